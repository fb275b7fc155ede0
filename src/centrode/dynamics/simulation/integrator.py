"""Adaptive integration with events: legs between jumps of the loads, standstills, limits, sticking.

A step that leaves its leg, or in which the drive stops, is done again to where that happens, so that none of its
stages sees beyond. Schemes: DOP853 (Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, 1993) and
Radau IIA of order 5 (Hairer, Wanner, II, 1996), both of SciPy; the first gives way to the second where the steps are
held back by stability (the product of step and damping rate stays at the edge of the stable region).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import pairwise
from math import copysign, isfinite, tau
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import scipy.integrate

from centrode.dynamics.loads import MassesAndLoads
from centrode.dynamics.masses import share
from centrode.dynamics.reduction import state_of_nodes
from centrode.dynamics.simulation.equation_of_motion import (
    CREEP,
    INERTIA,
    RATE,
    SORTS,
    STATES,
    VALUE,
    DriveForces,
    Driving,
    Ending,
    Field,
    FieldLeg,
    Occasion,
    ReducedFunctions,
    Trajectory,
    TrajectoryPiece,
    sort_load_terms,
    too_far,
    without_value,
)
from centrode.dynamics.simulation.equation_of_motion import Array as States
from centrode.dynamics.simulation.interpolation import Interpolant
from centrode.dynamics.state import DriveMotion
from centrode.errors import MotionError
from centrode.kinematics.machine_code.trace import Untraceable, trace_motion
from centrode.kinematics.machine_code.variables import PARAMETER, TIME, centre_of, varied_of, winding_of
from centrode.kinematics.machine_code.variables import RATE as RATE_VARIABLE
from centrode.kinematics.path import SampleGrid
from centrode.locale import _, mark
from centrode.model.simulation import MOST_TURNS
from centrode.numerics.executors import runner
from centrode.numerics.expressions import EXPRESSIONS, Node, Operand, as_node, variable
from centrode.numerics.graphs import Graph
from centrode.numerics.scans import Scan
from centrode.numerics.search import bisect, root

# The classical Runge-Kutta scheme of fourth order with equal steps, as the source integrates.

TOLD = 256
"""Steps between two reports of progress."""


def fixed_steps(
    field: Field,
    value: float,
    rate: float,
    duration: float,
    steps: int,
    tell: Callable[[float], None] | None = None,
) -> Trajectory:
    """The course by equal steps: no step ends at a jump or a standstill, as with any fixed-step scheme."""
    step = duration / steps
    states = np.empty((STATES, steps + 1))
    y: States = np.array([value, rate, *[0.0] * (STATES - 2)])
    states[:, 0] = y
    done = 0
    ended: Ending = "duration"
    try:
        for k in range(steps):
            y = next_state(field, k * step, y, step)
            if not np.isfinite(y).all():
                ended = field.tracks.ending(float(states[VALUE, done]))
                break
            if field.is_too_far(float(y[VALUE]), value):
                raise too_far((k + 1) * step)
            done = k + 1
            states[:, done] = y
            if tell is not None and done % TOLD == 0:
                tell(done / steps)
    except KeyboardInterrupt:
        if not done:
            raise
        ended = "interrupted"
    return trajectory_of_states(field, states[:, : done + 1], step, ended, 4 * steps)


def trajectory_of_states(
    field: Field, found: States, step: float, ended: Ending, evaluations: int
) -> Trajectory:
    """States (STATES, steps + 1) at even times as a course; between two steps an interpolant of the same order."""
    count = found.shape[1] - 1
    if ended in ("limit", "change point") and count == 0:
        raise MotionError(
            "[simulation]",
            _("the first step passes a limit or a change point"),
            _("give more steps, or another start"),
        )

    def slopes(t: float, y: States) -> States:
        # at the end of the motion the interpolant may look a little beyond it
        inside = y.copy()
        inside[VALUE] = min(max(y[VALUE], field.tracks.low), field.tracks.high)
        return _rates(field, t, inside)

    occasions = []
    if ended in ("limit", "change point"):
        last = float(found[VALUE, -1])
        occasions = [Occasion(ended, count * step, last if ended == "limit" else field.tracks.end(last))]
    piece = TrajectoryPiece(0.0, count * step, Interpolant(found, step, slopes), 1.0)
    return Trajectory([piece], occasions, ended, evaluations, "runge-kutta-4")


def even_times(course: Trajectory, step: float, samples: int) -> States:
    """Times of steps, as evenly spaced as may be."""
    count = round(course.last / step)
    return np.unique(np.rint(np.linspace(0, count, samples))) * step


def next_state(field: Field, t: float, y: States, step: float) -> States:
    """States (STATES) a step later, NaN where it leads beyond a limit; MotionError where a formula has no value."""
    k1 = _rates(field, t, y)
    k2 = _rates(field, t + 0.5 * step, y + 0.5 * step * k1)
    k3 = _rates(field, t + 0.5 * step, y + 0.5 * step * k2)
    k4 = _rates(field, t + step, y + step * k3)
    states = np.asarray(y + step / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4))
    # beyond the range there is no mechanism: NaN tells that the last step was one too many
    return states if field.tracks.low <= states[VALUE] <= field.tracks.high else np.full(STATES, np.nan)


def _rates(field: Field, t: float, y: States) -> States:
    """Slopes of the states; NaN beyond a limit."""
    value, rate = float(y[0]), float(y[1])
    tracks = field.tracks
    if not np.isfinite(value) or not tracks.low <= value <= tracks.high:
        return np.full(STATES, np.nan)
    # at rest loads act as they would when the drive sets out in its own sense
    sense = 1.0 if rate > 0.0 else -1.0 if rate < 0.0 else tracks.rows.sense
    forces = field.forces(field.leg_at(value, sense), t, value, rate)
    rates = np.array(
        [rate, forces.acceleration(rate), forces.driving * rate, forces.friction * rate, forces.other * rate]
    )
    if not np.isfinite(rates).all():
        raise without_value(t, value)
    return rates


# The fixed-step scheme as one scan over expressions: machine code where llvmlite is there.
#
# Positions are those of the closed forms, traced at each of the four stages: nothing is represented, so
# nothing is approximated but by the scheme. That needs a mechanism without events, as sweeps do
# (`kinematics.machine_code`).

Array: TypeAlias = npt.NDArray[np.float64]
Number: TypeAlias = Any

NAMES = ("value", "speed", "of drive", "of friction", "of others")
"""States of the scan, in the order of a course."""
BEGINNING, STEP = "beginning", "step"
"""Time at the beginning of a step [s], its length [s]."""


@dataclass(frozen=True)
class Compiled:
    """A simulation as a scan.

    Attributes
    ----------
    scan : one step of the scheme; parameters: its length; inputs: times at which steps begin
    executor : "machine code" or "arrays"
    """

    scan: Scan
    executor: str

    def states(self, value: float, rate: float, duration: float, steps: int) -> Array:
        """States (STATES, steps + 1) at the ends of all steps."""
        step = duration / steps
        times = step * np.arange(steps, dtype=np.float64)
        start = np.array([value, rate, *[0.0] * (STATES - 2)])
        known = {BEGINNING: times}
        inputs = np.stack([known[name] for name in self.scan.inputs]) if self.scan.inputs else None
        run = runner(self.scan, self.executor)
        outputs = run([[step]], inputs, start[:, None], steps=None if self.scan.inputs else steps).outputs
        return np.concatenate([start[:, None], outputs[:, :, 0]], axis=1)

    def course(self, field: Field, value: float, rate: float, duration: float, steps: int) -> Trajectory:
        """The course of so many steps, up to where the motion ends."""
        states = self.states(value, rate, duration, steps)
        # the scan has made all steps: where it went too far, or stopped, is looked up afterwards
        far = np.flatnonzero(np.abs(states[VALUE] - value) > MOST_TURNS * field.tracks.length)
        if len(far):
            raise too_far(duration / steps * int(far[0]))
        lost = ~np.isfinite(states).all(axis=0)
        ended: Ending = "duration"
        if lost.any():
            done = int(np.argmax(lost)) - 1
            step = duration / steps
            next_state(field, done * step, states[:, done], step)  # says which formula has no value
            states, ended = states[:, : done + 1], "limit"
        course = trajectory_of_states(field, states, duration / steps, ended, 4 * steps)
        course.executor = self.executor
        return course


def compile_scan(rows: ReducedFunctions, driving: Driving, executor: str) -> Compiled:
    """The scan of a mechanism; raises Untraceable, with a reason, where its motion cannot be said by expressions."""
    _refuse_events(rows)
    rates = _rate_graph(rows, driving)
    step = variable(STEP)
    begun = {name: variable(name) for name in NAMES}

    def at_stage(before: Mapping[str, Operand] | None, share: float) -> dict[str, Node]:
        moved = begun if before is None else {k: begun[k] + share * step * before[k] for k in NAMES}
        time = variable(BEGINNING) + share * step
        places: dict[str, Operand] = {PARAMETER: moved["value"], RATE_VARIABLE: moved["speed"], TIME: time}
        return dict(rates.substitute(places).outputs)

    k1 = at_stage(None, 0.0)
    k2 = at_stage(k1, 0.5)
    k3 = at_stage(k2, 0.5)
    k4 = at_stage(k3, 1.0)
    after = {
        name: as_node(begun[name] + step / 6.0 * (k1[name] + 2.0 * k2[name] + 2.0 * k3[name] + k4[name]))
        for name in NAMES
    }
    used = Graph(after).variables
    # only times that are used become inputs: others would make every step another one
    return Compiled(Scan((STEP,), tuple(x for x in (BEGINNING,) if x in used), after, after), executor)


def _rate_graph(rows: ReducedFunctions, driving: Driving) -> Graph:
    """Derivatives of the states as expressions of time, value and rate."""
    reducer = rows.reducer
    # two samples whose times and rates differ: then these are variables
    span = SampleGrid(np.array([0.0, 1.0]), np.array([0.0, 1.0]), np.array([1.0, 2.0]), np.zeros(2))
    traced = trace_motion(reducer.ready, span, varied_of(reducer.ready.kinematics.numbers, {}))
    if traced.steps:
        raise Untraceable(mark("groups of higher class"))
    time, value, rate = (variable(name) for name in (TIME, PARAMETER, RATE_VARIABLE))
    mechanism = reducer.ready.mechanism
    burden = MassesAndLoads.of(mechanism, None, EXPRESSIONS)
    state = state_of_nodes(traced.solved, burden, DriveMotion(time, value, rate))  # type: ignore[arg-type]
    inertia: Number = rows.added
    slope: Number = 0.0
    for mass in burden.masses:
        inertia, slope = (a + b for a, b in zip((inertia, slope), share(state, mass), strict=True))
    moments: dict[str, Number] = dict.fromkeys(SORTS, 0.0)
    for term in sort_load_terms(burden.loads):
        along = term.effort.along(state)
        moments[term.sort] = moments[term.sort] + term.effort.strength(state) * along
    driven = driving.over(EXPRESSIONS, time, value, rate)
    total = moments["stored"] + moments["friction"] + moments["other"] + driven
    powers = {"of drive": driven, "of friction": moments["friction"], "of others": moments["other"]}
    outputs: dict[str, Number] = {
        "value": rate,
        "speed": (total - 0.5 * slope * rate * rate) / inertia,
        **{name: moment * rate for name, moment in powers.items()},
    }
    graph = Graph.of(outputs)
    return graph.substitute(_turns(rows, graph))


def _refuse_events(rows: ReducedFunctions) -> None:
    """Limits and change points are not followed by expressions."""
    reducer = rows.reducer
    path = reducer.ready.kinematics.path
    if path.driven[0].drive.kind != "angle":
        raise Untraceable(mark("a drive that does not turn"))
    if reducer.events(path.initial - tau, path.initial + tau):
        raise Untraceable(mark("limits or change points within a turn"))


def _turns(rows: ReducedFunctions, graph: Graph) -> dict[str, float]:
    """Centres and windings of the links whose angles matter: from a turn of the drive."""
    reducer = rows.reducer
    path = reducer.ready.kinematics.path
    values = path.initial + np.linspace(0.0, tau, 721)
    turns: dict[str, float] = {}
    drive = path.driven[0].drive.id
    for link in reducer.ready.mechanism.link_names:
        names = centre_of(link), winding_of(link, drive)
        if not set(names) & set(graph.variables):
            continue
        angle = np.asarray(rows.state(values)[0].angle(link).value).reshape(-1)
        # angles are taken to turn with the drive as often as they do over one turn
        winding = round(float(angle[-1] - angle[0]) / tau)
        rest = angle - winding * values
        # around a fixed centre only less than half a turn either way is unambiguous
        if np.ptp(rest) >= tau / 2:
            raise Untraceable(mark("links that swing by half a turn or more"))
        turns |= {names[0]: 0.5 * float(np.min(rest) + np.max(rest)), names[1]: float(winding)}
    return turns


# Where a step meets the end of its leg or a standstill, and when a mechanism at rest breaks loose.

State: TypeAlias = npt.NDArray[np.float64]

REST_SCANS = 2000
"""Instants at which a mechanism at rest is checked for breaking loose, where something depends on time."""


def break_loose_time(field: Field, value: float, first: float, last: float) -> float | None:
    """When a mechanism at rest breaks loose between two times; evenly spaced instants tell, bisection finds it."""
    times: list[float] = np.linspace(first, last, REST_SCANS).tolist()
    for before, after in pairwise(times):
        if field.leaving(after, value) != 0.0:

            def rests(time: State) -> npt.NDArray[np.bool_]:
                return np.asarray([field.leaving(float(t), value) == 0.0 for t in time])

            # the first instant at which it does not rest any more
            return float(bisect(rests, np.array([before]), np.array([after]))[1][0])
    return None


def first_event(
    dense: Any, before: float, solver: Any, low: float, high: float, sense: float
) -> tuple[float, int, float] | None:
    """The first time in a step at which the value leaves its range or the rate (where a sense counts) its sense."""
    events: list[tuple[float, int, float]] = []
    y = solver.y
    # at an end of its range a value that does not move outwards has not left it: from rest it may stay there for long
    above = y[VALUE] > high or (y[VALUE] == high and y[RATE] > 0.0)
    below = y[VALUE] < low or (y[VALUE] == low and y[RATE] < 0.0)
    targets = [(VALUE, high)] if above else [(VALUE, low)] if below else []
    # the rate has the other sign, or is exactly zero, at the end of the step
    if sense and y[1] * sense <= 0.0:
        targets.append((1, 0.0))
    for component, target in targets:

        def distance_to_target(t: float, component: int = component, target: float = target) -> float:
            return float(dense(t)[component]) - target

        start = distance_to_target(before)
        # a function that begins at zero, or does not change its sign, gives no bracket
        if start == 0.0 or start * distance_to_target(solver.t) > 0.0:
            when = (
                solver.t
                if start * distance_to_target(solver.t) > 0.0
                else _behind_start(distance_to_target, before, solver.t)
            )
        else:
            when = root(distance_to_target, before, solver.t)
        events.append((when, component, target))
    return min(events, default=None)


def _behind_start(missed: Callable[[float], float], first: float, last: float) -> float:
    """Where a function that begins at zero comes back to it; the end where it does not."""
    places = np.linspace(first, last, 65)[1:]
    values = [missed(float(x)) for x in places]
    for k in range(1, len(places)):
        if values[k - 1] * values[k] <= 0.0:
            return root(missed, places[k - 1], places[k])
    return last


def refine_event(
    rates: Callable[[float, State], State], t: float, y: State, component: int, target: float
) -> tuple[float, State]:
    """From a place very near to an event to the event itself, by Taylor's polynomial."""
    slopes = rates(t, y)
    speed = float(slopes[component])
    if speed == 0.0:
        return t, y
    # one Newton step in time: the place is very near already
    step = (target - float(y[component])) / speed
    moved = y + step * slopes
    if component == VALUE:
        moved[VALUE] = target
    else:
        # the value is righted to second order, as the rate passes zero and the first order vanishes
        moved[VALUE] += 0.5 * slopes[1] * step * step
        moved[1] = target
    return t + step, moved


