"""Sizes of flywheels of a given moment of inertia: a rim on thin spokes, a disc.

With D the outer diameter, d = psi_h D the inner one (0 of a disc), b = psi_b D the width and rho the density,
J = pi rho b (D^4 - d^4) / 32 and m = pi rho b (D^2 - d^2) / 4; spokes and hub are left out.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

SOURCE_DENSITY, SOURCE_WIDTH, SOURCE_INNER = 7800.0, 0.2, 0.8
"""Density [kg/m^3], width and inner diameter over the outer one, of the coursework (docs: flywheel)."""
SOURCE_RIM, SOURCE_DISC = 0.437, 0.366
"""Its coefficients of J^(1/5); the one of the rim does not fit its own data."""
SOURCE_RIM_MASS, SOURCE_DISC_MASS = 6123.0, 1230.0


@dataclass(frozen=True)
class Wheel:
    """A flywheel of one shape.

    Attributes
    ----------
    outer, inner, width : float [m]
    mass : float [kg]
    inertia : float [kg m^2]
    rim_speed : float [m/s]
        Of the outer edge at the greatest speed of its shaft.
    bounded : bool
        The admissible rim speed bounds the diameter; the width follows, not the proportion.
    """

    outer: float
    inner: float
    width: float
    mass: float
    inertia: float
    rim_speed: float
    bounded: bool = False


def inertia_of(outer: float, inner: float, width: float, density: float) -> float:
    """Moment of inertia [kg m^2] of a ring about its axis; lengths [m], density [kg/m^3]."""
    return math.pi * density * width * (outer**4 - inner**4) / 32


def mass_of(outer: float, inner: float, width: float, density: float) -> float:
    """Mass [kg] of a ring."""
    return math.pi * density * width * (outer**2 - inner**2) / 4


def wheel(
    inertia: float,
    density: float,
    width: float,
    inner: float,
    speed: float,
    rim_speed: float | None = None,
) -> Wheel:
    """The flywheel of a moment of inertia [kg m^2], exactly.

    Parameters
    ----------
    density : float [kg/m^3]
    width, inner : float
        Width and inner diameter over the outer one; 0 inside is a disc.
    speed : float [rad/s]
        Greatest speed of its shaft.
    rim_speed : float [m/s], optional
        Greatest admissible one: bounds the diameter; then the width follows from the inertia.
    """
    outer = (32 * inertia / (math.pi * density * width * (1 - inner**4))) ** 0.2
    broad, bounded = width * outer, False
    if rim_speed is not None and 0.5 * speed * outer > rim_speed:
        outer, bounded = 2 * rim_speed / speed, True
        broad = inertia / inertia_of(outer, inner * outer, 1.0, density)
    hole = inner * outer
    mass = mass_of(outer, hole, broad, density)
    return Wheel(
        outer, hole, broad, mass, inertia_of(outer, hole, broad, density), 0.5 * speed * outer, bounded
    )


def by_source(inertia: float, speed: float, *, rim: bool) -> Wheel:
    """The flywheel by the coefficients of the coursework; `inertia` of the result is what these sizes really have."""
    coefficient, hole = (SOURCE_RIM, SOURCE_INNER) if rim else (SOURCE_DISC, 0.0)
    outer = coefficient * inertia**0.2
    inner, width = hole * outer, SOURCE_WIDTH * outer
    mass = SOURCE_RIM_MASS * (outer**2 - inner**2) * width if rim else SOURCE_DISC_MASS * outer**3
    real = inertia_of(outer, inner, width, SOURCE_DENSITY)
    return Wheel(outer, inner, width, mass, real, 0.5 * speed * outer)
