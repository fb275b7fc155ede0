"""The one list of constraints: formula and Jacobian row of each.

The list serves rank and mobility, the plan, residuals, Newton groups, equations in symbols and reactions.
Unknowns are the points (two coordinates) and the links (origin and angle); a constraint ties some of them
together.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol, TypeAlias

from centrode.algebra.plain import PLAIN
from centrode.geometry.plane import rotor_of
from centrode.geometry.space import Coordinates, Rows
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.structure.cylinders import DistanceDrive
from centrode.structure.dimensions import Dimensions
from centrode.structure.gear_ratios import GearRatio
from centrode.structure.positions import Entity, Positions, Row
from centrode.structure.wheels import Contact, NoSlip

Number: TypeAlias = Any
Namespace: TypeAlias = Any


class Constraint(Protocol):
    """What every kind of constraint tells of itself."""

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

    @property
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

    @property
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

    @property
    def bodies(self) -> tuple[Entity, ...]:
        return Entity("link", self.link), Entity("link", self.on)

    @property
    def label(self) -> str:
        return _("link {link} does not turn against {body} (guide {guide})").format(
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

    @property
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

    @property
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
    """All constraints of a mechanism: drives, links, guides, gears, rolling, each in description order."""
    found: list[Constraint] = []
    for drive in mechanism.drives:
        if drive.kind == "angle":
            found.append(AngleDrive(drive.id, drive.link or "", drive.relative_to))
        elif drive.distance is not None:
            found.append(DistanceDrive(drive.id, *drive.distance))
        else:
            guide = mechanism.guide(drive.guide or "")
            found.append(DisplacementDrive(drive.id, guide.point, guide.id, guide.on))
    for name, link in mechanism.links.items():
        found += [PointInLink(point, name) for point in link.coordinates]
    for guide in mechanism.guides:
        found.append(PointOnGuide(guide.point, guide.id, guide.on))
        if guide.link is not None:
            found.append(NoTurning(guide.link, guide.id, guide.on))
    found += [GearRatio(gear.id, gear.links[0], gear.links[1], gear.carrier) for gear in mechanism.gears]
    for wheel in mechanism.rolling:
        found += [kind(wheel.id, wheel.link, wheel.centre, wheel.on) for kind in (NoSlip, Contact)]
    return tuple(found)


def is_drive(constraint: Constraint) -> bool:
    """Whether the constraint is a drive."""
    return isinstance(constraint, (AngleDrive, DisplacementDrive, DistanceDrive))


def unknowns_of(mechanism: Mechanism) -> tuple[Entity, ...]:
    """Moving points, then links, in description order."""
    points = tuple(Entity("point", name) for name in mechanism.moving_points)
    return points + tuple(Entity("link", name) for name in mechanism.links)
