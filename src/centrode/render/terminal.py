"""Sheets on a terminal: facts as lines of two columns, tables with aligned columns."""

from __future__ import annotations

import unicodedata
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from centrode.quantities import typeset_unit
from centrode.render.spelling import PlainSpelling, holds_numbers
from centrode.sheets.texts import Number

if TYPE_CHECKING:
    from centrode.model.asked import Display
    from centrode.sheets.sheet import Column, Fact, Sheet, Table


def facts_text(facts: Iterable[Fact], display: Display) -> str:
    """Facts below each other, their values aligned."""
    spelling = PlainSpelling(display)
    return aligned([(spelling.text(fact.label), spelling.text(fact.value)) for fact in facts])


def sheet_text(sheet: Sheet, display: Display) -> str:
    """The heading, the facts and the printed tables of a sheet below each other, a line free between them."""
    spelling = PlainSpelling(display)
    parts = [spelling.text(sheet.heading), facts_text(sheet.facts, display)]
    for table in sheet.printed:
        parts += [spelling.text(table.caption), table_text(table, display)]
    return "\n\n".join(filter(None, parts))


def table_text(table: Table, display: Display) -> str:
    """A table under its heads; all columns align right, but for the first where it holds words."""
    spelling = PlainSpelling(display)
    columns = [[head_of(column, spelling), *_cells(column, spelling)] for column in table.columns]
    first = 0 if holds_numbers(table.columns[0]) else 1
    return aligned(list(zip(*columns, strict=True)), right=range(first, len(columns)))


def head_of(column: Column, spelling: PlainSpelling) -> str:
    """What a column holds, with the unit shown behind it: "φ, deg"."""
    unit = spelling.shown_unit(Number(0.0, column.unit))[1]
    name = spelling.text(column.head) or column.name
    return name if unit in ("", "1") else f"{name}, {typeset_unit(unit)}"


def _cells(column: Column, spelling: PlainSpelling) -> Sequence[str]:
    values = column.values
    if isinstance(values, np.ndarray):
        values = tuple(Number(value, column.unit, unit_hidden=True) for value in values.tolist())
    return [spelling.text(value) for value in values]


def aligned(rows: Sequence[Sequence[str]], header: Sequence[str] = (), right: Sequence[int] = ()) -> str:
    """Rows as plain text, columns aligned and two spaces apart; the columns numbered in `right` align right."""
    lines = [list(header), *rows] if header else list(rows)
    widths = [max(width_of(cell) for cell in column) for column in zip(*lines, strict=True)]
    texts = []
    for line in lines:
        gaps = [" " * (width - width_of(cell)) for cell, width in zip(line, widths, strict=True)]
        cells = [
            gap + cell if number in right else cell + gap
            for number, (cell, gap) in enumerate(zip(line, gaps, strict=True))
        ]
        texts.append("  ".join(cells).rstrip())
    return "\n".join(texts)


def width_of(text: str) -> int:
    """Columns that a text takes on a terminal: marks over letters take none, East Asian letters two."""
    marks = sum(unicodedata.category(letter) in ("Mn", "Me", "Cf") for letter in text)
    wide = sum(unicodedata.east_asian_width(letter) in ("W", "F") for letter in text)
    return len(text) - marks + wide
