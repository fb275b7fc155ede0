"""Curvature laws: their series at any place, their breaks, and what is refused."""

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
    check_span,
    derivatives,
    unlawful_place,
)
from centrode.cams.path_series import expanded_path, series_path
from centrode.errors import InputError

EPS = float(np.finfo(np.float64).eps)
ORDER = 6

SMOOTH = [
    (ConstantCurvature(12.0), lambda x: mp.mpf(12)),
    (ExponentialCurvature(10.0, 0.75), lambda x: 10 * mp.exp(x * 3 / 4)),
    (LinearCurvature(10.0, -3.0), lambda x: 10 - 3 * x),
    (TextCurvature("12", -1.0, 1.0), lambda x: mp.mpf(12)),
    (TextCurvature("10*exp(0.75*phi)", -1.0, 1.0), lambda x: 10 * mp.exp(x * 3 / 4)),
    (TextCurvature("9+2*cos(3*phi)^2", -1.0, 1.0), lambda x: 9 + 2 * mp.cos(3 * x) ** 2),
    (TextCurvature("20-5*abs(phi-0.25)", -1.0, 1.0), lambda x: 20 - 5 * abs(x - mp.mpf(0.25))),
    (
        TextCurvature("max(11,10+phi,min(12,10+4*phi))", -1.0, 1.0),
        lambda x: max(11, 10 + x, min(12, 10 + 4 * x)),
    ),
]


@pytest.mark.parametrize(("law", "exact"), SMOOTH, ids=[str(law) for law, _exact in SMOOTH])
def test_series_are_those_of_the_formula(law: CurvatureLaw, exact: object) -> None:
    places = np.array([-0.7, 0.1, 0.4, 0.8])
    found = np.asarray(law.series(places, ORDER))
    with mp.workdps(40):
        for column, place in enumerate(places):
            taylor = [float(c) for c in mp.taylor(exact, mp.mpf(place), ORDER)]
            assert np.all(np.abs(found[:, column] - taylor) <= 64 * EPS * (10 + np.abs(taylor)))
            assert law.series(float(place), ORDER) == pytest.approx(found[:, column].tolist(), rel=8 * EPS)


def test_kinks_are_found_to_rounding_and_have_two_sides() -> None:
    law = TextCurvature("15+abs(phi-0.3)+4*sign(phi+0.5)", -1.0, 1.0)
    assert law.breaks == pytest.approx((-0.5, 0.3), abs=2 * EPS)
    low, high = law.breaks
    assert law.series(high, 1, 1) == pytest.approx([19.0, 1.0])
    assert law.series(high, 1, -1) == pytest.approx([19.0, -1.0])
    assert law.series(low, 0, 1)[0] - law.series(low, 0, -1)[0] == pytest.approx(8.0)
    assert TextCurvature("12+abs(phi)", -1.0, 1.0).breaks == (0.0,)
    assert TextCurvature("12+abs(phi)*abs(phi)", 0.0, 1.0).breaks == ()


def test_a_series_of_a_stretch_ends_at_its_break() -> None:
    path = series_path(TextCurvature("15+5*abs(phi-0.4)", -1.0, 1.5), 0.05, 0.0, -1.0, 1.5, 30)
    assert (path.start, path.stop) == (-1.0, pytest.approx(0.4, abs=2 * EPS))
    assert np.isnan(path.radius(np.array([0.5]))).all()
    kinked = series_path(TextCurvature("15+5*abs(phi)", -1.0, 1.5), 0.05, 0.0, -1.0, 1.5, 30)
    assert (kinked.start, kinked.stop) == (0.0, 1.5)


def test_splines_pass_through_their_points_and_have_knots() -> None:
    points = ((-1.0, 20.0), (-0.2, 14.0), (0.4, 11.0), (1.0, 25.0))
    law = SplineCurvature(*zip(*points, strict=True))
    phi, values = np.array(points).T
    assert derivatives(law, phi)[0] == pytest.approx(values, rel=8 * EPS)
    assert law.breaks == (-0.2, 0.4)
    for knot in (
        law.breaks
    ):  # twice continuously differentiable; not-a-knot makes the third derivative continuous too
        before, behind = law.series(knot, 3, -1), law.series(knot, 3, 1)
        assert before[:3] == pytest.approx(behind[:3], rel=1e3 * EPS)
    assert np.isnan(derivatives(law, np.array([-1.1, 1.1]))).all()
    assert np.isfinite(derivatives(law, phi, 2)).all()


