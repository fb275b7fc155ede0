"""What the pictures show is where the results say it is: points, paths, vectors, centres, centrodes, forces."""

from __future__ import annotations

import functools
import math
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle
from PIL import Image

import centrode as ct
from centrode.animation.animate import MAKERS, Shown, animate_motion, layers_of, stage_of
from centrode.animation.centrodes import CentresLayer, CentrodesLayer
from centrode.animation.frames import Course, Film, course_from, course_of, film_from, film_of
from centrode.animation.layers import Layer, scene_of_film
from centrode.animation.linkages import LinksLayer, PathsLayer
from centrode.animation.stage import write_entries
from centrode.animation.vectors import (
    VectorLayer,
    joint_layer,
    load_layer,
    point_vectors,
    round_down,
    share_scale,
)
from centrode.render.drawing.style import house_style
from centrode.scenes.places import View

EPS = float(np.finfo(float).eps)
EVERYTHING = Shown(tuple(sorted(set(MAKERS) - {"forces", "loads"})))


@functools.cache
def course(name: str) -> Course:
    return course_of(ct.example(name))


def film(name: str, frames: int = 8) -> Film:
    return film_of(course(name), frames)


def drawn(layer: Layer, frame: int) -> Axes:
    """Axes on which a layer has drawn a frame, in a view of some size."""
    reach = layer.reach()
    low, high = (reach.min(axis=0), reach.max(axis=0)) if len(reach) else (-np.ones(2), np.ones(2))
    axes = Figure().add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set_xlim(low[0], high[0])
    axes.set_ylim(low[1], high[1])
    layer.stand(View(low, high, float(np.max(high - low)) / 6.0))
    layer.draw(axes, frame)
    return axes


@pytest.mark.parametrize("name", ["six-bar-press", "excavator-arm", "scissor-lift", "klann-leg"])
def test_hinges_stand_where_the_points_are(name: str) -> None:
    """Every point has a circle about its place of the dataset, in every frame."""
    shown = film(name)
    scene = scene_of_film(shown)
    for frame, sample in enumerate(shown.order.tolist()):
        axes = drawn(LinksLayer(shown, scene), frame)
        centres = np.array([one.center for one in axes.patches if isinstance(one, Circle)])
        for point in shown.mechanism.moving_points:
            place = scene.factor * shown.motion["position"].sel(point=point).to_numpy()[sample]
            assert np.hypot(*(centres - place).T).min() == 0.0


def test_names_keep_their_distance_from_their_points() -> None:
    shown = film("six-bar-press", 12)
    layer = LinksLayer(shown, scene_of_film(shown))
    apart: dict[str, list[np.ndarray]] = {}
    for frame in range(12):
        places = layer.scene.at(layer.sample(frame))
        for text in drawn(layer, frame).texts:
            apart.setdefault(text.get_text(), []).append(
                np.array(text.get_position()) - places[text.get_text()]
            )
    assert set(apart) == {"O", "C", *shown.mechanism.moving_points}
    for offsets in apart.values():
        assert np.ptp(offsets, axis=0).max() <= 8 * EPS * layer.scene.extent


@pytest.mark.parametrize("growing", [False, True])
def test_paths_are_those_of_the_motion(growing: bool) -> None:
    shown = film("crank-rocker", 12)
    layer = PathsLayer(shown, scene_of_film(shown), ["B"], growing)
    course = shown.course.motion["position"].sel(point="B").to_numpy()
    own = shown.motion["position"].sel(point="B").to_numpy()
    for frame, sample in enumerate(shown.order.tolist()):
        axes = drawn(layer, frame)
        if not growing:
            assert not axes.lines
            layer.ground(axes)
        (line,) = axes.lines
        path = np.array(line.get_data()).T
        if not growing:
            assert np.array_equal(path, course)
            continue
        # 30 samples of the course to a frame, the first of each at the frame itself
        assert np.array_equal(path[:-1], course[: 30 * frame + 1])
        assert np.array_equal(path[-1], own[sample])


