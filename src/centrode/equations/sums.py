"""Sums of products of letters, sines and cosines: what the constraint equations of planar linkages are made of."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, NamedTuple, TypeAlias

from centrode.equations.letters import Angle, Letter, Wave, wave

Number: TypeAlias = Any
Namespace: TypeAlias = Any
Coefficient: TypeAlias = int | Fraction


class Term(NamedTuple):
    """A product without its number: letters and waves with their whole exponents, in their order."""

    letters: tuple[tuple[Letter, int], ...] = ()
    waves: tuple[tuple[Wave, int], ...] = ()

    def times(self, other: Term, power: int = 1) -> Term:
        """The product with `power` of another term."""
        return Term(
            _multiplied(self.letters, other.letters, power), _multiplied(self.waves, other.waves, power)
        )


def _multiplied(one: tuple[Any, ...], other: tuple[Any, ...], power: int) -> tuple[Any, ...]:
    if not other:
        return one
    total = dict(one)
    for factor, exponent in other:
        total[factor] = total.get(factor, 0) + power * exponent
    return tuple(sorted((factor, exponent) for factor, exponent in total.items() if exponent))


ONE = Term()


@dataclass(frozen=True)
class Sum:
    """Terms with their numbers, none of them zero; numbers are whole or fractions, everything else is a letter."""

    terms: Mapping[Term, Coefficient]

    @classmethod
    def collected(cls, terms: Iterable[tuple[Term, Coefficient]]) -> Sum:
        """The sum of terms, equal ones taken together."""
        total: dict[Term, Coefficient] = {}
        for term, number in terms:
            total[term] = total.get(term, 0) + number
        return cls({term: number for term, number in total.items() if number})

    @classmethod
    def number(cls, number: Coefficient) -> Sum:
        """A number."""
        return cls({ONE: number} if number else {})

    @classmethod
    def letter(cls, letter: Letter, power: int = 1) -> Sum:
        """A letter, or a power of it."""
        return cls({Term(((letter, power),)): 1})

    @classmethod
    def wave(cls, kind: str, angle: Angle) -> Sum:
        """The sine or cosine of an angle."""
        sign, found = wave(kind, angle)
        return cls.number(sign) if found is None else cls({Term((), ((found, 1),)): sign})

    def __bool__(self) -> bool:
        return bool(self.terms)

    def __add__(self, other: Sum) -> Sum:
        return Sum.collected([*self.terms.items(), *other.terms.items()])

    def __sub__(self, other: Sum) -> Sum:
        return self + -other

    def __neg__(self) -> Sum:
        return self.scaled(-1)

    def __mul__(self, other: Sum) -> Sum:
        return Sum.collected(
            (one.times(two), a * b) for one, a in self.terms.items() for two, b in other.terms.items()
        )

    def scaled(self, number: Coefficient) -> Sum:
        """Every term times a number."""
        return Sum({term: value * number for term, value in self.terms.items()} if number else {})

    def divided(self, term: Term) -> Sum:
        """Every term over a product."""
        return Sum({own.times(term, -1): number for own, number in self.terms.items()})

    @property
    def letters(self) -> set[Letter]:
        """All letters, those of angles included."""
        found = {letter for term in self.terms for letter, _power in term.letters}
        for term in self.terms:
            for one, _power in term.waves:
                found.update(letter for letter, _count in one.parts)
        return found

    def slope(self, letter: Letter) -> Sum:
        """Partial derivative by a letter."""
        found: list[tuple[Term, Coefficient]] = []
        for term, number in self.terms.items():
            power = dict(term.letters).get(letter, 0)
            if power:
                found.append((term.times(Term(((letter, 1),)), -1), number * power))
            for one, exponent in term.waves:
                count = dict(one.parts).get(letter, 0)
                if count:
                    sign = 1 if one.kind == "sin" else -1
                    changed = Term((), ((one.partner, 1),)).times(Term((), ((one, 1),)), -1)
                    found.append((term.times(changed), number * exponent * count * sign))
        return Sum.collected(found)

    def rate(self, rates: Mapping[Letter, Sum]) -> Sum:
        """Derivative by time, the rates of those letters that move being given."""
        total = Sum({})
        for letter in sorted(self.letters & rates.keys()):
            total += self.slope(letter) * rates[letter]
        return total

    def replaced(self, values: Mapping[Letter, Sum]) -> Sum:
        """The sum with letters outside of angles replaced; they have positive exponents."""
        total = Sum({})
        for term, number in self.terms.items():
            known = [(letter, power) for letter, power in term.letters if letter in values]
            part = Sum({term.times(Term(tuple(known)), -1): number})
            for letter, power in known:
                for _time in range(power):
                    part = part * values[letter]
            total += part
        return total

    def renamed(self, names: Mapping[Letter, Letter]) -> Sum:
        """The sum with letters written otherwise, also in angles; the new ones have the ranks of the old."""

        def other(one: Wave) -> Wave:
            return Wave(tuple((names.get(letter, letter), count) for letter, count in one.parts), one.kind)

        return Sum.collected(
            (
                Term(
                    tuple(sorted((names.get(x, x), power) for x, power in term.letters)),
                    tuple(sorted((other(x), power) for x, power in term.waves)),
                ),
                number,
            )
            for term, number in self.terms.items()
        )

    def value(self, m: Namespace, value_of: Callable[[Letter], Number]) -> Number:
        """The number that it is, from those of its letters, over any algebra."""
        total: Number = 0.0
        for term, number in self.terms.items():
            product: Number = float(number)
            for letter, power in term.letters:
                product = product * _power(value_of(letter), power)
            for one, power in term.waves:
                angle: Number = 0.0
                for letter, count in one.parts:
                    angle = angle + count * value_of(letter)
                product = product * _power(m.sin(angle) if one.kind == "sin" else m.cos(angle), power)
            total = total + product
        return total


def _power(x: Number, power: int) -> Number:
    result = x
    for _time in range(abs(power) - 1):
        result = result * x
    return result if power > 0 else 1.0 / result


ZERO = Sum({})
