"""Closed forms of the groups of class II, over any algebra.

Each takes the positions known before it and adds its own; where a formula has several answers, it asks the
`Choices` it is given.
"""

from __future__ import annotations

from typing import Any, Protocol, TypeAlias

from centrode.geometry.plane import (
    Circle,
    Line,
    Pose,
    Vector,
    add,
    place,
    pose_with_point,
    reversed_rotor,
    subtract,
    turned,
)
from centrode.geometry.space import Curve, Root
from centrode.geometry.space import Pose as AnyPose
from centrode.kinematics.turned_links import add_angle, difference_of, turn_link
from centrode.kinematics.wheels import (
    beside_track,
    pose_at,
    rolloff_line,
    solve_train,
    touched_circle,
    touched_line,
)
from centrode.structure.constraints import Positions
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
    Rolloff,
    Slot,
    Stop,
    Stroke,
    Touch,
    Train,
    TurnedLink,
    Turning,
    TwoPointLink,
)

Number: TypeAlias = Any
Namespace: TypeAlias = Any


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
        local = numbers.local[group.link][group.point]
        at.points[group.point] = numbers.space.place(m, at.poses[group.link], local)
    elif isinstance(group, TwoPointLink):
        _two_points(group.link, group.first, group.second, m, numbers, at)
    elif isinstance(group, TurnedLink):
        at.poses[group.link] = _turned_link(group, m, numbers, at, choices)
    elif isinstance(group, Aim):
        _aim(group, m, numbers, at, choices.root)
    elif isinstance(group, Meet):
        _meet(group, m, numbers, at, choices)
    elif isinstance(group, Train):
        solve_train(group, m, numbers, at, choices.continued)
    elif isinstance(group, Newton):
        choices.higher(m, at)


def _turned_link(
    group: TurnedLink, m: Namespace, numbers: Dimensions, at: Positions, choices: Choices
) -> AnyPose:
    turning = group.turning
    if not isinstance(turning, Turning):
        rotor = turn_link(turning, group.link, m, numbers, at, choices.continued)
        return pose_at(group.link, group.pivot, rotor, m, numbers, at)
    add_angle(turning, group.link, numbers, at)
    rotor, reference = difference_of(turning, m, numbers, at), numbers.reference(turning.link)
    base = turning.relative_to
    if group.link != turning.link:  # it is the base that is unknown
        rotor, base = reversed_rotor(rotor), turning.link
        reference = reference and reference[2:] + reference[:2]
    local = numbers.local[group.link][group.pivot]
    return numbers.space.turned_pose(m, at.poses[base], rotor, local, at.points[group.pivot], reference)


def _two_points(link: str, first: str, second: str, m: Namespace, numbers: Dimensions, at: Positions) -> None:
    local = numbers.local[link]
    at.poses[link] = numbers.space.pose_by_two_points(
        m, local[first], local[second], at.points[first], at.points[second]
    )


def aim_curve(group: Aim, numbers: Dimensions) -> Curve:
    """Curve of the aimed link on which the target lies, in the link's axes."""
    if group.contact is not None:
        return beside_track(group.contact.rolling, numbers)
    if group.block is None or group.sliding is None:
        return numbers.curve(group.guide)
    # the block keeps its angle to the aimed link, so its pivot runs on a parallel of the guide
    through, direction = numbers.through[group.guide], numbers.direction[group.guide]
    inside = numbers.local[group.block]
    shift = subtract(inside[group.target], inside[group.sliding])
    return add(through, turned(shift, numbers.turn[group.guide])), direction


def _aim(group: Aim, m: Namespace, numbers: Dimensions, at: Positions, root: Root) -> None:
    pivot, target = at.points[group.pivot], at.points[group.target]
    local, curve = numbers.local[group.link][group.pivot], aim_curve(group, numbers)
    pose = numbers.space.aim(m, local, pivot, curve, target, root)
    at.poses[group.link] = pose
    if group.block is not None and group.sliding is not None:
        rotor = turned(pose.rotor, numbers.turn[group.guide])
        block = pose_with_point(numbers.local[group.block][group.target], at.points[group.target], rotor)
        at.poses[group.block] = block
        at.points[group.sliding] = place(block, numbers.local[group.block][group.sliding])


