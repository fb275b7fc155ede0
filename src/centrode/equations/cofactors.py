"""Determinants by cofactor expansion, step by step, along the line of a matrix that has most zeros."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np

from centrode.equations.inverse_functions import ValueOf
from centrode.equations.spelling import FormulaSpelling, formula_of, size_of, spell_formula
from centrode.equations.symbols import Sum

Entries: TypeAlias = tuple[tuple[Sum, ...], ...]


@dataclass(frozen=True)
class Cofactor:
    """A product of entries and a minor, with its sign; `minor` without rows is one."""

    sign: int
    entries: tuple[Sum, ...]
    minor: Entries


@dataclass(frozen=True)
class ExpansionStep:
    """A determinant as a sum of entries times minors; minors of two rows as bars, or `multiplied` out."""

    terms: tuple[Cofactor, ...]
    multiplied: bool = False

    @property
    def order(self) -> int:
        """Rows of the largest minor."""
        return max((len(term.minor) for term in self.terms), default=0)

    def value(self, value_of: ValueOf) -> Any:
        """The number."""
        total: Any = 0.0
        for term in self.terms:
            product: Any = float(term.sign)
            for entry in term.entries:
                product = product * entry.value(np, value_of)
            rows = [[entry.value(np, value_of) for entry in row] for row in term.minor]
            if len(rows) == 2 and self.multiplied:
                product = product * (rows[0][0] * rows[1][1] - rows[0][1] * rows[1][0])
            elif rows:
                product = product * np.linalg.det(np.array(rows))
            total = total + product
        return total

    def text(self, spelling: FormulaSpelling) -> str:
        """The formula."""
        text = ""
        for term in self.terms:
            minus, product = self._product(term, spelling)
            if (term.sign < 0) != minus:
                text += f" {spelling.minus} " if text else spelling.minus
            elif text:
                text += " + "
            text += product
        return text or spelling.number(0)

    def _product(self, term: Cofactor, spelling: FormulaSpelling) -> tuple[bool, str]:
        """A product without its sign, and whether a minus of an entry stands in front of it."""
        minus, factors = False, []
        for entry in term.entries:
            negative, text = _factor_text(entry, spelling)
            minus ^= negative
            factors += [text] if text else []
        if term.minor:
            rows = [[_entry_text(entry, spelling) for entry in row] for row in term.minor]
            if not self.multiplied:
                factors.append(spelling.minor(rows))
            else:
                inside = multiplied_text(term.minor, spelling)
                alone = len(self.terms) == 1 and not factors and not minus and term.sign > 0
                factors.append(inside if alone else spelling.bracket(inside))
        return minus, spelling.join(factors) or spelling.number(1)


def multiplied_text(minor: Entries, spelling: FormulaSpelling) -> str:
    """A determinant of two rows as the difference of two products, zeros left out."""
    (a, b), (c, d) = minor
    text = ""
    for sign, one, other in ((1, a, d), (-1, b, c)):
        if not one or not other:
            continue
        negative, factors = sign < 0, []
        for entry in (one, other):
            minus, spelled = _factor_text(entry, spelling)
            negative ^= minus
            factors += [spelled] if spelled else []
        mark = spelling.minus if negative else ""
        text += (f" {spelling.minus if negative else '+'} " if text else mark) + (
            spelling.product(factors) or spelling.number(1)
        )
    return text or spelling.number(0)


def _factor_text(entry: Sum, spelling: FormulaSpelling) -> tuple[bool, str]:
    """A factor of a product without its sign, nothing for one; and whether its sign is a minus."""
    formula = formula_of(entry)
    bare = not formula.product.letters and not formula.product.waves and size_of(formula.number) == 1
    if bare:  # one, or a sum as it stands
        return (formula.number < 0, "") if formula.single else (
            False, spelling.bracket(spell_formula(formula, spelling))
        )  # fmt: skip
    if formula.number < 0:
        formula = formula_of(entry.scale(-1))
        return True, spell_formula(formula, spelling)
    return False, spell_formula(formula, spelling)


def _entry_text(entry: Sum, spelling: FormulaSpelling) -> str:
    return spell_formula(formula_of(entry), spelling) if entry else spelling.number(0)


@dataclass(frozen=True)
class CofactorExpansion:
    """All steps from a determinant to products of its entries."""

    matrix: Entries

    @cached_property
    def steps(self) -> tuple[ExpansionStep, ...]:
        """Each with minors of one row less; the last with those of two rows multiplied out."""
        step = ExpansionStep((Cofactor(1, (), self.matrix),))
        found = []
        while step.order > 2:
            step = ExpansionStep(tuple(_expanded_minors(step.terms)))
            found.append(step)
        return (*found, ExpansionStep(step.terms, multiplied=True))

    @property
    def fits(self) -> bool:
        """Whether no step has more than one product."""
        return all(len(step.terms) <= 1 for step in self.steps)


def _expanded_minors(terms: Sequence[Cofactor]) -> Iterator[Cofactor]:
    """Every minor expanded along the row or column with fewest entries, the first of them."""
    for term in terms:
        rows = term.minor
        size = range(len(rows))
        along_rows = [[(i, j) for j in size if rows[i][j]] for i in size]
        along_columns = [[(i, j) for i in size if rows[i][j]] for j in size]
        for i, j in min([*along_rows, *along_columns], key=len):
            minor = tuple(
                tuple(entry for column, entry in enumerate(row) if column != j)
                for number, row in enumerate(rows)
                if number != i
            )
            sign = -term.sign if (i + j) % 2 else term.sign
            yield Cofactor(sign, (*term.entries, rows[i][j]), minor)
