"""L D L' in straight lines against a library, and what it fills."""

from __future__ import annotations

import numpy as np
import pytest

from centrode.dynamics.forward_dynamics.elimination import Elimination, order_of_least_degree

EPS = 2.0**-52


@pytest.mark.parametrize("size", [1, 4, 9])
def test_solutions_are_those_of_a_library(size: int) -> None:
    random = np.random.default_rng(size)
    whole = random.normal(size=(size, size)) * (random.random((size, size)) < 0.5)
    matrix = whole @ whole.T + np.eye(size)
    right = random.normal(size=size)
    entries = {(i, j): float(matrix[i, j]) for i in range(size) for j in range(i + 1)}
    found = Elimination.of(size, entries).solve(dict(enumerate(map(float, right))))
    bound = 64 * size * EPS * np.linalg.cond(matrix)
    assert np.allclose(
        [found.get(k, 0.0) for k in range(size)], np.linalg.solve(matrix, right), rtol=bound, atol=bound
    )


def test_products_between_solved_rows_are_those_with_the_inverse() -> None:
    random = np.random.default_rng(3)
    whole = random.normal(size=(5, 5))
    matrix, rows = whole @ whole.T + np.eye(5), random.normal(size=(2, 5))
    entries = {(i, j): float(matrix[i, j]) for i in range(5) for j in range(i + 1)}
    elimination = Elimination.of(5, entries)
    one, other = (elimination.forward(dict(enumerate(map(float, row)))) for row in rows)
    expected = rows[0] @ np.linalg.solve(matrix, rows[1])
    assert abs(elimination.product(one, other) - expected) <= 1e3 * EPS * abs(expected) * np.linalg.cond(
        matrix
    )


def test_a_tree_fills_nothing_and_a_chain_of_loops_stays_a_band() -> None:
    """A star eliminated from its centre would fill everything; from its leaves it fills nothing."""
    star = {(k, 0): 1.0 for k in range(1, 30)} | {(k, k): 40.0 for k in range(30)}
    assert sum(map(len, Elimination.of(30, star).columns.values())) == 29
    band = {(k, k): 4.0 for k in range(30)} | {(k, k - 1): 1.0 for k in range(1, 30)}
    assert sum(map(len, Elimination.of(30, band).columns.values())) == 29
    assert sorted(order_of_least_degree(30, set(star))) == list(range(30))
