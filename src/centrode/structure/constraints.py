"""The one list of constraints: formula and Jacobian row of each.

The list serves rank and mobility, the plan, residuals, Newton groups, equations in symbols and reactions.
Unknowns are the points (two coordinates) and the links (origin and angle); a constraint ties some of them
together.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Literal, NamedTuple, Protocol, TypeAlias

from centrode.geometry.plane import (
    Vector,
    along,
    cross,
    dot,
    place,
    reversed_rotor,
    rotate_vector,
    rotor_of,
    subtract,
)
from centrode.geometry.space import Coordinates, Place, Pose, Rows
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.numerics.operations import PLAIN
from centrode.structure.dimensions import Dimensions
from centrode.structure.gearing import Straight

# What is unknown, and where it is: points, links, positions in any algebra.

Number: TypeAlias = Any
Namespace: TypeAlias = Any
FRAME = "frame"


class Entity(NamedTuple):
    """An unknown: a moving point, or a link."""

    kind: Literal["point", "link"]
    name: str

    @property
    def unknowns(self) -> int:
        """Number of coordinates: 2 of a point, 3 of a link."""
        return 2 if self.kind == "point" else 3


Row: TypeAlias = dict[Entity, tuple[Number, ...]]
"""Derivatives of one equation by the coordinates of what it ties together."""


@dataclass
class Positions:
    """Places of all points and links, in any algebra, with the values of the drives.

    `angles` holds the angles [rad] that are known with their turns: of the frame, of links that a drive or a
    gear turns, and of links whose turns something else depends on.
    """

    points: dict[str, Place]
    poses: dict[str, Pose]
    drives: Mapping[str, Number]
    angles: dict[str, Number] = field(default_factory=lambda: {FRAME: 0.0})

    @classmethod
    def of_frame(cls, dimensions: Dimensions, drives: Mapping[str, Number], m: Namespace) -> Positions:
        """Positions known before any group is solved: points of the frame, its pose, values of the drives."""
        space = dimensions.space
        fixed = {name: space.place(m, space.at_rest, at) for name, at in dimensions.frame.items()}
        return cls(fixed, {FRAME: space.at_rest}, drives)

    def map_numbers(self, function: Callable[[Number], Number]) -> Positions:
        """Positions whose every number is function(number) of these: places, poses, values of drives, angles."""
        return Positions(
            {name: tuple(map(function, at)) for name, at in self.points.items()},
            {name: mapped_pose(pose, function) for name, pose in self.poses.items()},
            {name: function(value) for name, value in self.drives.items()},
            {name: function(value) for name, value in self.angles.items()},
        )

    def copy(self) -> Positions:
        """A copy of the positions, to which others may be added without changing these."""
        return Positions(dict(self.points), dict(self.poses), self.drives, dict(self.angles))


def mapped_pose(pose: Pose, function: Callable[[Number], Number]) -> Pose:
    """A pose whose every number is function(number) of this one, taken in their order: origin, then rotor or axes."""
    return type(pose)(*(tuple(map(function, vector)) for vector in pose))


def angle_between(m: Namespace, rotor: Vector, reference: Vector) -> Number:
    """Angle from one rotor to another, in (-pi, pi]."""
    difference = rotate_vector(rotor, reversed_rotor(reference))
    return m.atan2(difference[1], difference[0])


# Cylinders: a drive that gives the distance of two points, as a constraint.


@dataclass(frozen=True)
class DistanceDrive:
    """A drive gives the distance of two points."""

    drive: str
    first: str
    second: str
    size = 1
    angular = False

    @cached_property
    def bodies(self) -> tuple[Entity, ...]:
        return Entity("point", self.first), Entity("point", self.second)

    @property
    def label(self) -> str:
        return _("cylinder {drive}").format(drive=self.drive)

    def residual(self, m: Namespace, numbers: Dimensions, at: Positions) -> list[Number]:
        apart = subtract(at.points[self.second], at.points[self.first])
        return [m.sqrt(dot(apart, apart)) - at.drives[self.drive]]

    def rows(self, numbers: Dimensions, at: Positions) -> list[Row]:
        x, y = subtract(at.points[self.second], at.points[self.first])
        # a power, not m.sqrt: rows are derivatives at plain numbers, and any of those has powers
        length = (x * x + y * y) ** 0.5
        first, second = self.bodies
        # the unit vector from one point to the other, with opposite signs
        return [{first: (-x / length, -y / length), second: (x / length, y / length)}]


# Gears as constraints: the angles of two wheels and their carrier.


@dataclass(frozen=True)
class GearRatio:
    """Two links turn against a carrier in a constant ratio: (b - c) - i (a - c) stays what it is."""

    gear: str
    first: str
    second: str
    carrier: str
    size = 1
    angular = True

    @cached_property
    def bodies(self) -> tuple[Entity, ...]:
        return tuple(Entity("link", name) for name in self.links)

    @property
    def links(self) -> tuple[str, str, str]:
        """First wheel, second wheel, carrier."""
        return self.first, self.second, self.carrier

    @property
    def label(self) -> str:
        return _("gear {gear}").format(gear=self.gear)

    def weights(self, numbers: Dimensions) -> dict[str, Number]:
        """Link -> factor of its angle in the equation."""
        ratio = numbers.gearing.ratio[self.gear]
        first, second = numbers.gearing.shares.get(self.gear, (1.0, 1.0))
        # the carrier's own weight makes the sum vanish when all three turn together
        return {self.first: -ratio, self.second: 1.0, self.carrier: ratio * first - second}

    def constant(self, m: Namespace, numbers: Dimensions, at: Positions) -> Number:
        """Left side of the equation [rad] at positions whose angles are known: its constant."""
        carrier = at.angles[self.carrier]
        ratio = numbers.gearing.ratio[self.gear]
        first, second = numbers.gearing.shares.get(self.gear, (1.0, 1.0))
        return (at.angles[self.second] - second * carrier) - ratio * (at.angles[self.first] - first * carrier)

    def residual(self, m: Namespace, numbers: Dimensions, at: Positions) -> list[Number]:
        return [self.constant(m, numbers, at) - numbers.gearing.phase[self.gear]]

    def rows(self, numbers: Dimensions, at: Positions) -> list[Row]:
        row: Row = {}
        for link, factor in self.weights(numbers).items():
            # on the sphere an angle is measured on a body, which turns as well
            base = numbers.gearing.measured.get(link, FRAME)
            for body, slope in zip((link, base), _slopes(numbers, at, link, base), strict=True):
                entity, before = Entity("link", body), row.get(Entity("link", body), (0.0, 0.0, 0.0))
                row[entity] = tuple(old + factor * x for old, x in zip(before, slope, strict=True))
        # what an angle is measured on may be the frame, whose derivatives are no unknowns
        return [{entity: slope for entity, slope in row.items() if entity.name in self.links}]


def _slopes(numbers: Dimensions, at: Positions, link: str, base: str) -> tuple[Any, Any]:
    """Derivatives of a link's angle by the link and by what it is measured on."""
    reference = numbers.reference(link)
    if reference is None:
        return (0.0, 0.0, 1.0), (0.0, 0.0, -1.0)
    return numbers.space.turn_row(PLAIN, at.poses[link], at.poses[base], reference)


