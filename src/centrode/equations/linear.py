"""Linear systems in symbols, their determinants and Cramer's rule."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property
from itertools import combinations
from typing import Any, NamedTuple, TypeAlias

from centrode.equations.cofactors import CofactorExpansion
from centrode.equations.spelling import SymbolFormula, formula_of
from centrode.equations.symbols import ZERO, Angle, Letter, Sum, SumTerm, expression, matrix, merge_waves

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
    def determinant(self) -> SymbolFormula | None:
        """The determinant, or None where it would not be readable."""
        if len(self.unknowns) > LARGEST:
            return None
        found = formula_of(determinant(self.matrix, self.pairs))
        return found if found.size <= READABLE else None

    @cached_property
    def numerators(self) -> tuple[SymbolFormula, ...] | None:
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

    def expansion(self, column: int | None = None) -> CofactorExpansion:
        """Cofactor expansion of the determinant, or of that with the right side in the place of a column."""
        if column is None:
            return CofactorExpansion(self.matrix)
        return CofactorExpansion(
            tuple(
                (*row[:column], b, *row[column + 1 :]) for row, b in zip(self.matrix, self.right, strict=True)
            )
        )

    def solved_unknowns(self, name: Letter) -> tuple[SymbolFormula, ...] | None:
        """The unknowns by Cramer's rule; a determinant of several terms is written as the letter `name`."""
        under, numerators = self.determinant, self.numerators
        if under is None or numerators is None or not under.number:
            return None
        if not under.single:
            return tuple(formula_of(one.total.divide(SumTerm(((name, 1),)))) for one in numerators)
        factor = 1 / under_number(under)
        return tuple(formula_of(one.total.divide(under.product).scale(factor)) for one in numerators)


def under_number(formula: SymbolFormula) -> Fraction:
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
        row = tuple(merge_waves(equation.slope(x)) for x in unknowns)
        rest = equation
        for x, entry in zip(unknowns, row, strict=True):
            rest = rest - entry * Sum.letter(x)
        rest = -merge_waves(rest)
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
        return merge_waves(matrix[a][i] * matrix[b][j] - matrix[a][j] * matrix[b][i])
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
        total += (small * rest).scale(-1 if shift % 2 else 1)
    return total


# Places in symbols: two coordinates, each a sum.


class UnknownPlace(NamedTuple):
    """A vector in the frame's axes."""

    x: Sum
    y: Sum

    def plus(self, other: UnknownPlace, factor: int = 1) -> UnknownPlace:
        """The vector and `factor` times the other."""
        return UnknownPlace(self.x + other.x.scale(factor), self.y + other.y.scale(factor))

    def along(self, angle: Angle) -> Sum:
        """Component in a direction."""
        return merge_waves(Sum.wave("cos", angle) * self.x + Sum.wave("sin", angle) * self.y)

    def across(self, angle: Angle) -> Sum:
        """Component to the left of a direction."""
        return self.along(angle.turned_by(1))


ORIGIN = UnknownPlace(ZERO, ZERO)


def polar(size: Sum, angle: Angle) -> UnknownPlace:
    """A vector by its size and direction."""
    return UnknownPlace(size * Sum.wave("cos", angle), size * Sum.wave("sin", angle))


# What is found while the vector chains of a mechanism are laid: unknowns and constraints, group by group.


@dataclass(frozen=True)
class Unknown:
    """A quantity that the constraints determine.

    Attributes
    ----------
    name : "angle.AC", "slide.C", "bearing.wheel"
    letter, rate, second : it and its derivatives by time
    """

    name: str
    letter: Letter
    rate: Letter
    second: Letter


@dataclass(frozen=True)
class LinearConstraint:
    """One constraint: left = right, with what is left of it when earlier constraints are put in.

    Attributes
    ----------
    name : "y_C", "x_D", ...
    left : the chain, earlier constraints put in
    full : the chain in angles and lengths alone
    right : a constant, or another chain
    pair : number of the vector equation of which it is a component; -1 for a single one
    closing : direction of the link that closes the chain
    vector : of a component across that link, the vector equation it was taken of
    """

    name: str
    left: Sum
    full: Sum
    right: Sum
    pair: int = -1
    closing: Angle | None = None
    vector: UnknownPlace | None = None

    @property
    def residual(self) -> Sum:
        """Left side less right side."""
        return self.left - self.right

    def rate(self, moves: Mapping[Letter, Sum], times: int = 1) -> Sum:
        """First or second derivative of the residual by time, zero where the constraint holds.

        Of a vector equation across a link, the vector is differentiated and then its component is taken: what is
        left out is a multiple of the vector itself.
        """
        if self.vector is None or self.closing is None:
            total = self.residual
            for _time in range(times):
                total = total.rate(moves)
            return total
        x, y = self.vector
        for _time in range(times):
            x, y = x.rate(moves), y.rate(moves)
        return UnknownPlace(x, y).across(self.closing)


