"""Impacts of a motion: impulses of stops that are hit, and the rest of impacts that get ever smaller.

Impulses follow from the masses that the contacts feel. (F. Pfeiffer and C. Glocker, Multibody Dynamics with Unilateral
Contacts, 1996, chapter 8.)
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import isnan, nan
from typing import NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.forward_dynamics.bounded_forces import impulses_of_impact
from centrode.dynamics.forward_dynamics.contact_forces import ContactForces
from centrode.dynamics.forward_dynamics.contact_states import TOUCHING, ContactStates
from centrode.dynamics.forward_dynamics.contacts import AT_LEAST, AT_MOST, CLAMP, STOP
from centrode.dynamics.forward_dynamics.motion_steps import IMPACT, RESTS, Event, ImpactRecord
from centrode.numerics.initial_value_problems import HEADER

Array: TypeAlias = npt.NDArray[np.float64]

ACCUMULATED = 2e-5
"""Impacts that end within this share of the usual time are taken together."""


class TouchingContacts(NamedTuple):
    """Contacts that take part in an impact: number -> bound, 0 of a clamp.

    Attributes
    ----------
    hits, holds : what meets its bound, and what is at it already
    """

    hits: dict[int, float]
    holds: dict[int, float]


class ImpactOutcome(NamedTuple):
    """What is behind an impact.

    Attributes
    ----------
    felt : what contacts feel then
    record : of what impulses were made; None without any
    events : what has happened
    """

    felt: ContactForces
    record: ImpactRecord | None = None
    events: tuple[Event, ...] = ()


@dataclass(frozen=True)
class Impacts:
    """Impulses at one instant of a motion.

    Attributes
    ----------
    states : of the motion
    """

    states: ContactStates

    def apply(self, state: Array, felt: ContactForces, grounded: set[int]) -> ImpactOutcome:
        """Change the speeds of a state by impulses of stops that are hit, or to which what is `grounded` returns."""
        states = self.states
        hits, holds = self._touching(state, felt, grounded)
        if not hits:
            return ImpactOutcome(felt)
        time, taken = float(state[0, 0]), hits | holds
        numbers = list(taken)
        rows = [states.rows[k] for k in numbers]
        signs = np.array([-taken[k] or 1.0 for k in numbers])
        matrix, before = self._along_signs(felt, numbers, rows, signs, hits)
        is_stop = np.array([states.contacts[k].kind == STOP for k in numbers])
        restitution = [states.contacts[k].restitution for k in numbers]
        impulses, after = impulses_of_impact(matrix, before, restitution, is_stop)
        self._add_impulses(state, felt, numbers, signs * impulses, 0.5 * impulses * (before + after))
        if self._bounces(hits, grounded):
            own = slice(rows[0], rows[0] + 1) if len(rows) == 1 else rows
            speeds = felt.speeds + felt.mobility[:, own] @ (signs * impulses)
            behind = felt._replace(speeds=speeds, is_late=True)
        else:
            behind = states.forces_at(time, state[HEADER:, 0].tolist())
        settled = {
            k: 0.0 if k in grounded else self._rest_of_impacts(state, behind, k, hits[k])
            for k in numbers
            if k in hits
        }
        resting = [place for place, k in enumerate(numbers) if not isnan(settled.get(k, nan))]
        if resting:
            # the rest of infinitely many impacts at once: their sum is that of one without restitution
            now, more = signs * behind.speeds[numbers], np.zeros(len(numbers))
            among = matrix[resting][:, resting]
            more[resting] = np.linalg.lstsq(among, -now[resting], rcond=1e-11)[0]
            then = now + matrix @ more
            self._add_impulses(state, behind, numbers, signs * more, 0.5 * more * (now + then))
            behind = states.forces_at(time, state[HEADER:, 0].tolist())
        ends = tuple(settled[numbers[place]] for place in resting)
        record = ImpactRecord(tuple(numbers), signs, before, after, impulses, tuple(resting), ends)
        for place in resting:
            states.set(state, "active", numbers[place], taken[numbers[place]])
        return ImpactOutcome(behind, record, tuple(self._events(time, record, hits, settled)))

    def _touching(self, state: Array, felt: ContactForces, grounded: set[int]) -> TouchingContacts:
        """Closed clamps, and stops at a bound from which they do not fly off."""
        states = self.states
        hits: dict[int, float] = {}
        holds: dict[int, float] = {}
        for k in states.rows:
            contact = states.contacts[k]
            if contact.kind == CLAMP and states.get(state, "active", k):
                holds[k] = 0.0
            if contact.kind != STOP:
                continue
            for bound in (AT_LEAST, AT_MOST):
                speed = -bound * float(felt.speeds[k])
                slow = TOUCHING * states.units[k] * states.rate
                if not states.is_touching(felt, k, bound):
                    continue
                if speed < -slow or (k in grounded and speed > slow):
                    hits[k] = bound
                elif speed <= slow:
                    holds[k] = bound
        return TouchingContacts(hits, holds)

    def _along_signs(
        self,
        felt: ContactForces,
        numbers: Sequence[int],
        rows: Sequence[int],
        signs: Array,
        hits: Mapping[int, float],
    ) -> tuple[Array, Array]:
        """W among contacts and their speeds, both away from the bounds."""
        if len(numbers) == 1:
            # one alone, as nearly always: views of it are taken in a fraction of the time
            (k,), (row,) = numbers, rows
            return felt.mobility[row : row + 1, row : row + 1], signs * felt.speeds[k : k + 1]
        matrix = signs[:, None] * felt.mobility[rows][:, rows] * signs
        before = signs * felt.speeds[numbers]
        before[[k not in hits for k in numbers]] = 0.0
        return matrix, before

    def _events(
        self, time: float, record: ImpactRecord, hits: Mapping[int, float], settled: Mapping[int, float]
    ) -> list[Event]:
        """What an impact is noted as: of each stop that pushes, and of each that comes to rest."""
        found = []
        for k, before, after, impulse in zip(
            record.numbers, record.before, record.after, record.impulses, strict=True
        ):
            contact = self.states.contacts[k]
            if (k not in hits and impulse <= 0.0) or contact.kind != STOP:
                continue
            lost = -0.5 * float(impulse * (before + after))
            found.append(Event(time, IMPACT, nan, contact.label, float(impulse), lost))
            if not isnan(settled.get(k, nan)):
                found.append(Event(time + settled[k], RESTS, nan, contact.label))
        return found

    def _bounces(self, hits: Iterable[int], grounded: set[int]) -> bool:
        """Whether all that hits flies off whatever forces there are, so that only speeds are needed behind it."""
        states = self.states
        has_rows = len(states.rows) == len(states.contacts) and not states.pressed_numbers
        return has_rows and all(states.contacts[k].restitution >= 1.0 and k not in grounded for k in hits)

    def _add_impulses(
        self, state: Array, felt: ContactForces, numbers: Sequence[int], impulses: Array, works: Array
    ) -> None:
        """Change speeds by impulses along rows, and note the works of both."""
        states, equations = self.states, self.states.motion.equations
        names, rows = states.motion.names, [states.rows[k] for k in numbers]
        first = states.places[names.speeds[0]]
        shifts = felt.shifts[:, rows[0] : rows[0] + 1] if len(rows) == 1 else felt.shifts[:, rows]
        state[first : first + len(names.speeds), 0] += shifts @ impulses
        works_at = states.work_places
        count, kept = len(states.contacts), len(felt.rates)
        driven = len(equations.controls)
        for k, work in zip(numbers, works, strict=True):
            state[works_at[len(works_at) - count + k], 0] += work
        if kept:
            given = felt.reactions[:, rows] @ impulses
            for k in range(kept):
                state[works_at[len(works_at) - count - driven - kept + k], 0] -= given[k] * felt.rates[k]

    def _rest_of_impacts(self, state: Array, felt: ContactForces, number: int, bound: float) -> float:
        """Time [s] in which impacts that get ever smaller come to an end; NaN where that is not at once."""
        states = self.states
        speed = -bound * float(felt.speeds[number])
        restitution = states.contacts[number].restitution
        if restitution >= 1.0:
            return nan
        if speed <= TOUCHING * states.units[number] * states.rate:
            return 0.0
        free = -bound * states.acceleration(state, felt, number)
        if not free < 0.0:
            return nan
        whole = -2.0 * speed / free / (1.0 - restitution)
        return whole if whole * states.rate < ACCUMULATED else nan
