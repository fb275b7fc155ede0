"""Sheets on a terminal: facts as lines of two columns, tables with aligned columns."""

from __future__ import annotations

import unicodedata
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, assert_never

from centrode.render.spelling import PlainSpelling
from centrode.sheets.sheet import (
    Block,
    Check,
    FactTable,
    Formula,
    Illustration,
    Listing,
    Paragraph,
    Section,
    Table,
)
from centrode.sheets.texts import NOTHING, Number

if TYPE_CHECKING:
    from centrode.model.asked import Display
    from centrode.sheets.sheet import Fact, Sheet

WIDTH = 100
"""Columns of a listing."""


def sheet_text(sheet: Sheet, display: Display) -> str:
    """What a terminal prints of a sheet: its sections, or its facts where it has none."""
    spelling = PlainSpelling(display)
    sections = sheet.printed or (Section(NOTHING, (FactTable(sheet.facts),)),)
    return "\n\n".join(_section(section, spelling) for section in sections)


def _section(section: Section, spelling: PlainSpelling) -> str:
    parts = [spelling.text(section.title), *(_block(block, spelling) for block in section.blocks)]
    return "\n".join(filter(None, parts))


def _block(block: Block, spelling: PlainSpelling) -> str:
    """A block as lines; formulas, pictures and checks belong to documents."""
    match block:
        case FactTable(facts):
            return _facts(facts, spelling)
        case Table():
            return _table(block, spelling)
        case Paragraph(text):
            return spelling.text(text)
        case Listing(heading, items):
            return listing(spelling.text(heading), [spelling.text(item) for item in items])
        case Formula() | Illustration() | Check():
            return ""
        case _:
            assert_never(block)


def _table(table: Table, spelling: PlainSpelling) -> str:
    """A table under its heads; columns of numbers align right, with the unit behind the head."""
    heads, columns = [], []
    for column in table.columns:
        head = spelling.text(column.head) or column.name
        unit = spelling.unit(Number(0.0, column.unit))
        heads.append(f"{head}, {unit}" if unit else head)
        columns.append(
            [spelling.text(text) for text in column.values]
            if isinstance(column.values, tuple)
            else [
                spelling.number(Number(value, column.unit, unit_hidden=True))
                for value in column.values.tolist()
            ]
        )
    right = [number for number, column in enumerate(table.columns) if not isinstance(column.values, tuple)]
    return aligned(list(zip(*columns, strict=True)), heads, right)


def listing(heading: str, items: Sequence[str]) -> str:
    """A heading with items behind it, or indented below it where one line does not hold them; no item is broken."""
    line = ", ".join(items)
    if len(heading) + 2 + len(line) <= WIDTH:
        return f"{heading}: {line}"
    lines = [f"{heading}:", ""]
    for number, item in enumerate(items, start=1):
        piece = item if number == len(items) else f"{item},"
        longer = f"{lines[-1]} {piece}" if lines[-1] else f"  {piece}"
        if lines[-1] and len(longer) > WIDTH:
            lines.append(f"  {piece}")
        else:
            lines[-1] = longer
    return "\n".join(lines)


def facts_text(facts: Iterable[Fact], display: Display) -> str:
    """Facts below each other, their values aligned."""
    return _facts(facts, PlainSpelling(display))


def _facts(facts: Iterable[Fact], spelling: PlainSpelling) -> str:
    return aligned([(spelling.text(fact.label), spelling.text(fact.value)) for fact in facts])


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
