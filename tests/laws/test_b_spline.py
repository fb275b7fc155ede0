"""B-splines against another implementation, against polynomials, and against what was asked of them."""

from __future__ import annotations

import math
import sys

import numpy as np
import pytest
from scipy.interpolate import BSpline, make_interp_spline

from centrode.errors import InputError
from centrode.laws import LawSegment, SegmentedLaw
from centrode.laws.rises import Piece, Pieces
from centrode.laws.segments import Condition, b_spline, polynomial
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.jets import Jet, JetFunctions

EPS = sys.float_info.epsilon
JETS = JetFunctions(ARRAYS)
LENGTH = 3.0


def whole(found: list[tuple[float, Piece]]) -> Pieces:
    pieces = [piece for _end, piece in found]
    return Pieces.of([0.0, *(end for end, _piece in found)], [pieces[0], *pieces, pieces[-1]])


def derivatives(found: list[tuple[float, Piece]], t: np.ndarray, order: int) -> np.ndarray:
    jet = whole(found).jet(JETS, Jet.variable(t, order))
    return np.stack([np.broadcast_to(jet.derivative(k), t.shape) for k in range(order + 1)])


def asked(inner: int, rates: int, seed: int) -> list[Condition]:
    """Values at places drawn at random, and as many derivatives at both ends."""
    draw = np.random.default_rng(seed)
    places = LENGTH * np.sort(draw.uniform(0.05, 0.95, inner))
    ends = [tuple(draw.normal(size=rates + 1).tolist()) for _end in range(2)]
    way = [(float(place), (float(draw.normal()),)) for place in places]
    return [(0.0, ends[0]), *way, (LENGTH, ends[1])]


def knots(conditions: list[Condition], degree: int) -> np.ndarray:
    """At the places of the values where the conditions at the ends are those of a complete spline, else their means."""
    places = [time for time, given in conditions for _rate in given]
    inner = [time for time, _given in conditions[1:-1]]
    if not len(conditions[0][1]) == len(conditions[-1][1]) == (degree + 1) / 2:
        inner = [np.mean(places[k : k + degree]) for k in range(1, len(places) - degree)]
    return np.array([0.0] * (degree + 1) + inner + [LENGTH] * (degree + 1))


def another(conditions: list[Condition], degree: int) -> tuple[BSpline, list[float]]:
    """The spline by another implementation, and what rounding may take from its derivatives.

    Coefficients are as exact as their equations are conditioned, derivatives as their formulas carry that on.
    """
    places, values = np.array([(time, given[0]) for time, given in conditions]).T
    first, last = (list(enumerate(given[1:], 1)) for given in (conditions[0][1], conditions[-1][1]))
    t = knots(conditions, degree)
    spline = make_interp_spline(places, values, k=degree, t=t, bc_type=(first, last) if first else None)
    each = BSpline(t, np.eye(len(t) - degree - 1), degree)
    rows = [each(places[1:-1])]
    rows += [each(place, nu=k)[None] for place in (0.0, LENGTH) for k in range(len(first) + 1)]
    equations = np.vstack(rows)
    scaled = equations / np.abs(equations).max(axis=1, keepdims=True)
    loss = 8 * EPS * (degree + 1) * np.linalg.cond(scaled) * np.abs(spline.c).max()
    where = np.linspace(0.0, LENGTH, 61)
    return spline, [loss * np.abs(each(where, nu=k)).sum(axis=1).max() for k in range(degree + 1)]


@pytest.mark.parametrize("inner", [0, 1, 3, 12])
@pytest.mark.parametrize(
    ("degree", "rates"), [(1, 0), (2, 0), (3, 0), (3, 1), (4, 1), (5, 0), (5, 1), (5, 2), (6, 2), (7, 3)]
)
def test_it_is_the_spline_of_another_implementation(degree: int, rates: int, inner: int) -> None:
    conditions = asked(inner, rates, 100 * degree + inner)
    degree = min(degree, sum(len(given) for _time, given in conditions) - 1)
    other, losses = another(conditions, degree)
    where = np.linspace(0.0, LENGTH, 61)
    order = min(degree - 1, 4)
    found = derivatives(b_spline(conditions, degree), where, order)
    for k in range(order + 1):
        np.testing.assert_allclose(found[k], other(where, nu=k), rtol=0, atol=losses[k])


