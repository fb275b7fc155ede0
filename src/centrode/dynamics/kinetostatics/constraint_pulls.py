"""What each constraint does to points and links: its row of the Jacobian as forces and moments of one unit."""

from __future__ import annotations

from typing import Any, TypeAlias

from centrode.dynamics.coordinates import place_of
from centrode.dynamics.kinetostatics.teeth import Teeth
from centrode.dynamics.pulls import Pull, on_link, on_point
from centrode.dynamics.states import State
from centrode.model.mechanism import Mechanism
from centrode.structure.constraints import Constraint, DisplacementDrive, PointOnGuide
from centrode.structure.dimensions import Dimensions
from centrode.structure.positions import FRAME, Positions, Row
from centrode.structure.wheels import Contact, GearRatio, NoSlip

Number: TypeAlias = Any


def positions_of(state: State, numbers: Dimensions) -> Positions:
    """Plain positions of a planar state, to evaluate constraints on."""
    mechanism, space = state.mechanism, numbers.space
    points = {name: place_of(state.point(name)) for name in mechanism.points}
    poses = {FRAME: space.at_rest}
    for link, inside in numbers.local.items():
        point, local = next(iter(inside.items()))
        poses[link] = space.pose_of(state.m.base, place_of(state.rotor(link)), local, points[point])
    return Positions(dict(points), poses, {})


def pulls_of(
    constraint: Constraint, mechanism: Mechanism, numbers: Dimensions, at: Positions, teeth: Teeth
) -> list[tuple[Pull, ...]]:
    """Forces and moments of each row of a constraint, at a multiplier of one.

    Rows act on points; where a guide has a slider of its own, and under a rolling wheel, the force is put on the
    slider or the wheel itself: the pin's share of it would be a mere name.
    """
    if isinstance(constraint, GearRatio) and constraint.gear in teeth.axes:
        return [teeth.pulls(constraint, at, numbers)]
    link = _bearer(constraint, mechanism)
    return [_of_row(row, at, link) for row in constraint.rows(numbers, at)]


def _of_row(row: Row, at: Positions, link: str | None) -> tuple[Pull, ...]:
    found = []
    for entity, values in row.items():
        if entity.kind == "link":
            x, y, moment = values
            found.append(Pull(entity, (x, y), at.poses[entity.name].origin, moment))
            continue
        x, y = values
        place = at.points[entity.name]
        found.append(on_point(entity.name, (x, y), place) if link is None else on_link(link, (x, y), place))
    return tuple(found)


def _bearer(constraint: Constraint, mechanism: Mechanism) -> str | None:
    """The link that takes what a constraint's row gives to a point; None where it is the pin itself."""
    if isinstance(constraint, (PointOnGuide, DisplacementDrive)):
        return mechanism.guide(constraint.guide).link
    return constraint.link if isinstance(constraint, (Contact, NoSlip)) else None
