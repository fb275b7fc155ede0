"""Jets of any order against mpmath's Taylor series: arithmetic and functions, on floats, arrays, mpmath numbers."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from centrode.numerics.arrays import ARRAYS
from centrode.numerics.jets import Jet, JetFunctions

EPS = 2.0**-52
JETS = JetFunctions(ARRAYS)
ORDER = 8
Formula = Callable[[Any, Any], Any]


class Precise:
    """The functions in mpmath's names."""

    sin, cos, tan, exp, log, sqrt = mp.sin, mp.cos, mp.tan, mp.exp, mp.log, mp.sqrt
    asin, acos, atan, atan2 = mp.asin, mp.acos, mp.atan, mp.atan2
    abs = staticmethod(mp.fabs)
    sign = mp.sign


FORMULAS: dict[str, tuple[Formula, float]] = {
    "sum": (lambda m, x: 2.0 + x + x * x - 0.5 - (1.0 - x), 0.7),
    "product": (lambda m, x: (x + 1.0) * (x * x - 2.0) * 3.0, 0.7),
    "quotient": (lambda m, x: (x * x + 1.0) / (2.0 - x) / 4.0, 0.7),
    "reciprocal": (lambda m, x: 3.0 / (x + 1.0), 0.7),
    "whole power": (lambda m, x: x**5 + x**0, 0.7),
    "real power": (lambda m, x: (x + 1.0) ** -1.5, 0.7),
    "sqrt": (lambda m, x: m.sqrt(x * x + 0.3), 0.7),
    "sin": (lambda m, x: m.sin(2.0 * x), 0.7),
    "cos": (lambda m, x: m.cos(x * x), 0.7),
    "tan": (lambda m, x: m.tan(0.5 * x), 0.7),
    "exp": (lambda m, x: m.exp(-x * x), 0.7),
    "log": (lambda m, x: m.log(x + 2.0), 0.7),
    "asin": (lambda m, x: m.asin(0.5 * x), 0.4),
    "acos": (lambda m, x: m.acos(0.5 * x), 0.4),
    "atan": (lambda m, x: m.atan(x), 0.7),
    "atan2": (lambda m, x: m.atan2(m.sin(3.0 * x) + 0.2, m.cos(3.0 * x)), 0.7),
    "abs": (lambda m, x: m.abs(x - 2.0) * m.sign(x), 0.7),
    "dyad": (lambda m, x: m.sqrt((2.0 - m.cos(x)) * (2.5 + m.sin(x))) / (3.0 + m.cos(x)), 0.7),
}


def taylor(formula: Formula, at: float, order: int) -> list[Any]:
    with mp.workdps(60):
        return list(mp.taylor(lambda x: formula(Precise, x), mp.mpf(at), order))


def close(jet: Jet, exact: list[Any], factor: float = 1.0) -> None:
    """Coefficients to rounding: recurrences of k products of numbers below the greatest coefficient so far."""
    greatest = 1.0
    for k, (found, expected) in enumerate(zip(jet.coefficients, exact, strict=True)):
        greatest = max(greatest, abs(float(expected)))
        assert abs(float(found) - float(expected)) <= factor * 64 * EPS * (k + 1) * greatest, k


@pytest.mark.parametrize("name", FORMULAS)
def test_derivatives_of_any_order(name: str) -> None:
    formula, at = FORMULAS[name]
    for order in (0, 1, 2, 5, ORDER):
        jet = formula(JETS, Jet.variable(at, order))
        assert jet.order == order
        close(jet, taylor(formula, at, order))


@pytest.mark.parametrize("name", FORMULAS)
def test_arrays_go_through_the_same_formulas(name: str) -> None:
    formula, at = FORMULAS[name]
    values = np.array([at, at + 0.05])
    together = formula(JETS, Jet.variable(values, 3))
    for k, value in enumerate(values):
        alone = formula(JETS, Jet.variable(value, 3))
        for one, other in zip(together.coefficients, alone.coefficients, strict=True):
            assert np.broadcast_to(one, (2,))[k] == pytest.approx(float(other), rel=8 * EPS, abs=8 * EPS)


