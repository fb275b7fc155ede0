"""Formulas as one line of text, in the order of the textbooks: -(l₁/l₂) cos t/cos φ₂."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import gcd, lcm
from typing import Any, Protocol

from centrode.equations.symbols import Coefficient, Letter, Parts, Sum, SumTerm, Wave, expression, merge_waves

GREEK = {
    "alpha": "α", "beta": "β", "gamma": "γ", "delta": "δ", "epsilon": "ε", "theta": "θ", "kappa": "κ", "rho": "ρ",
    "phi": "φ", "psi": "ψ", "omega": "ω", "Delta": "Δ", "pi": "π", "pi/2": "π/2",
}  # fmt: skip
SUBSCRIPTS = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")
POWERS = str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹")
DOTS = {"": "", "dot": "\u0307", "ddot": "\u0308"}
NAME = re.compile(r"([A-Za-z]+?)(\d*)(?:_(?!d?dot$)(.+?))?(?:_(dot|ddot))?")


class Factored(Protocol):
    """What is spelled: a number, a product, and a sum whose terms share nothing."""

    @property
    def number(self) -> Coefficient: ...

    @property
    def product(self) -> SumTerm: ...

    @property
    def rest(self) -> Sum: ...

    @property
    def total(self) -> Sum: ...

    @property
    def single(self) -> bool: ...


def parts_of(name: str) -> tuple[str, str, str]:
    """Of a letter's name: the letter, what stands below it, dot or ddot above it."""
    found = NAME.fullmatch(name)
    if found is None:
        return name, "", ""
    base, number, below, dots = found.groups(default="")
    return base, ", ".join(part for part in (number, below) if part), dots


class FormulaSpelling:
    """How the parts of a formula are written; other spellings change what they have to."""

    minus = "-"

    def letter(self, letter: Letter) -> str:
        """A letter with its index."""
        base, below, dots = parts_of(letter.name)
        index = below.translate(SUBSCRIPTS) if below.isdecimal() else f"_{below}" if below else ""
        return unicodedata.normalize("NFC", f"{GREEK.get(base, base)}{DOTS[dots]}") + index

    def power(self, base: str, power: int) -> str:
        """A letter to a power."""
        return base if power == 1 else f"{base}{str(power).translate(POWERS)}"

    def wave(self, one: Wave, power: int) -> str:
        """A sine or cosine to a power."""
        name = self.power(one.kind, power)
        if len(one.parts) == 1 and one.parts[0][1] == 1:
            return f"{name} {self.letter(one.parts[0][0])}"
        return f"{name}{self.bracket(self.angle(one.parts))}"

    def angle(self, parts: Parts) -> str:
        """A sum of angles."""
        text = ""
        for letter, count in parts:
            sign = ("- " if count < 0 else "+ ") if text else ("-" if count < 0 else "")
            size = "" if abs(count) == 1 else f"{abs(count)} "
            text += (" " if text else "") + sign.replace("-", self.minus) + size + self.letter(letter)
        return text

    def bracket(self, text: str) -> str:
        """Something in round brackets."""
        return f"({text})"

    def text(self, name: str) -> str:
        """A name of the user's own inside of a sentence that may hold formulas."""
        return name

    def math(self, text: str) -> str:
        """A formula inside of a sentence."""
        return text

    def bars(self, text: str) -> str:
        """The size of something."""
        return f"|{text}|"

    def initial(self, text: str) -> str:
        """The value of a function at time zero."""
        return f"{text}(0)"

    def decimal(self, number: float) -> str:
        """A number that was given."""
        return f"{number:.6g}"

    def join(self, factors: Sequence[str]) -> str:
        """A product."""
        return " ".join(factors)

    def derivative(self, letter: Letter) -> str:
        """Derivative of a letter by time."""
        return f"d{self.letter(letter)}/dt"

    def root(self, text: str) -> str:
        """A square root."""
        return f"√{self.bracket(text)}"

    def function(self, name: str, text: str) -> str:
        """A function of a formula: arcsin, arccos, tan."""
        return f"{name}{self.bracket(text)}"

    def function_of(self, name: str, letter: Letter) -> str:
        """A sine, cosine or tangent of a letter."""
        return f"{name} {self.letter(letter)}"

    def direction(self, y: str, x: str) -> str:
        """The direction of a vector by its components."""
        return f"atan2({y}, {x})"

    def product(self, factors: Sequence[str]) -> str:
        """A product of formulas, its factors told apart."""
        return " · ".join(factors)

    def minor(self, rows: Sequence[Sequence[str]]) -> str:
        """A determinant of entries."""
        return f"|{'; '.join(', '.join(row) for row in rows)}|"

    def times(self, front: str, other: str) -> str:
        """A fraction in front of something."""
        return self.join([front, other])

    def number(self, number: int) -> str:
        """A whole number."""
        return str(number)

    def fraction(self, above: Sequence[str], below: Sequence[str]) -> str:
        """A fraction of two products."""
        bottom = self.join(below)
        return f"{self.join(above) or '1'}/{bottom if len(below) == 1 else self.bracket(bottom)}"

    def ratio(self, above: Sequence[str], below: Sequence[str]) -> str:
        """A fraction as a factor in front."""
        return self.bracket(self.fraction(above, below))


def order_of(term: SumTerm) -> tuple[object, ...]:
    """Where a term stands in a sum: by its angles, then by its letters."""
    waves = [(one.parts, one.kind) for one, _power in sorted(term.waves, key=lambda wave: wave[0].order)]
    return (bool(waves), [parts for parts, _kind in waves], term.letters, waves)


