"""The one list of constraints: formula and Jacobian row of each.

The list serves rank and mobility, the plan, residuals, Newton groups, equations in symbols and reactions.
Unknowns are the points (two coordinates) and the links (origin and angle); a constraint ties some of them
together.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol, TypeAlias

from centrode.geometry.plane import (
    Vector,
    cross,
    dot,
    place,
    rotor_of,
    subtract,
    turned,
)
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.structure.dimensions import Dimensions
from centrode.structure.positions import Entity, Positions, angle_between, line_of

Number: TypeAlias = Any
Namespace: TypeAlias = Any
Row: TypeAlias = dict[Entity, tuple[Number, ...]]


class Constraint(Protocol):
    """What every kind of constraint tells of itself."""

    @property
    def size(self) -> int:
        """Number of scalar equations."""

    @property
    def angular(self) -> bool:
        """Whether residuals are angles [rad]; otherwise they are lengths [m]."""

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
        return list(subtract(at.points[self.point], place(at.poses[self.link], self._local(numbers))))

    def rows(self, numbers: Dimensions, at: Positions) -> list[Row]:
        point, link = self.bodies
        arm = turned(self._local(numbers), at.poses[self.link].rotor)
        return [
            {point: (1.0, 0.0), link: (-1.0, 0.0, arm[1])},
            {point: (0.0, 1.0), link: (0.0, -1.0, -arm[0])},
        ]

    def _local(self, numbers: Dimensions) -> Vector:
        return numbers.local[self.link][self.point]


@dataclass(frozen=True)
class PointOnGuide:
    """A point stays on the line of a guide."""

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
        through, direction = line_of(numbers, at, self.guide, self.on)
        return [cross(direction, subtract(at.points[self.point], through))]

    def rows(self, numbers: Dimensions, at: Positions) -> list[Row]:
        point, link = self.bodies
        direction = line_of(numbers, at, self.guide, self.on)[1]
        arm = subtract(at.points[self.point], at.poses[self.on].origin)
        return [
            {
                point: (-direction[1], direction[0]),
                link: (direction[1], -direction[0], -dot(direction, arm)),
            }
        ]


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
        reference = turned(at.poses[self.on].rotor, numbers.turn[self.guide])
        return [angle_between(m, at.poses[self.link].rotor, reference)]

    def rows(self, numbers: Dimensions, at: Positions) -> list[Row]:
        link, on = self.bodies
        return [{link: (0.0, 0.0, 1.0), on: (0.0, 0.0, -1.0)}]


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
        reference = turned(at.poses[self.relative_to].rotor, rotor_of(m, at.drives[self.drive]))
        return [angle_between(m, at.poses[self.link].rotor, reference)]

    def rows(self, numbers: Dimensions, at: Positions) -> list[Row]:
        link, reference = self.bodies
        return [{link: (0.0, 0.0, 1.0), reference: (0.0, 0.0, -1.0)}]


@dataclass(frozen=True)
class DisplacementDrive:
    """A drive gives the displacement of a point along its guide, from the point the guide goes through."""

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
        through, direction = line_of(numbers, at, self.guide, self.on)
        return [dot(direction, subtract(at.points[self.point], through)) - at.drives[self.drive]]

    def rows(self, numbers: Dimensions, at: Positions) -> list[Row]:
        point, link = self.bodies
        direction = line_of(numbers, at, self.guide, self.on)[1]
        arm = subtract(at.points[self.point], at.poses[self.on].origin)
        return [{point: direction, link: (-direction[0], -direction[1], cross(direction, arm))}]


def constraints_of(mechanism: Mechanism) -> tuple[Constraint, ...]:
    """All constraints of a mechanism: drives first, then links, then guides, each in description order."""
    found: list[Constraint] = []
    for drive in mechanism.drives:
        if drive.kind == "angle":
            found.append(AngleDrive(drive.id, drive.link or "", drive.relative_to))
        else:
            guide = mechanism.guide(drive.guide or "")
            found.append(DisplacementDrive(drive.id, guide.point, guide.id, guide.on))
    for name, link in mechanism.links.items():
        found += [PointInLink(point, name) for point in link.coordinates]
    for guide in mechanism.guides:
        found.append(PointOnGuide(guide.point, guide.id, guide.on))
        if guide.link is not None:
            found.append(NoTurning(guide.link, guide.id, guide.on))
    return tuple(found)


def is_drive(constraint: Constraint) -> bool:
    """Whether the constraint is a drive."""
    return isinstance(constraint, (AngleDrive, DisplacementDrive))


def unknowns_of(mechanism: Mechanism) -> tuple[Entity, ...]:
    """Moving points, then links, in description order."""
    points = tuple(Entity("point", name) for name in mechanism.moving_points)
    return points + tuple(Entity("link", name) for name in mechanism.links)