@pytest.mark.parametrize("name", ["dyad", "atan2", "real power"])
def test_jets_over_mpmath_numbers_have_its_digits(name: str) -> None:
    formula, at = FORMULAS[name]
    with mp.workdps(50):
        jet = formula(JetFunctions(Precise), Jet.variable(mp.mpf(at), 5))
    with mp.workdps(50):
        for found, expected in zip(jet.coefficients, taylor(formula, at, 5), strict=True):
            assert abs(found - expected) <= mp.mpf(10) ** -44


def test_derivatives_are_factorials_times_coefficients() -> None:
    jet = JETS.exp(Jet.variable(0.3, 6))
    assert [jet.derivative(k) for k in range(7)] == pytest.approx([math.exp(0.3)] * 7, rel=16 * EPS)
    assert jet.slope().coefficients == pytest.approx(jet.lower_order().coefficients, rel=16 * EPS)


@settings(max_examples=40)
@given(st.lists(st.floats(-2, 2), min_size=4, max_size=4), st.lists(st.floats(-2, 2), min_size=4, max_size=4))
def test_jets_are_a_ring(a: list[float], b: list[float]) -> None:
    one, other = Jet(a), Jet(b)
    product = (one * other).coefficients
    assert product == pytest.approx((other * one).coefficients, abs=32 * EPS)
    expected = np.polynomial.polynomial.polymul(a, b)[:4]
    expected = np.append(expected, np.zeros(4 - len(expected)))
    assert np.array(product) == pytest.approx(expected, abs=64 * EPS)
    assert ((one + other) - other).coefficients == pytest.approx(one.coefficients, abs=8 * EPS)
    negative = -one
    assert (+one).coefficients == (-negative).coefficients


@settings(max_examples=40)
@given(st.floats(0.5, 3), st.lists(st.floats(-2, 2), min_size=3, max_size=3))
def test_quotients_and_roots_undo_products(value: float, rest: list[float]) -> None:
    jet = Jet([value, *rest])
    # each inverse recurrence divides by the value, at least 0.5, once an order
    allowed = 256 * EPS * (1 + 2 / value) ** 6
    assert ((jet * jet) / jet).coefficients == pytest.approx(jet.coefficients, abs=allowed)
    root = JETS.sqrt(jet)
    assert (root * root).coefficients == pytest.approx(jet.coefficients, abs=allowed)
    assert JETS.exp(JETS.log(jet)).coefficients == pytest.approx(jet.coefficients, abs=allowed)
    sine, cosine = JETS.sin(jet), JETS.cos(jet)
    assert (sine * sine + cosine * cosine).coefficients == pytest.approx((1.0, 0.0, 0.0, 0.0), abs=allowed)
    assert JETS.atan2(sine, cosine).coefficients[1:] == pytest.approx(jet.coefficients[1:], abs=allowed)


def test_sides_of_min_and_max() -> None:
    x = Jet.variable(0.3, 2)
    assert JETS.max(x, 0.1).coefficients == pytest.approx((0.3, 1.0, 0.0), abs=2 * EPS)
    assert JETS.min(x, 0.1).coefficients == pytest.approx((0.1, 0.0, 0.0), abs=2 * EPS)
    assert JETS.sign(x) == 1.0


def test_plain_numbers_pass_through() -> None:
    for name in ("sin", "cos", "sqrt", "exp", "log", "atan", "tan", "abs", "sign"):
        assert getattr(JETS, name)(0.5) == pytest.approx(getattr(ARRAYS, name)(0.5), rel=4 * EPS)
    assert JETS.atan2(0.5, -1.0) == math.atan2(0.5, -1.0)
    assert "Jet(" in repr(Jet.variable(1.0, 1))


def test_sine_and_cosine_at_once_are_each_alone() -> None:
    x = Jet([np.linspace(-3.0, 3.0, 7), 1.0, 0.25])
    sine, cosine = JETS.sine_and_cosine(x)
    for both, alone in ((sine, JETS.sin(x)), (cosine, JETS.cos(x))):
        for one, other in zip(both.coefficients, alone.coefficients, strict=True):
            np.testing.assert_array_equal(one, other)
    assert JETS.sine_and_cosine(0.5) == (JETS.sin(0.5), JETS.cos(0.5))
