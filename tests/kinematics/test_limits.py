"""Limits of one drive with the others held against the triangles that close or do not."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import centrode as ct
from centrode.kinematics.preparation import ready
from centrode.kinematics.several_inputs.limits import held_path, starting_at
from drives import apart, five_bar
from mechanisms import EPS, four_bar
from samples import few


@pytest.mark.parametrize("held", [0.3, 1.0, 1.8, 2.2])
def test_a_crank_of_a_five_bar_by_the_law_of_cosines(held: float) -> None:
    """With C still, O, A and C make a triangle: its angle at O where |AC| is the sum of the rods."""
    mechanism = five_bar(rods=(0.7, 0.6))
    found = ct.limits(mechanism, "OA", {"EC": held})
    c = 1.0 + 0.5 * np.exp(1j * held)
    side, reach = abs(c), 1.3
    half = np.arccos((0.5**2 + side**2 - reach**2) / (2 * 0.5 * side))
    exact = np.angle(c) + half * np.array([-1.0, 1.0])
    assert exact[0] < 1.0 < exact[1]
    # an angle by its cosine loses digits as 1/sin
    assert np.max(np.abs(np.array(found.interval) - exact)) <= 16 * EPS / np.sin(half)
    assert found.held == {"EC": held}
    assert found.about == 1.0
    assert "AB-CB" in found.low.group  # type: ignore[union-attr]


@pytest.mark.parametrize("scale", [1e-3, 1.0, 400.0])
def test_a_slider_between_its_dead_points(scale: float) -> None:
    slider = ct.Mechanism(
        frame={"points": {"O": [0.0, 0.0]}},
        links={"OA": {"length": scale}, "AB": {"length": 3.0 * scale}},
        guides=[{"point": "B", "on": "frame", "through": "O", "direction": [1, 0]}],
        drives=[{"guide": "B", "start": 3.0 * scale, "speed": 1.0}],
        assembly={"sides": {"A": "left"}},
    )
    found = ct.limits(slider)
    assert found.interval == pytest.approx((2.0 * scale, 4.0 * scale), rel=4 * EPS)
    assert found.unit == "m"
    other = ct.limits(slider, about=f"{-3000 * scale} mm")
    assert other.interval == pytest.approx((-4.0 * scale, -2.0 * scale), rel=4 * EPS)


def test_a_crank_that_turns_has_none_and_a_parallelogram_has_change_points() -> None:
    assert ct.limits(four_bar(1.0, 3.5, 3.0, 4.0)).interval == (-np.inf, np.inf)
    found = ct.limits(ct.example("parallelogram"))
    assert found.low is None
    assert found.high is None
    turns = np.array([end.value for end in found.change_points]) / np.pi
    assert turns == pytest.approx(np.round(turns), abs=1e-12)
    assert {0.0, 1.0, 2.0} <= set(np.round(turns))


def test_limits_are_those_of_the_motion_with_one_drive() -> None:
    locked = ct.example("slider-between-cranks-locked")
    motion = ct.motion(locked, start=-1.5, stop=2.0)
    events = motion["event_value"].to_numpy()
    low, high = ct.limits(locked).interval
    assert high == events[events > 0][0]
    assert low < 0.0


def chain_of_dyads() -> ct.Mechanism:
    """A five-bar whose B drives a further dyad, B-F-G: either may lock first."""
    mechanism = five_bar(rods=(0.7, 0.6))
    frame = {"points": {**{n: list(p) for n, p in mechanism.frame.points.items()}, "G": [0.6, 1.9]}}
    links = {name: {"length": link.length} for name, link in mechanism.links.items()}
    links |= {"BF": {"length": 0.9}, "GF": {"length": 0.6}}
    return five_bar(frame=frame, links=links, assembly={"sides": {"B": "left", "F": "left"}})


def test_the_group_that_locks_first_is_named() -> None:
    mechanism = chain_of_dyads()
    seen = set()
    for held in np.linspace(1.4, 2.4, 11):
        found = ct.limits(mechanism, "OA", {"EC": float(held)})
        for end in (found.low, found.high):
            assert end is not None
            data = ct.motion(with_drives(mechanism, end.value, float(held)), at=[0.0])
            b = data["position"].sel(point="B").to_numpy()[0]
            rods = abs(apart(mechanism, end.value, held) - 1.3)
            to_g = np.hypot(*(b - [0.6, 1.9]))
            further = min(abs(to_g - 1.5), abs(to_g - 0.3))
            seen.add(end.group)
            assert (further if "BF" in end.group else rods) <= 1e-7  # a root lets half the digits through
    assert len(seen) == 2


def with_drives(mechanism: ct.Mechanism, first: float, second: float) -> ct.Mechanism:
    shifted = ct.with_value(mechanism, "drives.OA.start", first)
    return ct.with_value(shifted, "drives.EC.start", second)


LIMITS_WRONG: dict[str, tuple[dict[str, Any], str]] = {
    "unknown": ({"drive": "AO"}, "no drive AO"),
    "which": ({}, "name the drive that moves: OA, EC"),
    "held and moving": ({"drive": "OA", "held": {"OA": 1.0}}, "the one that moves"),
    "held unknown": ({"drive": "OA", "held": {"OX": 1.0}}, "no drive OX"),
    "held in metres": ({"drive": "OA", "held": {"EC": "1 m"}}, "expected an angle"),
    "open": ({"drive": "OA", "held": {"EC": 0.0}, "about": np.pi}, "does not close there"),
    "far": ({"drive": "OA", "about": 1e9}, "about: it is too long"),
    "held far": ({"drive": "OA", "held": {"EC": 1e300}}, "hold EC: it is too long"),
    "not finite": ({"drive": "OA", "about": float("inf")}, "about"),
}


@pytest.mark.parametrize("name", LIMITS_WRONG)
def test_limits_asked_for_wrongly(name: str) -> None:
    arguments, message = LIMITS_WRONG[name]
    with pytest.raises(ct.InputError, match=message):
        ct.limits(five_bar(), **arguments)


def test_cylinders_of_an_excavator_by_the_law_of_cosines() -> None:
    """Boom and stick stop where cylinder and lever are in line; the bucket where its four-bar stretches out."""
    m = ct.example("excavator-arm")
    o, k = (np.array(m.frame.points[name]) for name in "OK")
    boom, stick = (m.links[name].coordinates for name in ("boom", "stick"))
    low, high = ct.limits(m, "K-A").interval
    lever, base = np.hypot(*boom["A"]), np.hypot(*(o - k))
    assert (low, high) == pytest.approx((lever - base, lever + base), rel=8 * EPS)
    low, high = ct.limits(m, "C-E").interval
    to_c, to_e = np.hypot(*np.subtract(boom["C"], boom["B"])), np.hypot(*stick["E"])
    assert (low, high) == pytest.approx((abs(to_c - to_e), to_c + to_e), rel=8 * EPS)
    # one cylinder does not feel the others
    other = ct.limits(m, "C-E", {"K-A": "2600 mm", "S-N": 2.0})
    assert other.interval == pytest.approx((low, high), rel=8 * EPS)
    low, high = ct.limits(m, "S-N").interval
    g, s, h = (np.array(stick[name]) for name in "GSH")
    rocker, rod = m.links["GN"].length, m.links["NL"].length + np.hypot(*m.links["bucket"].coordinates["L"])
    assert high == pytest.approx(np.hypot(*(g - s)) + rocker, rel=8 * EPS)
    # rod and bucket in line: N stands where circles about G and H meet, on one of two sides
    ground = np.hypot(*(h - g))
    along = (ground**2 + rocker**2 - rod**2) / (2 * ground)
    across = np.sqrt(rocker**2 - along**2)
    x, y = (h - g) / ground, np.array([-(h - g)[1], (h - g)[0]]) / ground
    places = [g + along * x + sense * across * y for sense in (1.0, -1.0)]
    # the limit is where |NH| is longest: its place loses digits as 1/across, as |SN| does as 1/sin at N
    off = min(abs(np.hypot(*(n - s)) - low) for n in places)
    assert off <= 64 * EPS * rod**2 / across


@pytest.mark.parametrize(
    "name",
    [
        "geared-five-bar",
        "planetary-gear-train",
        "rolling-wheel-rod",
        "third-class-triad",
        "fourth-class-group",
    ],
)
def test_a_position_that_signs_do_not_tell_is_reached_on_the_way(name: str) -> None:
    """Turns are counted, groups of higher class followed: the position is that of a motion that goes there."""
    mechanism = ct.example(name)
    prepared = ready(mechanism)
    drive = mechanism.drives[0].id
    about = prepared.kinematics.path.initial + (0.3 if "class" in name else 7.0)
    start = starting_at(prepared, held_path(prepared, drive, about, {}))
    data = ct.motion(mechanism, at=[about])
    for point in mechanism.moving_points:
        there = data["position"].sel(point=point).to_numpy()[0]
        assert start.start.points[point] == pytest.approx(there, abs=1e3 * EPS)
    for link in mechanism.links:
        if link in start.start.angles:
            turned = float(data["angle"].sel(link=link)[0])
            assert start.start.angles[link] == pytest.approx(turned, abs=1e3 * EPS)
            assert start.branches.angles[link] == start.start.angles[link]


def test_a_group_of_higher_class_with_a_drive_between_moving_links() -> None:
    """Scissors AB, CB on a crank OA and a rocker EC: |AC| by the angle v between the rods, then the triangle A-C-E."""
    mechanism = ct.Mechanism(
        frame={"points": {"O": [0.0, 0.0], "E": [1.0, 0.0]}},
        links={
            "OA": {"length": 0.4},
            "AB": {"length": 0.6, "angle": "70 deg"},
            "CB": {"length": 0.7},
            "EC": {"length": 0.5, "angle": "91 deg"},
        },
        drives=[
            {"link": "OA", "start": 1.0, "speed": 1.0},
            {"link": "CB", "relative_to": "AB", "start": 1.3, "speed": 1.0},
        ],
    )
    for v in few((1.1, 1.5), (1.1, 1.3, 1.5)):
        reach = np.sqrt(0.85 - 0.84 * np.cos(v))
        half = np.arccos((0.16 + 1.0 - (reach + 0.5) ** 2) / 0.8)
        low, high = ct.limits(mechanism, "OA", {"CB": v}).interval
        # the limit is found as the place where a curve turns back: to the root of rounding of its arc, squared
        assert (low, high) == pytest.approx((-half, half), abs=1e3 * EPS)
    for a in few((0.8, 1.2), (0.8, 1.0, 1.2)):
        apart = abs(1.0 - 0.4 * np.exp(1j * a))
        least = np.arccos((0.85 - (apart - 0.5) ** 2) / 0.84)
        if apart + 0.5 < 1.3:
            greatest = np.arccos((0.85 - (apart + 0.5) ** 2) / 0.84)
        else:  # the rods cannot stretch so far: only folding them stops the scissors
            greatest = 2 * np.pi - least
        interval = ct.limits(mechanism, "CB", {"OA": a}).interval
        assert interval == pytest.approx((least, greatest), abs=1e3 * EPS)
    with pytest.raises(ct.NotComputedYet, match="higher class"):
        ct.reachable_region(mechanism)


def test_too_far_to_be_brought_there() -> None:
    with pytest.raises(ct.InputError, match="is too long"):
        ct.limits(ct.example("geared-five-bar"), about=1e7)


@pytest.mark.parametrize(("start", "sense"), [(4.0, 1.0), (2.0, -1.0)])
def test_from_a_dead_point(start: float, sense: float) -> None:
    """A drive that begins at its limit moves to the side on which the mechanism closes."""
    slider = ct.Mechanism(
        frame={"points": {"O": [0.0, 0.0]}},
        links={"OA": {"length": 1.0}, "AB": {"length": 3.0}},
        guides=[{"point": "B", "on": "frame", "through": "O", "direction": [1, 0]}],
        drives=[{"guide": "B", "start": start, "speed": -sense}],
        assembly={"sides": {"A": "left"}},
    )
    assert ct.limits(slider).interval == pytest.approx((2.0, 4.0), abs=16 * EPS)


SLIDER_BEFORE_DYAD = """
[frame.points]
O = [0, 0]
D = [{D!r}, 2.5]
[links.OA]
length = 1
[links.AB]
length = 3
[links.BE]
length = 1.6
[links.DE]
length = 1.4
[[guides]]
point = "B"
on = "frame"
through = [0, 2.5]
direction = 0
[[drives]]
link = "OA"
start = {start}
speed = 1
[assembly]
sides = {{ B = "ahead", E = "left" }}
"""


@pytest.mark.parametrize("ahead", [0.1, 6e-3, 2e-3, 1e-4, 1e-6, 1e-9])
@pytest.mark.parametrize("start", [0.4, 0.4013])
def test_a_later_group_stops_just_before_an_earlier_one(ahead: float, start: float) -> None:
    """The slider would stop at -30 deg, AB square to its guide; a little before, BE and DE are stretched out."""
    stops = -math.pi / 6 + ahead
    slider = math.cos(stops) + math.sqrt(9 - (2.5 - math.sin(stops)) ** 2)
    mechanism = ct.parse_mechanism(SLIDER_BEFORE_DYAD.format(D=slider + 3, start=start))
    low = ct.limits(mechanism).low
    # rounding of D and of the slider, a dozen units of 6 m, over the slider's way per radian, which is 1 m at least
    assert low is not None
    assert low.group == "group BE-DE (point E)"
    assert abs(low.value - stops) <= 64 * EPS
    status = ct.motion(mechanism, at=[stops - ahead / 2, stops + ahead / 2]).status
    assert status.values.tolist() == [ct.Status.OPEN, ct.Status.OK]