def _carriage_rotor(
    group: Meet, m: Namespace, numbers: Dimensions, at: Positions, choices: Choices
) -> Vector | None:
    if group.carriage is None or group.turning is None:
        return None
    rotor = turn_link(group.turning, group.carriage, m, numbers, at, choices.continued)
    rolls = [locus.rolling for locus in group.loci if isinstance(locus, Rolloff)]
    if group.carriage not in at.angles and any(group.carriage in (r.link, r.on) for r in rolls):
        at.angles[group.carriage] = choices.continued(group.carriage, m.atan2(rotor[1], rotor[0]))
    return rotor


def _arms(group: Meet, numbers: Dimensions, rotor: Vector | None) -> dict[str, Vector]:
    """Vectors from the group's unknown vector to each of its points."""
    if group.carriage is None or rotor is None:
        return {point: (0.0, 0.0) for point in group.points}
    local = numbers.local[group.carriage]
    return {point: turned(local[point], rotor) for point in group.points}


def loci_of(group: Meet, m: Namespace, numbers: Dimensions, at: Positions, choices: Choices) -> list[Any]:
    """The two loci of a group's unknown vector, circles of links first."""
    rotor = _carriage_rotor(group, m, numbers, at, choices)
    arms = _arms(group, numbers, rotor)
    return [_locus(locus, m, numbers, at, arms, rotor) for locus in group.loci]


def _meet(group: Meet, m: Namespace, numbers: Dimensions, at: Positions, choices: Choices) -> None:
    rotor = _carriage_rotor(group, m, numbers, at, choices)
    arms = _arms(group, numbers, rotor)
    one, other = (_locus(locus, m, numbers, at, arms, rotor) for locus in group.loci)
    vector = numbers.space.meet(one, other, choices.root, choices.divisor)
    if group.carriage is not None and rotor is not None:
        at.poses[group.carriage] = Pose(vector, rotor)
    for point in group.points:
        at.points[point] = vector if rotor is None else add(vector, arms[point])
    for rod in group.rods:
        _two_points(rod.link, rod.centre, rod.point, m, numbers, at)


def _locus(
    locus: Locus,
    m: Namespace,
    numbers: Dimensions,
    at: Positions,
    arms: dict[str, Vector],
    rotor: Vector | None,
) -> Any:
    """Locus of the group's unknown vector: that of the point, moved back by the point's arm on the carriage."""
    if isinstance(locus, Stroke | Touch | Rolloff):
        found = _driven_or_rolled(locus, numbers, at, rotor)
    else:
        found = _of_point(locus, m, numbers, at, rotor)
    if rotor is None:
        return found
    arm = arms.get(locus.point, (0.0, 0.0))
    if isinstance(found, Circle):
        return Circle(subtract(found.centre, arm), found.radius)
    return Line(subtract(found.through, arm), found.direction)


def _of_point(
    locus: Rod | Rail | Slot | Stop, m: Namespace, numbers: Dimensions, at: Positions, rotor: Vector | None
) -> Any:
    """Locus of a point of the group; of the unknown vector itself, if it is a slot of the carriage."""
    if isinstance(locus, Rod):
        local = numbers.local[locus.link]
        return numbers.space.circle(m, at.points[locus.centre], local[locus.centre], local[locus.point])
    if isinstance(locus, Slot):
        assert rotor is not None
        arm = turned(numbers.through[locus.guide], rotor)
        direction = turned(numbers.direction[locus.guide], rotor)
        return Line(subtract(at.points[locus.point], arm), direction)
    assert isinstance(locus, (Rail, Stop))
    pose, curve = at.poses[locus.on], numbers.curve(locus.guide)
    if isinstance(locus, Rail):
        return numbers.space.rail(m, pose, curve)
    return numbers.space.stop(m, pose, curve, at.drives[locus.drive])


def _driven_or_rolled(
    locus: Stroke | Touch | Rolloff, numbers: Dimensions, at: Positions, rotor: Vector | None
) -> Circle | Line:
    """Locus of a point at a cylinder or a track; of the unknown vector itself, if the carriage holds the track."""
    if isinstance(locus, Stroke):
        return Circle(at.points[locus.centre], at.drives[locus.drive])
    if isinstance(locus, Rolloff):
        turn = at.angles[locus.rolling.link] - at.angles[locus.rolling.on]
        return Line(*rolloff_line(locus, turn, numbers, at, rotor))
    if locus.letter == "R":
        reach = numbers.gearing.reach(locus.contact.rolling)
        return Circle(touched_circle(locus, numbers, at, rotor), reach)
    return Line(*touched_line(locus, numbers, at, rotor))