# What is watched while an integration steps: that it gets on, how far it is, when the stiff scheme takes
# over.

MOST_STEPS = 150_000
"""Steps of one simulation: some two minutes, and 200 MB of their interpolants."""
EDGE = 3.0
"""Step times damping rate from which a step counts as held back by stability."""
ASIDE = 1e-6
"""Change of the rate, as a share of it, from which the damping rate is taken."""
LEAST_RATE = 1e-280
"""Rate below which a share of it would be no number."""
HELD_BACK = 15
"""Steps so held back after which the stiff scheme takes over."""


@dataclass(frozen=True)
class Until:
    """When to end: at a time [s], or at a distance of the drive's value from the start."""

    time: float
    way: float | None


@dataclass
class Watch:
    """Counts steps and watches them.

    Attributes
    ----------
    field, until, course : what is integrated, how far, and what is found
    stiff : whether the stiff scheme is used from now on
    tell : progress, a share of the whole
    most : steps
    start : value of the drive
    """

    field: Field
    until: Until
    course: Trajectory
    stiff: bool
    tell: Callable[[float], None] | None
    most: int
    start: float = 0.0
    steps: int = 0
    held_back: int = 0

    def count(self, leg: FieldLeg, begun: State, solver: Any, message: str | None) -> None:
        self.steps += 1
        value = float(begun[VALUE] + solver.y[0])
        if solver.status == "failed" or not np.isfinite(solver.y).all():
            raise (
                without_value(solver.t, value)
                if message is None
                else MotionError(
                    "[simulation]",
                    _("no step is small enough at t = {time:.6g} s, drive at {value:.6g}").format(
                        time=solver.t, value=value
                    ),
                    _('choose scheme = "stiff", or a larger tolerance'),
                )
            )
        if self.field.is_too_far(value, self.start):
            raise too_far(solver.t)
        if self.steps > self.most:
            raise MotionError(
                "[simulation]",
                _("{count} steps were taken up to t = {time:.6g} s").format(count=self.most, time=solver.t),
                _('give a shorter time, or choose scheme = "stiff" or a larger tolerance'),
            )
        if self.tell is not None and self.steps % 20 == 0:
            way = self.until.way
            share = solver.t / self.until.time if np.isfinite(self.until.time) else 0.0
            self.tell(share if way is None else max(share, abs(value - self.start) / way))
        if not self.stiff:
            self._watch(leg, solver, value)

    def _watch(self, leg: FieldLeg, solver: Any, value: float) -> None:
        """Change to the stiff scheme where damping holds the steps back."""
        rate = float(solver.y[1])
        # away from zero: beyond it friction would be another one
        more = rate + copysign(ASIDE * max(abs(rate), float(solver.atol[1]), LEAST_RATE), rate or leg.sense)

        def slowness(speed: float) -> float:
            forces: DriveForces = self.field.forces(leg, solver.t, value, speed)
            return float(forces.acceleration(speed))

        # the derivative of the acceleration by the rate: its product with the step is what stability asks
        # about
        damping = abs(slowness(more) - slowness(rate)) / (more - rate)
        held = damping * (solver.step_size or 0.0) > EDGE
        self.held_back = self.held_back + 1 if held else 0
        if self.held_back >= HELD_BACK:
            self.stiff = True
            self.course.scheme = "adaptive, then stiff"


