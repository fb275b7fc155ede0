"""Modes of contacts behind an event: what sticks, slips, is closed or opens, and what presses.

They follow from forces within bounds. (F. Pfeiffer and C. Glocker, Multibody Dynamics with Unilateral Contacts, 1996,
chapters 5 and 8.)
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import inf, nan
from typing import NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.forward_dynamics.bounded_forces import forces_within
from centrode.dynamics.forward_dynamics.contact_forces import ContactForces
from centrode.dynamics.forward_dynamics.contact_states import TOUCHING, ContactStates
from centrode.dynamics.forward_dynamics.contacts import AT_LEAST, AT_MOST, CLAMP, FRICTION, STOP
from centrode.dynamics.forward_dynamics.equations_of_motion import IMPLIED
from centrode.dynamics.forward_dynamics.motion_steps import CLOSES, OPENS, SLIPS, STICKS, Event
from centrode.dynamics.forward_dynamics.pressed_modes import response_with_held
from centrode.locale import _
from centrode.numerics.initial_value_problems import HEADER

Array: TypeAlias = npt.NDArray[np.float64]

VANISHES = 0.01
"""A reaction without friction below this share of that with it may be of either sign where both are lost."""
TURNING = 1e-8
"""An acceleration above this share of the usual one is none of rounding."""
AT_THE_LIMIT = 1e-6
"""What holds is at its limit where its event says so and this share is not missing."""
ROUNDS, SETTLED = 200, 1e-13
"""Rounds in which modes and bounds of friction by coefficients settle, to this share of the greatest."""


class ModeChoice(NamedTuple):
    """What the modes behind an event are noted as.

    Attributes
    ----------
    events : of contacts whose modes have changed
    ambiguity : the sentence that names friction with no or several solutions; None of one solution
    """

    events: list[Event]
    ambiguity: str | None = None


@dataclass(frozen=True)
class ContactModes:
    """What sticks, slips, is closed or opens behind an event.

    Attributes
    ----------
    states : of the motion
    """

    states: ContactStates

    def choose(
        self,
        state: Array,
        felt: ContactForces,
        let_go: set[int],
        comes: set[int],
        turned: Collection[int] = (),
    ) -> ModeChoice:
        """Set what sticks, slips, is closed or opens, by the forces that would hold it.

        What is in `let_go` is at the limit of its force; what is in `comes` has come to rest on its surface. In
        `turned` are sliders that other numbers begin to press.
        """
        states, ambiguity = self.states, None
        before = {k: states.get(state, "active", k) for k in states.rows}
        held, rested = self._candidates(state, felt, let_go, comes)
        if held and felt.is_late:
            felt = states.forces_at(float(state[0, 0]), state[HEADER:, 0].tolist())
        if states.pressed_numbers:
            felt, ambiguity = self._with_limits(state, felt, held, let_go)
        forces = self._held_forces(state, felt, held, let_go) if held else {}
        if states.pressed_numbers:
            self._set_weights(state, felt, forces, turned)
        events: list[Event] = []
        for k in states.rows:
            kind = states.contacts[k].kind
            if kind == FRICTION:
                was = bool(before[k]) or k in rested
                events += self._choose_friction(state, felt, k, (held, forces), was)
            elif kind == STOP:
                events += self._choose_stop(state, k, held.get(k, 0.0) if k in forces else 0.0, before[k])
        return ModeChoice(events, ambiguity)

    def _candidates(
        self, state: Array, felt: ContactForces, let_go: set[int], comes: set[int]
    ) -> tuple[dict[int, float], set[int]]:
        """What may be held, by contacts the bound (0 of all but stops), and what of it has been at rest."""
        states = self.states
        held: dict[int, float] = {}
        rested: set[int] = set()
        for k in states.rows:
            contact, active = states.contacts[k], states.get(state, "active", k)
            slow = TOUCHING * states.units[k] * states.rate
            if contact.kind == CLAMP:
                if active:
                    held[k] = 0.0
            elif contact.kind == FRICTION:
                slip = float(felt.speeds[k]) - contact.drift
                if abs(slip) <= slow or k in comes:
                    held[k] = 0.0
                    if k not in comes:
                        rested.add(k)
                states.set(state, "sense", k, 0.0 if k in held else float(np.sign(slip)))
            else:
                for bound in (AT_LEAST, AT_MOST):
                    opens = active == bound and k in let_go
                    rests = abs(float(felt.speeds[k])) <= slow
                    if rests and not opens and states.is_touching(felt, k, bound):
                        held[k] = bound
        return held, rested

    def _choose_friction(
        self,
        state: Array,
        felt: ContactForces,
        number: int,
        holding: tuple[dict[int, float], dict[int, float]],
        was: bool,
    ) -> list[Event]:
        """Set whether a friction sticks, by what may be held and the forces of what is."""
        states, (held, forces) = self.states, holding
        contact, time = states.contacts[number], float(state[0, 0])
        begins = number in forces and not states.get(state, "active", number)
        states.set(state, "active", number, 1.0 if number in forces else 0.0)
        if begins:
            states.set(state, "held", number, float(felt.values[number]) - contact.drift * time)
        # what others hold is at rest too, whatever its own friction does
        stays = number in forces or (number in held and self._is_implied(felt, number, forces))
        if stays is was or not time > 0.0:
            return []
        return [Event(time, STICKS if stays else SLIPS, nan, contact.label)]

    def _choose_stop(self, state: Array, number: int, bound: float, before: float) -> list[Event]:
        """Set whether a stop is closed, and at which bound."""
        states = self.states
        contact, time = states.contacts[number], float(state[0, 0])
        states.set(state, "active", number, bound)
        if bound:
            level = contact.least if bound < 0.0 else contact.most
            assert level is not None
            states.set(state, "held", number, float(level))
        if bool(bound) is bool(before) or not (before or time > 0.0):
            return []
        return [Event(time, CLOSES if bound else OPENS, nan, contact.label)]

    def _held_forces(
        self,
        state: Array,
        felt: ContactForces,
        held: dict[int, float],
        let_go: set[int],
    ) -> dict[int, float]:
        """Forces of what goes on to be held, by contacts; what slips gets its sense."""
        # what closures hold already needs no force
        fast = {k for k in held if self._follows(felt, self.states.rows[k], [])}
        if fast:
            # what rests for an instant, as a motion that closures dictate turns round, does not stick
            moved = self.states.slipping_accelerations(state, felt)
            for k in [one for one in fast if self.states.contacts[one].kind == FRICTION]:
                away = float(moved[self.states.rows[k]])
                if abs(away) > TURNING * self.states.units[k] * self.states.rate**2:
                    self.states.set(state, "sense", k, float(np.sign(away)))
                    fast.remove(k)
                    del held[k]
        held = {k: bound for k, bound in held.items() if k not in fast}
        found = {k: 0.0 for k in fast if self.states.contacts[k].kind != STOP}
        for k in [one for one in held if one in let_go and self.states.contacts[one].kind == FRICTION]:
            force = self._force_alone(state, felt, k, held)
            least, most = self._bounds(felt, k)
            near = AT_THE_LIMIT * (most - least)
            if force >= most - near or force <= least + near:
                self.states.set(state, "sense", k, -1.0 if force >= most - near else 1.0)
                del held[k]
        while held:
            numbers = list(held)
            rows = [self.states.rows[k] for k in numbers]
            right = self.states.slipping_accelerations(state, felt)
            low, high = np.array([self._bounds(felt, k, held[k]) for k in numbers]).T
            forces, rest = forces_within(felt.mobility[rows][:, rows], right[rows], low, high)
            slipping = self._first_to_slip(numbers, forces, rest, (low, high), felt)
            if slipping is None:
                found |= {
                    k: float(force)
                    for k, force in zip(numbers, forces, strict=True)
                    if self.states.contacts[k].kind != STOP or force != 0.0
                }
                break
            k, sense = slipping
            self.states.set(state, "sense", k, sense)
            del held[k]
        return found

    def _row_forces(self, state: Array, felt: ContactForces, held: Mapping[int, float]) -> Array:
        """Forces along rows: those of what is held, and the friction of what slips by its limits."""
        forces = np.zeros(len(self.states.rows))
        for k, row in self.states.rows.items():
            if k in held:
                forces[row] = held[k]
            elif self.states.contacts[k].kind == FRICTION:
                sense = self.states.get(state, "sense", k)
                forces[row] = felt.forwards[k] if sense > 0.0 else felt.backwards[k] if sense < 0.0 else 0.0
        return forces

    def _with_limits(
        self, state: Array, felt: ContactForces, held: dict[int, float], let_go: set[int]
    ) -> tuple[ContactForces, str | None]:
        """Bounds of friction by coefficients that fit the forces and modes which follow from them; whether none do.

        That is a sentence, or None.
        """
        ambiguity = None
        senses = {k: self.states.get(state, "sense", k) for k in self.states.rows}
        felt = felt.with_limits(felt.presses.limits(self._present_forces(state, felt)))
        for _round in range(ROUNDS):
            for k, sense in senses.items():
                self.states.set(state, "sense", k, sense)
            found = self._held_forces(state, felt, dict(held), let_go) if held else {}
            forces = self._settled_forces(state, felt, self._row_forces(state, felt, found), list(found))
            limits = felt.presses.limits(forces)
            apart = max(abs(a - b) for k in limits for a, b in zip(limits[k], felt.limits[k], strict=True))
            size = max(abs(a) for k in limits for a in limits[k])
            felt = felt.with_limits(limits)
            if not apart > SETTLED * size:
                break
        else:
            ambiguity = self.ambiguity(state)
        for k, sense in senses.items():
            self.states.set(state, "sense", k, sense)
        return felt, ambiguity

    def _settled_forces(self, state: Array, felt: ContactForces, forces: Array, held: Sequence[int]) -> Array:
        """Forces along rows with friction by coefficients of what slips as great as what presses."""
        slips = {
            k: (self.states.rows[k], self.states.get(state, "sense", k))
            for k in self.states.pressed_numbers
            if k not in held
        }
        slips = {k: (row, sense) for k, (row, sense) in slips.items() if sense}
        return felt.presses.settled_forces(felt.mobility, self._independent(felt, held), forces, slips)

    def _independent(self, felt: ContactForces, numbers: Iterable[int]) -> list[int]:
        """Rows of contacts: of what holds the same thing twice the first bears it, as in the steps."""
        rows: list[int] = []
        for k in numbers:
            if not self._follows(felt, self.states.rows[k], rows):
                rows.append(self.states.rows[k])
        return rows

    def _present_forces(self, state: Array, felt: ContactForces) -> Array:
        """Forces along rows in the modes that are still set."""
        active = [k for k in self.states.rows if self.states.get(state, "active", k)]
        rows = self._independent(felt, active)
        forces = self._row_forces(state, felt, dict.fromkeys([*active, *self.states.pressed_numbers], 0.0))
        if rows:
            right = felt.free + felt.mobility @ forces
            forces[rows] -= np.linalg.solve(felt.mobility[rows][:, rows], right[rows])
        return self._settled_forces(state, felt, forces, active)

    def _set_weights(
        self, state: Array, felt: ContactForces, held: Mapping[int, float], turned: Collection[int]
    ) -> None:
        """What presses from here on: signs of normal forces, and directions of the forces of pins."""
        senses = {k: self.states.get(state, "sense", k) for k in self.states.pressed_numbers}
        lost = {k: (self.states.get(state, "first", k), self.states.get(state, "second", k)) for k in turned}
        weights = felt.presses.weights(self._row_forces(state, felt, held), senses, lost)
        for k, (first, second) in weights.items():
            self.states.set(state, "first", k, first)
            self.states.set(state, "second", k, second)

    def ambiguity(self, state: Array) -> str:
        """The sentence that names the friction which has no or several solutions."""
        time = float(state[0, 0])
        felt = self.states.forces_at(time, state[HEADER:, 0].tolist())
        slips = [k for k in self.states.pressed_numbers if self.states.get(state, "sense", k)] or list(
            self.states.pressed_numbers
        )
        held = [self.states.rows[k] for k in self.states.rows if self.states.get(state, "active", k)]
        feedback = felt.presses.feedback(felt.mobility, held, {k: self.states.rows[k] for k in slips})
        worst = max(feedback, key=lambda k: feedback[k])
        what = _("at {time:.9g} s friction at {contact} may have no or several solutions")
        if len(slips) == 1:
            count = self._solutions(state, felt, worst, held)
            if count == 0:
                what = _("at {time:.9g} s friction at {contact} has no solution from there on")
            elif count is not None:
                what = _("at {time:.9g} s friction at {contact} has several solutions from there on")
        return what.format(time=time, contact=self.states.contacts[worst].label)

    def _solutions(self, state: Array, felt: ContactForces, number: int, held: Sequence[int]) -> int | None:
        """How many forces of the only friction that slips fit; None where what presses without it vanishes too."""
        presses, rows = felt.presses, list(held)
        forces = np.zeros(len(self.states.rows))
        if rows:
            forces[rows] = np.linalg.lstsq(felt.mobility[rows][:, rows], -felt.free[rows], rcond=1e-11)[0]
        at = presses.numbers.index(number)
        response = response_with_held(felt.mobility, held, self.states.rows[number])
        reaction = presses.base[at] + presses.gains[at] @ forces
        sense = self.states.get(state, "sense", number) or 1.0
        slipping = presses.reactions(self._present_forces(state, felt))[number]
        if np.max(np.abs(reaction)) <= VANISHES * np.max(np.abs(slipping)):
            return None
        return presses.solutions(number, reaction, presses.gains[at] @ response, sense)

    def _bounds(self, felt: ContactForces, number: int, bound: float = 0.0) -> tuple[float, float]:
        """Least and greatest force of a contact that is held."""
        contact = self.states.contacts[number]
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
        rows, right = [self.states.rows[number]], self.states.slipping_accelerations(state, felt)
        for k in held:
            if k != number and not self._follows(felt, self.states.rows[k], rows):
                rows.append(self.states.rows[k])
        return float(np.linalg.solve(felt.mobility[rows][:, rows], -right[rows])[0])

    def _is_implied(self, felt: ContactForces, number: int, others: Iterable[int]) -> bool:
        """Whether a contact cannot move where others hold."""
        return self._follows(felt, self.states.rows[number], self._independent(felt, others))

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
            if self.states.contacts[k].kind != FRICTION:
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
