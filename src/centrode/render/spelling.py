"""How texts of sheets become strings: the rules that all renderers share, those of terminals, figures and data."""

from __future__ import annotations

import math
import re
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, assert_never

from centrode.locale import _, decimal_mark, ngettext
from centrode.model.settings import shown_as
from centrode.quantities import spelled_unit, terminal_unit, typeset_unit, with_unit
from centrode.render.drawing.texts import formula, plain
from centrode.render.symbolic import plain_symbolic
from centrode.sheets.symbolic import SymbolicLeaf
from centrode.sheets.texts import (
    Counted,
    Expression,
    Factor,
    Indexed,
    Joined,
    Leaf,
    Name,
    Number,
    Part,
    Place,
    Sentence,
    Setting,
    Slanted,
    Symbol,
    Text,
    Title,
    Unit,
    VectorNotation,
)

if TYPE_CHECKING:
    from centrode.model.settings import Display
    from centrode.sheets.plots import AxisLabel


DASH = "–"
"""Stands for a number that is not there."""
SCREEN_DIGITS = 6
"""Significant digits of a number that people read on a screen; its files have all that it has."""
LONG_FORMAT = re.compile(r"\.(?:[7-9]|1\d)g$")
"""Formats with more digits than a screen shows."""


class Spelling(ABC):
    """Turns texts into strings of one medium, in the language that is spoken at the moment.

    Attributes
    ----------
    display : Display or None
        Units of lengths and angles; SI where None.
    """

    decimal = "."
    """What stands before the decimals of a number; spellings that take the language's mark say so."""

    def __init__(self, display: Display | None) -> None:
        self.display = display

    def text(self, text: Text) -> str:
        """A text as a string."""
        if isinstance(text, SymbolicLeaf):
            return self.symbolic(text)
        match text:
            case Name(what) | Slanted(what):
                return self.name(what)
            case Title(what):
                return self.name(_(what))
            case Number():
                return self.number(text)
            case Sentence(message, values):
                return self._fill_message(_(message), values)
            case Counted(singular, plural, count, values):
                return self._fill_message(
                    ngettext(singular, plural, count), {**values, "n": Number(count, digits="d")}
                )
            case Joined(parts, between):
                return between.join(map(self.text, parts))
            case Symbol():
                return self.symbol(text)
            case Expression():
                return self.expression(text)
            case Unit(unit, shown):
                return self.unit(shown_as(unit, self.display)[1] if shown else unit)
            case Place(coordinates, unit, digits):
                return self.place(
                    [Number(value, unit, digits, unit_hidden=True) for value in coordinates], unit
                )
            case Setting():
                return self.setting(text)
            case Indexed():
                return self.with_index(text)
            case Part(part):
                return self.part(self.text(part))
            case VectorNotation():
                return self.vectors(filled_notation(text, self.decimal))
            case _:
                assert_never(text)

    def _fill_message(self, message: str, values: Mapping[str, Text]) -> str:
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

    def setting(self, setting: Setting) -> str:
        """A line of a description with its table: pages and documents have no options."""
        return _("{line} under [{table}]").format(line=setting.line, table=setting.table)

    def unit(self, unit: str) -> str:
        """A unit as readers of the language print it; nothing for a plain number."""
        return spelled_unit(unit)

    @abstractmethod
    def with_index(self, symbol: Indexed) -> str:
        """A letter with numbers of bodies as its index."""

    @abstractmethod
    def place(self, coordinates: Sequence[Number], unit: str) -> str:
        """A place."""

    @abstractmethod
    def part(self, text: str) -> str:
        """What belongs to the entry above it."""

    @abstractmethod
    def vectors(self, notation: str) -> str:
        """A relation of a construction on paper."""

    @abstractmethod
    def symbolic(self, leaf: SymbolicLeaf) -> str:
        """A formula in the letters of equations."""


def filled_notation(relation: VectorNotation, decimal: str = ".") -> str:
    """The notation of a relation with its numbers."""
    numbers = {
        name: format(number.value, number.digits).replace(".", decimal)
        for name, number in relation.values.items()
    }
    return relation.notation.format(**numbers) if numbers else relation.notation


GUIDE = re.compile(r"∥ guide ([^()]+)(?=\))")
"""A guide in the notation of constructions: "(∥ guide A)"."""


