"""Closed forms of the groups of class II, over any algebra.

Each takes the positions known before it and adds its own; where a formula has several answers, it asks the
`Choices` it is given.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Protocol, TypeAlias, assert_never

from centrode.geometry.plane import (
    Line,
    PlaneCircle,
    PlanePose,
    Vector,
    add,
    along,
    place,
    pose_with_point,
    reversed_rotor,
    rotate_vector,
    rotor_of,
    subtract,
)
from centrode.geometry.space import Curve, Root
from centrode.geometry.space import Pose as AnyPose
from centrode.structure.constraints import FRAME, GearRatio, NoSlip, Positions
from centrode.structure.dimensions import Dimensions
from centrode.structure.gearing import Straight
from centrode.structure.groups import (
    Aim,
    AngleEquation,
    AngleGiven,
    Arm,
    CylinderCircle,
    Following,
    Group,
    GuideStop,
    Locus,
    Meet,
    Meshed,
    Newton,
    Rail,
    RigidPoint,
    Rod,
    Rolled,
    Rolloff,
    Slot,
    Touch,
    Train,
    TurnedLink,
    Turning,
    TwoPointLink,
)

# Closed forms of gears and rolling wheels, over any algebra: angles that follow, loci, trains.
#
# Angles run on over turns, so that ratios that are no whole numbers keep their meaning.

Number: TypeAlias = Any
Namespace: TypeAlias = Any
Continued: TypeAlias = Callable[[str, Number], Number]
PointAndDirection: TypeAlias = tuple[Vector, Vector]


def bearing_key(rolling: str) -> str:
    """Name under which the direction of a wheel's centre about its circle is counted over turns."""
    return f"rolling/{rolling}"  # no link has a slash in its name


def meshed_angle(turning: Meshed, link: str, numbers: Dimensions, at: Positions) -> Number:
    """Angle [rad] of one link of a gear from those of the other two."""
    gear = turning.gear
    ratio, phase = numbers.gearing.ratio[gear.gear], numbers.gearing.phase[gear.gear]
    first, second = numbers.gearing.shares.get(gear.gear, (1.0, 1.0))
    if link == gear.carrier:
        # solved for the carrier: theta2 - s2 theta_c = phase + ratio (theta1 - s1 theta_c)
        return (at.angles[gear.second] - ratio * at.angles[gear.first] - phase) / (second - ratio * first)
    carrier = at.angles[gear.carrier]
    if link == gear.second:
        return second * carrier + (phase + ratio * (at.angles[gear.first] - first * carrier))
    return first * carrier + (at.angles[gear.second] - second * carrier - phase) / ratio


def rolled_turn(
    rolling: NoSlip, m: Namespace, numbers: Dimensions, at: Positions, continued: Continued
) -> Number:
    """Angle [rad] of a wheel against the body it rolls on, from where its centre is."""
    gearing, phase = numbers.gearing, numbers.gearing.phase[rolling.rolling]
    if isinstance(gearing.track[rolling.rolling], Straight):
        # a wheel on a straight track turns by minus the way over the radius: forwards is clockwise seen from
        # the left
        return phase - rolling.slide(numbers, at) / gearing.radius[rolling.rolling]
    key = bearing_key(rolling.rolling)
    bearing = at.angles[key] = continued(key, rolling.bearing(m, numbers, at))
    return phase + gearing.spin(rolling.rolling) * bearing


def follow_contact(
    turning: Meshed | Rolled,
    link: str,
    m: Namespace,
    numbers: Dimensions,
    at: Positions,
    continued: Continued,
) -> tuple[Vector, Number | None]:
    """Rotor and angle of a link that a gear or a rolling contact turns; no angle where its turns are not known."""
    match turning:
        case Meshed():
            angle = meshed_angle(turning, link, numbers, at)
            return rotor_of(m, angle), angle
        case Rolled(rolling):
            turn = rolled_turn(rolling, m, numbers, at, continued)
            rotor = rotate_vector(at.poses[rolling.on].rotor, rotor_of(m, turn))
            return rotor, at.angles[rolling.on] + turn if rolling.on in at.angles else None
        case _:
            assert_never(turning)


