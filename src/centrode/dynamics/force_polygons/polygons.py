"""Force polygons of a mechanism at an instant: the whole way from a description to drawn forces."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.analysis.graphic.construction import construct
from centrode.analysis.graphic.diagrams import drawing_of
from centrode.analysis.graphic.stage import ConstructionStage, DrawingBoard, VectorDrawing
from centrode.dynamics.force_polygons.groups import (
    DyadReactions,
    WorkedSteps,
    dyad_of,
    solve_dyad,
    solve_single,
    solve_together,
    solve_triad,
    triad_of,
)
from centrode.dynamics.force_polygons.statics import (
    Action,
    Cell,
    FreeBodies,
    Ledger,
    Source,
    StateRates,
    StaticJoint,
    cells_of,
    joints_of,
    outer_actions,
)
from centrode.dynamics.force_polygons.steps import Step
from centrode.dynamics.kinetostatics.applied_forces import (
    DriveGroup,
    InputMotion,
    MotionOfDrive,
    check_motion,
    outer_of,
    steady_grid,
)
from centrode.dynamics.kinetostatics.radial_forces import tangential_forces_at
from centrode.dynamics.loads import MassesAndLoads
from centrode.dynamics.reduction import Reducer, reduce_state
from centrode.dynamics.state import DriveMotion, State
from centrode.errors import InputError, MotionError, Status
from centrode.kinematics.motion import dataset_of
from centrode.kinematics.path import grid_at, place_of
from centrode.kinematics.preparation import Ready, ready
from centrode.kinematics.solve import Solved, solve
from centrode.locale import _
from centrode.model.examples.catalogue import MechanismSource, mechanism_of
from centrode.model.mechanism import FRAME, Drive, Mechanism
from centrode.model.reading import nearest
from centrode.numerics.round_scales import FORCE_SCALES, round_scale
from centrode.printed_results import PrintsSummary
from centrode.quantities import status_word
from centrode.structure.plan import Structure

# Force polygons as data: vectors one behind the other, with names and a round scale.

PARTS = "ⁿᵗ"
"""Marks of normal and tangential parts behind the name of a reaction."""
PAPERS = {"A5": (210.0, 148.0), "A4": (297.0, 210.0), "A3": (420.0, 297.0)}
"""Sheets across [mm]."""
ROOM, HEAD = 0.38, 0.17
"""Share of a sheet's width for a polygon, and of its height above and below it."""
Size: TypeAlias = tuple[float, float]


@dataclass(frozen=True)
class PolygonVector:
    """A force of a polygon.

    Attributes
    ----------
    name : R12ᵗ, G2, Φ2, R03
    label : what it is: the load's name, the link, the joint
    body : the body it acts on
    source : "load", "weight", "inertia", "reaction" or "drive"
    force [N], start [N], place [m] : complex numbers; where the arrow begins in the polygon, where the force acts
    """

    name: str
    label: str
    body: str
    source: Source
    force: complex
    start: complex
    place: complex

    @property
    def end(self) -> complex:
        """Where the arrow ends [N]."""
        return self.start + self.force

    @property
    def is_part(self) -> bool:
        """Whether it is the normal or the tangential part of a reaction."""
        return self.name[-1] in PARTS

    @property
    def whole(self) -> str:
        """Name of the reaction that it is a part of, else its own."""
        return self.name[:-1] if self.is_part else self.name