@dataclass
class Draft:
    """A group in the making: what the plan has in it, and what was found so far."""

    links: list[str] = field(default_factory=list)
    points: list[str] = field(default_factory=list)
    plan: list[int] = field(default_factory=list)
    unknowns: list[Unknown] = field(default_factory=list)
    conditions: list[LinearConstraint] = field(default_factory=list)
    label: str = ""
    """What the group is called where that is not its term of the structural formula."""

    @property
    def balance(self) -> int:
        """Constraints less unknowns."""
        return len(self.conditions) - len(self.unknowns)


# A group of the plan in symbols: its unknowns, constraints and linear systems.


@dataclass(frozen=True)
class GroupSolution:
    """A linear system with its unknowns by Cramer's rule; None where that would not be readable.

    Attributes
    ----------
    system : matrix, right side, determinants
    letters : the unknowns
    formulas : each in terms of what stands before it
    under : the letter of the determinant; it stands in the formulas where this has several terms
    """

    system: LinearSystem
    formulas: tuple[SymbolFormula, ...] | None
    under: Letter

    @property
    def letters(self) -> tuple[Letter, ...]:
        return self.system.unknowns

    @property
    def has_letter(self) -> bool:
        """Whether the formulas are written with the letter of the determinant."""
        return self.system.determinant is not None and not self.system.determinant.single

    def expressions(self, formulas: Sequence[SymbolFormula] | None) -> Mapping[str, Any]:
        """Unknown -> SymPy expression, the determinant written out."""
        found = {
            letter.name: formula.expression
            for letter, formula in zip(self.letters, formulas or (), strict=False)
        }
        if not self.has_letter or self.system.determinant is None:
            return found
        under = self.system.determinant.expression
        return {name: one.subs(expression(Sum.letter(self.under)), under) for name, one in found.items()}


@dataclass(frozen=True)
class GroupEquations:
    """A group of the plan: its unknowns, constraints, and the linear systems of its rates and accelerations.

    What is called an expression or a matrix here is SymPy's (extra `symbols`); formulas print themselves.

    Attributes
    ----------
    label : as the structural formula has it, "II(CB, BD)"
    links : links whose angles or places it gives
    unknowns : with their names and letters
    conditions : the constraints
    velocities, seconds : the systems of the rates and of the accelerations
    closed : rates in terms of time and the unknowns alone, where that stays one product
    """

    label: str
    links: tuple[str, ...]
    unknowns: tuple[Unknown, ...]
    conditions: tuple[LinearConstraint, ...]
    velocities: GroupSolution
    seconds: GroupSolution
    closed: tuple[SymbolFormula | None, ...]

    @property
    def symbols(self) -> tuple[str, ...]:
        """Letters of the unknowns: "phi3", "phi4"."""
        return tuple(one.letter.name for one in self.unknowns)

    @cached_property
    def constraints(self) -> Mapping[str, Any]:
        """Constraint -> left side less right side, as an expression."""
        return {one.name: expression(one.residual) for one in self.conditions}

    @cached_property
    def matrix(self) -> Any:
        """Coefficients of the rates."""
        return matrix(self.velocities.system.matrix)

    @cached_property
    def right_side(self) -> Any:
        """What stands on the right of the rates' system."""
        return matrix([[entry] for entry in self.velocities.system.right])

    @cached_property
    def acceleration_right_side(self) -> Any:
        """What stands on the right where the same matrix has the accelerations as unknowns."""
        return matrix([[entry] for entry in self.seconds.system.right])

    @property
    def determinant_formula(self) -> SymbolFormula | None:
        """Determinant in the form of the textbooks; None where it would not be readable."""
        return self.velocities.system.determinant

    @cached_property
    def determinant(self) -> Any:
        """The same as an expression."""
        return None if self.determinant_formula is None else self.determinant_formula.expression

    @cached_property
    def determinants(self) -> tuple[Any, ...] | None:
        """The determinants of Cramer's rule, one an unknown."""
        found = self.velocities.system.numerators
        return None if found is None else tuple(one.expression for one in found)

    @cached_property
    def rates(self) -> Mapping[str, Any]:
        """Rate -> expression: of time and unknowns where it is short, else of the rates of earlier groups too."""
        return self.velocities.expressions(self.normal_form)

    @property
    def normal_form(self) -> tuple[SymbolFormula, ...] | None:
        """Rates as formulas, the shorter way."""
        formulas = self.velocities.formulas
        if formulas is None:
            return None
        return tuple(short or long for short, long in zip(self.closed, formulas, strict=True))

    @cached_property
    def accelerations(self) -> Mapping[str, Any]:
        """Acceleration -> expression of the rates and of earlier accelerations."""
        return self.seconds.expressions(self.seconds.formulas)
