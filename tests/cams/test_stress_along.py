"""Stress along a path: on circles in closed form, its greatest value by its slope, and the labelled result."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.optimize import brentq

from cam_families import CONTACT, STEEL
from centrode.cams.contact_stress import LineContact, contact_strip, greatest_along, stress_along
from centrode.cams.curvature_laws import ExponentialCurvature, LinearCurvature
from centrode.cams.path_series import expanded_path
from centrode.cams.results import cam_contact
from centrode.errors import InputError
from centrode.model.cam import Cam
from centrode.model.cam_files import parse_cam
from circle_path import CirclePath

EPS = 2.0**-52
PARTS = {
    "kind": "cam",
    "curvature": {"law": "exponential", "k0": "0.01 1/mm", "k1": 0.75},
    "start": {"radius": "50 mm"},
    "range": {"to": "90 deg"},
    "roller": {"radius": "15 mm"},
    "contact": {"force": "3 kN", "width": "30 mm", "cam": {"elasticity": "206 GPa"}},
}


def test_a_round_cam_is_pressed_alike_everywhere() -> None:
    """Two cylinders of 15 and 35 mm, by the closed form of Hertz."""
    path = CirclePath(0.05, 0.0, 1 / 0.05)
    phi = np.linspace(-3, 3, 7)
    found = stress_along(path, CONTACT, phi)
    modulus = 2.06e11 / (2 * (1 - 0.3**2))
    closed = math.sqrt(3000 / 0.03 * (1 / 0.015 + 1 / 0.035) * modulus / math.pi)
    np.testing.assert_allclose(found.strip.pressure, closed, rtol=64 * EPS)
    np.testing.assert_allclose(found.cam_radius, 0.035, rtol=16 * EPS)
    assert found.greatest.value == pytest.approx(closed, rel=64 * EPS)


def test_an_eccentric_circle() -> None:
    """The pressure angle of a circle whose centre lies e from the cam's: sin gamma = e/R cos of the angle to it."""
    centre, radius = 0.008, 0.05
    path = CirclePath(radius + centre, 0.0, 1 / radius)
    phi = np.linspace(-math.pi, math.pi, 41)
    found = stress_along(path, CONTACT, phi)
    sine = centre / radius * np.sin(phi)
    closed = contact_strip(CONTACT, -np.arcsin(sine), 1 / radius).pressure
    # the angle is read off a state with errors of some roundings, over its cosine
    np.testing.assert_allclose(found.strip.pressure, closed, rtol=256 * EPS)
    assert abs(found.greatest.angle) == pytest.approx(math.pi / 2, abs=1e-7)  # a flat top: root of rounding
    assert found.greatest.value == pytest.approx(
        float(contact_strip(CONTACT, math.asin(centre / radius), 1 / radius).pressure), rel=256 * EPS
    )


def test_the_greatest_stress_is_where_its_slope_is_zero() -> None:
    """Of a curvature that falls while the pressure angle grows: gamma' tan gamma + r K'/(1 - r K) = 0."""
    law, r = LinearCurvature(22.0, -8.0), CONTACT.roller_radius
    path = expanded_path(law, 0.05, 0.0, 0.0, 1.3)

    def slope(phi: float) -> float:
        at = np.array([phi])
        gamma, (curvature, change) = path.pressure_angle(at)[0], path.curvature(at, 1)[:, 0]
        turning = 1 - path.radius(at)[0, 0] * curvature / math.cos(gamma)
        return float(turning * math.tan(gamma) + r * change / (1 - r * curvature))

    found = stress_along(path, CONTACT, np.linspace(0, 1.3, 5))
    inner = [
        brentq(slope, a, b, xtol=1e-14)
        for a, b in zip(np.linspace(0.01, 1.29, 129)[:-1], np.linspace(0.01, 1.29, 129)[1:], strict=True)
        if slope(a) > 0 >= slope(b)
    ]
    candidates = [*inner, 0.0, 1.3]
    values = [
        float(
            contact_strip(
                CONTACT, path.pressure_angle(np.array([p])), path.curvature(np.array([p]))[0]
            ).pressure[0]
        )
        for p in candidates
    ]
    assert found.greatest.value == pytest.approx(max(values), rel=16 * EPS)
    assert found.greatest.angle == pytest.approx(candidates[int(np.argmax(values))], abs=1e-6)


