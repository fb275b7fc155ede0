"""From a spherical mechanism to its unknowns and constraints in symbols: the closures of its dyads in arcs.

The new point R of a dyad is carried on a circle about S by an arc or by a guide, and held by an arc from O. The first
closure is cos OR by the places of both, the second the law of cosines in the triangle S, R, O.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from centrode.equations.draft import Condition, Draft
from centrode.equations.letters import Angle
from centrode.equations.sphere_board import SphereBoard, Vector, unwritten
from centrode.equations.sums import Sum
from centrode.equations.turned import Axes
from centrode.kinematics.prepared import Ready
from centrode.locale import _
from centrode.structure.constraints import FRAME
from centrode.structure.groups import (
    Group,
    Meet,
    Rail,
    RigidPoint,
    Rod,
    TurnedLink,
    Turning,
    TwoPointLink,
)


@dataclass(frozen=True)
class Carrier:
    """What carries the new point on a circle: `axes` in its centre along the arc to `towards`, and the circle's arc."""

    centre: str
    axes: Axes
    towards: Vector
    end: str
    at: Vector
    arc: Angle
    link: str | None
    guide: str | None


def laid_on_sphere(ready: Ready) -> tuple[SphereBoard, tuple[Draft, ...]]:
    """All closures of a spherical mechanism, and the groups that have unknowns.

    Raises InputError for other groups than driven links and dyads of arcs and circles.
    """
    board = SphereBoard(ready, _pivots(ready))
    groups: list[Draft] = []
    for number, group in enumerate(ready.structure.groups):
        groups += _laid(board, group, number)
    return board, tuple(groups)


def _pivots(ready: Ready) -> list[str]:
    """Fixed points about which something turns, in the order of the plan."""
    found: list[str] = []
    for group in ready.structure.groups:
        if isinstance(group, TurnedLink):
            found.append(group.pivot)
        if isinstance(group, Meet):
            found += [rod.centre for rod in group.rods]
            guides = [locus.guide for locus in group.loci if isinstance(locus, Rail)]
            found += [
                one.pole for one in ready.mechanism.guides if one.id in guides and isinstance(one.pole, str)
            ]
    fixed = [name for name in dict.fromkeys(found) if name in ready.kinematics.numbers.frame]
    return fixed or list(ready.kinematics.numbers.frame)[:1]


def _laid(board: SphereBoard, group: Group, number: int) -> list[Draft]:
    if isinstance(group, TurnedLink) and isinstance(group.turning, Turning) and group.turning.drive:
        _drive(board, group.link, group.turning)
        return []
    if isinstance(group, RigidPoint) or (isinstance(group, TwoPointLink) and group.link in board.axes):
        return []
    if isinstance(group, Meet) and len(group.points) == 1 and len(group.rods) >= 1:
        return _dyad(board, group, number)
    raise unwritten()


def _drive(board: SphereBoard, link: str, turning: Turning) -> None:
    """Place a link that a drive turns against a body that is placed."""
    drive, base = turning.drive or "", turning.relative_to
    if link != turning.link or base not in board.axes:
        raise unwritten()
    pivot, second = list(board.inside[link])[:2]
    end = board.numbers.ends[link][0]
    axes, end = board.towards(base, pivot, end)
    turn = board.turn(link, (pivot, end, board.drive_value(drive)), Draft(), drive)
    board.place(link, pivot, second, axes.turned(turn))