# SciPy's solvers on a leg: the derivatives of the states, and tolerances in the measures of the machine.

SLOWEST = 1e-9
"""Part of a radian or a unit of length that the slowest drive of interest passes in the whole run."""


class Solvers:
    """Makes the solvers of one run; `watch` says whether they are to be stiff, `end` [s] is that of the run."""

    def __init__(self, field: Field, watch: Watch, end: float, tolerance: float) -> None:
        self.field, self.watch, self.end, self.tolerance = field, watch, end, tolerance
        # what would go no farther than this from beginning to end is rounding
        self.fastest = SLOWEST * field.tracks.unit / end if isfinite(end) else 0.0

    def rates(self, leg: FieldLeg, begun: State) -> Callable[[float, State], State]:
        """Derivatives of the states on a leg; value and works count from its beginning."""
        field, course, first = self.field, self.watch.course, float(begun[VALUE])

        def rates(t: float, y: State) -> State:
            rate = float(y[1])
            forces = field.forces(leg, t, first + float(y[0]), rate or leg.sense * CREEP)
            course.evaluations += 1
            return np.array(
                [
                    rate,
                    forces.acceleration(rate),
                    forces.driving * rate,
                    forces.friction * rate,
                    forces.other * rate,
                ]
            )

        return rates

    def solver(
        self,
        rates: Callable[[float, State], State],
        t: float,
        y: State,
        begun: State,
        leg: FieldLeg,
        end: float | None = None,
    ) -> Any:
        """SciPy's solver from a state on, up to a time; tolerances are in the measures of the machine."""
        forces = rates(t, y)
        if not np.isfinite(forces).all():
            raise without_value(t, float(begun[VALUE] + y[0]))
        unit = self.field.tracks.unit
        # the speed gained by the present acceleration over a hundredth of a unit counts, so that a start from
        # rest has a scale
        self.fastest = max(self.fastest, abs(float(y[1])), float(np.sqrt(0.02 * abs(forces[1]) * unit)))
        inertia = float(leg.rows(float(begun[VALUE] + y[0]))[INERTIA])
        # works are measured by the kinetic energy at the fastest speed so far
        energy = max(1e-300, inertia * self.fastest**2)
        scale = np.array([unit, 1e-2 * self.fastest or 1.0, energy, energy, energy])
        kind = scipy.integrate.Radau if self.watch.stiff else scipy.integrate.DOP853
        limit = self.end if end is None else end
        # SciPy takes no relative tolerance below 100 units of rounding
        return kind(rates, t, y, limit, rtol=max(self.tolerance, 3e-14), atol=self.tolerance * scale)


