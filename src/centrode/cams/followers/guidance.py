"""How a follower is led: along a line or about a pivot, in the axes of the frame.

The cam's centre is the origin. A translating follower moves along +y at x = offset. An oscillating one turns about the
pivot (distance, 0); its angle psi is counted from the line that leads from the pivot to the cam's centre, so that the
end of an arm stands at (distance - arm cos(psi), arm sin(psi)).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, TypeAlias

from centrode.errors import InputError
from centrode.locale import _

Number = Any
Vector: TypeAlias = tuple[Number, Number]


@dataclass(frozen=True)
class Translating:
    """A follower that slides along y.

    Attributes
    ----------
    start : float [m]
        Height of the roller's centre (of the edge, of the face) above the cam's centre at lift 0.
    offset : float [m]
        x of its axis.
    """

    start: float
    offset: float = 0.0

    def centre(self, _m: Any, lift: Number) -> Vector:
        """The roller's centre at a lift [m]."""
        return lift * 0.0 + self.offset, lift + self.start

    def direction(self, _m: Any, lift: Number) -> Vector:
        """Unit vector in which the follower's centre moves where the lift grows."""
        return lift * 0.0, lift * 0.0 + 1.0

    def face(self, _m: Any, lift: Number) -> tuple[Number, Number]:
        """Angle [rad] of the face's normal from y towards x, distance [m] of the face from the cam's centre."""
        return lift * 0.0, lift + self.start


@dataclass(frozen=True)
class Oscillating:
    """A follower that turns about a pivot.

    Attributes
    ----------
    start : float [rad]
        psi at lift 0.
    distance : float [m]
        Of the pivot from the cam's centre.
    arm : float [m]
        Of the roller's centre from the pivot.
    face_offset : float [m]
        By how much the line of a flat face passes the pivot, on the cam's side.
    """

    start: float
    distance: float
    arm: float = 0.0
    face_offset: float = 0.0

    def centre(self, m: Any, lift: Number) -> Vector:
        """The roller's centre at a lift [rad]."""
        psi = lift + self.start
        return m.cos(psi) * -self.arm + self.distance, m.sin(psi) * self.arm

    def direction(self, m: Any, lift: Number) -> Vector:
        """Unit vector in which the follower's centre moves where the lift grows."""
        psi = lift + self.start
        return m.sin(psi), m.cos(psi)

    def face(self, m: Any, lift: Number) -> tuple[Number, Number]:
        """Angle [rad] of the face's normal from y towards x, distance [m] of the face from the cam's centre."""
        psi = lift + self.start
        return psi, m.sin(psi) * self.distance - self.face_offset


Guidance: TypeAlias = Translating | Oscillating


def translating(path_radius: float, offset: float = 0.0) -> Translating:
    """A translating follower whose roller's centre (edge) starts at a distance [m] from the cam's centre.

    Raises
    ------
    InputError
        An offset that is not smaller than this distance.
    """
    if not abs(offset) < path_radius:
        what = _("with an offset of {offset:.6g} mm the follower's axis misses the base circle")
        least = _("a greater base radius, or an offset below {most:.6g} mm")
        told, repair = what.format(offset=1e3 * offset), least.format(most=1e3 * path_radius)
        raise InputError("[follower] offset", told, repair)
    return Translating(math.sqrt((path_radius - offset) * (path_radius + offset)), offset)


def oscillating(path_radius: float, arm: float, distance: float) -> Oscillating:
    """An oscillating follower whose roller's centre (edge) starts at a distance [m] from the cam's centre.

    Raises
    ------
    InputError
        Arm, distance of the pivot and that radius make no triangle.
    """
    if not abs(distance - arm) < path_radius < distance + arm:
        what = _("an arm of {arm:.6g} mm about a pivot at {distance:.6g} mm does not reach the base circle")
        between = _(
            "the path of the roller's centre starts between {low:.6g} and {high:.6g} mm, not at {radius:.6g}"
        )
        low, high = abs(distance - arm), distance + arm
        raise InputError(
            "[follower] arm",
            what.format(arm=1e3 * arm, distance=1e3 * distance),
            between.format(low=1e3 * low, high=1e3 * high, radius=1e3 * path_radius),
        )
    # half-angle formula: no digits are lost in thin triangles
    half = (path_radius - (distance - arm)) * (path_radius + (distance - arm)) / (4.0 * arm * distance)
    return Oscillating(2.0 * math.asin(math.sqrt(half)), distance, arm)


def oscillating_face(base_radius: float, distance: float, face_offset: float = 0.0) -> Oscillating:
    """An oscillating follower whose flat face lies on the base circle at lift 0.

    Raises
    ------
    InputError
        A face that cannot touch the base circle.
    """
    sine = (base_radius + face_offset) / distance
    if not -1.0 < sine < 1.0:
        what = _("a face {offset:.6g} mm off a pivot at {distance:.6g} mm does not reach the base circle")
        told = what.format(offset=1e3 * face_offset, distance=1e3 * distance)
        raise InputError("[follower] pivot_distance", told, _("put the pivot farther away"))
    return Oscillating(math.asin(sine), distance, 0.0, face_offset)
