"""How texts of sheets become strings: the rules that all renderers share, and those of terminals and figures."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import TYPE_CHECKING, assert_never

from centrode.locale import _, ngettext
from centrode.present.shown import formula, plain, shown_as
from centrode.quantities import typeset_unit
from centrode.sheets.texts import (
    Coordinates,
    Counted,
    Expression,
    Factor,
    Indexed,
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


class Spelling(ABC):
    """Turns texts into strings of one medium, in the language that is spoken at the moment.

    Attributes
    ----------
    display : Display or None
        Units of lengths and angles; SI where None.
    apart : str
        What parts coordinates.
    """

    apart = ", "

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
            case Coordinates():
                return self.coordinates(text)
            case Indexed():
                return self.indexed(text)
            case _:
                assert_never(text)

    def coordinates(self, place: Coordinates) -> str:
        """A place in brackets, its unit behind it."""
        numbers = [
            self.number(Number(value, place.unit, place.digits, unit_hidden=True)) for value in place.values
        ]
        unit = self.unit(Number(0.0, place.unit))
        return f"({self.apart.join(numbers)}) {unit}".rstrip()

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

    @abstractmethod
    def indexed(self, symbol: Indexed) -> str:
        """A letter with numbers of bodies as its index."""

    @abstractmethod
    def unit(self, number: Number) -> str:
        """The unit that a number appears in; nothing where there is none."""


class PlainSpelling(Spelling):
    """Plain text, as terminals print it: a decimal point in every language, units with raised digits."""

    def name(self, text: str) -> str:
        """What a user called something, as it is."""
        return text

    def number(self, number: Number) -> str:
        """A number with its unit behind a blank."""
        factor, unit = self.shown_unit(number)
        digits = format(number.value * factor if factor != 1.0 else number.value, number.digits or ".6g")
        text = digits if number.unit_hidden or unit in ("", "1") else f"{digits} {typeset_unit(unit)}"
        if number.degrees_too and unit == "rad":
            return f"{text} ({math.degrees(number.value):.6g} deg)"
        return text

    def unit(self, number: Number) -> str:
        """The unit with raised digits."""
        unit = self.shown_unit(number)[1]
        return "" if unit in ("", "1") else typeset_unit(unit)

    def indexed(self, symbol: Indexed) -> str:
        """The letter with its index right behind it."""
        return f"{symbol.letter}{symbol.index}"

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

    def indexed(self, symbol: Indexed) -> str:
        """The letter with its index below it."""
        return f"${symbol.letter}_{{{symbol.index}}}$"

    def label(self, label: AxisLabel) -> tuple[float, str, str]:
        """Factor from the label's unit to the one shown, the text of an axis with that unit behind it, and the unit."""
        factor, unit = self.shown_unit(Number(0.0, label.unit, unit_fixed=label.unit_fixed))
        symbol = self.symbol(label.symbol) if label.symbol is not None else ""
        text = " ".join(filter(None, (self.text(label.text), symbol)))
        return factor, f"{text}, {typeset_unit(unit)}" if unit not in ("", "1") else text, unit