MOST_IDLE = 100
"""Legs in succession in which no time passes."""
AT_END = 1e-9
"""Distance from a limit, in units of the drive, that counts as there."""

_RELATIVE = np.array([1.0, 0.0, 1.0, 1.0, 1.0])
"""States that count from the beginning of a leg."""


class Stepper:
    """Integration of a field from a start."""

    def __init__(
        self,
        field: Field,
        until: Until,
        tolerance: float,
        stiff: bool = False,
        tell: Callable[[float], None] | None = None,
        most: int = MOST_STEPS,
    ) -> None:
        self.field = field
        self.until = until
        self.course = Trajectory(scheme="stiff" if stiff else "adaptive")
        self.watch = Watch(field, until, self.course, stiff, tell, most)
        self.solvers = Solvers(field, self.watch, until.time, tolerance)
        self.sense = self.last = 0.0
        self.idle = 0

    def run(self, value: float, rate: float) -> Trajectory:
        """The course from a value and a rate at time zero; what is done is kept when it is interrupted."""
        state = np.array([value, rate, *[0.0] * (STATES - 2)])
        self.start = self.watch.start = value
        try:
            with np.errstate(all="ignore"):  # steps that lead astray are rejected
                self.course.ended = self._run(0.0, state)
        except KeyboardInterrupt:
            if not self.course.pieces:
                raise
            self.course.ended = "interrupted"
        return self.course

    def _run(self, t: float, state: State) -> Ending:
        while True:
            if self._way_done(state):
                return "turns"
            if not t < self.until.time:
                return "duration"
            self._check_headway(t)
            if state[1] == 0.0:
                sense = self.field.leaving(t, float(state[VALUE]))
                # the sense before rest and the one after differ: it has turned round
                if sense * self.sense < 0.0:
                    self._note("turns back", t, state)
                if sense == 0.0:
                    later = self._rest(t, state)
                    if later is None:
                        return "standstill"
                    t = later
                    continue
            else:
                sense = 1.0 if state[1] > 0.0 else -1.0
            self.sense = sense
            leg = self.field.leg(float(state[VALUE]), sense)
            if self._at_limit(float(state[VALUE]), sense):
                ending = self.field.tracks.ending(float(state[VALUE]))
                self._note(ending, t, state)
                return ending
            t, state = self._pass(leg, t, state)

    def _at_limit(self, value: float, sense: float) -> bool:
        # at the limit but for rounding: nothing lies ahead
        tracks = self.field.tracks
        near = AT_END * tracks.unit
        return value >= tracks.high - near if sense > 0.0 else value <= tracks.low + near

    def _way_done(self, state: State) -> bool:
        way = self.until.way
        return way is not None and abs(float(state[VALUE]) - self.start) >= way * (1.0 - 1e-12)

    def _check_headway(self, t: float) -> None:
        """Refuse to go on where leg follows upon leg and no time passes."""
        self.idle = self.idle + 1 if t == self.last else 0
        # the same time again: a leg was left as soon as it was entered
        self.last = t
        if self.idle > MOST_IDLE:
            raise MotionError(
                "[simulation]",
                _(
                    "the integration does not pass t = {time:.6g} s: the driving moment or the loads change too "
                    "often there"
                ).format(time=t),
                _("correct their formulas"),
            )

    def _note(self, kind: str, t: float, state: State) -> None:
        self.course.occasions.append(Occasion(kind, t, float(state[VALUE])))

    # at rest

    def _rest(self, t: float, state: State) -> float | None:
        """Until when it rests; None where nothing will ever move it, or not before the end."""
        value = float(state[VALUE])
        later = break_loose_time(self.field, value, t, self.until.time) if self.field.of_time else None
        held = state.copy()
        if later is None:
            self._note("standstill", t, state)
            self._keep(t, self.until.time if np.isfinite(self.until.time) else t, held)
            return None
        self._note("sticks", t, state)
        self._keep(t, later, held)
        self._note("breaks loose", later, state)
        return later

    def _keep(self, first: float, last: float, held: State) -> None:
        self.course.pieces.append(
            TrajectoryPiece(first, last, lambda times: np.repeat(held[:, None], len(times), axis=1), 0.0)
        )

    # in motion

    def _pass(self, leg: FieldLeg, t: float, state: State) -> tuple[float, State]:
        """Go on to the end of a leg, a standstill, or the end of the run."""
        # value and works count from the beginning of the leg, so that long runs lose no digits
        begun, y = state.copy(), state - state * _RELATIVE
        turning = self.field.turns_count
        low, high = leg.low - begun[VALUE], leg.high - begun[VALUE]
        # the run ends at a way, which is an end of the range like any other
        if self.until.way is not None:
            gone = begun[VALUE] - self.start
            low, high = max(low, -self.until.way - gone), min(high, self.until.way - gone)
        rates = self.solvers.rates(leg, begun)
        solver = self.solvers.solver(rates, t, y, begun, leg)
        while True:
            if not t < self.until.time:
                return self.until.time, y + begun * _RELATIVE
            before, y_before = solver.t, solver.y.copy()
            message = solver.step()
            self.watch.count(leg, begun, solver, message)
            dense = solver.dense_output()
            event = first_event(dense, before, solver, low, high, leg.sense if turning else 0.0)
            if event is None:
                self._add(before, solver.t, dense, begun, leg.sense)
                t, y = solver.t, solver.y
                if solver.status == "finished":
                    return t, y + begun * _RELATIVE
                # the stiff scheme takes over in the middle of a leg, from the last good state
                if self.watch.stiff and not isinstance(solver, scipy.integrate.Radau):
                    solver = self.solvers.solver(rates, t, y, begun, leg)
                continue
            when, component, target = event
            # from the beginning of the step once more, so that no stage looks beyond the event
            t, y = self._exactly(rates, before, y_before, when, begun, leg)
            t, y = refine_event(rates, t, y, component, target)
            ended = y + begun * _RELATIVE
            if component == VALUE:
                ended[VALUE] = min(max(ended[VALUE], leg.low), leg.high)
                # exactly the end of the leg, so that the next leg begins on the other side
                edge = leg.high if leg.sense * (target + begun[VALUE] - leg.low) > 0.0 else leg.low
                if abs(target + begun[VALUE] - edge) <= 1e-12 * max(1.0, abs(edge)):
                    ended[VALUE] = edge
            else:
                ended[1] = 0.0
            # the last piece ends short of the event by what was refined
            if not self.course.pieces or self.course.pieces[-1].last < t:
                self._close(t, ended, leg.sense)
            return t, ended

    def _exactly(
        self,
        rates: Callable[[float, State], State],
        t: float,
        y: State,
        when: float,
        begun: State,
        leg: FieldLeg,
    ) -> tuple[float, State]:
        """From the beginning of a step to a time within it, without looking beyond."""
        if not when > t:
            return t, y
        solver = self.solvers.solver(rates, t, y, begun, leg, when)
        while solver.status == "running":
            before = solver.t
            message = solver.step()
            self.watch.count(leg, begun, solver, message)
            self._add(before, solver.t, solver.dense_output(), begun, leg.sense)
        return solver.t, solver.y

    def _add(self, first: float, last: float, dense: Any, begun: State, sense: float) -> None:
        def at(times: Array) -> Array:
            states: Array = dense(times) + (begun * _RELATIVE)[:, None]
            return states

        self.course.pieces.append(TrajectoryPiece(first, last, at, sense))

    def _close(self, t: float, ended: State, sense: float) -> None:
        """Bring the last piece to the very end of the leg."""
        self.course.pieces.append(
            TrajectoryPiece(t, t, lambda times: np.repeat(ended[:, None], len(times), axis=1), sense)
        )