# Gears and rolling wheels as constraints, and the constants with which they mesh.
#
# A wheel that rolls keeps two constraints: it touches its track (a length), and it does not slip (an angle).


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
            return rotate_vector(track.direction, at.poses[self.on].rotor)
        x, y = self.offset(numbers, at)
        length = (x * x + y * y) ** 0.5
        return x / length, y / length

    def _arm(self, at: Positions) -> Vector:
        return subtract(at.points[self.centre], at.poses[self.on].origin)


@dataclass(frozen=True)
class TrackContact(_OnTrack):
    """A wheel touches its track: its centre keeps its distance from the line or from the circle's centre."""

    angular = False

    @cached_property
    def bodies(self) -> tuple[Entity, ...]:
        return Entity("point", self.centre), Entity("link", self.on)

    @property
    def label(self) -> str:
        return _("contact of wheel {wheel}").format(wheel=self.rolling)

    def residual(self, m: Namespace, numbers: Dimensions, at: Positions) -> list[Number]:
        reach, offset = numbers.gearing.reach(self.rolling), self.offset(numbers, at)
        track = numbers.gearing.track[self.rolling]
        if isinstance(track, Straight):
            return [cross(rotate_vector(track.direction, at.poses[self.on].rotor), offset) - reach]
        return [m.sqrt(dot(offset, offset)) - reach]

    def rows(self, numbers: Dimensions, at: Positions) -> list[Row]:
        point, on = self.bodies
        x, y = self.heading(numbers, at)
        if isinstance(numbers.gearing.track[self.rolling], Straight):
            # of cross(direction, offset): the left normal by the centre, and by the body what its shift and
            # turn undo
            return [{point: (-y, x), on: (y, -x, -dot((x, y), self._arm(at)))}]
        # the distance grows along the heading; the body's turn moves the circle's centre by its arm
        return [{point: (x, y), on: (-x, -y, cross((x, y), self._arm(at)))}]


