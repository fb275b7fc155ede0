"""Gears and rolling wheels as constraints, and the constants with which they mesh.

A wheel that rolls keeps two constraints: it touches its track (a length), and it does not slip (an angle).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, TypeAlias

from centrode.geometry.plane import (
    Vector,
    along,
    cross,
    dot,
    place,
    reversed_rotor,
    rotor_of,
    subtract,
    turned,
)
from centrode.locale import _
from centrode.structure.dimensions import Dimensions
from centrode.structure.gear_ratios import GearRatio
from centrode.structure.gearing import Straight
from centrode.structure.positions import Entity, Positions, Row, angle_between

Number: TypeAlias = Any
Namespace: TypeAlias = Any


@dataclass(frozen=True)
class _OnTrack:
    """A wheel (`link`) with its centre, and the body that carries what it rolls on."""

    rolling: str
    link: str
    centre: str
    on: str
    size = 1

    def offset(self, numbers: Dimensions, at: Positions) -> Vector:
        """Vector from the line's own point, or from the circle's centre, to that of the wheel."""
        track = numbers.gearing.track[self.rolling]
        start = track.through if isinstance(track, Straight) else track.centre
        return subtract(at.points[self.centre], place(at.poses[self.on], start))

    def heading(self, numbers: Dimensions, at: Positions) -> Vector:
        """Direction of a line as it lies now; from the circle's centre to that of the wheel."""
        track = numbers.gearing.track[self.rolling]
        if isinstance(track, Straight):
            return turned(track.direction, at.poses[self.on].rotor)
        x, y = self.offset(numbers, at)
        length = (x * x + y * y) ** 0.5
        return x / length, y / length

    def _arm(self, at: Positions) -> Vector:
        return subtract(at.points[self.centre], at.poses[self.on].origin)


@dataclass(frozen=True)
class Contact(_OnTrack):
    """A wheel touches its track: its centre keeps its distance from the line or from the circle's centre."""

    angular = False

    @property
    def bodies(self) -> tuple[Entity, ...]:
        return Entity("point", self.centre), Entity("link", self.on)

    @property
    def label(self) -> str:
        return _("contact of wheel {wheel}").format(wheel=self.rolling)

    def residual(self, m: Namespace, numbers: Dimensions, at: Positions) -> list[Number]:
        reach, offset = numbers.gearing.reach(self.rolling), self.offset(numbers, at)
        track = numbers.gearing.track[self.rolling]
        if isinstance(track, Straight):
            return [cross(turned(track.direction, at.poses[self.on].rotor), offset) - reach]
        return [m.sqrt(dot(offset, offset)) - reach]

    def rows(self, numbers: Dimensions, at: Positions) -> list[Row]:
        point, on = self.bodies
        x, y = self.heading(numbers, at)
        if isinstance(numbers.gearing.track[self.rolling], Straight):
            return [{point: (-y, x), on: (y, -x, -dot((x, y), self._arm(at)))}]
        return [{point: (x, y), on: (-x, -y, cross((x, y), self._arm(at)))}]