@pytest.mark.parametrize(("variable", "name"), [("velocity", "six-bar-press"), ("acceleration", "shaper")])
def test_vectors_are_as_long_as_their_scale_says(variable: str, name: str) -> None:
    shown = film(name)
    points = shown.mechanism.moving_points
    layer = point_vectors(shown, scene_of_film(shown), variable, points)
    greatest = 0.0
    for frame, sample in enumerate(shown.order.tolist()):
        axes = drawn(layer, frame)
        (arrows,) = axes.collections
        corners = np.array([path.vertices for path in arrows.get_paths()])
        starts, tips = (corners[:, 0] + corners[:, 6]) / 2.0, corners[:, 3]
        here = shown.motion.isel(sample=sample)
        for point, start, tip in zip(points, starts, tips, strict=True):
            place = here["position"].sel(point=point).to_numpy() * layer.scene.factor
            value = here[variable].sel(point=point).to_numpy() * layer.scene.factor  # the display's length
            # rounding of places and sums on the picture, some units of which are its coordinates
            room = 16 * EPS * float(np.abs(corners).max())
            assert np.abs(start - place).max() <= room
            assert np.abs(tip - start - layer.scale * value).max() <= room
            greatest = max(greatest, float(np.hypot(*value)))
    assert layer.greatest == pytest.approx(greatest, rel=8 * EPS)
    (told,) = layer.scales()
    value = float(told.text.split(": ")[1].split()[0])
    assert told.length == pytest.approx(layer.scale * value, rel=4 * EPS)
    assert value == round_down(0.8 * layer.greatest)


@pytest.mark.parametrize(
    ("value", "least"), [(1.0, 1.0), (0.99, 0.5), (4.9, 2.0), (5.0, 5.0), (73.0, 50.0), (2e-7, 2e-7)]
)
def test_round_values(value: float, least: float) -> None:
    assert round_down(value) == pytest.approx(least, rel=4 * EPS)


def test_vectors_that_run_away_do_not_make_the_others_small() -> None:
    """Near a limit velocities grow without bound: those beyond six upper deciles are left out and told."""
    mechanism = ct.example("slider-between-cranks-locked")
    motion = ct.motion(mechanism, 1001)
    last = float(motion["event_value"][0])
    near = last - np.geomspace(1.0, 1e-9, 60)
    shown = film_from(course_from(mechanism, ct.motion(mechanism, at=near)), 59)
    layer = point_vectors(shown, scene_of_film(shown), "velocity", mechanism.moving_points)
    sizes = np.linalg.norm(layer.vectors.values, axis=2)
    assert layer.greatest == 6.0 * np.quantile(sizes[np.isfinite(sizes)], 0.9) < sizes.max()
    lengths = [np.hypot(*layer.arrows(sample)[1].T) for sample in range(layer.count)]
    extent = float(np.max(np.ptp(layer.reach(), axis=0)))
    assert max(float(one.max(initial=0.0)) for one in lengths) <= 0.22 * extent
    assert any("too long to draw" in note for note in layer.notes())
    hidden = int((sizes > layer.greatest).sum())
    assert sum(map(len, lengths)) == sizes.size - hidden - int((sizes == 0.0).sum())


def test_what_does_not_move_has_no_vectors() -> None:
    shown = film("slider-between-cranks")
    layer = point_vectors(shown, scene_of_film(shown), "velocity", ["A"])
    layer.vectors.values[:] = 0.0
    still = VectorLayer(shown, layer.scene, layer.vectors)
    assert not still.scales() and not len(still.reach())
    assert not drawn(still, 0).collections
    assert still.notes() == ["velocity: none"]


def test_instant_centres_are_where_the_cranks_meet() -> None:
    """That of a four-bar's coupler is on both cranks; the names are those of the bodies' numbers."""
    shown = film("crank-rocker", 7)
    layer = CentresLayer(shown, scene_of_film(shown), [("AB", "frame")])
    assert layer.symbol(layer.pairs[0]) == "$P_{20}$"
    for sample in range(layer.count):
        o, a, d, b = (layer.scene.tracks[name][sample] for name in "OADB")
        share = np.linalg.solve(np.stack([a - o, -(b - d)], axis=1), d - o)
        place = o + share[0] * (a - o)
        # the angle between the cranks tells how many digits are left
        cosine = abs((a - o) @ (b - d)) / (np.hypot(*(a - o)) * np.hypot(*(b - d)))
        room = 200 * EPS * float(np.abs(place).max()) / max(1.0 - cosine**2, EPS)
        assert np.abs(layer.places[sample, 0] - place).max() <= room
    axes = drawn(layer, 1)
    marks = [line for line in axes.lines if line.get_marker() == "D"]
    assert [text.get_text() for text in axes.texts] == ["$P_{20}$"] * len(marks)


