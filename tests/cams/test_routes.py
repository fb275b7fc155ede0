"""Paths by steps and by the integrator against closed forms, forty digits and each other."""

from __future__ import annotations

import math

import mpmath as mp
import numpy as np
import pytest

from centrode.cams.curvature_laws import (
    ConstantCurvature,
    CurvatureLaw,
    ExponentialCurvature,
    LinearCurvature,
    SplineCurvature,
    TextCurvature,
    drawn_curvature,
)
from centrode.cams.path_integration import integrated_path
from centrode.cams.path_series import TOLERANCE, ExpandedPath, expanded_path
from centrode.cams.roller_path import SymmetricPath
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.jets import Jet, JetFunctions
from circle_path import CirclePath
from samples import few

from .conftest import exponential_path

EPS = float(np.finfo(np.float64).eps)
CIRCLES = [(0.05, 0.0, 16.0), (0.05, 0.3, 16.0), (0.05, -0.5, 25.0), (0.05, 0.0, 20.0), (0.2, 0.7, 7.0)]
JETS = JetFunctions(ARRAYS)


def allowed(path: ExpandedPath) -> float:
    """What the steps may have left out of a value over itself, and rounding."""
    return len(path.centres) * (TOLERANCE + 32 * EPS)


@pytest.mark.parametrize(("rho0", "gamma0", "k0"), CIRCLES)
def test_constant_curvature_draws_a_circle(rho0: float, gamma0: float, k0: float) -> None:
    """All places have the distance 1/k0 from a centre that lies on the normal at the start."""
    centre = (math.sin(gamma0) / k0, rho0 - math.cos(gamma0) / k0)
    for make in (expanded_path, integrated_path):
        path = make(ConstantCurvature(k0), rho0, gamma0, -3.0, 3.0)
        phi = np.linspace(path.start, path.stop, 101)
        rho, sine, cosine = path.state(phi)
        distance = np.hypot(rho * np.sin(phi) - centre[0], rho * np.cos(phi) - centre[1])
        bound = 100 * (TOLERANCE + 32 * EPS)
        assert np.all(np.abs(distance * k0 - 1.0) <= bound)
        assert np.all(np.abs(sine - k0 * (centre[0] * np.cos(phi) - centre[1] * np.sin(phi))) <= bound)
        assert np.all(np.abs(np.hypot(sine, cosine) - 1.0) <= bound)


@pytest.mark.parametrize(("rho0", "gamma0", "k0"), CIRCLES)
def test_derivatives_are_those_of_the_closed_form(rho0: float, gamma0: float, k0: float) -> None:
    x, y = math.sin(gamma0) / k0, rho0 - math.cos(gamma0) / k0
    phi = np.linspace(-0.4, 0.4, 9)
    turn = Jet.variable(phi, 5)
    along, across = JETS.sin(turn) * x + JETS.cos(turn) * y, JETS.cos(turn) * x - JETS.sin(turn) * y
    closed = along + JETS.sqrt(1.0 / k0**2 - across * across)
    path = expanded_path(ConstantCurvature(k0), rho0, gamma0, -0.4, 0.4)
    for found in (path.radius(phi, 5), CirclePath(rho0, gamma0, k0).radius(phi, 5)):
        for order in range(6):
            exact = closed.derivative(order)
            # the state's error, times what a derivative by the equations makes of it: order! over the radius of
            # convergence to that power, which is above a third here
            scale = math.factorial(order) * 3.0**order * rho0
            assert np.all(np.abs(found[order] - exact) <= allowed(path) * scale)


@pytest.mark.parametrize("ratio", [1.5, 3.0, 20.0])
@pytest.mark.parametrize("make", [expanded_path, integrated_path])
def test_beside_a_circle_the_follower_stalls_at_the_tangent(ratio: float, make: object) -> None:
    """A circle about a centre at `ratio` radii: rays of the angle asin(1/ratio) touch it."""
    radius, distance = 0.01, 0.01 * ratio
    path = make(ConstantCurvature(1 / radius), radius + distance, 0.0, -2.0, 2.0)  # type: ignore[operator]
    stall = math.asin(1 / ratio)
    # the state's error is that of a place beside the circle: it moves the tangent by as much, over the distance
    bound = 16 * EPS * len(getattr(path, "centres", range(100))) / math.cos(stall)
    assert abs(path.stop - stall) <= bound
    assert abs(path.start + stall) <= bound
    assert path.stall == pytest.approx(stall, abs=bound)
    rho, sine, cosine = path.state(np.array([path.start, path.stop]))
    assert np.all(np.abs(rho / math.sqrt(distance**2 - radius**2) - 1.0) <= 1e-6)
    assert sine == pytest.approx([1.0, -1.0], abs=1e-12)
    assert np.all(np.abs(cosine) <= 1e-6)


def test_up_to_the_stall_a_path_is_that_of_the_circle() -> None:
    path = expanded_path(ConstantCurvature(100.0), 0.03, 0.0, 0.0, 2.0)
    stall = math.asin(0.5)
    left = np.logspace(-1, -14, 27)
    phi = stall - left
    rho = 0.02 * np.cos(phi) + np.sqrt(0.01**2 - (0.02 * np.sin(phi)) ** 2)
    found = path.radius(phi)[0]
    # a rounding of the angle moves rho by as much times its slope, which is that of a root
    assert np.all(np.abs(found / rho - 1.0) <= len(path.centres) * (TOLERANCE + 8 * EPS / np.sqrt(left)))


