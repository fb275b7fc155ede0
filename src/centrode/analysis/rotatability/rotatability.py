"""Whether a mechanism turns fully: limits with their causes, extreme positions, dead points, transmission angles.

Everything follows from the geometry: limits and change points are the zeros of the groups' radicands, extreme
positions the zeros of rates, both found as roots and not among samples.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np

from centrode.analysis.rotatability.causes import (
    Cause,
    CauseKind,
    Condition,
    Tracer,
    Transmission,
    cause_of,
    transmissions_of,
    watched_dyads,
)
from centrode.analysis.rotatability.circuits import (
    Circuits,
    FourBar,
    Uncounted,
    circuits_of,
    four_bars_of,
)
from centrode.analysis.rotatability.tours import (
    DriveSweep,
    LinkStroke,
    monitored_function,
    strokes_of,
    tour_of,
    watched_members,
)
from centrode.kinematics.plan_evaluation import RadicandZero
from centrode.kinematics.preparation import Ready, ready
from centrode.kinematics.several_inputs.limits import initial_values
from centrode.locale import _
from centrode.model.examples.catalogue import MechanismSource, mechanism_of
from centrode.model.mechanism import Mechanism
from centrode.printed_results import PrintsSummary
from centrode.structure.assur import name_of


@dataclass(frozen=True)
class LimitFound:
    """Where the drive is stopped, which group stops it, and why.

    Attributes
    ----------
    value : of the drive [rad or m], equal to that of `limits` and of the motion's events
    drive : its name
    end : "low" or "high": the side of the initial position on which it lies
    group : name of the group
    links : its links
    cause : what happens to the group there
    condition : what holds there, in the angles phi of the links by their numbers in the description
    """

    value: float
    drive: str
    end: Literal["low", "high"]
    group: str
    links: tuple[str, ...]
    cause: Cause
    condition: Condition


@dataclass(frozen=True)
class ChangePoint:
    """Where both assemblies of a group meet and the mechanism can go on in either."""

    value: float
    drive: str
    group: str
    cause: Cause
    condition: Condition


@dataclass(frozen=True)
class DeadPoint:
    """Where a member, were it the drive, could not move the present drive: its own rate is zero there.

    Attributes
    ----------
    driver : link or guide
    value : its own value there [rad or m]
    at : value of the present drive [rad or m]
    in_line : pairs of links that fall in line
    """

    driver: str
    value: float
    at: float
    in_line: tuple[tuple[str, str], ...]


@dataclass(frozen=True)
class LinkTurning:
    """Turning of the members for one drive, the others held at their initial values.

    Attributes
    ----------
    drive, unit : its name; "rad" or "m"
    held : values of the others
    turns_fully : None for a displacement, which cannot turn
    period : turns of the drive after which the mechanism is back; None where it does not turn fully or is not
        back after two turns
    limits, change_points : those that bound the motion; those on the stretch that is looked at
    swings : of every link and slider
    dead_points : of every member as the drive
    transmissions : of every dyad whose transmission angle is defined
    circuits : None where they are not counted, for the reason in `circuits_missing`
    """

    drive: str
    unit: str
    held: Mapping[str, float]
    initial: float
    turns_fully: bool | None
    period: int | None
    limits: tuple[LimitFound, ...]
    change_points: tuple[ChangePoint, ...]
    swings: tuple[LinkStroke, ...]
    dead_points: tuple[DeadPoint, ...]
    transmissions: tuple[Transmission, ...]
    circuits: Circuits | None
    circuits_missing: Uncounted | None


@dataclass(frozen=True, repr=False)
class Rotatability(PrintsSummary):
    """Rotatability of a mechanism by its geometry.

    Attributes
    ----------
    mechanism : Mechanism
    turns_fully : whether the one drive turns fully; None with several drives, and for displacements
    limits : of all drives
    drives : LinkTurning of each drive, the others held
    four_bars : every four-bar and slider-crank loop with its type
    """

    mechanism: Mechanism
    turns_fully: bool | None
    limits: tuple[LimitFound, ...]
    drives: tuple[LinkTurning, ...]
    four_bars: tuple[FourBar, ...]

    @property
    def one(self) -> LinkTurning:
        """Results of the first drive, the only one as a rule."""
        return self.drives[0]


def rotatability(mechanism: MechanismSource) -> Rotatability:
    """Whether a mechanism turns fully, what stops it and why, and how its members move.

    Returns
    -------
    Rotatability
        Angles in rad, lengths in m. Limits and change points are exact to rounding, extreme positions to half
        the digits of the drive's value and all digits of their own. Limits are sought within two turns (four
        times the greatest length) on both sides.

    Raises
    ------
    InputError
        As `motion` does.

    Notes
    -----
    With several drives each is moved with the others held at their initial values.

    Examples
    --------
    >>> import centrode as ct
    >>> ct.rotatability(ct.example("crank-rocker")).turns_fully
    True
    """
    mechanism = mechanism_of(mechanism)
    prepared = ready(mechanism)
    values = initial_values(prepared)
    turnings = []
    for drive in mechanism.drives:
        held = {name: value for name, value in values.items() if name != drive.id}
        with np.errstate(all="ignore"):  # places may go to infinity at a limit
            turnings.append(_link_turning(prepared, tour_of(prepared, drive.id, held)))
    alone = len(turnings) == 1
    return Rotatability(
        mechanism,
        turnings[0].turns_fully if alone else None,
        tuple(limit for turning in turnings for limit in turning.limits),
        tuple(turnings),
        four_bars_of(prepared),
    )


def _link_turning(prepared: Ready, tour: DriveSweep) -> LinkTurning:
    members, dyads = watched_members(tour), watched_dyads(tour)
    # members and dyads in one course: each evaluation of the motion serves them all
    course = monitored_function(
        tour, [*(watched for watched, _kind in members), *(watched for watched, _group in dyads)]
    )
    swings = strokes_of(course, [kind for _one, kind in members])
    circuits, missing = circuits_of(tour)
    return LinkTurning(
        tour.drive.id,
        tour.unit,
        tour.held,
        tour.initial,
        tour.turns_fully if tour.angular else None,
        # turns are counted also where places are missing on the way, which is no period
        tour.turns if tour.comes_round else None,
        _limits(prepared, tour),
        _change_points(prepared, tour),
        tuple(swings),
        tuple(_dead_points(swings)),
        tuple(transmissions_of(course, [group for _one, group in dyads], len(members))),
        circuits,
        missing,
    )


def _limits(prepared: Ready, tour: DriveSweep) -> tuple[LimitFound, ...]:
    events = [event for event in tour.continuation.branches.events if event.kind == "limit"]
    limits = [
        _limit(prepared, tour, event, end)
        for end, value in (("low", tour.low), ("high", tour.high))
        for event in events
        if event.at == value
    ]
    # the formulas close for a negative length as well, so this limit is no event
    name, coordinate = tour.drive.id, prepared.parameter.drive(tour.drive.id)
    least = float(coordinate.value_of(0.0))
    end: Literal["low", "high"] = "low" if coordinate.sense > 0.0 else "high"
    reached = (tour.low if end == "low" else tour.high) == least
    if tour.drive.kind == "distance" and reached and not any(limit.value == least for limit in limits):
        group, cause = (
            _("cylinder {name} of no length").format(name=name),
            Cause(CauseKind.NO_LENGTH, ((Tracer.CYLINDER, name),)),
        )
        found = LimitFound(least, name, end, group, (), cause, f"{name} = 0")
        limits.insert(0 if end == "low" else len(limits), found)
    return tuple(limits)


def _limit(prepared: Ready, tour: DriveSweep, event: RadicandZero, end: str) -> LimitFound:
    group = prepared.structure.groups[event.group]
    side: Literal["low", "high"] = "low" if end == "low" else "high"
    return LimitFound(
        event.at,
        tour.drive.id,
        side,
        name_of(group),
        group.links,
        *cause_of(tour, group, event.group, event.at),
    )


def _change_points(prepared: Ready, tour: DriveSweep) -> tuple[ChangePoint, ...]:
    points: dict[ChangePoint, None] = {}  # several pairs of positions of a group may meet at one place
    for event in tour.events("change point"):
        if tour.low <= event.at <= tour.high:
            group = prepared.structure.groups[event.group]
            why = cause_of(tour, group, event.group, event.at, crossing=True)
            points[ChangePoint(event.at, tour.drive.id, name_of(group), *why)] = None
    return tuple(points)


def _dead_points(swings: list[LinkStroke]) -> list[DeadPoint]:
    return [
        DeadPoint(swing.name, extreme.value, extreme.at, extreme.in_line)
        for swing in swings
        for extreme in swing.extremes
        # at the drive's limit the member only stops with it: its rate has no zero
        if not extreme.at_limit
    ]