@dataclass(frozen=True)
class Polygon:
    """A closed chain of forces on a group or on one link.

    Attributes
    ----------
    bodies : what it is about
    vectors : one behind the other
    chords : of a group, the reactions of its inner joints, drawn into the chain; each closes the polygon of one link
    scale : newtons that a millimetre stands for
    """

    bodies: tuple[str, ...]
    vectors: tuple[PolygonVector, ...]
    chords: tuple[PolygonVector, ...]
    scale: float

    @property
    def sums(self) -> tuple[PolygonVector, ...]:
        """Reactions that were found in two parts, normal and tangential, as wholes."""
        return tuple(
            replace(first, name=first.name[:-1], force=first.force + second.force)
            for first, second in pairwise(self.vectors)
            if first.is_part and first.name[:-1] == second.name[:-1]
        )

    @property
    def gap(self) -> complex:
        """Sum of the vectors [N], which only rounding keeps from zero."""
        return sum((vector.force for vector in self.vectors), 0j)

    def length(self, vector: PolygonVector) -> float:
        """Length of a vector on paper [mm]."""
        return abs(vector.force) / self.scale

    def vector(self, name: str) -> PolygonVector:
        """A vector by its name; KeyError where there is none."""
        for one in (*self.vectors, *self.sums, *self.chords):
            if one.name == name:
                return one
        raise KeyError(name)

    def parts_of(self, name: str) -> tuple[PolygonVector, ...]:
        """The normal and the tangential part of a reaction; KeyError where it was not found in parts."""
        return tuple(self.vector(name + mark) for mark in PARTS)


def chain_actions(actions: Iterable[Action]) -> tuple[PolygonVector, ...]:
    """Actions one behind the other, from the origin."""
    found: list[PolygonVector] = []
    at = 0j
    for action in actions:
        found.append(vector_of(action, at))
        at += action.force
    return tuple(found)


def vector_of(action: Action, start: complex) -> PolygonVector:
    """An action as a vector that begins somewhere."""
    return PolygonVector(
        action.symbol, action.label, action.body, action.source, action.force, start, action.place
    )


def polygon_of(
    bodies: Sequence[str], actions: Iterable[Action], chords: Iterable[PolygonVector], room: Size
) -> Polygon:
    """A polygon with the finest round scale at which it goes into a room [mm]."""
    vectors = chain_actions(actions)
    return Polygon(tuple(bodies), vectors, tuple(chords), scale_of(vectors, room))


def scale_of(vectors: Sequence[PolygonVector], room: Size) -> float:
    """The finest scale [N/mm] of the series 1, 2, 2.5, 5 at which vectors go into a room."""
    corners = [0j, *(vector.end for vector in vectors)]
    wide = max(corner.real for corner in corners) - min(corner.real for corner in corners)
    high = max(corner.imag for corner in corners) - min(corner.imag for corner in corners)
    return round_scale(max(wide / room[0], high / room[1]), series=FORCE_SCALES)


def sheet_of(paper: str) -> Size:
    """Width and height [mm] of a sheet across; InputError for a name that is none."""
    if paper not in PAPERS:
        what = _("{paper} is not a supported paper size").format(paper=f'"{paper}"')
        known = _("one of: {names}").format(names=", ".join(PAPERS))
        raise InputError("paper", what, nearest(paper, PAPERS) or known)
    return PAPERS[paper]


def room_of(paper: str) -> Size:
    """Room [mm] of a polygon on a sheet."""
    wide, high = sheet_of(paper)
    return ROOM * wide, (1 - HEAD) * high


# Zhukovsky's lever: the velocity diagram, turned by a right angle, as a rigid lever with all forces on it.
#
# Its velocities are constructed as on a drawing board for a unit rate of one drive. Forces act at the images
# of their places; a moment on a link acts on the lever times (side of the image / side of the link). The
# lever is in equilibrium about the pole with the balancing moment.


@dataclass(frozen=True)
class LeverForce:
    """A force or moment on the lever.

    Attributes
    ----------
    name, label : of the force
    force [N] : complex number, as in the mechanism
    image : where it acts, from the pole [m, or 1 of a displacement drive; per radian or metre of the drive]
    couple : moment on the lever of what is a moment in the mechanism [N m, N of a displacement drive]
    moment : about the pole, counter-clockwise positive, the couple included
    """

    name: str
    label: str
    body: str
    force: complex
    image: complex
    couple: float
    moment: float


@dataclass(frozen=True)
class Lever:
    """The lever of one drive.

    Attributes
    ----------
    drive : its id
    images : point -> place on the lever, a complex number from the pole; points of the frame at the pole
    links : link -> its points, for its outline
    forces : what acts on it, moments included
    balancing : moment [N m] or force [N] of the drive, positive as its value grows
    """

    drive: str
    unit: str
    images: Mapping[str, complex]
    links: Mapping[str, tuple[str, ...]]
    forces: tuple[LeverForce, ...]

    @property
    def balancing(self) -> float:
        """Moment [N m] or force [N] that the drive must give, so that the lever stands still."""
        return -sum(one.moment for one in self.forces)


