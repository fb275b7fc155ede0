"""Formulas with their numbers, in the notation of the formula printer (typst's mathematics)."""

from __future__ import annotations

from collections.abc import Sequence

from centrode.model.settings import Display
from centrode.present.equations.typst import quoted
from centrode.render.document.numbers import Numbers

LONGEST = 6
"""Terms of a sum beyond which only its first and its last ones are written."""

ROUNDING = 1e-13
"""Terms below this share of the greatest are zero."""


def indexed(letter: str, *below: str) -> str:
    """A letter with names below it."""
    return f"{letter}_(" + ", ".join(map(quoted, below)) + ")"


def with_unit(numbers: Numbers, value: float, unit: str) -> str:
    """A quantity in SI with its unit, as mathematics."""
    label = numbers.shown(unit)[1]
    size = numbers.math(value, unit)
    return f"{size} thin {quoted(label)}" if label else size


def in_si(numbers: Numbers) -> Numbers:
    """The same spelling for formulas, whose numbers have to be in units that go together."""
    return Numbers(Display(), numbers.digits)


def sum_of(numbers: Numbers, values: Sequence[float], unit: str = "1") -> str:
    """Quantities added up, each with its sign; a long sum by its first and last terms, what is rounding as zero."""
    least = ROUNDING * max(map(abs, values), default=0.0)
    values = [0.0 if abs(value) <= least else value for value in values]
    shown = values if len(values) <= LONGEST else [*values[: LONGEST - 2], values[-1]]
    parts = [
        numbers.math(value, unit)
        if not place
        else ("- " if value < 0 else "+ ") + numbers.math(abs(value), unit)
        for place, value in enumerate(shown)
    ]
    if len(shown) < len(values):
        parts.insert(LONGEST - 2, "+ dots.c")
    return " ".join(parts)


def factor(numbers: Numbers, value: float, unit: str = "1") -> str:
    """A number in a product: in brackets where it is negative or has a power of ten."""
    size = numbers.math(value, unit)
    return f"({size})" if value < 0 or "dot" in size else size


def squared(numbers: Numbers, value: float, unit: str = "1") -> str:
    """The square of a number."""
    return f"{factor(numbers, value, unit)}^(2)"
