"""Events of a motion: found by shortened steps of the integrator itself, and what the modes are behind them.

A guard that has passed zero within a step stops the integrator there. The step is taken again from its beginning, with
ends between which the guard is zero: so an event has the error of a step of order 8, and none of an interpolant. Then
impulses follow from the masses that the contacts feel, and what sticks, slips, rests or opens from forces within
bounds. (F. Pfeiffer and C. Glocker, Multibody Dynamics with Unilateral Contacts, 1996, chapters 5 and 8.)
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from math import inf, isnan, nan
from types import MappingProxyType
from typing import Any, NamedTuple, Protocol, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.forward_dynamics.bounded_forces import forces_within, impulses_of_impact
from centrode.dynamics.forward_dynamics.change_points import Detour
from centrode.dynamics.forward_dynamics.contacts import (
    AT_LEAST,
    AT_MOST,
    CLAMP,
    COMPLIANT,
    FRICTION,
    STOP,
    Contact,
    ContactMode,
    pressed_numbers,
)
from centrode.dynamics.forward_dynamics.elimination import Vector
from centrode.dynamics.forward_dynamics.equations_of_motion import (
    IMPLIED,
    EquationsOfMotion,
    MassSystem,
    Terms,
)
from centrode.dynamics.forward_dynamics.motion_problem import (
    CONDITION,
    CONTROLS,
    GUARD,
    INDEPENDENCE,
    LIMIT,
    NEVER,
    PRESSES,
    ROUNDING,
    TOLERANCE,
    UNIQUE,
    Guard,
    MotionNames,
    guards_of,
    modes_of,
)
from centrode.dynamics.forward_dynamics.motion_steps import (
    AMBIGUOUS,
    CLOSES,
    CONDITION_ENDS,
    CONDITION_MET,
    IMPACT,
    LEAVES,
    LETS_GO,
    OPENS,
    RESTS,
    SLIPS,
    STICKS,
    TOUCHES,
    Event,
    ImpactRecord,
    Transition,
)
from centrode.dynamics.forward_dynamics.pressed_modes import (
    FrictionLimits,
    JointPresses,
    response_with_held,
)
from centrode.dynamics.load_coordinates import Turn
from centrode.errors import InputError, MotionError
from centrode.locale import _
from centrode.numerics.expressions import EXPRESSIONS, as_node, variable
from centrode.numerics.graphs import Graph
from centrode.numerics.initial_value_problems import (
    END,
    HEADER,
    SMALLEST,
    TIME,
    InitialValueProblem,
)
from centrode.numerics.integrators import Integrator
from centrode.numerics.python_functions import Function, python_function
from centrode.numerics.search import zero_between

Array: TypeAlias = npt.NDArray[np.float64]

_END = CONTROLS.index(END)
ROOT = 1e-16
"""Width [s] down to which the instant of an event is sought, as far as digits of the time go."""
TOUCHING = 1e-10
"""A gap below this share of the greatest length is closed, a speed below this share of the usual one is none."""
VANISHES = 0.01
"""A reaction without friction below this share of that with it may be of either sign where both are lost."""
TURNING = 1e-8
"""An acceleration above this share of the usual one is none of rounding."""
ACCUMULATED = 2e-5
"""Impacts that end within this share of the usual time are taken together."""
SOON = 1e-3
"""Share of the usual time after which the side of a condition that begins at zero is looked at."""
LOOKS = 33
"""Instants on a detour around a change point at which guards are looked at."""
HALVINGS = 60
AT_THE_LIMIT = 1e-6
"""What holds is at its limit where its event says so and this share is not missing."""
ROUNDS, SETTLED = 200, 1e-13
"""Rounds in which modes and bounds of friction by coefficients settle, to this share of the greatest."""
MOST_AT_ONCE = 100
"""Events one after the other at the same instant, beyond which none of them leads on."""


class ContactForces(NamedTuple):
    """What contacts feel at one state.

    Attributes
    ----------
    values, speeds : of their coordinates (contacts)
    forwards, backwards : forces that they would have if they slipped
    free : accelerations of the rows (rows) without forces in them
    loose : what their own forces would add if no closure held (rows)
    mobility : (rows, rows), accelerations of the rows by forces along them
    shifts : (coordinates, rows), changes of the speeds by impulses along the rows
    reactions : (kept drives, rows), impulses of kept drives by impulses along the rows
    rates : of the kept drives
    conditions : values of the user's events
    presses : reactions of joints with friction by coefficients
    is_late : whether speeds alone are those behind an impact, and forces and accelerations still those before it
    limits : bounds of friction by coefficients, where its forces are known
    """

    values: Array
    speeds: Array
    forwards: Array
    backwards: Array
    free: Array
    loose: Array
    mobility: Array
    shifts: Array
    reactions: Array
    rates: Array
    conditions: Array
    presses: JointPresses
    is_late: bool = False
    limits: Mapping[int, FrictionLimits] = MappingProxyType({})

    def with_limits(self, limits: Mapping[int, FrictionLimits]) -> ContactForces:
        """The same with bounds of friction by coefficients."""
        forwards, backwards = self.forwards.copy(), self.backwards.copy()
        for k, one in limits.items():
            forwards[k], backwards[k] = one.forwards, one.backwards
        return self._replace(forwards=forwards, backwards=backwards, limits=limits)


def contact_function(
    equations: EquationsOfMotion, names: MotionNames, problem: InitialValueProblem
) -> Function:
    """What contacts feel, as a function of time, parameters and what is carried."""
    m, tree = EXPRESSIONS, equations.tree
    modes = [
        # friction that slips is a force of its own here, what is closed has none
        ContactMode(mode.active if contact.kind == COMPLIANT else 0.0, 0.0, 0.0)
        for contact, mode in zip(equations.contacts, modes_of(names, variable) or (), strict=True)
    ]
    values = tree.values(m, [variable(name) for name in names.coordinates])
    speeds = [variable(name) for name in names.speeds]
    terms = equations.terms(m, values, speeds, variable(TIME), modes, [variable(x) for x in names.states])
    count = equations.equations
    rows, bias = terms.rows[count:], terms.bias[count:]
    system = equations.system(m, terms.without_contacts(count))
    moved, _forces = system.solve(system.force, terms.bias[:count])
    still = [0.0] * count
    outputs: dict[str, Any] = {}
    for k, one in enumerate(terms.measures):
        outputs |= {f"value {k}": one.value, f"speed {k}": one.speed}
        outputs |= {f"forwards {k}": one.forwards, f"backwards {k}": one.backwards}
    for i, row in enumerate(rows):
        outputs[f"free {i}"] = _product(row, moved) + bias[i]
        alone = system.mass.forward(row)
        outputs[f"loose {i}"] = system.mass.product(alone, alone)
        shift, forces = system.solve(row, still)
        outputs |= {f"mobility {i} {j}": _product(other, shift) for j, other in enumerate(rows)}
        outputs |= {f"shift {i} {k}": shift.get(k, 0.0) for k in range(equations.size)}
        first = count - len(equations.kept)
        outputs |= {f"reaction {i} {k}": forces.get(first + k, 0.0) for k in range(len(equations.kept))}
    outputs |= {f"rate {k}": rate for k, rate in enumerate(terms.rates)}
    outputs |= {f"condition {k}": value for k, value in enumerate(terms.conditions)}
    outputs |= _press_outputs(equations, terms, system, (moved, _forces))
    graph = Graph({name: as_node(x) for name, x in outputs.items()})
    return python_function(graph, [TIME, *problem.parameters, *problem.carried_names])


def _press_outputs(
    equations: EquationsOfMotion, terms: Terms, system: MassSystem, free: tuple[Vector, Vector]
) -> dict[str, Any]:
    """Reactions of joints with friction by coefficients, without forces of contacts and by each of these."""
    count = equations.equations
    still = [0.0] * count
    responses = [
        (number, system.solve(terms.rows[row], still)) for row, number in equations.contact_rows
    ] if terms.openings else []  # fmt: skip
    outputs: dict[str, Any] = {}
    for k, ways in terms.openings.items():
        for j in range(2):
            own = ways[j] if j < len(ways) else None
            outputs[f"press {k} {j}"] = 0.0 if own is None else own.reaction(*free)
            for i, response in responses:
                outputs[f"gain {k} {j} {i}"] = 0.0 if own is None else own.response(i, *response)
    return outputs


def row_of(state: Array) -> Array:
    """The time and what is carried (1 + carried) of a state of one motion."""
    row = state[HEADER - 1 :, 0].copy()
    row[0] = state[0, 0]
    return row


class WatchedMotion(Protocol):
    """What finding events needs of a motion: its equations, their initial value problem, and functions of a state."""

    @property
    def equations(self) -> EquationsOfMotion:
        """The equations with their numbers."""

    @property
    def names(self) -> MotionNames:
        """Names of what is carried from step to step."""

    @property
    def problem(self) -> InitialValueProblem:
        """The initial value problem."""

    @property
    def contact_function(self) -> Function:
        """What contacts feel at one state."""

    @property
    def closing_function(self) -> Function:
        """What a state ends with behind an event."""


@dataclass
class EventWatch:
    """Finds events of one motion, and sets the modes behind them.

    Attributes
    ----------
    integration : the motion whose steps are taken
    take : the integrator
    parameters : (parameters, 1) of its steps
    rate : what speeds are compared with [1/s]
    events : what has happened
    transitions : where modes may have changed, the start first
    ending : why what ends the motion does so, and the sentence that tells it
    """

    integration: WatchedMotion
    take: Integrator
    parameters: Array
    rate: float
    events: list[Event] = field(default_factory=list)
    transitions: list[Transition] = field(default_factory=list)
    _impact_now: ImpactRecord | None = None
    ending: tuple[str, str | None] = (CONDITION_ENDS, None)
    _at_once: int = 0
    _last: float = -inf

    @cached_property
    def contacts(self) -> tuple[Contact, ...]:
        """Contacts with their numbers."""
        return self.integration.equations.contacts

    @cached_property
    def guards(self) -> tuple[Guard, ...]:
        """Guards in their order."""
        return guards_of(self.integration.equations)

    @cached_property
    def _rows(self) -> dict[int, int]:
        """Number of a contact -> its row among those of contacts."""
        rows = self.integration.equations.contact_rows
        return {number: row - rows[0][0] for row, number in rows}

    @cached_property
    def _pressed_contacts(self) -> tuple[int, ...]:
        """Numbers of the contacts with friction by coefficients."""
        return pressed_numbers(self.contacts)

    @cached_property
    def _places(self) -> dict[str, int]:
        """Place of what is carried in a state."""
        return {name: HEADER + k for k, name in enumerate(self.integration.problem.carried_names)}

    @cached_property
    def _mode_places(self) -> dict[str, list[int]]:
        """Places in a state of what tells the modes, contact by contact."""
        names = self.integration.names
        told = {"active": names.active, "sense": names.senses, "held": names.held}
        found = {what: [self._places[one] for one in of_each] for what, of_each in told.items()}
        for what in ("first", "second"):
            named = [f"{what} {k}" for k in range(len(self.contacts))]
            found[what] = [self._places.get(name, -1) for name in named]
        return found

    @cached_property
    def _work_places(self) -> list[int]:
        """Places in a state of the works, those of contacts last."""
        return [self._places[name] for name in self.integration.names.works]

    @cached_property
    def _releases(self) -> list[float]:
        """Instants at which clamps let go [s]."""
        return [c.until for c in self.contacts if c.kind == CLAMP and isinstance(c.until, float)]

    @cached_property
    def _guard_rows(self) -> Array:
        return np.array([self._places[name] for name in self.integration.names.guards], dtype=np.intp)

    @cached_property
    def units(self) -> Array:
        """What coordinates of contacts are compared with: 1 rad, or the greatest length."""
        scale = float(self.integration.equations.numbers.scale)
        return np.array([1.0 if isinstance(c.coordinate, Turn) else scale for c in self.contacts])

    @cached_property
    def _numbers(self) -> list[float]:
        return [float(x) for x in self.parameters[:, 0]]

    def felt_at(self, row: Array) -> ContactForces:
        """What contacts feel at a row (1 + carried), the time first."""
        return self._feel(float(row[0]), row[1:].tolist())

    def _feel(self, time: float, carried: Sequence[float]) -> ContactForces:
        equations = self.integration.equations
        found = self.integration.contact_function([time, *self._numbers, *carried])
        count, rows, size, kept = (
            len(self.contacts),
            len(self._rows),
            equations.size,
            len(equations.kept),
        )
        numbers = np.array(found, dtype=np.float64)
        own = numbers[: 4 * count].reshape(count, 4)
        width = 2 + rows + size + kept
        by_row = numbers[4 * count : 4 * count + rows * width].reshape(rows, width)
        rest = numbers[4 * count + rows * width :]
        conditions = len(equations.conditions)
        pressed = rest[kept + conditions :].reshape(len(self._pressed_contacts), 2, 1 + rows)
        presses = JointPresses(
            self._pressed_contacts,
            tuple(self.contacts[k] for k in self._pressed_contacts),
            pressed[:, :, 0],
            pressed[:, :, 1:],
        )
        return ContactForces(
            own[:, 0], own[:, 1], own[:, 2], own[:, 3], by_row[:, 0], by_row[:, 1], by_row[:, 2 : 2 + rows],
            by_row[:, 2 + rows : 2 + rows + size].T, by_row[:, 2 + rows + size :].T,
            rest[:kept], rest[kept : kept + conditions], presses,
        )  # fmt: skip

    # the start

    def begin(self, state: Array) -> Array:
        """The state at the start with its modes.

        Raises InputError where a stop is violated there, or what is clamped moves.
        """
        carried = [float(x) for x in state[HEADER:, 0]]
        before = row_of(state)
        felt = self._feel(float(state[0, 0]), carried)
        for k, contact in enumerate(self.contacts):
            value, tolerance = float(felt.values[k]), TOUCHING * self.units[k]
            for bound, sign in ((contact.least, -1.0), (contact.most, 1.0)):
                if bound is not None and sign * (bound - value) < -tolerance:
                    what = _("it is at {value:.9g} at the start, beyond its bound {bound:.9g}")
                    repair = _("move the start, or correct the bound")
                    where = f"[[stops]] {contact.label}"
                    raise InputError(where, what.format(value=value, bound=bound), repair)
            if contact.kind == CLAMP:
                if abs(float(felt.speeds[k])) > TOUCHING * self.units[k] * self.rate:
                    what = _("it moves at the start, and is clamped")
                    raise InputError(
                        f"[[clamps]] {contact.label}", what, _("give it no speed, or remove the clamp")
                    )
                self._set(state, "active", k, 1.0)
                self._set(state, "held", k, value)
        started = self._behind(state, frozenset())
        if self.ending[1] is not None:
            repair = _("give smaller coefficients, or the value of the friction")
            raise MotionError("[[loads]]", self.ending[1], repair)
        if self.integration.names.sides:
            # what begins at zero is on the side to which it goes
            row = np.concatenate([started[:1, 0], started[HEADER:, 0]])
            soon = self._step_to(row, float(row[0]) + SOON / self.rate)
            later = self._feel(float(soon[0, 0]), soon[HEADER:, 0].tolist()).conditions
            for k, value in enumerate(felt.conditions):
                side = float(np.sign(value if abs(value) > ROUNDING else later[k])) or 1.0
                started[self._places[self.integration.names.sides[k]], 0] = side
        self._record(before, started, frozenset(), 0)
        return started

    def _record(self, before: Array, behind: Array, due: frozenset[int], told: int) -> None:
        """Keep a transition, whose events are those behind the first `told` ones."""
        noted = tuple(self.events[told:])
        self.transitions.append(Transition(before, row_of(behind), due, self._impact_now, noted))

    def _set(self, state: Array, what: str, number: int, value: float) -> None:
        state[self._mode_places[what][number], 0] = value

    def _get(self, state: Array, what: str, number: int) -> float:
        return state.item(self._mode_places[what][number])

    # where it is

    def locate(self, before: Array, state: Array) -> tuple[Array, frozenset[int]]:
        """The state at the first event between a row before a step and the state behind it, and its guards.

        `before` (1 + carried) has the time first.
        """
        begin, end = float(before[0]), float(state[0, 0])
        passed = np.flatnonzero(state[self._guard_rows, 0] < 0.0)
        rows = self._guard_rows[passed]
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
        guard = self.guards[number]
        if guard.kind != STOP:
            return 0.0
        unit = float(self.units[guard.number])
        return 1e-14 * unit

    @cached_property
    def _of_one_step(self) -> Array:
        """Parameters of a step that is taken whatever its error."""
        parameters = self.parameters.copy()
        parameters[CONTROLS.index(TOLERANCE)] = inf
        parameters[CONTROLS.index(SMALLEST)] = 0.0
        return parameters

    @cached_property
    def _trial(self) -> tuple[Array, Array, Callable[[], None]]:
        """A state, the one behind an attempt from it, and the attempt."""
        count = HEADER + len(self.integration.problem.carried_names)
        start, found = np.zeros((count, 1)), np.zeros((count, 1))
        return start, found, self.take.attempt_of(self._of_one_step, start, found)

    def _put(self, state: Array, before: Array) -> None:
        """Put a row (1 + carried) into a state from which one step is to be taken."""
        state[:HEADER, 0] = before[0], inf, 0.0, 0.0
        state[HEADER:, 0] = before[1:]
        state[self._places[GUARD]] = 0.0
        limit = self._places.get(LIMIT)
        if limit is not None:
            state[limit] = NEVER

    def _step_to(self, before: Array, time: float) -> Array:
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
        problem, last = self.integration.problem, detour.centre
        count = len(problem.unknowns)
        for time in np.linspace(detour.begin, detour.end, LOOKS)[1:]:
            there = [*detour.at(np.array([time]))[:, 0], *carried[count:]]
            closed = self.integration.closing_function([float(time), 1.0, *self._numbers, *there])
            guards = [closed[row - HEADER] for row in self._guard_rows]
            if min(guards, default=0.0) < 0.0:
                return last if last > detour.centre else None
            last = float(time)
        return float(detour.end)

    # what follows

    def pass_event(self, before: Array, state: Array, size: float) -> tuple[Array, Array, bool]:
        """The row at an event, the state behind it, and whether it ends the motion.

        Parameters
        ----------
        before : (1 + carried), the row before the step within which it is
        state : behind that step
        size : of the next step
        """
        found, due = self.locate(before, state)
        time = float(found[0, 0])
        self._at_once = self._at_once + 1 if time <= self._last else 0
        self._last = time
        if self._at_once > MOST_AT_ONCE:
            what = _("at {time:.9g} s events follow one another without end").format(time=time)
            raise MotionError("[simulation]", what, _("look at the stops and frictions there"))
        row, ends, told = row_of(found), False, len(self.events)
        for number in due:
            guard = self.guards[number]
            if guard.kind == CONDITION:
                ends = self._meet_condition(found, guard.number) or ends
        if any(self.guards[number].kind == UNIQUE for number in due):
            self.ending = (AMBIGUOUS, self._ambiguity(found))
            return row, found, True
        behind = self._behind(found, due)
        behind[1, 0] = size
        self._record(row, behind, due, told)
        return row, behind, ends or self.ending[0] == AMBIGUOUS

    def _meet_condition(self, state: Array, number: int) -> bool:
        condition = self.integration.equations.conditions[number]
        place = self._places[self.integration.names.sides[number]]
        time = float(state[0, 0])
        self.events.append(Event(time, CONDITION_MET, nan, condition.label))
        state[place] = -state[place]
        for k, contact in enumerate(self.contacts):
            if contact.kind == CLAMP and contact.until == condition.label:
                self.let_go(state, k)
        return condition.ends

    def let_go(self, state: Array, number: int) -> None:
        """Open a clamp."""
        if self._get(state, "active", number):
            self._set(state, "active", number, 0.0)
            self.events.append(Event(float(state[0, 0]), LETS_GO, nan, self.contacts[number].label))

    def next_release(self, time: float, end: float) -> float:
        """The next instant at which a clamp lets go, or the end [s]."""
        return min([one for one in self._releases if time < one < end], default=end)

    def release(self, state: Array, time: float) -> Array:
        """The state behind the instant at which clamps let go."""
        before, told = row_of(state), len(self.events)
        for k, contact in enumerate(self.contacts):
            if contact.kind == CLAMP and isinstance(contact.until, float) and contact.until <= time:
                self.let_go(state, k)
        behind = self._behind(state, frozenset())
        self._record(before, behind, frozenset(), told)
        return behind

    def _behind(self, state: Array, due: frozenset[int]) -> Array:
        """The state with speeds behind impacts, and modes that fit its forces."""
        state = state.copy()
        time = float(state[0, 0])
        self._impact_now = None
        guards = [self.guards[k] for k in due]
        # a stop that has been pressed opens, a contact that has stuck slips
        let_go = {
            guard.number
            for guard in guards
            if guard.kind in (STOP, FRICTION) and self._get(state, "active", guard.number)
        }
        # a flight that is too low to be told from rounding is none
        grounded = {guard.number for guard in guards if guard.kind == STOP} if self._at_once > 1 else set()
        felt = self._impact(state, self._feel(time, state[HEADER:, 0].tolist()), grounded)
        for guard in guards:
            contact = self.contacts[guard.number] if guard.kind == STOP else None
            if contact is not None and contact.kind == COMPLIANT:
                pressed = self._get(state, "active", guard.number) != 0.0
                self._set(state, "active", guard.number, 0.0 if pressed else guard.bound)
                kind = LEAVES if pressed else TOUCHES
                self.events.append(Event(time, kind, nan, contact.label))
                felt = self._feel(time, state[HEADER:, 0].tolist())
        comes = {guard.number for guard in guards if guard.kind == FRICTION} - let_go
        turned = {guard.number for guard in guards if guard.kind == PRESSES}
        self._choose_modes(state, felt, let_go, comes, turned)
        return self._closed_state(state)

    def _closed_state(self, state: Array) -> Array:
        """The state with everything that follows from its modes."""
        problem = self.integration.problem
        carried = state[HEADER:, 0].tolist()
        if INDEPENDENCE in problem.carried_names:
            carried[problem.carried_names.index(INDEPENDENCE)] = 0.0
        closed = self.integration.closing_function([float(state[0, 0]), 1.0, *self._numbers, *carried])
        state[HEADER:, 0] = closed
        if any(
            self.guards[k].kind == UNIQUE and state[row, 0] < 0.0 for k, row in enumerate(self._guard_rows)
        ):
            self.ending = (AMBIGUOUS, self._ambiguity(state))
        # what is passed already is none: a guard at zero counts from there on
        rows = self._guard_rows
        state[rows, 0] = np.maximum(state[rows, 0], 0.0)
        if state.item(self._places[GUARD]) >= 2.0:
            state[self._places[GUARD]] -= 2.0
        return state

    # impacts

    def _touching(self, felt: ContactForces, number: int, bound: float) -> bool:
        contact = self.contacts[number]
        level = contact.least if bound < 0.0 else contact.most
        if level is None:
            return False
        return bool(bound * (level - felt.values[number]) <= TOUCHING * self.units[number])

    def _impact(self, state: Array, felt: ContactForces, grounded: set[int]) -> ContactForces:
        """Impulses of stops that are hit, or to which what is `grounded` returns at once; what contacts feel then."""
        hits: dict[int, float] = {}
        holding: dict[int, float] = {}
        for k in self._rows:
            contact = self.contacts[k]
            if contact.kind == CLAMP and self._get(state, "active", k):
                holding[k] = 0.0
            if contact.kind != STOP:
                continue
            for bound in (AT_LEAST, AT_MOST):
                speed = -bound * float(felt.speeds[k])
                slow = TOUCHING * self.units[k] * self.rate
                if not self._touching(felt, k, bound):
                    continue
                if speed < -slow or (k in grounded and speed > slow):
                    hits[k] = bound
                elif speed <= slow:
                    holding[k] = bound
        if not hits:
            return felt
        time, taken = float(state[0, 0]), hits | holding
        numbers = list(taken)
        rows = [self._rows[k] for k in numbers]
        signs = np.array([-taken[k] or 1.0 for k in numbers])
        is_stop = np.array([self.contacts[k].kind == STOP for k in numbers])
        if len(numbers) == 1:
            # one alone, as nearly always: views of it are taken in a fraction of the time
            (k,), (row,) = numbers, rows
            matrix, before = felt.mobility[row : row + 1, row : row + 1], signs * felt.speeds[k : k + 1]
        else:
            matrix = signs[:, None] * felt.mobility[rows][:, rows] * signs
            before = signs * felt.speeds[numbers]
            before[[k not in hits for k in numbers]] = 0.0
        restitution = [self.contacts[k].restitution for k in numbers]
        impulses, after = impulses_of_impact(matrix, before, restitution, is_stop)
        self._apply(state, felt, numbers, signs * impulses, 0.5 * impulses * (before + after))
        settled: dict[int, float] = {}
        if self._bounces(hits, grounded):
            own = slice(rows[0], rows[0] + 1) if len(rows) == 1 else rows
            speeds = felt.speeds + felt.mobility[:, own] @ (signs * impulses)
            behind = felt._replace(speeds=speeds, is_late=True)
        else:
            behind = self._feel(time, state[HEADER:, 0].tolist())
        for k in numbers:
            if k in hits:
                settled[k] = 0.0 if k in grounded else self._rest_of_impacts(state, behind, k, hits[k])
        resting = [place for place, k in enumerate(numbers) if not isnan(settled.get(k, nan))]
        if resting:
            # the rest of infinitely many impacts at once: their sum is that of one without restitution
            now, more = signs * behind.speeds[numbers], np.zeros(len(numbers))
            among = matrix[resting][:, resting]
            more[resting] = np.linalg.lstsq(among, -now[resting], rcond=1e-11)[0]
            then = now + matrix @ more
            self._apply(state, behind, numbers, signs * more, 0.5 * more * (now + then))
            behind = self._feel(time, state[HEADER:, 0].tolist())
        ends = tuple(settled[numbers[place]] for place in resting)
        self._impact_now = ImpactRecord(tuple(numbers), signs, before, after, impulses, tuple(resting), ends)
        for place, k in enumerate(numbers):
            if k not in hits and impulses[place] <= 0.0:
                continue
            if self.contacts[k].kind != STOP:
                continue
            lost = -0.5 * float(impulses[place] * (before[place] + after[place]))
            label = self.contacts[k].label
            self.events.append(Event(time, IMPACT, nan, label, float(impulses[place]), lost))
            if not isnan(settled.get(k, nan)):
                self.events.append(Event(time + settled[k], RESTS, nan, label))
                self._set(state, "active", k, taken[k])
        return behind

    def _bounces(self, hits: Iterable[int], grounded: set[int]) -> bool:
        """Whether all that hits flies off whatever forces there are, so that only speeds are needed behind it."""
        has_rows = len(self._rows) == len(self.contacts) and not self._pressed_contacts
        return has_rows and all(self.contacts[k].restitution >= 1.0 and k not in grounded for k in hits)

    def _apply(
        self, state: Array, felt: ContactForces, numbers: Sequence[int], impulses: Array, works: Array
    ) -> None:
        """Change speeds by impulses along rows, and note the works of both."""
        names, rows = self.integration.names, [self._rows[k] for k in numbers]
        first = self._places[names.speeds[0]]
        shifts = felt.shifts[:, rows[0] : rows[0] + 1] if len(rows) == 1 else felt.shifts[:, rows]
        state[first : first + len(names.speeds), 0] += shifts @ impulses
        works_at = self._work_places
        count, kept = len(self.contacts), len(felt.rates)
        driven = len(self.integration.equations.controls)
        for k, work in zip(numbers, works, strict=True):
            state[works_at[len(works_at) - count + k], 0] += work
        if kept:
            given = felt.reactions[:, rows] @ impulses
            for k in range(kept):
                state[works_at[len(works_at) - count - driven - kept + k], 0] -= given[k] * felt.rates[k]

    def _rest_of_impacts(self, state: Array, felt: ContactForces, number: int, bound: float) -> float:
        """Time [s] in which impacts that get ever smaller come to an end; NaN where that is not at once."""
        speed = -bound * float(felt.speeds[number])
        restitution = self.contacts[number].restitution
        if restitution >= 1.0:
            return nan
        if speed <= TOUCHING * self.units[number] * self.rate:
            return 0.0
        free = -bound * self._acceleration(state, felt, number)
        if not free < 0.0:
            return nan
        whole = -2.0 * speed / free / (1.0 - restitution)
        return whole if whole * self.rate < ACCUMULATED else nan

    def acceleration_at(self, row: Array, felt: ContactForces, number: int) -> float:
        """Acceleration of a contact's coordinate at a row (1 + carried) with the forces of all others."""
        return self._acceleration(np.concatenate([np.zeros(HEADER - 1), row])[:, None], felt, number)

    def _acceleration(self, state: Array, felt: ContactForces, number: int) -> float:
        """Acceleration of a contact's coordinate with the forces of all others."""
        held = [k for k in self._rows if k != number and self._get(state, "active", k)]
        right = self._slipping(state, felt)
        row = self._rows[number]
        if not held:
            return float(right[row])
        rows = [self._rows[k] for k in held]
        forces = np.linalg.lstsq(felt.mobility[rows][:, rows], -right[rows], rcond=1e-11)[0]
        return float(right[row] + felt.mobility[row, rows] @ forces)

    def _slipping(self, state: Array, felt: ContactForces) -> Array:
        """Accelerations of the rows with the friction of what slips."""
        forces = np.zeros(len(self._rows))
        for k, row in self._rows.items():
            if self.contacts[k].kind == FRICTION:
                sense = self._get(state, "sense", k)
                forces[row] = felt.forwards[k] if sense > 0.0 else felt.backwards[k] if sense < 0.0 else 0.0
        return felt.free + felt.mobility @ forces

    # modes

    def _choose_modes(
        self,
        state: Array,
        felt: ContactForces,
        let_go: set[int],
        comes: set[int],
        turned: Collection[int] = (),
    ) -> None:
        """What sticks, slips, is closed or opens, by the forces that would hold it.

        What is in `let_go` is at the limit of its force; what is in `comes` has come to rest on its surface. In
        `turned` are sliders that other numbers begin to press.
        """
        held: dict[int, float] = {}
        before = {k: self._get(state, "active", k) for k in self._rows}
        rested: set[int] = set()
        for k in self._rows:
            contact, active = self.contacts[k], before[k]
            slow = TOUCHING * self.units[k] * self.rate
            if contact.kind == CLAMP:
                if active:
                    held[k] = 0.0
            elif contact.kind == FRICTION:
                slip = float(felt.speeds[k]) - contact.drift
                if abs(slip) <= slow or k in comes:
                    held[k] = 0.0
                    if k not in comes:
                        rested.add(k)
                self._set(state, "sense", k, 0.0 if k in held else float(np.sign(slip)))
            else:
                for bound in (AT_LEAST, AT_MOST):
                    opens = active == bound and k in let_go
                    rests = abs(float(felt.speeds[k])) <= slow
                    if rests and not opens and self._touching(felt, k, bound):
                        held[k] = bound
        if held and felt.is_late:
            felt = self._feel(float(state[0, 0]), state[HEADER:, 0].tolist())
        if self._pressed_contacts:
            felt = self._with_limits(state, felt, held, let_go)
        forces = self._held_forces(state, felt, held, let_go) if held else {}
        if self._pressed_contacts:
            self._set_weights(state, felt, forces, turned)
        time = float(state[0, 0])
        for k in self._rows:
            contact, active = self.contacts[k], before[k]
            if contact.kind == FRICTION:
                self._set(state, "active", k, 1.0 if k in forces else 0.0)
                if k in forces and not active:
                    self._set(state, "held", k, float(felt.values[k]) - contact.drift * time)
                # what others hold is at rest too, whatever its own friction does
                stays = k in forces or (k in held and self._is_implied(felt, k, forces))
                was = bool(active) or k in rested
                if stays is not was and time > 0.0:
                    self.events.append(Event(time, STICKS if stays else SLIPS, nan, contact.label))
            elif contact.kind == STOP:
                self._choose_mode_of_stop(state, k, held.get(k, 0.0) if k in forces else 0.0, active)

    def _choose_mode_of_stop(self, state: Array, number: int, bound: float, before: float) -> None:
        contact, time = self.contacts[number], float(state[0, 0])
        self._set(state, "active", number, bound)
        if bound:
            level = contact.least if bound < 0.0 else contact.most
            assert level is not None
            self._set(state, "held", number, float(level))
        if bool(bound) is not bool(before) and (before or time > 0.0):
            self.events.append(Event(time, CLOSES if bound else OPENS, nan, contact.label))

    def _held_forces(
        self,
        state: Array,
        felt: ContactForces,
        held: dict[int, float],
        let_go: set[int],
    ) -> dict[int, float]:
        """Forces of what goes on to be held, by contacts; what slips gets its sense."""
        # what closures hold already needs no force
        fast = {k for k in held if self._follows(felt, self._rows[k], [])}
        if fast:
            # what rests for an instant, as a motion that closures dictate turns round, does not stick
            moved = self._slipping(state, felt)
            for k in [one for one in fast if self.contacts[one].kind == FRICTION]:
                away = float(moved[self._rows[k]])
                if abs(away) > TURNING * self.units[k] * self.rate**2:
                    self._set(state, "sense", k, float(np.sign(away)))
                    fast.remove(k)
                    del held[k]
        held = {k: bound for k, bound in held.items() if k not in fast}
        found = {k: 0.0 for k in fast if self.contacts[k].kind != STOP}
        for k in [one for one in held if one in let_go and self.contacts[one].kind == FRICTION]:
            force = self._force_alone(state, felt, k, held)
            least, most = self._bounds(felt, k)
            near = AT_THE_LIMIT * (most - least)
            if force >= most - near or force <= least + near:
                self._set(state, "sense", k, -1.0 if force >= most - near else 1.0)
                del held[k]
        while held:
            numbers = list(held)
            rows = [self._rows[k] for k in numbers]
            right = self._slipping(state, felt)
            low, high = np.array([self._bounds(felt, k, held[k]) for k in numbers]).T
            forces, rest = forces_within(felt.mobility[rows][:, rows], right[rows], low, high)
            slipping = self._first_to_slip(numbers, forces, rest, (low, high), felt)
            if slipping is None:
                found |= {
                    k: float(force)
                    for k, force in zip(numbers, forces, strict=True)
                    if self.contacts[k].kind != STOP or force != 0.0
                }
                break
            k, sense = slipping
            self._set(state, "sense", k, sense)
            del held[k]
        return found

    # friction by coefficients

    def _row_forces(self, state: Array, felt: ContactForces, held: Mapping[int, float]) -> Array:
        """Forces along rows: those of what is held, and the friction of what slips by its limits."""
        forces = np.zeros(len(self._rows))
        for k, row in self._rows.items():
            if k in held:
                forces[row] = held[k]
            elif self.contacts[k].kind == FRICTION:
                sense = self._get(state, "sense", k)
                forces[row] = felt.forwards[k] if sense > 0.0 else felt.backwards[k] if sense < 0.0 else 0.0
        return forces

    def _with_limits(
        self, state: Array, felt: ContactForces, held: dict[int, float], let_go: set[int]
    ) -> ContactForces:
        """Bounds of friction by coefficients that fit the forces and modes which follow from them."""
        senses = {k: self._get(state, "sense", k) for k in self._rows}
        felt = felt.with_limits(felt.presses.limits(self._present_forces(state, felt)))
        for _round in range(ROUNDS):
            for k, sense in senses.items():
                self._set(state, "sense", k, sense)
            found = self._held_forces(state, felt, dict(held), let_go) if held else {}
            forces = self._settled_forces(state, felt, self._row_forces(state, felt, found), list(found))
            limits = felt.presses.limits(forces)
            apart = max(abs(a - b) for k in limits for a, b in zip(limits[k], felt.limits[k], strict=True))
            size = max(abs(a) for k in limits for a in limits[k])
            felt = felt.with_limits(limits)
            if not apart > SETTLED * size:
                break
        else:
            self.ending = (AMBIGUOUS, self._ambiguity(state))
        for k, sense in senses.items():
            self._set(state, "sense", k, sense)
        return felt

    def _settled_forces(self, state: Array, felt: ContactForces, forces: Array, held: Sequence[int]) -> Array:
        """Forces along rows with friction by coefficients of what slips as great as what presses."""
        slips = {
            k: (self._rows[k], self._get(state, "sense", k)) for k in self._pressed_contacts if k not in held
        }
        slips = {k: (row, sense) for k, (row, sense) in slips.items() if sense}
        return felt.presses.settled_forces(felt.mobility, self._independent(felt, held), forces, slips)

    def _independent(self, felt: ContactForces, numbers: Iterable[int]) -> list[int]:
        """Rows of contacts: of what holds the same thing twice the first bears it, as in the steps."""
        rows: list[int] = []
        for k in numbers:
            if not self._follows(felt, self._rows[k], rows):
                rows.append(self._rows[k])
        return rows

    def _present_forces(self, state: Array, felt: ContactForces) -> Array:
        """Forces along rows in the modes that are still set."""
        active = [k for k in self._rows if self._get(state, "active", k)]
        rows = self._independent(felt, active)
        forces = self._row_forces(state, felt, dict.fromkeys([*active, *self._pressed_contacts], 0.0))
        if rows:
            right = felt.free + felt.mobility @ forces
            forces[rows] -= np.linalg.solve(felt.mobility[rows][:, rows], right[rows])
        return self._settled_forces(state, felt, forces, active)

    def _set_weights(
        self, state: Array, felt: ContactForces, held: Mapping[int, float], turned: Collection[int]
    ) -> None:
        """What presses from here on: signs of normal forces, and directions of the forces of pins."""
        senses = {k: self._get(state, "sense", k) for k in self._pressed_contacts}
        lost = {k: (self._get(state, "first", k), self._get(state, "second", k)) for k in turned}
        weights = felt.presses.weights(self._row_forces(state, felt, held), senses, lost)
        for k, (first, second) in weights.items():
            self._set(state, "first", k, first)
            self._set(state, "second", k, second)

    def _ambiguity(self, state: Array) -> str:
        """The sentence that names the friction which has no or several solutions."""
        time = float(state[0, 0])
        felt = self._feel(time, state[HEADER:, 0].tolist())
        slips = [k for k in self._pressed_contacts if self._get(state, "sense", k)] or list(
            self._pressed_contacts
        )
        held = [self._rows[k] for k in self._rows if self._get(state, "active", k)]
        feedback = felt.presses.feedback(felt.mobility, held, {k: self._rows[k] for k in slips})
        worst = max(feedback, key=lambda k: feedback[k])
        what = _("at {time:.9g} s friction at {contact} may have no or several solutions")
        if len(slips) == 1:
            count = self._solutions(state, felt, worst, held)
            if count == 0:
                what = _("at {time:.9g} s friction at {contact} has no solution from there on")
            elif count is not None:
                what = _("at {time:.9g} s friction at {contact} has several solutions from there on")
        return what.format(time=time, contact=self.contacts[worst].label)

    def _solutions(self, state: Array, felt: ContactForces, number: int, held: Sequence[int]) -> int | None:
        """How many forces of the only friction that slips fit; None where what presses without it vanishes too."""
        presses, rows = felt.presses, list(held)
        forces = np.zeros(len(self._rows))
        if rows:
            forces[rows] = np.linalg.lstsq(felt.mobility[rows][:, rows], -felt.free[rows], rcond=1e-11)[0]
        at = presses.numbers.index(number)
        response = response_with_held(felt.mobility, held, self._rows[number])
        reaction = presses.base[at] + presses.gains[at] @ forces
        sense = self._get(state, "sense", number) or 1.0
        slipping = presses.reactions(self._present_forces(state, felt))[number]
        if np.max(np.abs(reaction)) <= VANISHES * np.max(np.abs(slipping)):
            return None
        return presses.solutions(number, reaction, presses.gains[at] @ response, sense)

    def _bounds(self, felt: ContactForces, number: int, bound: float = 0.0) -> tuple[float, float]:
        """Least and greatest force of a contact that is held."""
        contact = self.contacts[number]
        if contact.kind == CLAMP:
            return -inf, inf
        if contact.kind == STOP:
            # pushed down from a bound above, up from one below
            return (-inf, 0.0) if bound > 0.0 else (0.0, inf)
        if number in felt.limits:
            return felt.limits[number].least, felt.limits[number].most
        least, most = sorted((float(felt.forwards[number]), float(felt.backwards[number])))
        if contact.static is not None:
            least, most = min(-float(contact.static), least), max(float(contact.static), most)
        return least, most

    def _force_alone(self, state: Array, felt: ContactForces, number: int, held: dict[int, float]) -> float:
        """The force of a contact where others that hold the same thing leave everything to it, as the steps do."""
        rows, right = [self._rows[number]], self._slipping(state, felt)
        for k in held:
            if k != number and not self._follows(felt, self._rows[k], rows):
                rows.append(self._rows[k])
        return float(np.linalg.solve(felt.mobility[rows][:, rows], -right[rows])[0])

    def _is_implied(self, felt: ContactForces, number: int, others: Iterable[int]) -> bool:
        """Whether a contact cannot move where others hold."""
        return self._follows(felt, self._rows[number], self._independent(felt, others))

    def _follows(self, felt: ContactForces, row: int, rows: list[int]) -> bool:
        """Whether a row follows from closures and independent other rows, as far as the steps tell them apart."""
        pivot = float(felt.mobility[row, row])
        if rows:
            along = np.linalg.solve(felt.mobility[rows][:, rows], felt.mobility[rows, row])
            pivot -= float(felt.mobility[row, rows] @ along)
        return bool(pivot <= IMPLIED * felt.loose[row])

    def _first_to_slip(
        self,
        numbers: Sequence[int],
        forces: Array,
        rest: Array,
        bounds: tuple[Array, Array],
        felt: ContactForces,
    ) -> tuple[int, float] | None:
        """The first friction that does not hold, and the sense in which it slips; None where all hold."""
        low, high = bounds
        for place, k in enumerate(numbers):
            if self.contacts[k].kind != FRICTION:
                continue
            force, least, most = float(forces[place]), float(low[place]), float(high[place])
            if felt.forwards[k] > felt.backwards[k]:
                # what drives either way holds nowhere
                return k, 1.0 if rest[place] >= 0.0 else -1.0
            if force >= most:
                # pushed forwards as much as can be: it goes backwards
                return k, -1.0 if most > least or rest[place] <= 0.0 else 1.0
            if force <= least:
                return k, 1.0
        return None


def _product(one: Any, other: Any) -> Any:
    total: Any = 0.0
    for k, x in one.items():
        if k in other:
            total = total + x * other[k]
    return total