def _dyad(board: SphereBoard, group: Meet, number: int) -> list[Draft]:
    """Both closures of a dyad, each with its unknown."""
    carrier, rod = _carrier(board, group)
    point = group.points[0]
    draft = Draft(list({rod.link, carrier.link or rod.link}), [point], [number])
    held = board.arc(rod.link, rod.centre, point)
    value = _angle(carrier.at, carrier.towards, board.at(point))
    if carrier.link is not None:
        value = _started(board, carrier.link, value)
        turn = board.turn(carrier.link, (carrier.centre, carrier.end, value), draft, None)
    else:
        turn = board.bearing(carrier.guide or "", (carrier.centre, carrier.end, value), draft)
    out = carrier.axes.turned(turn)
    there = out.moved(carrier.arc)
    if carrier.link is not None:
        board.place(carrier.link, carrier.centre, point, out)
    board.points[point] = there.at
    board.moving.append(point)
    far = board.points[rod.centre]
    left = Sum.wave("cos", held)
    draft.conditions.append(Condition(f"cos {rod.centre}{point}", left, left, far.dot(there.at)))
    leaning, angle, side = _leaning(board, carrier, rod, point, held)
    board.place(rod.link, point, rod.centre, there.leaning(angle, side))
    return [draft, leaning]


def _leaning(
    board: SphereBoard, carrier: Carrier, rod: Rod, point: str, held: Angle
) -> tuple[Draft, Angle, int]:
    """The angle of the holding link to the path of the point, by the law of cosines; and the side it is on."""
    corner = _angle(board.at(point), carrier.at, board.at(rod.centre))
    side = -1 if corner > 0 else 1
    draft = Draft([rod.link], [], [], label=_("{link} in {point}").format(link=rod.link, point=point))
    angle = board.lean(rod.link, point, carrier.centre, math.pi / 2 - abs(corner), draft)
    left = Sum.wave("sin", held) * Sum.wave("sin", carrier.arc) * Sum.wave("sin", angle)
    left += Sum.wave("cos", held) * Sum.wave("cos", carrier.arc)
    right = carrier.axes.at.dot(board.points[rod.centre])
    draft.conditions.append(Condition(f"cos {carrier.centre}{rod.centre}", left, left, right))
    return draft, angle, side


def _carrier(board: SphereBoard, group: Meet) -> tuple[Carrier, Rod]:
    """Which side of a dyad carries the point: a guide, or the link whose other end is fixed."""
    first, second = group.loci
    for one, other in ((first, second), (second, first)):
        if isinstance(one, Rail) and isinstance(other, Rod):
            return _circle(board, one), other
    if not (isinstance(first, Rod) and isinstance(second, Rod)):
        raise unwritten()
    fixed = [rod.centre in board.inside[FRAME] for rod in (first, second)]
    swinging, other = (first, second) if fixed[0] and not fixed[1] else (second, first)
    base = board.body_of(swinging.centre)
    link = board.mechanism.links[swinging.link]
    named = link.reference[1] if link.reference and link.reference[0] == swinging.centre else None
    axes, end = board.towards(base, swinging.centre, named if named in board.inside[base] else None)
    point = group.points[0]
    arc = board.arc(swinging.link, swinging.centre, point)
    at, towards = board.at(swinging.centre), board.carried(base, board.inside[base][end])
    return Carrier(swinging.centre, axes, towards, end, at, arc, swinging.link, None), other


def _circle(board: SphereBoard, rail: Rail) -> Carrier:
    """The circle of a guide about a point of a body that is placed."""
    if rail.on not in board.axes:
        raise unwritten()
    name, radius = board.poles[rail.guide], board.numbers.direction[rail.guide][0]
    axes, end = board.towards(rail.on, name, None)
    direction = (math.cos(float(radius)), math.sin(float(radius)))
    arc = board.constant(f"r_{rail.guide}", "arc of circle", (rail.guide,), direction)
    at, towards = (board.carried(rail.on, board.inside[rail.on][one]) for one in (name, end))
    return Carrier(name, axes, towards, end, at, arc, None, rail.guide)


def _angle(pivot: Vector, start: Vector, end: Vector) -> float:
    """Angle in a place from one arc to another, counter-clockwise seen from outside."""
    first, second = np.cross(pivot, start), np.cross(pivot, end)
    return float(np.arctan2(pivot @ np.cross(first, second), first @ second))


def _started(board: SphereBoard, link: str, value: float) -> float:
    """The angle with the turns that the motion gives it."""
    known = board.ready.assembled.angles.get(link)
    if known is None:
        return value
    return value + math.tau * round((float(known) - value) / math.tau)
