"""Force polygons of a mechanism at an instant: the whole way from a description to drawn forces."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr

from centrode.analysis.graphic.board import Board
from centrode.analysis.graphic.instant import drawing_of
from centrode.analysis.graphic.stage import Drawing
from centrode.dynamics.burden import Burden
from centrode.dynamics.force_polygons.actions import Action, Rates, outer_actions
from centrode.dynamics.force_polygons.bodies import Bodies
from centrode.dynamics.force_polygons.dyads import Found, dyad_of, solve_dyad
from centrode.dynamics.force_polygons.joints import Joint, joints_of
from centrode.dynamics.force_polygons.ledger import Ledger
from centrode.dynamics.force_polygons.lever import Lever, lever_of
from centrode.dynamics.force_polygons.others import solve_single, solve_together
from centrode.dynamics.force_polygons.partition import Cell, cells_of
from centrode.dynamics.force_polygons.polygon import (
    PolygonVector,
    polygon_of,
    room_of,
    vector_of,
)
from centrode.dynamics.force_polygons.result import ForcePolygons, GroupForces
from centrode.dynamics.force_polygons.triads import solve_triad, triad_of
from centrode.dynamics.force_polygons.words import Words
from centrode.dynamics.reducer import Reducer, reduced
from centrode.dynamics.states import Moving, State
from centrode.errors import InputError, MotionError, Status
from centrode.kinematics.dataset import dataset_of
from centrode.kinematics.ready import Ready, ready
from centrode.kinematics.solve import Solved, solve
from centrode.kinematics.spans import span_at
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.quantities import status_word


def force_polygons(mechanism: Mechanism, at: float, paper: str = "A4") -> ForcePolygons:
    """Reactions and balancing moment at an instant by force polygons, group by group, and by Zhukovsky's lever.

    Parameters
    ----------
    at : float [rad or m, or s]
        A value of the drive, or a time, as in `motion(at=...)`.
    paper : "A5", "A4" or "A3"
        The sheet that scales of forces are chosen for.

    Raises
    ------
    InputError
        No masses and no loads, or incomplete ones; a paper that is none; an instant out of range.
    NotComputedYet
        The sphere; friction; constraints that repeat each other, so that reactions are not determined.
    MotionError
        The mechanism does not close there, or stands at a limit, a change point or a dead point.
    """
    room = room_of(paper)
    burden = Burden.in_plane(mechanism)
    prepared = ready(mechanism)
    solved = solve(prepared, span_at(prepared.kinematics.path, np.array([at], dtype=np.float64)))
    exact = dataset_of(solved)
    _refuse_where_it_is_not(exact, at)
    drawing = drawing_of(prepared, exact, Board())
    bodies = Bodies.of(prepared.structure)
    state, rates, machine = _state(solved, burden)
    outer = outer_actions(burden, state, rates, drawing, bodies)
    joints = joints_of(prepared.structure, bodies, drawing)
    ledger = Ledger.of(bodies, joints, outer, float(drawing.numbers.scale))
    cells = cells_of(prepared.structure, bodies, joints)
    groups = tuple(_group(cell, ledger, room) for cell in cells)
    drives = {joint.name: _driving(ledger, joint) for joint in joints if joint.kind == "drive"}
    return ForcePolygons(
        mechanism,
        exact,
        _speeds(exact, prepared, rates),
        "machine" if machine else "drive",
        bodies.names,
        groups,
        _reactions(ledger),
        _moments(ledger),
        drives,
        _by_work(burden, state, rates, prepared),
        _levers(prepared, drawing, bodies, outer),
        tuple(outer),
        {name: complex(*place) for name, place in drawing.at.points.items()},
        paper,
    )


def _refuse_where_it_is_not(exact: xr.Dataset, at: float) -> None:
    status = int(exact["status"][0])
    if status not in (Status.OK, Status.CUT_OFF):
        raise MotionError(
            "at",
            _("at {at:.9g} the mechanism is {status}: there are no forces to draw").format(
                at=at, status=status_word(status)
            ),
            _("choose another instant"),
        )


def _state(solved: Solved, burden: Burden) -> tuple[State, Rates, bool]:
    """The state at the speed that `reduce` takes, its rates by time, and whether the machine gives the speed."""
    span, prepared = solved.span, solved.ready
    by_machine = prepared.mechanism.machine is not None and prepared.parameter.is_uniform
    if by_machine:
        moving = Reducer(prepared, burden).moving(span.parameter)
        return State.of(solved, moving), Rates(float(moving.rate[0]), 0.0), True
    moving = Moving(span.time, span.parameter, span.rate)
    return State.of(solved, moving), Rates(float(span.rate[0]), float(span.second_rate[0])), False


def _speeds(exact: xr.Dataset, prepared: Ready, rates: Rates) -> dict[str, float]:
    """Speed of each drive; with several they have their own."""
    drives = prepared.mechanism.drives
    if not prepared.kinematics.path.by_time:
        return {drives[0].id: rates.first}
    found = {}
    for one in prepared.kinematics.path.driven:
        found[one.drive.id] = float("nan") if one.drive.speed is None else one.drive.speed
    return found


def _group(cell: Cell, ledger: Ledger, room: tuple[float, float]) -> GroupForces:
    """Solve one group and enter its reactions."""
    words, before = Words(), tuple(ledger.on(cell.bodies))
    kind, found = _solved(cell, ledger, words)
    for joint, force, moment in found.forces:
        ledger.settle(joint, force, moment)
    words.notes(cell.joints)
    inner = [id(joint) for joint in cell.inner]
    reactions = tuple(
        ledger.reaction(joint, body, force, moment)
        for joint, force, moment in found.forces
        for body in cell.bodies
        if body in joint.shares and id(joint) not in inner
    )
    numbers = tuple(ledger.bodies.number(body) for body in cell.bodies)
    whole = polygon_of(cell.bodies, found.chain, _chords(cell, ledger, found), room)
    single = tuple(
        polygon_of((body,), [one for one in ledger.actions[body] if one.force != 0], (), room)
        for body in cell.bodies
    )
    return GroupForces(
        cell.bodies,
        numbers,
        kind,
        before,
        reactions,
        tuple(words.lines),
        whole,
        single,
        cell.joints,
        found.marks,
    )


def _solved(cell: Cell, ledger: Ledger, words: Words) -> tuple[str, Found]:
    """The kind of a group, and its reactions by the way that fits it."""
    dyad = dyad_of(cell)
    if dyad is not None:
        return dyad.kind, solve_dyad(dyad, ledger, words)
    single = solve_single(cell, ledger, words)
    if single is not None:
        driven = any(joint.kind == "drive" for joint in cell.joints)
        return "input" if driven else "single", single
    triad = triad_of(cell)
    by_point = None if triad is None else solve_triad(triad, ledger, words)
    if by_point is not None:
        return "triad", by_point
    return "together", solve_together(cell, ledger, words)


def _chords(cell: Cell, ledger: Ledger, found: Found) -> list[PolygonVector]:
    """Reactions of inner joints of a dyad: from where the forces of its first link end to where they begin."""
    dyad = dyad_of(cell)
    if dyad is None:
        return []
    body, at, began = dyad.first.body, 0j, True
    force = next(force for joint, force, _moment in found.forces if joint is dyad.inner)
    for action in found.chain:
        if action.body != body:
            began = False
        if began:
            at += action.force
    return [vector_of(ledger.reaction(dyad.inner, body, force), at)]


def _driving(ledger: Ledger, joint: Joint) -> float:
    """Moment or force of a drive, positive as its value grows."""
    number = next(k for k, one in enumerate(ledger.joints) if one is joint)
    force, moment = ledger.forces[number]
    return moment if not joint.has_force else (force * joint.along.conjugate()).real


def _reactions(ledger: Ledger) -> dict[str, complex]:
    """Forces of joints on each of their bodies, by name."""
    actions = [action for body in ledger.bodies.names for action in ledger.actions[body]]
    return {one.symbol: one.force for one in actions if one.source == "reaction" and one.symbol[0] == "R"}


def _moments(ledger: Ledger) -> dict[str, float]:
    """Moments of guides and meshes on their bodies."""
    found = {}
    for number, joint in enumerate(ledger.joints):
        _force, moment = ledger.forces[number]
        for body, share in joint.shares.items():
            symbol = ledger.symbol(joint, body)
            if joint.kind == "guide":
                found[f"M{symbol.removeprefix('R')}"] = share * moment
            elif joint.kind == "mesh" and not joint.has_force:
                found[symbol] = share * moment
    return found


def _by_work(burden: Burden, state: State, rates: Rates, prepared: Ready) -> dict[str, float]:
    """Balancing moment by virtual work, J q'' + J' q'^2/2 - M, of one drive."""
    if prepared.kinematics.path.by_time:
        return {}
    one = reduced(burden, state, np.zeros(1, dtype=np.int8))
    inertia, slope, moment = (float(part[0]) for part in (one.inertia, one.inertia_slope, one.moment))
    drive = prepared.mechanism.drives[0].id
    return {drive: inertia * rates.second + 0.5 * slope * rates.first**2 - moment}


def _levers(prepared: Ready, drawing: Drawing, bodies: Bodies, outer: Sequence[Action]) -> tuple[Lever, ...]:
    """A lever for each drive; none where the velocities of a group cannot be drawn by hand."""
    drives = prepared.mechanism.drives
    try:
        return tuple(lever_of(prepared.structure, drawing, bodies, outer, drive) for drive in drives)
    except InputError:
        return ()
