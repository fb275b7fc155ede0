"""Groups behind a change point: chains of parallelograms, change points close together, limits close by."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from itertools import pairwise

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


LONG = 60
"""Linkages in a row: by boxes about each point the bound of rounding grew by 5.7 from one to the next."""
ROUNDING = 64 * 2.0**-52
"""What one linkage may add to the angle of the next, where nothing magnifies it."""


def in_a_row(
    pivots: Sequence[float], cranks: Sequence[float], couplers: Sequence[float], turns: Sequence[float]
) -> ct.Mechanism:
    """Four-bar linkages in a row on pivots in line, each turning the crank of the next; `turns` are those at first."""
    ends = [x + length * cmath.exp(1j * turn) for x, length, turn in zip(pivots, cranks, turns, strict=True)]
    links: dict[str, dict[str, object]] = {
        f"c{i}": {"points": [f"D{i}", f"A{i}"], "length": length, "angle": turn}
        for i, (length, turn) in enumerate(zip(cranks, turns, strict=True))
    }
    for i, (length, (first, last)) in enumerate(zip(couplers, pairwise(ends), strict=True)):
        angle = cmath.phase(last - first)
        links[f"k{i}"] = {"points": [f"A{i}", f"A{i + 1}"], "length": length, "angle": angle}
    return ct.Mechanism(
        frame={"points": {f"D{i}": [x, 0.0] for i, x in enumerate(pivots)}},
        links=links,
        drives=[{"link": "c0", "start": turns[0], "speed": 1.0}],
    )


def freudenstein(crank: float, coupler: float, rocker: float, base: float, turn: float) -> float:
    """Angle of the rocker of an open linkage: K1 cos(psi) - K2 cos(phi) + K3 = cos(phi - psi), as a quadratic.

    Freudenstein, An analytical approach to the design of four-link mechanisms (1954); the unknown is tan(psi / 2).
    """
    k1, k2 = base / crank, base / rocker
    k3 = (crank**2 - coupler**2 + rocker**2 + base**2) / (2.0 * crank * rocker)
    a = math.cos(turn) * (1.0 - k2) - k1 + k3
    b = -2.0 * math.sin(turn)
    c = k1 + k3 - (1.0 + k2) * math.cos(turn)
    return 2.0 * math.atan2(-b - math.sqrt(b * b - 4.0 * a * c), 2.0 * a)


@pytest.mark.parametrize("seed", range(few(1, 5)))
def test_many_parallelograms_in_a_row_turn_as_their_crank(seed: int) -> None:
    random = np.random.default_rng(seed)
    mechanism = chain(random.uniform(0.5, 1.5), random.uniform(0.5, 3.0, LONG), random.uniform(0.8, 2.0))
    turns = np.linspace(0.7, 2.3, 5)
    motion = ct.motion(mechanism, at=turns)
    assert (motion.status == ct.Status.OK).all()
    for i in range(LONG):
        assert np.abs(motion.angle.sel(link=f"c{i + 1}") - turns).max() < ROUNDING * (i + 1)


def test_parallelograms_fill_a_description() -> None:
    """As many as a description holds links for."""
    assert ct.check(chain(1.0, [2.0] * 99, 1.0)).mobility == 1


def test_many_parallelograms_pass_their_change_points_together() -> None:
    """Those of all linkages lie in one place; what one loses beside it the next shall not multiply."""
    count = 20
    turns = np.linspace(math.pi - 0.03, math.pi + 0.03, 9)
    motion = ct.motion(chain(1.0, [2.0] * count, 1.0), at=turns)
    assert (motion.status == ct.Status.OK).all()
    for i in range(count):
        assert np.abs(motion.angle.sel(link=f"c{i + 1}") - turns).max() < CLOSE * (i + 1)


@pytest.mark.parametrize("ulps", [-1, 8])
def test_parallelograms_whose_couplers_are_off_by_rounding(ulps: int) -> None:
    """Each is a few units of the last place from a change point that it does not have, or from one it cannot pass."""
    turns = np.linspace(0.7, 2.3, 5)
    coupler = 2.0 + ulps * np.spacing(2.0)
    pivots = [2.0 * i for i in range(LONG + 1)]
    mechanism = in_a_row(pivots, [1.0] * (LONG + 1), [coupler] * LONG, [1.0] * (LONG + 1))
    motion = ct.motion(mechanism, at=turns)
    assert (motion.status == ct.Status.OK).all()
    for i in range(LONG):
        # to first order a coupler longer by e turns each rocker by e / (r sin(phi)) less than its crank
        truth = turns - (i + 1) * (coupler - 2.0) / np.sin(turns)
        assert np.abs(motion.angle.sel(link=f"c{i + 1}") - truth).max() < ROUNDING * (i + 1)


def test_many_drag_links_in_a_row_follow_freudenstein() -> None:
    """Linkages that are no parallelograms: the equation of each, solved from the angle before."""
    random = np.random.default_rng(3)
    cranks = random.uniform(2.0, 2.2, LONG + 1)
    couplers, bases = random.uniform(2.0, 2.3, LONG), random.uniform(0.3, 0.6, LONG)
    pivots = np.concatenate([[0.0], np.cumsum(bases)])

    def angles(turn: float) -> list[float]:
        found = [turn]
        for i in range(LONG):
            sides = cranks[i], couplers[i], cranks[i + 1], bases[i]
            found.append(freudenstein(*sides, found[-1]))
        return found

    mechanism = in_a_row(pivots.tolist(), cranks.tolist(), couplers.tolist(), angles(1.0))
    turns = np.linspace(0.0, 2.0 * math.pi, 7)
    motion = ct.motion(mechanism, at=turns)
    assert (motion.status == ct.Status.OK).all()
    truth = np.array([angles(turn) for turn in turns])
    # the rates tell how much of an error each linkage passes on
    steps = np.array([angles(turn + 1e-6) for turn in turns])
    rates = np.abs(np.remainder(steps - truth + math.pi, 2.0 * math.pi) - math.pi) / 1e-6
    for i in range(1, LONG + 1):
        found = motion.angle.sel(link=f"c{i}").to_numpy()
        apart = np.abs(np.remainder(found - truth[:, i] + math.pi, 2.0 * math.pi) - math.pi)
        magnified = rates[:, i] * np.sum(1.0 / rates[:, : i + 1], axis=1)
        assert (apart < 4.0 * ROUNDING * magnified).all()


def test_many_antiparallelograms_in_a_row() -> None:
    """tan(psi / 2) = -(d + a) / (d - a) tan(phi / 2), there and back: the next linkage stands the other way round."""
    random = np.random.default_rng(5)
    count, crank = 40, 1.0
    bases = random.uniform(1.6, 2.4, count) * np.where(np.arange(count) % 2, -1.0, 1.0)
    factors = -(bases + crank) / (bases - crank)
    pivots = np.concatenate([[0.0], np.cumsum(bases)])
    halves = np.concatenate([[1.0], np.cumprod(factors)])

    def angles(turn: float) -> np.ndarray:
        return np.asarray(2.0 * np.arctan(halves * math.tan(0.5 * turn)))

    mechanism = in_a_row(pivots.tolist(), [crank] * (count + 1), np.abs(bases).tolist(), angles(1.0).tolist())
    turns = np.linspace(0.7, 1.6, 5)
    motion = ct.motion(mechanism, at=turns)
    assert (motion.status == ct.Status.OK).all()
    truth = np.array([angles(turn) for turn in turns])
    rates = np.abs(np.sin(truth) / np.sin(turns)[:, None])
    for i in range(1, count + 1):
        apart = np.abs(motion.angle.sel(link=f"c{i}").to_numpy() - truth[:, i])
        magnified = rates[:, i] * np.sum(1.0 / rates[:, : i + 1], axis=1)
        assert (apart < 4.0 * ROUNDING * magnified).all()
