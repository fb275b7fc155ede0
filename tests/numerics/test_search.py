"""Roots and extremes against polynomials with known roots, mpmath, and dense sampling."""

import math
from collections.abc import Callable

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from centrode.numerics.search import (
    PARTS,
    bisect,
    crossing_brackets,
    extremes,
    foretold_brackets,
    interpolated_roots,
    maxima_between,
    newton_roots,
    root,
    roots,
    sign_changes,
    tops,
    zero_between,
)

EPS = 2.0**-52


def with_roots(places):
    """A polynomial with known simple roots, by its factors: its sign is exact, and so is its zero."""

    def value(x):
        return np.prod(x[..., None] - np.asarray(places), axis=-1)

    def slope(x):
        rest = [np.delete(places, k) for k in range(len(places))]
        return sum(np.prod(x[..., None] - one, axis=-1) for one in rest)

    return value, slope


def apart(places, least):
    """Sorted places of which neighbours are at least so far apart."""
    kept = []
    for place in sorted(places):
        if not kept or place - kept[-1] >= least:
            kept.append(place)
    return np.array(kept)


places_of_roots = st.lists(st.floats(-3.0, 3.0), min_size=1, max_size=7).map(lambda one: apart(one, 0.1))


@given(places_of_roots)
def test_roots_of_a_product_of_factors(places):
    value, slope = with_roots(places)
    nodes = np.linspace(-3.5, 3.5, 351)  # no cell of 0.02 holds two roots
    tolerance = 4.0 * EPS * 3.5
    found = roots(value, nodes)
    assert len(found) == len(places)
    assert np.abs(found - places).max() <= tolerance
    low, high = crossing_brackets(nodes, value(nodes))
    assert np.abs(newton_roots(lambda x: (value(x), slope(x)), low, high) - places).max() <= tolerance
    last, first = bisect(lambda x: np.sign(value(x)) == np.sign(value(low)), low, high)
    assert (last <= first).all()
    assert np.abs(first - places).max() <= tolerance


def test_roots_beside_mpmath():
    low, high = np.array([0.5, 1.0, 2.0, 4.0]), np.array([1.5, 2.0, 3.0, 6.0])
    shift = np.array([0.5, -0.3, -0.9, 0.9])
    found = interpolated_roots(lambda x: np.cos(x) - shift, low, high)
    slopes = newton_roots(lambda x: (np.cos(x) - shift, -np.sin(x)), low, high)
    with mpmath.workdps(30):
        known = [mpmath.acos(mpmath.mpf(float(c))) for c in shift]
        known[3] = 2 * mpmath.pi - known[3]
        for k, place in enumerate(known):
            # one unit of rounding of the cosine over its slope, and the last places of the bracket
            bound = EPS / abs(float(mpmath.sin(place))) + 2.0 * EPS * high[k]
            assert abs(found[k] - float(place)) <= bound
            assert abs(slopes[k] - float(place)) <= bound


@pytest.mark.parametrize("power", [3, 5, 9, 21])
def test_a_root_of_high_order_is_found_like_any_other(power):
    # the sign of an odd power is exact, however flat it is
    found = interpolated_roots(lambda x: (x - 0.3) ** power, np.array([-1.0]), np.array([2.0]))
    assert abs(found[0] - 0.3) <= 4.0 * EPS + 1e-300 ** (1.0 / power)


def test_a_jump_over_zero_is_the_place_of_the_jump():
    def step(x):
        return np.where(x < 0.3, -1.0, 5.0)

    assert abs(interpolated_roots(step, np.array([0.0]), np.array([1.0]))[0] - 0.3) <= 2.0 * EPS
    last, first = bisect(lambda x: step(x) < 0.0, np.array([0.0]), np.array([1.0]))
    assert last[0] < 0.3 <= first[0] <= np.nextafter(last[0], 1.0) + EPS


