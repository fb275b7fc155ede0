"""Symmetric elimination in straight lines: L D L' of sparse matrices over any algebra.

Matrices are given by their entries below and on the diagonal; what is a plain zero stays one and costs nothing. The
order of the pivots is that of least degree, so that trees fill nothing and chains of loops stay bands. (A. George and
J. Liu, Computer Solution of Large Sparse Positive Definite Systems, 1981, chapter 5.) No pivot is sought by its
value: what is computed is the same for all values, so it can be traced.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

Number: TypeAlias = Any
Entries: TypeAlias = dict[tuple[int, int], Number]
"""(row, column) -> number, row >= column."""
Vector: TypeAlias = dict[int, Number]
Reciprocal: TypeAlias = Callable[[int, Number], Number]
"""(row, pivot) -> reciprocal of the pivot, or zero where the row is left out."""


def is_zero(x: Number) -> bool:
    """Whether a number is the plain zero."""
    return type(x) is float and x == 0.0


def add_term(vector: dict[Any, Number], key: Any, term: Number) -> None:
    """Add a term to an entry, if it is not the plain zero."""
    if not is_zero(term):
        vector[key] = vector[key] + term if key in vector else term


def times(a: Number, b: Number) -> Number:
    """The product; the plain zero where a factor is, and nothing is multiplied by the plain one."""
    if is_zero(a) or is_zero(b):
        return 0.0
    if type(a) is float and a == 1.0:
        return b
    return a if type(b) is float and b == 1.0 else a * b


def order_of_least_degree(size: int, pattern: set[tuple[int, int]], last: Collection[int] = ()) -> list[int]:
    """Rows in an order in which each has the fewest neighbours when its turn comes; the first of equals first.

    Rows of `last` come behind all others.
    """
    neighbours: list[set[int]] = [set() for _row in range(size)]
    for i, j in pattern:
        if i != j:
            neighbours[i].add(j)
            neighbours[j].add(i)
    left, order = set(range(size)), []
    while left:
        row = min(left, key=lambda k: (k in last, len(neighbours[k]), k))
        left.remove(row)
        order.append(row)
        for one in neighbours[row]:
            neighbours[one] |= neighbours[row]
            neighbours[one] -= {one, row}
    return order


def _reciprocal(_row: int, pivot: Number) -> Number:
    return 1.0 / pivot


@dataclass(frozen=True)
class Elimination:
    """A symmetric matrix as L D L'.

    Attributes
    ----------
    order : rows in the order of their pivots
    columns : row -> entries of L below its pivot, by their rows
    pivots, reciprocals : by rows
    """

    order: Sequence[int]
    columns: Mapping[int, Vector]
    pivots: Mapping[int, Number]
    reciprocals: Mapping[int, Number]

    @classmethod
    def of(
        cls,
        size: int,
        entries: Entries,
        reciprocal: Reciprocal = _reciprocal,
        last: Collection[int] = (),
    ) -> Elimination:
        """The elimination of a matrix; rows of `last` have their pivots behind all others."""
        pattern = {key for key, x in entries.items() if not is_zero(x)}
        order = order_of_least_degree(size, pattern, last)
        rest: dict[int, Vector] = {row: {} for row in range(size)}
        for (i, j), x in entries.items():
            if not is_zero(x):
                rest[i][j] = x
                rest[j][i] = x
        columns: dict[int, Vector] = {}
        pivots: Vector = {}
        reciprocals: Vector = {}
        for row in order:
            own = rest.pop(row)
            pivots[row] = own.pop(row, 0.0)
            reciprocals[row] = reciprocal(row, pivots[row])
            below = {i: times(x, reciprocals[row]) for i, x in own.items()}
            columns[row] = below
            others = list(below)
            for k, i in enumerate(others):
                rest[i].pop(row)
                for j in others[k:]:
                    product = times(below[i], own[j])
                    x = rest[i][j] - product if j in rest[i] else -product
                    rest[i][j] = x
                    rest[j][i] = x
        return cls(order, columns, pivots, reciprocals)

    def forward(self, right: Mapping[int, Number]) -> Vector:
        """Solution of L y = right."""
        y = {row: x for row, x in right.items() if not is_zero(x)}
        for row in self.order:
            if row in y:
                for i, factor in self.columns[row].items():
                    add_term(y, i, -times(factor, y[row]))
        return y

    def backward(self, y: Mapping[int, Number]) -> Vector:
        """Solution of D L' x = y."""
        x: Vector = {}
        for row in reversed(self.order):
            if row in y:
                x[row] = times(y[row], self.reciprocals[row])
            for i, factor in self.columns[row].items():
                if i in x:
                    add_term(x, row, -times(factor, x[i]))
        return x

    def product(self, one: Mapping[int, Number], other: Mapping[int, Number]) -> Number:
        """One' D^-1 other of vectors that `forward` has solved for."""
        total: Number = 0.0
        for row, value in one.items():
            if row in other:
                term = times(times(value, other[row]), self.reciprocals[row])
                total = term if is_zero(total) else total + term
        return total

    def solve(self, right: Mapping[int, Number]) -> Vector:
        """Solution of the whole system."""
        return self.backward(self.forward(right))
