"""Formulas with their numbers put in, as a textbook writes them behind the letters."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence

from centrode.equations.spelling import SymbolFormula, spell_formula
from centrode.equations.symbols import Letter, Parts, SumTerm, Wave
from centrode.locale import _
from centrode.present.equations import page
from centrode.present.equations.typst import LONG, TypstSpelling, in_degrees, strip_brackets
from centrode.render.document.blocks import (
    Block,
    FormulaBlock,
    ParagraphBlock,
    SectionBlocks,
    SystemBlock,
    TableBlock,
    shown,
)
from centrode.render.document.numbers import Numbers, respell
from centrode.render.document.rows import degrees

MOST_TERMS, MOST_NUMBERS = 6, 26
"""Terms and numbers of the longest formula that is written with its numbers: beyond them nobody follows."""

NOTHING = 1e-14
"""Part of the greatest number of its kind below which a number is rounding."""


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


def with_numbers(
    formula: SymbolFormula,
    values: Mapping[Letter, float],
    numbers: Numbers,
    differences_first: bool = False,
    turned: bool = False,
) -> str | None:
    """A formula with its numbers, spelled as `spell_formula` does.

    None where it is too long, has no letters, or one of its numbers does not exist.
    """
    letters = sum(_count(term) for term in (formula.product, *formula.rest.terms))
    if not letters or formula.size > MOST_TERMS or letters > MOST_NUMBERS:
        return None
    if not all(math.isfinite(values.get(letter, math.nan)) for letter in formula.total.letters):
        return None
    return spell_formula(formula, NumberSpelling(values, numbers), differences_first, turned)


def _count(term: SumTerm) -> int:
    return len(term.letters) + sum(len(one.parts) for one, _power in term.waves)


def clean_rates(values: Mapping[Letter, float], rates: Iterable[Letter]) -> dict[Letter, float]:
    """Values as they are shown: rates that are nothing but the rounding of others are zero."""
    found = dict(values)
    sizes = [abs(values[letter]) for letter in rates if math.isfinite(values[letter])]
    for letter in rates:
        if abs(values[letter]) <= NOTHING * max(sizes, default=0.0):
            found[letter] = 0.0
    return found


# Equations spelled for a page as blocks of a report: the relations and systems that `centrode equations`
# prints.


def section_of(section: page.PageSection) -> SectionBlocks:
    """A section of the equations' page as one of a report."""
    return SectionBlocks(section.heading, blocks_of(section.entries))


def blocks_of(entries: Iterable[page.Entry]) -> tuple[Block, ...]:
    """Relations that follow each other stand below each other."""
    found: list[Block] = []
    lines: list[tuple[str, ...]] = []
    for entry in entries:
        if isinstance(entry, page.Relation):
            lines.append(entry.parts)
            continue
        if lines:
            found.append(FormulaBlock(tuple(lines)))
            lines = []
        found.append(_block(entry))
    return (*found, FormulaBlock(tuple(lines))) if lines else tuple(found)


def _block(entry: page.PageSystem | page.Symbols | page.Note) -> Block:
    if isinstance(entry, page.PageSystem):
        return SystemBlock(entry.matrix, entry.unknowns, entry.right)
    if isinstance(entry, page.Note):
        return ParagraphBlock(entry.text)
    rows = tuple((f"${name}$", respell(degrees(value)), shown(words)) for name, value, words in entry.rows)
    return TableBlock((_("symbol"), _("value"), _("meaning")), rows, "", (False, True, False))
