"""Closed forms of the groups of class II, over any algebra.

Each takes the positions known before it and adds its own; where a formula has several answers, it asks the
`Choices` it is given.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Protocol, TypeAlias

from centrode.geometry.plane import (
    Pose,
    Root,
    Vector,
    add,
    aim,
    along,
    length_of,
    meet_circle_and_line,
    meet_circles,
    meet_lines,
    place,
    pose_by_two_points,
    pose_with_point,
    reversed_rotor,
    rotor_of,
    subtract,
    turned,
)
from centrode.structure.dimensions import Dimensions
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
    TurnedLink,
    Turning,
    TwoPointLink,
)
from centrode.structure.positions import Positions, line_of

Number: TypeAlias = Any
Namespace: TypeAlias = Any


@dataclass(frozen=True)
class Circle:
    """Locus of the unknown vector: a circle."""

    centre: Vector
    radius: Number


@dataclass(frozen=True)
class Line:
    """Locus of the unknown vector: a line with a unit direction."""

    through: Vector
    direction: Vector


class Choices(Protocol):
    """What decides where a formula has several answers."""

    def root(self, radicand: Number) -> Number:
        """The signed root of a radicand: the sign is the branch."""

    def divisor(self, divisor: Number) -> Number:
        """A number that is divided by, as it is: its zero is a place the group cannot pass."""

    def continued(self, key: str, angle: Number) -> Number:
        """An angle in (-pi, pi] with the turns that its path has made; `key` names it."""

    def higher(self, m: Namespace, at: Positions) -> None:
        """Add what the group gives, if it is of higher class."""


def solve_group(group: Group, m: Namespace, numbers: Dimensions, at: Positions, choices: Choices) -> None:
    """Add the places of a group's points and links to the positions."""
    if isinstance(group, RigidPoint):
        at.points[group.point] = place(at.poses[group.link], numbers.local[group.link][group.point])
    elif isinstance(group, TwoPointLink):
        _two_points(group.link, group.first, group.second, numbers, at)
    elif isinstance(group, TurnedLink):
        local = numbers.local[group.link][group.pivot]
        rotor = turning_rotor(group.turning, group.link, m, numbers, at)
        at.poses[group.link] = pose_with_point(local, at.points[group.pivot], rotor)
    elif isinstance(group, Aim):
        _aim(group, numbers, at, choices.root)
    elif isinstance(group, Meet):
        _meet(group, m, numbers, at, choices)
    elif isinstance(group, Newton):
        choices.higher(m, at)


def turning_rotor(turning: Turning, link: str, m: Namespace, numbers: Dimensions, at: Positions) -> Vector:
    """Rotor of a link whose angle a drive or a guide gives against a body that is known."""
    if turning.drive is not None:
        difference = rotor_of(m, at.drives[turning.drive])
    else:
        difference = numbers.turn[turning.guide or ""]
    if link == turning.link:
        return turned(at.poses[turning.relative_to].rotor, difference)
    return turned(at.poses[turning.link].rotor, reversed_rotor(difference))


def _two_points(link: str, first: str, second: str, numbers: Dimensions, at: Positions) -> None:
    local = numbers.local[link]
    at.poses[link] = pose_by_two_points(local[first], local[second], at.points[first], at.points[second])


def aim_line(group: Aim, numbers: Dimensions) -> tuple[Vector, Vector]:
    """Line of the aimed link on which the target lies, in the link's axes."""
    through, direction = numbers.through[group.guide], numbers.direction[group.guide]
    if group.block is not None and group.sliding is not None:
        # the block keeps its angle to the aimed link, so its pivot runs on a parallel of the guide
        inside = numbers.local[group.block]
        shift = subtract(inside[group.target], inside[group.sliding])
        through = add(through, turned(shift, numbers.turn[group.guide]))
    return through, direction


