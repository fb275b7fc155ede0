"""Linear equations of a group of higher class, made small: what follows from a few free coordinates is left out.

A link that hangs on a known point has one free coordinate, its turn about that point; a point of such a link has
none. Only the equations that are left over have to be solved together (tearing; Cellier and Kofman, Continuous
System Simulation, 2006, section 7). The order of elimination follows from the group alone.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.arrays import ARRAYS
from centrode.geometry.plane import is_literal_zero
from centrode.structure.constraints import Entity, PointInLink, Positions
from centrode.structure.dimensions import Dimensions
from centrode.structure.groups import Newton

Array: TypeAlias = npt.NDArray[np.float64]
Number: TypeAlias = Any
Shift: TypeAlias = Sequence[Number]
Block: TypeAlias = tuple[tuple[Number, Number], tuple[Number, Number]]


class Follow(NamedTuple):
    """An unknown, the hinge from which it follows, and the first of its free coordinates.

    A link that hangs on a point is free to turn; without a hinge all coordinates of the unknown are free.
    """

    entity: Entity
    by: PointInLink | None
    first: int

    @property
    def turn(self) -> int:
        """The free coordinate that is the turn of a link."""
        return self.first if self.by is not None else self.first + 2


@dataclass(frozen=True)
class Pattern:
    """The unknowns of a group in the order in which they follow, and the equations left over."""

    follows: tuple[Follow, ...]
    kept: tuple[int, ...]

    @property
    def free(self) -> int:
        """Number of free coordinates."""
        return len(self.kept)


@lru_cache(maxsize=256)
def pattern_of(group: Newton) -> Pattern:
    """In which order the unknowns of a group follow."""
    whole = [
        c
        for c, row in group.equations
        if row == 1 and isinstance(c, PointInLink) and (c, 0) in group.equations
    ]
    left = [Entity("link", name) for name in group.links] + [Entity("point", name) for name in group.points]
    follows: list[Follow] = []
    used: set[PointInLink] = set()
    free = 0
    while left:
        found = next((f for entity in left if (f := _hinge(entity, whole, left))), None)
        entity = left[0] if found is None else found[0]
        by = None if found is None else found[1]
        follows.append(Follow(entity, by, free))
        left.remove(entity)
        if by is None:
            free += entity.unknowns
        else:
            used.add(by)
            free += entity.kind == "link"
    kept = tuple(i for i, (c, _row) in enumerate(group.equations) if c not in used)
    return Pattern(tuple(follows), kept)


def _hinge(
    entity: Entity, whole: Sequence[PointInLink], left: Sequence[Entity]
) -> tuple[Entity, PointInLink] | None:
    """A hinge that ties an unknown to what is known already."""
    for constraint in whole:
        point, link = constraint.bodies
        if entity in (point, link) and not (point in left and link in left):
            return entity, constraint
    return None


class Linear:
    """The equations of a group made linear at k places.

    `matrix` (k, free, free) are derivatives of the equations left over by the free coordinates: turns [rad], and
    shifts in the greatest length; their lengths are in the greatest length too.
    """

    def __init__(self, group: Newton, numbers: Dimensions, at: Positions, places: int) -> None:
        self.group, self.numbers, self.places = group, numbers, places
        self.pattern = pattern_of(group)
        found = {c: c.rows(numbers, at) for c, _row in group.equations}
        self.rows = [found[c][row] for c, row in group.equations]
        self.number = {equation: i for i, equation in enumerate(group.equations)}
        self.tangents: dict[Entity, dict[int, Shift]] = {}
        self._inverses: dict[Entity, Block] = {}
        self._shifts: dict[Entity, Sequence[Shift]] = {}
        for follow in self.pattern.follows:
            self.tangents[follow.entity] = self._tangents(follow, at)
        self.units = [
            1.0 if group.equations[i][0].angular else 1.0 / numbers.scale for i in self.pattern.kept
        ]
        self.matrix = self._matrix()

    def _tangents(self, follow: Follow, at: Positions) -> dict[int, Shift]:
        """How an unknown moves with each free coordinate."""
        entity, by, space = follow.entity, follow.by, self.numbers.space
        if by is None:
            if entity.kind == "point":
                return {follow.first: (self.numbers.scale, 0.0), follow.first + 1: (0.0, self.numbers.scale)}
            # the link's first point may only ride on it, and be solved after the group
            place = next(iter(self.numbers.local[entity.name].values()))
            pivot = space.place(ARRAYS, at.poses[entity.name], place)
            shifts = space.shifts(ARRAYS, pivot, self.numbers.scale)
            return {follow.first + k: shift for k, shift in enumerate(shifts)}
        one, other = self._pair(by)
        if entity.kind == "link":
            pivot = at.points[by.point]
            self._shifts[entity] = space.shifts(ARRAYS, pivot, 1.0)[:2]
            block = [[_dot(row[entity], shift) for shift in self._shifts[entity]] for row in (one, other)]
        else:
            block = [[row[entity][0], row[entity][1]] for row in (one, other)]
        self._inverses[entity] = _inverse(block)
        source = by.bodies[0] if entity.kind == "link" else by.bodies[1]
        tangents: dict[int, Shift] = {}
        for j, shift in self.tangents.get(source, {}).items():
            tangents[j] = self._answer(entity, [_minus(_dot(row[source], shift)) for row in (one, other)])
        if entity.kind == "link":
            tangents[follow.first] = space.spin(at.poses[entity.name], at.points[by.point])
        return tangents

    def _pair(self, by: PointInLink) -> tuple[Mapping[Entity, Shift], Mapping[Entity, Shift]]:
        return self.rows[self.number[by, 0]], self.rows[self.number[by, 1]]

    def _answer(self, entity: Entity, right: Sequence[Number]) -> Shift:
        """How an unknown moves so that the two rows of its hinge give what is asked."""
        (a, b), (c, d) = self._inverses[entity]
        pair = _dot((a, b), right), _dot((c, d), right)
        if entity.kind == "point":
            return pair
        return _combined(pair, self._shifts[entity])

    def _matrix(self) -> Array:
        free = self.pattern.free
        parts = [x for k in self.pattern.kept for row in self.rows[k].values() for x in row]
        matrix = np.zeros(
            (self.places, free, free), dtype=np.result_type(np.float64, *map(np.asarray, parts))
        )
        for i, (k, unit) in enumerate(zip(self.pattern.kept, self.units, strict=True)):
            for entity, slopes in self.rows[k].items():
                for j, shift in self.tangents.get(entity, {}).items():
                    matrix[:, i, j] += _dot(slopes, shift) * unit
        return matrix

    def reduced(self, right: Sequence[Number]) -> tuple[dict[Entity, Shift], list[Number]]:
        """What right sides of all equations ask for at no free motion, and the right sides left over."""
        moved: dict[Entity, Shift] = {}
        for entity, by, _first in self.pattern.follows:
            if by is None:
                continue
            source = by.bodies[0] if entity.kind == "link" else by.bodies[1]
            wanted = [right[self.number[by, k]] for k in (0, 1)]
            if source in moved:
                rows = self._pair(by)
                wanted = [x - _dot(row[source], moved[source]) for x, row in zip(wanted, rows, strict=True)]
            moved[entity] = self._answer(entity, wanted)
        rest = []
        for k, unit in zip(self.pattern.kept, self.units, strict=True):
            value = right[k]
            for entity, slopes in self.rows[k].items():
                if entity in moved:
                    value = value - _dot(slopes, moved[entity])
            rest.append(value * unit)
        return moved, rest

    def whole(self, moved: Mapping[Entity, Shift], free: Sequence[Number]) -> dict[Entity, Shift]:
        """How all unknowns move: as asked for at no free motion, and with free coordinates."""
        found: dict[Entity, Shift] = {}
        for entity, tangents in self.tangents.items():
            total = moved.get(entity, (0.0,) * entity.unknowns)
            for j, shift in tangents.items():
                total = tuple(_sum(t, _dot((x,), (free[j],))) for t, x in zip(total, shift, strict=True))
            found[entity] = total
        return found


def solved(matrix: Array, right: Array) -> Array:
    """Solution (k, n, m) of the equations at every place; NaN where the matrix is singular."""
    try:
        return np.asarray(np.linalg.solve(matrix, right))
    except np.linalg.LinAlgError:
        sign, _size = np.linalg.slogdet(matrix)
        found = np.full(right.shape, np.nan, dtype=np.result_type(matrix, right))
        found[sign != 0.0] = np.linalg.solve(matrix[sign != 0.0], right[sign != 0.0])
        return found


def _sum(a: Number, b: Number) -> Number:
    return b if is_literal_zero(a) else a if is_literal_zero(b) else a + b


def _minus(a: Number) -> Number:
    return a if is_literal_zero(a) else -a


def _dot(a: Sequence[Number], b: Sequence[Number]) -> Number:
    """Scalar product; literal zeros and ones, of which rows are full, cost nothing."""
    total: Number = 0.0
    for x, y in zip(a, b, strict=True):
        if is_literal_zero(x) or is_literal_zero(y):
            continue
        total = _sum(
            total, y if type(x) is float and x == 1.0 else x if type(y) is float and y == 1.0 else x * y
        )
    return total


def _combined(factors: Sequence[Number], shifts: Sequence[Shift]) -> Shift:
    return tuple(_dot(factors, [shift[k] for shift in shifts]) for k in range(len(shifts[0])))


def _inverse(block: Sequence[Sequence[Number]]) -> Block:
    """Inverse of a matrix of two rows and columns."""
    (a, b), (c, d) = block
    over = 1.0 / (_dot((a,), (d,)) - _dot((b,), (c,)))
    return (_dot((d,), (over,)), _minus(_dot((b,), (over,)))), (
        _minus(_dot((c,), (over,))),
        _dot((a,), (over,)),
    )