class PlainSpelling(Spelling):
    """Plain text, as terminals print it: a decimal point in every language, degrees that can be typed again."""

    def name(self, text: str) -> str:
        """What a user called something, as it is."""
        return text

    def number(self, number: Number) -> str:
        """A number with its unit behind a blank."""
        factor, unit = self.shown_unit(number)
        digits = self._digits(number.value * factor if factor != 1.0 else number.value, number.digits)
        text = digits if number.unit_hidden else with_unit(digits, self.label_of(unit))
        if number.degrees_too and unit == "rad":
            return f"{text} ({with_unit(self._digits(math.degrees(number.value), ''), self.label_of('deg'))})"
        return text

    def label_of(self, unit: str) -> str:
        """A unit as it stands behind a number."""
        return self.unit(unit)

    def _digits(self, value: float, digits: str) -> str:
        if math.isnan(value):
            return DASH
        if not value and digits.endswith("e"):
            return "0"
        return format(value, f"{digits}.6g" if digits in ("", "+") else digits)

    def symbol(self, symbol: Symbol) -> str:
        """A letter with its index behind a low line."""
        return f"{symbol.letter}_{symbol.index}" if symbol.index else symbol.letter

    def expression(self, expression: Expression) -> str:
        """Mathematics in its own notation: terminals have no other."""
        holes = {name: self.leaf(leaf) for name, leaf in expression.values.items()}
        return expression.notation.format(**holes)

    def with_index(self, symbol: Indexed) -> str:
        """The letter with its index right behind it."""
        return f"{symbol.letter}{symbol.index}"

    def unit(self, unit: str) -> str:
        """A unit as terminals print it."""
        return terminal_unit(unit)

    def place(self, coordinates: Sequence[Number], unit: str) -> str:
        """A place as "(1.25, 0) m"."""
        label = self.label_of(shown_as(unit, self.display)[1])
        return f"({', '.join(map(self.number, coordinates))}) {label}".rstrip()

    def setting(self, setting: Setting) -> str:
        """A line of a description with its table, or the option."""
        under = super().setting(setting)
        return _("{line}, or the option {option}").format(line=under, option=setting.option)

    def part(self, text: str) -> str:
        """What belongs to the entry above it, indented."""
        return f"  {text}"

    def vectors(self, notation: str) -> str:
        """A relation of a construction on paper, in its own notation."""
        return GUIDE.sub(lambda found: _("∥ guide {guide}").format(guide=found[1]), notation)

    def symbolic(self, leaf: SymbolicLeaf) -> str:
        """A formula in letters, as one line."""
        return plain_symbolic(leaf)

    def leaf(self, leaf: Leaf) -> str:
        """A part of a relation."""
        if isinstance(leaf, str):
            return leaf
        return self.text(leaf.number if isinstance(leaf, Factor) else leaf)


class DataSpelling(PlainSpelling):
    """Plain text in files of data: units by their SI names in every language."""

    def unit(self, unit: str) -> str:
        """A unit by its name, "kg m^2"."""
        return unit

    def label_of(self, unit: str) -> str:
        """A unit by its name, with raised powers; nothing for a plain number."""
        return "" if unit == "1" else typeset_unit(unit)


class PrintSpelling(PlainSpelling):
    """Plain text beside drawings, with units as books print them."""

    def setting(self, setting: Setting) -> str:
        """A line of a description with its table: no command is at hand."""
        return Spelling.setting(self, setting)

    def unit(self, unit: str) -> str:
        """A unit as books print it."""
        return spelled_unit(unit)


class ScreenSpelling(PrintSpelling):
    """As on paper, with the decimal mark of the language; a semicolon parts coordinates where that is a comma.

    `sentences` is what the page makes of a translated sentence before its holes are filled.
    """

    def __init__(self, display: Display | None, sentences: Callable[[str], str] = str) -> None:
        super().__init__(display)
        self.decimal = decimal_mark()
        self.sentences = sentences

    def _fill_message(self, message: str, values: Mapping[str, Text]) -> str:
        return super()._fill_message(self.sentences(message), values)

    def _digits(self, value: float, digits: str) -> str:
        read = LONG_FORMAT.sub(f".{SCREEN_DIGITS}g", digits)
        return super()._digits(value, read).replace(".", self.decimal)

    def place(self, coordinates: Sequence[Number], unit: str) -> str:
        """A place as "(1.25, 0) m" or "(1,25; 0) m"."""
        if self.decimal == ".":
            return super().place(coordinates, unit)
        label = self.label_of(shown_as(unit, self.display)[1])
        return f"({'; '.join(map(self.number, coordinates))}) {label}".rstrip()


class DrawingSpelling(PrintSpelling):
    """Plain texts within drawings: a minus as in print."""

    def number(self, number: Number) -> str:
        """A number with its unit behind a blank."""
        return super().number(number).replace("-", "−")


class FigureSpelling(PrintSpelling):
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

    def with_index(self, symbol: Indexed) -> str:
        """The letter with its index below it."""
        return f"${symbol.letter}_{{{symbol.index}}}$"

    def label(self, label: AxisLabel) -> tuple[float, str, str]:
        """Factor from the label's unit to the one shown, the text of an axis with that unit behind it, and the unit."""
        factor, unit = self.shown_unit(Number(0.0, label.unit, unit_fixed=label.unit_fixed))
        symbol = self.symbol(label.symbol) if label.symbol is not None else ""
        text = " ".join(filter(None, (self.text(label.text), symbol)))
        shown = self.unit(unit)
        return factor, f"{text}, {shown}" if shown else text, unit