def lever_of(
    structure: Structure, drawing: VectorDrawing, bodies: FreeBodies, outer: Sequence[Action], drive: Drive
) -> Lever:
    """The lever of one drive, the others held; raises as velocity diagrams do at dead points."""
    coordinate = structure.mechanism.motion_parameter.drive(drive.id)
    stage = ConstructionStage(
        drawing,
        {one.id: coordinate.sense if one.id == drive.id else 0.0 for one in structure.mechanism.drives},
    )
    stage.points |= dict.fromkeys(drawing.numbers.frame, 0j)
    construct(structure, stage)
    forces = []
    for action in outer:
        image = -1j * _rate(stage, bodies, action)
        couple = action.moment * _turn(stage, bodies, action.body)
        # (-i v) x F = v . F: a moment on the lever is the power in the mechanism, at unit rate of the drive
        arm = image.conjugate() * action.force
        forces.append(
            LeverForce(
                action.symbol, action.label, action.body, action.force, image, couple, arm.imag + couple
            )
        )
    links = {name: tuple(link.coordinates) for name, link in structure.mechanism.links.items()}
    images = {name: -1j * rate for name, rate in stage.points.items()}
    return Lever(
        drive.id,
        coordinate.force_unit,
        images,
        links,
        tuple(forces),
    )


def _rate(stage: ConstructionStage, bodies: FreeBodies, action: Action) -> complex:
    """Velocity of the place of a body where an action acts."""
    if action.force == 0 or action.body == FRAME:
        return 0j
    if action.body in bodies.sliders:
        return stage.points[bodies.sliders[action.body].point]
    if action.body in bodies.pins:
        return stage.points[bodies.pins[action.body]]
    return stage.point_rate(action.body, action.place)


def _turn(stage: ConstructionStage, bodies: FreeBodies, body: str) -> float:
    """Turning of a link; of sliders no moment is asked."""
    return stage.turns.get(body, 0.0)


# Force polygons of an instant as a result: groups, polygons, reactions, balancing moments, levers.


@dataclass(frozen=True)
class GroupForces:
    """Forces of one group and the steps of their construction.

    Attributes
    ----------
    bodies : its links and sliders; `numbers` those in the names of forces
    kind : "RRR", "RRP", "RPR", "PRP", "RPP", "triad", "input", "single" or "together"
    actions : what acts on its bodies before it is solved: loads, weights, inertia, reactions of groups behind it
    reactions : of its outer joints and drives, on its bodies
    steps : what was done
    polygon : of the whole group
    link_polygons : of each of its bodies
    joints : its own joints, inner and outer
    marks : special points of the construction: S of a triad is its Assur point
    """

    bodies: tuple[str, ...]
    numbers: tuple[int, ...]
    kind: str
    actions: tuple[Action, ...]
    reactions: tuple[Action, ...]
    steps: tuple[Step, ...]
    polygon: Polygon
    link_polygons: tuple[Polygon, ...]
    joints: tuple[StaticJoint, ...]
    marks: tuple[tuple[str, complex], ...] = ()


