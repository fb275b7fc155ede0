"""Motion laws: values and derivatives against exact ones, the spline against fifty digits and scipy."""

import math
import pickle
import sys
from itertools import pairwise
from types import SimpleNamespace

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import CubicSpline

from centrode.errors import InputError
from centrode.laws import Law, TableLaw, TextLaw, Uniform
from centrode.numerics.jets import Jet

ARRAYS = SimpleNamespace(sin=np.sin, cos=np.cos, sqrt=np.sqrt, atan2=np.arctan2)
EPS = sys.float_info.epsilon


def test_uniform_motion() -> None:
    law: Law = Uniform(2.5)
    assert law.jet(math, 2.0) == 5.0
    assert law.span is None
    np.testing.assert_array_equal(law.jet(ARRAYS, np.array([0.0, -2.0])), [0.0, -5.0])


def test_text_law_and_its_derivatives() -> None:
    law: Law = TextLaw("0.3*sin(2*t) + t^2")
    assert law.jet(math, 0.7) == pytest.approx(0.3 * math.sin(1.4) + 0.49, rel=4 * EPS)
    moved = law.jet(ARRAYS, np.array([0.1, 0.2]))
    np.testing.assert_allclose(moved, 0.3 * np.sin([0.2, 0.4]) + np.array([0.01, 0.04]), rtol=4 * EPS)


def test_constant_text_law_has_the_shape_of_time() -> None:
    np.testing.assert_array_equal(TextLaw("pi/2").jet(ARRAYS, np.zeros(3)), [math.pi / 2] * 3)


@pytest.mark.parametrize("text", ["0.3*sin(2*q)", "import os", ""])
def test_text_law_refuses_other_texts(text: str) -> None:
    with pytest.raises(InputError):
        TextLaw(text)


def exact_spline(x: list[float], y: list[float], t: float) -> mpmath.mpf:
    """Not-a-knot spline solved for all its coefficients at once, from its definition alone."""
    n = len(x) - 1
    matrix, right, row = mpmath.zeros(4 * n, 4 * n), mpmath.zeros(4 * n, 1), 0
    for i in range(n):
        h = mpmath.mpf(x[i + 1]) - mpmath.mpf(x[i])
        matrix[row, 4 * i], right[row] = 1, y[i]
        for k in range(4):
            matrix[row + 1, 4 * i + k] = h**k
        right[row + 1] = y[i + 1]
        row += 2
        if i < n - 1:
            for order, powers in ((1, (1, 2 * h, 3 * h**2)), (2, (2, 6 * h))):
                for k, factor in enumerate(powers):
                    matrix[row, 4 * i + order + k] = factor
                matrix[row, 4 * (i + 1) + order] = -powers[0]
                row += 1
    for i in (0, n - 2):
        matrix[row, 4 * i + 3], matrix[row, 4 * (i + 1) + 3] = 1, -1
        row += 1
    solved = mpmath.lu_solve(matrix, right)
    i = max(k for k in range(n) if x[k] <= t)
    return sum(solved[4 * i + k] * (mpmath.mpf(t) - mpmath.mpf(x[i])) ** k for k in range(4))


@pytest.mark.parametrize("count", [4, 5, 9])
def test_spline_against_fifty_digits(count: int) -> None:
    random = np.random.default_rng(count)
    x = np.cumsum(random.uniform(0.2, 2.0, count)).tolist()
    y = random.normal(size=count).tolist()
    law = TableLaw(tuple(x), tuple(y))
    for t in random.uniform(x[0], x[-1], 12).tolist():
        with mpmath.workdps(50):
            exact = float(exact_spline(x, y, t))
        # The steps differ by less than 10, so the system's condition is below 100.
        assert law.jet(math, t) == pytest.approx(exact, abs=100 * 8 * EPS * max(map(abs, y)) * 10)