def test_centres_in_one_place_share_their_names() -> None:
    shown = film("crank-rocker", 7)
    axes = drawn(CentresLayer(shown, scene_of_film(shown)), 0)  # the crank points at D: P20 is in D
    assert "$P_{20}$, $P_{30}$" in [text.get_text() for text in axes.texts]
    few = CentresLayer(film("six-bar-press"), scene_of_film(film("six-bar-press")))
    assert [second for _first, second in few.pairs] == ["frame"] * 5


@pytest.mark.parametrize(
    ("name", "link", "against"),
    [
        ("crank-rocker", "AB", "frame"),
        ("antiparallelogram", "DB", "OA"),
        ("spherical-crank-rocker", "BC", "frame"),
    ],
)
def test_centrodes_touch_in_the_centre(name: str, link: str, against: str) -> None:
    """Where the frames are samples of the course both curves pass the touching place."""
    course = course_of(ct.example(name), 61)
    shown = film_from(course, 12)
    layer = CentrodesLayer(shown, scene_of_film(shown), link, against)
    for sample in range(layer.count):
        place = layer.touching(sample)
        if not np.isfinite(place).all():
            continue
        for side in (0, 1):
            curve = layer.placed_curve(side, sample)
            gap = np.nanmin(np.linalg.norm(curve - place, axis=1))
            far = float(np.nanmax(np.abs(np.append(curve[np.isfinite(curve)], place))))
            assert gap <= 1e4 * EPS * far  # the same centre once by its body's axes and once by the frame's


def test_a_link_that_only_shifts_has_no_centrode() -> None:
    shown = film("scissor-lift")
    with pytest.raises(ct.InputError, match="there is no centrode in this range"):
        CentrodesLayer(
            shown, scene_of_film(shown), "platform" if "platform" in shown.mechanism.links else "frame"
        )


def test_forces_in_a_hinge_are_opposite_and_loads_are_what_they_are() -> None:
    """In a hinge of two links without a load, and one scale for forces and loads."""
    shown = film("six-bar-press")
    scene = scene_of_film(shown)
    joints, loads = joint_layer(shown, scene), load_layer(shown, scene)
    bodies = dict.fromkeys(map(str, ct.reactions(shown.mechanism, 2)["side"].to_numpy()))
    kept = [name for name in bodies if not name.endswith("/frame")]
    force = dict(zip(kept, joints.vectors.values.transpose(1, 0, 2), strict=False))
    worst = float(np.abs(joints.vectors.values).max())
    for pin in ("A/OA", "B/AB"):
        other = {"A/OA": "A/AB", "B/AB": "B/CD"}[pin]
        # the equations of all links are solved together
        assert np.abs(force[pin] + force[other]).max() <= 1e4 * EPS * worst
    assert np.unique(loads.vectors.values[:, 1:, 0]).tolist() == [0.0]
    down = loads.vectors.values[0, 1:, 1]
    assert down.tolist() == pytest.approx([-90.0, -160.0, -220.0, -35.0])  # the weights of the description
    share_scale([joints, loads])
    assert joints.scale == loads.scale
    for layer in (joints, loads):
        starts, along = layer.arrows(3)
        values = layer.vectors.values[3][layer.shown[3]]
        assert np.abs(along - layer.scale * values).max() <= 4 * EPS * float(np.abs(along).max())
        assert len(starts) == len(values)


@pytest.mark.parametrize("name", ["six-bar-press", "crank-rocker", "spherical-crank-rocker", "double-rocker"])
def test_nothing_is_cut_off(name: str) -> None:
    """The view holds what every layer reaches, and it is the same in every frame."""
    shown = film(name)
    stage, _notes = stage_of(shown, EVERYTHING, (320, 240))
    figure, axes, _paper = stage._prepare_figure()
    limits = np.array([axes.get_xlim(), axes.get_ylim()])
    for layer in stage.layers:
        places = layer.reach()
        assert ((places >= limits[:, 0]) & (places <= limits[:, 1])).all()
    for frame in range(stage.frames):
        for layer in stage.layers:
            layer.draw(axes, frame)
    assert np.array_equal(np.array([axes.get_xlim(), axes.get_ylim()]), limits)
    wide, high = np.ptp(limits, axis=1)
    box = axes.get_position()
    shape = (box.width * figure.get_figwidth()) / (box.height * figure.get_figheight())
    assert wide / high == pytest.approx(shape, rel=16 * EPS)  # equal scales


