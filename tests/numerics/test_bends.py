"""Bounds of second derivatives over cells against exact ones at places inside."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from centrode.numerics.arrays import ARRAYS
from centrode.numerics.bends import BendFunctions, Bent, Cells
from centrode.numerics.jets import Jet, JetFunctions
from mechanisms import EPS

BENDS, JETS = BendFunctions(ARRAYS), JetFunctions(ARRAYS)
CENTRES = np.linspace(-3.0, 3.0, 61)
INSIDE = np.linspace(-1.0, 1.0, 41)
FORMULAS: dict[str, Callable[[Any, Any], Any]] = {
    "line": lambda m, x: 3.0 * x - 2.0,
    "square": lambda m, x: x * x,
    "cube": lambda m, x: x * (x * x),
    "difference of products": lambda m, x: x * m.sin(x) - m.cos(x) * x,
    "reciprocal": lambda m, x: 1.0 / (4.0 + x),
    "quotient": lambda m, x: m.sin(x) / (2.0 + m.cos(x)),
    "half of it": lambda m, x: m.cos(2.0 * x) / 2.0,
    "root": lambda m, x: m.sqrt(5.0 - x),
    "root of a wave": lambda m, x: m.sqrt(1.2 - m.cos(x)),
    "angle": lambda m, x: m.atan2(m.sin(x) + 0.3, m.cos(x) * 2.0),
    "from a number": lambda m, x: 1.0 - m.sin(x),
}


def bent(formula: Callable[[Any, Any], Any], half: float) -> tuple[Bent, Any]:
    """The number over cells, and its exact second derivatives inside them."""
    with np.errstate(all="ignore"):
        found = formula(BENDS, BENDS.variable(CENTRES, Cells(half, ARRAYS)))
        exact = formula(JETS, Jet.variable(CENTRES[:, None] + half * INSIDE, 2))
    return found, exact


@pytest.mark.parametrize("half", [1e-3, 0.05])
@pytest.mark.parametrize("name", FORMULAS)
def test_bounds_hold_and_are_not_idle(name: str, half: float) -> None:
    found, exact = bent(FORMULAS[name], half)
    second = np.abs(np.broadcast_to(exact.derivative(2), (len(CENTRES), len(INSIDE))))
    bend = np.broadcast_to(found.bend, CENTRES.shape)
    known = np.isfinite(bend)
    assert known.mean() > 0.9
    assert (second[known] <= bend[known, None] * (1.0 + 64 * EPS) + 64 * EPS).all()
    values = np.abs(np.broadcast_to(exact.value, second.shape))
    assert (values <= np.broadcast_to(found.most, CENTRES.shape)[:, None] * (1.0 + 64 * EPS))[known].all()
    assert (values >= np.broadcast_to(found.least, CENTRES.shape)[:, None] - 64 * EPS)[known].all()


@pytest.mark.parametrize("name", FORMULAS)
def test_value_and_slope_have_the_bits_of_jets(name: str) -> None:
    found, _exact = bent(FORMULAS[name], 0.01)
    with np.errstate(all="ignore"):
        plain = FORMULAS[name](JETS, Jet.variable(CENTRES, 1))
    for one, other in zip(found.coefficients, plain.coefficients, strict=True):
        np.testing.assert_array_equal(one, other)


def test_nothing_is_known_where_a_divisor_or_a_radicand_may_be_zero() -> None:
    x = BENDS.variable(np.array([0.0, 0.04, 0.2]), Cells(0.05, ARRAYS))
    with np.errstate(all="ignore"):
        for number in (1.0 / x, BENDS.sqrt(x)):
            np.testing.assert_array_equal(np.isfinite(number.bend), [False, False, True])


def test_what_is_not_bounded_makes_all_that_follows_unbounded() -> None:
    x = BENDS.variable(CENTRES + 5.0, Cells(0.01, ARRAYS))
    plain = Jet.variable(CENTRES + 5.0, 1)
    for number in (x + plain, plain + x, x - plain, plain - x, x * plain, plain * x, x / plain, plain / x):
        assert type(number) is Jet