def touched_circle(locus: Touch, numbers: Dimensions, at: Positions, rotor: Vector | None) -> Vector:
    """Centre of the circle on which a wheel's centre is, or the carriage's origin where the track is carried."""
    centre = numbers.gearing.track[locus.contact.rolling].centre  # type: ignore[union-attr]
    if locus.carried and rotor is not None:
        # the carriage's unknown vector is its origin: the point less its place on the turned carriage
        return subtract(at.points[locus.point], rotate_vector(centre, rotor))
    return place(at.poses[locus.contact.on], centre)


def touched_line(locus: Touch, numbers: Dimensions, at: Positions, rotor: Vector | None) -> PointAndDirection:
    """Line on which a wheel's centre is, a radius to the left of the track; or the carriage's origin."""
    through, direction = beside_track(locus.contact.rolling, numbers)
    if locus.carried and rotor is not None:
        return subtract(at.points[locus.point], rotate_vector(through, rotor)), rotate_vector(
            direction, rotor
        )
    pose = at.poses[locus.contact.on]
    return place(pose, through), rotate_vector(direction, pose.rotor)


def beside_track(rolling: str, numbers: Dimensions) -> PointAndDirection:
    """The parallel of a straight track on which the wheel's centre is, in the axes of the body that carries it."""
    track = numbers.gearing.track[rolling]
    assert isinstance(track, Straight)
    left, (x, y) = numbers.gearing.radius[rolling], track.direction
    # the left normal of the direction (x, y) is (-y, x)
    return add(track.through, (-left * y, left * x)), track.direction


def rolloff_line(
    locus: Rolloff, turn: Number, numbers: Dimensions, at: Positions, rotor: Vector | None
) -> PointAndDirection:
    """Line square to the track where a wheel turned by `turn` [rad] puts its centre; or the carriage's origin."""
    rolling = locus.rolling.rolling
    slide = (numbers.gearing.phase[rolling] - turn) * numbers.gearing.radius[rolling]
    track = numbers.gearing.track[rolling]
    assert isinstance(track, Straight)
    foot, (x, y) = along(track.through, track.direction, slide), track.direction
    if locus.carried and rotor is not None:
        return subtract(at.points[locus.point], rotate_vector(foot, rotor)), rotate_vector((-y, x), rotor)
    pose = at.poses[locus.rolling.on]
    return place(pose, foot), rotate_vector((-y, x), pose.rotor)


def solve_train(group: Train, m: Namespace, numbers: Dimensions, at: Positions, continued: Continued) -> None:
    """Add angles, poses and points of a train."""
    rows = [equation_at(equation, m, numbers, at, continued) for equation in group.equations]
    at.angles.update(solved_angles(group, rows, at))
    place_train(group, m, numbers, at)


def place_train(group: Train, m: Namespace, numbers: Dimensions, at: Positions) -> None:
    """Add poses and points of a train whose angles are known."""
    for link, pivot in group.places:
        local = numbers.local[link]
        at.poses[link] = pose_at(link, pivot, rotor_of(m, at.angles[link]), m, numbers, at)
        for point, bringing in group.brought:
            if bringing == link:
                at.points[point] = numbers.space.place(m, at.poses[link], local[point])


def pose_at(
    link: str, pivot: str, rotor: Vector, m: Namespace, numbers: Dimensions, at: Positions
) -> AnyPose:
    """Pose of a link about a known point whose angle has a rotor: in the plane the angle of its own axes."""
    inside, place_of_pivot, reference = numbers.local[link][pivot], at.points[pivot], numbers.reference(link)
    if reference is None:
        return pose_with_point(inside, place_of_pivot, rotor)
    base = at.poses[numbers.gearing.measured.get(link, FRAME)]
    return numbers.space.turned_pose(m, base, rotor, inside, place_of_pivot, reference)


