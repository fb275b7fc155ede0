"""Change points that several drives pass at times known in closed form; a mesh in time of the mechanism's own."""

from __future__ import annotations

from collections.abc import Callable
from math import factorial
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

import centrode as ct
from centrode.kinematics.path import OFF_GRID, TimeScale, nearest_node
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.jets import Jet, JetFunctions
from mechanisms import EPS, events, point, statuses

Array = npt.NDArray[np.float64]
M = JetFunctions(ARRAYS)

MENDED = tuple(16 * factorial(order) * EPS / 0.04 ** (1 + order) for order in range(3))
"""Errors next to a change point in units of the size, those of `test_change_points`."""


def five_bar(
    a: float, d: float, rod: float, drives: list[dict[str, Any]], side: str = "left"
) -> ct.Mechanism:
    """Cranks OA and EC of length a on motors d apart, two rods that meet in B."""
    return ct.Mechanism(
        frame={"points": {"O": [0.0, 0.0], "E": [d, 0.0]}},
        links={"OA": {"length": a}, "AB": {"length": rod}, "CB": {"length": rod}, "EC": {"length": a}},
        drives=drives,
        assembly={"sides": {"B": side}},
    )


def mirror_images(speed: float) -> ct.Mechanism:
    """Cranks that mirror each other: |AC| = d - 2 a cos(w t) just reaches the length of both rods, at w t = pi."""
    drives = [{"link": "OA", "start": 0.0, "speed": speed}, {"link": "EC", "start": np.pi, "speed": -speed}]
    return five_bar(0.3, 1.0, 0.8, drives, "left")


def of_mirror_images(phase: Any) -> Any:
    """B of `mirror_images`: its height over AC is the root of a square, so it passes through zero smoothly."""
    over = M.cos(phase * 0.5) * M.sqrt((1.3 - M.cos(phase) * 0.3) * 0.6)
    return (over + M.sin(phase) * 0.3) * 1j + 0.5


@pytest.mark.parametrize("speed", [1e-5, 0.02, 1.0, 37.0, 1e6])
def test_rods_that_just_stretch_out(speed: float) -> None:
    at = np.pi * np.array([0.0, 0.3, 0.995, 1.0, 1.0 + 1e-9, 1.005, 1.7, 2.9, 3.0, 3.4])
    data = ct.motion(mirror_images(speed), at=at / speed)
    assert set(statuses(data)) == {"ok"}
    passed = np.array([1.0, 3.0]) * np.pi
    assert np.array(events(data, "change point")) * speed == pytest.approx(passed, abs=1e-7)
    exact = of_mirror_images(Jet.variable(at, 2))
    for order, variable in enumerate(("position", "velocity", "acceleration")):
        found = point(data, "B", variable) / speed**order
        assert np.max(np.abs(found - exact.derivative(order))) <= MENDED[order]


def through_one_place(speeds: tuple[float, float]) -> ct.Mechanism:
    """A and C pass through one place at t = 2 s, where B can go on in either direction."""
    start = [np.pi / 3 - 2 * speeds[0], 2 * np.pi / 3 - 2 * speeds[1]]
    drives = [
        {"link": link, "start": at, "speed": speed}
        for link, at, speed in zip(("OA", "EC"), start, speeds, strict=True)
    ]
    return five_bar(1.0, 1.0, 1.5, drives)


def ends(t: Array, speeds: tuple[float, float]) -> tuple[Array, Array]:
    """A and C of `through_one_place`."""
    return (
        np.exp(1j * (np.pi / 3 + (t - 2.0) * speeds[0])),
        1.0 + np.exp(1j * (2 * np.pi / 3 + (t - 2.0) * speeds[1])),
    )


@pytest.mark.parametrize("speeds", [(1.0, -2.0), (0.3, 0.9), (-1.0, 0.4)])
def test_cranks_whose_ends_pass_through_one_place(speeds: tuple[float, float]) -> None:
    mechanism = through_one_place(speeds)
    data = ct.motion(mechanism, at=np.array([0.0, 1.4, 1.9, 2.1, 2.5]))
    assert set(statuses(data)) == {"ok"}
    assert np.min(np.abs(np.array(events(data, "change point")) - 2.0)) <= 1e-7
    t = data["time"].to_numpy()
    a, c = ends(t, speeds)
    apart = c - a
    side = np.where(t < 2.0, 1.0, -1.0) * 1j * apart / np.abs(apart)
    exact = (a + c) / 2 + side * np.sqrt(2.25 - np.abs(apart) ** 2 / 4)
    # a unit vector of a difference of places loses the digits that the difference loses
    allowed = 64 * EPS * 2.0 / np.min(np.abs(apart))
    assert np.max(np.abs(point(data, "B") - exact)) <= allowed
    near = ct.motion(mechanism, at=2.0 + np.array([-1e-3, -1e-7, 0.0, 1e-7, 1e-3]))
    middle, around = point(near, "B")[2], point(near, "B")[[0, 4]]
    speed = np.abs(point(near, "B", "velocity")).max()
    assert set(statuses(near)) == {"ok"}
    assert np.max(np.abs(around - middle)) <= 1.1 * speed * 1e-3  # it does not jump to the other side


LAWS: dict[str, list[dict[str, Any]]] = {
    "speeds": [{"speed": 1.0}, {"speed": -2.0}],
    "faster and faster": [{"law": "0.01*t**3"}, {"law": "-0.02*t**3"}],
    "by turns": [{"law": "3*sin(t)"}, {"law": "-6*sin(t)"}],
    "a jump after a rest": [
        {
            "segments": [
                {"curve": "dwell", "time": 5.0},
                {"to": 3.0, "time": 0.01, "curve": "cycloidal"},
                {"curve": "dwell", "time": 3.0},
            ]
        },
        {"law": "-0.1*t"},
    ],
}