def test_bisection_runs_either_way_and_ends_beside_zero():
    last, first = bisect(lambda x: x > 0.0, np.array([1.0, 2.0]), np.array([-1.0, 0.0]))
    assert (last > 0.0).all()
    assert (first <= 0.0).all()
    assert (last - first <= 4.0 * EPS).all()


def test_a_bracket_with_its_root_at_an_end():
    square = interpolated_roots(lambda x: x * (x - 1.0), np.array([0.0, 0.5]), np.array([0.5, 1.0]))
    assert square.tolist() == [0.0, 1.0]


def test_one_sign_at_both_ends_gives_the_end_nearer_to_zero():
    found = interpolated_roots(lambda x: x + 1.0, np.array([0.0, -9.0]), np.array([4.0, -2.0]))
    assert found.tolist() == [0.0, -2.0]


def test_absence_in_a_bracket_is_absence_of_its_root():
    def broken(x):
        return np.where((x > 0.2) & (x < 0.8), np.nan, x - 0.5)

    assert np.isnan(interpolated_roots(broken, np.array([0.0]), np.array([1.0]))[0])
    found = interpolated_roots(
        lambda x: np.where(x < 2.0, broken(x), x - 2.5), np.array([0.0, 2.0]), np.array([1.0, 3.0])
    )
    assert np.isnan(found[0])
    assert found[1] == 2.5
    assert np.isnan(interpolated_roots(broken, np.array([0.3]), np.array([1.0]))[0])


def test_one_number():
    assert abs(root(lambda x: x**3 - 2.0, 0.0, 2.0) - 2.0 ** (1.0 / 3.0)) <= 4.0 * EPS


def test_no_brackets_no_roots():
    nothing = np.empty(0)
    assert interpolated_roots(np.cos, nothing, nothing).size == 0
    assert newton_roots(lambda x: (np.cos(x), -np.sin(x)), nothing, nothing).size == 0
    assert [part.size for part in bisect(lambda x: x > 0.0, nothing, nothing)] == [0, 0]
    assert [part.size for part in maxima_between(np.cos, nothing, nothing)] == [0, 0]


@pytest.mark.parametrize(
    ("values", "cells"),
    [
        ([1.0, -1.0, -2.0], [(0, 1)]),
        ([1.0, 0.0, -2.0], [(0, 2)]),  # a zero at a node
        ([1.0, 0.0, 2.0], []),  # it touches
        ([1.0, 0.0, 0.0, -2.0], []),  # a dwell
        ([0.0, 1.0, 2.0, 0.0], []),  # zeros at the ends
        ([1.0, np.nan, -1.0], []),  # a gap
        ([1.0, np.nan, 3.0, -1.0, np.inf, 1.0], [(2, 3)]),
        ([], []),
        ([1.0], []),
    ],
)
def test_brackets_of_samples(values, cells):
    nodes = np.arange(float(len(values)))
    low, high = crossing_brackets(nodes, np.array(values))
    assert list(zip(low.tolist(), high.tolist(), strict=True)) == cells


def test_no_bracket_reaches_over_the_two_sides_of_a_jump():
    nodes = np.array([0.0, np.nextafter(1.0, 0.0), 1.0, 2.0])
    assert crossing_brackets(nodes, np.array([1.0, 1.0, -1.0, -1.0]))[0].size == 0
    assert crossing_brackets(nodes, np.array([1.0, 0.0, -1.0, -1.0]))[0].size == 0
    assert crossing_brackets(nodes, np.array([1.0, 1.0, -1.0, 1.0]))[0].tolist() == [1.0]


def test_sign_changes_of_many_rows():
    rows = np.array([[1.0, -1.0, np.nan, 1.0], [1.0, 2.0, 3.0, 4.0], [np.inf, -1.0, 2.0, 0.0]])
    found, cells = sign_changes(rows)
    assert list(zip(found.tolist(), cells.tolist(), strict=True)) == [(0, 0), (2, 1)]


