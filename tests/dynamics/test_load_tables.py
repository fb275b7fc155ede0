"""Tables of loads over the stroke, the drive and time, beside the same loads given in other ways."""

from __future__ import annotations

import math
import sys
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

import centrode as ct
from centrode.dynamics.strokes import ends_of_stroke

EPS = sys.float_info.epsilon
RADIUS, ROD = 0.045, 0.16
AREA = math.pi * 0.09**2 / 4


def engine(
    *loads: dict[str, Any], machine: dict[str, Any] | None = None, speed: float = -20.0, rod: float = ROD,
    **given: Any,
) -> ct.Mechanism:  # fmt: skip
    """A crank and a piston on the x axis, at crank angle 0 farthest from the crank."""
    given |= {} if machine is None else {"machine": machine}
    return ct.Mechanism(
        frame={"points": {"O": [0, 0]}},
        links={
            "crank": {"points": {"O": [0, 0], "A": [RADIUS, 0]}},
            "rod": {"points": {"A": [0, 0], "B": [rod, 0]}},
            "piston": {"points": ["B"], "mass": 0.5},
        },
        guides=[{"point": "B", "on": "frame", "through": [0, 0], "direction": [1, 0], "link": "piston"}],
        drives=[{"link": "crank", "start": 0, "speed": speed}],
        assembly={"sides": {"B": "ahead"}},
        loads=list(loads),
        **given,
    )


def along(**given: Any) -> dict[str, Any]:
    return {"kind": "force", "guide": "B", **given}


def moments(mechanism: ct.Mechanism, at: np.ndarray) -> np.ndarray:
    return np.asarray(ct.reduce(mechanism, at=at).reduced_moment.values)


CRANK = np.radians(np.arange(1.0, 360.0, 7.0))


def slide(phi: np.ndarray) -> np.ndarray:
    return RADIUS * np.cos(phi) + np.sqrt(ROD**2 - (RADIUS * np.sin(phi)) ** 2)


def slide_rate(phi: np.ndarray) -> np.ndarray:
    sine, cosine = np.sin(phi), np.cos(phi)
    return -RADIUS * sine - RADIUS**2 * sine * cosine / np.sqrt(ROD**2 - (RADIUS * sine) ** 2)


def test_the_ends_of_a_stroke_are_those_of_the_dead_points() -> None:
    found = ends_of_stroke(engine(along(value=1)), "B", "")
    assert found == pytest.approx((ROD - RADIUS, ROD + RADIUS), rel=8 * EPS)


def test_a_table_over_the_stroke_is_one_over_the_displacement() -> None:
    rows = [[0, 100, 20], [0.25, 300, -50], [1, 500, 80]]
    share = engine(along(over="stroke", table=rows))
    low, stroke = ROD - RADIUS, 2 * RADIUS
    written = engine(along(table=[[low + row[0] * stroke, *row[1:]] for row in rows]))
    # the displacement is rounded, and the greatest slope of the table is 800 N over the stroke
    assert moments(share, CRANK) == pytest.approx(moments(written, CRANK), rel=0, abs=64 * EPS * 800)


def test_a_stroke_measured_from_its_other_end() -> None:
    """From the outer dead point the piston goes there as its displacement falls."""
    rows = [[0, 100, 20], [0.25, 300, -50], [1, 500, 80]]
    found = moments(engine(along(over="stroke", measured_from="greatest", table=rows)), CRANK)
    share = (ROD + RADIUS - slide(CRANK)) / (2 * RADIUS)
    at, there, back = np.array(rows).T
    # the crank turns clockwise: from 180 to 0 deg the piston goes outwards, which is back
    force = np.where(math.pi < CRANK, np.interp(share, at, there), np.interp(share, at, back))
    assert found == pytest.approx(force * slide_rate(CRANK), rel=0, abs=1e3 * EPS * 800)


FOUR_STROKE = [[0, 0.02], [180, 0.02], [340, 0.4], [375, 1.0], [420, 0.3], [540, 0.06], [720, 0.02]]


