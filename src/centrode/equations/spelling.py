"""Formulas as one line of text, in the order of the textbooks: -(l₁/l₂) cos t/cos φ₂."""

from __future__ import annotations

import re
from collections.abc import Sequence
from fractions import Fraction
from typing import TYPE_CHECKING

from centrode.equations.letters import Letter, Parts, Wave
from centrode.equations.sums import Coefficient, Sum, Term

if TYPE_CHECKING:
    from centrode.equations.formulas import Formula

GREEK = {
    "alpha": "α", "beta": "β", "gamma": "γ", "epsilon": "ε", "theta": "θ", "kappa": "κ", "rho": "ρ",
    "phi": "φ", "psi": "ψ", "omega": "ω", "Delta": "Δ",
}  # fmt: skip
SUBSCRIPTS = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")
POWERS = str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹")
DOTS = {"": "", "dot": "\u0307", "ddot": "\u0308"}
NAME = re.compile(r"([A-Za-z]+?)(\d*)(?:_(.+?))?(?:_(dot|ddot))?")


def parts_of(name: str) -> tuple[str, str, str]:
    """Of a letter's name: the letter, what stands below it, dot or ddot above it."""
    found = NAME.fullmatch(name)
    if found is None:
        return name, "", ""
    base, number, below, dots = found.groups(default="")
    return base, ", ".join(part for part in (number, below) if part), dots


class Spelling:
    """How the parts of a formula are written; other spellings change what they have to."""

    minus = "-"

    def letter(self, letter: Letter) -> str:
        """A letter with its index."""
        base, below, dots = parts_of(letter.name)
        index = below.translate(SUBSCRIPTS) if below.isdecimal() else f"_{below}" if below else ""
        return f"{GREEK.get(base, base)}{DOTS[dots]}{index}"

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

    def join(self, factors: Sequence[str]) -> str:
        """A product."""
        return " ".join(factors)

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


def order_of(term: Term) -> tuple[object, ...]:
    """Where a term stands in a sum: by its angles, then by its letters."""
    waves = [(one.parts, one.kind) for one, _power in sorted(term.waves, key=lambda wave: wave[0].order)]
    return (not waves, [parts for parts, _kind in waves], term.letters, waves)


def spelled_sum(total: Sum, spelling: Spelling) -> str:
    """A sum, each term a product or a fraction."""
    text = ""
    order = sorted(total.terms, key=order_of)
    if not any(term.waves for term in order):
        order.sort(key=lambda term: total.terms[term] < 0)  # phi2 - u phi1
    for term in order:
        number = total.terms[term]
        sign = ("- " if number < 0 else "+ ") if text else ("-" if number < 0 else "")
        text += (" " if text else "") + sign.replace("-", spelling.minus)
        text += _product(size_of(number), term, None, spelling, False)
    return text or spelling.number(0)


def spelled(formula: Formula, spelling: Spelling, differences_first: bool = False) -> str:
    """A formula; with `differences_first` sines of differences stand before those of angles, as in determinants."""
    if not formula.number:
        return spelling.number(0)
    if formula.product == Term() and abs(formula.number) == 1 and not formula.single:
        return spelled_sum(formula.total, spelling)
    rest = None if formula.single else formula.rest
    sign = spelling.minus if formula.number < 0 else ""
    return sign + _product(size_of(formula.number), formula.product, rest, spelling, differences_first)


def _product(
    size: Fraction, term: Term, rest: Sum | None, spelling: Spelling, differences_first: bool
) -> str:
    above, below = _letters(term, 1, spelling), _letters(term, -1, spelling)
    if size.numerator != 1:
        above.insert(0, spelling.number(size.numerator))
    if size.denominator != 1:
        below.insert(0, spelling.number(size.denominator))
    top = _waves(term, 1, spelling, differences_first)
    if rest is not None:
        top.insert(0, spelling.bracket(spelled_sum(rest, spelling)))
    bottom = _waves(term, -1, spelling, differences_first)
    if not below and not bottom:
        return spelling.join([*above, *top]) or spelling.number(1)
    if rest is None and below and bottom and top:
        front = spelling.ratio(above, below)
        return spelling.join([front, spelling.fraction(top, bottom)])
    if rest is None and below and not bottom and top:
        return spelling.join([spelling.ratio(above, below), *top])
    return spelling.fraction([*above, *top], [*below, *bottom])


def _letters(term: Term, sign: int, spelling: Spelling) -> list[str]:
    return [
        spelling.power(spelling.letter(letter), abs(power))
        for letter, power in term.letters
        if power * sign > 0
    ]


def _waves(term: Term, sign: int, spelling: Spelling, differences_first: bool) -> list[str]:
    chosen = [(one, abs(power)) for one, power in term.waves if power * sign > 0]
    chosen.sort(key=lambda wave: wave[0].order)
    if differences_first:
        chosen.sort(key=lambda wave: len(wave[0].parts) == 1)
    return [spelling.wave(one, power) for one, power in chosen]


def size_of(number: Coefficient) -> Fraction:
    """A number without its sign."""
    return abs(Fraction(number))
