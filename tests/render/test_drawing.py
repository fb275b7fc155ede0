"""Drawings: the conventional signs stand at the points, the names beside them."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.patches import Circle, FancyArrowPatch, Polygon

import centrode
from centrode.model.files import parse_mechanism
from centrode.render.drawing.linkage import draw_mechanism
from centrode.render.drawing.tags import label_places
from centrode.render.figures.curves import part_of_pi
from centrode.scenes.linkage import cylinders, scene_of, straight_track
from centrode.scenes.places import corners
from centrode.views.abscissa import passings


def drawn(made, sample: int = 0):
    mechanism, dataset = made
    scene = scene_of(mechanism, dataset)
    axes = Figure().subplots()
    draw_mechanism(axes, scene, sample)
    return scene, axes


def circles(axes, radius: float):
    return {
        tuple(np.round(patch.center, 9))
        for patch in axes.patches
        if isinstance(patch, Circle) and np.isclose(patch.radius, radius)
    }


def test_hinges_are_circles_and_other_points_dots(make):
    scene, axes = drawn(make("press"))
    places = {name: tuple(np.round(place, 9)) for name, place in scene.at(0).items()}
    assert circles(axes, scene.sign) == {places[name] for name in ("O", "C", "A", "B", "D", "H")}
    assert circles(axes, 0.5 * scene.sign) == {places[name] for name in ("S2", "S4")}


def test_links_pass_their_points(make):
    scene, axes = drawn(make("press"), 40)
    places = scene.at(40)
    found = {line.get_label(): np.stack(line.get_data(), axis=1) for line in axes.get_lines()}
    np.testing.assert_array_equal(found["OA"], [places["O"], places["A"]])
    np.testing.assert_array_equal(found["rocker"], [places["C"], places["D"]])
    assert axes.get_aspect() == 1.0


def test_a_slider_lies_along_its_guide(make):
    scene, axes = drawn(make("press"))
    rectangles = [
        patch.get_xy() for patch in axes.patches if isinstance(patch, Polygon) and len(patch.get_xy()) == 5
    ]
    (outline,) = rectangles
    np.testing.assert_allclose(outline[:4].mean(axis=0), scene.at(0)["H"])
    assert np.ptp(outline[:, 0]) > np.ptp(outline[:, 1])


def test_a_slot_holds_its_pin(make):
    mechanism, dataset = make("slotted")
    scene = scene_of(mechanism, dataset)
    for sample in (0, 30, 140):
        axes = Figure().subplots()
        draw_mechanism(axes, scene, sample)
        (slot,) = [p for p in axes.patches if isinstance(p, Polygon) and len(p.get_xy()) > 20]
        assert slot.get_path().contains_point(scene.at(sample)["A"])


def test_the_drive_has_an_arrow(make):
    _scene, axes = drawn(make("five_bar"))
    assert sum(isinstance(patch, FancyArrowPatch) for patch in axes.patches) == 2


@pytest.mark.parametrize("name", ["press", "worked", "jansen", "slotted"])
def test_every_point_has_its_name_and_no_two_names_meet(make, name):
    scene, axes = drawn(make(name))
    texts = {text.get_text(): np.array(text.get_position()) for text in axes.texts}
    assert set(texts) == set(scene.at(0))
    height = 10.0 / 72.0 / scene.inches * scene.extent
    places = list(texts.values())
    for k, first in enumerate(places):
        for second in places[k + 1 :]:
            assert np.max(np.abs(first - second)) > 0.6 * height
    for point, place in texts.items():
        assert np.hypot(*(place - scene.at(0)[point])) < 4 * height


def test_names_stand_away_from_lines():
    origin, right, up = np.zeros(2), np.array([1.0, 0.0]), np.array([0.0, 1.0])
    places = label_places({"A": origin}, [(origin, right), (origin, up)], 0.05, 0.04)
    assert (places["A"] < 0).all()


def test_outlines_of_links():
    text = """
    [frame.points]
    O = [0, 0]
    [links.plate]
    points = { O = [0, 0], A = [2, 0], B = [2, 1], M = [1.5, 0.4], C = [0, 1] }
    [links.bar]
    points = { C = [0, 0], E = [1, 0.5], F = [2, 1] }
    [[drives]]
    link = "plate"
    speed = 1
    """
    mechanism = parse_mechanism(text, "plate")
    assert corners(mechanism.links["plate"]) == ["O", "A", "B", "C"]
    assert corners(mechanism.links["bar"]) == ["C", "F"]


def test_a_block_on_a_rod_is_a_rectangle_along_it(make):
    mechanism, dataset = make("slotted")
    keys = {"point": "A", "on": "кулиса", "through": "C", "direction": (1.0, 0.0), "link": "M"}
    links = {"OA": {"length": 0.4}, "кулиса": mechanism.links["кулиса"], "M": {"points": {"A": (0.0, 0.0)}}}
    drives = [{"link": "OA", "start": 0.0, "law": "0.5*sin(2*t)"}]
    rod = type(mechanism)(frame=mechanism.frame, links=links, guides=[keys], drives=drives)
    scene, axes = drawn((rod, dataset), 20)
    (outline,) = [p.get_xy() for p in axes.patches if isinstance(p, Polygon) and len(p.get_xy()) == 5]
    side = outline[1] - outline[0]
    turn = float(dataset["angle"].sel(link="кулиса")[20])
    np.testing.assert_allclose(np.arctan2(side[1], side[0]), turn)
    np.testing.assert_allclose(outline[:4].mean(axis=0), scene.at(20)["A"])


def test_parts_of_pi():
    pi = np.pi
    assert [part_of_pi(x) for x in (0.0, pi / 6, -pi / 2, pi, 3 * pi / 2, -2 * pi)] == [
        "0",
        "π/6",
        "−π/2",
        "π",
        "3π/2",
        "−2π",
    ]


def test_passings_of_a_value():
    times, values = np.arange(4.0), np.array([0.0, 2.0, 0.0, 2.0])
    assert passings(times, values, 1.0) == [0.5, 1.5, 2.5]
    assert passings(times, values, 0.0) == [0.0, 2.0]
    assert passings(times, values, 3.0) == []


def run_of(name: str):
    mechanism = centrode.example(name)
    return mechanism, centrode.motion(mechanism, 13)


def test_a_rolling_wheel_is_a_circle_at_its_centre_with_its_track():
    scene, axes = drawn(run_of("planetary-hypocycloid"), 4)
    assert circles(axes, 1.0) == {tuple(np.round(scene.at(4)["A"], 9))}  # rim and filling of the wheel
    assert circles(axes, 3.0) == {(0.0, 0.0)}  # the ring
    assert (scene.low <= -3.0).all() and (scene.high >= 3.0).all()


def test_a_straight_track_runs_under_the_wheel_from_end_to_end():
    mechanism, dataset = run_of("rolling-wheel-rod")
    scene = scene_of(mechanism, dataset)
    start, end = straight_track(scene, mechanism.rolling[0], 0)
    contact = scene.factor * dataset["contact"].sel(rolling="wheel").to_numpy()
    assert start[0] < contact[:, 0].min() and end[0] > contact[:, 0].max()
    np.testing.assert_allclose([start[1], end[1]], contact[:2, 1], atol=1e-12 * scene.extent)


def test_a_cylinder_keeps_its_barrel_and_ends_at_its_points():
    mechanism, dataset = run_of("excavator-arm")
    scene = scene_of(mechanism, dataset)
    lengths = []
    for sample in (0, 4, 9):
        for drive, foot, mouth, end in cylinders(scene, sample):
            places = scene.at(sample)
            np.testing.assert_array_equal(foot, places[drive.distance[0]])
            np.testing.assert_array_equal(end, places[drive.distance[1]])
            lengths.append(np.hypot(*(mouth - foot)))
            assert lengths[-1] < np.hypot(*(end - foot))
    np.testing.assert_allclose(lengths[:3] * 2, lengths[3:], rtol=1e-12)
