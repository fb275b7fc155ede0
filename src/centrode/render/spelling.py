"""How texts of sheets become strings: the rules that all renderers share, and those of terminals and figures."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import TYPE_CHECKING, assert_never

import numpy as np

from centrode.locale import _, ngettext
from centrode.present.shown import formula, plain, shown_as
from centrode.quantities import typeset_unit
from centrode.sheets.texts import (
    Counted,
    Expression,
    Factor,
    Joined,
    Name,
    Number,
    Sentence,
    Symbol,
    Text,
    Title,
)

if TYPE_CHECKING:
    from centrode.model.asked import Display
    from centrode.sheets.plots import AxisLabel
    from centrode.sheets.sheet import Column


def holds_numbers(column: Column) -> bool:
    """Whether the cells of a column are numbers, with or without words behind them."""
    return isinstance(column.values, np.ndarray) or all(
        isinstance(cell, Number) or (isinstance(cell, Joined) and isinstance(cell.parts[0], Number))
        for cell in column.values
    )


DASH = "–"
"""Stands for a number that is not there."""


class Spelling(ABC):
    """Turns texts into strings of one medium, in the language that is spoken at the moment.

    Attributes
    ----------
    display : Display or None
        Units of lengths and angles; SI where None.
    """

    def __init__(self, display: Display | None) -> None:
        self.display = display

    def text(self, text: Text) -> str:
        """A text as a string."""
        match text:
            case Name(what):
                return self.name(what)
            case Title(what):
                return self.name(_(what))
            case Number():
                return self.number(text)
            case Sentence(message, values):
                return self._filled(_(message), values)
            case Counted(singular, plural, count, values):
                return self._filled(ngettext(singular, plural, count), {**values, "n": Number(count)})
            case Joined(parts, between):
                return between.join(map(self.text, parts))
            case Symbol():
                return self.symbol(text)
            case Expression():
                return self.expression(text)
            case _:
                assert_never(text)

    def _filled(self, message: str, values: Mapping[str, Text]) -> str:
        # a message without holes may hold braces of its own
        return (
            message.format(**{name: self.text(value) for name, value in values.items()})
            if values
            else message
        )

    def shown_unit(self, number: Number) -> tuple[float, str]:
        """Factor from the number's unit to the one it appears in, and that unit; "1" where there is none."""
        return shown_as(number.unit, None if number.unit_fixed else self.display)

    @abstractmethod
    def name(self, text: str) -> str:
        """What a user called something."""

    @abstractmethod
    def number(self, number: Number) -> str:
        """A number with its unit."""

    @abstractmethod
    def symbol(self, symbol: Symbol) -> str:
        """A letter of a formula."""

    @abstractmethod
    def expression(self, expression: Expression) -> str:
        """A piece of mathematics."""


class PlainSpelling(Spelling):
    """Plain text, as terminals print it: a decimal point in every language, units with raised digits."""

    def name(self, text: str) -> str:
        """What a user called something, as it is."""
        return text

    def number(self, number: Number) -> str:
        """A number with its unit behind a blank."""
        factor, unit = self.shown_unit(number)
        digits = self._digits(number.value * factor if factor != 1.0 else number.value, number.digits)
        if number.degrees_too and unit == "rad" and number.value:
            return f"{digits} rad ({self._digits(math.degrees(number.value), number.digits)} deg)"
        return digits if number.unit_hidden or unit in ("", "1") else f"{digits} {typeset_unit(unit)}"

    def _digits(self, value: float, digits: str) -> str:
        return DASH if math.isnan(value) else format(value, digits if len(digits) > 1 else f"{digits}.6g")

    def symbol(self, symbol: Symbol) -> str:
        """A letter with its index behind a low line."""
        return f"{symbol.letter}_{symbol.index}" if symbol.index else symbol.letter

    def expression(self, expression: Expression) -> str:
        """Mathematics in its own notation: terminals have no other."""
        holes = {
            name: leaf
            if isinstance(leaf, str)
            else self.text(leaf.number if isinstance(leaf, Factor) else leaf)
            for name, leaf in expression.values.items()
        }
        return expression.notation.format(**holes)


class FigureSpelling(PlainSpelling):
    """Texts of figures, in which dollar signs part mathematics from words.

    The decimal mark of the language is set when figures are written.
    """

    def name(self, text: str) -> str:
        """What a user called something, in which no dollar sign begins mathematics."""
        return plain(text)

    def symbol(self, symbol: Symbol) -> str:
        """A letter with its index, as mathematics; an index that is a name stands upright."""
        index = symbol.index if symbol.slanted or not symbol.index else rf"\mathrm{{{symbol.index}}}"
        return formula(symbol.letter, index)

    def label(self, label: AxisLabel) -> tuple[float, str, str]:
        """Factor from the label's unit to the one shown, the text of an axis with that unit behind it, and the unit."""
        factor, unit = self.shown_unit(Number(0.0, label.unit, unit_fixed=label.unit_fixed))
        symbol = self.symbol(label.symbol) if label.symbol is not None else ""
        text = " ".join(filter(None, (self.text(label.text), symbol)))
        return factor, f"{text}, {typeset_unit(unit)}" if unit not in ("", "1") else text, unit
