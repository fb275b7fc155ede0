"""Derivatives of a motion through its events: stops that are hit, what sticks, slips, opens, lets go.

A neighbouring motion has the same event a little earlier or later, and behind it another law moves it on. With the
guard g that is zero at the event, the rates f before and F behind it, and what the event makes of a state, R(x),

    dt = -(g' dx) / (g' f),    dx at the event = dx + f dt,    dx behind it = R' (dx at the event) - F dt

(the saltation matrix). Which contacts hit, stick or open stays as it is; where a neighbour would do otherwise there is
no derivative. R and g are what the events themselves are computed by, and their derivatives differences of sixth order
along each direction. (M. di Bernardo, C. J. Budd, A. R. Champneys and P. Kowalczyk, Piecewise-smooth Dynamical
Systems, Springer 2008, sections 2.3 and 2.5.)
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.forward_dynamics.contact_forces import ContactForces
from centrode.dynamics.forward_dynamics.contact_states import ContactStates
from centrode.dynamics.forward_dynamics.contacts import CLAMP, FRICTION, STOP
from centrode.dynamics.forward_dynamics.equations_of_motion import EquationsOfMotion
from centrode.dynamics.forward_dynamics.initial_position import units_of
from centrode.dynamics.forward_dynamics.integration import MotionIntegration
from centrode.dynamics.forward_dynamics.motion_steps import RESTS, ImpactRecord, Transition
from centrode.errors import MotionError, NotComputedYet
from centrode.locale import _
from centrode.numerics.python_functions import Function

Array: TypeAlias = npt.NDArray[np.float64]

STEP = 1e-3
"""Step of differences: change of an angle, of lengths and speeds as shares of their usual sizes."""
WEIGHTS = ((1, 3.0 / 4.0), (2, -3.0 / 20.0), (3, 1.0 / 60.0))
"""Central differences of sixth order: steps and weights."""
SAME = 1e-7
"""By which share of its size an event computed anew may differ, and two events at one instant may depart."""
GRAZES = 1e-9
"""A guard that passes zero more slowly than this share of the usual rate only touches it."""


class ContactNumbers(NamedTuple):
    """Numbers of c contacts that the equations of motion do not have, or their changes; each (c).

    Attributes
    ----------
    least, most : bounds of stops
    restitution : of stops
    until : when clamps let go by the clock [s]
    drift : speeds of surfaces
    """

    least: Array
    most: Array
    restitution: Array
    until: Array
    drift: Array

    @classmethod
    def of(cls, equations: EquationsOfMotion) -> ContactNumbers:
        """Those of the contacts of a motion; zero where a contact has none."""
        contacts = equations.contacts
        return cls(
            np.array([c.least or 0.0 for c in contacts], dtype=np.float64),
            np.array([c.most or 0.0 for c in contacts], dtype=np.float64),
            np.array([c.restitution for c in contacts], dtype=np.float64),
            np.array([c.until if isinstance(c.until, float) else 0.0 for c in contacts]),
            np.array([c.drift for c in contacts], dtype=np.float64),
        )

    def at_step(self, by: ContactNumbers, step: float) -> ContactNumbers:
        """The numbers with a step along their changes."""
        return ContactNumbers(*(one + step * change for one, change in zip(self, by, strict=True)))


@dataclass(frozen=True)
class Direction:
    """Along which a motion may change.

    Attributes
    ----------
    parameters : (parameters) changes of the numbers of the problem
    contacts : those of the numbers of contacts
    """

    parameters: Array
    contacts: ContactNumbers


class Neighbour(NamedTuple):
    """Changes of a state along one direction.

    Attributes
    ----------
    unknowns : (unknowns) of what is followed
    held : (contacts) of the values at which contacts hold
    """

    unknowns: Array
    held: Array


class EventChange(NamedTuple):
    """How an event changes along one direction.

    Attributes
    ----------
    time : its instant
    at_event : the state at the event itself, before it
    behind : the state at a fixed instant behind it
    rests : instants at which last small impacts come to an end, by places of the impact
    """

    time: float
    at_event: Neighbour
    behind: Neighbour
    rests: tuple[float, ...]


@dataclass
class EventDerivatives:
    """Derivatives of one motion through its events.

    Attributes
    ----------
    integration : of the motion
    parameters : (parameters) of its steps
    rate : what speeds are compared with [1/s]
    rates : (time, parameters, carried) -> rates of what is followed
    """

    integration: MotionIntegration
    parameters: Array
    rate: float
    rates: Function

    @cached_property
    def _count(self) -> int:
        return len(self.integration.problem.unknowns)

    @cached_property
    def _places(self) -> dict[str, int]:
        """Place of what is carried in a row behind its time."""
        return {name: k for k, name in enumerate(self.integration.problem.carried_names)}

    @cached_property
    def _held(self) -> list[int]:
        return [self._places[name] for name in self.integration.names.held]

    @cached_property
    def _active(self) -> list[int]:
        return [self._places[name] for name in self.integration.names.active]

    @cached_property
    def _states(self) -> ContactStates:
        return ContactStates(self.integration, self.parameters[:, None], self.rate)

    @cached_property
    def numbers(self) -> ContactNumbers:
        """Numbers of the contacts."""
        return ContactNumbers.of(self.integration.equations)

    @cached_property
    def _sizes(self) -> Array:
        """What changes of the unknowns are compared with; infinite where they do not count."""
        names, found = self.integration.names, np.full(self._count, np.inf)
        units = units_of(self.integration.equations.tree, self.integration.equations.numbers)
        found[names.part(names.coordinates)] = units
        found[names.part(names.speeds)] = units * self.rate
        return found

    def flow(self, row: Array) -> Array:
        """Rates (unknowns) of what is followed at a row (1 + carried)."""
        found = self.rates([float(row[0]), *self.parameters.tolist(), *row[1:].tolist()])
        return np.array(found, dtype=np.float64)

    def through(
        self, transition: Transition, change: Neighbour, direction: Direction, previous: float | None
    ) -> EventChange:
        """How a transition changes along a direction, from the state's change at its instant.

        Parameters
        ----------
        previous : change of the time of an event at the same instant just before; None without one

        Raises
        ------
        MotionError
            A guard only touches zero, or two events at one instant depart.
        NotComputedYet
            The event is made of what is not followed here.
        """
        before, behind = self.flow(transition.before), self.flow(transition.behind)
        if previous is None:
            shift = self._change_of_time(transition, change, direction, before)
        else:
            shift = previous
        moved = Neighbour(change.unknowns + before * shift, change.held)
        self._check_same(transition)
        found = self._derivative(
            lambda step: self._behind(transition, moved, direction, shift, step),
            self._step_of(moved.unknowns, direction, shift, transition.before),
        )
        count, contacts = self._count, len(self._held)
        after = Neighbour(found[:count] - behind * shift, found[count : count + contacts])
        return EventChange(shift, moved, after, tuple((found[count + contacts :] + shift).tolist()))

    # when

    def _change_of_time(
        self, transition: Transition, change: Neighbour, direction: Direction, flow: Array
    ) -> float:
        """Change of the instant of a transition; zero at the start."""
        if not transition.due:
            return self._change_of_release(transition, direction)
        guards = sorted(transition.due)
        still = np.zeros(len(self._held))
        none = Direction(np.zeros_like(self.parameters), direction.contacts)
        along = self._derivative(
            lambda step: self._guards(transition.before, change, direction, 0.0, step, guards),
            self._step_of(change.unknowns, direction, 0.0, transition.before),
        )
        passing = self._derivative(
            lambda step: self._guards(transition.before, Neighbour(flow, still), none, 1.0, step, guards),
            self._step_of(flow, none, 1.0, transition.before),
        )
        scale = self._guard_sizes(guards) * self.rate
        if np.any(np.abs(passing) <= GRAZES * scale):
            what = _("at {time:.9g} s something only touches: there are no derivatives beyond it")
            raise MotionError(
                "gradients", what.format(time=transition.time), _("change a number, or give a shorter time")
            )
        shifts = -along / passing
        self._check_together(transition, shifts)
        return float(shifts[0])

    def _guard_sizes(self, guards: Sequence[int]) -> Array:
        """What gaps are compared with; of all other guards nothing is known, so nothing is taken for small."""
        states = self._states
        found = []
        for number in guards:
            guard = states.guards[number]
            found.append(float(states.units[guard.number]) if guard.kind == STOP else 0.0)
        return np.array(found)

    def _change_of_release(self, transition: Transition, direction: Direction) -> float:
        contacts = self.integration.equations.contacts
        let_go = [
            float(direction.contacts.until[k])
            for k, place in enumerate(self._active)
            if contacts[k].kind == CLAMP
            and transition.before[1 + place] != 0.0
            and transition.behind[1 + place] == 0.0
        ]
        self._check_together(transition, np.array(let_go))
        return let_go[0] if let_go else 0.0

    def _check_together(self, transition: Transition, shifts: Array) -> None:
        """Raise where events at one instant would be at different ones for a neighbour."""
        if len(shifts) and np.ptp(shifts) > SAME * (np.max(np.abs(shifts)) + 1e-300):
            what = _("at {time:.9g} s two things happen at once that part where a number changes")
            raise MotionError(
                "gradients",
                what.format(time=transition.time),
                _("change a number, so that one happens first"),
            )

    def _guards(
        self,
        row: Array,
        change: Neighbour,
        direction: Direction,
        shift: float,
        step: float,
        guards: Sequence[int],
    ) -> Array:
        """Values of guards at a step along a direction from a row before an event."""
        carried = self._carried_at(row, change, step)
        closed = self.integration.closing_function(
            [float(row[0]) + step * shift, 1.0, *(self.parameters + step * direction.parameters), *carried]
        )
        names = self.integration.names.guards
        return np.array([closed[self._places[names[number]]] for number in guards])

    def _carried_at(self, row: Array, change: Neighbour, step: float) -> Array:
        carried = row[1:].copy()
        carried[: self._count] += step * change.unknowns
        carried[self._held] += step * change.held
        return carried

    # what follows

    def _behind(
        self, transition: Transition, change: Neighbour, direction: Direction, shift: float, step: float
    ) -> Array:
        """State behind an event, values held, and durations of small impacts, at a step along a direction."""
        row = np.concatenate(
            [
                [transition.before[0] + step * shift],
                self._carried_at(transition.before, change, step),
            ]
        )
        numbers = self.numbers.at_step(direction.contacts, step)
        parameters = self.parameters + step * direction.parameters
        states = ContactStates(self.integration, parameters[:, None], self.rate)
        felt = states.forces_in(row)
        rests = np.zeros(0)
        if transition.impact is not None:
            rests = self._apply_impact(states, row, felt, transition.impact, numbers.restitution)
        self._take_modes(row, transition, felt, numbers)
        closed = np.array(self.integration.closing_function([row[0], 1.0, *parameters, *row[1:]]))
        return np.concatenate([closed[: self._count], row[1:][self._held], rests])

    def _take_modes(
        self, row: Array, transition: Transition, felt: ContactForces, numbers: ContactNumbers
    ) -> None:
        """Give a row the modes of the transition, and the values at which what begins to hold holds."""
        held = row[1:][self._held]
        row[1 + self._count :] = transition.behind[1 + self._count :]
        for k, contact in enumerate(self.integration.equations.contacts):
            was, now = (float(one[1 + self._active[k]]) for one in (transition.before, transition.behind))
            if now != 0.0 and now != was:
                if contact.kind == FRICTION:
                    held[k] = felt.values[k] - numbers.drift[k] * row[0]
                elif contact.kind == CLAMP:
                    held[k] = felt.values[k]
                else:
                    held[k] = numbers.least[k] if now < 0.0 else numbers.most[k]
        row[1:][self._held] = held

    def _apply_impact(
        self, states: ContactStates, row: Array, felt: ContactForces, impact: ImpactRecord, restitution: Array
    ) -> Array:
        """Change the speeds of a row by impulses of the same contacts; how long last small impacts take [s]."""
        rows = {k: place for place, k in enumerate(self._with_rows)}
        at = [rows[k] for k in impact.numbers]
        matrix = impact.signs[:, None] * felt.mobility[np.ix_(at, at)] * impact.signs
        speeds = impact.signs * felt.speeds[list(impact.numbers)]
        impulses = np.zeros(len(at))
        pushes = np.flatnonzero(impact.impulses != 0.0)
        aim = -self._shares(impact, restitution)[pushes] * speeds[pushes]
        impulses[pushes] = np.linalg.lstsq(matrix[np.ix_(pushes, pushes)], aim - speeds[pushes], rcond=1e-11)[
            0
        ]
        after = speeds + matrix @ impulses
        rests = []
        part = self.integration.names.part(self.integration.names.speeds)
        start = row[1 + part.start : 1 + part.stop].copy()
        row[1 + part.start : 1 + part.stop] = start + felt.shifts[:, at] @ (impact.signs * impulses)
        if impact.resting:
            resting = list(impact.resting)
            behind = states.forces_in(row)
            for place, whole in zip(resting, impact.settled, strict=True):
                k = impact.numbers[place]
                share = float(restitution[k])
                free = impact.signs[place] * states.acceleration_at(row, behind, k)
                rests.append(-2.0 * float(after[place]) / free / (1.0 - share) if whole > 0.0 else 0.0)
            more = np.linalg.lstsq(matrix[np.ix_(resting, resting)], -after[resting], rcond=1e-11)[0]
            impulses[resting] += more
            row[1 + part.start : 1 + part.stop] = start + felt.shifts[:, at] @ (impact.signs * impulses)
        return np.array(rests)

    @cached_property
    def _with_rows(self) -> tuple[int, ...]:
        """Numbers of the contacts in the order of their rows."""
        return tuple(number for _row, number in self.integration.equations.contact_rows)

    def _shares(self, impact: ImpactRecord, restitution: Array) -> Array:
        """By which share speeds came back, as restitutions at a step: those of the contacts, or the least of them."""
        shares, own = np.zeros(len(impact.numbers)), self.numbers.restitution
        for place, (speed, after) in enumerate(zip(impact.before, impact.after, strict=True)):
            if not speed < 0.0 or impact.impulses[place] == 0.0:
                continue
            share = -after / speed
            k = impact.numbers[place]
            if abs(share - own[k]) > SAME:
                # the least of those that hit holds for all, or none is left
                like = [other for other in impact.numbers if abs(own[other] - share) <= SAME]
                if not like:
                    shares[place] = share
                    continue
                k = like[0]
            shares[place] = restitution[k]
        return shares

    def _check_same(self, transition: Transition) -> None:
        """Raise where what was computed at the event is not what is differentiated here."""
        none = Neighbour(np.zeros(self._count), np.zeros(len(self._held)))
        still = Direction(np.zeros_like(self.parameters), ContactNumbers(*np.zeros((5, len(self._held)))))
        found = self._behind(transition, none, still, 0.0, 0.0)[: self._count]
        names = self.integration.names
        for part in (names.part(names.coordinates), names.part(names.speeds)):
            size = self._sizes[part]
            if (
                np.max(np.abs(found - transition.behind[1 : 1 + self._count])[part] / size, initial=0.0)
                > SAME
            ):
                what = _("the event at {time:.9g} s has no derivatives here").format(time=transition.time)
                raise NotComputedYet("gradients", what, _("compare motions whose numbers differ a little"))

    # differences

    def _step_of(self, change: Array, direction: Direction, shift: float, row: Array) -> float:
        """Step of differences along a direction; infinite where nothing changes."""
        fast = np.maximum(np.abs(row[1 : 1 + self._count]), self._sizes)
        sizes = [float(np.max(np.abs(change) / fast, initial=0.0)), abs(shift) * self.rate]
        known = np.abs(self.parameters) > 0.0
        sizes.append(float(np.max(np.abs(direction.parameters[known] / self.parameters[known]), initial=0.0)))
        sizes += [float(np.max(np.abs(one), initial=0.0)) for one in direction.contacts]
        largest = max(sizes)
        return STEP / largest if largest > 0.0 else np.inf

    def _derivative(self, function: Callable[[float], Array], step: float) -> Array:
        """Derivative of a function of a step along a direction at zero."""
        if not np.isfinite(step):
            return np.zeros_like(function(0.0))
        total: Array | float = 0.0
        for count, weight in WEIGHTS:
            total = total + weight / step * (function(count * step) - function(-count * step))
        return np.asarray(total)


def rests_of(transition: Transition) -> dict[int, int]:
    """Number of an event of a transition -> its place among impacts that come to an end, of those that are later."""
    found, place = {}, 0
    for number, event in enumerate(transition.events):
        if event.kind == RESTS:
            found[number] = place
            place += 1
    return found