def test_two_roots_in_one_cell_that_the_tangents_foretell():
    def dip(x):
        return (x - 0.5) ** 2 - 1e-4, 2.0 * (x - 0.5)

    nodes = np.array([0.0, 0.4, 0.61, 1.0])
    low, high = foretold_brackets(dip, nodes, *dip(nodes))
    found = np.sort(newton_roots(dip, low, high))
    # the difference under the square loses as much as its own size says
    assert np.abs(found - [0.49, 0.51]).max() <= 4.0 * EPS / 0.02

    def clear(x):
        return (x - 0.5) ** 2 + 1e-4, 2.0 * (x - 0.5)

    assert foretold_brackets(clear, nodes, *clear(nodes))[0].size == 0


waves = st.lists(st.tuples(st.floats(-1.0, 1.0), st.floats(0.0, 6.3)), min_size=2, max_size=4).filter(
    lambda one: sum(abs(a) for a, _phase in one) > 0.1
)


def wave(terms):
    def value(x):
        return sum(a * np.sin((k + 1) * x + phase) for k, (a, phase) in enumerate(terms))

    def slope(x):
        return sum((k + 1) * a * np.cos((k + 1) * x + phase) for k, (a, phase) in enumerate(terms))

    return value, slope


@given(waves)
def test_extremes_of_periodic_functions_beside_dense_samples(terms):
    value, slope = wave(terms)
    nodes = np.linspace(0.0, 2.0 * np.pi, 181)
    found = extremes(value, slope, nodes)
    dense = value(np.linspace(0.0, 2.0 * np.pi, 20001))
    size = sum(abs(a) for a, _phase in terms)
    # the second derivative is at most 16 times the size: half a step of the dense samples loses no more than that
    lost = 8.0 * size * (np.pi / 20000.0) ** 2
    assert dense.max() - 8.0 * EPS * size <= found.greatest <= dense.max() + lost
    assert dense.min() - lost <= found.least <= dense.min() + 8.0 * EPS * size
    assert found.range == found.greatest - found.least
    assert abs(value(np.array([found.at_greatest]))[0] - found.greatest) <= 8.0 * EPS * size
    # the same without the slope, over the period without its end
    _places, heights = tops(value, nodes[:-1], period=True)
    assert abs(heights.max() - found.greatest) <= 16.0 * EPS * size


def test_extremes_at_ends_at_kinks_and_of_a_constant():
    nodes = np.linspace(-1.0, 2.0, 7)
    straight = extremes(lambda x: 2.0 * x, lambda x: np.full_like(x, 2.0), nodes)
    assert straight == extremes(lambda x: 2.0 * x, lambda x: 0.0 * x, nodes)
    assert (straight.at_least, straight.at_greatest) == (-1.0, 2.0)
    kink = extremes(lambda x: np.abs(x - 0.3), lambda x: np.where(x < 0.3, -1.0, 1.0), nodes)
    assert kink.least <= 4.0 * EPS  # where the slope jumps, between two nodes
    constant = extremes(lambda x: 0.0 * x + 3.0, lambda x: 0.0 * x, nodes)
    assert (constant.least, constant.greatest, constant.range) == (3.0, 3.0, 0.0)
    assert constant.at_least == constant.at_greatest == -1.0


def test_extremes_where_some_values_are_absent():
    def value(x):
        return np.where(x < 0.5, np.nan, np.sin(x))

    def slope(x):
        return np.where(x < 0.5, np.nan, np.cos(x))

    found = extremes(value, slope, np.linspace(0.0, 3.0, 31))
    assert found.greatest == 1.0
    assert abs(found.at_greatest - np.pi / 2) <= 4.0 * EPS
    assert found.at_least == 3.0


def test_noise_about_a_constant_is_looked_into_at_few_places():
    rng = np.random.default_rng(5)
    nodes = np.linspace(0.0, 1.0, 20001)
    asked = []

    def slope(x):
        asked.append(x.size)
        return rng.standard_normal(x.shape)

    found = extremes(lambda x: 1.0 + 1e-12 * np.cos(40.0 * x), slope, nodes)
    assert abs(found.greatest - 1.0 - 1e-12) <= 4.0 * EPS
    assert max(asked[1:]) <= 2000