def indicator() -> dict[str, Any]:
    rows = [[f"{angle} deg", share] for angle, share in FOUR_STROKE]
    return along(over="drive", pressure="-4 MPa", diameter="90 mm", table=rows)


def test_an_indicator_diagram_of_four_strokes() -> None:
    """p(phi)/p_max on a piston of 90 mm, against the displacement; the rows repeat after two turns."""
    phi = np.concatenate([CRANK, CRANK + math.tau, CRANK - 4 * math.tau])
    angle, share = np.array(FOUR_STROKE).T
    pressure = -4e6 * np.interp(np.degrees(np.mod(phi, 2 * math.tau)), angle, share)
    expected = pressure * AREA * slide_rate(phi)
    assert moments(engine(indicator()), phi) == pytest.approx(
        expected, rel=0, abs=1e4 * EPS * 4e6 * AREA * RADIUS
    )


def test_the_stroke_of_a_drive_that_does_not_turn_fully_is_that_of_the_range() -> None:
    """A rod shorter than the crank: between -0.5 and 0.4 rad the piston goes from the farther end to the dead point."""
    load = along(table=[[0.0, 1.0], [1.0, 3.0]], over="stroke")
    with pytest.raises(
        ct.InputError, match=r"does not turn fully; give the range of the motion in \[study\]"
    ):
        ct.reduce(engine(load, rod=0.04), at=[0.1])
    ranged = engine(load, rod=0.04, speed=1.0, study={"from": -0.5, "to": 0.4})
    least, greatest = ends_of_stroke(ranged, "B", "")
    ends = [
        RADIUS * math.cos(phi) + math.sqrt(0.04**2 - (RADIUS * math.sin(phi)) ** 2) for phi in (-0.5, 0.0)
    ]
    assert [least, greatest] == pytest.approx(ends, rel=64 * EPS)
    here = RADIUS * math.cos(0.1) + math.sqrt(0.04**2 - (RADIUS * math.sin(0.1)) ** 2)
    share = (here - least) / (greatest - least)
    (slope,) = ct.motion(ranged, at=[0.1]).slide_velocity_coefficient.values.ravel()
    assert float(moments(ranged, np.array([0.1]))[0]) == pytest.approx((1 + 2 * share) * slope, rel=1e-12)


def test_a_machine_of_four_strokes_has_a_cycle_of_two_turns() -> None:
    """The mean driving moment takes the work of the gas: the integral of p dV over both turns."""
    machine = {"mean_speed": 150, "fluctuation": 0.05}
    load = indicator()  # a compressor: the crank turns clockwise, so that the gas resists
    steady = ct.steady_motion(engine(load, machine=machine), 5)
    turned = steady.drive_value.values.ravel()
    assert abs(turned[-1] - turned[0]) == pytest.approx(4 * math.pi, rel=8 * EPS)
    angle, share = np.array(FOUR_STROKE).T
    x, weights = np.polynomial.legendre.leggauss(40)
    work = 0.0
    edges = np.unique(np.concatenate([np.radians(angle), np.arange(0.0, 4.1 * math.pi, math.pi / 2)]))
    edges = edges[edges <= 4 * math.pi + 1e-12]
    for low, high in pairwise(edges):
        phi = 0.5 * (low + high) + 0.5 * (high - low) * x
        force = -4e6 * AREA * np.interp(np.degrees(phi), angle, share)
        work += 0.5 * (high - low) * float(weights @ (force * slide_rate(phi)))
    wheel = ct.flywheel(engine(load, machine=machine))
    # the crank turns clockwise: the work of the load over a cycle is minus the integral over growing angles, and the
    # moment that makes up for it acts clockwise
    assert wheel.driving_moment == pytest.approx(-work / (4 * math.pi), rel=1e-11)


def test_a_torque_over_the_drive_is_its_formula() -> None:
    rows = [["0 deg", 1.0], ["90 deg", 4.0], ["360 deg", 1.0]]
    table = engine({"kind": "torque", "link": "crank", "table": rows})
    expected = np.interp(np.degrees(CRANK), [0, 90, 360], [1, 4, 1])
    assert moments(table, CRANK) == pytest.approx(expected, rel=0, abs=64 * EPS * 4)
    jumps = ct.reduce(table, samples=3).jumps.values
    assert np.degrees(np.mod(jumps, math.tau)) == pytest.approx([90.0], rel=8 * EPS)


