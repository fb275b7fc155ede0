"""Sizes of flywheels: their inertia is the one asked for; the source's coefficients miss by what the notes say."""

from __future__ import annotations

import math

import pytest

from centrode.dynamics.steady_motion.flywheel import by_source, inertia_of, mass_of, wheel

EPS = 2.0**-52


@pytest.mark.parametrize("inner", [0.0, 0.5, 0.8, 0.95])
@pytest.mark.parametrize("inertia", [1e-4, 1.0, 1459.5])
def test_the_inertia_is_the_one_asked_for(inertia: float, inner: float) -> None:
    """By adding up thin rings."""
    made = wheel(inertia, 7800.0, 0.2, inner, 7.0)
    assert made.inner == pytest.approx(inner * made.outer, rel=4 * EPS)
    assert made.width == pytest.approx(0.2 * made.outer, rel=4 * EPS)
    rings = 2000
    step = 0.5 * (made.outer - made.inner) / rings
    radii = [0.5 * made.inner + (k + 0.5) * step for k in range(rings)]
    masses = [7800.0 * made.width * 2 * math.pi * r * step for r in radii]
    # the midpoint rule is exact for r, and misses r^3 by step^2/(4 r^2) in each ring
    assert sum(masses) == pytest.approx(made.mass, rel=1e-12)
    missed = step**2 / 4 / max(radii) ** 2 * 2
    assert sum(m * r**2 for m, r in zip(masses, radii, strict=True)) == pytest.approx(inertia, rel=missed)
    assert made.inertia == pytest.approx(inertia, rel=32 * EPS)
    assert made.rim_speed == pytest.approx(3.5 * made.outer, rel=4 * EPS)


def test_the_source_and_its_error() -> None:
    """Printed: D2 = 1.876, D1 = 1.501, b = 0.375 m, 2912 kg for 1459 kg m^2; the rim really has 2101."""
    rim, disc = (by_source(1459.0, 7.0, rim=which) for which in (True, False))
    for value, printed in ((rim.outer, 1.876), (rim.inner, 1.501), (rim.width, 0.375), (disc.outer, 1.571)):
        assert abs(value - printed) <= 0.0005
    assert abs(inertia_of(1.876, 0.8 * 1.876, 0.2 * 1.876, 7800.0) - 2101) <= 0.5
    assert rim.inertia == pytest.approx(2101, rel=0.001)  # sizes rounded to a millimetre
    right = wheel(1459.0, 7800.0, 0.2, 0.8, 7.0)
    assert right.outer / 1459.0**0.2 == pytest.approx(0.4062, abs=0.00005)
    assert right.outer == pytest.approx(1.744, abs=0.0005)
    assert right.mass == pytest.approx(2340, abs=0.5)
    assert disc.inertia == pytest.approx(1467, abs=1)
    # its 0.366 is the right coefficient to three decimals
    assert abs(wheel(1459.0, 7800.0, 0.2, 0.0, 7.0).outer / 1459.0**0.2 - 0.366) <= 0.0005


def test_the_admissible_rim_speed_bounds_the_diameter() -> None:
    free = wheel(1459.0, 7800.0, 0.2, 0.8, 50.0)
    assert free.rim_speed > 30.0
    bound = wheel(1459.0, 7800.0, 0.2, 0.8, 50.0, 30.0)
    assert bound.bounded
    assert bound.outer == pytest.approx(1.2, rel=4 * EPS)
    assert bound.inertia == pytest.approx(1459.0, rel=32 * EPS)
    assert bound.mass == pytest.approx(mass_of(1.2, 0.96, bound.width, 7800.0), rel=4 * EPS)
    assert bound.mass > free.mass
    assert not wheel(1459.0, 7800.0, 0.2, 0.8, 50.0, 50.0).bounded