def solved_angles(
    group: Train, rows: list[tuple[Mapping[str, Number], Number]], at: Positions
) -> dict[str, Number]:
    """Angles of a train's links from its equations: factors by link, and right sides."""
    # a table without zeros: trains are sparse, and literal zeros would become jets
    unknown = group.links
    table = [{link: row[link] for link in unknown if link in row} for row, _right in rows]
    right: list[Number] = []
    for row, value in rows:
        for link, factor in row.items():
            if link not in unknown:
                value = value - factor * at.angles[link]
        right.append(value)
    # elimination in the order of pivots that structure chose: it does not depend on numbers, so every algebra
    # takes the same way
    for k, (i, link) in enumerate(group.pivots):
        for j, _column in group.pivots[k + 1 :]:
            if link in table[j]:
                share = table[j].pop(link) / table[i][link]
                for other, factor in table[i].items():
                    if other != link:
                        table[j][other] = table[j].get(other, 0.0) - share * factor
                right[j] = right[j] - share * right[i]
    angles: dict[str, Number] = {}
    # back substitution, last pivot first
    for i, link in reversed(group.pivots):
        value = right[i]
        for other, factor in table[i].items():
            if other in angles:
                value = value - factor * angles[other]
        angles[link] = value / table[i][link]
    return angles


def equation_at(
    equation: AngleEquation, m: Namespace, numbers: Dimensions, at: Positions, continued: Continued
) -> tuple[Mapping[str, Number], Number]:
    """Factors of the angles in an equation by link, and its right side."""
    gearing = numbers.gearing
    match equation:
        case GearRatio():
            return equation.weights(numbers), gearing.phase[equation.gear]
        case NoSlip():
            return {equation.link: 1.0, equation.on: -1.0}, rolled_turn(equation, m, numbers, at, continued)
        case Arm(rolling=rolling):
            spin = gearing.spin(rolling.rolling)
            right = gearing.phase[rolling.rolling] + spin * arm_angle(equation, m, numbers)
            # the arm follows the wheel's centre: its angle less its direction in its own axes is the bearing of
            # the centre
            return {rolling.link: 1.0, rolling.on: spin - 1.0, equation.link: -spin}, right
        case AngleGiven():
            given = _given_angle(equation, m, numbers, at)
            if (
                numbers.reference(equation.link) is not None
            ):  # on the sphere the angle is that between the two
                return {equation.link: 1.0}, given
            return {equation.link: 1.0, equation.relative_to: -1.0}, given
        case _:
            assert_never(equation)


def arm_angle(arm: Arm, m: Namespace, numbers: Dimensions) -> Number:
    """Direction [rad] from the circle's centre to the wheel's in the axes of the arm."""
    local = numbers.local[arm.link]
    x, y = subtract(local[arm.rolling.centre], local[arm.pivot])
    return m.atan2(y, x)


def _given_angle(equation: AngleGiven, m: Namespace, numbers: Dimensions, at: Positions) -> Number:
    if equation.drive is not None:
        return at.drives[equation.drive]
    rotor = numbers.turn[equation.guide or ""]
    return m.atan2(rotor[1], rotor[0])


# Rotors and angles of links that a drive, a guide, a gear or rolling turns, over any algebra.


def difference_of(turning: Turning, m: Namespace, numbers: Dimensions, at: Positions) -> Vector:
    """Rotor from the body that a turning is relative to, to its link."""
    if turning.drive is not None:
        return rotor_of(m, at.drives[turning.drive])
    return numbers.turn[turning.guide or ""]


def turn_link(
    turning: Turning | Following,
    link: str,
    m: Namespace,
    numbers: Dimensions,
    at: Positions,
    continued: Continued,
) -> Vector:
    """Rotor of a link whose angle follows, in the plane; the angle is added where it is known with its turns."""
    if isinstance(turning, Turning):
        add_angle(turning, link, numbers, at)
        return turning_rotor(turning, link, m, numbers, at)
    rotor, angle = follow_contact(turning, link, m, numbers, at, continued)
    if angle is not None:
        at.angles[link] = angle
    return rotor


def add_angle(turning: Turning, link: str, numbers: Dimensions, at: Positions) -> None:
    """Add the angle of a driven link with its turns, if that of the other link is known."""
    if turning.drive is not None and numbers.reference(turning.link) is not None:
        # on the sphere the angle is that between the two links itself, and tells nothing of the other one's
        if link == turning.link:
            at.angles[link] = at.drives[turning.drive]
        return
    other = turning.relative_to if link == turning.link else turning.link
    if turning.drive is not None and other in at.angles:
        value = at.drives[turning.drive]
        at.angles[link] = value + at.angles[other] if link == turning.link else at.angles[other] - value


