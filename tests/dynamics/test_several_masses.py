"""Several masses on one link, beside one mass by hand and beside links that are hinged stiffly."""

from __future__ import annotations

import math
import sys
from typing import Any

import numpy as np
import pytest

import centrode as ct
from centrode.dynamics.masses import link_masses, masses_of

EPS = sys.float_info.epsilon
QUANTITIES = ("reduced_inertia", "reduced_moment")


def press(**coupler: Any) -> ct.Mechanism:
    """A four-bar whose coupler carries a plate."""
    return ct.Mechanism(
        gravity=[0, -9.81],
        frame={"points": {"O": [0, 0], "D": [4, 0]}},
        links={
            "OA": {"points": ["O", "A"], "length": 1},
            "AB": {"points": {"A": [0.2, 0.1], "B": [3.7, 0.1], "P": [1, 1]}, **coupler},
            "DB": {"points": ["D", "B"], "length": 3, "mass": 2, "shape": "rod"},
        },
        drives=[{"link": "OA", "start": 1, "speed": 2}],
        assembly={"sides": {"B": "left"}},
    )


PARTS = [
    {"mass": 2.0, "at": "P"},
    {"mass": 0.5, "at": [1.5, -0.2], "inertia": 0.02},
    {"mass": 1.5, "at": "B", "inertia": 0.1},
]
PLACES = [(1.0, 1.0), (1.5, -0.2), (3.7, 0.1)]


def by_hand(masses: list[float], places: list[tuple[float, float]], own: list[float]) -> dict[str, Any]:
    """Sum, centre, and inertia by parallel axes."""
    whole = math.fsum(masses)
    x = math.fsum(m * place[0] for m, place in zip(masses, places, strict=True)) / whole
    y = math.fsum(m * place[1] for m, place in zip(masses, places, strict=True)) / whole
    spread = [m * ((p[0] - x) ** 2 + (p[1] - y) ** 2) for m, p in zip(masses, places, strict=True)]
    return {"mass": whole, "centre": [x, y], "inertia": math.fsum([*own, *spread])}


@pytest.mark.parametrize("own", [None, {"mass": 3, "centre": [0.9, 0.3], "inertia": 0.4}])
def test_several_masses_are_one(own: dict[str, Any] | None) -> None:
    masses, places, inertias = [2.0, 0.5, 1.5], list(PLACES), [0.0, 0.02, 0.1]
    if own is not None:
        masses, places, inertias = [3.0, *masses], [(0.9, 0.3), *places], [0.4, *inertias]
    several, single = press(masses=PARTS, **(own or {})), press(**by_hand(masses, places, inertias))
    one, other = masses_of(several)[0], masses_of(single)[0]
    assert float(one.mass) == pytest.approx(other.mass, rel=4 * EPS)
    assert float(one.moment_of_inertia) == pytest.approx(other.moment_of_inertia, rel=16 * EPS)
    found, expected = (ct.reduce(mechanism, 25) for mechanism in (several, single))
    for name in QUANTITIES:
        size = np.abs(expected[name].values).max()
        assert found[name].values == pytest.approx(expected[name].values, rel=0, abs=64 * EPS * size)
    forces = [ct.reactions(mechanism, 5).joint_force.values for mechanism in (several, single)]
    assert forces[0] == pytest.approx(
        forces[1], rel=0, abs=1e3 * EPS * np.nanmax(np.abs(forces[1])), nan_ok=True
    )


def test_two_masses_at_the_ends_are_a_dumbbell() -> None:
    mass = masses_of(press(masses=[{"mass": 1, "at": "A"}, {"mass": 3, "at": "B"}]))[0]
    # of m1 and m2 the distance l apart it is m1 m2 l^2 / (m1 + m2)
    assert float(mass.moment_of_inertia) == pytest.approx(3 / 4 * 3.5**2, rel=8 * EPS)


def test_masses_are_written_as_they_are_read_and_shown() -> None:
    mechanism = press(masses=PARTS)
    assert ct.parse_mechanism(ct.mechanism_text(mechanism)) == mechanism
    assert [mass.link for mass in link_masses(mechanism).masses] == ["AB", "DB"]


@pytest.mark.parametrize(
    ("masses", "message"),
    [
        ([{"mass": 1}], "at"),
        ([{"mass": -1, "at": "A"}], "negative"),
        ([{"mass": 1, "at": "Q"}], '"Q"'),
        ({"mass": 1, "at": "A"}, "list"),
    ],
)
def test_masses_that_cannot_be(masses: Any, message: str) -> None:
    with pytest.raises(ct.InputError, match=message):
        press(masses=masses)
