"""Polynomials from conditions against the linear system they satisfy, solved with sixty digits."""

import math
import sys

import mpmath
import numpy as np
import pytest

from centrode.errors import InputError
from centrode.laws.rises import Piece, Pieces
from centrode.laws.segments import Condition, polynomial
from centrode.numerics.jets import Jet

EPS = sys.float_info.epsilon

CASES: dict[str, list[Condition]] = {
    "line": [(0.0, (1.0,)), (3.0, (-2.0,))],
    "cubic": [(0.0, (0.0, 0.5)), (0.7, (1.0, -2.0))],
    "one end only": [(0.0, (0.0, 0.0, 0.0, 0.0)), (2.0, (0.1,))],
    "seventh degree": [(0.0, (0.1, 0.3, -0.7, 2.0)), (0.3, (0.4, 0.0, 1.1, -9.0))],
    "later start": [(1.3, (0.0, 1.0)), (2.1, (0.5,)), (2.2, (0.4, 0.1, 0.2))],
    "way points": [(0.0, (0.0, 0.0, 0.0)), (0.1, (0.3,)), (0.37, (0.2,)), (0.9, (0.8,)), (1.0, (1.0, 0.0))],
    "short": [(0.0, (0.0, 1e3)), (1e-6, (1e-3, 0.0, 1e9))],
}


def exact_powers(conditions: list[Condition]) -> list[mpmath.mpf]:
    """Coefficients of powers of time, from the conditions as equations."""
    rows = [(time, order, value) for time, given in conditions for order, value in enumerate(given)]
    matrix, right = mpmath.zeros(len(rows), len(rows)), mpmath.zeros(len(rows), 1)
    for i, (time, order, value) in enumerate(rows):
        right[i] = value
        for k in range(order, len(rows)):
            matrix[i, k] = math.perm(k, order) * mpmath.mpf(time) ** (k - order)
    return list(mpmath.lu_solve(matrix, right))


def whole(conditions: list[Condition]) -> Pieces:
    found = polynomial(conditions)
    return Pieces.of(
        [conditions[0][0], *(end for end, _p in found)], [found[0][1], *(p for _e, p in found), found[-1][1]]
    )


def nearest(conditions: list[Condition], t: float) -> Piece:
    return next(piece for end, piece in polynomial(conditions) if t <= end)


def allowed(piece: Piece, t: float, order: int) -> float:
    """Rounding of the terms about the piece's origin, and of the distance from it."""
    x = abs(t - piece.origin) / piece.unit
    terms = [piece.value, *piece.powers]
    size = sum(
        abs(c) * math.perm(k, order) * x ** (k - order) * (k + 1) for k, c in enumerate(terms) if k >= order
    )
    return (2 * len(terms) + 8) * EPS * size / piece.unit**order + sys.float_info.min


@pytest.mark.parametrize("name", CASES)
def test_values_and_three_derivatives_between_the_conditions(name: str) -> None:
    conditions = CASES[name]
    law = whole(conditions)
    first, last = conditions[0][0], conditions[-1][0]
    with mpmath.workdps(60):
        powers = exact_powers(conditions)
        for t in np.random.default_rng(len(name)).uniform(first, last, 20).tolist():
            jet = law.jet(math, Jet.variable(t, 3))
            for order in range(4):
                terms = [
                    math.perm(k, order) * c * mpmath.mpf(t) ** (k - order)
                    for k, c in enumerate(powers)
                    if k >= order
                ]
                margin = allowed(nearest(conditions, t), t, order)
                assert jet.derivative(order) == pytest.approx(float(mpmath.fsum(terms)), rel=0, abs=margin)


@pytest.mark.parametrize("name", CASES)
def test_conditions_are_met_to_rounding_of_each(name: str) -> None:
    law = whole(CASES[name])
    for time, given in CASES[name]:
        jet = law.jet(math, Jet.variable(time, 4))
        assert jet.value == given[0]
        for order, rate in enumerate(given):
            # Rounded as a coefficient, then divided by the unit `order` times.
            assert jet.derivative(order) == pytest.approx(rate, rel=2 * (order + 1) * EPS, abs=0)


def test_the_known_polynomials_come_out() -> None:
    """3-4-5 and 4-5-6-7 are those with two and three derivatives zero at both ends."""
    for zeros, powers in ((2, (10, -15, 6)), (3, (35, -84, 70, -20))):
        (_end, piece), _other = polynomial([(0.0, (0.0,) * (zeros + 1)), (1.0, (1.0,) + (0.0,) * zeros)])
        assert piece.powers == (0.0,) * zeros + powers


def test_what_cannot_be_computed_is_refused() -> None:
    with pytest.raises(InputError, match="cannot be computed"):
        polynomial([(0.0, (0.0, 1e300, 1e300)), (1e50, (1.0,))])