@dataclass(frozen=True)
class NoSlip(_OnTrack):
    """A wheel rolls without slip: its turn against the body that carries its track follows its centre's way."""

    angular = True

    @property
    def bodies(self) -> tuple[Entity, ...]:
        return Entity("link", self.link), Entity("point", self.centre), Entity("link", self.on)

    @property
    def label(self) -> str:
        return _("rolling of wheel {wheel}").format(wheel=self.rolling)

    def slide(self, numbers: Dimensions, at: Positions) -> Number:
        """Way of the wheel's centre along a line [m], from the line's own point."""
        return dot(self.heading(numbers, at), self.offset(numbers, at))

    def bearing(self, m: Namespace, numbers: Dimensions, at: Positions) -> Number:
        """Direction [rad] of the wheel's centre from the circle's in the axes of its body, in (-pi, pi]."""
        x, y = turned(self.offset(numbers, at), reversed_rotor(at.poses[self.on].rotor))
        return m.atan2(y, x)

    def constant(self, m: Namespace, numbers: Dimensions, at: Positions) -> Number:
        """What the equation's left side is at positions whose angles are known [rad]."""
        relative = at.angles[self.link] - at.angles[self.on]
        if isinstance(numbers.gearing.track[self.rolling], Straight):
            return relative + self.slide(numbers, at) / numbers.gearing.radius[self.rolling]
        return relative - numbers.gearing.spin(self.rolling) * self.bearing(m, numbers, at)

    def residual(self, m: Namespace, numbers: Dimensions, at: Positions) -> list[Number]:
        phase = numbers.gearing.phase[self.rolling]
        if isinstance(numbers.gearing.track[self.rolling], Straight):
            return [self.constant(m, numbers, at) - phase]
        # where the wheel's own turns, which are known, want its centre: so the centre's need not be counted
        spin = numbers.gearing.spin(self.rolling)
        bearing = (at.angles[self.link] - at.angles[self.on] - phase) / spin
        wanted = turned(at.poses[self.on].rotor, rotor_of(m, bearing))
        return [spin * angle_between(m, wanted, self.offset(numbers, at))]

    def rows(self, numbers: Dimensions, at: Positions) -> list[Row]:
        wheel, point, on = self.bodies
        direction, arm = self.heading(numbers, at), self._arm(at)
        if isinstance(numbers.gearing.track[self.rolling], Straight):
            radius = numbers.gearing.radius[self.rolling]
            x, y = direction[0] / radius, direction[1] / radius
        else:
            share = numbers.gearing.spin(self.rolling) / dot(direction, self.offset(numbers, at))
            x, y = share * direction[1], -share * direction[0]
        return [{wheel: (0.0, 0.0, 1.0), point: (x, y), on: (-x, -y, cross((x, y), arm) - 1.0)}]


@dataclass(frozen=True)
class Standing:
    """A link stands at a given angle: what says in the initial position how a gear or a wheel meshes."""

    link: str
    angle: float
    size = 1
    angular = True

    @property
    def bodies(self) -> tuple[Entity, ...]:
        return (Entity("link", self.link),)

    @property
    def label(self) -> str:
        return _("initial angle of link {link}").format(link=self.link)

    def residual(self, m: Namespace, numbers: Dimensions, at: Positions) -> list[Number]:
        return [at.angles[self.link] - self.angle]

    def rows(self, numbers: Dimensions, at: Positions) -> list[Row]:
        return [{Entity("link", self.link): (0.0, 0.0, 1.0)}]


Meshing: TypeAlias = GearRatio | NoSlip
"""What keeps an equation between angles with a constant of its own."""


def identity_of(constraint: Meshing) -> str:
    """Id of the gear or of the rolling wheel."""
    return constraint.gear if isinstance(constraint, GearRatio) else constraint.rolling


def phase_of(constraint: Meshing, m: Namespace, numbers: Dimensions, at: Positions) -> Number:
    """The constant [rad] with which wheels mesh that stand as they do, from positions with the links' angles."""
    return constraint.constant(m, numbers, at)


def angle_links(constraint: Meshing) -> tuple[str, ...]:
    """Links whose initial angle may say how the wheels mesh; the first of them that is unknown does."""
    if isinstance(constraint, GearRatio):
        return constraint.second, constraint.first, constraint.carrier
    return (constraint.link,)


def contact_point(constraint: Contact | NoSlip, m: Namespace, numbers: Dimensions, at: Positions) -> Vector:
    """Where a wheel touches its track: the instant centre of the wheel against the body it rolls on."""
    track = numbers.gearing.track[constraint.rolling]
    heading, offset = constraint.heading(numbers, at), constraint.offset(numbers, at)
    start = subtract(at.points[constraint.centre], offset)
    if isinstance(track, Straight):
        return along(start, heading, dot(heading, offset))
    # a ring around its pin touches on the far side of the pin
    far = m.sign(track.radius - numbers.gearing.radius[constraint.rolling]) if track.inside else 1.0
    return along(start, heading, far * track.radius)