def _aim(group: Aim, numbers: Dimensions, at: Positions, root: Root) -> None:
    through, direction = aim_line(group, numbers)
    pivot = numbers.local[group.link][group.pivot]
    pose = aim(pivot, at.points[group.pivot], through, direction, at.points[group.target], root)
    at.poses[group.link] = pose
    if group.block is not None and group.sliding is not None:
        rotor = turned(pose.rotor, numbers.turn[group.guide])
        block = pose_with_point(numbers.local[group.block][group.target], at.points[group.target], rotor)
        at.poses[group.block] = block
        at.points[group.sliding] = place(block, numbers.local[group.block][group.sliding])


def _carriage_rotor(group: Meet, m: Namespace, numbers: Dimensions, at: Positions) -> Vector | None:
    if group.carriage is None or group.turning is None:
        return None
    return turning_rotor(group.turning, group.carriage, m, numbers, at)


def _arms(group: Meet, numbers: Dimensions, rotor: Vector | None) -> dict[str, Vector]:
    """Vectors from the group's unknown vector to each of its points."""
    if group.carriage is None or rotor is None:
        return {point: (0.0, 0.0) for point in group.points}
    local = numbers.local[group.carriage]
    return {point: turned(local[point], rotor) for point in group.points}


def loci_of(group: Meet, m: Namespace, numbers: Dimensions, at: Positions) -> list[Circle | Line]:
    """The two loci of a group's unknown vector, circles first."""
    rotor = _carriage_rotor(group, m, numbers, at)
    arms = _arms(group, numbers, rotor)
    return [_locus(locus, m, numbers, at, arms, rotor) for locus in group.loci]


def _meet(group: Meet, m: Namespace, numbers: Dimensions, at: Positions, choices: Choices) -> None:
    rotor = _carriage_rotor(group, m, numbers, at)
    arms = _arms(group, numbers, rotor)
    loci = [_locus(locus, m, numbers, at, arms, rotor) for locus in group.loci]
    vector = _where_they_meet(loci, choices)
    if group.carriage is not None and rotor is not None:
        at.poses[group.carriage] = Pose(vector, rotor)
    for point in group.points:
        at.points[point] = vector if rotor is None else add(vector, arms[point])
    for rod in group.rods:
        _two_points(rod.link, rod.centre, rod.point, numbers, at)


def _where_they_meet(loci: Sequence[Circle | Line], choices: Choices) -> Vector:
    one, other = loci
    if isinstance(one, Circle):
        if isinstance(other, Circle):
            return meet_circles(one.centre, one.radius, other.centre, other.radius, choices.root)
        return meet_circle_and_line(one.centre, one.radius, other.through, other.direction, choices.root)
    assert isinstance(other, Line)  # circles stand first
    return meet_lines(one.through, one.direction, other.through, other.direction, choices.divisor)


def _locus(
    locus: Locus,
    m: Namespace,
    numbers: Dimensions,
    at: Positions,
    arms: dict[str, Vector],
    rotor: Vector | None,
) -> Circle | Line:
    """Locus of the group's unknown vector: that of the point, moved back by the point's arm on the carriage."""
    if isinstance(locus, Rod):
        local = numbers.local[locus.link]
        # the sign of a two-point link's length depends on which end is known; circles do not feel it
        radius = length_of(m, subtract(local[locus.point], local[locus.centre]))
        return Circle(subtract(at.points[locus.centre], arms[locus.point]), radius)
    if isinstance(locus, Slot) and rotor is not None:
        arm = turned(numbers.through[locus.guide], rotor)
        direction = turned(numbers.direction[locus.guide], rotor)
        return Line(subtract(at.points[locus.point], arm), direction)
    assert isinstance(locus, (Rail, Stop))
    through, direction = line_of(numbers, at, locus.guide, locus.on)
    if isinstance(locus, Stop):
        through = along(through, direction, at.drives[locus.drive])
        direction = (-direction[1], direction[0])
    return Line(subtract(through, arms[locus.point]), direction)
