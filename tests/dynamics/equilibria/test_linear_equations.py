"""The linearised equations against differences of 50 digits, and their eigenvalues against mpmath."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from mpmath import mp, mpf

import centrode as ct
from centrode.dynamics.equilibria.equilibrium_search import approached_positions, settled_equilibria
from centrode.dynamics.equilibria.linear_equations import LoadedMechanism, loaded_mechanism
from centrode.dynamics.equilibria.small_motions import small_motions
from free_motions import DOUBLE_PENDULUM, FIVE_BAR
from sprung import SLIDER, SPHERE, SPRUNG_FOUR_BAR

DIGITS, STEP = 50, mpf(10) ** -15
CASES = {
    "double pendulum": DOUBLE_PENDULUM,
    "five-bar": FIVE_BAR,
    "four-bar": SPRUNG_FOUR_BAR,
    "slider": SLIDER,
    "sphere": SPHERE,
}


@pytest.fixture(autouse=True)
def many_digits() -> Any:
    with mp.workdps(DIGITS):
        yield


def left_over(loaded: LoadedMechanism, q: list[Any], v: list[Any], reactions: list[Any]) -> list[Any]:
    """F - G' lambda by the terms of the equations of motion over numbers of many digits."""
    equations = loaded.equations
    terms = equations.terms(mp, equations.tree.values(mp, q), v, mpf(0))
    found = [terms.force.get(i, mpf(0)) for i in range(loaded.size)]
    for row, size in zip(terms.rows, reactions, strict=True):
        for i, x in row.items():
            found[i] = found[i] - x * size
    return found


def differences(function: Any, at: list[Any]) -> Any:
    """Columns of central differences; their error of the order STEP squared is nothing to a float."""
    columns = []
    for k in range(len(at)):
        ahead, behind = ([x + sense * STEP * (i == k) for i, x in enumerate(at)] for sense in (1, -1))
        pairs = zip(function(ahead), function(behind), strict=True)
        columns.append([(a - b) / (2 * STEP) for a, b in pairs])
    return np.array(columns, dtype=object).T


@pytest.mark.parametrize("name", CASES)
def test_stiffness_and_damping_are_those_of_differences(name: str) -> None:
    loaded = loaded_mechanism(ct.parse_mechanism(CASES[name]).with_drives_held())
    generator = np.random.default_rng(5)
    # nothing has to close for derivatives to be right
    q = loaded.position.coordinates + generator.uniform(-0.1, 0.1, loaded.size)
    v, reactions = generator.uniform(-1, 1, loaded.size), generator.uniform(-3, 3, loaded.equations.equations)
    found = loaded.at(q[None], reactions[None], v[None])
    exact_q, exact_v, sizes = ([mpf(float(x)) for x in row] for row in (q, v, reactions))
    stiffness = differences(lambda at: left_over(loaded, at, exact_v, sizes), exact_q)
    damping = differences(lambda at: left_over(loaded, exact_q, at, sizes), exact_v)
    for mine, other in ((found.stiffness[0], -stiffness), (found.damping[0], -damping)):
        scale = max(1.0, float(np.max(np.abs(mine))))
        # some hundred operations of which each rounds
        assert np.max(np.abs(mine - other.astype(float))) < 200 * np.finfo(float).eps * scale


@pytest.mark.parametrize("name", CASES)
def test_eigenvalues_are_those_of_mpmath(name: str) -> None:
    loaded = loaded_mechanism(ct.parse_mechanism(CASES[name]).with_drives_held())
    places = settled_equilibria(loaded, approached_positions(loaded, loaded.position.coordinates[None]))
    (motions,) = small_motions(loaded, places)
    count = len(motions.mass)
    mass, damping, stiffness = (
        mp.matrix(m.tolist()) for m in (motions.mass, motions.damping, motions.stiffness)
    )
    whole = mp.matrix(2 * count, 2 * count)
    for part, first in ((-(mass**-1) * stiffness, 0), (-(mass**-1) * damping, count)):
        for i in range(count):
            whole[i, count + i] = mpf(1)
            for j in range(count):
                whole[count + i, first + j] = part[i, j]
    exact = [complex(x) for x in mp.eig(whole, left=False, right=False) if x.imag >= -(mpf(10) ** -30)]
    assert len(motions.eigenvalues) == len(exact)
    largest = max(abs(x) for x in exact)
    for mine in motions.eigenvalues:
        # of a simple eigenvalue; the condition of these small matrices stays below some thousands
        assert min(abs(mine - x) for x in exact) < 1e-11 * largest


def test_many_states_are_those_of_each() -> None:
    loaded = loaded_mechanism(ct.parse_mechanism(FIVE_BAR).with_drives_held())
    generator = np.random.default_rng(6)
    places = loaded.position.coordinates + generator.uniform(-0.2, 0.2, (5, loaded.size))
    together = loaded.at(places)
    for k, place in enumerate(places):
        alone = loaded.at(place[None])
        assert np.allclose(together.stiffness[k], alone.stiffness[0], rtol=0, atol=1e-12)


def test_closing_keeps_what_closes_and_marks_what_does_not() -> None:
    loaded = loaded_mechanism(ct.parse_mechanism(FIVE_BAR).with_drives_held())
    far = loaded.position.coordinates + np.array([0.0, 0.0, 0.3, 0.0])
    closed = loaded.closed_coordinates(np.array([loaded.position.coordinates, far]))
    assert np.max(np.abs(closed[0] - loaded.position.coordinates)) < 1e-14
    left, _rows = loaded.closures_at(closed)
    assert np.nanmax(np.abs(left)) < 1e-14
