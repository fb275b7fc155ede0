"""Formulas with their numbers, in the notation of the formula printer (typst's mathematics)."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from centrode.equations.symbols import Letter, Parts, Wave
from centrode.model.settings import Display
from centrode.render.document.numbers import Numbers
from centrode.render.document.typst import LONG, TypstSpelling, in_degrees, strip_brackets


def in_si(numbers: Numbers) -> Numbers:
    """The same spelling for formulas, whose numbers have to be in units that go together."""
    return Numbers(Display(), numbers.digits)


def factor(numbers: Numbers, value: float, unit: str = "1") -> str:
    """A number in a product: in brackets where it is negative or has a power of ten."""
    size = numbers.math(value, unit)
    return f"({size})" if value < 0 or "dot" in size else size


def square(numbers: Numbers, value: float, unit: str = "1") -> str:
    """The square of a number."""
    return f"{factor(numbers, value, unit)}^(2)"


class NumberSpelling(TypstSpelling):
    """Every letter as its number: angles of sines and cosines in the unit of the display, all else as it counts."""

    def __init__(self, values: Mapping[Letter, float], numbers: Numbers) -> None:
        self.values = values
        self.numbers = numbers

    def letter(self, letter: Letter) -> str:
        return _in_brackets(self.numbers.math(self.values[letter]))

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
            text += (" " if text else "") + sign + size + (value if bare else _in_brackets(value))
        return text

    def join(self, factors: Sequence[str]) -> str:
        return " dot.op ".join(factors)

    def fraction(self, above: Sequence[str], below: Sequence[str]) -> str:
        top, bottom = self.join(above) or "1", self.join(below)
        if len(top) > LONG:
            return f"frac(1, {strip_brackets(bottom)}) dot.op {top}"
        return f"frac({strip_brackets(top) if len(above) == 1 else top}, {strip_brackets(bottom)})"

    def times(self, front: str, other: str) -> str:
        return self.join([front, other])

    def _angle(self, letter: Letter) -> str:
        degrees = str(self.numbers.display.angle) != "rad"
        value = self.values[letter]
        text = self.numbers.math(math.degrees(value) if degrees else value)
        return in_degrees(text) if degrees else text


def _in_brackets(text: str) -> str:
    """A negative number in brackets of its own."""
    return f"({text})" if text.startswith("-") else text
