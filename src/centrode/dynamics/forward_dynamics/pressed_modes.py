"""Friction by coefficients at an event: what presses each joint, and the modes that fit it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.forward_dynamics.contacts import Contact
from centrode.dynamics.forward_dynamics.reaction_friction import greatest_press, pressing_force
from centrode.numerics.arrays import ARRAYS

Array: TypeAlias = npt.NDArray[np.float64]

NEWTON_STEPS, ROUNDING = 40, 1e-15
"""Steps of Newton's method for friction, and share of the greatest force below which one is rounding."""
BEYOND = 1.0 + 1e-6
"""By how much a coefficient is greater where solutions are counted at the place at which their number changes."""
TIED = 1e-9
"""Two numbers that press are equal where they differ by less than this share of the greater one."""


class FrictionLimits(NamedTuple):
    """Bounds of a force of friction along its coordinate [N or N m].

    Attributes
    ----------
    forwards, backwards : forces while it slips forwards and backwards
    least, most : while it sticks
    """

    forwards: float
    backwards: float
    least: float
    most: float


@dataclass(frozen=True)
class JointPresses:
    """Reactions of joints with friction by coefficients as functions of forces along the rows of contacts.

    Attributes
    ----------
    numbers : of the contacts
    contacts : these
    base : (contacts, 2) without forces of contacts [N or N m]
    gains : (contacts, 2, rows) by them
    """

    numbers: tuple[int, ...]
    contacts: tuple[Contact, ...]
    base: Array
    gains: Array

    def reactions(self, forces: Array) -> dict[int, Sequence[float]]:
        """Reactions [N or N m] at forces along rows (rows), by the numbers of contacts."""
        found = self.base + self.gains @ forces
        return {
            k: [float(x) for x in row[: len(contact.pressing.openings)]]  # type: ignore[union-attr]
            for k, contact, row in zip(self.numbers, self.contacts, found, strict=True)
        }

    def limits(self, forces: Array) -> dict[int, FrictionLimits]:
        """Bounds of the forces of friction at forces along rows (rows)."""
        found = {}
        for contact, (k, reaction) in zip(self.contacts, self.reactions(forces).items(), strict=True):
            assert contact.pressing is not None
            kinetic = contact.pressing.kinetic
            slips = [
                kinetic
                * float(pressing_force(ARRAYS, contact, *contact.pressing.parts(reaction, sense, kinetic)))
                for sense in (1.0, -1.0)
            ]
            holds = [float(greatest_press(ARRAYS, contact, reaction, sense)) for sense in (1.0, -1.0)]
            found[k] = FrictionLimits(-slips[0], slips[1], min(-holds[0], -slips[0]), max(holds[1], slips[1]))
        return found

    def settled_forces(
        self, mobility: Array, held: Sequence[int], forces: Array, slips: Mapping[int, tuple[int, float]]
    ) -> Array:
        """Forces along rows (rows) with friction of what slips as great as what presses then; what is held follows.

        Parameters
        ----------
        mobility, held : (rows, rows), and rows whose accelerations stay what they are
        slips : number of a contact -> its row and its sense
        """
        if not slips:
            return forces
        at = [self.numbers.index(k) for k in slips]
        rows, senses = [row for row, _sense in slips.values()], [sense for _row, sense in slips.values()]
        ways = np.array([response_with_held(mobility, held, row) for row in rows])
        gains = np.einsum("kjr,mr->kjm", self.gains[at], ways)
        forces = forces.copy()
        for _step in range(NEWTON_STEPS):
            reactions = self.base[at] + self.gains[at] @ forces
            matrix, left = np.eye(len(at)), forces[rows].copy()
            for i, (k, sense) in enumerate(zip(at, senses, strict=True)):
                pressing = self.contacts[k].pressing
                assert pressing is not None
                count, factor = len(pressing.openings), sense * pressing.kinetic
                parts = np.array(pressing.parts(reactions[i, :count].tolist(), sense, pressing.kinetic))
                weight = _weight(pressing.is_round, parts)
                left[i] += factor * float(weight @ parts)
                for j in range(len(at)):
                    gain = pressing.parts(gains[i, :count, j].tolist(), sense, pressing.kinetic)
                    matrix[i, j] += factor * float(weight @ np.array(gain))
            try:
                change = -np.linalg.solve(matrix, left)
            except np.linalg.LinAlgError:
                break
            forces += change @ ways
            if not np.max(np.abs(change)) > ROUNDING * np.max(np.abs(forces)):
                break
        return forces

    def weights(
        self, forces: Array, senses: Mapping[int, float], before: Mapping[int, tuple[float, float]]
    ) -> dict[int, tuple[float, float]]:
        """Weights of what presses; `before` are those that have just lost, which count no more where others tie."""
        found = {}
        for contact, (k, reaction) in zip(self.contacts, self.reactions(forces).items(), strict=True):
            assert contact.pressing is not None
            x, y = contact.pressing.parts(reaction, senses[k], contact.pressing.kinetic)
            if contact.pressing.is_round:
                length = float(np.hypot(x, y))
                found[k] = (x / length, y / length) if length > 0.0 else (0.0, 0.0)
                continue
            choices = [((1.0, 0.0), x), ((-1.0, 0.0), -x)]
            if len(contact.pressing.openings) > 1:
                choices += [((0.0, 1.0), y), ((0.0, -1.0), -y)]
            choices.sort(key=lambda choice: -choice[1])
            size = max(abs(x), abs(y))
            best = [pair for pair, value in choices if value >= choices[0][1] - TIED * size]
            lost = before.get(k)
            # where a number that presses meets another one, it is the other that grows
            found[k] = next(pair for pair in (*best, *(pair for pair, _value in choices)) if pair != lost)
        return found

    def feedback(self, mobility: Array, held: Sequence[int], slips: Mapping[int, int]) -> dict[int, float]:
        """How much at most each friction that slips adds to itself and others, by numbers; `slips` has their rows."""
        found = dict.fromkeys(slips, 0.0)
        for row in slips.values():
            gains = self.gains @ response_with_held(mobility, held, row)
            for contact, k, gain in zip(self.contacts, self.numbers, gains, strict=True):
                if k in found:
                    assert contact.pressing is not None
                    reaction = [float(x) for x in gain[: len(contact.pressing.openings)]]
                    parts = contact.pressing.parts(reaction, 1.0, contact.pressing.kinetic)
                    found[k] += contact.pressing.kinetic * float(pressing_force(ARRAYS, contact, *parts))
        return found

    def solutions(self, number: int, reaction: Array, gain: Array, sense: float) -> int:
        """How many forces x >= 0 of the only friction that slips fit x = c m(r - s g x), just beyond where they change.

        `reaction` r and `gain` g (2) are those without it and by a unit of its force along the coordinate.
        """
        contact = self.contacts[self.numbers.index(number)]
        pressing = contact.pressing
        assert pressing is not None
        count = len(pressing.openings)
        u, v = pressing.parts([float(x) for x in reaction[:count]], sense, pressing.kinetic)
        a, b = (-sense * x for x in pressing.parts([float(x) for x in gain[:count]], sense, pressing.kinetic))
        factor = BEYOND * pressing.kinetic
        if pressing.is_round:
            # x^2 = c^2 |r + g x|^2
            roots = np.roots(
                [
                    factor**2 * (a * a + b * b) - 1.0,
                    2.0 * factor**2 * (a * u + b * v),
                    factor**2 * (u * u + v * v),
                ]
            )
            return int(np.sum((np.abs(roots.imag) <= TIED * np.abs(roots)) & (roots.real >= 0.0)))
        found = 0
        for first, second in ((1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0))[: 2 * count]:
            feed = 1.0 - factor * (first * a + second * b)
            size = factor * (first * u + second * v) / feed if feed else -1.0
            presses = first * (u + a * size) + second * (v + b * size)
            greatest = max(abs(u + a * size), abs(v + b * size))
            found += bool(size >= 0.0 and presses >= greatest - TIED * abs(greatest))
        return found


def _weight(is_round: bool, parts: Array) -> Array:
    """Derivative of what presses by its two numbers."""
    if is_round:
        length = float(np.hypot(*parts))
        return parts / length if length > 0.0 else np.zeros(2)
    greater = int(np.argmax(np.abs(parts)))
    weight = np.zeros(2)
    weight[greater] = np.sign(parts[greater])
    return weight


def response_with_held(mobility: Array, held: Sequence[int], row: int) -> Array:
    """Forces along rows (rows) that a unit of force along one brings about where others hold, its own included."""
    forces = np.zeros(len(mobility))
    forces[row] = 1.0
    if held:
        rows = list(held)
        forces[rows] -= np.linalg.lstsq(mobility[rows][:, rows], mobility[rows, row], rcond=1e-11)[0]
    return forces