def test_the_highest_of_several_tops() -> None:
    found = greatest_along((0.0, 10.0), lambda x: np.sin(7 * x) + 0.01 * x)
    top = max((math.pi / 2 + math.tau * n + math.asin(0.01 / 7)) / 7 for n in range(11))
    assert found.angle == pytest.approx(top, abs=1e-7)
    nothing = greatest_along((0.0, 1.0), lambda x: np.full_like(x, np.nan))
    assert math.isnan(nothing.value)
    partly = greatest_along((0.0, 1.0), lambda x: np.where(x > 0.5, np.nan, x))
    assert partly.value == pytest.approx(0.5, abs=1e-9)


def test_an_undercut_cam_has_no_stress() -> None:
    path = expanded_path(ExponentialCurvature(40.0, 2.0), 0.025, 0.0, 0.0, 0.5)
    contact = LineContact(3000.0, 0.03, 0.02, STEEL, STEEL)
    found = stress_along(path, contact, np.array([0.0, 0.1, 0.2]))
    assert np.isfinite(found.strip.pressure[0])
    assert np.isnan(found.strip.pressure[2])  # 40 exp(0.4) * 0.02 is beyond 1


def test_the_labelled_result() -> None:
    cam = Cam(**PARTS)
    data = cam_contact(cam, 19)
    path = expanded_path(ExponentialCurvature(10.0, 0.75), 0.05, 0.0, 0.0, math.pi / 2)
    phi = np.linspace(0, math.pi / 2, 19)
    expected = stress_along(path, CONTACT, phi)
    np.testing.assert_array_equal(data["carrier_angle"], phi)
    np.testing.assert_array_equal(data["contact_stress"], expected.strip.pressure)
    np.testing.assert_array_equal(data["cam_curvature_radius"], expected.cam_radius)
    assert data["contact_stress"].attrs["units"] == "Pa"
    assert data.attrs["greatest_stress"] == expected.greatest.value
    assert "admissible_stress" not in data.attrs


def test_a_leg_is_pressed_over_its_working_arc() -> None:
    symmetric = {**PARTS["curvature"], "symmetric": True}
    legs = Cam(**{**PARTS, "curvature": symmetric, "mover": {"legs": 4, "post": 0.1}})
    data = cam_contact(legs, 5)
    assert data["carrier_angle"].values.tolist() == pytest.approx(np.linspace(-math.pi / 4, math.pi / 4, 5))
    np.testing.assert_array_equal(data["contact_stress"], data["contact_stress"][::-1])
    assert data.attrs["greatest_stress_at"] == pytest.approx(math.pi / 4)


def test_two_materials_and_a_groove() -> None:
    bronze = {"elasticity": "110 GPa", "poisson": 0.34}
    one, two = (
        cam_contact(Cam(**{**PARTS, "contact": {**PARTS["contact"], **more}}), 5)
        for more in ({}, {"roller": bronze, "outer": True})
    )
    assert (two["contact_stress"] < one["contact_stress"]).all()
    assert (two["cam_curvature_radius"] < 0).all()


@pytest.mark.parametrize(
    ("contact", "where"),
    [
        ('force = "-3 kN"\nwidth = 0.03\ncam = { elasticity = 2e11 }', "force"),
        ('force = 3\nwidth = "3 N"\ncam = { elasticity = 2e11 }', "width"),
        ('force = 3\nwidth = 0.03\ncam = { elasticity = "206 mm" }', "elasticity"),
        ("force = 3\nwidth = 0.03\ncam = { elasticity = 2e11, poisson = 0.6 }", "poisson"),
        ("force = 3\nwidth = 0.03", "cam"),
    ],
)
def test_wrong_contacts(contact: str, where: str) -> None:
    text = (
        'kind = "cam"\ncurvature = { law = "constant", k0 = 20 }\nstart = { radius = 0.05 }\n'
        "range = { to = 1 }\nroller = { radius = 0.01 }\n[contact]\n" + contact
    )
    with pytest.raises(InputError, match=where):
        parse_cam(text)


def test_no_contact() -> None:
    with pytest.raises(InputError, match="force"):
        cam_contact(Cam(**{name: part for name, part in PARTS.items() if name != "contact"}))
