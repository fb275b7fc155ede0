"""Formulas in the form of textbooks: what all terms share in front, over what they are divided by."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import gcd, lcm
from typing import Any

from centrode.equations.expressions import expression
from centrode.equations.letters import Letter
from centrode.equations.merging import merged
from centrode.equations.spelling import Spelling, ordered, spelled
from centrode.equations.sums import Coefficient, Sum, Term


@dataclass(frozen=True)
class Formula:
    """A number, a product and a sum whose terms share nothing; `expression` is the same for SymPy.

    The product holds what the formula is divided by, with negative exponents.
    """

    number: Coefficient
    product: Term
    rest: Sum

    @property
    def total(self) -> Sum:
        """The same as one sum."""
        return Sum({self.product: self.number}) * self.rest if self.number else Sum({})

    @property
    def single(self) -> bool:
        """Whether it is one product."""
        return len(self.rest.terms) <= 1

    @property
    def size(self) -> int:
        """Number of terms."""
        return len(self.rest.terms)

    @cached_property
    def expression(self) -> Any:
        """SymPy expression (the extra `symbols`)."""
        return (
            expression(Sum({self.product: self.number})) * expression(self.rest)
            if self.number
            else expression(Sum({}))
        )

    def renamed(self, names: Mapping[Letter, Letter]) -> Formula:
        """The same with letters written otherwise."""
        return formula_of(self.total.renamed(names))

    def __str__(self) -> str:
        return spelled(self, Spelling())


def formula_of(total: Sum) -> Formula:
    """The textbook form of a sum: over a common denominator, pairs of waves taken together, factors in front."""
    whole, shared = _apart(total)
    taken, again = _apart(merged(whole))
    number, rest = _number(taken)
    return Formula(number, shared.times(again), rest)


def _apart(total: Sum) -> tuple[Sum, Term]:
    """A sum whose terms share no factor and are divided by nothing, and the product that was in front of it."""
    terms = list(total.terms)
    if not terms:
        return total, Term()
    letters = [dict(term.letters) for term in terms]
    waves = [dict(term.waves) for term in terms]
    shared = Term(
        tuple(sorted(_least(letters).items())),
        tuple(sorted(_least(waves).items())),
    )
    return total.divided(shared), shared


def _least(powers: list[dict[Any, int]]) -> dict[Any, int]:
    every = {factor for one in powers for factor in one}
    least = {factor: min(one.get(factor, 0) for one in powers) for factor in every}
    return {factor: power for factor, power in least.items() if power}


def _number(total: Sum) -> tuple[Coefficient, Sum]:
    """The number in front of a sum, with the sign of its first term."""
    if not total:
        return 0, Sum.number(1)
    numbers = [Fraction(x) for x in total.terms.values()]
    size = Fraction(gcd(*(x.numerator for x in numbers)), lcm(*(x.denominator for x in numbers)))
    first = ordered(total)[0]
    number: Coefficient = size if total.terms[first] > 0 else -size
    if number.denominator == 1:
        number = int(number)
    return number, total.scaled(1 / Fraction(number))
