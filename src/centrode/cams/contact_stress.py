"""Contact of the roller with the cam: a line contact after Hertz, and the formula of the source.

Everything is SI: forces [N], lengths [m], elasticity and stress [Pa]. A curvature is positive where a body bulges.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from centrode.cams.roller_path import RollerPath
from centrode.errors import InputError
from centrode.locale import _
from centrode.numerics.search import tops

Array = NDArray[np.float64]

SOURCE_FACTOR = 0.418
"""Of (11) in the paper, as printed: sqrt(1 / (2 pi (1 - nu^2))) is 0.41820 for nu = 0.3."""

DEEPEST_SHEAR = math.sqrt((math.sqrt(5) - 1) / 2)
"""Depth of the greatest shear over the half width. With s = (depth / half width)^2 the shear below the middle of
the strip, p (sqrt(s) - s / sqrt(1 + s)), is greatest where s^2 + s = 1; it is there p s^(5/2)."""

GREATEST_SHEAR = DEEPEST_SHEAR**5
"""Greatest shear over the greatest pressure: 0.30028."""


@dataclass(frozen=True)
class ContactMaterial:
    """An elastic material: Young's modulus [Pa] and Poisson's ratio."""

    elasticity: float
    poisson: float

    def __post_init__(self) -> None:
        if not (math.isfinite(self.elasticity) and self.elasticity > 0):
            what = _("the modulus of elasticity must be positive, got {value:g} Pa")
            raise InputError("elasticity", what.format(value=self.elasticity), _("steel has about 210 GPa"))
        if not 0 <= self.poisson <= 0.5:
            what = _("Poisson's ratio must lie between 0 and 0.5, got {value:g}").format(value=self.poisson)
            raise InputError("poisson", what, _("steel has about 0.3"))


@dataclass(frozen=True)
class Pressed:
    """A strip of contact.

    Attributes
    ----------
    half_width : (...) [m]
    pressure : (...) [Pa]
        The greatest, in the middle of the strip.
    shear : (...) [Pa]
        The greatest, below the surface.
    depth : (...) [m]
        Where the shear is greatest.
    """

    half_width: Array
    pressure: Array
    shear: Array
    depth: Array


@dataclass(frozen=True)
class LineContact:
    """What presses a roller on a cam.

    Attributes
    ----------
    force : float [N]
        Along the follower (leg).
    width : float [m]
        Length of the line of contact.
    roller_radius : float [m]
    cam, roller : ContactMaterial
    outer : bool
        The roller leans on the outer wall of a groove instead of on the cam inside of it.
    """

    force: float
    width: float
    roller_radius: float
    cam: ContactMaterial
    roller: ContactMaterial
    outer: bool = False

    def __post_init__(self) -> None:
        for name in ("force", "width", "roller_radius"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0):
                raise InputError(name, _("must be positive, got {value:g}").format(value=value))

    @property
    def modulus(self) -> float:
        """Contact modulus of the two materials [Pa]."""
        return contact_modulus(self.cam, self.roller)


def contact_modulus(first: ContactMaterial, second: ContactMaterial) -> float:
    """Contact modulus E* [Pa] of two materials: 1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2."""
    return 1 / sum((1 - material.poisson**2) / material.elasticity for material in (first, second))


def reduced_elasticity(first: ContactMaterial, second: ContactMaterial) -> float:
    """Reduced modulus of elasticity [Pa] that the source's formula wants: 2 E1 E2 / (E1 + E2)."""
    return 2 * first.elasticity * second.elasticity / (first.elasticity + second.elasticity)


def line_contact(load: Array | float, curvature: Array | float, modulus: float) -> Pressed:
    """Line contact of two cylinders with parallel axes after Hertz.

    Parameters
    ----------
    load : (...) [N/m]
        Normal force over the length of the line.
    curvature : (...) [1/m]
        Sum of both curvatures, the hollow one negative: 1/r + 1/R.
    modulus : float [Pa]
        Of `contact_modulus`.

    Returns
    -------
    Pressed
        NaN where the curvature is not positive: no strip forms there.

    Notes
    -----
    half width sqrt(4 w / (pi kappa E*)), pressure sqrt(w kappa E* / pi). K. L. Johnson, Contact Mechanics
    (1985), sections 4.2 and 5.1. Relative rounding errors stay below 4 eps.
    """
    load, curvature = np.broadcast_arrays(np.asarray(load, float), np.asarray(curvature, float))
    bent = np.where(curvature > 0, curvature, np.nan)
    half_width = np.sqrt(4 * load / (math.pi * bent * modulus))
    pressure = np.sqrt(load * bent * modulus / math.pi)
    return Pressed(half_width, pressure, GREATEST_SHEAR * pressure, DEEPEST_SHEAR * half_width)


