"""Pictures of centres and centrodes: places are the numbers', no text covers another, light and dark."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_hex, to_rgb
from matplotlib.figure import Figure
from PIL import Image

import centrode as ct
from centrode.analysis.instant_centres.kennedy import CentreConstruction
from centrode.analysis.instant_centres.results import (
    CentreResults,
    CentrodeResults,
    centre_results,
    centrode_results,
)
from centrode.animation.animate import animate_centrodes
from centrode.model.examples import example_text
from centrode.render.drawing.style import darken, house_style
from centrode.render.drawing.tags import Tag, write_tags
from centrode.render.figures.pictures import figure_of
from centrode.sheets.scenes import Scene
from centrode.topics.presentation import sheet_of
from samples import examples_at_hand, few

PLANAR = [name for name in examples_at_hand(ct.example_names()) if "space" not in example_text(name)]
CROWDED = [
    "andrews-squeezer", "antiparallelogram", "cam-driven-linkage", "cardan-gear", "elliptic-trammel", "excavator-arm",
    "five-bar-two-drives", "fourth-class-group", "jansen-leg", "klann-leg", "planetary-gear-train", "rack-and-pinion",
    "rolling-wheel-rod", "scissor-lift", "six-bar-press", "slider-between-cranks", "stephenson-six-bar",
    "third-class-triad", "three-crank-parallelogram", "whitworth-quick-return",
]  # fmt: skip
"""Those with most names, and one of each kind of joint and of drive."""
A5 = (8.27, 5.83)


def position(
    name: str, share: float = 0.4, pairs: Any = None
) -> tuple[CentreResults, CentreConstruction, Figure]:
    """A mechanism at one of its regular samples, with its construction and the figure of it."""
    mechanism = ct.example(name)
    motion = ct.motion(mechanism, samples=13)
    regular = np.flatnonzero(motion["status"].to_numpy() == ct.Status.OK)
    sample = int(regular[int(share * regular.size)])
    instant = float(mechanism.motion_parameter.instants(motion)[sample])
    results = centre_results(mechanism, pairs=pairs, instants=[instant])
    (made,) = results.constructions
    assert made is not None
    return results, made, ct.figures(results)["centres"]


def drawn_at(results: CentrodeResults, sample: int) -> Figure:
    """The centrodes as they lie at a sample."""
    scene = sheet_of(results).pictures["centrodes"]
    assert isinstance(scene, Scene)
    linkage = dataclasses.replace(scene.linkage, sample=sample)
    return figure_of(dataclasses.replace(scene, linkage=linkage), results.mechanism.display)


def texts_of(figure: Figure) -> list[tuple[str, Any]]:
    """Texts that name places, with their boxes."""
    figure.draw_without_rendering()
    canvas: Any = FigureCanvasAgg(figure)
    tags = [text for text in figure.axes[0].texts if text.get_gid() == "tag"]
    return [(text.get_text(), text.get_window_extent(canvas.get_renderer())) for text in tags]


@pytest.mark.parametrize("name", few(CROWDED, PLANAR))
def test_names_of_no_example_cover_each_other(name: str) -> None:
    results, _made, figure = position(name)
    boxes = texts_of(figure)
    room = figure.axes[0].get_window_extent()
    for number, (text, box) in enumerate(boxes):
        assert not [other for other, taken in boxes[:number] if box.overlaps(taken)], text
        assert room.x0 <= box.x0 and box.x1 <= room.x1 and room.y0 <= box.y0 and box.y1 <= room.y1, text
    assert (np.array(figure.get_size_inches()) <= A5).all()
    assert figure.axes[0].get_aspect() == 1.0
    named = {point for text, _box in boxes for point in text.replace("\n", ", ").split(", ")}
    assert set(results.mechanism.points) <= named


def test_centres_stand_at_their_places() -> None:
    _results, made, figure = position("slider-between-cranks")
    marks = [line for line in figure.axes[0].get_lines() if line.get_marker() == "D"]
    shown = {tuple(float(x[0]) for x in line.get_data()) for line in marks}
    assert shown <= {step.place for step in made.steps}
    limits = np.array([figure.axes[0].get_xlim(), figure.axes[0].get_ylim()])
    inside = {
        step.place
        for step in made.steps
        if step.place and (limits[:, 0] <= step.place).all() and (step.place <= limits[:, 1]).all()
    }
    assert shown == inside
    chords = [line for line in figure.axes[1].get_lines() if len(line.get_xdata()) == 2]
    assert len(chords) == len(made.steps)


def test_the_pairs_that_are_asked_for() -> None:
    _results, made, figure = position("jansen-leg", pairs=[("AB", "frame")])
    assert sum(line.get_marker() == "D" for line in figure.axes[0].get_lines()) == 1
    needed = made.needed_steps([(2, 0)])
    chords = [line for line in figure.axes[1].get_lines() if len(line.get_xdata()) == 2]
    assert len(chords) == len(needed.steps) == 5


def test_a_crowd_of_names_finds_room() -> None:
    figure = Figure(figsize=(6, 5))
    axes = figure.add_axes((0.1, 0.1, 0.8, 0.8))
    random = np.random.default_rng(3)
    tags = [Tag(0.5 + 0.04 * random.standard_normal(2), f"$P_{{{k}}}$, {k}") for k in range(30)]
    write_tags(axes, tags, [], [], 10.0, 4.0)
    boxes = [box for _text, box in texts_of(figure)]
    assert len(boxes) == 30
    assert not any(a.overlaps(b) for k, a in enumerate(boxes) for b in boxes[:k])


def test_centrodes_are_drawn_piece_by_piece() -> None:
    results = centrode_results(ct.example("crank-rocker"), 91, link="AB")
    found, figure = results.centrodes, drawn_at(results, 20)
    pieces = found["centrode_piece"].to_numpy()
    curves = [line for line in figure.axes[0].get_lines() if line.get_zorder() == 7.2]
    assert len(curves) == 2 * (pieces.max() + 1)
    fixed = found["fixed_centrode"].to_numpy()
    for piece, line in enumerate(curves[: pieces.max() + 1]):
        np.testing.assert_array_equal(np.stack(line.get_data(), axis=1), fixed[pieces == piece])
    # laid on the frame, the moving centrode passes the centre of the sample
    moving = np.concatenate([np.stack(line.get_data(), axis=1) for line in curves[pieces.max() + 1 :]])
    np.testing.assert_allclose(moving[20], fixed[20], atol=1e-12 * np.abs(fixed[20]).max())


def test_against_a_moving_link_both_move() -> None:
    mechanism = ct.example("antiparallelogram")
    results = centrode_results(mechanism, 31, 0.4, 2.8, link="DB", against="OA")
    for sample in (3, 20):
        figure = drawn_at(results, sample)
        first, second = (
            np.stack(line.get_data(), axis=1)
            for line in figure.axes[0].get_lines()
            if line.get_zorder() == 7.2
        )
        expected = ct.instant_centres(results.motion, [("DB", "OA")])["centre"].to_numpy()[sample, 0]
        for curve in (first, second):
            np.testing.assert_allclose(curve[sample], expected, atol=1e-12)


def test_the_animation_rolls(tmp_path: Path) -> None:
    mechanism = ct.example("elliptic-trammel")
    motion = ct.motion(mechanism, samples=7)
    found = ct.centrodes(motion, "AB")
    for dark in (False, True):
        path = tmp_path / f"{dark}.gif"
        animate_centrodes(mechanism, motion, found, path, dark)
        with Image.open(path) as picture:
            assert picture.format == "GIF"
            assert picture.n_frames == 12  # there and back over seven samples
            corner = picture.convert("RGB").getpixel((2, 2))
        assert (max(corner) < 64) == dark
    with pytest.raises(ct.InputError, match="there is no centrode in this range"):
        animate_centrodes(mechanism, motion, ct.centrodes(motion, "slider A"), tmp_path / "none.gif")
    assert not (tmp_path / "none.gif").exists()


def test_the_curvature_figure_shows_its_curves() -> None:
    results = centrode_results(ct.example("crank-rocker"), 9, link="AB", instants=[2.5])
    bent, figure = results.curvature, ct.figures(results)["curvature"]
    assert bent is not None
    circle, cubic = (
        np.stack(line.get_data(), axis=1) for line in figure.axes[0].get_lines() if line.get_zorder() == 6.8
    )
    pole, end = (bent[name].to_numpy()[0] for name in ("pole", "inflection_pole"))
    np.testing.assert_allclose(
        np.sum((circle - pole) * (circle - end), axis=1),
        0.0,
        atol=1e-12 * float(bent["inflection_diameter"][0]) ** 2,
    )  # Thales
    tangent = float(bent["pole_tangent"][0])
    local = (cubic - pole) @ np.array(
        [[np.cos(tangent), -np.sin(tangent)], [np.sin(tangent), np.cos(tangent)]]
    )
    x, y = local[np.isfinite(local).all(axis=1)].T
    a, b = bent["stationary_cubic"].to_numpy()[0]
    size = np.hypot(x, y)
    assert (np.abs((x * x + y * y) * (a * x + b * y) - x * y) <= 1e-10 * (1 + size) ** 3).all()
    boxes = [box for _text, box in texts_of(figure)]
    assert not any(one.overlaps(other) for k, one in enumerate(boxes) for other in boxes[:k])


def test_dark_pictures_are_light_on_dark() -> None:
    _results, _made, figure = position("slider-between-cranks")
    figure = darken(figure)
    canvas: Any = FigureCanvasAgg(figure)
    canvas.draw()
    picture = np.asarray(canvas.buffer_rgba())[..., :3].astype(float).mean(axis=-1)
    assert np.median(picture) < 40
    assert picture.max() > 200
    for text in figure.findobj(lambda one: hasattr(one, "get_fontsize") and one.get_text()):
        red, green, blue = (int(to_hex(text.get_color())[k : k + 2], 16) for k in (1, 3, 5))
        assert max(red, green, blue) > 140, text.get_text()
        for effect in text.get_path_effects():  # the edge of letters is of the ground
            edge = to_hex(effect._gc["foreground"])
            assert max(int(edge[k : k + 2], 16) for k in (1, 3, 5)) < 40, text.get_text()


def test_areas_and_later_marks_are_dark_pictures_own() -> None:
    """A tint of the white ground becomes one of the dark ground; marks that a greater size brings are as the others."""
    with house_style():
        figure = Figure(figsize=(4.0, 1.0))
        axes = figure.add_subplot()
        axes.plot([0.0, 1.0], [0.0, 37.0])
        area = axes.axhspan(0.0, 20.0, color="#cfe3f2")
        FigureCanvasAgg(figure).draw()
        few = len(axes.get_yticks())
        darken(figure)
        figure.set_size_inches(4.0, 9.0)
        FigureCanvasAgg(figure).draw()
        assert len(axes.get_yticks()) > few
        assert min(to_rgb(label.get_color())[0] for label in axes.get_yticklabels()) > 0.6
        assert max(max(to_rgb(line.get_color())) for line in axes.get_ygridlines()) < 0.4
        assert max(to_rgb(area.get_facecolor())) < 0.5
