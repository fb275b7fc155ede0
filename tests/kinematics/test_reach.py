"""Limits of one drive, and the reachable region of two, against the triangles that close or do not."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
import xarray as xr

import centrode as ct
from centrode.kinematics.holding import held_path, starting_at
from centrode.kinematics.ready import ready
from mechanisms import EPS, four_bar

Array = npt.NDArray[np.float64]


def five_bar(
    a: float = 0.5,
    rods: tuple[float, float] = (0.7, 0.4),
    c: float = 0.5,
    d: float = 1.0,
    start: tuple[float, float] = (1.0, 1.8),
    **more: Any,
) -> ct.Mechanism:
    """Cranks OA and EC, rods AB and CB: it closes where |AC| lies between the difference and the sum of the rods."""
    parts: dict[str, Any] = {
        "frame": {"points": {"O": [0.0, 0.0], "E": [d, 0.0]}},
        "links": {
            "OA": {"length": a},
            "AB": {"length": rods[0]},
            "CB": {"length": rods[1]},
            "EC": {"length": c},
        },
        "drives": [
            {"link": "OA", "start": start[0], "speed": 1.0},
            {"link": "EC", "start": start[1], "speed": -2.0},
        ],
        "assembly": {"sides": {"B": "left"}},
    }
    return ct.Mechanism(**{**parts, **more})


def apart(mechanism: ct.Mechanism, first: Any, second: Any) -> Any:
    """|AC| of a five-bar by the angles of its cranks."""
    lengths = {name: link.length for name, link in mechanism.links.items()}
    d = mechanism.frame.points["E"][0]
    return np.abs(lengths["OA"] * np.exp(1j * first) - d - lengths["EC"] * np.exp(1j * second))


def least_and_greatest(mechanism: ct.Mechanism) -> tuple[float, float]:
    rods = [mechanism.links[name].length for name in ("AB", "CB")]
    return abs(rods[0] - rods[1]), rods[0] + rods[1]


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


def grid_of(region: xr.Dataset) -> tuple[Array, Array]:
    first, second = np.meshgrid(region["first"], region["second"], indexing="ij")
    return first, second


MECHANISMS = {
    "an island in it": five_bar(),
    "tall": five_bar(rods=(0.35, 0.9), a=0.45, c=0.3, d=1.1),
    "in parts": five_bar(0.7, (0.17, 0.13), 0.7, 1.0, (0.95, 2.3)),
}


@pytest.mark.parametrize("name", MECHANISMS)
def test_the_region_of_a_five_bar_is_where_its_rods_reach(name: str) -> None:
    mechanism = MECHANISMS[name]
    region = ct.reachable_region(mechanism, samples=121)
    least, greatest = least_and_greatest(mechanism)
    between = apart(mechanism, *grid_of(region))
    closed = (between >= least) & (between <= greatest)
    clear = np.minimum(np.abs(between - least), np.abs(between - greatest)) > 16 * EPS
    status = region["status"].to_numpy()
    assert np.array_equal(closed[clear], (status != ct.Status.OPEN)[clear])
    margin = region["margin"].to_numpy()
    assert np.array_equal(margin[clear] > 0.0, closed[clear])
    # what is reached is one connected part of it: by an independent flood through neighbouring nodes
    assert np.array_equal(status == ct.Status.OK, flooded(closed, seed(region)))
    assert int((status == ct.Status.OK).sum()) > 100
    assert (status == ct.Status.CUT_OFF).any() == (name == "in parts")


def seed(region: xr.Dataset) -> tuple[int, int]:
    start = region["initial_value"].to_numpy()
    return tuple(  # type: ignore[return-value]
        int(np.flatnonzero(region[name].to_numpy() == value)[0])
        for name, value in zip(("first", "second"), start, strict=True)
    )


def flooded(closed: npt.NDArray[np.bool_], start: tuple[int, int]) -> npt.NDArray[np.bool_]:
    found = np.zeros(closed.shape, dtype=bool)
    found[start] = True
    edge = [start]
    while edge:
        i, j = edge.pop()
        for k, n in ((i + 1, j), (i - 1, j), (i, j + 1), (i, j - 1)):
            # both ends of a turn are one place
            for place in {(k % (closed.shape[0] - 1), n % (closed.shape[1] - 1)), (k, n)}:
                inside = 0 <= place[0] < closed.shape[0] and 0 <= place[1] < closed.shape[1]
                if inside and closed[place] and not found[place]:
                    found[place] = True
                    edge.append(place)
    return found


@pytest.mark.parametrize("name", MECHANISMS)
def test_border_points_are_exact(name: str) -> None:
    mechanism = MECHANISMS[name]
    region = ct.reachable_region(mechanism, samples=61)
    first, second = region["border_value"].to_numpy().T
    least, greatest = least_and_greatest(mechanism)
    between = apart(mechanism, first, second)
    off = np.minimum(np.abs(between - least), np.abs(between - greatest))
    # a root is exact to a few units of its last place (values below 8), |AC| moves at most by a crank's length with it
    assert np.max(off) <= 8 * EPS * 8
    on_lines = np.isin(first, region["first"]) | np.isin(second, region["second"])
    assert on_lines.all()
    # every line on which the nodes change between open and closed has a border point between them
    closed = region["status"].to_numpy() != ct.Status.OPEN
    changes = int((closed[1:] != closed[:-1]).sum() + (closed[:, 1:] != closed[:, :-1]).sum())
    assert region.sizes["border"] >= changes > 0


def test_border_points_are_the_limits_with_the_other_drive_held() -> None:
    mechanism = five_bar()
    region = ct.reachable_region(mechanism, samples=31)
    for k, held in enumerate(region["second"].to_numpy()):
        if region["status"].to_numpy()[seed(region)[0], k] != ct.Status.OK:
            continue
        found = ct.limits(mechanism, "OA", {"EC": float(held)})
        border = region["border_value"].to_numpy()
        line = np.sort(border[border[:, 1] == held][:, 0])
        low, high = found.interval
        inside = [x for x in (low, high) if region["first"][0] <= x <= region["first"][-1]]
        for value in inside:
            assert np.min(np.abs(line - value)) <= 4 * np.spacing(abs(value))


def slotted_arm() -> ct.Mechanism:
    """A turning arm carries a guide; its slider is tied to the frame by two rods: an angle and a displacement."""
    return ct.Mechanism(
        frame={"points": {"O": [0.0, 0.0], "D": [0.6, 0.0]}},
        links={
            "OK": {"points": {"O": [0.0, 0.0], "K": [0.3, 0.0]}},
            "PQ": {"length": 0.5},
            "DQ": {"length": 0.4},
        },
        guides=[{"point": "P", "on": "OK", "through": [0.0, 0.0], "direction": [1.0, 0.0]}],
        drives=[
            {"link": "OK", "start": 0.3, "speed": 0.4},
            {"guide": "P", "start": 0.3, "speed": 0.02},
        ],
        assembly={"sides": {"Q": "left"}},
    )


def test_an_angle_and_a_displacement() -> None:
    """P = s e^{i a}; it closes where 0.1 <= |P - 0.6| <= 0.9. A half turn of the arm is a change of sign of s."""
    region = ct.reachable_region(slotted_arm(), samples=91)
    angle, way = grid_of(region)
    between = np.abs(way * np.exp(1j * angle) - 0.6)
    clear = np.minimum(np.abs(between - 0.1), np.abs(between - 0.9)) > 16 * EPS
    closed = (between >= 0.1) & (between <= 0.9)
    assert np.array_equal(closed[clear], (region["status"].to_numpy() != ct.Status.OPEN)[clear])
    assert region["second"].attrs["units"] == "m"
    assert region["border_value"].attrs["units"] == "rad m"
    # its range: the limits with the arm at 0.3, and a tenth of their distance beyond
    root = np.sqrt(0.81 - 0.36 * np.sin(0.3) ** 2)
    low, high = 0.6 * np.cos(0.3) + root * np.array([-1.0, 1.0])
    beyond = 0.1 * (high - low)
    assert region["second"].to_numpy()[[0, -1]] == pytest.approx([low - beyond, high + beyond], rel=16 * EPS)


def test_a_motor_between_two_moving_links_as_second_drive() -> None:
    """The rod AB is turned against the crank: C B closes over D where |BD| allows."""
    mechanism = ct.Mechanism(
        frame={"points": {"O": [0.0, 0.0], "D": [1.0, 0.0]}},
        links={"OA": {"length": 0.5}, "AB": {"length": 0.6}, "BC": {"length": 0.7}, "DC": {"length": 0.5}},
        drives=[
            {"link": "OA", "start": 0.5, "speed": 1.0},
            {"link": "AB", "relative_to": "OA", "start": 0.4, "speed": 1.0},
        ],
        assembly={"sides": {"C": "left"}},
    )
    region = ct.reachable_region(mechanism, samples=61)
    first, second = grid_of(region)
    between = np.abs(0.5 * np.exp(1j * first) + 0.6 * np.exp(1j * (first + second)) - 1.0)
    closed = (between >= 0.2) & (between <= 1.2)
    clear = np.minimum(np.abs(between - 0.2), np.abs(between - 1.2)) > 16 * EPS
    assert np.array_equal(closed[clear], (region["status"].to_numpy() != ct.Status.OPEN)[clear])
    held = ct.limits(mechanism, "AB", {"OA": 0.9})
    for value in held.interval:
        reached = abs(0.5 * np.exp(0.9j) + 0.6 * np.exp(1j * (0.9 + value)) - 1.0)
        assert min(abs(reached - 0.2), abs(reached - 1.2)) <= 8 * EPS * 4


def three_cranks() -> ct.Mechanism:
    """A third motor turns the arm on which the second crank stands."""
    return ct.Mechanism(
        frame={"points": {"O": [0.0, 0.0], "H": [1.5, 0.0]}},
        links={
            "HE": {"length": 0.5},
            "OA": {"length": 0.5},
            "AB": {"length": 0.7},
            "CB": {"length": 0.4},
            "EC": {"length": 0.5},
        },
        drives=[
            {"link": "OA", "start": 1.0, "speed": 1.0},
            {"link": "HE", "start": np.pi, "speed": 0.1},
            {"link": "EC", "start": 1.8, "speed": -2.0},
        ],
        assembly={"sides": {"B": "left"}},
    )


def test_two_of_three_drives() -> None:
    """With the arm at its initial place the region is that of the five-bar."""
    three = ct.reachable_region(three_cranks(), ("OA", "EC"), samples=41)
    two = ct.reachable_region(five_bar(), samples=41)
    assert np.array_equal(three["status"], two["status"])
    assert three.attrs["held_HE"] == np.pi
    held = ct.reachable_region(three_cranks(), ("OA", "EC"), samples=41, held={"HE": "170 deg"})
    assert not np.array_equal(held["status"], two["status"])
    turned = ct.reachable_region(three_cranks(), ("EC", "OA"), samples=41)
    assert np.array_equal(turned["status"].to_numpy(), two["status"].to_numpy().T)


def test_everything_is_reached_where_nothing_locks() -> None:
    for name in ("two-link-arm", "five-bar-two-drives"):
        region = ct.reachable_region(ct.example(name), samples=13)
        assert (region["status"] == ct.Status.OK).all()
        assert region.sizes["border"] == 0


WRONG: dict[str, tuple[dict[str, Any], str]] = {
    "unknown": ({"drives": ("OA", "XY")}, "no drive XY"),
    "one": ({"drives": ("OA",)}, "two different drives"),
    "the same": ({"drives": ("OA", "OA")}, "two different drives"),
    "three": ({"drives": ("OA", "EC", "HE")}, "two different drives"),
    "which": ({}, "two different drives; 3 are given; name two of: OA, HE, EC"),
    "range of another": ({"drives": ("OA", "EC"), "ranges": {"HE": (0, 1)}}, "not one of the two"),
    "range elsewhere": ({"drives": ("OA", "EC"), "ranges": {"OA": (2, 3)}}, "hold the initial value, 1"),
    "range of nothing": ({"drives": ("OA", "EC"), "ranges": {"OA": (1, 1)}}, "hold the initial value"),
    "range in metres": ({"drives": ("OA", "EC"), "ranges": {"OA": ("0 m", "2 m")}}, "expected an angle"),
    "no samples": ({"drives": ("OA", "EC"), "samples": 1}, "ask for 2 to"),
    "too many": ({"drives": ("OA", "EC"), "samples": 10**9}, "ask for 2 to"),
    "held and moving": ({"drives": ("OA", "EC"), "held": {"EC": 1.0}}, "the one that moves"),
    "held open": ({"drives": ("OA", "EC"), "held": {"HE": 0.0}}, "does not close there"),
    "not finite": ({"drives": ("OA", "EC"), "held": {"HE": float("nan")}}, "hold HE"),
}


@pytest.mark.parametrize("name", WRONG)
def test_a_region_asked_for_wrongly(name: str) -> None:
    arguments, message = WRONG[name]
    with pytest.raises(ct.InputError, match=message):
        ct.reachable_region(three_cranks(), **arguments)


LIMITS_WRONG: dict[str, tuple[dict[str, Any], str]] = {
    "unknown": ({"drive": "AO"}, "no drive AO"),
    "which": ({}, "say which one moves: OA, EC"),
    "held and moving": ({"drive": "OA", "held": {"OA": 1.0}}, "the one that moves"),
    "held unknown": ({"drive": "OA", "held": {"OX": 1.0}}, "no drive OX"),
    "held in metres": ({"drive": "OA", "held": {"EC": "1 m"}}, "expected an angle"),
    "open": ({"drive": "OA", "held": {"EC": 0.0}, "about": np.pi}, "does not close there"),
    "not finite": ({"drive": "OA", "about": float("inf")}, "about"),
}


@pytest.mark.parametrize("name", LIMITS_WRONG)
def test_limits_asked_for_wrongly(name: str) -> None:
    arguments, message = LIMITS_WRONG[name]
    with pytest.raises(ct.InputError, match=message):
        ct.limits(five_bar(), **arguments)


def test_nodes_on_a_limit_are_not_cut_off() -> None:
    """Ranges with the limits on their grid: between them everything is reached, whatever rounding says of them."""
    excavator = ct.example("excavator-arm")
    pair = ("C-E", "S-N")
    ends = {name: ct.limits(excavator, name).interval for name in pair}
    for beyond in (0.0, 0.1, 0.25):
        spans = {
            name: (low - beyond * (high - low), high + beyond * (high - low))
            for name, (low, high) in ends.items()
        }
        region = ct.reachable_region(excavator, pair, spans, samples=61)
        inside = [
            (region[name].to_numpy() > ends[drive][0] * (1 + 1e-12))
            & (region[name].to_numpy() < ends[drive][1] * (1 - 1e-12))
            for name, drive in zip(("first", "second"), pair, strict=True)
        ]
        status = region["status"].to_numpy()
        assert (status[np.ix_(*inside)] == ct.Status.OK).all()
        assert not (status == ct.Status.CUT_OFF).any()


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
    for v in (1.1, 1.3, 1.5):
        reach = np.sqrt(0.85 - 0.84 * np.cos(v))
        half = np.arccos((0.16 + 1.0 - (reach + 0.5) ** 2) / 0.8)
        low, high = ct.limits(mechanism, "OA", {"CB": v}).interval
        # the limit is found as the place where a curve turns back: to the root of rounding of its arc, squared
        assert (low, high) == pytest.approx((-half, half), abs=1e3 * EPS)
    for a in (0.8, 1.0, 1.2):
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


def test_a_cylinder_has_a_length() -> None:
    excavator = ct.example("excavator-arm")
    for length in (0.0, -1.0):
        with pytest.raises(ct.InputError, match="length above zero"):
            ct.limits(excavator, "K-A", {"C-E": length})
    with pytest.raises(ct.InputError, match="length above zero"):
        ct.reachable_region(excavator, ("K-A", "C-E"), {"K-A": (-1.0, 3.0)})
