"""Line contact against the theory's integrals, the coefficients of Roark's table, and the source's formula."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import minimize_scalar

from centrode.cams.contact_stress import (
    DEEPEST_SHEAR,
    GREATEST_SHEAR,
    ContactMaterial,
    LineContact,
    contact_modulus,
    contact_strip,
    line_contact,
    normal_load,
    reduced_elasticity,
    relative_curvature,
    source_stress,
)
from centrode.errors import InputError

EPS = 2.0**-52
STEEL = ContactMaterial(2.06e11, 0.3)
BRONZE = ContactMaterial(1.1e11, 0.34)
PAIRS = [
    (STEEL, STEEL),
    (STEEL, BRONZE),
    (ContactMaterial(3e9, 0.5), STEEL),
    (STEEL, ContactMaterial(7e10, 0.0)),
]


@pytest.mark.parametrize(("first", "second"), PAIRS)
@pytest.mark.parametrize(("r", "R"), [(0.012, 0.05), (0.012, math.inf), (0.012, -0.03), (2.0, 0.1)])
def test_the_strip_is_in_equilibrium_and_fills_the_gap(
    first: ContactMaterial, second: ContactMaterial, r: float, R: float
) -> None:
    """The pressures add up to the load, and bend both surfaces by just what the gap between the cylinders asks.

    Half-planes under p(s) have slopes that differ by 2/(pi E*) int p(s)/(x - s) ds (Johnson, 2.24), which in the
    strip has to be x (1/r + 1/R). With s = a cos t the singular part integrates to 0: (p(s) - p(x))/(x - s) is
    smooth inside.
    """
    kappa, load = 1 / r + 1 / R, 3.7e5
    modulus = contact_modulus(first, second)
    found = line_contact(load, kappa, modulus)
    a, peak = float(found.half_width), float(found.pressure)
    nodes = (np.arange(400) + 0.5) * math.pi / 400
    whole = np.sum(peak * np.sin(nodes) * a * np.sin(nodes)) * math.pi / 400
    # the midpoint rule is exact for a trigonometric polynomial of this degree; 400 sums round
    assert whole == pytest.approx(load, rel=400 * EPS)
    for x in np.array([-0.83, -0.31, 0.12, 0.57]) * a:
        here = math.sqrt(1 - (x / a) ** 2)
        # Chebyshev's second kind: pv int sqrt(1 - s^2)/(x - s) ds = pi x
        smooth = quad(
            lambda t, x=x, here=here: (math.sin(t) - here) / (x - a * math.cos(t)) * a * math.sin(t),
            0,
            math.pi,
            points=[math.acos(x / a)],
            limit=400,
        )
        left = here * math.log((a + x) / (a - x))
        slope = 2 / (math.pi * modulus) * peak * (smooth[0] + left)
        room = 2 / (math.pi * modulus) * peak * smooth[1] + 64 * EPS * abs(x * kappa)
        assert slope == pytest.approx(x * kappa, abs=room)


def test_the_shear_below_the_strip() -> None:
    """From the forces on the surface by Flamant's field, added up; its greatest value found by search."""
    count = 4000
    t = (np.arange(count) + 0.5) * math.pi / count
    s, force = np.cos(t), np.sin(t) ** 2 * math.pi / count

    def shear(z: float) -> float:
        square = s**2 + z**2
        down = -2 / math.pi * np.sum(force * z**3 / square**2)
        along = -2 / math.pi * np.sum(force * s**2 * z / square**2)
        return 0.5 * (along - down)

    found = minimize_scalar(lambda z: -shear(z), bounds=(0.3, 1.5), method="bounded", options={"xatol": 1e-9})
    # periodic integrand without poles near the real axis: the sum is exact to its rounding
    assert shear(DEEPEST_SHEAR) == pytest.approx(GREATEST_SHEAR, rel=count * EPS)
    assert -found.fun == pytest.approx(GREATEST_SHEAR, rel=count * EPS)
    # a flat top: the place is known to the root of the value's rounding
    assert found.x == pytest.approx(DEEPEST_SHEAR, abs=math.sqrt(count * EPS))
    for value, printed in ((DEEPEST_SHEAR, 0.786), (GREATEST_SHEAR, 0.300)):  # Johnson, (4.47)
        assert abs(value - printed) <= 0.0005


@pytest.mark.parametrize(("r", "R"), [(0.01, 0.04), (0.01, math.inf), (0.01, -0.025)])
def test_the_coefficients_of_tables(r: float, R: float) -> None:
    """Roark's Formulas for Stress and Strain, table of contact stresses: cylinders, on a plane, in a groove.

    greatest pressure 0.798 sqrt(p/(KD CE)), width of the strip 1.60 sqrt(p KD CE); with nu = 0.3 and equal E
    0.591 sqrt(p E/KD) and 2.15 sqrt(p KD/E). KD is D1 D2/(D1 + D2), D2, or D1 D2/(D1 - D2).
    """
    kd = 2 / (1 / r + 1 / R)
    load, (first, second) = 2.5e5, PAIRS[1]
    ce = (1 - first.poisson**2) / first.elasticity + (1 - second.poisson**2) / second.elasticity
    found = line_contact(load, 1 / r + 1 / R, contact_modulus(first, second))
    assert abs(found.pressure / math.sqrt(load / (kd * ce)) - 0.798) <= 0.0005
    assert abs(2 * found.half_width / math.sqrt(load * kd * ce) - 1.60) <= 0.005
    same = line_contact(load, 1 / r + 1 / R, contact_modulus(STEEL, STEEL))
    assert abs(same.pressure / math.sqrt(load * STEEL.elasticity / kd) - 0.591) <= 0.0005
    assert abs(2 * same.half_width / math.sqrt(load * kd / STEEL.elasticity) - 2.15) <= 0.005


