"""Adaptive integration with events: legs between jumps of the loads, standstills, limits, sticking.

A step that leaves its leg, or in which the drive stops, is done again to where that happens, so that none of its
stages sees beyond. Schemes: DOP853 (Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, 1993) and
Radau IIA of order 5 (Hairer, Wanner, II, 1996), both of SciPy; the first gives way to the second where the steps are
held back by stability (the product of step and damping rate stays at the edge of the stable region).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import scipy.integrate

from centrode.dynamics.simulation.course import STATES, VALUE, Course, Ending, Occasion, Piece
from centrode.dynamics.simulation.field import Field, Leg
from centrode.dynamics.simulation.meeting import arrived, first_event, loosening
from centrode.dynamics.simulation.solvers import Solvers
from centrode.dynamics.simulation.watching import MOST_STEPS, Until, Watch
from centrode.errors import MotionError
from centrode.locale import _

Array: TypeAlias = npt.NDArray[np.float64]
State: TypeAlias = Array

MOST_IDLE = 100
"""Legs in succession in which no time passes."""
AT_END = 1e-9
"""Distance from a limit, in units of the drive, that counts as there."""

_RELATIVE = np.array([1.0, 0.0, 1.0, 1.0, 1.0])
"""States that count from the beginning of a leg."""


class Stepper:
    """One run of a field from a start."""

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
        self.course = Course(scheme="stiff" if stiff else "adaptive")
        self.watch = Watch(field, until, self.course, stiff, tell, most)
        self.solvers = Solvers(field, self.watch, until.time, tolerance)
        self.sense = self.last = 0.0
        self.idle = 0

    def run(self, value: float, rate: float) -> Course:
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
        tracks = self.field.tracks
        near = AT_END * tracks.unit
        return value >= tracks.high - near if sense > 0.0 else value <= tracks.low + near

    def _way_done(self, state: State) -> bool:
        way = self.until.way
        return way is not None and abs(float(state[VALUE]) - self.start) >= way * (1.0 - 1e-12)

    def _check_headway(self, t: float) -> None:
        """Refuse to go on where leg follows upon leg and no time passes."""
        self.idle = self.idle + 1 if t == self.last else 0
        self.last = t
        if self.idle > MOST_IDLE:
            raise MotionError(
                "[simulation]",
                _("it gets no farther than t = {time:.6g} s: drive or loads change too often there").format(
                    time=t
                ),
                _("correct their formulas"),
            )

    def _note(self, kind: str, t: float, state: State) -> None:
        self.course.occasions.append(Occasion(kind, t, float(state[VALUE])))

    # at rest

    def _rest(self, t: float, state: State) -> float | None:
        """Until when it rests; None where nothing will ever move it, or not before the end."""
        value = float(state[VALUE])
        later = loosening(self.field, value, t, self.until.time) if self.field.of_time else None
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
            Piece(first, last, lambda times: np.repeat(held[:, None], len(times), axis=1), 0.0)
        )

    # in motion

    def _pass(self, leg: Leg, t: float, state: State) -> tuple[float, State]:
        """Go on to the end of a leg, a standstill, or the end of the run."""
        begun, y = state.copy(), state - state * _RELATIVE
        turning = self.field.turns_count
        low, high = leg.low - begun[VALUE], leg.high - begun[VALUE]
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
                if self.watch.stiff and not isinstance(solver, scipy.integrate.Radau):
                    solver = self.solvers.solver(rates, t, y, begun, leg)
                continue
            when, component, target = event
            t, y = self._exactly(rates, before, y_before, when, begun, leg)
            t, y = arrived(rates, t, y, component, target)
            ended = y + begun * _RELATIVE
            if component == VALUE:
                ended[VALUE] = min(max(ended[VALUE], leg.low), leg.high)
                edge = leg.high if leg.sense * (target + begun[VALUE] - leg.low) > 0.0 else leg.low
                if abs(target + begun[VALUE] - edge) <= 1e-12 * max(1.0, abs(edge)):
                    ended[VALUE] = edge
            else:
                ended[1] = 0.0
            if not self.course.pieces or self.course.pieces[-1].last < t:
                self._close(t, ended, leg.sense)
            return t, ended

    def _exactly(
        self, rates: Callable[[float, State], State], t: float, y: State, when: float, begun: State, leg: Leg
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
            found: Array = dense(times) + (begun * _RELATIVE)[:, None]
            return found

        self.course.pieces.append(Piece(first, last, at, sense))

    def _close(self, t: float, ended: State, sense: float) -> None:
        """Bring the last piece to the very end of the leg."""
        self.course.pieces.append(
            Piece(t, t, lambda times: np.repeat(ended[:, None], len(times), axis=1), sense)
        )
