"""Where a follower touches its cam, as the envelope of all its places, with exact derivatives.

In the cam's axes the follower goes about the cam against the cam's turning. A roller's centre describes a path; with
the outward normal n of that path the profile is centre - r n, its radius of curvature 1/K - r. A flat face with the
normal at the angle omega (from y towards x) and the distance p(omega) from the centre touches at
p n + dp/domega w, w the derivative of n, and its radius of curvature is p + d2p/domega2.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, Any, Protocol, TypeAlias

import numpy as np
from numpy.typing import NDArray

from centrode.cams.nodes import inside, nodes_of
from centrode.cams.profiles import Undercut
from centrode.cams.roller_path import JETS
from centrode.errors import InputError
from centrode.locale import _
from centrode.numerics.jets import Jet
from centrode.numerics.search import Extremes, Function, extremes, roots
from centrode.printed_results import PrintsSummary

if TYPE_CHECKING:
    from centrode.model.follower_cam import PlateCam

# How a follower is led: along a line or about a pivot, in the axes of the frame.
#
# The cam's centre is the origin. A translating follower moves along +y at x = offset. An oscillating one
# turns about the
# pivot (distance, 0); its angle psi is counted from the line that leads from the pivot to the cam's centre,
# so that the
# end of an arm stands at (distance - arm cos(psi), arm sin(psi)).

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


def translating_follower(path_radius: float, offset: float = 0.0) -> Translating:
    """A translating follower whose roller's centre (edge) starts at a distance [m] from the cam's centre.

    Raises
    ------
    InputError
        An offset that is not smaller than this distance.
    """
    if not abs(offset) < path_radius:
        what = _("with an offset of {offset:.6g} mm the follower's axis misses the base circle")
        least = _("choose a larger base radius, or an offset below {most:.6g} mm")
        told, repair = what.format(offset=1e3 * offset), least.format(most=1e3 * path_radius)
        raise InputError("[follower] offset", told, repair)
    return Translating(math.sqrt((path_radius - offset) * (path_radius + offset)), offset)


def oscillating_follower(path_radius: float, arm: float, distance: float) -> Oscillating:
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
        raise InputError("[follower] pivot_distance", told, _("move the pivot farther away"))
    return Oscillating(math.asin(sine), distance, 0.0, face_offset)


Array: TypeAlias = NDArray[np.float64]
ORDER = 3
"""Derivatives of the lift that a contact is made from: the slope of the curvature needs the third."""


class ContactMotion(Protocol):
    """The lift of a follower over one turn of the cam."""

    @property
    def edges(self) -> tuple[float, ...]:
        """Angles [rad] from 0 to 2 pi between which the lift is smooth."""

    def lift(self, phi: Array, order: int = 0) -> Array:
        """The lift and its derivatives (order + 1, n) [m or rad, by rad^k]; at an edge those of what begins there."""


@dataclass(frozen=True)
class FollowerContact:
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


class ContactPoint(Protocol):
    """What of a follower touches the cam."""

    @property
    def roller(self) -> float:
        """Radius [m] of the roller; 0 for a knife edge, infinite for a flat face."""

    def contact(self, guide: Guidance, phi: Array, lift: Array, sense: float) -> FollowerContact:
        """The contact at angles (n) where the lift has these derivatives (ORDER + 1, n)."""


def jet_of(derivatives: Array) -> Jet:
    """A function of the angle as a jet, from its derivatives."""
    return Jet([row / math.factorial(k) for k, row in enumerate(derivatives)])


def rotate_into_cam(vector: Vector, phi: Jet, sense: float) -> tuple[Jet, Jet]:
    """A vector of the frame in the axes of a cam that has turned by phi."""
    x, y = vector
    cosine, sine = JETS.cos(phi), JETS.sin(phi) * sense
    return x * cosine + y * sine, y * cosine - x * sine


@dataclass(frozen=True)
class Point:
    """A knife edge (radius 0) or a roller with its radius [m]."""

    roller: float = 0.0

    def contact(self, guide: Guidance, phi: Array, lift: Array, sense: float) -> FollowerContact:
        rise, angle = jet_of(lift), Jet.variable(phi, ORDER)
        x, y = rotate_into_cam(guide.centre(JETS, rise), angle, sense)
        across, up = (one.lower_order() for one in rotate_into_cam(guide.direction(JETS, rise), angle, sense))
        u, v = x.slope(), y.slope()
        pressure = JETS.atan2(u * across + v * up, (u * up - v * across) * sense)
        length = JETS.sqrt(u * u + v * v)
        omega = JETS.atan2(-v * sense, u * sense)
        curvature = omega.slope() * sense / length.lower_order()
        stretch = -curvature * self.roller + 1.0
        centre, normal = _stack(x.value, y.value), _direction(omega.value)
        bend = 1.0 / curvature.value - self.roller
        return FollowerContact(
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

    def contact(self, guide: Guidance, phi: Array, lift: Array, sense: float) -> FollowerContact:
        normal_in_frame, distance = guide.face(JETS, jet_of(lift))
        omega = normal_in_frame + Jet.variable(phi, ORDER) * sense
        turning = omega.slope()
        foot = distance.slope() / turning
        bend = distance.lower_order().lower_order() + foot.slope() / turning.lower_order()
        normal, ahead = _direction(omega.value), _ahead(omega.value)
        place = distance.value[:, None] * normal + foot.value[:, None] * ahead
        along, pressure = _on_face(guide, normal_in_frame.lower_order(), foot, sense)
        return FollowerContact(
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


def _stack(x: Array, y: Array) -> Array:
    return np.stack([x, y], axis=-1)


def _direction(angle: Array) -> Array:
    return _stack(np.sin(angle), np.cos(angle))


def _ahead(angle: Array) -> Array:
    return _stack(np.cos(angle), -np.sin(angle))


# A plate cam with its follower: the closed profile, its corners, where it is undercut, and its extremes.

KINK = 1e-9
"""Turns of the normal [rad], and steps of the contact over the base radius, that are rounding."""
FLAT = 1e-13
"""Slopes below this share of a value (by radian) are rounding."""
PLACES = 721
WATCHED = {
    "pressure": ("pressure_angle", "pressure_slope"),
    "path_curvature": ("path_curvature", "path_curvature_slope"),
    "stretch": ("stretch", "stretch_slope"),
    "along": ("along", "along_slope"),
}
"""Values of a contact whose extremes are looked for, with their slopes."""


@dataclass(frozen=True)
class LiftCorner:
    """A joint of the motion at which the speed of the lift jumps.

    Attributes
    ----------
    at : float [rad]
    turn : float [rad]
        By how much the normal turns, positive at an outward corner of the path; 0 for a flat face.
    step : float [m]
        By how far the contact steps along the flat face in the sense of the contact's way; 0 otherwise.
    """

    at: float
    turn: float
    step: float = 0.0

    def undercuts(self, roller: float) -> bool:
        """Whether a follower of this roller cuts away the profile on both sides of the corner."""
        return self.step < 0.0 or (self.turn > 0.0 and roller > 0.0)


@dataclass(frozen=True, repr=False)
class FollowerCam(PrintsSummary):
    """A plate cam that moves a follower.

    Attributes
    ----------
    motion : ContactMotion
    guide : Translating or Oscillating
    touch : Point or Face
    base_radius : float [m]
        Least radius of the profile, where the lift is 0.
    sense : +1 or -1
        Whether the cam turns counter-clockwise or clockwise.
    cam : PlateCam or None
        The description that it is the cam of; None without one.
    """

    motion: ContactMotion
    guide: Guidance
    touch: ContactPoint
    base_radius: float
    sense: float = 1.0
    cam: PlateCam | None = field(default=None, repr=False, compare=False)

    @property
    def edges(self) -> tuple[float, ...]:
        """Angles [rad] between which the profile is smooth."""
        return self.motion.edges

    def contact(self, phi: Array) -> FollowerContact:
        """The contact at angles (n) [rad] from 0 to a turn, exact to the rounding of the lift's three derivatives."""
        phi = np.asarray(phi, dtype=np.float64)
        with np.errstate(divide="ignore", invalid="ignore"):
            return self.touch.contact(self.guide, phi, self.motion.lift(phi, ORDER), self.sense)

    def in_frame(self, vectors: Array, phi: Array) -> Array:
        """Places or directions (n, 2) of the cam's axes in the axes of the frame, the cam turned by phi (n)."""
        cosine, sine = np.cos(phi), self.sense * np.sin(phi)
        x, y = vectors[..., 0], vectors[..., 1]
        return np.stack([x * cosine - y * sine, y * cosine + x * sine], axis=-1)

    @cached_property
    def corners(self) -> tuple[LiftCorner, ...]:
        """Joints at which the speed of the lift jumps, growing."""
        found = (self._corner(at) for at in self.edges[:-1])
        return tuple(one for one in found if one is not None)

    def _corner(self, at: float) -> LiftCorner | None:
        before = inside(0.0, self.edges[-1] if at == self.edges[0] else at)[1]
        sides = self.contact(np.array([before, at]))
        if isinstance(self.touch, Face):
            step = float(np.sum((sides.place[1] - sides.place[0]) * sides.tangent[1]))
            return LiftCorner(at, 0.0, step) if abs(step) > KINK * self.base_radius else None
        turn = self.sense * math.remainder(sides.normal_angle[1] - sides.normal_angle[0], math.tau)
        return LiftCorner(at, turn) if abs(turn) > KINK else None

    @cached_property
    def undercuts(self) -> list[Undercut]:
        """Where the profile runs back, so that the follower's other places cut it away; corners have no width.

        Ends are cusps, where `stretch` is zero, exact to rounding. What goes over phi = 0 is told in one piece.
        """
        sharp = [Undercut(one.at, one.at) for one in self.corners if one.undercuts(self.touch.roller)]
        smooth = self._running_back()
        # a corner that lies within a stretch is told with it
        alone = [one for one in sharp if not any(two.start <= one.start <= two.stop for two in smooth)]
        return sorted([*smooth, *alone], key=lambda one: one.start)

    def _running_back(self) -> list[Undercut]:
        found: list[Undercut] = []
        for start, stop in self._backwards():
            if found and found[-1].stop == start:
                found[-1] = Undercut(found[-1].start, stop)
            else:
                found.append(Undercut(start, stop))
        if len(found) > 1 and found[0].start == self.edges[0] and found[-1].stop == self.edges[-1]:
            found[-1] = Undercut(found[-1].start, found.pop(0).stop + math.tau)
        return found

    def _backwards(self) -> Iterator[tuple[float, float]]:
        """Stretches between cusps and edges on which the profile runs back."""
        values, _slopes = self._value_and_slope("stretch")
        # cusps lie on both sides of the lowest places, however near
        lowest = self.turns("stretch")
        found = roots(values, nodes_of(sorted({*self.edges, *lowest.tolist()})))
        for start, stop in pairwise(self.edges):
            cusps = found[(found > start) & (found < stop)].tolist()
            for low, high in pairwise((start, *cusps, stop)):
                inner = np.linspace(low, high, 9)[1:-1]
                if high > low and float(np.median(self.contact(inner).stretch)) <= 0.0:
                    yield low, high

    @cached_property
    def path_curvature(self) -> Extremes:
        """Extremes of the curvature [1/m] of the path of the roller's centre."""
        return self._extremes("path_curvature")

    @cached_property
    def pressure(self) -> Extremes:
        """Extremes of the pressure angle [rad]."""
        return self._extremes("pressure")

    @cached_property
    def bends(self) -> Extremes:
        """Extremes of the radius of curvature [m] of the profile under a flat face; it has none but these."""
        return self._extremes("stretch")

    @cached_property
    def face(self) -> Extremes:
        """Ends [m] of the stretch of a flat face on which the cam touches it, from the axis or from the pivot."""
        return self._extremes("along")

    def _extremes(self, name: str) -> Extremes:
        """Over the stretches between edges, with what holds before and behind each."""
        return extremes(*self._value_and_slope(name), nodes_of(self.edges))

    def turns(self, name: str) -> Array:
        """Angles [rad] between edges at which a value of `WATCHED` is least or greatest, growing."""
        return roots(self._value_and_slope(name)[1], nodes_of(self.edges))

    def _value_and_slope(self, name: str) -> tuple[Function, Function]:
        """A value of the contact and its slope as functions of the angle."""
        value, slope = WATCHED[name]

        def values(phi: Array) -> Array:
            return np.asarray(getattr(self.contact(phi), value))

        def slopes(phi: Array) -> Array:
            contact = self.contact(phi)
            found = np.asarray(getattr(contact, slope))
            # on a dwell the slope is rounding, whose signs say nothing
            return np.where(np.abs(found) <= FLAT * np.abs(getattr(contact, value)), 0.0, found)

        return values, slopes

    @cached_property
    def least_bend(self) -> tuple[float, float]:
        """Least radius of curvature [m] of the profile where it bulges, and where [rad]; infinite if it never does.

        Zero or less where it is undercut.
        """
        if isinstance(self.touch, Face):
            return self.bends.least, self.bends.at_least
        most, at = self.greatest_roller
        return most - self.touch.roller, at

    @cached_property
    def greatest_roller(self) -> tuple[float, float]:
        """The radius [m] that a roller on this path of its centre has to stay below, and where [rad] it is decided.

        It is the least radius of curvature of the path where it bulges; 0 at a corner, infinite if there is neither.
        """
        sharp = [one.at for one in self.corners if one.turn > 0.0]
        if sharp:
            return 0.0, sharp[0]
        found = self.path_curvature
        return (1.0 / found.greatest if found.greatest > 0.0 else math.inf), found.at_greatest

    @cached_property
    def greatest_cutter(self) -> tuple[float, float]:
        """The radius [m] that a cutter has to stay below to come to the bottom of every hollow, and where [rad].

        Infinite where there is no hollow. At a hollow corner a roller leaves its own arc, a knife edge nothing.
        """
        corners = [(self.touch.roller, one.at) for one in self.corners if one.turn < 0.0]
        if isinstance(self.touch, Face):
            return math.inf, 0.0
        found = self.path_curvature
        hollow = self.touch.roller - 1.0 / found.least if found.least < 0.0 else math.inf
        return min([(hollow, found.at_least), *corners])

    @cached_property
    def overlap(self) -> tuple[float, float]:
        """By how much [m] a roller overlaps the profile elsewhere than it touches it, and at which angle [rad].

        Among 720 places of the roller and of the profile; 0 where it never does, and for other followers.
        """
        if isinstance(self.touch, Face) or self.touch.roller == 0.0:
            return 0.0, 0.0
        phi = np.linspace(self.edges[0], self.edges[-1], PLACES)[:-1]
        found = self.contact(phi)
        apart = np.hypot(*(found.centre[:, None] - found.place).transpose(2, 0, 1)).min(axis=1)
        worst = int(np.argmin(apart))
        depth = self.touch.roller - float(apart[worst])
        scale = float(np.abs(found.centre).max())
        return (depth, float(phi[worst])) if depth > KINK * scale else (0.0, 0.0)
