"""Closed forms of gears and rolling wheels, over any algebra: angles that follow, loci, trains.

Angles run on over turns, so that ratios that are no whole numbers keep their meaning.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, TypeAlias

from centrode.geometry.plane import (
    Vector,
    add,
    along,
    place,
    pose_with_point,
    rotor_of,
    subtract,
    turned,
)
from centrode.geometry.space import Pose
from centrode.structure.constraints import FRAME, GearRatio, NoSlip, Positions
from centrode.structure.dimensions import Dimensions
from centrode.structure.gearing import Straight
from centrode.structure.groups import AngleEquation, AngleGiven, Arm, Meshed, Rolled, Rolloff, Touch, Train

Number: TypeAlias = Any
Namespace: TypeAlias = Any
Continued: TypeAlias = Callable[[str, Number], Number]
Line: TypeAlias = tuple[Vector, Vector]


def bearing_key(rolling: str) -> str:
    """Name under which the direction of a wheel's centre about its circle is counted over turns."""
    return f"rolling/{rolling}"  # no link has a slash in its name


def meshed_angle(turning: Meshed, link: str, numbers: Dimensions, at: Positions) -> Number:
    """Angle [rad] of one link of a gear from those of the other two."""
    gear = turning.gear
    ratio, phase = numbers.gearing.ratio[gear.gear], numbers.gearing.phase[gear.gear]
    first, second = numbers.gearing.shares.get(gear.gear, (1.0, 1.0))
    if link == gear.carrier:
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
        return phase - rolling.slide(numbers, at) / gearing.radius[rolling.rolling]
    key = bearing_key(rolling.rolling)
    bearing = at.angles[key] = continued(key, rolling.bearing(m, numbers, at))
    return phase + gearing.spin(rolling.rolling) * bearing


def followed(
    turning: Meshed | Rolled,
    link: str,
    m: Namespace,
    numbers: Dimensions,
    at: Positions,
    continued: Continued,
) -> tuple[Vector, Number | None]:
    """Rotor and angle of a link that a gear or a rolling contact turns; no angle where its turns are not known."""
    if isinstance(turning, Meshed):
        angle = meshed_angle(turning, link, numbers, at)
        return rotor_of(m, angle), angle
    on = turning.rolling.on
    turn = rolled_turn(turning.rolling, m, numbers, at, continued)
    rotor = turned(at.poses[on].rotor, rotor_of(m, turn))
    return rotor, at.angles[on] + turn if on in at.angles else None


def touched_circle(locus: Touch, numbers: Dimensions, at: Positions, rotor: Vector | None) -> Vector:
    """Centre of the circle on which a wheel's centre is, or the carriage's origin where the track is carried."""
    centre = numbers.gearing.track[locus.contact.rolling].centre  # type: ignore[union-attr]
    if locus.carried and rotor is not None:
        return subtract(at.points[locus.point], turned(centre, rotor))
    return place(at.poses[locus.contact.on], centre)


def touched_line(locus: Touch, numbers: Dimensions, at: Positions, rotor: Vector | None) -> Line:
    """Line on which a wheel's centre is, a radius to the left of the track; or the carriage's origin."""
    through, direction = beside_track(locus.contact.rolling, numbers)
    if locus.carried and rotor is not None:
        return subtract(at.points[locus.point], turned(through, rotor)), turned(direction, rotor)
    pose = at.poses[locus.contact.on]
    return place(pose, through), turned(direction, pose.rotor)


def beside_track(rolling: str, numbers: Dimensions) -> Line:
    """The parallel of a straight track on which the wheel's centre is, in the axes of the body that carries it."""
    track = numbers.gearing.track[rolling]
    assert isinstance(track, Straight)
    left, (x, y) = numbers.gearing.radius[rolling], track.direction
    return add(track.through, (-left * y, left * x)), track.direction


def rolloff_line(
    locus: Rolloff, turn: Number, numbers: Dimensions, at: Positions, rotor: Vector | None
) -> Line:
    """Line square to the track where a wheel turned by `turn` [rad] puts its centre; or the carriage's origin."""
    rolling = locus.rolling.rolling
    slide = (numbers.gearing.phase[rolling] - turn) * numbers.gearing.radius[rolling]
    track = numbers.gearing.track[rolling]
    assert isinstance(track, Straight)
    foot, (x, y) = along(track.through, track.direction, slide), track.direction
    if locus.carried and rotor is not None:
        return subtract(at.points[locus.point], turned(foot, rotor)), turned((-y, x), rotor)
    pose = at.poses[locus.rolling.on]
    return place(pose, foot), turned((-y, x), pose.rotor)


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


def pose_at(link: str, pivot: str, rotor: Vector, m: Namespace, numbers: Dimensions, at: Positions) -> Pose:
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
    unknown = group.links
    table = [{link: row[link] for link in unknown if link in row} for row, _right in rows]
    right: list[Number] = []
    for row, value in rows:
        for link, factor in row.items():
            if link not in unknown:
                value = value - factor * at.angles[link]
        right.append(value)
    for k, (i, link) in enumerate(group.pivots):
        for j, _column in group.pivots[k + 1 :]:
            if link in table[j]:
                share = table[j].pop(link) / table[i][link]
                for other, factor in table[i].items():
                    if other != link:
                        table[j][other] = table[j].get(other, 0.0) - share * factor
                right[j] = right[j] - share * right[i]
    angles: dict[str, Number] = {}
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
    if isinstance(equation, GearRatio):
        return equation.weights(numbers), gearing.phase[equation.gear]
    if isinstance(equation, NoSlip):
        return {equation.link: 1.0, equation.on: -1.0}, rolled_turn(equation, m, numbers, at, continued)
    if isinstance(equation, Arm):
        rolling = equation.rolling
        spin = gearing.spin(rolling.rolling)
        right = gearing.phase[rolling.rolling] + spin * arm_angle(equation, m, numbers)
        return {rolling.link: 1.0, rolling.on: spin - 1.0, equation.link: -spin}, right
    given = _given(equation, m, numbers, at)
    if numbers.reference(equation.link) is not None:  # on the sphere the angle is that between the two
        return {equation.link: 1.0}, given
    return {equation.link: 1.0, equation.relative_to: -1.0}, given


def arm_angle(arm: Arm, m: Namespace, numbers: Dimensions) -> Number:
    """Direction [rad] from the circle's centre to the wheel's in the axes of the arm."""
    local = numbers.local[arm.link]
    x, y = subtract(local[arm.rolling.centre], local[arm.pivot])
    return m.atan2(y, x)


def _given(equation: AngleGiven, m: Namespace, numbers: Dimensions, at: Positions) -> Number:
    if equation.drive is not None:
        return at.drives[equation.drive]
    rotor = numbers.turn[equation.guide or ""]
    return m.atan2(rotor[1], rotor[0])