@dataclass(frozen=True)
class NoSlip(_OnTrack):
    """A wheel rolls without slip: its turn against the body that carries its track follows its centre's way."""

    angular = True

    @cached_property
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
        x, y = rotate_vector(self.offset(numbers, at), reversed_rotor(at.poses[self.on].rotor))
        return m.atan2(y, x)

    def constant(self, m: Namespace, numbers: Dimensions, at: Positions) -> Number:
        """Left side of the equation [rad] at positions whose angles are known: its constant."""
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
        wanted = rotate_vector(at.poses[self.on].rotor, rotor_of(m, bearing))
        return [spin * angle_between(m, wanted, self.offset(numbers, at))]

    def rows(self, numbers: Dimensions, at: Positions) -> list[Row]:
        wheel, point, on = self.bodies
        direction, arm = self.heading(numbers, at), self._arm(at)
        if isinstance(numbers.gearing.track[self.rolling], Straight):
            radius = numbers.gearing.radius[self.rolling]
            x, y = direction[0] / radius, direction[1] / radius
        else:
            # the bearing turns by the part across the heading over the distance of the centres
            share = numbers.gearing.spin(self.rolling) / dot(direction, self.offset(numbers, at))
            # spin times the direction square to the heading, clockwise: the residual falls as the centre goes
            # round
            x, y = share * direction[1], -share * direction[0]
        return [{wheel: (0.0, 0.0, 1.0), point: (x, y), on: (-x, -y, cross((x, y), arm) - 1.0)}]


@dataclass(frozen=True)
class Standing:
    """A link stands at a given angle: what says in the initial position how a gear or a wheel meshes."""

    link: str
    angle: float
    size = 1
    angular = True

    @cached_property
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


def contact_point(
    constraint: TrackContact | NoSlip, m: Namespace, numbers: Dimensions, at: Positions
) -> Vector:
    """Where a wheel touches its track: the instant centre of the wheel against the body it rolls on."""
    track = numbers.gearing.track[constraint.rolling]
    heading, offset = constraint.heading(numbers, at), constraint.offset(numbers, at)
    start = subtract(at.points[constraint.centre], offset)
    if isinstance(track, Straight):
        # a straight track is touched at the foot of the centre
        return along(start, heading, dot(heading, offset))
    # a ring around its pin touches on the far side of the pin
    far = m.sign(track.radius - numbers.gearing.radius[constraint.rolling]) if track.inside else 1.0
    return along(start, heading, far * track.radius)


