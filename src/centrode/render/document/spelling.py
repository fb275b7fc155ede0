"""How texts of sheets become text and mathematics of documents: few digits, typeset units, the mark of the language."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from typing import TYPE_CHECKING, assert_never

from centrode.locale import chosen_language, coordinate_separator
from centrode.quantities import DEGREES, spelled_unit, with_unit
from centrode.render.document.formulas import NumberSpelling, in_si
from centrode.render.document.numbers import NARROW, Numbers, spelled_number
from centrode.render.document.typst import TypstSpelling, in_degrees, quote, shown, with_degrees, word
from centrode.render.document.vectors import vector_mathematics
from centrode.render.spelling import Spelling, filled_notation
from centrode.render.symbolic import spell_symbolic
from centrode.sheets.symbolic import FactoredFormula, InverseFormula, SymbolicLeaf
from centrode.sheets.texts import (
    Expression,
    Factor,
    Indexed,
    Leaf,
    Name,
    Number,
    Sentence,
    Slanted,
    Symbol,
    VectorNotation,
)

if TYPE_CHECKING:
    from centrode.sheets.sheet import Column

TANGENT = re.compile(r"\b(arc)?tan\b")
ROUNDING = 1e-12
"""What is below this share of the greatest of a column is zero."""


class DocumentSpelling(Spelling):
    """Texts in which mathematics stands between dollar signs, as blocks of documents hold them.

    Attributes
    ----------
    numbers : Numbers
        How many digits numbers have, and how they are spelled.
    """

    def __init__(self, numbers: Numbers) -> None:
        super().__init__(numbers.display)
        self.numbers = numbers

    def name(self, text: str) -> str:
        """What a user called something, in which nothing is taken for mathematics."""
        return shown(text)

    def number(self, number: Number) -> str:
        """A number with its unit; degrees with their sign."""
        factor, unit = self.shown_unit(number)
        value = number.value * factor if factor != 1.0 else number.value
        text = self._digits(value, number.digits)
        # a number that only the document gives its digits stands in titles, which keep it and its unit together
        gap = " " if number.digits else NARROW
        if number.degrees_too and unit == "rad" and value:
            degrees = self.numbers.plain(math.degrees(value)) + DEGREES
            return f"{with_unit(text, spelled_unit(unit), gap)} ({degrees})"
        return text if number.unit_hidden else with_unit(text, spelled_unit(unit), gap)

    def _digits(self, value: float, digits: str) -> str:
        """A number in the format that its sentence wants, with no more digits than the document has."""
        if digits in ("", "+") or not math.isfinite(value):
            return ("+" if digits == "+" and value > 0.0 else "") + self.numbers.plain(value)
        if not value and digits.endswith("e"):
            return "0"
        text = format(value, digits)
        sign = text[0] if text[0] in "+-" else ""
        body, percent = (text[len(sign) :].removesuffix("%"), "%" if text.endswith("%") else "")
        mantissa, exponent, power = body.partition("e")
        exact = abs(value) * (100.0 if percent else 1.0) / 10.0 ** int(power or 0)
        mantissa = shorten(mantissa, self.numbers.digits, exact)
        spelled = spelled_number(("-" if sign == "-" else "") + mantissa + (f"e{power}" if exponent else ""))
        return ("+" if sign == "+" else "") + spelled + percent

    def symbol(self, symbol: Symbol) -> str:
        """A letter with its index, as mathematics."""
        index = symbol.index if symbol.slanted else f"upright({quote(symbol.index)})"
        return f"${symbol.letter}_({index})$" if symbol.index else f"${symbol.letter}$"

    def with_index(self, symbol: Indexed) -> str:
        """A letter with its index, as mathematics."""
        return f"${symbol.letter}_({quote(symbol.index)})$"

    def expression(self, expression: Expression) -> str:
        """Mathematics between dollar signs."""
        return f"${self.mathematics(expression)}$"

    def place(self, coordinates: Sequence[Number], unit: str) -> str:
        """A place, its coordinates parted as the decimal mark of the language allows."""
        label = self.numbers.shown(unit)[1]
        return f"({coordinate_separator().join(map(self.number, coordinates))}) {label}".rstrip()

    def part(self, text: str) -> str:
        """What belongs to the entry above it, behind a dash."""
        return f"– {text}"

    def symbolic(self, leaf: SymbolicLeaf) -> str:
        """A formula in letters, as mathematics."""
        return f"${self.mathematics(leaf)}$"

    def vectors(self, notation: str) -> str:
        """A relation of a construction on paper, as mathematics."""
        return f"${vector_mathematics(notation)}$"

    def mathematics(self, leaf: Leaf) -> str:
        """Mathematics without the dollar signs, numbers with their units."""
        if isinstance(leaf, SymbolicLeaf):
            return spell_symbolic(leaf, self._letters(leaf))
        match leaf:
            case str():
                return spelled_functions(leaf)
            case Expression(notation, values):
                spelled = {name: self.mathematics(value) for name, value in values.items()}
                return with_degrees(spelled_functions(notation).format(**spelled))
            case Number():
                size, label = self._size(leaf)
                if leaf.unit_hidden or not label:
                    return size
                return in_degrees(size) if label == DEGREES else f"{size} thin {quote(label)}"
            case Factor(number):
                size, _label = self._size(number)
                return f"({size})" if number.value < 0 or "dot" in size else size
            case Name(text):
                return quote(text)
            case Slanted(text):
                return word(text)
            case Sentence():
                return quote(self.text(leaf))
            case Symbol():
                return self.symbol(leaf).strip("$")
            case Indexed(letter, index):
                return f"{letter}_({index if index.isdecimal() else quote(index)})"
            case VectorNotation():
                return vector_mathematics(filled_notation(leaf))
            case _:
                assert_never(leaf)

    def _letters(self, leaf: SymbolicLeaf) -> TypstSpelling:
        """How the letters of a formula are written: as letters, or as the numbers that it brings along."""
        if isinstance(leaf, (FactoredFormula, InverseFormula)) and leaf.values is not None:
            return NumberSpelling(leaf.values, self.numbers)
        return TypstSpelling()

    def _size(self, number: Number) -> tuple[str, str]:
        """A number as mathematics, and the label of its unit."""
        factor, unit = self.shown_unit(number)
        return self.numbers.math(number.value * factor), spelled_unit(unit)

    def head(self, column: Column) -> str:
        """Head of a column: what it holds, with the unit behind it."""
        name = self.text(column.head) or self.name(column.name)
        return self.of_column(column).head(name, column.unit)

    def of_column(self, column: Column) -> Numbers:
        """How the numbers of a column are spelled: in the units of the display, or in SI."""
        return in_si(self.numbers) if column.unit_fixed else self.numbers


def spelled_functions(notation: str) -> str:
    """Mathematics with the names of functions that readers of the language write: tg and arctg, but tan in English."""
    return notation if chosen_language() == "en" else TANGENT.sub(r'op("\1tg")', notation)


def shorten(mantissa: str, digits: int, exact: float) -> str:
    """A decimal with at most so many digits, its whole part kept; rounded once, from the number it spells."""
    whole = len(mantissa.partition(".")[0])
    if "." not in mantissa or len(mantissa.replace(".", "").lstrip("0")) <= digits:
        return mantissa
    return f"{exact:.0f}" if whole >= digits else f"{exact:.{digits}g}"
