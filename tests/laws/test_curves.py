"""Curves of a rise against the accelerations that define them, integrated with forty digits."""

import math
import sys
from collections.abc import Callable
from functools import cache

import mpmath
import numpy as np
import pytest

from centrode.laws import CURVES, RiseCurve
from centrode.laws.rises import Piece
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.jets import Jet, JetFunctions
from centrode.numerics.rounding_bounds import ROUNDED, SAFETY, Rounded
from samples import spread

EPS = sys.float_info.epsilon
JETS = JetFunctions(ARRAYS)
PI = mpmath.mp.pi
Real = mpmath.mpf


def modified_sine(u: Real) -> Real:
    peak = 4 * PI**2 / (4 + PI)
    if 1 / Real(8) <= u <= 7 / Real(8):
        return peak * mpmath.cos(4 * PI / 3 * (u - 1 / Real(8)))
    return peak * mpmath.sin(4 * PI * u) if u < 0.5 else -peak * mpmath.sin(4 * PI * (1 - u))


def modified_trapezoid(u: Real) -> Real:
    if u > 0.5:
        return -modified_trapezoid(1 - u)
    peak = 8 * PI / (2 + PI)
    if u <= 1 / Real(8):
        return peak * mpmath.sin(4 * PI * u)
    return peak if u <= 3 / Real(8) else peak * mpmath.cos(4 * PI * (u - 3 / Real(8)))


def trapezoid(u: Real) -> Real:
    if u > 0.5:
        return -trapezoid(1 - u)
    return Real(16) / 3 * min(8 * u, 1, 8 * (Real(1) / 2 - u))


ACCELERATION: dict[str, Callable[[Real], Real]] = {
    "uniform": lambda u: 0 * u,
    "parabolic": lambda u: Real(4) if u < 0.5 else Real(-4),
    "harmonic": lambda u: PI**2 / 2 * mpmath.cos(PI * u),
    "cycloidal": lambda u: 2 * PI * mpmath.sin(2 * PI * u),
    "3-4-5": lambda u: 60 * u - 180 * u**2 + 120 * u**3,
    "4-5-6-7": lambda u: 420 * u**2 - 1680 * u**3 + 2100 * u**4 - 840 * u**5,
    "trapezoid": trapezoid,
    "modified sine": modified_sine,
    "modified trapezoid": modified_trapezoid,
}
PEAKS = {
    "uniform": (1.0, 0.0),
    "parabolic": (2.0, 4.0),
    "harmonic": (math.pi / 2, math.pi**2 / 2),
    "cycloidal": (2.0, 2 * math.pi),
    "3-4-5": (1.875, 10 / math.sqrt(3)),
    "4-5-6-7": (2.1875, 84 * math.sqrt(5) / 25),
    "trapezoid": (2.0, 16 / 3),
    "modified sine": (4 * math.pi / (4 + math.pi), 4 * math.pi**2 / (4 + math.pi)),
    "modified trapezoid": (2.0, 8 * math.pi / (2 + math.pi)),
}
"""Greatest speed and acceleration of a rise of 1 in the time 1."""

PRINTED = {
    "parabolic": (2.0, 4.0),
    "trapezoid": (2.0, 5.3333),
    "harmonic": (1.5708, 4.9348),
    "cycloidal": (2.0, 6.2832),
    "3-4-5": (1.875, 5.7735),
    "4-5-6-7": (2.1875, 7.5132),
    "modified sine": (1.7596, 5.5280),
    "modified trapezoid": (2.0, 4.8881),
}
"""As handbooks of cams print them, to four places."""

SMOOTH = {"uniform": 0, "parabolic": 1, "harmonic": 1, "4-5-6-7": 3}
"""Derivatives that vanish at both ends; two for the others."""

JOINTS = [0, 1 / 8, 3 / 8, 1 / 2, 5 / 8, 7 / 8, 1]
INSIDE = [1e-9, 0.01, 0.1, 0.2, 0.3, 0.45, 0.55, 0.7, 0.8, 0.9, 0.99, 1 - 2**-30]


@cache
def truth(name: str, u: float) -> list[float]:
    """s and three derivatives at u from the acceleration alone."""
    with mpmath.workdps(40):
        acceleration, at = ACCELERATION[name], Real(u)
        ends = [Real(joint) for joint in JOINTS if joint < u] + [at]
        first = 1 if name == "uniform" else 0
        speed = first + mpmath.quad(acceleration, ends)
        value = first * at + mpmath.quad(lambda v: (at - v) * acceleration(v), ends)
        near = {"h": Real(10) ** -13}
        return [float(x) for x in (value, speed, acceleration(at), mpmath.diff(acceleration, at, **near))]


