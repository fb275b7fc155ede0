"""Steps of the explicit scheme, with the events and change points on the way."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.forward_dynamics.change_point_passage import ChangePointPassage
from centrode.dynamics.forward_dynamics.change_points import Detour, HalfCircles
from centrode.dynamics.forward_dynamics.contact_states import ContactStates, row_of
from centrode.dynamics.forward_dynamics.event_steps import EventWatch
from centrode.dynamics.forward_dynamics.initial_position import units_of
from centrode.dynamics.forward_dynamics.initial_state import InitialState
from centrode.dynamics.forward_dynamics.motion_functions import MotionFunctions
from centrode.dynamics.forward_dynamics.motion_problem import (
    CONTROLS,
    FAR,
    GUARD,
    PASSED,
)
from centrode.dynamics.forward_dynamics.motion_steps import (
    BLOW_UP,
    CHANGE_POINT,
    DURATION,
    NEAR_MISS,
    STEP_SIZE,
    Event,
    MotionSteps,
)
from centrode.locale import _
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.initial_value_problems import END, HEADER, SMALLEST
from centrode.numerics.integrators import Integrator

Array: TypeAlias = npt.NDArray[np.float64]

ROWS, MOST_ROWS = 1024, 65536
"""Steps in one call of the integrator: few at first, as room is made for all of them."""
ATTEMPTS = 200_000
"""Steps tried in one call of the integrator, so that progress is shown between calls."""
MOST_STEPS = 5_000_000
"""Steps of one motion, beyond which it ends."""
WILD = 1e5
"""Displacements over the greatest length, and speeds over those at the start, grow without bound beyond this."""


@dataclass
class ExplicitSteps:
    """One integration by the explicit scheme.

    Attributes
    ----------
    motion : equations of motion as functions
    half_circles : along which change points are passed
    take : the integrator
    duration [s], tolerance : of the error of a step, relative to what moves
    progress : called with the time reached [s]
    kept : rows of what has been reached, (steps, 1 + carried) each
    events, detours : near misses and crossings; pieces of motion around the change points that were passed
    ending : how it ended, and the sentence that tells why; None as long as it goes on
    """

    motion: MotionFunctions
    half_circles: HalfCircles
    take: Integrator
    duration: float
    tolerance: float
    progress: Callable[[float], None] | None = None
    kept: list[Array] = field(default_factory=list)
    events: list[Event] = field(default_factory=list)
    detours: list[Detour] = field(default_factory=list)
    ending: tuple[str, str | None] | None = None
    _watch: EventWatch | None = None
    _attempts: int = 0
    _steps: int = 0
    _room: int = ROWS
    _rows: Array = field(default_factory=lambda: np.empty((0, 0)))

    def run(self, start: InitialState) -> MotionSteps:
        """The steps from a state."""
        motion = self.motion
        rate = motion.rate(start, self.duration)
        parameters = motion.parameters(self.duration, self.tolerance, rate)
        first = min(self.duration, 0.01 / rate)
        state = np.concatenate([[0.0, first, 0.0, 0.0], motion.carried_values(start)])[:, None]
        if motion.equations.has_events:
            self._watch = EventWatch(ContactStates(motion, parameters, rate), self.take)
            state = self._watch.begin(state)
        self.kept = [np.concatenate([[0.0], state[HEADER:, 0]])[None]]
        passage = ChangePointPassage(motion, self.half_circles, self.take, parameters, rate, self.tolerance)
        while float(state[0, 0]) < self.duration and self.ending is None:
            state = self._advance(state, passage)
        return self._result()

    def _advance(self, state: Array, passage: ChangePointPassage) -> Array:
        """The state behind one call of the integrator, and what stopped it."""
        watch, parameters = self._watch, passage.parameters
        pause = self.duration if watch is None else watch.next_release(float(state[0, 0]), self.duration)
        state = self._take_steps(parameters, state, pause)
        time, size = float(state[0, 0]), float(state[1, 0])
        if self.progress is not None:
            self.progress(time)
        if watch is not None and state[self._guard, 0] >= PASSED:
            return self._pass_event(watch, state)
        if watch is not None and time >= pause and pause < self.duration:
            state = watch.release(state, time)
            self.kept.append(row_of(state)[None])
            if watch.ending[1] is not None:
                self.ending = watch.ending
            return state
        if time >= self.duration:
            return state
        if self._guard is not None and state[self._guard, 0] != 0.0:
            return self._pass_change_point(passage, state)
        self._check_progress(state, passage.rate, size > parameters[CONTROLS.index(SMALLEST), 0])
        self._room = min(4 * self._room, MOST_ROWS)
        return state

    @cached_property
    def _guard(self) -> int | None:
        """Place in a state of what stops the steps."""
        problem = self.motion.problem
        return HEADER + problem.carried_names.index(GUARD) if problem.guard else None

    def _take_steps(self, parameters: Array, state: Array, end: float) -> Array:
        """The state behind steps up to a time, or to what stops them; they are kept."""
        if not len(self._rows):
            self._rows = np.empty((self._room, len(self.kept[0][0])))
        parameters[CONTROLS.index(END), 0] = end
        state = self.take.run(parameters, state, ATTEMPTS, self._rows)
        self._attempts += int(state[2, 0])
        written = int(state[3, 0])
        self._steps += written
        self.kept.append(self._rows[:written])
        self._rows = self._rows[written:]
        return state

    def _pass_event(self, watch: EventWatch, state: Array) -> Array:
        """The state behind the first event within the last step, which is taken again."""
        time, size = float(state[0, 0]), float(state[1, 0])
        self.kept[-1] = self.kept[-1][:-1]
        before = next(some[-1] for some in reversed(self.kept) if len(some))
        row, state, ends = watch.pass_event(before, state, max(size, 0.5 * (time - before[0])))
        self.kept += [row[None], row_of(state)[None]]
        if ends:
            self.ending = watch.ending
        return state

    def _pass_change_point(self, passage: ChangePointPassage, state: Array) -> Array:
        """The state behind the change point ahead, or the same where there is none."""
        back = passage.step_back(state, self.kept, self.detours)
        passed = passage.lead_on(state if back is None else back[0], self._watch)
        if back is not None and not isinstance(passed, str) and passed[0] is not None:
            state, self.kept = back
        elif back is not None:
            passed = passage.lead_on(state, self._watch)
        if isinstance(passed, str):
            self.ending = CHANGE_POINT, passed
            return state
        detour, event = passed
        if event is not None and event.kind == NEAR_MISS:
            # looked at again and again on the way there, it is one
            self.events = [
                one
                for one in self.events
                if one.kind != NEAR_MISS or abs(one.time - event.time) > FAR / passage.rate
            ]
        self.events += [event] if event is not None else []
        if detour is not None:
            self.detours.append(detour)
            self.kept.append(np.concatenate([[float(state[0, 0])], state[HEADER:, 0]])[None])
        return state

    def _check_progress(self, state: Array, rate: float, goes_on: bool) -> None:
        """End what grows without bound, whose steps become too small, or which takes too many."""
        away = self._farthest(state, rate)
        if away > WILD:
            self.ending = BLOW_UP, self._wild_cause(state, away)
        elif not goes_on:
            kind = STEP_SIZE if np.all(np.isfinite(state)) else BLOW_UP
            cause = _(
                "at {time:.9g} s the step became as small as {step:.3g} s; {part} changes its speed fastest there"
            )
            part = self._fastest(state)
            self.ending = kind, cause.format(time=float(state[0, 0]), step=float(state[1, 0]), part=part)
        elif self._steps >= MOST_STEPS:
            self.ending = STEP_SIZE, _("more than {count} steps").format(count=MOST_STEPS)

    def _result(self) -> MotionSteps:
        """What was reached, with everything that happened up to there."""
        watch, events = self._watch, self.events
        if watch is not None:
            reached = float(self.kept[-1][-1, 0]) if len(self.kept[-1]) else self.duration
            told = [one for one in watch.events if one.time <= reached]
            events = sorted([*events, *told], key=lambda one: one.time)
        changed = () if watch is None else tuple(watch.transitions)
        ended, cause = self.ending or (DURATION, None)
        rows = np.concatenate(self.kept).T
        return MotionSteps(rows, ended, cause, self._attempts, tuple(events), tuple(self.detours), changed)

    def _wild_cause(self, state: Array, away: float) -> str:
        """What has grown without bound, and the load that gives it most power."""
        names, tree = self.motion.names, self.motion.equations.tree
        q, w = (list(state[HEADER:, 0][names.part(kind)]) for kind in (names.coordinates, names.speeds))
        with np.errstate(all="ignore"):
            terms = self.motion.equations.terms(ARRAYS, tree.values(ARRAYS, q), w, float(state[0, 0]))
        sizes = np.abs(w) / units_of(tree, self.motion.equations.numbers)
        cause = _("at {time:.9g} s {part} had moved {far:.3g} times the greatest length or as fast as that")
        part = tree.coordinates[int(np.argmax(np.nan_to_num(sizes, nan=np.inf)))].name
        cause = cause.format(time=float(state[0, 0]), part=part, far=away)
        powers = [float(power) for power in terms.powers]
        if not powers or not max(powers) > 0.0:
            return cause
        load = self.motion.equations.loads[int(np.argmax(powers))].label
        return f"{cause}; " + _("the load that gives most power is {load}").format(load=load)

    def _fastest(self, state: Array) -> str:
        """Name of the coordinate whose speed changes most, or is the greatest."""
        names, tree = self.motion.names, self.motion.equations.tree
        q, w = (list(state[HEADER:, 0][names.part(kind)]) for kind in (names.coordinates, names.speeds))
        with np.errstate(all="ignore"):
            terms = self.motion.equations.terms(ARRAYS, tree.values(ARRAYS, q), w, float(state[0, 0]))
            accelerations = np.array(self.motion.equations.accelerations(ARRAYS, terms)[0], dtype=np.float64)
        sizes = np.abs(accelerations) / units_of(tree, self.motion.equations.numbers)
        return tree.coordinates[int(np.argmax(np.nan_to_num(sizes, nan=np.inf)))].name

    def _farthest(self, state: Array, rate: float) -> float:
        """The greatest displacement over the greatest length, or speed over what speeds are compared with."""
        names, units = self.motion.names, units_of(self.motion.equations.tree, self.motion.equations.numbers)
        values = np.abs(state[HEADER:, 0])
        slid = np.array([one.kind != "angle" for one in self.motion.equations.tree.coordinates])
        moved = values[names.part(names.coordinates)] / units
        fast = values[names.part(names.speeds)] / units / rate
        return float(max(np.max(moved[slid], initial=0.0), 1e-3 * np.max(fast, initial=0.0)))