def relative_curvature(curvature: Array | float, roller_radius: float, outer: bool = False) -> Array:
    """Sum of the curvatures of roller and cam [1/m], from that of the path of the roller's centre.

    The cam inside is bent by 1/R = K / (1 - r K), so that 1/r + 1/R = 1 / (r (1 - r K)), also where the cam is
    flat (K = 0) or hollow (K < 0). The outer wall of a groove is hollow with R = 1/K + r. NaN where the cam is
    undercut (r K >= 1), or the roller does not fit the hollow.
    """
    bent = roller_radius * np.asarray(curvature, float)
    gap = 1 + bent if outer else 1 - bent
    return np.asarray(1 / (roller_radius * np.where(gap > 0, gap, np.nan)))


def normal_load(contact: LineContact, pressure_angle: Array | float) -> Array:
    """Normal force over the length of the line [N/m]: the force along the follower over cos gamma, no friction."""
    cosine = np.cos(np.asarray(pressure_angle, float))
    return np.asarray(contact.force / (contact.width * np.where(cosine > 0, cosine, np.nan)))


def contact_strip(contact: LineContact, pressure_angle: Array | float, curvature: Array | float) -> Pressed:
    """The strip of contact where the pressure angle [rad] and the curvature of the roller's path [1/m] are these."""
    bent = relative_curvature(curvature, contact.roller_radius, contact.outer)
    return line_contact(normal_load(contact, pressure_angle), bent, contact.modulus)


def source_stress(contact: LineContact, pressure_angle: Array | float, curvature: Array | float) -> Array:
    """Contact stress [Pa] by (11) of the paper: 0.418 sqrt(P E / (b cos gamma) (1/r + 1/R))."""
    bent = relative_curvature(curvature, contact.roller_radius, contact.outer)
    elasticity = reduced_elasticity(contact.cam, contact.roller)
    return np.asarray(SOURCE_FACTOR * np.sqrt(normal_load(contact, pressure_angle) * elasticity * bent))


# Contact stress along the path of a roller, its greatest value, and the source's formula beside it.

ANGLES = 721
"""Angles among which the greatest value is looked for, before it is refined."""
NEAR = 3
"""So many of the highest places are refined."""


@dataclass(frozen=True)
class Greatest:
    """The greatest value of something along a path, and the angle [rad] where it is."""

    value: float
    angle: float


@dataclass(frozen=True)
class Stressed:
    """Stress along a path.

    Attributes
    ----------
    phi : (n,) [rad]
    strip : Pressed
        The line contact at each angle; NaN where the cam is undercut, or the follower stalls.
    by_source : (n,) [Pa]
        The stress by the formula of the source.
    cam_radius : (n,) [m]
        Radius of curvature of the cam where the roller leans on it; negative where it is hollow.
    greatest, greatest_by_source : Greatest
        Of the pressure and of the source's stress [Pa].
    """

    phi: Array
    strip: Pressed
    by_source: Array
    cam_radius: Array
    greatest: Greatest
    greatest_by_source: Greatest


def stress_along(
    path: RollerPath, contact: LineContact, phi: Array, ends: tuple[float, float] | None = None
) -> Stressed:
    """Contact of the roller with the cam along its path.

    Parameters
    ----------
    path : RollerPath
    contact : LineContact
    phi : (n,) [rad]
        Angles between the path's ends.
    ends : (from, to) [rad]
        Where the greatest stress is looked for; the whole path if left out.
    """
    ends = ends or (path.start, path.stop)
    gamma, curvature = _state(path, phi)
    radius = contact.roller_radius
    with np.errstate(divide="ignore"):
        cam = -(1 / curvature + radius) if contact.outer else 1 / curvature - radius
    return Stressed(
        phi=phi,
        strip=contact_strip(contact, gamma, curvature),
        by_source=source_stress(contact, gamma, curvature),
        cam_radius=cam,
        greatest=greatest_along(ends, lambda at: contact_strip(contact, *_state(path, at)).pressure),
        greatest_by_source=greatest_along(ends, lambda at: source_stress(contact, *_state(path, at))),
    )


def greatest_along(ends: tuple[float, float], value: Callable[[Array], Array]) -> Greatest:
    """Greatest value between two angles [rad] of a function of angles (n,) [rad]; NaN where it is known nowhere."""
    phi = np.unique(np.append(np.linspace(*ends, ANGLES), np.clip(0.0, *ends)))

    def known(at: Array) -> Array:
        stresses = value(at)
        return np.where(np.isfinite(stresses), stresses, np.nan)

    places, values = tops(known, phi, most=NEAR)
    if not places.size:
        return Greatest(float("nan"), float("nan"))
    best = int(np.argmax(values))
    return Greatest(float(values[best]), float(places[best]))


def _state(path: RollerPath, phi: Array) -> tuple[Array, Array]:
    """Pressure angle [rad] and curvature of the path [1/m]."""
    return path.pressure_angle(phi), path.curvature(phi)[0]
