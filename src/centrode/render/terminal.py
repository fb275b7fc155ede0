"""Sheets on a terminal: facts as lines of two columns, tables with aligned columns."""

from __future__ import annotations

import unicodedata
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from centrode.render.spelling import PlainSpelling
from centrode.sheets.texts import Number

if TYPE_CHECKING:
    from centrode.model.asked import Display
    from centrode.sheets.sheet import Column, Fact, Sheet, Table
    from centrode.sheets.texts import Text


def sheet_text(sheet: Sheet, display: Display) -> str:
    """The facts of a sheet, and below them the tables that it prints, a blank line between them."""
    facts = [facts_text(sheet.facts, display)] if sheet.facts else []
    return "\n\n".join([*facts, *(table_text(table, display) for table in sheet.printed)])


def facts_text(facts: Iterable[Fact], display: Display) -> str:
    """Facts below each other, their values aligned."""
    spelling = PlainSpelling(display)
    return aligned([(spelling.text(fact.label), spelling.text(fact.value)) for fact in facts])


def plain_text(text: Text, display: Display) -> str:
    """A text as a terminal prints it."""
    return PlainSpelling(display).text(text)


def table_text(table: Table, display: Display) -> str:
    """A table of texts under its heads; columns of numbers align right."""
    spelling = PlainSpelling(display)
    heads = [_head(column, spelling) for column in table.columns]
    cells = [[spelling.text(text) for text in column.values] for column in table.columns]
    numbers = [k for k, column in enumerate(table.columns) if isinstance(column.values[0], Number)]
    return aligned(list(zip(*cells, strict=True)), heads, numbers)


def _head(column: Column, spelling: PlainSpelling) -> str:
    name = spelling.text(column.head) or column.name
    return f"{name}, {column.unit}" if column.unit not in ("", "1") else name


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