def test_what_is_asked_at_the_ends_holds_exactly() -> None:
    start, end = (0.25, -0.5, 0.75, 2.0), (1.0, 0.0, -3.0, 0.5)
    found = b_spline([(0.0, start), (0.5, (0.4,)), (1.25, (2.0,)), (2.0, end)], 7)
    both = derivatives(found, np.array([0.0, 2.0]), 3)
    assert both.T.tolist() == [list(start), list(end)]


@pytest.mark.parametrize("degree", [3, 5, 9])
def test_with_few_conditions_it_is_their_polynomial(degree: int) -> None:
    conditions: list[Condition] = [(0.0, (0.0, 1.0)), (1.0, (2.0,)), (LENGTH, (0.5,))]
    where = np.linspace(0.0, LENGTH, 31)
    expected = derivatives(polynomial(conditions), where, 3)
    np.testing.assert_allclose(
        derivatives(b_spline(conditions, degree), where, 3),
        expected,
        rtol=0,
        atol=64 * EPS * np.abs(expected).max(),
    )


@pytest.mark.parametrize("degree", [3, 4, 5])
def test_a_polynomial_of_its_degree_is_reproduced(degree: int) -> None:
    """Whatever the knots: each polynomial of the degree is a spline on them."""
    coefficients = np.random.default_rng(degree).normal(size=degree + 1)
    curve = np.polynomial.Polynomial(coefficients)
    places = np.linspace(0.0, LENGTH, 9)
    rates = [curve.deriv(k) for k in range(1, (degree + 1) // 2)]
    conditions: list[Condition] = [(float(x), (float(curve(x)),)) for x in places]
    for end in (0, -1):
        x = conditions[end][0]
        conditions[end] = (x, (float(curve(x)), *(float(rate(x)) for rate in rates)))
    where = np.linspace(0.0, LENGTH, 50)
    found = derivatives(b_spline(conditions, degree), where, degree - 1)
    for k in range(degree):
        expected = curve.deriv(k)(where)
        # Knots lie 3/8 apart: a derivative more costs such a quotient more, with the degree in front.
        size = np.abs(curve(where)).max() * (2 * degree * 8 / LENGTH) ** k
        np.testing.assert_allclose(found[k], expected, rtol=0, atol=64 * EPS * degree * size)


def test_inside_all_derivatives_but_the_last_are_continuous() -> None:
    conditions = asked(6, 2, 7)
    found, losses = b_spline(conditions, 5), another(conditions, 5)[1]
    pieces = whole(found)
    for number, (end, _piece) in enumerate(found[:-2], 1):
        sides = [pieces.at_row(row, JETS, Jet.variable(np.float64(end), 5)) for row in (number, number + 1)]
        jumps = [abs(float(sides[1].derivative(k)) - float(sides[0].derivative(k))) for k in range(6)]
        assert all(jump <= loss for jump, loss in zip(jumps[:5], losses, strict=False))
        assert jumps[5] > losses[5]


def test_a_segment_of_a_law_may_be_one() -> None:
    law = SegmentedLaw(
        (
            LawSegment(1.0, 2.0, "cycloidal"),
            LawSegment(2.0, 0.0, "b-spline", (0.0, 0.0), (0.0, 0.0), ((0.5, 1.5), (1.0, 0.5)), 5),
        )
    )
    assert [law.jet(math, t) for t in (0.0, 1.0, 3.0)] == [0.0, 2.0, 0.0]
    assert law.jet(math, 1.5) == pytest.approx(1.5, rel=64 * EPS)
    assert law.segments[1].inner_jump == 5 and law.segments[0].inner_jump is None


@pytest.mark.parametrize("degree", [0, 16])
def test_degrees_are_bounded(degree: int) -> None:
    with pytest.raises(InputError, match="between 1 and 15"):
        LawSegment(1.0, 1.0, "b-spline", degree=degree)


def test_ends_take_fewer_derivatives_than_the_degree() -> None:
    with pytest.raises(
        InputError, match="degree 3 admits fewer derivatives at an end than its degree, got 3"
    ):
        LawSegment(1.0, 1.0, "b-spline", (0.0, 0.0, 0.0), (), (), 3)


def test_what_cannot_be_computed_is_refused() -> None:
    with pytest.raises(InputError, match="cannot be computed"):
        b_spline([(0.0, (0.0, 1e308, 1e308)), (1e3, (0.0,))], 5)