def turning_rotor(turning: Turning, link: str, m: Namespace, numbers: Dimensions, at: Positions) -> Vector:
    """Rotor of a link whose angle a drive or a guide gives against a body that is known, in the plane."""
    difference = difference_of(turning, m, numbers, at)
    if link == turning.link:
        return rotate_vector(at.poses[turning.relative_to].rotor, difference)
    return rotate_vector(at.poses[turning.link].rotor, reversed_rotor(difference))


class Choices(Protocol):
    """Choices between the several solutions of a formula."""

    def root(self, radicand: Number) -> Number:
        """The signed root of a radicand: the sign is the branch."""

    def divisor(self, divisor: Number) -> Number:
        """A number that is divided by, as it is: its zero is a place the group cannot pass."""

    def take_meeting(self, one: Any, other: Any, place: Any) -> None:
        """Hook that is called with two loci and the place where they meet."""

    def continue_angle(self, key: str, angle: Number) -> Number:
        """An angle in (-pi, pi] with the turns that its path has made; `key` names it."""

    def higher(self, m: Namespace, at: Positions) -> None:
        """Add what the group gives, if it is of higher class."""


def solve_group(group: Group, m: Namespace, numbers: Dimensions, at: Positions, choices: Choices) -> None:
    """Add the places of a group's points and links to the positions."""
    match group:
        case RigidPoint():
            local = numbers.local[group.link][group.point]
            at.points[group.point] = numbers.space.place(m, at.poses[group.link], local)
        case TwoPointLink():
            _two_points(group.link, group.first, group.second, m, numbers, at)
        case TurnedLink():
            at.poses[group.link] = _turned_link(group, m, numbers, at, choices)
        case Aim():
            _aim(group, m, numbers, at, choices.root)
        case Meet():
            _meet(group, m, numbers, at, choices)
        case Train():
            solve_train(group, m, numbers, at, choices.continue_angle)
        case Newton():
            choices.higher(m, at)
        case _:
            assert_never(group)


def _turned_link(
    group: TurnedLink, m: Namespace, numbers: Dimensions, at: Positions, choices: Choices
) -> AnyPose:
    turning = group.turning
    if not isinstance(turning, Turning):
        rotor = turn_link(turning, group.link, m, numbers, at, choices.continue_angle)
        return pose_at(group.link, group.pivot, rotor, m, numbers, at)
    add_angle(turning, group.link, numbers, at)
    rotor, reference = difference_of(turning, m, numbers, at), numbers.reference(turning.link)
    base = turning.relative_to
    if group.link != turning.link:  # it is the base that is unknown
        rotor, base = reversed_rotor(rotor), turning.link
        # the arcs that measure the angle change places with the links
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
    return add(through, rotate_vector(shift, numbers.turn[group.guide])), direction


def _aim(group: Aim, m: Namespace, numbers: Dimensions, at: Positions, root: Root) -> None:
    pivot, target = at.points[group.pivot], at.points[group.target]
    local, curve = numbers.local[group.link][group.pivot], aim_curve(group, numbers)
    pose = numbers.space.aim(m, local, pivot, curve, target, root)
    if _gathers_errors(m) and isinstance(pose, PlanePose):
        cosine, sine = m.without_bounds(pose.rotor)
        rotor = m.gather_errors(pose.rotor, ((cosine, sine), (-sine, cosine)), group)
        pose = pose_with_point(local, pivot, (rotor[0], rotor[1]))
    at.poses[group.link] = pose
    if group.block is not None and group.sliding is not None:
        rotor = rotate_vector(pose.rotor, numbers.turn[group.guide])
        block = pose_with_point(numbers.local[group.block][group.target], at.points[group.target], rotor)
        at.poses[group.block] = block
        at.points[group.sliding] = place(block, numbers.local[group.block][group.sliding])


def _carriage_rotor(
    group: Meet, m: Namespace, numbers: Dimensions, at: Positions, choices: Choices
) -> Vector | None:
    if group.carriage is None or group.turning is None:
        return None
    rotor = turn_link(group.turning, group.carriage, m, numbers, at, choices.continue_angle)
    rolls = [locus.rolling for locus in group.loci if isinstance(locus, Rolloff)]
    if group.carriage not in at.angles and any(group.carriage in (r.link, r.on) for r in rolls):
        at.angles[group.carriage] = choices.continue_angle(group.carriage, m.atan2(rotor[1], rotor[0]))
    return rotor


