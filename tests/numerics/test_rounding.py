"""Numbers with rounding bounds: the true error lies below the bound, and the bound is not much above it."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import Any

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from centrode.geometry.intersections import meet_circles
from centrode.geometry.plane import PlaneCircle
from centrode.numerics.rounding_bounds import ROUNDED, SAFETY, UNIT_ROUNDOFF, Rounded

VALUE = st.floats(-100, 100).filter(lambda x: abs(x) > 1e-3)


class Precise:
    sin, cos, sqrt, exp, log, abs, min, max = mp.sin, mp.cos, mp.sqrt, mp.exp, mp.log, abs, min, max


FORMULAS: dict[str, Callable[[Any, Any, Any, Any], Any]] = {
    "sum": lambda m, a, b, c: a + b + c,
    "difference": lambda m, a, b, c: (1.5 - a) - b * c,
    "product": lambda m, a, b, c: a * b * c * 0.1,
    "quotient": lambda m, a, b, c: (2.0 / a) / b + c / 3.0,
    "functions": lambda m, a, b, c: m.sin(a) * m.cos(b) + m.sin(-c),
    "root": lambda m, a, b, c: m.sqrt(a * a + b * b) - c,
    "exponential": lambda m, a, b, c: m.exp(a * 0.1 - b * 0.1) * c,
    "logarithm": lambda m, a, b, c: m.log(m.abs(a * b)) + c,
    "least and greatest": lambda m, a, b, c: m.min(a * b, b * c) + m.max(a * b, c),
    "cancelling": lambda m, a, b, c: (a + b) * (a - b) - (a * a - b * b),
}


@settings(max_examples=40)
@given(VALUE, VALUE, VALUE)
@pytest.mark.parametrize("name", FORMULAS)
def test_errors_lie_below_their_bounds(name: str, a: float, b: float, c: float) -> None:
    formula = FORMULAS[name]
    found = formula(ROUNDED, *(Rounded(np.float64(x), 0.0) for x in (a, b, c)))
    with mp.workdps(60):
        exact = formula(Precise, mp.mpf(a), mp.mpf(b), mp.mpf(c))
        error = float(abs(mp.mpf(float(found.value)) - exact))
    # constants are taken as known to half a unit; SAFETY covers second order and library functions
    assert error <= SAFETY * float(found.bound) + 1e-300


@settings(max_examples=30)
@given(VALUE, VALUE)
def test_bounds_are_first_order_in_the_unit_roundoff(a: float, b: float) -> None:
    found = Rounded(a, 0.0) * Rounded(b, 0.0)
    assert found.bound == UNIT_ROUNDOFF * abs(a * b)
    exact = Fraction(a) * Fraction(b)
    assert abs(Fraction(found.value) - exact) <= Fraction(found.bound)


def test_data_are_known_to_half_a_unit() -> None:
    assert Rounded.of(3.0).bound == 3.0 * UNIT_ROUNDOFF
    assert Rounded.of(Rounded(1.0, 2.0)).bound == 2.0
    assert "Rounded(" in repr(Rounded.of(1.0))


def test_root_of_a_number_that_may_be_zero() -> None:
    found = ROUNDED.sqrt(Rounded(np.float64(1e-20), np.float64(1e-18)))
    assert found.bound >= np.sqrt(1e-18)
    far = ROUNDED.sqrt(Rounded(np.float64(4.0), np.float64(1e-15)))
    assert far.bound == pytest.approx(1e-15 / 4 + 2 * UNIT_ROUNDOFF, rel=1e-9)


@settings(max_examples=40)
@given(st.floats(0.5, 3.0), st.floats(0.5, 3.0), st.floats(-3.1, 3.1))
def test_touching_circles_are_zero_within_the_bound(r: float, s: float, turn: float) -> None:
    """Centres r + s apart in any direction: the radicand is zero as far as rounding tells, and its bound is small."""
    found: list[Rounded] = []
    x, y = (Rounded.of(np.float64((r + s) * f(turn))) for f in (np.cos, np.sin))

    def root(x: Rounded) -> Rounded:
        found.append(x)
        return ROUNDED.sqrt(Rounded(np.abs(x.value), x.bound))

    meet_circles(PlaneCircle((0.0, 0.0), r), PlaneCircle((x, y), s), root)
    assert abs(found[0].value) <= SAFETY * found[0].bound
    # (r + s)^2 - l^2 is known to a dozen roundings of (r + s)^2, times 4 r s
    assert found[0].bound <= 32 * UNIT_ROUNDOFF * (r + s) ** 2 * 4 * r * s + 1e-30


def test_errors_gathered_along_turning_directions_add_up() -> None:
    """A vector turned 200 times by half a right angle: boxes about it would grow by the root of two each time."""
    cosine, sine = (Rounded.of(np.float64(f(0.25 * np.pi))) for f in (np.cos, np.sin))
    x, y = Rounded.of(np.float64(1.2)), Rounded.of(np.float64(0.7))
    steps = 200
    for k in range(1, steps + 1):
        x, y = x * cosine - y * sine, x * sine + y * cosine
        turn = 0.25 * np.pi * k
        along = np.cos(turn), np.sin(turn)
        x, y = ROUNDED.gather_errors((x, y), (along, (-along[1], along[0])), None)
    with mp.workdps(60):
        c, s = mp.mpf(float(cosine.value)), mp.mpf(float(sine.value))
        exact = mp.mpc(1.2, 0.7) * mp.mpc(c, s) ** steps
        assert abs(mp.mpf(float(x.value)) - exact.real) <= float(x.bound)
        assert abs(mp.mpf(float(y.value)) - exact.imag) <= float(y.bound)
    # each turn rounds four products and two sums of numbers below 2, and takes cosine and sine for data
    assert max(x.bound, y.bound) <= steps * 16 * UNIT_ROUNDOFF * 2.0


def test_an_error_that_numbers_share_cancels() -> None:
    x, y = ROUNDED.gather_errors((Rounded(3.0, 1e-3), Rounded(4.0, 0.0)), ((0.6, 0.8), (-0.8, 0.6)), None)
    # what moves the vector along itself leaves its direction: 4 dx = 3 dy
    across = x * 4.0 - y * 3.0
    assert across.bound == pytest.approx(5.0 * 0.8 * 1e-3, rel=1e-9)
    assert (x - x).bound <= 4.0 * UNIT_ROUNDOFF * x.value