def test_cylinders_by_hand() -> None:
    """Steel (207 GPa, 0.292), diameters 20 and 40 mm, 1000 N over 25 mm, with Shigley's arrangement of it.

    b^2 = 2 F/(pi l) (2 (1 - nu^2)/E)/(1/d1 + 1/d2), p = 2 F/(pi b l), in newtons and millimetres.
    """
    half = math.sqrt(2 * 1000 / (math.pi * 25) * (2 * (1 - 0.292**2) / 207e3) / (1 / 20 + 1 / 40))
    steel = ContactMaterial(207e9, 0.292)
    found = line_contact(1000 / 0.025, 1 / 0.010 + 1 / 0.020, contact_modulus(steel, steel))
    assert found.half_width == pytest.approx(1e-3 * half, rel=16 * EPS)
    assert found.pressure == pytest.approx(1e6 * 2 * 1000 / (math.pi * half * 25), rel=16 * EPS)


def test_the_factor_of_the_source_is_that_of_steel() -> None:
    """0.418 is sqrt(1/(2 pi (1 - 0.3^2))) = 0.41820 in three digits, and so is sqrt(0.175) = 0.41833."""
    exact = math.sqrt(1 / (2 * math.pi * (1 - 0.3**2)))
    assert abs(exact - 0.418) <= 0.0005
    assert abs(math.sqrt(0.175) - 0.418) <= 0.0005
    contact = LineContact(5000.0, 0.02, 0.015, STEEL, STEEL)
    gamma, curvature = np.array([0.0, 0.2, -0.4]), np.array([10.0, 20.0, -5.0])
    ratio = source_stress(contact, gamma, curvature) / contact_strip(contact, gamma, curvature).pressure
    assert ratio == pytest.approx(0.418 / exact, rel=16 * EPS)
    assert np.all(abs(ratio - 1) <= 0.0005 / exact)


def test_the_formula_in_its_own_units() -> None:
    """Newtons, millimetres and megapascals, as the paper writes (11)."""
    contact = LineContact(3000.0, 0.018, 0.012, STEEL, BRONZE)
    gamma, curvature = 0.15, 22.0
    r, R = 12.0, 1000 / curvature - 12.0
    elasticity = 2 * 2.06e5 * 1.1e5 / (2.06e5 + 1.1e5)
    paper = 0.418 * math.sqrt(3000 * elasticity / (18 * math.cos(gamma)) * (1 / r + 1 / R))
    assert reduced_elasticity(STEEL, BRONZE) == pytest.approx(1e6 * elasticity, rel=8 * EPS)
    assert source_stress(contact, gamma, curvature) == pytest.approx(1e6 * paper, rel=32 * EPS)


def test_curvatures_of_roller_and_cam() -> None:
    """A roller on a cam bent outwards, flat, hollow, and on the outer wall of a groove."""
    r = 0.01
    for path, cam in ((0.05, 0.04), (-0.05, -0.06), (0.011, 0.001)):
        assert relative_curvature(1 / path, r) == pytest.approx(1 / r + 1 / cam, rel=64 * EPS)
    assert relative_curvature(0.0, r) == 1 / r
    assert relative_curvature(1 / 0.05, r, outer=True) == pytest.approx(1 / r - 1 / 0.06, rel=64 * EPS)
    assert np.isnan(relative_curvature(np.array([100.0, 120.0]), r)).all()  # undercut
    assert np.isnan(relative_curvature(-120.0, r, outer=True))  # the roller does not fit


def test_the_normal_force_grows_with_the_pressure_angle() -> None:
    contact = LineContact(1000.0, 0.02, 0.01, STEEL, STEEL)
    assert normal_load(contact, math.pi / 3) == pytest.approx(2 * 1000 / 0.02, rel=8 * EPS)
    assert np.isnan(normal_load(contact, 2.0))


@pytest.mark.parametrize(
    "wrong",
    [
        lambda: ContactMaterial(0.0, 0.3),
        lambda: ContactMaterial(math.inf, 0.3),
        lambda: ContactMaterial(2e11, 0.51),
        lambda: ContactMaterial(2e11, math.nan),
        lambda: LineContact(-1.0, 0.02, 0.01, STEEL, STEEL),
        lambda: LineContact(1.0, 0.0, 0.01, STEEL, STEEL),
        lambda: LineContact(1.0, 0.02, math.nan, STEEL, STEEL),
    ],
)
def test_what_cannot_be(wrong: object) -> None:
    assert callable(wrong)
    with pytest.raises(InputError):
        wrong()
