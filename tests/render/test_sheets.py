"""Sheets of drawings: true lengths in DXF and PDF, standard scales, main inscription, nothing over another."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path
from typing import Any

import ezdxf
import numpy as np
import pypdfium2
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

import centrode as ct
from centrode.locale import speaking
from centrode.render.drafting.recorder import drawing_of_figure
from centrode.render.drafting.scales import diagram_scale, largest_standard_scale, read_scale
from centrode.render.drafting.sheets import drawing_figures, write_drawing_set
from centrode.report.drawing_sheets import drawing_sheets
from samples import examples_at_hand
from sheet_fields import BLOCK, EXACT, FRAME, TURNED, boxes_of_texts, check_fields, inside

SIGNED = """
[report.title_page]
institution = "НТУУ «КПІ»"
title = "Курсова робота"
author = "Шевченко Т. Г."
teacher = "Коваленко О. В."
group = "МТ-21"
year = 2026
designation = "ТММ.07"
"""


@dataclass
class Written:
    folder: Path
    figures: list[Figure]
    documents: list[Any]

    def lines(self, sheet: int, layer: str) -> list[np.ndarray]:
        """Polylines of a layer."""
        found = self.documents[sheet].modelspace().query(f'LWPOLYLINE[layer=="{layer}"]')
        return [np.array([point[:2] for point in line.get_points()]) for line in found]

    def circles(self, sheet: int) -> np.ndarray:
        return np.array([[*one.dxf.center][:2] for one in self.documents[sheet].modelspace().query("CIRCLE")])

    def words(self, sheet: int) -> list[str]:
        return [one.dxf.text for one in self.documents[sheet].modelspace().query("TEXT")]


@pytest.fixture(scope="module")
def press() -> ct.Mechanism:
    return ct.parse_mechanism(ct.mechanism_text(ct.example("six-bar-press")) + SIGNED)


@pytest.fixture(scope="module")
def written(press: ct.Mechanism, tmp_path_factory: pytest.TempPathFactory) -> Written:
    folder = tmp_path_factory.mktemp("sheets")
    made = drawing_sheets(press)
    write_drawing_set(made, folder)
    documents = [ezdxf.readfile(folder / f"sheet-{number}.dxf") for number in (1, 2, 3)]
    return Written(folder, drawing_figures(made), documents)


def test_links_are_as_long_as_the_scale_says(written: Written, press: ct.Mechanism) -> None:
    circles = written.circles(0)
    bodies = [body for body in press.links.values() if len(body.coordinates) > 1]
    lengths = [body.length or math.dist(*list(body.coordinates.values())[:2]) for body in bodies]
    apart = np.hypot(*(circles[:, None] - circles).transpose(2, 0, 1))
    for length in lengths:
        assert np.abs(apart - 1e3 * length / 10.0).min() <= EXACT  # 1:10


def test_vectors_of_a_plan_are_velocities(written: Written, press: ct.Mechanism) -> None:
    motion = ct.motion(press, at=["120 deg"])
    drawn = [math.dist(*line) for line in written.lines(0, "main") if len(line) == 2]
    for quantity, per in (("velocity", 0.004), ("acceleration", 0.002)):
        for point in "ABDH":
            size = float(np.hypot(*motion[quantity].sel(point=point).values[0]))
            assert min(abs(one - size / per) for one in drawn) <= EXACT * size / per


def test_the_stroke_is_that_of_the_slider(written: Written, press: ct.Mechanism) -> None:
    places = ct.motion(press, 7201).position.sel(point="H", axis="x")
    stroke = float(places.max() - places.min())
    curve = max(written.lines(0, "main"), key=lambda line: line[:, 1].max() if len(line) > 700 else 0.0)
    # position 0 stands at one end of the stroke, the other lies within half a degree: a parabola
    assert np.ptp(curve[:, 1]) == pytest.approx(stroke / 0.02, abs=2e-3)
    assert np.ptp(curve[:, 0]) == pytest.approx(2.0 * math.pi / 0.02, rel=1e-9)


def test_tangents_of_the_energy_mass_diagram_give_the_flywheel(written: Written, press: ct.Mechanism) -> None:
    """Slopes are omega^2 / 2 of the extreme speeds in the scales of the diagram: tan psi = mu_J omega^2 / (2 mu_T)."""
    mean, per_work, per_inertia = 65.0 * math.pi / 30.0, 40.0, 0.1
    sloping = [
        line for line in written.lines(1, "thin") if len(line) == 2 and abs(np.diff(line[:, 1])[0]) > 0.0
    ]
    sloping = [line for line in sloping if np.diff(line[:, 0])[0] > 100.0]
    tangents = [
        per_inertia * (mean * (1.0 + sign * 0.11 / 2.0)) ** 2 / (2.0 * per_work) for sign in (-1.0, 1.0)
    ]
    slopes = sorted(float(np.diff(line[:, 1])[0] / np.diff(line[:, 0])[0]) for line in sloping)
    assert slopes == pytest.approx(tangents, rel=1e-9)
    length = abs(sloping[0][0, 1] - sloping[1][0, 1])
    needed = per_inertia * length / (tangents[1] - tangents[0])
    assert needed == pytest.approx(ct.flywheel(press).inertia, rel=1e-9)
    # no place of the diagram lies beyond its tangents, and by them alone the flywheel is the same
    steady = ct.steady_motion(press, 3601)
    inertia, work = steady.inertia_of_links.values, steady.work.values
    least, greatest = (0.5 * (mean * (1.0 + sign * 0.11 / 2.0)) ** 2 for sign in (-1.0, 1.0))
    span = (work - greatest * inertia).max() - (work - least * inertia).min()
    assert span / (greatest - least) == pytest.approx(needed, rel=1e-6)
    assert f"= {needed:.5g} kg·m²" in " ".join(written.words(1))


def test_forces_of_a_polygon_are_the_reactions(written: Written, press: ct.Mechanism) -> None:
    drawn = [
        math.dist(*line) for layer in ("main", "thin") for line in written.lines(2, layer) if len(line) == 2
    ]
    loads = ct.reactions(press, at=["120 deg"], motion="real")
    for side, per in (("C/frame", 100.0), ("D/DH", 100.0), ("O/frame", 100.0)):
        size = float(np.hypot(*loads.joint_force.sel(side=side).values[0]))
        assert min(abs(one - size / per) for one in drawn) <= EXACT * size / per, side


def test_the_inscription_says_who_and_what(written: Written) -> None:
    for number, document in enumerate(written.documents, start=1):
        assert not document.audit().errors
        words = written.words(number - 1)
        for text in ("Шевченко Т. Г.", "Коваленко О. В.", "Курсова робота", "НТУУ «КПІ»", "МТ-21, 2026"):
            assert text in words, text
        assert words.count(f"ТММ.07.{number:02d}") == 2  # once upside down
        assert f"Sheet {number}" in words and "Sheets 3" in words
        with pypdfium2.PdfDocument(written.folder / f"sheet-{number}.pdf") as pdf:
            told = pdf[0].get_textpage().get_text_range()
        assert f"ТММ.07.{number:02d}" in told and "Шевченко" in told
    assert "1:10" in written.words(0)


def test_pdf_has_the_size_of_the_paper(written: Written) -> None:
    millimetre = 72.0 / 25.4
    with pypdfium2.PdfDocument(written.folder / "sheet-1.pdf") as pdf:
        page = pdf[0]
        assert page.get_size() == pytest.approx((841.0 * millimetre, 594.0 * millimetre), abs=1e-3)
        boxes = [np.array(one.get_bounds()) / millimetre for one in page.get_objects() if one.type == 2]
    # boxes are larger than lines by the width of these; the file has six decimals of points
    wide = max(boxes, key=lambda box: box[2] - box[0])
    block = max((box for box in boxes if box[0] > 640.0), key=lambda box: box[2] - box[0])
    assert (wide[2] - wide[0]) - (block[2] - block[0]) == pytest.approx(816.0 - 185.0, abs=1e-4)
    assert (wide[3] - wide[1]) - (block[3] - block[1]) == pytest.approx(584.0 - 55.0, abs=1e-4)
    assert (wide[:2] + wide[2:]) / 2 == pytest.approx((428.0, 297.0), abs=1e-4)


def test_lines_have_the_widths_of_the_standard(written: Written) -> None:
    widths = {
        layer.dxf.name: layer.dxf.lineweight
        for layer in written.documents[0].layers
        if layer.dxf.lineweight > 0
    }
    assert {widths[name] for name in ("main", "frame", "title-block-main")} == {70}
    assert {widths[name] for name in ("thin", "dashed", "names", "title-block")} == {25}
    frame = [line for line in written.lines(0, "frame")]
    assert [*frame[0].min(axis=0), *frame[0].max(axis=0)] == pytest.approx(FRAME, abs=EXACT)
    block = [line for line in written.lines(0, "title-block-main") if len(line) == 5]
    corners = sorted(tuple([*line.min(axis=0), *line.max(axis=0)]) for line in block)
    assert corners == [pytest.approx(TURNED, abs=EXACT), pytest.approx(BLOCK, abs=EXACT)]


def test_nothing_leaves_its_field(written: Written) -> None:
    for number, figure in enumerate(written.figures):
        layers = ("main", "thin", "dashed", "chain", "frame", "title-block", "title-block-main")
        check_fields(figure, [(layer, line) for layer in layers for line in written.lines(number, layer)])


def test_texts_do_not_cover_each_other(written: Written) -> None:
    for figure in written.figures:
        for (_layer, one, first), (_other, two, second) in combinations(boxes_of_texts(figure), 2):
            over = np.minimum(first[1], second[1]) - np.maximum(first[0], second[0])
            assert over.min() <= 1.0, (one, two)  # boxes have room above and below small letters


@pytest.mark.parametrize(
    "name", examples_at_hand(("crank-rocker", "slider-between-cranks-locked", "jansen-leg"))
)
def test_the_scale_is_the_largest_standard_one(name: str) -> None:
    mechanism = ct.example(name)
    if mechanism.space == "sphere":
        with pytest.raises(ct.NotComputedYet):
            drawing_sheets(mechanism)
        return
    made = drawing_sheets(mechanism)
    (figure, *_others) = drawing_figures(made)
    check_fields(figure, [])
    said = [text for layer, text, _box in boxes_of_texts(figure) if layer and ":" in text and len(text) < 8]
    scale = read_scale(said[0], "test")
    larger = [one for one in STANDARD if one > scale.ratio * (1.0 + 1e-9)]
    assert any(abs(one - scale.ratio) <= 1e-12 * one for one in STANDARD)
    positions = made.sheets[0].positions
    tracks = np.concatenate(
        [one["position"].values.reshape(-1, 2) for one in (positions.positions, positions.path)]
    )
    size = 1e3 * np.nanmax(tracks, axis=0) - 1e3 * np.nanmin(tracks, axis=0)
    room = np.array([814.0 - 362.0, 582.0 - 16.0 - 17.0 - (232.0 if made.sheets[0].plans else 0.0)])
    assert (size * scale.ratio <= room - 34.0 + EXACT).all()
    assert (size * min(larger) > room - 34.0).any()


STANDARD = (
    *(1.0 / one for one in (2, 2.5, 4, 5, 10, 15, 20, 25, 40, 50, 75, 100, 200, 400, 500, 800, 1000)),
    1.0, 2.0, 2.5, 4.0, 5.0, 10.0, 20.0, 40.0, 50.0, 100.0,
)  # fmt: skip
"""GOST 2.302-68."""


def test_standard_scales_are_those_of_the_standard() -> None:
    for fits in np.geomspace(1e-3, 99.0, 301):
        assert largest_standard_scale(fits).ratio == pytest.approx(
            max(one for one in STANDARD if one <= fits * (1 + 1e-9))
        )
    for extent in np.geomspace(1e-4, 1e5, 97):
        scale = diagram_scale(extent, 100.0)
        mantissa = scale / 10.0 ** math.floor(math.log10(scale) + 1e-12)
        assert min(abs(mantissa - one) for one in (1.0, 2.0, 2.5, 4.0, 5.0)) <= 1e-9
        assert extent / scale <= 100.0 * (1.0 + 1e-9) < 2.0001 * extent / scale * 1.25


def test_the_same_sheets_give_the_same_bytes(tmp_path: Path) -> None:
    made = drawing_sheets(ct.example("slider-crank-offset"))
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
        write_drawing_set(made, tmp_path / name)
    for file in ("sheet-1.pdf", "sheet-1.dxf"):
        assert (tmp_path / "a" / file).read_bytes() == (tmp_path / "b" / file).read_bytes()


def test_sheets_speak(press: ct.Mechanism) -> None:
    made = drawing_sheets(press)
    for language, words in (("ru", ("Масштаб", "Лист 2", "Утв.")), ("uk", ("Масштаб", "Аркуш 2", "Затв."))):
        with speaking(language):
            figure = drawing_figures(made)[1]
        texts = {text for _layer, text, _box in boxes_of_texts(figure)}
        assert set(words) <= texts
        check_fields(figure, [])


def test_sheets_of_the_sphere_have_its_diagrams() -> None:
    """cos CB = cos AB sin psi + sin AB cos psi sin beta, AB = 15 and CB = 45 deg; its derivative gives the rate."""
    text = ct.mechanism_text(ct.example("spherical-crank-rocker-rigid"))
    made = drawing_sheets(ct.parse_mechanism(text + "\n[machine]\nmean_speed = 2.94\nfluctuation = 0.05\n"))
    assert [type(sheet).__name__ for sheet in made.sheets] == ["DiagramSheet", "EnergySheet"]
    assert made.absent.startswith("not drawn on the sphere: plan of positions") and not made.missing
    angle, rate, _acceleration = (diagram.curves[0] for diagram in made.sheets[0].diagrams)
    beta, psi, crank = angle.across, angle.up, math.radians(15)
    assert beta[-1] == pytest.approx(math.tau, abs=1e-12)
    left = math.cos(crank) * np.sin(psi) + math.sin(crank) * np.cos(psi) * np.sin(beta)
    np.testing.assert_allclose(left, math.cos(math.radians(45)), atol=1e-12)
    slope = math.cos(crank) * np.cos(psi) - math.sin(crank) * np.sin(psi) * np.sin(beta)
    expected = -2.94 * math.sin(crank) * np.cos(psi) * np.cos(beta) / slope
    np.testing.assert_allclose(rate.up, expected, atol=1e-11)
    for figure in drawing_figures(made):
        check_fields(figure, [])
    with pytest.raises(
        ct.InputError, match="BC neither turns about a hinge of the frame nor is a guide of it"
    ):
        drawing_sheets(ct.example("spherical-crank-rocker"), link="BC")


def test_several_instants_have_a_sheet_of_plans() -> None:
    made = drawing_sheets(ct.example("crank-rocker"), instants=["30 deg", "90 deg", "150 deg"])
    assert [type(sheet).__name__ for sheet in made.sheets] == ["MotionSheet", "VectorSheet"]
    assert len(made.sheets[1].plans) == 6
    for figure in drawing_figures(made):
        check_fields(figure, [])


def test_letters_of_titles_are_alike_on_all_sheets(written: Written) -> None:
    titles = ("Plan of positions", "Moments, works", "Force polygons")
    heights = [
        text.dxf.height
        for document, title in zip(written.documents, titles, strict=True)
        for text in document.modelspace().query('TEXT[layer=="title-block"]')
        if text.dxf.text.startswith(title)
    ]
    assert len(heights) == 3 and np.ptp(heights) <= EXACT


def test_the_course_stands_below_the_designation(press: ct.Mechanism, tmp_path: Path) -> None:
    course = "Теорія механізмів і машин"
    signed = SIGNED.replace("designation", f'course = "{course}"\ndesignation')
    made = drawing_sheets(ct.parse_mechanism(ct.mechanism_text(ct.example("crank-rocker")) + signed))
    (figure,) = drawing_figures(made)
    boxes = {text: box for layer, text, box in boxes_of_texts(figure) if layer}
    designation, below = boxes["ТММ.07.01"], boxes[course]
    assert below[1, 1] <= designation[0, 1] + 1.0  # boxes have room above and below small letters
    field = (716.0, 45.0, 836.0, 60.0)  # GOST 2.104: field 2 of form 1
    assert inside(below, field)
    check_fields(figure, [])


def test_edges_end_at_the_border_of_their_field() -> None:
    """Of a line that leaves its axes the part inside is drawn up to the border: (0, 0) to (2, 1) is cut at x = 1."""
    figure = Figure(figsize=(100.0 / 25.4, 100.0 / 25.4), dpi=72)
    axes = figure.add_axes((0.1, 0.2, 0.5, 0.4))
    axes.set_axis_off()
    axes.set_xlim(0.0, 1.0)
    axes.set_ylim(0.0, 1.0)
    axes.plot([0.0, 2.0], [0.0, 1.0], color="black")
    axes.plot([0.5, 1.5, 0.5], [0.5, 0.5, 0.75], color="black")
    axes.plot([-1.0, 3.0], [1.5, 1.5], color="black")
    FigureCanvasAgg(figure)
    found = [stroke.places for stroke in drawing_of_figure(figure).strokes]
    expected = [[(0, 0), (1, 0.5)], [(0.5, 0.5), (1, 0.5)], [(1, 0.625), (0.5, 0.75)]]
    assert len(found) == 3
    for places, ends in zip(found, expected, strict=True):
        scaled = np.array([10.0, 20.0]) + np.array(ends) * [50.0, 40.0]
        np.testing.assert_allclose(places, scaled, atol=1e-6)