def test_a_table_over_time_is_one_over_the_drive_at_constant_speed() -> None:
    """At -20 rad/s a turn takes 0.314 s."""
    rows = [[0, 10.0], [0.05, 60.0], [0.4, -10.0]]
    by_time = engine(along(over="time", table=rows))
    by_drive = engine(along(over="drive", table=[[-20 * time, force] for time, force in reversed(rows)]))
    at = -CRANK
    assert moments(by_time, at) == pytest.approx(moments(by_drive, at), rel=0, abs=64 * EPS * 1000)
    late = engine(along(over="time", table=rows[:2]))
    with pytest.raises(ct.InputError, match=r"its table lies between 0 and 0\.05, and its load is needed at"):
        moments(late, at)


def test_a_table_is_simulated() -> None:
    """From rest a crank with a flywheel under a torque by table gains the work of it."""
    rows = [["-360 deg", 2.0], ["-200 deg", 3.0], ["0 deg", 2.0]]
    mechanism = ct.Mechanism(
        frame={"points": {"O": [0, 0]}},
        links={"crank": {"points": {"O": [0, 0], "A": [1, 0]}, "inertia": 0.5, "mass": 1, "centre": "O"}},
        drives=[{"link": "crank", "start": 0, "speed": 1}],
        loads=[{"kind": "torque", "link": "crank", "table": rows}],
        simulation={"duration": 2.0, "samples": 21, "tolerance": 1e-11},
    )
    found = ct.simulate(mechanism)
    value, speed = found.drive_value.values.ravel(), found.drive_speed.values.ravel()
    grid = np.linspace(0.0, value.max(), 200_001)
    torque = np.interp(np.mod(np.degrees(grid), 360.0), [0, 160, 360], [2, 3, 2])
    work = np.concatenate([[0.0], np.cumsum(0.5 * (torque[1:] + torque[:-1]) * np.diff(grid))])
    assert 0.25 * speed**2 == pytest.approx(np.interp(value, grid, work), rel=1e-8, abs=1e-8)


REFUSED = [
    (along(over="stroke", table=[[0.1, 1], [1, 2]]), "begins at 0 and ends at 1"),
    (along(over="turn", table=[[0, 1], [1, 2]]), '"turn"'),
    (along(over="drive", table=[[1, 1], [0, 2]]), "first numbers that increase"),
    (along(over="drive", table=[[0, 1, 2], [1, 2, 3]]), r"\[drive, force\]"),
    (along(value=3, over="drive"), '"over" is used with a table only'),
    (
        along(over="drive", measured_from="least", table=[[0, 1], [1, 2]]),
        "measured_from is used with a table over the",
    ),
    (along(pressure="4 MPa", table=[[0, 1], [1, 2]]), "diameter"),
    ({"kind": "torque", "link": "crank"}, "one of"),
    (
        {"kind": "torque", "link": "crank", "over": "stroke", "table": [[0, 1], [1, 2]]},
        "the table of a torque is over",
    ),
    ({"kind": "force", "point": "B", "vector": [1, 0], "pressure": 3.0}, "with a force along a guide only"),
]


@pytest.mark.parametrize(("load", "message"), REFUSED)
def test_tables_that_cannot_be(load: dict[str, Any], message: str) -> None:
    with pytest.raises(ct.InputError, match=message):
        engine(load)


def test_tables_are_written_as_they_are_read() -> None:
    loads = [indicator(), along(over="stroke", measured_from="greatest", table=[[0, 1, 2], [1, 2, 3]])]
    mechanism = engine(*loads, {"kind": "torque", "link": "crank", "over": "time", "table": [[0, 1], [1, 2]]})
    assert ct.parse_mechanism(ct.mechanism_text(mechanism)) == mechanism