@dataclass(frozen=True, repr=False)
class ForcePolygons(PrintsSummary):
    """Forces of a mechanism at an instant, by hand.

    Attributes
    ----------
    exact : the motion at the instant
    speed : rate of each drive at which inertia and loads are taken [rad/s or m/s]; `speed_from` "machine", "drive", or
        "steady" of the real motion
    names : bodies by number
    groups : in the order in which they were solved, the input link at the end
    reactions : name -> force [N] as a complex number, R12 of body 1 on body 2
    moments : name -> moment [N m] of guides and meshes
    balancing : drive -> moment [N m] or force [N] that it must give, positive as its value grows
    work : the same by virtual work, of one drive
    levers : Zhukovsky's lever of each drive
    outer : loads, weights and inertia
    places : point -> place [m]
    paper : the sheet that scales are chosen for
    group : group I of a machine in its real motion, at the one sample; None otherwise
    """

    mechanism: Mechanism
    exact: xr.Dataset
    speed: Mapping[str, float]
    speed_from: str
    names: tuple[str, ...]
    groups: tuple[GroupForces, ...]
    reactions: Mapping[str, complex]
    moments: Mapping[str, float]
    balancing: Mapping[str, float]
    work: Mapping[str, float]
    levers: tuple[Lever, ...]
    outer: tuple[Action, ...]
    places: Mapping[str, complex]
    paper: str
    group: DriveGroup | None = None

    @property
    def paper_size(self) -> Size:
        """Width and height of the sheet of paper [mm]."""
        return sheet_of(self.paper)

    @property
    def polygons(self) -> tuple[Polygon, ...]:
        """Of every group, in the order in which they were solved."""
        return tuple(group.polygon for group in self.groups)

    @property
    def steps(self) -> tuple[Step, ...]:
        """All steps, group by group."""
        return tuple(step for group in self.groups for step in group.steps)

    @property
    def lever(self) -> Lever:
        """The lever of the first drive; KeyError where it cannot be drawn."""
        if not self.levers:
            raise KeyError("lever")
        return self.levers[0]


def force_polygons(
    mechanism: MechanismSource, at: npt.ArrayLike, paper: str = "A4", *, motion: MotionOfDrive = "mean"
) -> ForcePolygons:
    """Reactions and balancing moment at an instant by force polygons, group by group, and by Zhukovsky's lever.

    Parameters
    ----------
    at : float [rad or m, or s], or a text with a unit ("120 deg")
        A value of the drive, or a time, as in `motion(at=...)`; a list may hold one.
    paper : "A5", "A4" or "A3"
        The sheet that scales of forces are chosen for.
    motion : "mean" or "real"
        At the speed of `reduce`, or at the real speed and acceleration of a machine in steady motion.

    Raises
    ------
    InputError
        No masses and no loads, or incomplete ones; a paper that is none; an instant out of range.
    NotComputedYet
        The sphere; friction; constraints that repeat each other, so that reactions are not determined.
    MotionError
        The mechanism does not close there, or stands at a limit, a change point or a dead position.

    Examples
    --------
    >>> import centrode as ct
    >>> found = ct.force_polygons(ct.example("six-bar-press"), 2.0)
    >>> [str(name) for name in found.balancing]
    ['OA']
    """
    mechanism = mechanism_of(mechanism)
    check_motion(motion)
    room = room_of(paper)
    burden = MassesAndLoads.in_plane(mechanism)
    prepared = ready(mechanism)
    at = place_of(prepared.parameter.instant, at)
    pace = None
    if motion == "real":
        prepared, span, pace = steady_grid(mechanism, None, [at])
    else:
        span = grid_at(prepared.kinematics.path, np.array([at], dtype=np.float64))
    solved = solve(prepared, span)
    exact = dataset_of(solved)
    _refuse_where_it_is_not(exact, at)
    drawing = drawing_of(prepared, exact, DrawingBoard())
    bodies = FreeBodies.of(prepared.structure)
    state, rates, source = _state(solved, burden) if pace is None else _real_state(solved, pace)
    outer = outer_actions(burden, state, rates, drawing, bodies)
    joints = joints_of(prepared.structure, bodies, drawing, _teeth(prepared, state, rates, burden))
    ledger = Ledger.of(bodies, joints, outer, float(drawing.numbers.scale))
    cells = cells_of(prepared.structure, bodies, joints)
    groups = tuple(_group(cell, ledger, room) for cell in cells)
    drives = {joint.name: _drive_reaction(ledger, joint) for joint in joints if joint.kind == "drive"}
    return ForcePolygons(
        mechanism,
        exact,
        _speeds(exact, prepared, rates),
        source,
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
        None if pace is None else pace.group,
    )


def _teeth(prepared: Ready, state: State, rates: StateRates, burden: MassesAndLoads) -> dict[str, complex]:
    """Tangential forces on the second wheels of pairs of gears [N]: which flanks bear follows from all loads."""
    if not any(gear.pair for gear in prepared.mechanism.gears):
        return {}
    outer = outer_of(state, burden, np.array([rates.second]), state.exists)
    forces = tangential_forces_at(prepared, state, outer)
    return {name: complex(*force[0]) for name, force in forces.items()}


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


