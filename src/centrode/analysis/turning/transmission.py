"""Transmission angles of the dyads: how well each passes motion on, from 0 (it locks) to a right angle."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import Any, TypeAlias

import numpy as np

from centrode.algebra.arrays import ARRAYS
from centrode.analysis.turning.tours import Tour
from centrode.analysis.turning.watched import Course, Pair, Watched
from centrode.geometry.plane import cross as plane_cross
from centrode.geometry.plane import dot as plane_dot
from centrode.geometry.plane import place, subtract, turned
from centrode.geometry.sphere import cross, dot, tangent
from centrode.kinematics.dyads import aim_curve
from centrode.kinematics.path import JETS
from centrode.kinematics.plan_evaluation import Kinematics
from centrode.structure.assur import name_of
from centrode.structure.constraints import Positions
from centrode.structure.groups import Aim, Group, Locus, Meet, Rail, Rod, Slot, Stroke

Number: TypeAlias = Any


@dataclass(frozen=True)
class Transmission:
    """Extremes of a dyad's transmission angle over a tour.

    Attributes
    ----------
    group : its name
    kind : "RRR", "RRP", "RPR"
    least, least_at : the least acute angle [rad] (between lines: 0 to pi/2), and the drive's value there
    extremes : (drive's value, angle [rad]) of its minima and maxima; two links: 0 to pi, otherwise acute
    """

    group: str
    kind: str
    least: float
    least_at: float
    extremes: tuple[tuple[float, float], ...]


def watched_dyads(tour: Tour, guides: bool = False) -> list[tuple[Watched, int]]:
    """The transmission angles of a plan's dyads, each with the number of its group; on demand of two guides too."""
    kinematics = tour.continuation.kinematics
    found = []
    for index, group in enumerate(kinematics.structure.groups):
        watched = _watched(kinematics, group)
        if watched is None and guides:
            watched = _watched_guides(kinematics, group)
        if watched is not None:
            found.append((watched, index))
    return found


def _watched(kinematics: Kinematics, group: Group) -> Watched | None:
    """RRR: between the two rods; RRP: between the rod and the normal of the line; RPR: between arm and normal."""
    name = name_of(group)
    sphere = kinematics.numbers.space.name == "sphere"
    if isinstance(group, Aim) and group.contact is None:
        of_aim = _of_aim_on_sphere if sphere else _of_aim
        return Watched(name, "rad", lambda at: of_aim(kinematics, group, at))
    if not isinstance(group, Meet):
        return None
    centres = [locus for locus in group.loci if isinstance(locus, (Rod, Stroke))]
    if len(centres) == 2:
        return Watched(name, "rad", lambda at: _between_rods(sphere, centres, at))
    line = next((locus for locus in group.loci if isinstance(locus, (Rail, Slot))), None)
    if len(centres) == 1 and isinstance(line, Rail) and sphere:
        return Watched(name, "rad", lambda at: _to_pole(kinematics, centres[0], line, at))
    if len(centres) == 1 and line is not None and not sphere:
        return Watched(name, "rad", lambda at: _to_normal(kinematics, centres[0], line, group.carriage, at))
    return None


def _watched_guides(kinematics: Kinematics, group: Group) -> Watched | None:
    """PRP, RPP: between the two guides, on the sphere between the arcs to the poles of both circles."""
    if not isinstance(group, Meet) or len(group.loci) != 2:
        return None
    lines = [locus for locus in group.loci if isinstance(locus, (Rail, Slot))]
    name = name_of(group)
    if len(lines) != 2:
        return None
    if kinematics.numbers.space.name != "sphere":
        return Watched(name, "rad", lambda at: _between_guides(kinematics, lines, group.carriage, at))
    rails = [line for line in lines if isinstance(line, Rail)]
    if len(rails) != 2 or len(group.points) != 1:
        return None
    return Watched(name, "rad", lambda at: _between_poles(kinematics, rails, group.points[0], at))


def _between_guides(
    kinematics: Kinematics, lines: list[Rail | Slot], carriage: str | None, at: Positions
) -> Pair:
    bodies = [line.on if isinstance(line, Rail) else carriage for line in lines]
    one, other = (
        turned(kinematics.numbers.direction[line.guide], at.poses[body or "frame"].rotor)
        for line, body in zip(lines, bodies, strict=True)
    )
    return plane_dot(one, other), plane_cross(one, other)


def _between_poles(kinematics: Kinematics, rails: list[Rail], point: str, at: Positions) -> Pair:
    space, numbers = kinematics.numbers.space, kinematics.numbers
    pin = at.points[point]
    one, other = (
        tangent(pin, space.place(JETS, at.poses[rail.on], numbers.through[rail.guide])) for rail in rails
    )
    return dot(one, other), dot(pin, cross(one, other))


def _between_rods(sphere: bool, rods: list[Any], at: Positions) -> Pair:
    one, other = ((at.points[rod.point], at.points[rod.centre]) for rod in rods)
    if sphere:
        arc, next_arc = (tangent(pin, centre) for pin, centre in (one, other))
        return dot(arc, next_arc), dot(one[0], cross(arc, next_arc))
    line, next_line = (subtract(centre, pin) for pin, centre in (one, other))
    return plane_dot(line, next_line), plane_cross(line, next_line)


def _to_pole(kinematics: Kinematics, rod: Any, line: Rail, at: Positions) -> Pair:
    """Between the rod's arc and the arc to the pole of the guide's circle."""
    space, numbers = kinematics.numbers.space, kinematics.numbers
    pin, centre = at.points[rod.point], at.points[rod.centre]
    pole = space.place(JETS, at.poses[line.on], numbers.through[line.guide])
    arc, to_pole = tangent(pin, centre), tangent(pin, pole)
    return dot(arc, to_pole), dot(pin, cross(arc, to_pole))


def _of_aim_on_sphere(kinematics: Kinematics, group: Aim, at: Positions) -> Pair:
    """In the target, between the arcs to the pivot and to the pole of the guide's circle."""
    space, numbers = kinematics.numbers.space, kinematics.numbers
    target, pivot = at.points[group.target], at.points[group.pivot]
    pole = space.place(JETS, at.poses[group.link], numbers.through[group.guide])
    arc, to_pole = tangent(target, pivot), tangent(target, pole)
    return dot(arc, to_pole), dot(target, cross(arc, to_pole))


def _to_normal(kinematics: Kinematics, rod: Any, line: Locus, carriage: str | None, at: Positions) -> Pair:
    """The rod's share along the line is the sine; that along the normal the cosine."""
    assert isinstance(line, (Rail, Slot))
    body = line.on if isinstance(line, Rail) else carriage
    rotor = at.poses[body or "frame"].rotor
    direction = turned(kinematics.numbers.direction[line.guide], rotor)
    arm = subtract(at.points[rod.point], at.points[rod.centre])
    return plane_cross(direction, arm), plane_dot(direction, arm)


def _of_aim(kinematics: Kinematics, group: Aim, at: Positions) -> Pair:
    """The target's way along the line from the pivot's foot is the sine, the pivot's distance from it the cosine."""
    _through, direction = aim_curve(group, kinematics.numbers)
    pose = at.poses[group.link]
    pivot = place(pose, kinematics.numbers.local[group.link][group.pivot])
    along = turned(direction, pose.rotor)
    arm = subtract(at.points[group.target], pivot)
    return plane_cross(along, arm), plane_dot(along, arm)


def transmissions_of(course: Course, groups: list[int], first: int = 0) -> list[Transmission]:
    """Extremes of the watched transmission angles, from number `first` on."""
    found = []
    for k, index in enumerate(groups, first):
        group = course.tour.prepared.structure.groups[index]
        fold = _between if group.kind == "RRR" else _acute  # two links have a sense each, a line has none
        extremes = [(float(at), fold(float(value))) for at, value in zip(*course.turned[k], strict=True)]
        least, at = least_of(course, k, index, extremes)
        found.append(Transmission(course.watched[k].name, group.kind, least, at, tuple(extremes)))
    return found


def _between(value: float) -> float:
    """An angle between two directions, in [0, pi]."""
    folded = abs(value) % (2.0 * pi)
    return min(folded, 2.0 * pi - folded)


def _acute(value: float) -> float:
    """An angle between two lines, in [0, pi/2]."""
    between = _between(value)
    return min(between, pi - between)


def least_of(course: Course, k: int, index: int, extremes: list[tuple[float, float]]) -> tuple[float, float]:
    """The least acute angle; zero at the group's own limits and change points."""
    tour = course.tour
    if not isinstance(tour.prepared.structure.groups[index], Aim):
        for event in tour.events("limit") + tour.events("change point"):
            if event.group == index and (event.kind == "change point" or event.at in (tour.low, tour.high)):
                return 0.0, event.at
    acute = [(min(value, pi - value), at) for at, value in extremes]
    if not acute or not tour.comes_round:
        acute += transmission_at_ends(course, k)
    if not acute:
        sines = np.abs(np.sin(course.values[k]))
        node = int(np.nanargmin(sines))
        acute.append((float(np.arcsin(sines[node])), float(course.nodes[node])))
    return min(acute)


def transmission_at_ends(course: Course, k: int) -> list[tuple[float, float]]:
    """The acute angle at the ends of the stretch: the drive's limits, or the initial position."""
    found = []
    for at in (end for end in course.tour.span if np.isfinite(end)):
        value = float(course.watched[k].value(course.tour.stopped(at, ARRAYS), 1)[0])
        if np.isfinite(value):
            between = _between(value)
            found.append((min(between, pi - between), at))
    return found