@pytest.mark.parametrize(
    ("law", "place"),
    [
        (LinearCurvature(10.0, -9.0), 10 / 9),
        (TextCurvature("10-20*phi^2", -1.0, 1.5), math.sqrt(0.5)),
        (TextCurvature("(phi-0.5)^2*40", -1.0, 1.5), 0.5),
        (TextCurvature("(phi-0.5)^2*40+1e-9", -1.0, 1.5), None),
        (TextCurvature("10+log(0.75-phi)", -1.0, 1.5), 0.75 - math.exp(-10)),
        (TextCurvature("10/(0.7-phi)", -1.0, 1.5), 0.7),
        (ExponentialCurvature(10.0, -9.0), None),
    ],
    ids=str,
)
def test_the_place_where_a_curvature_ends_to_be_one(law: CurvatureLaw, place: float | None) -> None:
    found = unlawful_place(law, 1.5)
    if place is None:
        assert found is None
    else:
        # of a double root only the square is known to rounding
        assert found == pytest.approx(place, abs=1e-8 if "^2*40" in str(law) else 1e-14)


def test_stalls_come_before_what_the_law_does_behind_them() -> None:
    law = TextCurvature("200-150*phi", -1.0, 1.5)  # not positive from 4/3 on
    path = expanded_path(law, 0.05, 0.0, 0.0, 1.5)
    assert path.stall is not None
    assert path.stall < 4 / 3


REFUSED: list[tuple[str, dict[str, object], str]] = [
    ("10-9*phi", {"stop": 1.5}, "the curvature is not positive from 63.662 deg on"),
    ("10+9*phi", {"start": -1.5}, "the curvature is not positive from -63.662 deg on"),
    ("-3", {}, "the curvature at the start is not positive (-3 1/m)"),
    ("0", {}, "the curvature at the start is not positive (0 1/m)"),
    ("1/phi", {}, "the curvature is not a finite number at 0 deg"),
    ("log(phi-1)", {}, "the curvature is not a finite number at 0 deg"),
    ("10+sqrt(phi)", {}, "the path has no Taylor series at 0 deg"),
    ("10+sqrt(abs(phi-0.3))", {}, "the path has no Taylor series at 17.18"),
    ("1e-9", {"stop": 1.6}, "the path diverges from the cam's centre"),
    ("1e9", {}, "check the units of the curvature"),
    ("15+abs(sin(1200*phi))", {}, "the formula has corners at more than 1000 places"),
    ("15+sin(50000*phi)", {}, "the path needs more than 5000 steps"),
    ("15", {"start": 0.1}, "the range must contain the start phi = 0"),
    ("15", {"stop": -0.1}, "the range must contain the start phi = 0"),
    ("15", {"stop": 0.0}, "the range must contain the start phi = 0"),
    ("15", {"stop": 100.0}, "the range is longer than 10 turns"),
    ("15", {"stop": math.nan}, "finite numbers are needed"),
    ("15", {"rho0": -1.0}, "the radius at the start has to be positive"),
    ("15", {"gamma0": 1.57}, "the pressure angle at the start must lie within 89 deg"),
    ("15", {"tolerance": 1.0}, "the tolerance must lie between"),
]


@pytest.mark.parametrize(("text", "given", "said"), REFUSED, ids=[f"{t} {g}" for t, g, _s in REFUSED])
def test_what_is_no_path_is_refused(text: str, given: dict[str, object], said: str) -> None:
    keys = {"rho0": 0.05, "gamma0": 0.0, "start": 0.0, "stop": 1.0} | given
    with pytest.raises(InputError) as refused:
        expanded_path(TextCurvature(text, -1.5, 1.6), **keys)  # type: ignore[arg-type]
    assert said in str(refused.value)


def test_other_refusals() -> None:
    with pytest.raises(
        InputError, match=r"the curvature is known from 0 to 57\.\d+ deg, the range is 0 to 90 deg"
    ):
        check_span(SplineCurvature((0.0, 0.5, 1.0), (10.0, 11.0, 12.0)), 0.0, math.pi / 2)
    with pytest.raises(InputError, match="2001 terms are given; give 2 to 2000"):
        series_path(ConstantCurvature(12.0), 0.05, terms=2001)
    with pytest.raises(
        InputError, match="the coefficients of the series exceed the range of floating-point numbers"
    ):
        series_path(ExponentialCurvature(5000.0, 3.0), 0.05, terms=2000)
    for value in (0.0, -1.0, math.inf, math.nan):
        with pytest.raises(InputError, match="a curvature has to be positive and finite"):
            ConstantCurvature(value)
    with pytest.raises(InputError, match="finite numbers only"):
        ExponentialCurvature(1.0, math.nan)