class Constraint(Protocol):
    """Members of every kind of constraint."""

    @property
    def size(self) -> int:
        """Number of scalar equations."""

    @property
    def angular(self) -> bool:
        """Whether residuals are angles [rad]; otherwise they are lengths."""

    @property
    def bodies(self) -> tuple[Entity, ...]:
        """Points and links tied together, the frame and its points included."""

    @property
    def label(self) -> str:
        """Name for messages."""

    def residual(self, m: Namespace, numbers: Dimensions, at: Positions) -> list[Number]:
        """Left sides of the equations, zero where the constraint holds."""

    def rows(self, numbers: Dimensions, at: Positions) -> list[Row]:
        """Derivatives of the left sides by the coordinates of the bodies."""


@dataclass(frozen=True)
class PointInLink:
    """A link carries a point at fixed coordinates in its axes: half of a hinge."""

    point: str
    link: str
    size = 2
    angular = False

    @cached_property
    def bodies(self) -> tuple[Entity, ...]:
        return Entity("point", self.point), Entity("link", self.link)

    @property
    def label(self) -> str:
        return _("point {point} in link {link}").format(point=self.point, link=self.link)

    def residual(self, m: Namespace, numbers: Dimensions, at: Positions) -> list[Number]:
        point, pose = at.points[self.point], at.poses[self.link]
        return numbers.space.in_link(m, point, pose, self._local(numbers))

    def apart(self, m: Namespace, numbers: Dimensions, at: Positions) -> list[Number]:
        """By how much the point is not there, in each direction of space: the size of the residual at less cost."""
        point, pose = at.points[self.point], at.poses[self.link]
        return numbers.space.apart(m, point, pose, self._local(numbers))

    def rows(self, numbers: Dimensions, at: Positions) -> list[Row]:
        point, pose = at.points[self.point], at.poses[self.link]
        slopes = numbers.space.in_link_rows(PLAIN, point, pose, self._local(numbers))
        return [_row(self.bodies, slope) for slope in slopes]

    def _local(self, numbers: Dimensions) -> Coordinates:
        return numbers.local[self.link][self.point]


@dataclass(frozen=True)
class PointOnGuide:
    """A point stays on the curve of a guide."""

    point: str
    guide: str
    on: str
    size = 1
    angular = False

    @cached_property
    def bodies(self) -> tuple[Entity, ...]:
        return Entity("point", self.point), Entity("link", self.on)

    @property
    def label(self) -> str:
        return _("point {point} on guide {guide}").format(point=self.point, guide=self.guide)

    def residual(self, m: Namespace, numbers: Dimensions, at: Positions) -> list[Number]:
        point, pose = at.points[self.point], at.poses[self.on]
        return [numbers.space.on_guide(m, point, pose, numbers.curve(self.guide))]

    def rows(self, numbers: Dimensions, at: Positions) -> list[Row]:
        point, pose = at.points[self.point], at.poses[self.on]
        slope = numbers.space.on_guide_row(PLAIN, point, pose, numbers.curve(self.guide))
        return [_row(self.bodies, slope)]


@dataclass(frozen=True)
class NoTurning:
    """A link keeps its angle to the body that carries its guide: a prismatic pair together with PointOnGuide."""

    link: str
    guide: str
    on: str
    size = 1
    angular = True

    @cached_property
    def bodies(self) -> tuple[Entity, ...]:
        return Entity("link", self.link), Entity("link", self.on)

    @property
    def label(self) -> str:
        if self.on == FRAME:
            return _("link {link} does not turn relative to the frame (guide {guide})").format(
                link=self.link, guide=self.guide
            )
        return _("link {link} does not turn relative to {body} (guide {guide})").format(
            link=self.link, body=self.on, guide=self.guide
        )

    def residual(self, m: Namespace, numbers: Dimensions, at: Positions) -> list[Number]:
        pose, base = at.poses[self.link], at.poses[self.on]
        return [numbers.space.turn(m, pose, base, numbers.turn[self.guide], None)]

    def rows(self, numbers: Dimensions, at: Positions) -> list[Row]:
        pose, base = at.poses[self.link], at.poses[self.on]
        return [_row(self.bodies, numbers.space.turn_row(PLAIN, pose, base, None))]