@pytest.mark.parametrize("seed", range(few(2, 4)))
def test_random_exponentials_agree_with_forty_digits(seed: int) -> None:
    draw = np.random.default_rng(seed)
    rho0, gamma0 = 10 ** draw.uniform(-2, 1), draw.uniform(-0.5, 0.5)
    k0, k1 = draw.uniform(0.4, 1.2) / rho0, draw.uniform(-1.0, 1.0)
    law = ExponentialCurvature(k0, k1)
    for stop in (0.8, -0.8):
        exact_rho, exact_gamma, exact_slope = exponential_path(k0, k1, rho0, gamma0, stop)
        for make in (expanded_path, integrated_path):
            path = make(law, rho0, gamma0, min(stop, 0.0), max(stop, 0.0))
            at = np.array([stop])
            bound = 20 * (TOLERANCE + 32 * EPS)
            assert abs(path.radius(at)[0, 0] / float(exact_rho) - 1.0) <= bound
            assert abs(path.sine(at)[0, 0] - float(mp.sin(exact_gamma))) <= bound
            assert abs(path.sine(at, 1)[1, 0] - float(exact_slope)) <= 2 * bound


LAWS: list[CurvatureLaw] = [
    ExponentialCurvature(10.0, 0.75),
    ExponentialCurvature(10.0, -2.0),
    LinearCurvature(15.0, 4.0),
    SplineCurvature((-1.0, -0.2, 0.4, 1.0), (20.0, 14.0, 11.0, 25.0)),
    TextCurvature("15+5*sin(3*phi)", -0.9, 0.9),
    TextCurvature("15+8*abs(phi-0.25)", -0.9, 0.9),
    TextCurvature("20+4*sign(phi+0.3)", -0.9, 0.9),
]


@pytest.mark.parametrize("law", LAWS, ids=str)
def test_both_routes_draw_the_same_path(law: CurvatureLaw) -> None:
    steps, integrated = (make(law, 0.05, 0.1, -0.9, 0.9) for make in (expanded_path, integrated_path))
    phi = np.linspace(-0.9, 0.9, 181)
    one, other = steps.state(phi), integrated.state(phi)
    # steps of the integrator are no longer than 0.02: a hundred or two, a rounding or two each
    bound = allowed(steps) + 400 * EPS
    assert np.all(np.abs(other[0] / one[0] - 1.0) <= bound)
    assert np.all(np.abs(other[1] - one[1]) <= 4 * bound)


@pytest.mark.parametrize("law", LAWS[:5], ids=str)
def test_the_drawn_curve_has_the_curvature_of_the_law(law: CurvatureLaw) -> None:
    """The circle through three places of a curve is off by the square of their distance."""
    path = expanded_path(law, 0.05, 0.1, -0.9, 0.9)
    errors = []
    for count in (91, 181, 361):
        phi = np.linspace(-0.9, 0.9, count)
        drawn = drawn_curvature(phi, path.radius(phi)[0])
        smooth = ~np.any([np.abs(phi - place) < 0.05 for place in (*law.breaks, 9.0)], axis=0)
        errors.append(float(np.nanmax(np.abs(drawn / path.curvature(phi)[0] - 1.0)[smooth])))
    orders = [math.log2(errors[0] / errors[1]), math.log2(errors[1] / errors[2])]
    assert orders == pytest.approx([2.0, 2.0], abs=0.1)  # the next order of the error is a hundredth of it
    assert errors[2] < 1e-3


def test_tolerance_is_kept_and_costs_steps() -> None:
    law = ExponentialCurvature(10.0, 0.75)
    fine = expanded_path(law, 0.05, tolerance=1e-15)
    phi = np.linspace(0.0, math.pi / 2, 91)
    for tolerance in (1e-4, 1e-8, 1e-12):
        path = expanded_path(law, 0.05, tolerance=tolerance)
        assert path.order < fine.order
        apart = np.abs(path.radius(phi)[0] / fine.radius(phi)[0] - 1.0)
        assert np.all(apart <= 4 * len(path.centres) * tolerance)


def test_symmetric_paths_are_even() -> None:
    half = expanded_path(ExponentialCurvature(10.0, 0.75), 0.05)
    both = SymmetricPath(half)
    phi = np.linspace(0.0, math.pi / 2, 31)
    parity = np.array([1.0, -1.0, 1.0, -1.0])[:, None]
    assert np.array_equal(both.radius(-phi, 3)[:, 1:], (parity * half.radius(phi, 3))[:, 1:])
    assert np.array_equal(both.pressure_angle(-phi), -half.pressure_angle(phi))
    assert np.array_equal(both.curvature(-phi)[0], half.curvature(phi)[0])
    assert (both.start, both.stop) == (-half.stop, half.stop)


def test_places_outside_are_absent() -> None:
    path = expanded_path(ExponentialCurvature(10.0, 0.75), 0.05, 0.0, -0.5, 1.0)
    outside = np.array([-0.6, 1.1, np.nan])
    assert np.isnan(path.radius(outside, 2)).all()
    assert np.isnan(path.pressure_angle(outside)).all()
    assert np.isnan(path.curvature(outside)).all()
    assert np.isfinite(path.radius(np.array([-0.5, 1.0]), 2)).all()
