"""Which closed form solves a group: rigid point, link by two points, crank, parallel link, a dyad, or none."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from centrode.model.mechanism import Mechanism
from centrode.structure.constraints import (
    AngleDrive,
    Constraint,
    DisplacementDrive,
    NoTurning,
    PointInLink,
    PointOnGuide,
)
from centrode.structure.cylinders import DistanceDrive
from centrode.structure.groups import (
    Aim,
    Group,
    Locus,
    Meet,
    Newton,
    Rail,
    RigidPoint,
    Rod,
    Slot,
    Stop,
    Stroke,
    TurnedLink,
    Turning,
    TwoPointLink,
)
from centrode.structure.positions import Entity
from centrode.structure.trains import following, train, wheel_locus
from centrode.structure.wheel_groups import Following
from centrode.structure.wheels import Contact


@dataclass(frozen=True)
class Unsolved:
    """A group before it is classified: its unknowns and the constraints matched to them, in description order."""

    mechanism: Mechanism
    points: tuple[str, ...]
    links: tuple[str, ...]
    constraints: tuple[Constraint, ...]
    crosses_once: bool = True

    def ends(self, link: str) -> tuple[str, ...]:
        """Points that the group's constraints fix in a link."""
        return tuple(c.point for c in self.constraints if isinstance(c, PointInLink) and c.link == link)

    def knows_point(self, point: str) -> bool:
        return point not in self.points

    def knows_link(self, link: str) -> bool:
        return link not in self.links

    def turning(self, link: str) -> tuple[Constraint, Turning | Following] | None:
        """The constraint that gives the angle of a link from known ones, if there is one."""
        for c in self.constraints:
            follows = following(self, c, link)
            if follows is not None:
                return c, follows
            found = _turning_of(c)
            if found is None or link not in (found.link, found.relative_to):
                continue
            other = found.relative_to if found.link == link else found.link
            if self.knows_link(other):
                return c, found
        return None


def _turning_of(constraint: Constraint) -> Turning | None:
    if isinstance(constraint, AngleDrive):
        return Turning(constraint.link, constraint.relative_to, drive=constraint.drive)
    if isinstance(constraint, NoTurning):
        return Turning(constraint.link, constraint.on, guide=constraint.guide)
    return None


def classify(
    mechanism: Mechanism,
    unknowns: Sequence[Entity],
    equations: Sequence[tuple[Constraint, int]],
    crosses_once: bool = True,
) -> Group:
    """The group that unknowns form under the equations (constraint and row) matched to them.

    `crosses_once` says whether the curves of two guides meet in one place, as lines do.
    """
    group = Unsolved(
        mechanism,
        tuple(e.name for e in unknowns if e.kind == "point"),
        tuple(e.name for e in unknowns if e.kind == "link"),
        tuple(dict.fromkeys(constraint for constraint, _row in equations)),
        crosses_once,
    )
    for attempt in (_rigid_point, _single_link, _aim_with_block, _meet, train):
        found = attempt(group)
        if found is not None:
            return found
    return Newton(group.points, group.links, tuple(equations))


def _rigid_point(group: Unsolved) -> Group | None:
    if group.links or len(group.points) != 1 or len(group.constraints) != 1:
        return None
    (constraint,) = group.constraints
    return RigidPoint(constraint.point, constraint.link) if isinstance(constraint, PointInLink) else None


def _single_link(group: Unsolved) -> Group | None:
    if group.points or len(group.links) != 1:
        return None
    (link,) = group.links
    ends = group.ends(link)
    if len(ends) == 2:
        return TwoPointLink(link, *ends)
    if len(ends) != 1:
        return None
    turning = group.turning(link)
    if turning is not None:
        return TurnedLink(link, ends[0], turning[1])
    for c in group.constraints:
        if isinstance(c, PointOnGuide) and c.on == link:
            return Aim(link, ends[0], c.guide, c.point)
        if isinstance(c, Contact) and c.on == link:
            touch = wheel_locus(group, c, link)
            return Aim(link, ends[0], "", c.centre, contact=c) if touch and touch.letter == "P" else None
    return None