@dataclass(frozen=True)
class AngleDrive:
    """A drive gives the angle of a link against another, or against the frame."""

    drive: str
    link: str
    relative_to: str
    size = 1
    angular = True

    @cached_property
    def bodies(self) -> tuple[Entity, ...]:
        return Entity("link", self.link), Entity("link", self.relative_to)

    @property
    def label(self) -> str:
        return _("drive of link {link}").format(link=self.link)

    def residual(self, m: Namespace, numbers: Dimensions, at: Positions) -> list[Number]:
        pose, base = at.poses[self.link], at.poses[self.relative_to]
        rotor = rotor_of(m, at.drives[self.drive])
        return [numbers.space.turn(m, pose, base, rotor, numbers.reference(self.link))]

    def rows(self, numbers: Dimensions, at: Positions) -> list[Row]:
        pose, base = at.poses[self.link], at.poses[self.relative_to]
        slope = numbers.space.turn_row(PLAIN, pose, base, numbers.reference(self.link))
        return [_row(self.bodies, slope)]


@dataclass(frozen=True)
class DisplacementDrive:
    """A drive gives the displacement of a point along its guide."""

    drive: str
    point: str
    guide: str
    on: str
    size = 1
    angular = False

    @cached_property
    def bodies(self) -> tuple[Entity, ...]:
        return Entity("point", self.point), Entity("link", self.on)

    @property
    def label(self) -> str:
        return _("drive of guide {guide}").format(guide=self.guide)

    def residual(self, m: Namespace, numbers: Dimensions, at: Positions) -> list[Number]:
        point, pose = at.points[self.point], at.poses[self.on]
        return [numbers.space.slid(m, point, pose, numbers.curve(self.guide), at.drives[self.drive])]

    def rows(self, numbers: Dimensions, at: Positions) -> list[Row]:
        point, pose = at.points[self.point], at.poses[self.on]
        slope = numbers.space.slid_row(PLAIN, point, pose, numbers.curve(self.guide))
        return [_row(self.bodies, slope)]


def _row(bodies: tuple[Entity, ...], slopes: Rows) -> Row:
    """The derivatives of one equation by the coordinates of the two bodies it ties."""
    return dict(zip(bodies, slopes, strict=True))


def constraints_of(mechanism: Mechanism) -> tuple[Constraint, ...]:
    # drives first: rows of the Jacobian are kept in this order, so a drive is never the redundant one
    """All constraints of a mechanism: drives, links, guides, gears, rolling, each in description order."""
    constraints: list[Constraint] = []
    for drive in mechanism.drives:
        if drive.kind == "angle":
            constraints.append(AngleDrive(drive.id, drive.link or "", drive.relative_to))
        elif drive.distance is not None:
            constraints.append(DistanceDrive(drive.id, *drive.distance))
        else:
            guide = mechanism.guide(drive.guide or "")
            constraints.append(DisplacementDrive(drive.id, guide.point, guide.id, guide.on))
    for name, link in mechanism.links.items():
        constraints += [PointInLink(point, name) for point in link.coordinates]
    for guide in mechanism.guides:
        constraints.append(PointOnGuide(guide.point, guide.id, guide.on))
        if guide.link is not None:
            constraints.append(NoTurning(guide.link, guide.id, guide.on))
    constraints += [
        GearRatio(gear.id, gear.links[0], gear.links[1], gear.carrier) for gear in mechanism.gears
    ]
    for wheel in mechanism.rolling:
        constraints += [kind(wheel.id, wheel.link, wheel.centre, wheel.on) for kind in (NoSlip, TrackContact)]
    return tuple(constraints)


def is_drive(constraint: Constraint) -> bool:
    """Whether the constraint is a drive."""
    return isinstance(constraint, (AngleDrive, DisplacementDrive, DistanceDrive))


def unknowns_of(mechanism: Mechanism) -> tuple[Entity, ...]:
    """Moving points, then links, in description order."""
    points = tuple(Entity("point", name) for name in mechanism.moving_points)
    return points + tuple(Entity("link", name) for name in mechanism.links)
