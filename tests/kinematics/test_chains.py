"""Groups behind a change point: chains of parallelograms, change points close together, limits close by."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import pytest

import centrode as ct
from samples import few

# Next to a change point angles were measured exact to 3e-13; a chain adds up what its groups lose.
CLOSE = 2e-12


def chain(crank: float, gaps: Sequence[float], start: float, speed: float = 1.0) -> ct.Mechanism:
    """Equal cranks on fixed pivots in line, joined by couplers as long as the gaps between the pivots."""
    pivots = np.concatenate([[0.0], np.cumsum(gaps)])
    links: dict[str, dict[str, object]] = {"c0": {"points": ["D0", "A0"], "length": crank}}
    for i, gap in enumerate(gaps):
        links[f"k{i}"] = {"points": [f"A{i}", f"A{i + 1}"], "length": gap, "angle": 0.0}
        links[f"c{i + 1}"] = {"points": [f"D{i + 1}", f"A{i + 1}"], "length": crank, "angle": start}
    return ct.Mechanism(
        frame={"points": {f"D{i}": [x, 0.0] for i, x in enumerate(pivots.tolist())}},
        links=links,
        drives=[{"link": "c0", "start": start, "speed": speed}],
    )


@pytest.mark.parametrize("seed", range(few(5, 25)))
def test_chains_of_parallelograms_stay_parallel(seed: int) -> None:
    """All change points of all groups lie at the same values of the drive; every crank turns like the first."""
    random = np.random.default_rng(seed)
    count = int(random.integers(2, 6))
    mechanism = chain(random.uniform(0.3, 1.5), random.uniform(0.5, 3.0, count), random.uniform(0.3, 2.8))
    motion = ct.motion(mechanism, samples=73)
    assert (motion.status == ct.Status.OK).all()
    for i in range(count):
        error = np.abs(motion.angle.sel(link=f"c{i + 1}") - motion.drive_value[:, 0])
        assert error.max() < CLOSE * 2**count
    assert motion.sizes["event"] == 2 * count


def test_change_points_close_together_do_not_depend_on_the_range() -> None:
    """Two parallelograms whose change points lie 0.05 rad apart, asked for up to the first and beyond the second."""
    apart = 0.05
    mechanism = ct.Mechanism(
        frame={"points": {"O": [0, 0], "D": [2, 0], "E": [2 + 1.7 * math.cos(apart), 1.7 * math.sin(apart)]}},
        links={
            "OA": {"length": 1}, "AB": {"length": 2, "angle": 0.0}, "DB": {"length": 1, "angle": 1.0},
            "BC": {"length": 1.7, "angle": apart}, "EC": {"length": 1, "angle": 1.0},
        },
        drives=[{"link": "OA", "start": 1.0, "speed": 1}],
    )  # fmt: skip
    places = np.linspace(math.pi - 0.03, math.pi + 0.011, 9)
    near = ct.motion(mechanism, at=places)
    far = ct.motion(mechanism, at=[*places, math.pi + 0.5])
    assert np.abs(near.angle.sel(link="EC") - places).max() < 4 * CLOSE
    assert np.array_equal(near.position, far.position[:-1])


def test_a_redundant_link_that_does_not_fit_opens_its_mechanism() -> None:
    motion = ct.motion(
        ct.example("three-crank-parallelogram"), samples=9, vary={"links.FE.length": [1.0, 1.2]}
    )
    assert (motion.status[0] == ct.Status.OK).all()
    assert (motion.status[1] == ct.Status.OPEN).all()
    assert np.isnan(motion.position[1]).all()


@pytest.mark.parametrize("start", [0.01, 0.05, 0.1, 0.12, math.pi - 0.05, math.pi - 0.1, math.pi - 0.3])
def test_an_overconstrained_mechanism_moves_from_anywhere(start: float) -> None:
    """Also next to its change points, behind which the other assembly does not fit."""
    links = {
        "OA": {"length": 1, "angle": start}, "DB": {"length": 1, "angle": start},
        "FE": {"length": 1, "angle": start},
        "coupler": {"points": {"A": [0, 0], "B": [2, 0], "E": [0.8, 0]}, "angle": 0.0},
    }  # fmt: skip
    mechanism = ct.Mechanism(
        frame={"points": {"O": [0, 0], "D": [2, 0], "F": [0.8, 0]}},
        links=links,
        drives=[{"link": "OA", "speed": 1}],
    )
    assert ct.check(mechanism).mobility == 1