@given(
    st.lists(st.floats(0.1, 5), min_size=3, max_size=12),
    st.randoms(use_true_random=False),
)
def test_spline_agrees_with_scipy_and_is_smooth(steps: list[float], random: "object") -> None:
    x = np.cumsum([0.0, *steps])
    y = np.array([random.uniform(-1, 1) for _ in x])  # type: ignore[attr-defined]
    law = TableLaw(tuple(x.tolist()), tuple(y.tolist()))
    t = np.linspace(x[0], x[-1], 41)
    t[-1] = x[-1]
    peer = CubicSpline(x, y)(t)
    np.testing.assert_allclose(law.jet(ARRAYS, t), peer, atol=1e-10 * max(1.0, np.abs(peer).max()))
    np.testing.assert_allclose(law.jet(ARRAYS, x), y, atol=1e-10 * max(1.0, np.abs(peer).max()))


def test_cubics_are_reproduced_exactly_and_join_in_two_derivatives() -> None:
    x = (0.0, 0.5, 2.0, 3.0, 3.5)
    law = TableLaw(x, tuple(t**3 - 2 * t for t in x))
    assert law.jet(math, 1.3) == pytest.approx(1.3**3 - 2.6, rel=8 * EPS)
    bent = TableLaw(x, (0.0, 1.0, -1.0, 2.0, 0.5))
    for (_, left), (knot, right) in pairwise(zip(x, bent.cubics[1:-1], strict=False)):
        h = knot - x[x.index(knot) - 1]
        assert left[1] + 2 * left[2] * h + 3 * left[3] * h**2 == pytest.approx(right[1], abs=1e-13)
        assert 2 * left[2] + 6 * left[3] * h == pytest.approx(2 * right[2], abs=1e-13)


def test_few_rows_give_a_line_and_a_parabola() -> None:
    assert TableLaw((0.0, 2.0), (1.0, 5.0)).jet(math, 0.5) == 2.0
    assert TableLaw((0.0, 1.0, 3.0), (0.0, 1.0, 9.0)).jet(math, 2.0) == 4.0


def test_jets_give_the_derivatives() -> None:
    x = (0.0, 1.0, 2.0, 4.0)
    law = TableLaw(x, tuple(t**3 for t in x))
    jet = law.jet(math, Jet.variable(3.0, 3))
    assert [jet.derivative(k) for k in range(4)] == pytest.approx([27.0, 27.0, 18.0, 6.0], rel=1e-13)
    many = law.jet(ARRAYS, Jet.variable(np.array([0.5, 3.0]), 2))
    np.testing.assert_allclose(many.derivative(1), [0.75, 27.0], rtol=1e-12)
    np.testing.assert_allclose(many.derivative(2), [3.0, 18.0], rtol=1e-12)


def test_outside_the_table_there_is_nothing() -> None:
    law = TableLaw((1.0, 2.0, 3.0), (0.0, 1.0, 0.0))
    assert law.span == (1.0, 3.0)
    assert law.jet(math, 3.0) == pytest.approx(0.0, abs=EPS)
    assert math.isnan(law.jet(math, 3.0000001))
    assert math.isnan(law.jet(math, 0.9))
    assert np.isnan(law.jet(ARRAYS, np.array([0.9, 1.0, 3.0, 3.1, np.nan]))).tolist() == [1, 0, 0, 1, 1]
    outside = law.jet(ARRAYS, Jet.variable(np.array([0.0, 2.0]), 1))
    assert np.isnan(outside.derivative(1)).tolist() == [True, False]


@pytest.mark.parametrize(
    ("times", "values", "message"),
    [
        ((0.0,), (1.0,), "at least two rows"),
        ((), (), "at least two rows"),
        ((0.0, 1.0), (1.0,), "at least two rows"),
        ((0.0, 1.0, 1.0), (0.0, 1.0, 2.0), "at row 3: 1.0, then 1.0"),
        ((0.0, math.nan), (0.0, 1.0), "finite"),
        ((0.0, 1.0), (0.0, math.inf), "finite"),
        ((0.0, 1e-300, 2e-300, 3e-300), (0.0, 1.0, -1.0, 1.0), "too close"),
    ],
)
def test_bad_tables_are_refused(times: tuple[float, ...], values: tuple[float, ...], message: str) -> None:
    with pytest.raises(InputError, match=message):
        TableLaw(times, values)


def test_laws_can_be_sent_and_compared() -> None:
    law = TableLaw((0.0, 1.0), (0.0, 1.0))
    assert pickle.loads(pickle.dumps(law)) == law
    assert TextLaw("t") == TextLaw("t") != TextLaw("2*t")
