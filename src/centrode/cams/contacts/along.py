"""Contact stress along the path of a roller, its greatest value, and the source's formula beside it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from centrode.cams.contacts.line import Contact, Pressed, pressed, source_stress
from centrode.cams.path import RollerPath
from centrode.numerics.search import tops

Array = NDArray[np.float64]

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
    path: RollerPath, contact: Contact, phi: Array, ends: tuple[float, float] | None = None
) -> Stressed:
    """Contact of the roller with the cam along its path.

    Parameters
    ----------
    path : RollerPath
    contact : Contact
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
        strip=pressed(contact, gamma, curvature),
        by_source=source_stress(contact, gamma, curvature),
        cam_radius=cam,
        greatest=greatest_along(ends, lambda at: pressed(contact, *_state(path, at)).pressure),
        greatest_by_source=greatest_along(ends, lambda at: source_stress(contact, *_state(path, at))),
    )


def greatest_along(ends: tuple[float, float], value: Callable[[Array], Array]) -> Greatest:
    """Greatest value between two angles [rad] of a function of angles (n,) [rad]; NaN where it is known nowhere."""
    phi = np.unique(np.append(np.linspace(*ends, ANGLES), np.clip(0.0, *ends)))

    def known(at: Array) -> Array:
        found = value(at)
        return np.where(np.isfinite(found), found, np.nan)

    places, values = tops(known, phi, most=NEAR)
    if not places.size:
        return Greatest(float("nan"), float("nan"))
    best = int(np.argmax(values))
    return Greatest(float(values[best]), float(places[best]))


def _state(path: RollerPath, phi: Array) -> tuple[Array, Array]:
    """Pressure angle [rad] and curvature of the path [1/m]."""
    return path.pressure_angle(phi), path.curvature(phi)[0]
