"""Where a follower touches its cam, as the envelope of all its places, with exact derivatives.

In the cam's axes the follower goes about the cam against the cam's turning. A roller's centre describes a path; with
the outward normal n of that path the profile is centre - r n, its radius of curvature 1/K - r. A flat face with the
normal at the angle omega (from y towards x) and the distance p(omega) from the centre touches at
p n + dp/domega w, w the derivative of n, and its radius of curvature is p + d2p/domega2.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol, TypeAlias

import numpy as np
from numpy.typing import NDArray

from centrode.algebra.jets import Jet
from centrode.cams.followers.guidance import Guidance, Oscillating, Vector
from centrode.cams.frames import JETS

Array: TypeAlias = NDArray[np.float64]
ORDER = 3
"""Derivatives of the lift that a contact is made from: the slope of the curvature needs the third."""


class Motion(Protocol):
    """The lift of a follower over one turn of the cam."""

    @property
    def edges(self) -> tuple[float, ...]:
        """Angles [rad] from 0 to 2 pi between which the lift is smooth."""

    def lift(self, phi: Array, order: int = 0) -> Array:
        """The lift and its derivatives (order + 1, n) [m or rad, by rad^k]; at an edge those of what begins there."""


@dataclass(frozen=True)
class Contact:
    """Contact of follower and cam at angles `phi` (n) [rad] that the cam has turned, in the cam's axes.

    Attributes
    ----------
    lift : (n) [m or rad]
    centre : (n, 2) [m]
        The roller's centre; of a knife edge and of a flat face the place of contact.
    place : (n, 2) [m]
        Of the profile.
    normal, tangent : (n, 2)
        Unit vectors: out of the cam, and where the contact goes while the cam turns.
    normal_angle : (n) [rad]
        Of the normal, from y towards x.
    speed : (n) [m/rad]
        ds/dphi along the tangent; negative where the profile runs back.
    pace : (n)
        ds/dphi [m/rad] of the roller's centre; dangle/dphi [1] of a flat face against the cam, positive if it is led.
    stretch, stretch_slope : (n)
        `speed` over `pace`: 1 - r K of a roller [1], the radius of curvature under a flat face [m]; by phi.
    bend : (n) [m]
        Radius of curvature of the profile: positive where it bulges, infinite where it is straight.
    curvature : (n) [1/m]
        1/bend.
    pressure_angle, pressure_slope : (n) [rad], [1]
        Between the normal and the follower's motion; positive where the contact moves with the rising follower.
    path_curvature, path_curvature_slope : (n) [1/m], [1/m/rad]
        Of the path of the roller's centre, positive where it bulges; of the profile with a flat face.
    along, along_slope : (n) [m], [m/rad]
        Place of contact along a flat face: from the follower's axis in the sense of x, or from the pivot; else NaN.
    """

    phi: Array
    lift: Array
    centre: Array
    place: Array
    normal: Array
    tangent: Array
    normal_angle: Array
    speed: Array
    pace: Array
    stretch: Array
    stretch_slope: Array
    bend: Array
    curvature: Array
    pressure_angle: Array
    pressure_slope: Array
    path_curvature: Array
    path_curvature_slope: Array
    along: Array
    along_slope: Array


class Touch(Protocol):
    """What of a follower touches the cam."""

    @property
    def roller(self) -> float:
        """Radius [m] of the roller; 0 for a knife edge, infinite for a flat face."""

    def contact(self, guide: Guidance, phi: Array, lift: Array, sense: float) -> Contact:
        """The contact at angles (n) where the lift has these derivatives (ORDER + 1, n)."""


def jet_of(derivatives: Array) -> Jet:
    """A function of the angle as a jet, from its derivatives."""
    return Jet([row / math.factorial(k) for k, row in enumerate(derivatives)])


def turned(vector: Vector, phi: Jet, sense: float) -> tuple[Jet, Jet]:
    """A vector of the frame in the axes of a cam that has turned by phi."""
    x, y = vector
    cosine, sine = JETS.cos(phi), JETS.sin(phi) * sense
    return x * cosine + y * sine, y * cosine - x * sine


@dataclass(frozen=True)
class Point:
    """A knife edge (radius 0) or a roller with its radius [m]."""

    roller: float = 0.0

    def contact(self, guide: Guidance, phi: Array, lift: Array, sense: float) -> Contact:
        rise, angle = jet_of(lift), Jet.variable(phi, ORDER)
        x, y = turned(guide.centre(JETS, rise), angle, sense)
        across, up = (one.lowered() for one in turned(guide.direction(JETS, rise), angle, sense))
        u, v = x.slope(), y.slope()
        pressure = JETS.atan2(u * across + v * up, (u * up - v * across) * sense)
        length = JETS.sqrt(u * u + v * v)
        omega = JETS.atan2(-v * sense, u * sense)
        curvature = omega.slope() * sense / length.lowered()
        stretch = -curvature * self.roller + 1.0
        centre, normal = _stacked(x.value, y.value), _direction(omega.value)
        bend = 1.0 / curvature.value - self.roller
        return Contact(
            phi,
            lift[0],
            centre,
            centre - self.roller * normal,
            normal,
            sense * _ahead(omega.value),
            omega.value,
            length.value * stretch.value,
            length.value,
            stretch.value,
            stretch.derivative(1) + 0.0 * phi,
            bend,
            curvature.value / stretch.value,
            pressure.value,
            pressure.derivative(1),
            curvature.value,
            curvature.derivative(1),
            *np.full((2, *phi.shape), np.nan),
        )


@dataclass(frozen=True)
class Face:
    """A flat face."""

    roller: float = math.inf

    def contact(self, guide: Guidance, phi: Array, lift: Array, sense: float) -> Contact:
        normal_in_frame, distance = guide.face(JETS, jet_of(lift))
        omega = normal_in_frame + Jet.variable(phi, ORDER) * sense
        turning = omega.slope()
        foot = distance.slope() / turning
        bend = distance.lowered().lowered() + foot.slope() / turning.lowered()
        normal, ahead = _direction(omega.value), _ahead(omega.value)
        place = distance.value[:, None] * normal + foot.value[:, None] * ahead
        along, pressure = _on_face(guide, normal_in_frame.lowered(), foot, sense)
        return Contact(
            phi,
            lift[0],
            place,
            place,
            normal,
            sense * ahead,
            omega.value,
            bend.value * turning.value * sense,
            turning.value * sense + 0.0 * phi,
            bend.value,
            bend.derivative(1),
            bend.value,
            1.0 / bend.value,
            pressure.value + 0.0 * phi,
            pressure.derivative(1) + 0.0 * phi,
            1.0 / bend.value,
            -bend.derivative(1) / bend.value**2,
            along.value,
            along.derivative(1),
        )


def _on_face(guide: Guidance, psi: Jet, foot: Jet, sense: float) -> tuple[Jet, Jet]:
    """Place of contact along the face, pressure angle."""
    if not isinstance(guide, Oscillating):
        return foot - guide.offset, foot * 0.0
    along = JETS.cos(psi) * guide.distance - foot
    return along, JETS.atan2(along * 0.0 - sense * guide.face_offset, along)


def _stacked(x: Array, y: Array) -> Array:
    return np.stack([x, y], axis=-1)


def _direction(angle: Array) -> Array:
    return _stacked(np.sin(angle), np.cos(angle))


def _ahead(angle: Array) -> Array:
    return _stacked(np.cos(angle), -np.sin(angle))