def order_terms(total: Sum) -> list[SumTerm]:
    """Terms in the order in which they are written; those without angles begin with a positive one."""
    order = sorted(total.terms, key=order_of)
    if not any(term.waves for term in order):
        order.sort(key=lambda term: total.terms[term] < 0)  # phi2 - u phi1
    return order


def spelled_sum(total: Sum, spelling: FormulaSpelling) -> str:
    """A sum, each term a product or a fraction."""
    text = ""
    for term in order_terms(total):
        number = total.terms[term]
        sign = ("- " if number < 0 else "+ ") if text else ("-" if number < 0 else "")
        text += (" " if text else "") + sign.replace("-", spelling.minus)
        text += _Product(spelling).text(size_of(number), term, None)
    return text or spelling.number(0)


def spell_formula(
    formula: Factored, spelling: FormulaSpelling, differences_first: bool = False, turned: bool = False
) -> str:
    """A formula.

    With `differences_first` sines of differences stand before those of angles, as in determinants; with `turned` a
    minus goes into the sine of a difference.
    """
    if not formula.number:
        return spelling.number(0)
    if formula.product == SumTerm() and abs(formula.number) == 1 and not formula.single:
        return spelled_sum(formula.total, spelling)
    rest = None if formula.single else formula.rest
    other = _turnable(formula) if turned and formula.number < 0 else None
    sign = spelling.minus if formula.number < 0 and other is None else ""
    pieces = _Product(spelling, differences_first, other)
    return sign + pieces.text(size_of(formula.number), formula.product, rest)


def _turnable(formula: Factored) -> Wave | None:
    """The sine of a difference into which a sign may go; that of a sum would begin with a minus."""
    for one, power in formula.product.waves:
        if power == 1 and one.kind == "sin" and any(count < 0 for _letter, count in one.parts):
            return one
    return None


@dataclass(frozen=True)
class _Product:
    """Writes products; the wave `turned` with the opposite sign of its angle."""

    spelling: FormulaSpelling
    differences_first: bool = False
    turned: Wave | None = None

    def text(self, size: Fraction, term: SumTerm, rest: Sum | None) -> str:
        spelling = self.spelling
        above, below = self._letters(term, 1), self._letters(term, -1)
        if size.numerator != 1:
            above.insert(0, spelling.number(size.numerator))
        if size.denominator != 1:
            below.insert(0, spelling.number(size.denominator))
        top, bottom = self._waves(term, 1), self._waves(term, -1)
        if rest is not None:
            top.insert(0, spelling.bracket(spelled_sum(rest, spelling)))
        if not below and not bottom:
            return spelling.join([*above, *top]) or spelling.number(1)
        if rest is None and below and top:
            front = spelling.ratio(above, below)
            return spelling.times(front, spelling.fraction(top, bottom) if bottom else spelling.join(top))
        return spelling.fraction([*above, *top], [*below, *bottom])

    def _letters(self, term: SumTerm, sign: int) -> list[str]:
        spelling = self.spelling
        return [
            spelling.power(spelling.letter(letter), abs(power))
            for letter, power in term.letters
            if power * sign > 0
        ]

    def _waves(self, term: SumTerm, sign: int) -> list[str]:
        chosen = [(one, abs(power)) for one, power in term.waves if power * sign > 0]
        chosen.sort(key=lambda wave: wave[0].order)
        if self.differences_first:
            chosen.sort(key=lambda wave: len(wave[0].parts) == 1)
        return [self.spelling.wave(self._side(one), power) for one, power in chosen]

    def _side(self, one: Wave) -> Wave:
        if one != self.turned:
            return one
        parts = [(letter, -count) for letter, count in one.parts]
        return Wave(tuple(sorted(parts, key=lambda part: part[1] < 0)), one.kind)


def size_of(number: Coefficient) -> Fraction:
    """A number without its sign."""
    return abs(Fraction(number))


# Formulas in the form of textbooks: what all terms share in front, over what they are divided by.


@dataclass(frozen=True)
class SymbolFormula:
    """A number, a product and a sum whose terms share nothing; `expression` is the same for SymPy.

    The product holds what the formula is divided by, with negative exponents.
    """

    number: Coefficient
    product: SumTerm
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

    def rename_letters(self, names: Mapping[Letter, Letter]) -> SymbolFormula:
        """The same with letters written otherwise."""
        return formula_of(self.total.rename_letters(names))

    def __str__(self) -> str:
        return spell_formula(self, FormulaSpelling())


def formula_of(total: Sum) -> SymbolFormula:
    """The textbook form of a sum: over a common denominator, pairs of waves taken together, factors in front."""
    whole, shared = _apart(total)
    taken, again = _apart(merge_waves(whole))
    number, rest = _number(taken)
    return SymbolFormula(number, shared.times(again), rest)


def _apart(total: Sum) -> tuple[Sum, SumTerm]:
    """A sum whose terms share no factor and are divided by nothing, and the product that was in front of it."""
    terms = list(total.terms)
    if not terms:
        return total, SumTerm()
    letters = [dict(term.letters) for term in terms]
    waves = [dict(term.waves) for term in terms]
    shared = SumTerm(
        tuple(sorted(_least(letters).items())),
        tuple(sorted(_least(waves).items())),
    )
    return total.divide(shared), shared


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
    first = order_terms(total)[0]
    number: Coefficient = size if total.terms[first] > 0 else -size
    if number.denominator == 1:
        number = int(number)
    return number, total.scale(1 / Fraction(number))
