"""Transmission angles on the sphere: between the arcs from a dyad's inner joint to the centres of its two circles.

A link's centre is its other hinge, a guide's the pole of its circle; of a link that aims with its guide they are its
pivot and that pole, seen from the point aimed at.
"""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.analysis.instant_centres.turning_bodies import TurningBodies, pole_of, turning_bodies_of
from centrode.model.sphere import unit_vector
from centrode.structure.groups import Aim, Group, Meet, Rail, Rod

Array: TypeAlias = npt.NDArray[np.float64]


class ArcAngles:
    """Angles between arcs over one motion."""

    def __init__(self, data: xr.Dataset) -> None:
        self.bodies: TurningBodies = turning_bodies_of(data)

    def of(self, group: Group) -> Array | None:
        """Transmission angle of a group at every sample; None where it has none."""
        points = self.bodies.points
        if isinstance(group, Aim) and group.contact is None:
            target = points[group.target]
            return _acute(_between(target, points[group.pivot], self._pole(group.guide)))
        if not isinstance(group, Meet) or len(group.points) != 1:
            return None
        centres = [self._centre(locus) for locus in group.loci if isinstance(locus, (Rod, Rail))]
        if len(centres) != 2:
            return None
        angle = _between(points[group.points[0]], centres[0], centres[1])
        return angle if len(group.rods) == 2 else _acute(angle)

    def _centre(self, locus: Rod | Rail) -> Array:
        return self.bodies.points[locus.centre] if isinstance(locus, Rod) else self._pole(locus.guide)

    def _pole(self, name: str) -> Array:
        """Where the pole of a guide's circle is."""
        guide = self.bodies.mechanism.guide(name)
        inside = np.array(unit_vector(pole_of(self.bodies.mechanism, guide)))
        return np.asarray(self.bodies.axes[:, self.bodies.number(guide.on)] @ inside)


def _between(at: Array, first: Array, second: Array) -> Array:
    """Angle in a place from the arc to one other place to the arc to another, in [0, pi]."""
    one, other = np.cross(at, first), np.cross(at, second)
    sine = np.linalg.norm(np.cross(one, other), axis=-1)
    return np.asarray(np.arctan2(sine, np.sum(one * other, axis=-1)))


def _acute(angle: Array) -> Array:
    return np.asarray(np.minimum(angle, np.pi - angle))
