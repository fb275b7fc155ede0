"""Formulas with their numbers put in, as a textbook writes them behind the letters."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from centrode.equations.formulas import Formula
from centrode.equations.letters import Letter, Parts, Wave
from centrode.equations.spelling import spelled
from centrode.equations.sums import Sum
from centrode.present.equations.typst import TypstSpelling
from centrode.report.numbers import Numbers

MOST_TERMS, MOST_NUMBERS = 6, 26
"""Terms and numbers of the longest formula that is written with its numbers: beyond them nobody follows."""


class NumberSpelling(TypstSpelling):
    """Every letter as its number: angles of sines and cosines in the unit of the display, all else as it counts."""

    def __init__(self, values: Mapping[Letter, float], numbers: Numbers) -> None:
        self.values = values
        self.numbers = numbers

    def letter(self, letter: Letter) -> str:
        return _guarded(self.numbers.math(self.values[letter]))

    def power(self, base: str, power: int) -> str:
        if power != 1 and "dot.op" in base and not base.startswith("("):
            return f"({base})^({power})"
        return super().power(base, power)

    def wave(self, one: Wave, power: int) -> str:
        return f"{self.power(one.kind, power)} ({self.angle(one.parts)})"

    def angle(self, parts: Parts) -> str:
        text = ""
        for letter, count in parts:
            value = self._angle(letter)
            sign = ("- " if count < 0 else "+ ") if text else ("-" if count < 0 else "")
            size = "" if abs(count) == 1 else f"{abs(count)} dot.op "
            bare = not text and count > 0 and abs(count) == 1
            text += (" " if text else "") + sign + size + (value if bare else _guarded(value))
        return text

    def join(self, factors: Sequence[str]) -> str:
        return " dot.op ".join(factors)

    def fraction(self, above: Sequence[str], below: Sequence[str]) -> str:
        return f"frac({self.join(above) or '1'}, {self.join(below)})"

    def times(self, front: str, other: str) -> str:
        return self.join([front, other])

    def _angle(self, letter: Letter) -> str:
        degrees = str(self.numbers.display.angle) != "rad"
        value = self.values[letter]
        text = self.numbers.math(math.degrees(value) if degrees else value)
        return f"{text} degree" if degrees else text


def _guarded(text: str) -> str:
    """A negative number in brackets of its own."""
    return f"({text})" if text.startswith("-") else text


def with_numbers(formula: Formula, values: Mapping[Letter, float], numbers: Numbers) -> str | None:
    """A formula with its numbers; None where it is too long, has none, or one of them does not exist."""
    total = formula.total
    count = sum(len(term.letters) + sum(len(one.parts) for one, _power in term.waves) for term in total.terms)
    if not count or formula.size > MOST_TERMS or count > MOST_NUMBERS:
        return None
    if not all(math.isfinite(values.get(letter, math.nan)) for letter in total.letters):
        return None
    return spelled(formula, NumberSpelling(values, numbers))


def spelled_entry(total: Sum, values: Mapping[Letter, float], numbers: Numbers) -> str:
    """An entry of a system as a number."""
    with_zero = float(total.value(math, values.__getitem__)) if total else 0.0
    return numbers.math(with_zero)