def test_samples_that_are_not_there_are_not_drawn() -> None:
    shown = film("crank-rocker", 6)
    scene = scene_of_film(shown)
    scene.tracks["B"][2] = np.nan
    axes = drawn(LinksLayer(shown, scene), 2)
    assert "B" not in {text.get_text() for text in axes.texts}
    assert {"A", "O", "D"} <= {text.get_text() for text in axes.texts}
    with pytest.raises(ct.InputError, match="no sample has every point in place"):
        motion = ct.motion(ct.example("crank-rocker"), 5)
        motion["position"][:] = np.nan
        course_from(ct.example("crank-rocker"), motion)


@pytest.mark.parametrize(
    ("shown", "told"),
    [
        (Shown(("speeds",)), '"speeds" cannot be shown; show any of accelerations, centres'),
        (Shown(("paths",), ["Z"]), 'there is no moving point "Z"'),
        (Shown(("paths",), ["O"]), 'there is no moving point "O"'),
        (Shown(("centres",), ["A"]), "points: it controls how paths, velocities, accelerations"),
        (Shown(("paths",), link="AB"), "link: it controls how centrodes are shown, which are not shown"),
        (Shown((), growing=True), "growing: it controls how paths"),
        (Shown(("centres",), pairs=[("AB", "XY")]), "XY"),
        (Shown(("centrodes",), link="XY"), "XY"),
    ],
)
def test_names_that_mean_nothing_are_refused(shown: Shown, told: str) -> None:
    with pytest.raises(ct.InputError) as refusal:
        layers_of(film("crank-rocker", 4), scene_of_film(film("crank-rocker", 4)), shown)
    assert told in str(refusal.value)


def test_forces_need_masses_or_loads() -> None:
    with pytest.raises(ct.InputError, match="there are neither masses nor loads"):
        ct.animate(ct.example("crank-rocker"), Path("never.gif"), Shown(["forces"]))
    assert not Path("never.gif").exists()


def test_given_results_run_round_or_there_and_back(tmp_path: Path) -> None:
    linkage = ct.example("spherical-four-bar")
    for name, last, count in (("round", math.tau, 12), ("back", 3.0, 24)):
        motion = ct.motion(linkage, at=np.linspace(0.0, last, 49))
        animate_motion(linkage, motion, tmp_path / f"{name}.gif", frames=12)
        with Image.open(tmp_path / f"{name}.gif") as picture:
            assert getattr(picture, "n_frames", 1) == count


@pytest.mark.parametrize("size", [(800, 600), (1200, 300), (300, 900)])
@pytest.mark.parametrize("name", ["six-bar-press", "jansen-leg", "spherical-crank-rocker-rigid"])
def test_texts_stand_in_the_picture(name: str, size: tuple[int, int]) -> None:
    """Title, scales and legend lie inside, and the scales and the legend below the drawing."""
    what = sorted(MAKERS) if name == "six-bar-press" else ["paths", "velocities", "accelerations", "centres"]
    stage, _notes = stage_of(film(name, 4), Shown(what), size)
    with house_style():
        figure, axes, paper = stage._prepare_figure()
        canvas = FigureCanvasAgg(figure)
        canvas.draw()
        renderer = canvas.get_renderer()
        bottom = axes.get_window_extent(renderer).y0
        title, *scales = paper.texts
        legend = paper.get_legend()
        below = [*scales, *([] if legend is None else [legend])]
        assert len(scales) == sum(len(layer.scales()) for layer in stage.layers)
        for artist in [title, *below]:
            box = artist.get_window_extent(renderer)
            assert box.x0 >= 0.0 and box.x1 <= size[0]
            assert box.y0 >= 0.0 and box.y1 <= size[1]
            assert artist is title or box.y1 <= bottom + 1.0  # a pixel
        for above, lower in pairwise(below):
            one, other = above.get_window_extent(renderer), lower.get_window_extent(renderer)
            assert not one.overlaps(other)


def test_a_long_legend_is_cut() -> None:
    paper = Figure(figsize=(8, 6)).add_axes((0, 0, 1, 1))
    paper.set_xlim(0, 8)
    paper.set_ylim(0, 6)
    many = [(Line2D([], []), f"{number} link") for number in range(400)]
    assert write_entries(paper, many) == pytest.approx(0.08 + 5 * 0.2)
    assert [text.get_text() for text in paper.get_legend().get_texts()][-2:] == ["22 link", "…"]
    assert write_entries(paper, [(Line2D([], []), 40 * "W")] * 3) == pytest.approx(0.08 + 3 * 0.2)
