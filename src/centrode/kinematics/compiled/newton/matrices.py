"""The matrix of a group of higher class as expressions, made small once more: turns of leaves are found last."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

from centrode.algebra.expression_functions import EXPRESSIONS
from centrode.algebra.expressions import Node, Operand
from centrode.geometry.plane import Vector, dot
from centrode.kinematics.compiled.newton.small_systems import inverse, minus, product, times
from centrode.kinematics.higher_class.chains import Chain

Number: TypeAlias = Any


@dataclass(frozen=True)
class Matrix:
    """Equations of a group made linear.

    Attributes
    ----------
    core : the equations without those across the arms of leaves, by all coordinates but the turns of leaves
    inverse : of the core
    rows, columns : where they stand among all
    terms : of each row of the core, what the terms of its equation come up to: in rad, or in the greatest length
    across : of each leaf, its equation by the core's coordinates
    leaves : of each leaf, its equation, its turn, and one over the derivative of that by this
    arms : along which equations of leaves are seen
    """

    core: Sequence[Sequence[Operand]]
    inverse: Sequence[Sequence[Operand]]
    rows: Sequence[int]
    columns: Sequence[int]
    terms: Sequence[Operand]
    across: Sequence[Sequence[Operand]]
    leaves: Sequence[tuple[int, int, Operand]]
    arms: Sequence[Vector]

    @classmethod
    def of(cls, chain: Chain, columns: Sequence[Sequence[Operand]], arms: Sequence[Vector]) -> Matrix:
        """From the columns of all derivatives, in the order of the equations left over."""
        whole = [list(row) for row in zip(*columns, strict=True)]
        leaves = []
        terms: list[Operand] = [1.0] * len(whole)
        for leaf in chain.leaves:
            local = chain.arm(leaf)
            terms[leaf.rows[0]] = EXPRESSIONS.sqrt(dot(local, local)) * (1.0 / chain.unit)
            # across its arm a leaf turns by minus the square of that, whatever it stands at
            leaves.append((leaf.rows[1], leaf.column, -(chain.unit**2) / dot(local, local)))
        rows = [i for i in range(len(whole)) if i not in [row for row, _column, _over in leaves]]
        others = [j for j in range(len(whole)) if j not in [column for _row, column, _over in leaves]]
        core = [[whole[i][j] for j in others] for i in rows]
        across = [[whole[i][j] for j in others] for i, _column, _over in leaves]
        return cls(core, inverse(core), rows, others, [terms[i] for i in rows], across, leaves, arms)

    @property
    def changing(self) -> list[tuple[tuple[int, int], Node]]:
        """The numbers of the core that are not the same everywhere."""
        return [
            ((i, j), x) for i, row in enumerate(self.core) for j, x in enumerate(row) if isinstance(x, Node)
        ]

    @property
    def numbers(self) -> list[Operand]:
        """All that solving takes."""
        found = [x for rows in (self.inverse, self.across) for row in rows for x in row]
        return [
            *found,
            *(over for _row, _column, over in self.leaves),
            *(x for arm in self.arms for x in arm),
        ]

    def solved(self, right: Sequence[Operand]) -> list[Operand]:
        """The free coordinates that answer right sides."""
        found: list[Operand] = [0.0] * len(right)
        core = product(self.inverse, [right[i] for i in self.rows])
        for j, x in zip(self.columns, core, strict=True):
            found[j] = x
        for (row, column, over), across in zip(self.leaves, self.across, strict=True):
            rest = right[row]
            for a, x in zip(across, core, strict=True):
                rest = minus(rest, times(a, x))
            found[column] = times(rest, over)
        return found
