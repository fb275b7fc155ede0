"""How far the series reaches, and what its cut leaves out."""

from __future__ import annotations

import cmath
import math
import re

import numpy as np
import pytest

import centrode as ct
from centrode.cams.cam import cam_routes, foretold_error, path_routes_results, routes_of
from centrode.cams.curvature_laws import (
    ConstantCurvature,
    ExponentialCurvature,
    LinearCurvature,
    TextCurvature,
)
from centrode.cams.path_series import convergence, expanded_path, series_path
from centrode.render import fact_rows
from centrode.topics.presentation import sheet_of

EPS = float(np.finfo(np.float64).eps)


@pytest.mark.parametrize(("gamma0", "k0"), [(0.0, 10.0), (0.3, 10.0), (-0.4, 30.0), (0.2, 70.0)])
def test_of_a_circle_the_nearest_singularity_is_known(gamma0: float, k0: float) -> None:
    """cos(gamma) = 0 where the ray touches the circle: |c| sin(phi - phi_c) = +-R, mostly at complex angles."""
    x, y = math.sin(gamma0) / k0, 0.05 - math.cos(gamma0) / k0
    towards = math.atan2(x, y)
    root = cmath.asin(1.0 / (k0 * math.hypot(x, y)))
    places = [towards + sign * root + half for sign in (1, -1) for half in (-math.pi, 0.0, math.pi)]
    places += [towards + sign * (math.pi - root) for sign in (1, -1)]
    nearest = min(abs(place) for place in places)
    found = convergence(ConstantCurvature(k0), 0.05, gamma0)
    assert found.singularity is not None
    assert found.radius == pytest.approx(nearest, rel=1e3 * EPS)
    assert found.estimate == pytest.approx(
        nearest, rel=2e-3
    )  # 160 coefficients, the next order of 1/n: n^-2 / 4


def test_a_circle_about_the_centre_converges_everywhere() -> None:
    assert convergence(ConstantCurvature(20.0), 0.05).radius == math.inf


def test_the_stall_itself_may_be_nearest() -> None:
    law = ExponentialCurvature(200.0, 0.75)
    path = expanded_path(law, 0.05)
    assert path.stall is not None
    assert convergence(law, 0.05).radius == pytest.approx(path.stall, rel=1e3 * EPS)


def test_a_singularity_of_the_law_is_told_by_the_coefficients_only() -> None:
    """A pole beside the real axis, at 0.3i, where the path has no stall."""
    found = convergence(TextCurvature("15+0.01/(0.09+phi^2)", -1.0, 1.0), 0.05)
    assert found.singularity is None
    assert found.radius == found.estimate == pytest.approx(0.3, rel=0.02)


@pytest.mark.parametrize(
    "law", [{"law": "exponential", "k0": 10, "k1": 0.75}, {"law": "linear", "k0": 12, "k1": 6}], ids=str
)
@pytest.mark.parametrize("terms", [8, 20, 40])
def test_foretold_errors_cover_the_true_ones(law: dict[str, object], terms: int) -> None:
    cam = ct.Cam(kind="cam", curvature=law, start={"radius": 0.05}, range={"to": 1.4})
    routes = routes_of(cam, terms)
    phi = np.linspace(0.0, min(1.4, 0.9 * routes.convergence.radius), 57)
    foretold = foretold_error(routes, phi)
    true = np.abs(routes.series.radius(phi)[0] - routes.steps.radius(phi)[0])
    rounding = 0.05 * terms * 1e-13
    assert np.all(true <= foretold + rounding)
    # not for nothing: terms of both signs cancel in part, a hundred times too great is still a forecast
    assert np.max(true) > 100 * rounding
    assert np.max(foretold) <= 100 * np.max(true)


def test_formulas_15_and_16_part_where_the_series_is_cut() -> None:
    example = ct.example("cam-from-curvature")
    at = np.radians([30.0, 60.0, 80.0])
    parts = [np.abs(cam_routes(example, at=at, terms=n).parting.to_numpy()) for n in (10, 20, 40)]
    assert np.all(parts[0] > 3 * parts[1])
    assert np.all(parts[1] > 3 * parts[2])
    errors = np.abs(cam_routes(example, at=at, terms=20).series_error.to_numpy())
    assert np.all(parts[1] > errors)  # without knowing the path, it tells that the series is off


def test_where_the_curvature_is_constant_formula_16_says_nothing() -> None:
    cam = ct.Cam(kind="cam", curvature={"law": "constant", "k0": 12}, start={"radius": 0.05}, range={"to": 1})
    found = cam_routes(cam, samples=5)
    assert np.isnan(found.radius_by_slope).all()
    assert np.isfinite(found.series_error).all()


def test_linear_laws_converge_alike_on_both_sides() -> None:
    one, other = (convergence(LinearCurvature(10.0, slope), 0.05) for slope in (5.0, -5.0))
    assert one.singularity is not None and other.singularity is not None
    assert one.singularity.real == pytest.approx(-other.singularity.real, rel=1e4 * EPS)


def test_zeros_of_the_curvature_do_not_spoil_many_terms() -> None:
    """K = 20 (1 + 0.3 sin 3 phi) vanishes at a complex angle that is nearer than the circle of convergence.

    300 terms leave (0.95 R / R)^300 out of the series; what divides by K makes its roundings grow 1e10 times there.
    """
    law = TextCurvature("20*(1 + 0.3*sin(3*phi))", -1.0, 1.0)
    circle = convergence(law, 0.05)
    zero = abs(complex(-math.pi / 2, math.acosh(1 / 0.3)) / 3)
    assert zero < 0.85 * circle.radius
    at = np.array([0.95 * circle.radius])
    assert at[0] < 1.0
    series = series_path(law, 0.05, stop=1.0, terms=300)
    path = expanded_path(law, 0.05, stop=1.0)
    # the terms decay like (at/R)^n n^(-3/2): the sum of those left out, times 1/(1 - at/R)
    left_out = 0.95**300 * 300**-1.5 / 0.05
    assert abs(float(series.sine(at)[0, 0] - path.sine(at)[0, 0])) < left_out


@pytest.mark.parametrize("turns", [0.0, 1.0])
def test_where_the_curvature_does_not_change_formula_16_has_no_meaning(turns: float) -> None:
    """K' = -2 sin(phi) is zero at half turns but for the rounding of pi; beside them the numbers are as before."""
    law = {"law": "formula", "formula": "12+2*cos(phi)"}
    cam = ct.Cam(kind="cam", curvature=law, start={"radius": 0.07}, range={"to": 4.0})
    flat = turns * math.pi
    found = cam_routes(cam, at=[flat, flat + 1e-3, flat + 0.1])
    assert np.isnan(found.parting.values).tolist() == [True, False, False]


def test_the_places_without_a_meaning_are_told() -> None:
    law = {"law": "formula", "formula": "12+2*cos(phi)"}
    cam = ct.Cam(kind="cam", curvature=law, start={"radius": 0.07}, range={"to": math.pi})
    results = path_routes_results(cam, 361)
    rows = fact_rows(sheet_of(results).facts, cam.display)
    (said,) = [text for _label, text in rows if "(15)" in text]
    assert said.endswith("the comparison has no meaning: φ = 0 rad (0 deg), 3.14159 rad (180 deg)")
    apart = np.abs(results.dataset.parting.values)
    assert float(re.findall(r"differ by up to (\S+) m;", said)[0]) == float(f"{np.nanmax(apart):.3g}")
    # by its neighbours, not by rounding over rounding
    assert np.nanmax(apart) < 10.0