def _real_state(solved: Solved, pace: InputMotion) -> tuple[State, StateRates, str]:
    """The state at the real speed of a machine, its rates by time, and whose they are."""
    rates = StateRates(float(pace.moving.rate[0]), float(pace.acceleration[0]))
    return State.of(solved, pace.moving), rates, pace.source


def _state(solved: Solved, burden: MassesAndLoads) -> tuple[State, StateRates, str]:
    """The state at the speed that `reduce` takes, its rates by time, and whose they are."""
    span, prepared = solved.span, solved.ready
    by_machine = prepared.mechanism.runs_at_mean_speed and prepared.parameter.is_uniform
    if by_machine:
        moving = Reducer(prepared, burden).moving(span.parameter)
        return State.of(solved, moving), StateRates(float(moving.rate[0]), 0.0), "machine"
    moving = DriveMotion(span.time, span.parameter, span.rate)
    return State.of(solved, moving), StateRates(float(span.rate[0]), float(span.second_rate[0])), "drive"


def _speeds(exact: xr.Dataset, prepared: Ready, rates: StateRates) -> dict[str, float]:
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
    worked, before = WorkedSteps(), tuple(ledger.on(cell.bodies))
    kind, found = _solve_cell(cell, ledger, worked)
    for joint, force, moment in found.forces:
        # known from now on: groups that are solved later feel them
        ledger.settle(joint, force, moment)
    worked.assumptions(cell.joints)
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
        tuple(worked.steps),
        whole,
        single,
        cell.joints,
        found.marks,
    )


def _solve_cell(cell: Cell, ledger: Ledger, worked: WorkedSteps) -> tuple[str, DyadReactions]:
    """The kind of a group, and its reactions by the way that fits it."""
    dyad = dyad_of(cell)
    if dyad is not None:
        return dyad.kind, solve_dyad(dyad, ledger, worked)
    single = solve_single(cell, ledger, worked)
    if single is not None:
        driven = any(joint.kind == "drive" for joint in cell.joints)
        return "input" if driven else "single", single
    # from the hand construction that needs least to the equations that always work
    triad = triad_of(cell)
    by_point = None if triad is None else solve_triad(triad, ledger, worked)
    if by_point is not None:
        return "triad", by_point
    return "together", solve_together(cell, ledger, worked)


def _chords(cell: Cell, ledger: Ledger, found: DyadReactions) -> list[PolygonVector]:
    """Reactions of inner joints of a dyad: from where the forces of its first link end to where they begin."""
    dyad = dyad_of(cell)
    if dyad is None:
        return []
    # the chain begins with the forces on the first link, all in one run
    body, at, began = dyad.first.body, 0j, True
    force = next(force for joint, force, _moment in found.forces if joint is dyad.inner)
    for action in found.chain:
        if action.body != body:
            began = False
        if began:
            at += action.force
    return [vector_of(ledger.reaction(dyad.inner, body, force), at)]


def _drive_reaction(ledger: Ledger, joint: StaticJoint) -> float:
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


def _by_work(burden: MassesAndLoads, state: State, rates: StateRates, prepared: Ready) -> dict[str, float]:
    """Balancing moment by virtual work, J q'' + J' q'^2/2 - M, of one drive."""
    if prepared.kinematics.path.by_time:
        return {}
    one = reduce_state(burden, state, np.zeros(1, dtype=np.int8))
    inertia, slope, moment = (float(part[0]) for part in (one.inertia, one.inertia_slope, one.moment))
    drive = prepared.mechanism.drives[0].id
    return {drive: inertia * rates.second + 0.5 * slope * rates.first**2 - moment}


def _levers(
    prepared: Ready, drawing: VectorDrawing, bodies: FreeBodies, outer: Sequence[Action]
) -> tuple[Lever, ...]:
    """A lever for each drive; none where the velocities of a group cannot be drawn by hand."""
    drives = prepared.mechanism.drives
    try:
        return tuple(lever_of(prepared.structure, drawing, bodies, outer, drive) for drive in drives)
    except InputError:
        return ()
