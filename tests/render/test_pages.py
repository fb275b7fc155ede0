"""Pages of a document: true scales, names that stand free, light and dark."""

from __future__ import annotations

import colorsys
import io
import math
from pathlib import Path

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.patches import FancyArrowPatch
from matplotlib.text import Text

import centrode as ct
from boxes import boxes, outside, overlapping
from centrode.analysis.graphic.checks import graphic_check
from centrode.analysis.transmission import transmission_results
from centrode.render.drawing.style import LEAST_POINTS, darken, house_style
from centrode.render.figures.files import save_figures
from centrode.render.pages.page import (
    COLUMN,
    COLUMNS,
    CORNER,
    INCH,
    SIZE,
    PageView,
    count_crossings,
    new_page,
    symbol,
    typeset,
)
from centrode.render.pages.vector_diagrams import SHORT, TOGETHER
from drawn_curves import at_samples
from samples import few

INSTANTS = {
    "slider-between-cranks": math.pi / 2,
    "jansen-leg": 1.0,
    "excavator-arm": 0.7,
    "whitworth-quick-return": 0.9,
    "third-class-triad": 1.0,
    "planetary-hypocycloid": 1.0,
    "rolling-wheel-rod": 0.6,
}
LOOKED_AT = few(
    ["slider-between-cranks", "jansen-leg", "whitworth-quick-return", "planetary-hypocycloid"], list(INSTANTS)
)
PLANS = ("six-bar-press", "slider-between-cranks", "jansen-leg", "elliptic-trammel")


@pytest.fixture(scope="module")
def pages() -> dict[str, dict[str, Figure]]:
    return {
        name: ct.figures(ct.graphic_analysis(ct.example(name), instants=[INSTANTS[name]]))
        for name in LOOKED_AT
    }


def test_a_page_can_be_saved_as_any_figure(pages: dict[str, dict[str, Figure]]) -> None:
    stream = io.BytesIO()
    pages["slider-between-cranks"]["velocity"].savefig(stream, format="png", dpi=20)
    assert stream.getvalue().startswith(b"\x89PNG")


@pytest.mark.parametrize("name", LOOKED_AT)
@pytest.mark.parametrize("page", ["mechanism", "velocity", "acceleration"])
def test_no_text_covers_another_or_leaves_the_page(
    pages: dict[str, dict[str, Figure]], name: str, page: str
) -> None:
    figure = pages[name][page]
    measured = boxes(figure)
    assert overlapping(measured) == []
    assert outside(figure, measured) == []
    size = INCH * np.array(figure.get_size_inches())
    assert size == pytest.approx([210, 148])


@pytest.mark.parametrize(
    "line",
    [
        "drive crank: balancing moment or force: 260.31 N m, at the crank's own angle",
        "привод кривошип: зрівноважувальний момент (сила): 260,31 Н·м за кутом повороту",
        "моменты относительно полюса, приходящиеся на единицу скорости привода OA",
    ],
)
def test_lines_of_the_column_stay_on_the_page(line: str) -> None:
    page = new_page()
    page.write_lines(COLUMN, 100.0, [line], letters=COLUMNS, step=4.0, size=LEAST_POINTS, indent=4)
    assert outside(page.figure) == []
    assert " ".join(text.get_text().strip() for text in page.overlay.texts) == line


@pytest.mark.parametrize(
    ("name", "count"), [*((name, 24) for name in PLANS), (PLANS[0], 12), (PLANS[-1], 12)]
)
def test_numbers_of_a_plan_stand_free(name: str, count: int) -> None:
    figure = ct.figures(ct.plan_of_positions(ct.example(name), count))["plan"]
    measured = boxes(figure)
    assert overlapping(measured) == []
    assert outside(figure, measured) == []
    texts = [text.get_text() for text in figure.findobj(Text)]
    assert {str(number) for number in range(count)} <= set(texts)


def arrows(figure: Figure) -> list[np.ndarray]:
    found = [patch for axes in figure.axes for patch in axes.patches if isinstance(patch, FancyArrowPatch)]
    return [np.array(patch._posA_posB) for patch in found if patch._posA_posB is not None]


@pytest.mark.parametrize("name", ["jansen-leg", "whitworth-quick-return"])
def test_vectors_are_as_long_as_the_scale_says(pages: dict[str, dict[str, Figure]], name: str) -> None:
    found = graphic_check(ct.example(name), INSTANTS[name]).diagrams
    for page, diagram in (("velocity", found.velocity), ("acceleration", found.acceleration)):
        drawn = arrows(pages[name][page])
        (pole,) = [
            np.ravel(line.get_data())
            for line in pages[name][page].axes[0].lines
            if line.get_marker() == "o" and line.get_markersize() == 3.0
        ]
        from_pole = [ends[1] - ends[0] for ends in drawn if np.abs(ends[0] - pole).max() < 1e-9]
        for point in found.mechanism.moving_points:
            image = diagram.images[point] / diagram.scale
            if abs(image) > max(SHORT, TOGETHER):
                # images nearer to another one than that share its arrow
                apart = min(abs(complex(*vector) - image) for vector in from_pole)
                assert apart <= TOGETHER


def test_every_moving_point_has_its_image(pages: dict[str, dict[str, Figure]]) -> None:
    texts = {text.get_text() for text in pages["jansen-leg"]["velocity"].findobj(Text)}
    assert {"a", "b", "c", "e", "f", "g"} <= texts


def test_dark_pages_have_light_texts() -> None:
    figures = ct.figures(ct.graphic_analysis(ct.example("crank-rocker"), instants=[1.0]))
    for figure in figures.values():
        dark = darken(figure)
        assert lightness(dark.get_facecolor()) < 0.2
        for text in dark.findobj(Text):
            if text.get_text():
                assert lightness(text.get_color()) > 0.5
        assert overlapping(dark) == []


