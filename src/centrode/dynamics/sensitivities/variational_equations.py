"""Variational equations of a free motion: how it changes with its start and with the numbers of its mechanism.

Beside everything that is followed stand its derivatives along some directions. Their rates are those of the rates by
the chain rule, and where a step is closed its derivatives are those of what closes it: they are the exact derivatives
of the steps that are taken, as long as these stay the same. (E. Hairer, S. P. Norsett and G. Wanner, Solving Ordinary
Differential Equations I, 2nd ed., 1993, section I.14.)

At events the derivatives jump; see `event_derivatives`. A motion that comes to a change point has none beyond it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import inf
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.forward_dynamics.explicit_steps import ATTEMPTS, MOST_STEPS
from centrode.dynamics.forward_dynamics.free_motion import FreeMotion
from centrode.dynamics.forward_dynamics.initial_state import InitialState
from centrode.dynamics.forward_dynamics.motion_problem import CONTROLS, GUARD, LENGTH, PASSED, RATE, TOLERANCE
from centrode.dynamics.forward_dynamics.motion_steps import Event, MotionSteps, Transition
from centrode.dynamics.sensitivities.event_derivatives import (
    ContactNumbers,
    Direction,
    EventChange,
    EventDerivatives,
    Neighbour,
    rests_of,
)
from centrode.errors import MotionError
from centrode.locale import _
from centrode.numerics.expressions import EXPRESSIONS, Node, as_node, variable
from centrode.numerics.graphs import directional_derivatives
from centrode.numerics.initial_value_problems import (
    BEFORE,
    END,
    HEADER,
    OF_FIFTH,
    OF_THIRD,
    STEP,
    TIME,
    InitialValueProblem,
)
from centrode.numerics.integrators import integrator_of
from centrode.numerics.python_integrations import PythonIntegration
from centrode.numerics.scans import evaluate

Array: TypeAlias = npt.NDArray[np.float64]


CHANGE_TOLERANCE = 1e-11
"""The least share of all changes along a direction by which a step may err: shorter steps would be lost in rounding."""


CHANGE_FLOOR = 1e-6
"""Changes of the motion, where a number changes by its own size, below which errors are not compared with them."""


def change_of(name: str, direction: int) -> str:
    """Name of the derivative of a quantity along a direction."""
    return f"change {direction} of {name}"


def floor_of(direction: int) -> str:
    """Name of what is added to the changes along a direction where an error is compared with them."""
    return f"floor {direction}"


def variational_problem(
    problem: InitialValueProblem,
    directions: Sequence[Sequence[str]],
    compared: Sequence[tuple[str, Node | float]] = (),
) -> InitialValueProblem:
    """The problem with derivatives of all that is followed along some directions.

    Parameters
    ----------
    directions : of each direction the parameters that change along it; all that is followed may do
    compared : what is followed whose changes may err by a share of all of them, and the unit of each
    """
    changes = [
        {variable(name): variable(change_of(name, k)) for name in (*problem.unknowns, *parameters)}
        for k, parameters in enumerate(directions)
    ]
    rates, closing = dict(problem.rates), dict(problem.closing)
    of_rates = directional_derivatives(list(problem.rates.values()), changes)
    closed = [name for name in problem.unknowns if name in problem.closing]
    of_closing = directional_derivatives([problem.closing[name] for name in closed], changes)
    for k in range(len(directions)):
        own = zip(problem.unknowns, of_rates[k], strict=True)
        rates |= {change_of(name, k): as_node(x) for name, x in own}
        kept = zip(closed, of_closing[k], strict=True)
        closing |= {change_of(name, k): as_node(x) for name, x in kept}
    further = tuple(change_of(name, k) for k, parameters in enumerate(directions) for name in parameters)
    further += tuple(floor_of(k) for k in range(len(directions)))
    error: Node = problem.error
    for k in range(len(directions)):
        error = as_node(EXPRESSIONS.max(error, _error_of_changes(k, compared)))
    return replace(
        problem, parameters=(*problem.parameters, *further), rates=rates, closing=closing, error=error
    )


def _error_of_changes(direction: int, compared: Sequence[tuple[str, Node | float]]) -> Node | float:
    """The error of the changes along a direction, of a step, over what is allowed.

    Where a force has a kink the motion itself hardly errs, and its derivatives jump: steps get short there.
    """
    m = EXPRESSIONS
    fifth: Any = 0.0
    third: Any = 0.0
    scale: Any = variable(floor_of(direction))
    for name, unit in compared:
        change = change_of(name, direction)
        parts = [variable(prefix + change) / unit for prefix in (OF_FIFTH, OF_THIRD)]
        fifth, third = fifth + parts[0] * parts[0], third + parts[1] * parts[1]
        scale = scale + m.max(m.abs(variable(BEFORE + change)), m.abs(variable(change))) / unit
    if not compared:
        return 0.0
    together = fifth + 0.01 * third
    size = m.abs(variable(STEP)) * fifth / m.sqrt(together * float(len(compared)))
    allowed = scale * m.max(variable(TOLERANCE), CHANGE_TOLERANCE)
    return as_node(m.where(m.less(0.0, together), size / allowed, 0.0))


@dataclass(frozen=True)
class ChangedEvent:
    """An event of a motion with its derivatives along k directions, all of them at the event itself, before it.

    Attributes
    ----------
    event : what happened
    time_changes : (k) of its instant
    coordinates, speeds : (coordinates)
    coordinate_changes, speed_changes : (k, coordinates)
    """

    event: Event
    time_changes: Array
    coordinates: Array
    speeds: Array
    coordinate_changes: Array
    speed_changes: Array


@dataclass(frozen=True)
class ChangedMotion:
    """A motion at instants (n) with its derivatives along k directions.

    Attributes
    ----------
    times : (n) [s]
    coordinates, speeds : (n, coordinates)
    coordinate_changes, speed_changes : (n, k, coordinates)
    events : in the order of their instants
    steps : of the motion itself, where it has events; None of a smooth one
    """

    times: Array
    coordinates: Array
    speeds: Array
    coordinate_changes: Array
    speed_changes: Array
    events: tuple[ChangedEvent, ...] = ()
    steps: MotionSteps | None = None


@dataclass(frozen=True)
class VariationalEquations:
    """A free motion with directions along which it may change.

    Attributes
    ----------
    free : the motion
    directions : of each the change of numbers of the equations, by their variables; empty where the start alone changes
    contacts : of each the change of numbers of contacts that the equations do not have; none where these stay
    sizes : of each that of the number along which it goes; 1 where they are left out
    """

    free: FreeMotion
    directions: tuple[Mapping[str, float], ...]
    contacts: tuple[ContactNumbers, ...] = ()
    sizes: tuple[float, ...] = ()

    @cached_property
    def problem(self) -> InitialValueProblem:
        """The motion with its derivatives as an initial value problem."""
        integration, names = self.free.integration, self.free.integration.names
        compared: list[tuple[str, Node | float]] = []
        for coordinate, place, speed in zip(
            self.free.coordinates, names.coordinates, names.speeds, strict=True
        ):
            unit: Node | float = 1.0 if coordinate.kind == "angle" else variable(LENGTH)
            compared += [(place, unit), (speed, unit * variable(RATE))]
        # where something holds is a number that changes at events
        return variational_problem(
            integration.problem, [(*one, *names.held) for one in self.directions], compared
        )

    def motion(
        self,
        start: InitialState,
        changes: Sequence[InitialState],
        times: Array,
        tolerance: float,
        executor: str = "auto",
        duration: float | None = None,
    ) -> ChangedMotion:
        """The motion from a state, and its derivatives from those of the state along each direction.

        Parameters
        ----------
        changes : of each direction the derivatives of coordinates and speeds; those that the closures ask for are taken
        times : (n) [s] that grow
        tolerance : of the error of a step
        duration : of the motion [s]; the last instant by default

        Raises
        ------
        MotionError
            The motion does not get to the last instant, or has no derivatives beyond an event.
        NotComputedYet
            An event is made of what is not followed.
        """
        return _VariedCourse(self, start, tolerance, executor, duration or float(times[-1])).run(
            changes, times
        )


class _VariedCourse:
    """One motion with its derivatives, from event to event."""

    def __init__(
        self,
        equations: VariationalEquations,
        start: InitialState,
        tolerance: float,
        executor: str,
        duration: float,
    ) -> None:
        self.equations, self.start = equations, start
        self.integration = integration = equations.free.integration
        self.problem, self.names = equations.problem, integration.names
        self.rate = integration.rate(start, duration)
        self.own = integration.parameters(duration, tolerance, self.rate)[:, 0]
        held = [0.0] * len(self.names.held)
        changes = [x for one in equations.directions for x in (*one.values(), *held)]
        sizes = equations.sizes or (1.0,) * len(equations.directions)
        floors = [CHANGE_FLOOR / (abs(size) or 1.0) for size in sizes]
        self.parameters = np.concatenate([self.own, changes, floors])[:, None]
        self.take = integrator_of(self.problem, executor)
        self.count = len(integration.problem.unknowns)
        self.steps: MotionSteps | None = None
        if equations.free.equations.has_events:
            self.steps = integration.explicit_steps(start, duration, tolerance, executor)
        self.through = EventDerivatives(
            integration, self.own, self.rate, PythonIntegration(integration.problem).rates
        )

    @cached_property
    def directions(self) -> tuple[Direction, ...]:
        """Directions by the numbers of the problem and of the contacts."""
        known, own = self.integration.problem.parameters, self.equations.contacts
        still = ContactNumbers(*np.zeros((len(ContactNumbers._fields), len(self.names.held))))
        return tuple(
            Direction(
                np.array([one.get(name, 0.0) for name in known]),
                own[k] if own else still,
            )
            for k, one in enumerate(self.equations.directions)
        )

    def _carried_at_start(self, changes: Sequence[InitialState]) -> dict[str, float]:
        """All that is carried at the start, by names."""
        names, base = self.names, self.integration.problem
        carried = dict(zip(base.carried_names, self.integration.carried_values(self.start), strict=True))
        for k, change in enumerate(changes):
            carried |= {change_of(name, k): 0.0 for name in base.unknowns}
            own = (
                *zip(names.coordinates, change.coordinates, strict=True),
                *zip(names.speeds, change.speeds, strict=True),
            )
            carried |= {change_of(name, k): float(x) for name, x in own}
        given = dict(zip(self.problem.parameters, self.parameters[:, 0], strict=True))
        closed = evaluate(self.problem.of_closing, carried | {TIME: 0.0, STEP: 1.0} | given)
        # rotors and their changes are those of the start; so are changes that the closures keep
        for k in range(len(changes)):
            for name in base.unknowns:
                if name not in names.works:
                    carried[change_of(name, k)] = float(closed[change_of(name, k)])
        return carried

    def run(self, changes: Sequence[InitialState], times: Array) -> ChangedMotion:
        """The motion at instants with its derivatives."""
        carried = self._carried_at_start(changes)
        values = [carried[name] for name in self.problem.carried_names]
        size = min(float(times[-1]), 0.01 / self.rate)
        state = np.concatenate([[0.0, size, 0.0, 0.0], values])[:, None]
        rows = np.empty((len(times), len(self.problem.carried_names)))
        events: list[ChangedEvent] = []
        shifts, last, done = [0.0] * len(changes), -inf, 0
        for transition in () if self.steps is None else self.steps.transitions:
            reached = int(np.searchsorted(times, transition.time, side="left"))
            state = self._take_samples(state, times, rows, done, reached)
            done = max(done, reached)
            state = self._integrate_until(state, transition.time)
            again = shifts if transition.time <= last else None
            state, shifts = self._pass_transition(state, transition, again, events)
            last = transition.time
        self._take_samples(state, times, rows, done, len(times))
        return self._changed_motion(times, rows, len(changes), events)

    def _take_samples(self, state: Array, times: Array, rows: Array, begin: int, end: int) -> Array:
        for number in range(begin, end):
            state = self._integrate_until(state, float(times[number]))
            rows[number] = state[HEADER:, 0]
        return state

    def _integrate_until(self, state: Array, time: float) -> Array:
        """The state at an instant, by steps from one before it."""
        self.parameters[CONTROLS.index(END)] = time
        guard = (
            HEADER + self.problem.carried_names.index(GUARD) if GUARD in self.problem.carried_names else None
        )
        attempts = 0
        while float(state[0, 0]) < time:
            before = float(state[0, 0])
            if guard is not None and state.item(guard) >= PASSED:
                # where events are is known already
                state[guard, 0] -= PASSED
            state = self.take.run(self.parameters, state, ATTEMPTS)
            attempts += int(state[2, 0])
            if float(state[0, 0]) == before or attempts > MOST_STEPS:
                what = _("the motion has no derivatives beyond {time:.9g} s").format(time=before)
                raise MotionError(
                    "", what, _("give a shorter time: it comes to a change point or ends there")
                )
        return state

    def _changes(self, state: Array, direction: int) -> Neighbour:
        """Changes along a direction of a state."""
        first = HEADER + self.count * (1 + direction)
        held = [self._held_place(direction, name) for name in self.names.held]
        return Neighbour(state[first : first + self.count, 0].copy(), self.parameters[held, 0].copy())

    def _held_place(self, direction: int, name: str) -> int:
        return self.problem.parameters.index(change_of(name, direction))

    def _pass_transition(
        self,
        state: Array,
        transition: Transition,
        again: Sequence[float] | None,
        events: list[ChangedEvent],
    ) -> tuple[Array, list[float]]:
        """The state behind a transition, and how its instant changes along each direction."""
        state = state.copy()
        found = []
        for k, direction in enumerate(self.directions):
            change = self._changes(state, k)
            one = self.through.through(transition, change, direction, None if again is None else again[k])
            found.append(one)
            first = HEADER + self.count * (1 + k)
            state[first : first + self.count, 0] = one.behind.unknowns
            for name, value in zip(self.names.held, one.behind.held, strict=True):
                self.parameters[self._held_place(k, name), 0] = value
        # the motion itself goes on from where it was found to be
        unknowns = state[HEADER : HEADER + self.count, 0]
        unknowns[:] = transition.behind[1 : 1 + self.count]
        fixed = self.integration.problem.fixed_names
        state[len(state) - len(fixed) :, 0] = transition.behind[1 + self.count :]
        state[0, 0] = transition.time
        events += self._changed_events(transition, found)
        return state, [one.time for one in found]

    def _changed_events(self, transition: Transition, found: Sequence[EventChange]) -> list[ChangedEvent]:
        """The events of a transition with their derivatives."""
        rests, told = rests_of(transition), []
        parts = [self.names.part(kind) for kind in (self.names.coordinates, self.names.speeds)]
        here = transition.before[1:]
        of_each = [np.array([one.at_event.unknowns[part] for one in found]) for part in parts]
        for number, event in enumerate(transition.events):
            place = rests.get(number)
            times = np.array([one.time if place is None else one.rests[place] for one in found])
            told.append(ChangedEvent(event, times, here[parts[0]], here[parts[1]], *of_each))
        return told

    def _changed_motion(
        self, times: Array, rows: Array, directions: int, events: Sequence[ChangedEvent]
    ) -> ChangedMotion:
        def part(wanted: Sequence[str]) -> Array:
            return rows[:, [self.problem.carried_names.index(name) for name in wanted]]

        names = self.names
        return ChangedMotion(
            times, part(names.coordinates), part(names.speeds),
            np.stack([part([change_of(x, k) for x in names.coordinates]) for k in range(directions)], axis=1),
            np.stack([part([change_of(x, k) for x in names.speeds]) for k in range(directions)], axis=1),
            tuple(sorted(events, key=lambda one: one.event.time)), self.steps,
        )  # fmt: skip
