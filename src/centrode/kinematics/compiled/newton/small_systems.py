"""Small systems of linear equations solved by straight-line code: no step hangs on a value, only what it takes does.

Up to three unknowns by cofactors, more by elimination in which rows are exchanged by selection.
"""

from __future__ import annotations

import functools
from collections.abc import Sequence
from typing import TypeAlias

from centrode.algebra.expression_functions import EXPRESSIONS
from centrode.algebra.expressions import Operand
from centrode.geometry.plane import is_literal_zero

Matrix: TypeAlias = Sequence[Sequence[Operand]]
Vector: TypeAlias = Sequence[Operand]

m = EXPRESSIONS


def times(a: Operand, b: Operand) -> Operand:
    """Product; a literal zero costs nothing."""
    if is_literal_zero(a) or is_literal_zero(b):
        return 0.0
    return a * b


def minus(a: Operand, b: Operand) -> Operand:
    """Difference; a literal zero costs nothing."""
    return a if is_literal_zero(b) else -b if is_literal_zero(a) else a - b


def plus(a: Operand, b: Operand) -> Operand:
    """Sum; a literal zero costs nothing."""
    return b if is_literal_zero(a) else a if is_literal_zero(b) else a + b


def product(matrix: Matrix, vector: Vector) -> list[Operand]:
    """Matrix times vector."""
    return [dot(row, vector) for row in matrix]


def multiplied(first: Matrix, second: Matrix) -> list[list[Operand]]:
    """Product of two matrices."""
    columns = list(zip(*second, strict=True))
    return [[dot(row, column) for column in columns] for row in first]


def dot(a: Vector, b: Vector) -> Operand:
    """Scalar product."""
    return total([times(x, y) for x, y in zip(a, b, strict=True)])


def total(values: Vector) -> Operand:
    """Sum."""
    start: Operand = 0.0
    return functools.reduce(plus, values, start)


def sizes(matrix: Matrix) -> list[list[Operand]]:
    """Absolute values of all numbers."""
    return [[x if is_literal_zero(x) else m.abs(x) for x in row] for row in matrix]


def inverse(matrix: Matrix) -> list[list[Operand]]:
    """The inverse; infinite or NaN where there is none."""
    return _by_cofactors(matrix) if len(matrix) <= 3 else _by_elimination(matrix)


def _by_cofactors(matrix: Matrix) -> list[list[Operand]]:
    size = len(matrix)
    if not size:
        return []
    cofactors = [[_cofactor(matrix, i, j) for j in range(size)] for i in range(size)]
    over = 1.0 / dot(matrix[0], cofactors[0])
    return [[times(cofactors[j][i], over) for j in range(size)] for i in range(size)]


def _cofactor(matrix: Matrix, i: int, j: int) -> Operand:
    rest = [[x for c, x in enumerate(row) if c != j] for r, row in enumerate(matrix) if r != i]
    if not rest:
        return 1.0
    if len(rest) == 1:
        found: Operand = rest[0][0]
    else:
        (a, b), (c, d) = rest
        found = minus(times(a, d), times(b, c))
    return minus(0.0, found) if (i + j) % 2 else found


def _by_elimination(matrix: Matrix) -> list[list[Operand]]:
    """Gauss and Jordan; the greatest number of a column comes to its diagonal."""
    size = len(matrix)
    rows = [[*row, *(1.0 if i == j else 0.0 for j in range(size))] for i, row in enumerate(matrix)]
    for k in range(size):
        for i in range(k + 1, size):
            _exchanged(rows, k, i)
        over = 1.0 / rows[k][k]
        rows[k] = [0.0 if c <= k else times(x, over) for c, x in enumerate(rows[k])]
        for i in range(size):
            if i != k:
                factor = rows[i][k]
                rows[i] = [
                    0.0 if c <= k else minus(x, times(factor, y))
                    for c, (x, y) in enumerate(zip(rows[i], rows[k], strict=True))
                ]
    return [row[size:] for row in rows]


def _exchanged(rows: list[list[Operand]], k: int, i: int) -> None:
    """Exchange two rows where the lower one has the greater number in column k."""
    first, second = rows[k][k], rows[i][k]
    if is_literal_zero(second):
        return
    if is_literal_zero(first):
        rows[k], rows[i] = rows[i], rows[k]
        return
    lower = m.less(m.abs(first), m.abs(second))
    pairs = list(zip(rows[k], rows[i], strict=True))
    rows[k] = [x if x is y else _selected(lower, y, x) for x, y in pairs]
    rows[i] = [y if x is y else _selected(lower, x, y) for x, y in pairs]


def _selected(condition: Operand, x: Operand, y: Operand) -> Operand:
    if is_literal_zero(x) and is_literal_zero(y):
        return 0.0
    return m.where(condition, x, y)  # type: ignore[arg-type]
