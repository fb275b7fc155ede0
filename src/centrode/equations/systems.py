"""Linear systems in symbols, their determinants and Cramer's rule."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import combinations
from typing import TypeAlias

from centrode.equations.formulas import Formula, formula_of
from centrode.equations.letters import Letter
from centrode.equations.merging import merged
from centrode.equations.sums import Sum, Term

Row: TypeAlias = tuple[Sum, ...]

LARGEST = 4
"""Unknowns of the largest system whose determinants are written out."""
READABLE = 12
"""Terms of the longest determinant that is written out."""


@dataclass(frozen=True)
class LinearSystem:
    """matrix unknowns = right.

    `pairs` numbers the rows that are components of one vector equation alike; -1 are single ones.
    """

    unknowns: tuple[Letter, ...]
    matrix: tuple[Row, ...]
    right: tuple[Sum, ...]
    pairs: tuple[int, ...]

    @cached_property
    def determinant(self) -> Formula | None:
        """The determinant, or None where it would not be readable."""
        if len(self.unknowns) > LARGEST:
            return None
        found = formula_of(determinant(self.matrix, self.pairs))
        return found if found.size <= READABLE else None

    @cached_property
    def numerators(self) -> tuple[Formula, ...] | None:
        """Determinants with the right side in the place of one column after the other."""
        if self.determinant is None:
            return None
        return tuple(
            formula_of(
                determinant(
                    [(*row[:i], b, *row[i + 1 :]) for row, b in zip(self.matrix, self.right, strict=True)],
                    self.pairs,
                )
            )
            for i in range(len(self.unknowns))
        )

    def solved(self, name: Letter) -> tuple[Formula, ...] | None:
        """The unknowns by Cramer's rule; a determinant of several terms is written as the letter `name`."""
        under, numerators = self.determinant, self.numerators
        if under is None or numerators is None or not under.number:
            return None
        if not under.single:
            return tuple(formula_of(one.total.divided(Term(((name, 1),)))) for one in numerators)
        factor = 1 / under_number(under)
        return tuple(formula_of(one.total.divided(under.product).scaled(factor)) for one in numerators)


def under_number(formula: Formula) -> Fraction:
    """The number in front of a formula that is one product."""
    return Fraction(formula.number)


def system_of(
    residual_rates: Sequence[Sum], unknowns: Sequence[Letter], pairs: Sequence[int]
) -> LinearSystem:
    """The system of equations that are linear in the unknowns: each is zero.

    A row whose first entry is negative is turned round, as one does by hand.
    """
    matrix, right = [], []
    for equation in residual_rates:
        row = tuple(merged(equation.slope(x)) for x in unknowns)
        rest = equation
        for x, entry in zip(unknowns, row, strict=True):
            rest = rest - entry * Sum.letter(x)
        rest = -merged(rest)
        first = next((entry for entry in row if entry), Sum({}))
        if all(number < 0 for number in first.terms.values()) and first:
            row, rest = tuple(-entry for entry in row), -rest
        matrix.append(row)
        right.append(rest)
    return LinearSystem(tuple(unknowns), tuple(matrix), tuple(right), tuple(pairs))


def determinant(matrix: Sequence[Row], pairs: Sequence[int]) -> Sum:
    """Determinant of a matrix of sums.

    It is expanded along rows and columns that have one entry, then along the two rows of a vector equation
    together: then the sines of differences appear by themselves.
    """
    rows, columns = tuple(range(len(matrix))), tuple(range(len(matrix)))
    return _minor(matrix, pairs, rows, columns)


def _minor(
    matrix: Sequence[Row], pairs: Sequence[int], rows: tuple[int, ...], columns: tuple[int, ...]
) -> Sum:
    if not rows:
        return Sum.number(1)
    if len(rows) == 2:
        (a, b), (i, j) = rows, columns
        return merged(matrix[a][i] * matrix[b][j] - matrix[a][j] * matrix[b][i])
    for line in rows:
        filled = [column for column in columns if matrix[line][column]]
        if len(filled) <= 1:
            return _along(matrix, pairs, rows, columns, (line,), [(column,) for column in filled])
    for column in columns:
        filled = [line for line in rows if matrix[line][column]]
        if len(filled) <= 1:
            return sum(
                (_along(matrix, pairs, rows, columns, (line,), [(column,)]) for line in filled), Sum({})
            )
    both = next(((a, b) for a, b in combinations(rows, 2) if pairs[a] == pairs[b] >= 0), None)
    chosen = both or rows[:1]
    return _along(matrix, pairs, rows, columns, chosen, list(combinations(columns, len(chosen))))


def _along(
    matrix: Sequence[Row],
    pairs: Sequence[int],
    rows: tuple[int, ...],
    columns: tuple[int, ...],
    lines: tuple[int, ...],
    places: Sequence[tuple[int, ...]],
) -> Sum:
    """Laplace's expansion along some rows; of the columns only those in `places`."""
    total = Sum({})
    for chosen in places:
        small = matrix[lines[0]][chosen[0]] if len(lines) == 1 else _minor(matrix, pairs, lines, chosen)
        if not small:
            continue
        rest = _minor(
            matrix,
            pairs,
            tuple(r for r in rows if r not in lines),
            tuple(c for c in columns if c not in chosen),
        )
        shift = sum(rows.index(r) for r in lines) + sum(columns.index(c) for c in chosen)
        total += (small * rest).scaled(-1 if shift % 2 else 1)
    return total
