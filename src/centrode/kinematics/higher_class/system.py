"""The equations of a group of higher class at many places, over any algebra.

What is known beside the group is given at every place; the state of a place is where the group's points and
links are. Derivatives follow from the same equations over jets, order by order, and bounds of rounding errors
over bounded numbers (Griewank and Walther, Evaluating Derivatives, 2nd ed., 2008, section 13; Higham, Accuracy
and Stability of Numerical Algorithms, 2nd ed., 2002, section 25).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.arrays import ARRAYS
from centrode.algebra.jets import Jet
from centrode.algebra.rounding import ROUNDED, Rounded
from centrode.geometry.plane import rotor_of
from centrode.kinematics.higher_class.reduction import Linear, Pattern, Shift, pattern_of, solved
from centrode.kinematics.paths import JETS
from centrode.structure.constraints import Constraint, Entity, Positions
from centrode.structure.dimensions import Dimensions
from centrode.structure.groups import Newton

Array: TypeAlias = npt.NDArray[np.float64]
Mask: TypeAlias = npt.NDArray[np.bool_]
Number: TypeAlias = Any
Namespace: TypeAlias = Any


@dataclass(frozen=True)
class Motion:
    """A small motion of a group: how every unknown moves, and how its free coordinates change."""

    shifts: Mapping[Entity, Shift]
    free: Sequence[Number]


@dataclass(frozen=True)
class System:
    """The equations of a group at k places: dimensions and known positions are floats or (k,) arrays.

    A state (k, width) holds the numbers of the group's points, then those of its links' poses, then the angles of
    its links with their turns, where turns are counted.
    """

    group: Newton
    numbers: Dimensions
    known: Positions
    places: int

    def taken(self, which: npt.NDArray[np.intp]) -> System:
        """The same equations at some of the places."""

        def take(x: Number) -> Number:
            return x if np.ndim(x) == 0 else x[which]

        return System(self.group, self.numbers.mapped(take), self.known.mapped(take), len(which))

    @cached_property
    def pattern(self) -> Pattern:
        """What follows from what."""
        return pattern_of(self.group)

    @property
    def free(self) -> int:
        """Number of free coordinates."""
        return self.pattern.free

    @property
    def turning(self) -> int:
        """How many numbers of a state are angles with their turns: the last ones."""
        return len(self._turns)

    @cached_property
    def _turns(self) -> dict[str, int]:
        """The free coordinate that turns a link, where turns are counted."""
        if "rolling" in self.numbers.space.lacks:
            return {}  # no turns are counted there
        return {f.entity.name: f.turn for f in self.pattern.follows if f.entity.kind == "link"}

    def at(self, m: Namespace, known: Positions, state: Array, motion: Motion | None = None) -> Positions:
        """Known positions with those of a state, moved a little, over any algebra."""
        at, space, column = known.copied(), self.numbers.space, 0
        for name in self.group.points:
            size = len(space.axes)
            place = tuple(state[:, column + k] for k in range(size))
            column += size
            at.points[name] = (
                place if motion is None else space.moved_point(m, place, motion.shifts[Entity("point", name)])
            )
        for name in self.group.links:
            parts = []
            for part in space.at_rest:
                parts.append(tuple(state[:, column + k] for k in range(len(part))))
                column += len(part)
            pose = type(space.at_rest)(*parts)
            at.poses[name] = (
                pose if motion is None else space.moved_pose(m, pose, motion.shifts[Entity("link", name)])
            )
        for k, (name, turn) in enumerate(self._turns.items()):
            angle = state[:, column + k]
            at.angles[name] = angle if motion is None else motion.free[turn] + angle
        return at

    def numbers_of(self, at: Positions) -> list[Number]:
        """The numbers of a state, over any algebra."""
        numbers = [x for name in self.group.points for x in at.points[name]]
        numbers += [x for name in self.group.links for part in at.poses[name] for x in part]
        return numbers + [at.angles[name] for name in self._turns]

    def weights(self) -> Array:
        """What makes the numbers of a state comparable, (k, width): lengths count in the greatest length."""
        length = 1.0 / self.numbers.scale
        weights = [length for _name in self.group.points for _axis in self.numbers.space.axes]
        rest = self.numbers.space.at_rest
        parts = [length if name == "origin" else 1.0 for name, part in rest._asdict().items() for _x in part]
        return self.stacked([*weights, *parts * len(self.group.links), *[1.0] * len(self._turns)])

    def state_of(self, at: Positions) -> Array:
        """The state in which positions are: (k, width)."""
        return self.stacked(self.numbers_of(at))

    def moved(self, state: Array, motion: Motion) -> Array:
        """A state moved a little."""
        return self.righted(self.state_of(self.at(ARRAYS, self.known, state, motion)))

    def righted(self, state: Array) -> Array:
        """A state whose links keep their own distances, and whose angles are those of its links."""
        at, space = self.at(ARRAYS, self.known, state), self.numbers.space
        for name in self.group.points:
            at.points[name] = space.moved_point(ARRAYS, at.points[name], (0.0, 0.0))
        for name in self.group.links:
            at.poses[name] = space.righted(ARRAYS, at.poses[name])
        for name in self._turns:
            near = at.angles[name]
            at.angles[name] = near + space.turn(
                ARRAYS, at.poses[name], space.at_rest, rotor_of(ARRAYS, near), None
            )
        return self.state_of(at)

    def residual(self, m: Namespace, at: Positions) -> list[Number]:
        """Left sides of the equations."""
        found: dict[Constraint, list[Number]] = {}
        values = []
        for constraint, row in self.group.equations:
            if constraint not in found:
                found[constraint] = constraint.residual(m, self.numbers, at)
            values.append(found[constraint][row])
        return values

    def linear(self, at: Positions) -> Linear:
        """The equations made linear at positions."""
        return Linear(self.group, self.numbers, at, self.places)

    def gap(self, state: Array) -> Array:
        """Greatest left side of the equations, in rad or in the greatest length: (k,)."""
        values = self.residual(ARRAYS, self.at(ARRAYS, self.known, state))
        units = [1.0 if c.angular else 1.0 / self.numbers.scale for c, _row in self.group.equations]
        gaps = np.abs(self.stacked([x * u for x, u in zip(values, units, strict=True)]))
        return np.asarray(np.max(gaps, axis=1), dtype=np.float64)

    def stacked(self, values: Sequence[Number]) -> Array:
        """Numbers as an array (k, numbers)."""
        found = np.empty(
            (len(values), self.places), dtype=np.result_type(np.float64, *map(np.asarray, values))
        )
        for row, value in zip(found, values, strict=True):
            row[:] = value
        return found.T

    def jets(self, known: Positions, state: Array, linear: Linear, order: int) -> Motion:
        """Taylor coefficients of the motion from a converged state, by the variable of the known jets."""
        zero = np.zeros(self.places)
        shifts = {f.entity: [[zero] for _ in range(f.entity.unknowns)] for f in linear.pattern.follows}
        free = [[zero] for _ in range(self.free)]
        inverse = solved(linear.matrix, np.broadcast_to(np.eye(self.free), linear.matrix.shape))
        for k in range(1, order + 1):
            motion = _as_jets(shifts, free, k)
            values = self.residual(JETS, self.at(JETS, known.mapped(lambda x, k=k: cut(x, k)), state, motion))  # type: ignore[misc]
            moved, rest = linear.reduced([_minus_coefficient(x, k) for x in values])
            freely = list(times(inverse, self.stacked(rest)).T)
            for entity, shift in linear.whole(moved, freely).items():
                for c, x in zip(shifts[entity], shift, strict=True):
                    c.append(x)
            for c, x in zip(free, freely, strict=True):
                c.append(x)
        return _as_jets(shifts, free, order)

    def bounds(self, known: Positions, state: Array, linear: Linear) -> Motion:
        """The motion zero with the bound of the state's rounding error."""
        values = [Rounded.of(x) for x in self.residual(ROUNDED, self.at(ROUNDED, known, state))]
        zero = np.zeros(self.places)
        moved, rest = linear.reduced([Rounded(zero, x.bound + np.abs(x.value)) for x in values])
        inverse = solved(linear.matrix, np.broadcast_to(np.eye(self.free), linear.matrix.shape))
        bound = times(np.abs(inverse), self.stacked([Rounded.of(x).bound for x in rest]))
        free = [Rounded(zero, column) for column in bound.T]
        shifts = {
            entity: tuple(Rounded(zero, Rounded.of(x).bound) for x in shift)
            for entity, shift in linear.whole(moved, free).items()
        }
        return Motion(shifts, free)


def _as_jets(shifts: Mapping[Entity, list[list[Number]]], free: list[list[Number]], order: int) -> Motion:
    def jet(c: list[Number]) -> Jet:
        return Jet([*c[: order + 1], *[0.0] * (order + 1 - len(c))])

    return Motion({entity: tuple(map(jet, cs)) for entity, cs in shifts.items()}, [jet(c) for c in free])


def cut(x: Number, order: int) -> Number:
    """A jet without what is beyond an order."""
    return Jet(x.coefficients[: order + 1]) if isinstance(x, Jet) else x


def _minus_coefficient(x: Number, k: int) -> Number:
    return -x.coefficients[k] if isinstance(x, Jet) else 0.0


def total(columns: Array) -> Array:
    """Sum over the second axis, added up in one order whatever the number of places."""
    found = columns[:, 0].copy()
    for j in range(1, columns.shape[1]):
        found += columns[:, j]
    return found


def times(matrix: Array, vector: Array) -> Array:
    """Product at every place, added up in one order whatever the number of places."""
    total = np.zeros(vector.shape, dtype=np.result_type(matrix, vector))
    for j in range(vector.shape[1]):
        total += matrix[:, :, j] * vector[:, j : j + 1]
    return total
