"""Formulas with their numbers, in the notation of the formula printer (typst's mathematics)."""

from __future__ import annotations

from centrode.model.settings import Display
from centrode.present.equations.typst import quote
from centrode.render.document.numbers import Numbers


def with_unit(numbers: Numbers, value: float, unit: str) -> str:
    """A quantity in SI with its unit, as mathematics."""
    label = numbers.shown(unit)[1]
    size = numbers.math(value, unit)
    return f"{size} thin {quote(label)}" if label else size


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
