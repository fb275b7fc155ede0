"""A plate that only guides hold: two of its points move on the axes of the frame, the third in the slot of a crank."""

from __future__ import annotations

import math

import numpy as np
import pytest

import centrode as ct
from mechanisms import EPS, statuses

LENGTH, U, V = 2.0, 0.5, 1.2
"""Distance of the points on the axes; the third point in the plate's axes."""
PIVOT = (-0.4, -0.9)
START = 0.9


def plate_angle(crank: float, side: int) -> float:
    """The third point lies in the line of the slot: a cos + b sin of the plate's angle is c."""
    a = math.sin(crank) * (U - LENGTH) - math.cos(crank) * V
    b = -math.sin(crank) * V - math.cos(crank) * U
    c = math.sin(crank) * PIVOT[0] - math.cos(crank) * PIVOT[1]
    return math.atan2(b, a) + side * math.acos(c / math.hypot(a, b))


def plate(start: float, **angles: float) -> ct.Mechanism:
    axes = {"P": [1, 0], "Q": [0, 1]}
    return ct.Mechanism(
        frame={"points": {"F": list(PIVOT)}},
        links={
            "crank": {"points": {"F": [0, 0]}},
            "plate": {"points": {"P": [0, 0], "Q": [LENGTH, 0], "R": [U, V]}, **angles},
        },
        guides=[
            *({"point": name, "through": [0, 0], "direction": axis} for name, axis in axes.items()),
            {"point": "R", "on": "crank", "through": [0, 0], "direction": [1, 0]},
        ],
        drives=[{"link": "crank", "start": start, "speed": 1.0}],
    )


@pytest.mark.parametrize("side", [1, -1])
def test_the_angle_alone_tells_the_initial_position(side: int) -> None:
    values = np.linspace(START - 0.2, START + 0.2, 5)
    expected = np.array([plate_angle(x, side) for x in values])
    motion = ct.motion(plate(START, angle=round(expected[2], 2)), at=values)
    assert statuses(motion) == ["ok"] * 5
    found = motion.angle.sel(link="plate").values
    slope = np.max(np.abs(motion.angular_velocity_coefficient.sel(link="plate").values))
    assert np.max(np.abs(found - expected)) <= 64.0 * EPS * (1.0 + slope)
    at = motion.position.sel(point="P")
    assert np.max(np.abs(at.sel(axis="x") + LENGTH * np.cos(expected))) <= 64.0 * EPS * LENGTH * (1.0 + slope)


def test_points_that_only_ride_on_the_plate_may_stand_first() -> None:
    held = plate(START, angle=round(plate_angle(START, 1), 2))
    points = {"S": (0.3, -0.2), **dict(held.links["plate"].coordinates)}
    riding = ct.Mechanism(
        frame=held.frame,
        links={"crank": held.links["crank"], "plate": {"points": points, "angle": held.links["plate"].angle}},
        guides=held.guides,
        drives=held.drives,
    )
    one, other = ct.motion(held, at=[START, 1.0]), ct.motion(riding, at=[START, 1.0])
    assert np.max(np.abs(one.angle.values - other.angle.values)) <= 64.0 * EPS


def test_a_plate_whose_slots_pass_pins() -> None:
    """No point of the plate is a hinge: three pins, one of them on a crank, move in three slots of it."""
    places = {"E": (1.5, -0.3), "F": (-0.8, 0.9), "A": (math.cos(START), math.sin(START))}
    headings = {"E": 0.3, "F": 1.4, "A": 2.6}
    mechanism = ct.Mechanism(
        frame={"points": {"O": [0, 0], "E": list(places["E"]), "F": list(places["F"])}},
        links={"OA": {"length": 1}, "plate": {"points": {"Z": [0, 0]}, "angle": 0.01}},
        guides=[
            {"name": p, "point": p, "on": "plate", "through": list(places[p]), "direction": headings[p]}
            for p in places
        ],
        drives=[{"link": "OA", "start": START, "speed": 1.0}],
    )
    values = [START - 0.1, START, START + 0.1]
    motion = ct.motion(mechanism, at=values)
    assert statuses(motion) == ["ok"] * 3
    turn, origin = motion.angle.sel(link="plate").values, motion.position.sel(point="Z").values
    axes = np.exp(1j * turn)
    for pin in places:
        here = np.exp(1j * np.array(values)) if pin == "A" else complex(*places[pin])
        local = (here - origin[:, 0] - 1j * origin[:, 1]) / axes - complex(*places[pin])
        assert np.max(np.abs((local * np.exp(-1j * headings[pin])).imag)) <= 64.0 * EPS
    assert abs(turn[1]) <= 64.0 * EPS and abs(turn[2] - turn[0]) > 0.01


def test_without_an_angle_it_is_asked_for() -> None:
    with pytest.raises(ct.InputError, match="give the initial angle of plate"):
        ct.motion(plate(START), samples=2)