def allowed(curve: RiseCurve, order: int) -> float:
    """Rounding of a derivative: the terms' sizes, times the operations on each."""

    def size(piece: Piece) -> float:
        powers = sum(
            abs(c) * math.perm(k, order) * 0.5 ** (k - order)
            for k, c in enumerate(piece.powers, 1)
            if k >= order
        )
        # sin y and the phase y, up to 2 pi, that its rounding is relative to
        waves = (abs(piece.cycloid) + abs(piece.square) * 2**order) * piece.wave**order * 8
        return abs(piece.value) + powers + waves

    return 2 * (8 + max(len(piece.powers) for piece in curve.pieces)) * EPS * max(map(size, curve.pieces))


def derivatives(curve: RiseCurve, u: float) -> list[float]:
    jet = curve.jet(JETS, Jet.variable(np.float64(u), 3))
    return [float(jet.derivative(k)) for k in range(4)]


@pytest.mark.parametrize("name", CURVES)
@pytest.mark.parametrize("u", spread(INSIDE, 6))
def test_value_and_three_derivatives(name: str, u: float) -> None:
    found = derivatives(CURVES[name], u)
    for order, (mine, exact) in enumerate(zip(found, truth(name, u), strict=True)):
        # The difference quotient of the truth itself is good to 1e-26 of the fifth derivative.
        assert mine == pytest.approx(exact, rel=0, abs=allowed(CURVES[name], order)), order


@pytest.mark.parametrize("name", CURVES)
def test_greatest_speed_and_acceleration(name: str) -> None:
    curve = CURVES[name]
    u = np.linspace(0, 1, 4001)
    jet = curve.jet(JETS, Jet.variable(u, 4))
    for order, peak in enumerate(PEAKS[name], 1):
        values = np.abs(jet.derivative(order) * np.ones(len(u)))
        # Between samples a smooth maximum is missed by its curvature; it is not smooth in the trapezoid's plateau.
        missed = np.abs(jet.derivative(order + 2) * np.ones(len(u))).max() * (u[1] / 2) ** 2 / 2
        assert peak - missed - allowed(curve, order) <= values.max() <= peak + allowed(curve, order)


@pytest.mark.parametrize("name", PRINTED)
def test_peaks_are_those_that_are_printed(name: str) -> None:
    assert PEAKS[name] == pytest.approx(PRINTED[name], rel=0, abs=0.5e-4)


@pytest.mark.parametrize("name", CURVES)
def test_ends_are_exact_and_as_smooth_as_promised(name: str) -> None:
    start, end = derivatives(CURVES[name], 0.0), derivatives(CURVES[name], 1.0)
    order = SMOOTH.get(name, 2)
    assert (start[0], end[0]) == (0.0, 1.0)
    assert start[1 : order + 1] == end[1 : order + 1] == [0.0] * order
    whole = CURVES[name].jet(JETS, Jet.variable(np.float64(0.0), order + 1))
    assert whole.derivative(order + 1) > 0  # so that a drive knows the sense in which it sets out


@pytest.mark.parametrize("name", CURVES)
def test_curves_are_symmetric(name: str) -> None:
    u = np.linspace(0, 1, 257)  # 1 - u is exact
    both = CURVES[name].jet(ARRAYS, u) + CURVES[name].jet(ARRAYS, 1 - u)
    np.testing.assert_allclose(both, 1.0, rtol=0, atol=2 * allowed(CURVES[name], 0))


@pytest.mark.parametrize("name", CURVES)
def test_pieces_join_in_value_speed_and_acceleration(name: str) -> None:
    curve = CURVES[name]
    for joint in curve.breaks[1:-1]:
        left, right = derivatives(curve, math.nextafter(joint, 0)), derivatives(curve, joint)
        for order in range(2 if name == "parabolic" else 3):
            step = EPS * (abs(right[order + 1]) + abs(left[order + 1]) + 1)
            assert left[order] == pytest.approx(right[order], abs=step + 2 * allowed(curve, order))


@pytest.mark.parametrize("name", CURVES)
def test_arrays_scalars_and_shapes(name: str) -> None:
    curve = CURVES[name]
    u = np.linspace(0, 1, 12).reshape(3, 4)
    many = curve.jet(ARRAYS, u)
    assert many.shape == (3, 4)
    one = [curve.jet(math, number) for number in u.ravel().tolist()]
    np.testing.assert_allclose(many.ravel(), one, rtol=0, atol=allowed(curve, 0))
    assert isinstance(curve.jet(math, 1), float)  # whole numbers too
    assert math.isnan(curve.jet(math, math.nan))


@pytest.mark.parametrize("name", CURVES)
def test_bounds_of_rounding_hold(name: str) -> None:
    u = np.array(INSIDE)
    found = CURVES[name].jet(ROUNDED, Rounded.of(u))
    exact = np.array([truth(name, number)[0] for number in INSIDE])
    assert (np.abs(found.value - exact) <= SAFETY * found.bound).all()
    assert (found.bound <= allowed(CURVES[name], 0) + EPS * PEAKS[name][0]).all()


def test_what_is_a_little_outside_goes_on() -> None:
    for curve in CURVES.values():
        assert curve.jet(math, 1 + EPS) == pytest.approx(1.0, abs=4 * EPS)
        assert curve.jet(math, -EPS) == pytest.approx(0.0, abs=4 * EPS)