def _arms(group: Meet, numbers: Dimensions, rotor: Vector | None) -> dict[str, Vector]:
    """Vectors from the group's unknown vector to each of its points."""
    if group.carriage is None or rotor is None:
        return {point: (0.0, 0.0) for point in group.points}
    local = numbers.local[group.carriage]
    return {point: rotate_vector(local[point], rotor) for point in group.points}


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
    if _gathers_errors(m):
        vector = _gather_errors(group, m, numbers, (one, other), vector)
    choices.take_meeting(one, other, vector)
    if group.carriage is not None and rotor is not None:
        at.poses[group.carriage] = PlanePose(vector, rotor)
    for point in group.points:
        # of a group without a carriage the unknown vector is the point itself
        at.points[point] = vector if rotor is None else add(vector, arms[point])
    for rod in group.rods:
        _two_points(rod.link, rod.centre, rod.point, m, numbers, at)


def _gathers_errors(m: Namespace) -> bool:
    """Whether numbers of this algebra carry bounds whose directions are kept (`numerics.rounding_bounds`)."""
    return getattr(m, "gathers", False)


def _gather_errors(group: Meet, m: Namespace, numbers: Dimensions, loci: tuple[Any, Any], vector: Any) -> Any:
    """A group's vector with its errors square to one of its loci and along it.

    A point on the circle of a link with a fixed pivot is exact across and carries what the linkage before it has lost
    along the circle. Kept apart, the two pass on from group to group as they are; in a box about them both, each group
    would multiply them.
    """
    # the locus that feels less of what was before
    locus = min(loci, key=lambda each: len(m.sources_of(each)))
    plain = type(locus)(*m.without_bounds(locus))
    directions = numbers.space.directions_at(m.base, plain, m.without_bounds(vector))
    return m.gather_errors(vector, directions, group)


def _locus(
    locus: Locus,
    m: Namespace,
    numbers: Dimensions,
    at: Positions,
    arms: dict[str, Vector],
    rotor: Vector | None,
) -> Any:
    """Locus of the group's unknown vector: that of the point, moved back by the point's arm on the carriage."""
    curve = _of_point(locus, m, numbers, at, rotor)
    # without a carriage the point is unknown itself
    if rotor is None:
        return curve
    # the locus of the point, shifted by its arm, is that of the carriage's origin
    arm = arms.get(locus.point, (0.0, 0.0))
    if isinstance(curve, PlaneCircle):
        return PlaneCircle(subtract(curve.centre, arm), curve.radius)
    return Line(subtract(curve.through, arm), curve.direction)


def _of_point(locus: Locus, m: Namespace, numbers: Dimensions, at: Positions, rotor: Vector | None) -> Any:
    """Locus of a point of the group; of the unknown vector itself, if the carriage has the slot or the track."""
    match locus:
        case Rod(point, centre, link):
            local = numbers.local[link]
            return numbers.space.circle(m, at.points[centre], local[centre], local[point])
        case CylinderCircle(centre=centre, drive=drive):
            return PlaneCircle(at.points[centre], at.drives[drive])
        case Rail(guide=guide, on=on):
            return numbers.space.rail(m, at.poses[on], numbers.curve(guide))
        case Slot(point, guide):
            # the slot lies on the turned carriage: its origin is the point less the slot's place
            assert rotor is not None
            arm = rotate_vector(numbers.through[guide], rotor)
            direction = rotate_vector(numbers.direction[guide], rotor)
            return Line(subtract(at.points[point], arm), direction)
        case GuideStop(guide=guide, on=on, drive=drive):
            return numbers.space.stop(m, at.poses[on], numbers.curve(guide), at.drives[drive])
        case Touch(letter="R"):
            reach = numbers.gearing.reach(locus.contact.rolling)
            return PlaneCircle(touched_circle(locus, numbers, at, rotor), reach)
        case Touch():
            return Line(*touched_line(locus, numbers, at, rotor))
        case Rolloff():
            turn = at.angles[locus.rolling.link] - at.angles[locus.rolling.on]
            return Line(*rolloff_line(locus, turn, numbers, at, rotor))
        case _:
            assert_never(locus)
