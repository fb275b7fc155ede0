"""Where events of a motion are: ends of steps, shortened until a guard is zero there.

A guard that has passed zero within a step stops the integrator there. The step is taken again from its beginning, with
ends between which the guard is zero: so an event has the error of a step of order 8, and none of an interpolant.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from math import inf
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.forward_dynamics.change_points import Detour
from centrode.dynamics.forward_dynamics.contact_states import ContactStates
from centrode.dynamics.forward_dynamics.contacts import STOP
from centrode.dynamics.forward_dynamics.motion_problem import CONTROLS, GUARD, LIMIT, NEVER, TOLERANCE
from centrode.numerics.initial_value_problems import END, HEADER, SMALLEST
from centrode.numerics.integrators import Integrator
from centrode.numerics.search import zero_between

Array: TypeAlias = npt.NDArray[np.float64]

_END = CONTROLS.index(END)
ROOT = 1e-16
"""Width [s] down to which the instant of an event is sought, as far as digits of the time go."""
LOOKS = 33
"""Instants on a detour around a change point at which guards are looked at."""
HALVINGS = 60


@dataclass(frozen=True)
class EventLocation:
    """Where the first event within a step is.

    Attributes
    ----------
    states : of the motion
    take : the integrator
    """

    states: ContactStates
    take: Integrator

    def locate(self, before: Array, state: Array) -> tuple[Array, frozenset[int]]:
        """The state at the first event between a row before a step and the state behind it, and its guards.

        `before` (1 + carried) has the time first.
        """
        begin, end = float(before[0]), float(state[0, 0])
        passed = np.flatnonzero(state[self.states.guard_places, 0] < 0.0)
        rows = self.states.guard_places[passed]
        start, found, attempt = self._trial
        self._put(start, before)
        ends = self._of_one_step[_END]
        watched = [int(row) for row in rows]
        column, single = found[:, 0], watched[0]
        # both ends are known already
        known = {begin: 1.0, end: min(state.item(row) for row in watched)}

        def at(time: float) -> float:
            value = known.get(time)
            if value is not None:
                return value
            ends[0] = time
            attempt()
            if len(watched) == 1:
                return column.item(single)
            return min(column.item(row) for row in watched)

        low = begin
        if min(before.item(row - HEADER + 1) for row in watched) <= 0.0:
            # a guard that begins at zero rises first, where it does not pass it at once
            low = end
            for _halving in range(HALVINGS):
                low = begin + 0.5 * (low - begin)
                if not low > begin or at(low) > 0.0:
                    break
            else:
                low = begin
            if not low > begin:
                return start.copy(), frozenset(int(k) for k in passed)
        final = end
        if low < end:
            final = zero_between(at, low, end, ROOT)
        if not final > begin:
            return start.copy(), frozenset(int(k) for k in passed)
        ends[0] = final
        attempt()
        if len(watched) == 1:
            return found.copy(), frozenset((int(passed[0]),))
        least = found[rows, 0]
        due = [int(k) for k, value in zip(passed, least, strict=True) if value <= self._due_below(int(k))]
        if not due:
            due = [int(passed[int(np.argmin(least))])]
        return found.copy(), frozenset(due)

    def _due_below(self, number: int) -> float:
        """What of a guard at an event is still that of rounding."""
        guard = self.states.guards[number]
        if guard.kind != STOP:
            return 0.0
        unit = float(self.states.units[guard.number])
        return 1e-14 * unit

    @cached_property
    def _of_one_step(self) -> Array:
        """Parameters of a step that is taken whatever its error."""
        parameters = self.states.parameters.copy()
        parameters[CONTROLS.index(TOLERANCE)] = inf
        parameters[CONTROLS.index(SMALLEST)] = 0.0
        return parameters

    @cached_property
    def _trial(self) -> tuple[Array, Array, Callable[[], None]]:
        """A state, the one behind an attempt from it, and the attempt."""
        count = HEADER + len(self.states.motion.problem.carried_names)
        start, found = np.zeros((count, 1)), np.zeros((count, 1))
        return start, found, self.take.attempt_of(self._of_one_step, start, found)

    def _put(self, state: Array, before: Array) -> None:
        """Put a row (1 + carried) into a state from which one step is to be taken."""
        state[:HEADER, 0] = before[0], inf, 0.0, 0.0
        state[HEADER:, 0] = before[1:]
        state[self.states.places[GUARD]] = 0.0
        limit = self.states.places.get(LIMIT)
        if limit is not None:
            state[limit] = NEVER

    def step_to(self, before: Array, time: float) -> Array:
        """The state at a time, by one step from a row before it."""
        start, found, attempt = self._trial
        self._put(start, before)
        if not time > before[0]:
            return start.copy()
        self._of_one_step[_END] = time
        attempt()
        return found.copy()

    def clear_until(self, detour: Detour, carried: Array) -> float | None:
        """The end of a detour around a change point, or an instant behind the point before which nothing happens [s].

        None where something happens before the change point itself.
        """
        problem, last = self.states.motion.problem, detour.centre
        count = len(problem.unknowns)
        for time in np.linspace(detour.begin, detour.end, LOOKS)[1:]:
            there = [*detour.at(np.array([time]))[:, 0], *carried[count:]]
            closed = self.states.motion.closing_function([float(time), 1.0, *self.states.numbers, *there])
            guards = [closed[row - HEADER] for row in self.states.guard_places]
            if min(guards, default=0.0) < 0.0:
                return last if last > detour.centre else None
            last = float(time)
        return float(detour.end)
