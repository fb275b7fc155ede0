"""The reachable region of two drives against the triangles that close or do not."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
import xarray as xr

import centrode as ct
from drives import apart, five_bar, least_and_greatest, three_cranks
from mechanisms import EPS

Array = npt.NDArray[np.float64]


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


def trammel() -> ct.Mechanism:
    """Two sliders on perpendicular guides, both driven, joined by two rods."""
    return ct.Mechanism(
        frame={"points": {"O": [0.0, 0.0]}},
        links={"AC": {"length": 0.9}, "BC": {"length": 0.4}},
        guides=[
            {"point": "A", "on": "frame", "through": "O", "direction": [1.0, 0.0]},
            {"point": "B", "on": "frame", "through": "O", "direction": [0.0, 1.0]},
        ],
        drives=[{"guide": "A", "start": 0.6, "speed": 0.1}, {"guide": "B", "start": 0.5, "speed": -0.1}],
        assembly={"sides": {"C": "left"}},
    )


def test_two_displacements() -> None:
    """A and B are reached in a ring: between the difference and the sum of the rods apart."""
    region = ct.reachable_region(trammel(), samples=101)
    x, y = grid_of(region)
    between = np.hypot(x, y)
    clear = np.minimum(np.abs(between - 0.5), np.abs(between - 1.3)) > 16 * EPS
    closed = (between >= 0.5) & (between <= 1.3)
    status = region["status"].to_numpy()
    assert np.array_equal(closed[clear], (status == ct.Status.OK)[clear])
    assert np.hypot(*region["border_value"].to_numpy().T).min() == pytest.approx(0.5, rel=8 * EPS)
    assert np.hypot(*region["border_value"].to_numpy().T).max() == pytest.approx(1.3, rel=8 * EPS)


def test_two_of_three_drives() -> None:
    """With the arm at its initial place the region is that of the five-bar."""
    three = ct.reachable_region(three_cranks(), ("OA", "EC"), samples=41)
    two = ct.reachable_region(five_bar(), samples=41)
    assert np.array_equal(three["status"], two["status"])
    assert three.attrs["held"] == json.dumps({"HE": np.pi})
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
    "range elsewhere": ({"drives": ("OA", "EC"), "ranges": {"OA": (2, 3)}}, "contain the initial value, 1"),
    "range of nothing": ({"drives": ("OA", "EC"), "ranges": {"OA": (1, 1)}}, "range OA: it is empty"),
    "range in metres": ({"drives": ("OA", "EC"), "ranges": {"OA": ("0 m", "2 m")}}, "expected an angle"),
    "no samples": ({"drives": ("OA", "EC"), "samples": 1}, "give 2 to"),
    "too many": ({"drives": ("OA", "EC"), "samples": 10**9}, "give 2 to"),
    "held and moving": ({"drives": ("OA", "EC"), "held": {"EC": 1.0}}, "the one that moves"),
    "held open": ({"drives": ("OA", "EC"), "held": {"HE": 0.0}}, "does not close there"),
    "far": ({"drives": ("OA", "EC"), "ranges": {"OA": (0, 1e9)}}, "range OA: it is too long: .* 500"),
    "wide": ({"drives": ("OA", "EC"), "ranges": {"OA": (0, 100)}}, "15.9 turns; give at most 10"),
    "not finite": ({"drives": ("OA", "EC"), "held": {"HE": float("nan")}}, "hold HE"),
}


@pytest.mark.parametrize("name", WRONG)
def test_a_region_asked_for_wrongly(name: str) -> None:
    arguments, message = WRONG[name]
    with pytest.raises(ct.InputError, match=message):
        ct.reachable_region(three_cranks(), **arguments)


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


def test_a_cylinder_has_a_length() -> None:
    excavator = ct.example("excavator-arm")
    for length in (0.0, -1.0):
        with pytest.raises(ct.InputError, match="length above zero"):
            ct.limits(excavator, "K-A", {"C-E": length})
    with pytest.raises(ct.InputError, match="length above zero"):
        ct.reachable_region(excavator, ("K-A", "C-E"), {"K-A": (-1.0, 3.0)})