def lightness(colour: object) -> float:
    return colorsys.rgb_to_hls(*to_rgb(colour))[1]  # type: ignore[arg-type]


def test_pages_are_the_same_bytes_twice(tmp_path: Path) -> None:
    written = []
    for folder in (tmp_path / "one", tmp_path / "two"):
        folder.mkdir()
        figures = ct.figures(ct.graphic_analysis(ct.example("crank-rocker"), instants=[1.0]))
        written.append([file.read_bytes() for file in save_figures(figures, folder)])
    assert len(written[0]) == 6
    assert written[0] == written[1]


def test_a_view_is_true_to_scale() -> None:
    view = PageView.about(CORNER, SIZE, np.array([[0.0, 0.0], [2.0, 1.0]]), 0.02)
    assert np.hypot(*(view.mm([1.0, 0.0]) - view.mm([0.0, 0.0]))) == pytest.approx(50)
    assert view.mm([1.0, 0.5]) == pytest.approx(CORNER + SIZE / 2)


def test_segments_through_a_box() -> None:
    low, high = np.array([0.0, 0.0]), np.array([1.0, 1.0])
    through = [(np.array([-1.0, 0.5]), np.array([2.0, 0.5])), (np.array([0.5, 0.5]), np.array([0.6, 9.0]))]
    beside = [(np.array([-1.0, 1.5]), np.array([2.0, 1.5])), (np.array([2.0, -1.0]), np.array([2.0, 9.0]))]
    lines = np.array([*through, *beside])
    assert count_crossings(low[None], high[None], lines).tolist() == [2]
    assert count_crossings(low[None], high[None], np.empty((0, 2, 2))).tolist() == [0]
    far = np.array([0.0, 100.0])
    assert count_crossings(np.array([low, low + far]), np.array([high, high + far]), lines).tolist() == [2, 0]


def test_names_stand_beside_what_they_name() -> None:
    with house_style():
        page = new_page()
        page.avoid([(np.array([50.0, 50.0]), np.array([60.0, 50.0]))])
        for name in ("a", "b", "c"):
            page.name(np.array([50.0, 50.0]), name)
        page.place_names(np.array([[0.0, 0.0], [100.0, 100.0]]))
    assert overlapping(page.figure) == []
    for text in page.overlay.texts:
        assert np.hypot(*(np.array(text.get_position()) - 50.0)) < 8.0


def test_symbols_are_typeset() -> None:
    assert symbol("a", "BA", "normal") == "$a^{n}_{BA}$"
    assert typeset("v_A = v_AO (⊥ AO)") == "$v_{A}$ = $v_{AO}$ (⊥ AO)"
    assert typeset("cost $") == r"cost \$"
    assert symbol("P", "кулиса") == r"$P_{\mathrm{кулиса}}$"


def test_transmission_angles_are_drawn_in_degrees() -> None:
    mechanism = ct.four_bar(crank=1, coupler=3.5, rocker=3, ground=4)
    results = transmission_results(mechanism, samples=37)
    angles = results.angles
    upper, lower = ct.figures(results)["transmission"].axes
    (curve,) = [line for line in upper.lines if line.get_label() == "coupler-rocker"]
    assert np.allclose(at_samples(curve.get_ydata(), 37), np.degrees(angles.transmission_angle.values[:, 0]))
    assert "°" in lower.get_ylabel()


def test_instants_in_one_drawing_have_true_vectors_and_centres() -> None:
    """The printed check: t = 0 and t = pi/2. Tips of the arrows are the motion's velocities in one scale."""
    press = ct.example("slider-between-cranks")
    figure = ct.figures(ct.graphic_analysis(press, instants=[0.0, math.pi / 2]))["instants"]
    overlay, axes = figure.axes[0], figure.axes[1]
    low, place = np.array([axes.get_xlim()[0], axes.get_ylim()[0]]), axes.get_position()
    corner = np.array([place.x0, place.y0]) * np.array(figure.get_size_inches()) * INCH
    scale = (axes.get_xlim()[1] - low[0]) / (place.width * figure.get_figwidth() * INCH)
    found = []
    for arrow in overlay.patches:
        if isinstance(arrow, FancyArrowPatch) and arrow._posA_posB is not None:
            start, end = np.array(arrow._posA_posB)
            found.append(np.array([low + scale * (start - corner), end - start]))
    motion = ct.motion(press, at=[0.0, math.pi / 2])
    vectors = []
    for quantity, per in (("velocity", 0.025), ("acceleration", 0.05)):  # as the figure says
        for sample in range(2):
            for point in press.moving_points:
                at = motion.position.sel(point=point).values[sample]
                size = motion[quantity].sel(point=point).values[sample] / per
                if np.hypot(*size) >= 1.0:  # millimetres
                    vectors.append(np.array([at, size]))
    assert len(found) == len(vectors)
    for vector in vectors:
        assert min(np.abs(one - vector).max() for one in found) <= 1e-9 * 100.0
    texts = {text.get_text() for text in overlay.texts}
    # at pi/2 the coupler translates: it has one centre, the cranks share theirs
    assert {r"$P_{AC}$", r"$P_{CB}$", r"$P_{CB{}^{\prime}}$", r"$P_{OA}$", r"$P_{BD}$"} <= texts
    assert not {r"$P_{AC{}^{\prime}}$", r"$P_{OA{}^{\prime}}$"} & texts
    assert {"A", "A′", "O", "D"} <= texts and "O′" not in texts


def test_one_instant_has_no_drawing_of_several() -> None:
    assert "instants" not in ct.figures(ct.graphic_analysis(ct.example("crank-rocker"), instants=[0.7]))