def _aim_with_block(group: Unsolved) -> Group | None:
    """RPR whose guide's point is not the hinge of the block: two links on known pivots, a prismatic pair between."""
    if len(group.links) != 2 or len(group.points) != 1 or len(group.constraints) != 5:
        return None
    (sliding,) = group.points
    guides = [c for c in group.constraints if isinstance(c, PointOnGuide) and c.point == sliding]
    fixed = [c for c in group.constraints if isinstance(c, NoTurning)]
    if len(guides) != 1 or len(fixed) != 1 or fixed[0].guide != guides[0].guide:
        return None
    link, block = fixed[0].on, fixed[0].link
    pivots = group.ends(link)
    targets = tuple(point for point in group.ends(block) if point != sliding)
    known = all(group.knows_point(point) for point in pivots + targets)
    if len(pivots) != 1 or len(targets) != 1 or not known or {link, block} != set(group.links):
        return None
    return Aim(link, pivots[0], guides[0].guide, targets[0], block, sliding)


def _meet(group: Unsolved) -> Group | None:
    """One unknown vector with two loci; everything else in the group must hang on it."""
    carriages = [link for link in group.links if group.turning(link) is not None]
    if len(carriages) > 1:
        return None
    carriage = carriages[0] if carriages else None
    used: set[Constraint] = set()
    turning = None
    if carriage is None:
        if len(group.points) != 1:
            return None
    else:
        found = group.turning(carriage)
        if found is None or not _carries_all(group, carriage):
            return None
        used.add(found[0])
        turning = found[1]
        used |= {c for c in group.constraints if isinstance(c, PointInLink) and c.link == carriage}
    loci: list[Locus] = []
    for link in group.links:
        if link != carriage:
            rod = _rod(group, link)
            if rod is None:
                return None
            loci.append(rod)
            used |= {c for c in group.constraints if isinstance(c, PointInLink) and c.link == link}
    for c in group.constraints:
        locus = _line(group, c, carriage) or wheel_locus(group, c, carriage)
        if isinstance(c, DistanceDrive):
            locus = _stroke(group, c)
        if locus is not None:
            loci.append(locus)
            used.add(c)
    loci.sort(key=lambda locus: locus.letter != "R")  # circles first
    if len(loci) != 2 or used != set(group.constraints):
        return None
    return Meet(group.points, (loci[0], loci[1]), carriage, turning, group.crosses_once)


def _carries_all(group: Unsolved, carriage: str) -> bool:
    """Whether the unknown points of the group are exactly the points its carriage brings along."""
    return set(group.ends(carriage)) == set(group.points)


def _rod(group: Unsolved, link: str) -> Rod | None:
    ends = group.ends(link)
    unknown = [point for point in ends if not group.knows_point(point)]
    known = [point for point in ends if group.knows_point(point)]
    if len(ends) != 2 or len(unknown) != 1:
        return None
    return Rod(unknown[0], known[0], link)


def _stroke(group: Unsolved, drive: DistanceDrive) -> Stroke | None:
    unknown = [point for point in (drive.first, drive.second) if not group.knows_point(point)]
    if len(unknown) != 1:
        return None
    known = drive.second if unknown[0] == drive.first else drive.first
    return Stroke(unknown[0], known, drive.drive)


def _line(group: Unsolved, constraint: Constraint, carriage: str | None) -> Locus | None:
    if isinstance(constraint, PointOnGuide):
        if constraint.on == carriage:
            return Slot(constraint.point, constraint.guide) if group.knows_point(constraint.point) else None
        known = group.knows_link(constraint.on) and not group.knows_point(constraint.point)
        return Rail(constraint.point, constraint.guide, constraint.on) if known else None
    if isinstance(constraint, DisplacementDrive):
        known = group.knows_link(constraint.on) and not group.knows_point(constraint.point)
        return Stop(constraint.point, constraint.guide, constraint.on, constraint.drive) if known else None
    return None
