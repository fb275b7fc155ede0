"""What is admissible of a cam, and by how much it is kept."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from centrode.cams.followers.bodies import Corner, FollowerCam
from centrode.cams.followers.contact import Array, Contact
from centrode.cams.followers.layouts import Layout
from centrode.cams.nodes import nodes_of

STILL = 1e-12
"""Slopes of the lift below this share of the greatest are those of a dwell."""


@dataclass(frozen=True)
class Admissible:
    """What a cam has to keep.

    Attributes
    ----------
    pressure_angle, return_angle : float [rad]
        Greatest pressure angles where the follower rises, where it falls; where it dwells both.
    bend : float [m]
        Least radius of curvature of the profile where it bulges; at 0 it must not be undercut.
    """

    pressure_angle: float = math.pi / 2
    return_angle: float = math.pi / 2
    bend: float = 0.0


@dataclass(frozen=True)
class Margin:
    """By how much bounds are kept at worst, where, and which; negative where they are not."""

    least: float
    at: float
    by: str


def margin(contact: Contact, slope: Array, layout: Layout, kept: Admissible) -> Margin:
    """What is left at the worst of some contacts, `slope` (n) the lift's there.

    Of pressure angles in radians; of curvature 1 - (r + bend) K of a roller, (R - bend)/r0 of a flat face.
    """
    still = STILL * float(np.abs(slope).max())
    steepness = np.abs(contact.pressure_angle)
    pressure = np.minimum(
        np.where(slope >= -still, kept.pressure_angle - steepness, math.inf),
        np.where(slope <= still, kept.return_angle - steepness, math.inf),
    )
    if layout.flat:
        size = float(np.abs(contact.place).max())
        bent = np.where(contact.pace > 0.0, (contact.bend - kept.bend) / size, -math.inf)
    else:
        bent = 1.0 - (layout.touch.roller + kept.bend) * contact.path_curvature
    bent = np.where(np.isfinite(bent), bent, -math.inf)
    first, second = int(np.argmin(pressure)), int(np.argmin(bent))
    if pressure[first] <= bent[second]:
        return Margin(float(pressure[first]), float(contact.phi[first]), "pressure angle")
    return Margin(float(bent[second]), float(contact.phi[second]), "curvature")


def exact_margin(cam: FollowerCam, layout: Layout, kept: Admissible) -> Margin:
    """`margin` over the whole turn, extremes found to rounding."""
    names = ("pressure", "stretch" if layout.flat else "path_curvature")
    phi = np.concatenate([nodes_of(cam.edges), *(cam.turns(name) for name in names)])
    found = margin(cam.contact(phi), cam.motion.lift(phi, 1)[1], layout, kept)
    sharp = [one.at for one in cam.corners if breaks(one, layout, kept)]
    return Margin(-math.inf, sharp[0], "curvature") if sharp else found


def breaks(corner: Corner, layout: Layout, kept: Admissible) -> bool:
    """Whether a corner leaves the profile undercut, or with a sharp edge where a radius of curvature is asked for."""
    return corner.undercuts(layout.touch.roller) or (corner.turn > 0.0 and kept.bend > 0.0)
