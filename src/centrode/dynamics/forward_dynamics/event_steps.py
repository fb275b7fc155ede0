"""Events of a motion: its start, each event with what is behind it, and what the record keeps of them."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from math import inf, isfinite, nan
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.forward_dynamics.change_points import Detour
from centrode.dynamics.forward_dynamics.contact_forces import ContactForces
from centrode.dynamics.forward_dynamics.contact_modes import ContactModes
from centrode.dynamics.forward_dynamics.contact_states import TOUCHING, ContactStates, row_of
from centrode.dynamics.forward_dynamics.contacts import CLAMP, COMPLIANT, FRICTION, STOP
from centrode.dynamics.forward_dynamics.event_location import EventLocation
from centrode.dynamics.forward_dynamics.impacts import Impacts
from centrode.dynamics.forward_dynamics.motion_problem import CONDITION, PRESSES, ROUNDING, UNIQUE
from centrode.dynamics.forward_dynamics.motion_steps import (
    AMBIGUOUS,
    CONDITION_ENDS,
    CONDITION_MET,
    LEAVES,
    LETS_GO,
    TOUCHES,
    Event,
    ImpactRecord,
    Transition,
)
from centrode.errors import InputError, MotionError
from centrode.locale import _
from centrode.numerics.initial_value_problems import HEADER
from centrode.numerics.integrators import Integrator

Array: TypeAlias = npt.NDArray[np.float64]


SOON = 1e-3
"""Share of the usual time after which the side of a condition that begins at zero is looked at."""
MOST_AT_ONCE = 100
"""Events one after the other at the same instant, beyond which none of them leads on."""


@dataclass
class EventWatch:
    """Finds events of one motion, and sets the modes behind them.

    Attributes
    ----------
    states : of the motion whose steps are taken
    take : the integrator
    events : what has happened
    transitions : where modes may have changed, the start first
    ending : why what ends the motion does so, and the sentence that tells it
    """

    states: ContactStates
    take: Integrator
    events: list[Event] = field(default_factory=list)
    transitions: list[Transition] = field(default_factory=list)
    ending: tuple[str, str | None] = (CONDITION_ENDS, None)
    _impact_now: ImpactRecord | None = None
    _at_once: int = 0
    _last: float = -inf

    @cached_property
    def _location(self) -> EventLocation:
        return EventLocation(self.states, self.take)

    @cached_property
    def _impacts(self) -> Impacts:
        return Impacts(self.states)

    @cached_property
    def _modes(self) -> ContactModes:
        return ContactModes(self.states)

    @cached_property
    def _releases(self) -> list[float]:
        """Instants at which clamps let go [s]."""
        contacts = self.states.contacts
        return [c.until for c in contacts if c.kind == CLAMP and isinstance(c.until, float)]

    # the start

    def begin(self, state: Array) -> Array:
        """The state at the start with its modes.

        Raises InputError where a stop is violated there, or what is clamped moves.
        """
        carried = [float(x) for x in state[HEADER:, 0]]
        before = row_of(state)
        felt = self.states.forces_at(float(state[0, 0]), carried)
        self._check_stops(felt)
        self._close_clamps(state, felt)
        started = self._behind(state, frozenset())
        if self.ending[1] is not None:
            repair = _("give smaller coefficients, or the value of the friction")
            raise MotionError("[[loads]]", self.ending[1], repair)
        self._set_sides(started, felt)
        self._record(before, started, frozenset(), 0)
        return started

    def _check_stops(self, felt: ContactForces) -> None:
        """Raise InputError where a stop is violated, or its two points coincide."""
        for k, contact in enumerate(self.states.contacts):
            value, tolerance = float(felt.values[k]), TOUCHING * self.states.units[k]
            if not isfinite(felt.speeds[k]):
                # a distance has no derivative where it vanishes
                what = _("its points coincide at the start, where their distance has no direction")
                raise InputError(f"[[stops]] {contact.label}", what, _("move the start a little"))
            for bound, sign in ((contact.least, -1.0), (contact.most, 1.0)):
                if bound is not None and sign * (bound - value) < -tolerance:
                    what = _("it is at {value:.9g} at the start, beyond its bound {bound:.9g}")
                    repair = _("move the start, or correct the bound")
                    where = f"[[stops]] {contact.label}"
                    raise InputError(where, what.format(value=value, bound=bound), repair)

    def _close_clamps(self, state: Array, felt: ContactForces) -> None:
        """Close all clamps; raise InputError where one moves."""
        states = self.states
        for k, contact in enumerate(states.contacts):
            if contact.kind != CLAMP:
                continue
            if abs(float(felt.speeds[k])) > TOUCHING * states.units[k] * states.rate:
                what = _("it moves at the start, and is clamped")
                raise InputError(
                    f"[[clamps]] {contact.label}", what, _("give it no speed, or remove the clamp")
                )
            states.set(state, "active", k, 1.0)
            states.set(state, "held", k, float(felt.values[k]))

    def _set_sides(self, started: Array, felt: ContactForces) -> None:
        """Set the sides of conditions: what begins at zero is on the side to which it goes."""
        states, sides = self.states, self.states.motion.names.sides
        if not sides:
            return
        row = np.concatenate([started[:1, 0], started[HEADER:, 0]])
        soon = self._location.step_to(row, float(row[0]) + SOON / states.rate)
        later = states.forces_at(float(soon[0, 0]), soon[HEADER:, 0].tolist()).conditions
        for k, value in enumerate(felt.conditions):
            side = float(np.sign(value if abs(value) > ROUNDING else later[k])) or 1.0
            started[states.places[sides[k]], 0] = side

    def _record(self, before: Array, behind: Array, due: frozenset[int], told: int) -> None:
        """Keep a transition, whose events are those behind the first `told` ones."""
        noted = tuple(self.events[told:])
        self.transitions.append(Transition(before, row_of(behind), due, self._impact_now, noted))

    def clear_until(self, detour: Detour, carried: Array) -> float | None:
        """The end of a detour around a change point, or an instant behind the point before which nothing happens [s].

        None where something happens before the change point itself.
        """
        return self._location.clear_until(detour, carried)

    # what follows

    def pass_event(self, before: Array, state: Array, size: float) -> tuple[Array, Array, bool]:
        """The row at an event, the state behind it, and whether it ends the motion.

        Parameters
        ----------
        before : (1 + carried), the row before the step within which it is
        state : behind that step
        size : of the next step
        """
        found, due = self._location.locate(before, state)
        time = float(found[0, 0])
        self._at_once = self._at_once + 1 if time <= self._last else 0
        self._last = time
        if self._at_once > MOST_AT_ONCE:
            what = _("at {time:.9g} s events follow one another without end").format(time=time)
            raise MotionError("[simulation]", what, _("look at the stops and frictions there"))
        row, ends, told = row_of(found), False, len(self.events)
        guards = [self.states.guards[number] for number in due]
        for guard in guards:
            if guard.kind == CONDITION:
                ends = self._meet_condition(found, guard.number) or ends
        if any(guard.kind == UNIQUE for guard in guards):
            self.ending = (AMBIGUOUS, self._modes.ambiguity(found))
            return row, found, True
        behind = self._behind(found, due)
        behind[1, 0] = size
        self._record(row, behind, due, told)
        return row, behind, ends or self.ending[0] == AMBIGUOUS

    def _meet_condition(self, state: Array, number: int) -> bool:
        states = self.states
        condition = states.motion.equations.conditions[number]
        place = states.places[states.motion.names.sides[number]]
        time = float(state[0, 0])
        self.events.append(Event(time, CONDITION_MET, nan, condition.label))
        state[place] = -state[place]
        for k, contact in enumerate(states.contacts):
            if contact.kind == CLAMP and contact.until == condition.label:
                self._let_go(state, k)
        return condition.ends

    def _let_go(self, state: Array, number: int) -> None:
        """Open a clamp."""
        if self.states.get(state, "active", number):
            self.states.set(state, "active", number, 0.0)
            label = self.states.contacts[number].label
            self.events.append(Event(float(state[0, 0]), LETS_GO, nan, label))

    def next_release(self, time: float, end: float) -> float:
        """The next instant at which a clamp lets go, or the end [s]."""
        return min([one for one in self._releases if time < one < end], default=end)

    def release(self, state: Array, time: float) -> Array:
        """The state behind the instant at which clamps let go."""
        before, told = row_of(state), len(self.events)
        for k, contact in enumerate(self.states.contacts):
            if contact.kind == CLAMP and isinstance(contact.until, float) and contact.until <= time:
                self._let_go(state, k)
        behind = self._behind(state, frozenset())
        self._record(before, behind, frozenset(), told)
        return behind

    def _behind(self, state: Array, due: frozenset[int]) -> Array:
        """The state with speeds behind impacts, and modes that fit its forces."""
        states, state = self.states, state.copy()
        time = float(state[0, 0])
        guards = [states.guards[k] for k in due]
        # a stop that has been pressed opens, a contact that has stuck slips
        let_go = {
            guard.number
            for guard in guards
            if guard.kind in (STOP, FRICTION) and states.get(state, "active", guard.number)
        }
        # a flight that is too low to be told from rounding is none
        grounded = {guard.number for guard in guards if guard.kind == STOP} if self._at_once > 1 else set()
        felt = states.forces_at(time, state[HEADER:, 0].tolist())
        felt, self._impact_now, events = self._impacts.apply(state, felt, grounded)
        self.events += events
        for guard in guards:
            contact = states.contacts[guard.number] if guard.kind == STOP else None
            if contact is not None and contact.kind == COMPLIANT:
                pressed = states.get(state, "active", guard.number) != 0.0
                states.set(state, "active", guard.number, 0.0 if pressed else guard.bound)
                kind = LEAVES if pressed else TOUCHES
                self.events.append(Event(time, kind, nan, contact.label))
                felt = states.forces_at(time, state[HEADER:, 0].tolist())
        comes = {guard.number for guard in guards if guard.kind == FRICTION} - let_go
        turned = {guard.number for guard in guards if guard.kind == PRESSES}
        choice = self._modes.choose(state, felt, let_go, comes, turned)
        self.events += choice.events
        if choice.ambiguity is not None:
            self.ending = (AMBIGUOUS, choice.ambiguity)
        if not states.close(state):
            self.ending = (AMBIGUOUS, self._modes.ambiguity(state))
        return state