def test_tops_with_gaps_kinks_and_edges():
    nodes = np.linspace(0.0, 10.0, 101)

    def value(x):
        return np.where((x > 4.0) & (x < 5.05), np.nan, np.cos(x) + 0.1 * x)

    places, heights = tops(value, nodes)
    inner = 2.0 * np.pi + float(np.arcsin(0.1)), float(np.arcsin(0.1))
    assert abs(places[0] - inner[0]) <= 1e-7  # a smooth top lies where rounding hides its fall
    assert abs(heights[0] - (np.cos(inner[0]) + 0.1 * inner[0])) <= 4.0 * EPS * 2.0
    assert any(abs(place - inner[1]) <= 1e-7 for place in places)
    kinked, least = tops(lambda x: -np.abs(x - 0.123), nodes)
    assert abs(kinked[0] - 0.123) <= 0.2 * (2.0 / PARTS) ** 12
    assert abs(least[0]) <= 0.2 * (2.0 / PARTS) ** 12
    # the greatest value lies where a gap begins between two nodes
    edge, height = tops(lambda x: np.where(x > 3.33, np.nan, x), nodes)
    assert abs(edge[0] - 3.33) <= 8.0 * EPS
    assert edge[0] == height[0]
    assert tops(lambda x: x * np.nan, nodes)[0].size == 0
    assert tops(lambda x: 0.0 * x, nodes, most=1)[1].tolist() == [0.0]
    # without a bound: the place where it is lost
    with np.errstate(divide="ignore"):
        endless, infinite = tops(lambda x: 1.0 / np.abs(x - 5.0), nodes, most=1)
    assert (endless[0], infinite[0]) == (5.0, np.inf)


def test_tops_near_the_greatest_and_so_many():
    nodes = np.linspace(0.0, 12.0, 241)

    def value(x):
        return np.sin(x) + 0.05 * x

    assert len(tops(value, nodes)[0]) == 3
    assert len(tops(value, nodes, most=2)[0]) == 2
    first = np.pi - np.arccos(0.05)
    assert abs(tops(value, nodes, most=1)[0][0] - (2.0 * np.pi + first)) <= 1e-6
    assert len(tops(value, nodes, near=0.01)[0]) == 1


def test_rows_with_functions_of_their_own():
    centres = np.array([0.2, 0.7, -1.0])
    places, values = maxima_between(
        lambda x: 1.0 - (x - centres[:, None]) ** 2, np.full(3, -0.5), np.full(3, 1.5)
    )
    assert np.abs(values - [1.0, 1.0, 0.75]).max() <= 4.0 * EPS
    assert np.abs(places[:2] - centres[:2]).max() <= 1e-7
    assert places[2] == -0.5


@pytest.mark.parametrize(
    ("function", "low", "high", "place"),
    [
        (lambda x: 2.0 - x * x, 0.0, 3.0, math.sqrt(2.0)),
        (math.cos, 1.0, 2.0, math.pi / 2),
        (lambda x: -((x - 1.0) ** 3), 0.0, 5.0, 1.0),
        (lambda x: math.exp(-50.0 * x) - 1e-9, 0.0, 1.0, math.log(1e9) / 50.0),
        (lambda x: 1.0 if x < 0.3 else -1.0, 0.0, 1.0, 0.3),
        (lambda x: 5.0 - x, 0.0, 5.0, 5.0),
        (lambda x: x - 1000.25, 1000.0, 1001.0, 1000.25),
    ],
)
def test_one_zero_of_a_function_of_plain_numbers(
    function: Callable[[float], float], low: float, high: float, place: float
) -> None:
    assert abs(zero_between(function, low, high, 1e-16) - place) <= 4 * EPS * place