def lawful(name: str) -> ct.Mechanism:
    one, other = LAWS[name]
    drives = [{"link": "OA", "start": 1.0, **one}, {"link": "EC", "start": 2.0, **other}]
    return five_bar(0.5, 1.0, 0.6, drives)


@pytest.mark.parametrize("name", LAWS)
def test_a_longer_range_changes_nothing(name: str) -> None:
    """The same bits at the same times, and the same events: the rods reach 1.2 < 1 + 2 0.5, so there are limits."""
    mechanism = lawful(name)
    at = np.linspace(0.0, 1.5, 7)
    short = ct.motion(mechanism, at=at)
    long = ct.motion(mechanism, at=np.append(at, [3.1, 5.5, 7.9]))
    for variable in ("position", "velocity", "acceleration", "angle", "status"):
        np.testing.assert_array_equal(short[variable].to_numpy(), long[variable].to_numpy()[: len(at)])
    passed = short["event_value"].to_numpy()
    np.testing.assert_array_equal(passed, long["event_value"].to_numpy()[: len(passed)])


def test_a_limit_in_a_quick_move_after_a_rest_is_found() -> None:
    """The rods stretch out within the hundredth of a second in which the first crank moves."""
    mechanism = lawful("a jump after a rest")
    data = ct.motion(mechanism, at=np.array([0.0, 4.9, 5.2]))
    found = [x for x in events(data, "limit") if 5.0 < x < 5.01]
    assert found
    law = mechanism.drive("OA").motion_law
    for t in found:
        a = 0.5 * np.exp(1j * (1.0 + float(law.jet(ARRAYS, np.float64(t)))))
        c = 1.0 + 0.5 * np.exp(1j * (2.0 - 0.1 * t))
        # a rounding error of t moves A by its speed, 2 * 3 / 0.01 * 0.5 at most
        assert abs(abs(a - c) - 1.2) <= 8 * EPS * (1.0 + 300 * 5)


def rates(of: Callable[[Array], Array]) -> TimeScale:
    return TimeScale.of(of)


PACES: dict[str, Callable[[Array], Array]] = {
    "even": lambda t: np.ones_like(t),
    "slow": lambda t: 1e-7 * np.ones_like(t),
    "growing": lambda t: t * t,
    "a pulse": lambda t: 1e3 * np.exp(-(((t - 2.0) / 0.05) ** 2)),
    "at rest": lambda t: 0.0 * t,
    "absent": lambda t: np.where(t > 0.0, 1.0 / np.sqrt(np.abs(t) + 1e-300), np.nan),
}


@pytest.mark.parametrize("name", PACES)
def test_nodes_are_a_part_of_those_of_any_wider_range(name: str) -> None:
    pace = rates(PACES[name])
    base = pace.base
    wide = pace.nodes(-3.3 * base, 5.7 * base)
    assert (np.diff(wide) > 0.0).all()
    for low, high in ((0.0, 0.9 * base), (-1.2 * base, 0.3 * base), (1.9 * base, 2.1 * base), (-base, base)):
        nodes = pace.nodes(low, high)
        assert nodes[0] <= low
        assert nodes[-1] >= high
        np.testing.assert_array_equal(nodes, wide[(wide >= nodes[0]) & (wide <= nodes[-1])])


@pytest.mark.parametrize("name", PACES)
def test_no_drive_makes_more_than_half_a_degree_between_nodes(name: str) -> None:
    pace = rates(PACES[name])
    nodes = pace.nodes(0.0, 4.0 * pace.base)
    middle = 0.5 * (nodes[1:] + nodes[:-1])
    # rates are looked at a thousand times on a stretch: between two looks a pulse grows by less than a tenth;
    # where stretches meet, a node off the grid's end is followed by one off its beginning
    allowed = 1.1 * (1.0 + OFF_GRID) * np.radians(0.5)
    assert np.nanmax(PACES[name](middle) * np.diff(nodes)) <= allowed


@pytest.mark.parametrize("time", [0.0, 0.3, 1.0, 2.0, 3.0, 4.0, -0.3, -1.0, -2.0, -2.5, 1e300, -1e-300])
def test_the_unit_is_that_of_one_stretch(time: float) -> None:
    pace = TimeScale(lambda t: 1.0 + np.abs(t), 1.0)
    if abs(time) < 1e6:
        below, above = pace.nodes(time, time)[[0, -1]]
        assert below <= time <= above
    unit = pace.unit_at(time)
    span = max(1.0, 2.0 ** np.ceil(np.log2(max(abs(time), 1e-9)) + (time >= 0)))
    assert 1.0 / (1.0 + span) * (1 - 1e-12) <= unit <= 1.0


def test_nearest_node() -> None:
    mesh = np.array([0.0, 1.0, 3.0])
    assert nearest_node(mesh, np.array([-5.0, 0.4, 0.6, 1.9, 2.1, 9.0])).tolist() == [0, 0, 1, 1, 2, 2]


def test_a_longer_range_changes_nothing_next_to_a_change_point() -> None:
    at = np.pi + np.linspace(-0.05, 0.05, 11)
    short, long = ct.motion(mirror_images(1.0), at=at), ct.motion(mirror_images(1.0), at=np.append(at, 300.0))
    for variable in ("position", "velocity", "acceleration", "angle"):
        np.testing.assert_array_equal(short[variable].to_numpy(), long[variable].to_numpy()[: len(at)])
