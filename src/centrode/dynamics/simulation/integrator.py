"""Adaptive integration with events: legs between jumps of the loads, standstills, limits, sticking.

A step that leaves its leg, or in which the drive stops, is done again to where that happens, so that none of its
stages sees beyond. Schemes: DOP853 (Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, 1993) and
Radau IIA of order 5 (Hairer, Wanner, II, 1996), both of SciPy; the first gives way to the second where the steps are
held back by stability (the product of step and damping rate stays at the edge of the stable region).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from importlib import import_module
from itertools import pairwise
from math import copysign, isfinite
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.simulation.equation_of_motion import (
    CREEP,
    INERTIA,
    RATE,
    STATES,
    VALUE,
    DriveForces,
    Ending,
    Field,
    FieldLeg,
    Occasion,
    ReducedTrajectory,
    TrajectoryPiece,
    too_far,
    without_value,
)
from centrode.errors import MotionError
from centrode.locale import _
from centrode.numerics.search import bisect, root

# Where a step meets the end of its leg or a standstill, and when a mechanism at rest breaks loose.

State: TypeAlias = npt.NDArray[np.float64]
Array: TypeAlias = State

_integrate = partial(import_module, "scipy.integrate")  # off the path of commands that simulate nothing
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
    course: ReducedTrajectory
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
        kind = _integrate().Radau if self.watch.stiff else _integrate().DOP853
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
        self.course = ReducedTrajectory(scheme="stiff" if stiff else "adaptive")
        self.watch = Watch(field, until, self.course, stiff, tell, most)
        self.solvers = Solvers(field, self.watch, until.time, tolerance)
        self.sense = self.last = 0.0
        self.idle = 0

    def run(self, value: float, rate: float) -> ReducedTrajectory:
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
                if self.watch.stiff and not isinstance(solver, _integrate().Radau):
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
