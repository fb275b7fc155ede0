"""States of a motion with contacts: where modes and works stand in them, and what contacts feel there."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.forward_dynamics.contact_forces import ContactForces
from centrode.dynamics.forward_dynamics.contacts import FRICTION, Contact, pressed_numbers
from centrode.dynamics.forward_dynamics.motion_functions import MotionFunctions
from centrode.dynamics.forward_dynamics.motion_problem import GUARD, INDEPENDENCE, UNIQUE, Guard, guards_of
from centrode.dynamics.forward_dynamics.pressed_modes import JointPresses
from centrode.dynamics.load_coordinates import is_angular
from centrode.dynamics.state import length_unit
from centrode.numerics.initial_value_problems import HEADER

Array: TypeAlias = npt.NDArray[np.float64]

TOUCHING = 1e-10
"""A gap below this share of the greatest length is closed, a speed below this share of the usual one is none."""


@dataclass(frozen=True)
class ContactStates:
    """Reads and changes states of one motion.

    A state is that of the integrator, (header + carried, 1); a row (1 + carried) has the time first.

    Attributes
    ----------
    motion : its equations as functions
    parameters : (parameters, 1) of its steps
    rate : what speeds are compared with [1/s]
    """

    motion: MotionFunctions
    parameters: Array
    rate: float

    @cached_property
    def contacts(self) -> tuple[Contact, ...]:
        """Contacts with their numbers."""
        return self.motion.equations.contacts

    @cached_property
    def guards(self) -> tuple[Guard, ...]:
        """Guards in their order."""
        return guards_of(self.motion.equations)

    @cached_property
    def rows(self) -> dict[int, int]:
        """Number of a contact -> its row among those of contacts."""
        rows = self.motion.equations.contact_rows
        return {number: row - rows[0][0] for row, number in rows}

    @cached_property
    def pressed_numbers(self) -> tuple[int, ...]:
        """Numbers of the contacts with friction by coefficients."""
        return pressed_numbers(self.contacts)

    @cached_property
    def places(self) -> dict[str, int]:
        """Place of what is carried in a state."""
        return {name: HEADER + k for k, name in enumerate(self.motion.problem.carried_names)}

    @cached_property
    def mode_places(self) -> dict[str, list[int]]:
        """Places in a state of what tells the modes, contact by contact."""
        names = self.motion.names
        told = {"active": names.active, "sense": names.senses, "held": names.held}
        found = {what: [self.places[one] for one in of_each] for what, of_each in told.items()}
        for what in ("first", "second"):
            named = [f"{what} {k}" for k in range(len(self.contacts))]
            found[what] = [self.places.get(name, -1) for name in named]
        return found

    @cached_property
    def work_places(self) -> list[int]:
        """Places in a state of the works, those of contacts last."""
        return [self.places[name] for name in self.motion.names.works]

    @cached_property
    def guard_places(self) -> Array:
        """Places in a state of the guards."""
        return np.array([self.places[name] for name in self.motion.names.guards], dtype=np.intp)

    @cached_property
    def units(self) -> Array:
        """What coordinates of contacts are compared with: 1 rad, or the greatest length."""
        scale = float(self.motion.equations.numbers.scale) * length_unit(self.motion.equations.tree.mechanism)
        return np.array([1.0 if is_angular(c.coordinate) else scale for c in self.contacts])

    @cached_property
    def numbers(self) -> list[float]:
        """Values of the parameters."""
        return [float(x) for x in self.parameters[:, 0]]

    def get(self, state: Array, what: str, number: int) -> float:
        """A number of the mode of a contact."""
        return state.item(self.mode_places[what][number])

    def set(self, state: Array, what: str, number: int, value: float) -> None:
        """Give a contact a number of its mode: "active", "sense", "held", "first" or "second"."""
        state[self.mode_places[what][number], 0] = value

    def forces_in(self, row: Array) -> ContactForces:
        """What contacts feel at a row (1 + carried), the time first."""
        return self.forces_at(float(row[0]), row[1:].tolist())

    def forces_at(self, time: float, carried: Sequence[float]) -> ContactForces:
        """What contacts feel at a time, by what is carried (carried)."""
        equations = self.motion.equations
        found = self.motion.contact_function([time, *self.numbers, *carried])
        count, rows, size, kept = (
            len(self.contacts),
            len(self.rows),
            equations.size,
            len(equations.kept),
        )
        numbers = np.array(found, dtype=np.float64)
        own = numbers[: 4 * count].reshape(count, 4)
        width = 2 + rows + size + kept
        by_row = numbers[4 * count : 4 * count + rows * width].reshape(rows, width)
        rest = numbers[4 * count + rows * width :]
        conditions = len(equations.conditions)
        pressed = rest[kept + conditions :].reshape(len(self.pressed_numbers), 2, 1 + rows)
        presses = JointPresses(
            self.pressed_numbers,
            tuple(self.contacts[k] for k in self.pressed_numbers),
            pressed[:, :, 0],
            pressed[:, :, 1:],
        )
        return ContactForces(
            own[:, 0], own[:, 1], own[:, 2], own[:, 3], by_row[:, 0], by_row[:, 1], by_row[:, 2 : 2 + rows],
            by_row[:, 2 + rows : 2 + rows + size].T, by_row[:, 2 + rows + size :].T,
            rest[:kept], rest[kept : kept + conditions], presses,
        )  # fmt: skip

    def is_touching(self, felt: ContactForces, number: int, bound: float) -> bool:
        """Whether the gap at a bound is closed."""
        contact = self.contacts[number]
        level = contact.least if bound < 0.0 else contact.most
        if level is None:
            return False
        return bool(bound * (level - felt.values[number]) <= TOUCHING * self.units[number])

    def slipping_accelerations(self, state: Array, felt: ContactForces) -> Array:
        """Accelerations of the rows with the friction of what slips."""
        forces = np.zeros(len(self.rows))
        for k, row in self.rows.items():
            if self.contacts[k].kind == FRICTION:
                sense = self.get(state, "sense", k)
                forces[row] = felt.forwards[k] if sense > 0.0 else felt.backwards[k] if sense < 0.0 else 0.0
        return felt.free + felt.mobility @ forces

    def acceleration(self, state: Array, felt: ContactForces, number: int) -> float:
        """Acceleration of a contact's coordinate with the forces of all others."""
        held = [k for k in self.rows if k != number and self.get(state, "active", k)]
        right = self.slipping_accelerations(state, felt)
        row = self.rows[number]
        if not held:
            return float(right[row])
        rows = [self.rows[k] for k in held]
        forces = np.linalg.lstsq(felt.mobility[rows][:, rows], -right[rows], rcond=1e-11)[0]
        return float(right[row] + felt.mobility[row, rows] @ forces)

    def acceleration_at(self, row: Array, felt: ContactForces, number: int) -> float:
        """Acceleration of a contact's coordinate at a row (1 + carried) with the forces of all others."""
        return self.acceleration(np.concatenate([np.zeros(HEADER - 1), row])[:, None], felt, number)

    def close(self, state: Array) -> bool:
        """Give a state everything that follows from its modes; whether its friction has one solution."""
        problem = self.motion.problem
        carried = state[HEADER:, 0].tolist()
        if INDEPENDENCE in problem.carried_names:
            carried[problem.carried_names.index(INDEPENDENCE)] = 0.0
        closed = self.motion.closing_function([float(state[0, 0]), 1.0, *self.numbers, *carried])
        state[HEADER:, 0] = closed
        is_unique = not any(
            self.guards[k].kind == UNIQUE and state[row, 0] < 0.0 for k, row in enumerate(self.guard_places)
        )
        # what is passed already is none: a guard at zero counts from there on
        rows = self.guard_places
        state[rows, 0] = np.maximum(state[rows, 0], 0.0)
        if state.item(self.places[GUARD]) >= 2.0:
            state[self.places[GUARD]] -= 2.0
        return is_unique


def row_of(state: Array) -> Array:
    """The time and what is carried (1 + carried) of a state of one motion."""
    row = state[HEADER - 1 :, 0].copy()
    row[0] = state[0, 0]
    return row
