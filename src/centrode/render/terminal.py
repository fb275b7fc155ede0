"""Sheets on a terminal: facts as lines of two columns, tables with aligned columns."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable
from typing import TYPE_CHECKING, assert_never

from centrode.locale import _
from centrode.render.plain_formulas import relation_lines, symbol_lines, system_lines
from centrode.render.plain_table import WIDTH, aligned_text, broken_text, listing
from centrode.render.spelling import PlainSpelling
from centrode.sheets.players import CamPlayer, MotionPlayer, WheelPlayer
from centrode.sheets.sheet import (
    Block,
    Check,
    FactTable,
    Formula,
    Illustration,
    Items,
    Listing,
    Paragraph,
    Reference,
    Section,
    SheetEquations,
    SymbolList,
    Table,
)
from centrode.sheets.texts import Number

if TYPE_CHECKING:
    from centrode.model.settings import Display
    from centrode.sheets.sheet import Column, ExplainedSymbol, Fact, Sheet
    from centrode.sheets.texts import Text

INDENT = "  "


def fact_rows(facts: Iterable[Fact], display: Display) -> list[tuple[str, str]]:
    """Labels and values of facts, to stand among other rows."""
    spelling = PlainSpelling(display)
    return [(spelling.text(fact.label), spelling.text(fact.value)) for fact in facts]


def plain_text(text: Text, display: Display) -> str:
    """A text as a terminal prints it."""
    return PlainSpelling(display).text(text)


def sheet_text(sheet: Sheet, display: Display, width: int | None = None) -> str:
    """What a terminal prints of a sheet: its facts and what it prints below them, a blank line between the parts.

    Notes stand right below the last part.

    Parameters
    ----------
    width : columns of the terminal, beyond which facts, tables and sentences are broken; where None only paragraphs are
    """
    spelling = PlainSpelling(display)
    heading = spelling.text(sheet.heading)
    parts = [heading] if heading else []
    parts += [aligned_text(fact_rows(sheet.facts, display), width=width)] if sheet.facts else []
    for block in sheet.printed:
        text = (
            _section(block, spelling, width) if isinstance(block, Section) else _block(block, spelling, width)
        )
        if not text:
            continue  # what a page plays
        if isinstance(block, Items) and parts:
            parts[-1] += "\n" + text  # what is above them is their heading
        else:
            parts.append(text)
    notes = [line for note in notes_of(sheet, spelling) for line in _lines(note, width)]
    return "\n".join(["\n\n".join(parts), *notes] if parts else notes)


def notes_of(sheet: Sheet, spelling: PlainSpelling) -> list[str]:
    """What a reader should know besides, a line each."""
    return [_("note: {note}").format(note=spelling.text(note)) for note in sheet.notes]


def _lines(text: str, width: int | None) -> list[str]:
    """A sentence as it is, or in lines that the terminal holds."""
    return [text] if width is None else broken_text(text, width, INDENT)


def _section(section: Section, spelling: PlainSpelling, width: int | None) -> str:
    parts = [spelling.text(section.title), *(_part(block, spelling, width) for block in section.blocks)]
    return "\n".join(filter(None, parts))


def _part(block: Block, spelling: PlainSpelling, width: int | None) -> str:
    """A block below the title of a section: sentences and formulas are indented."""
    if not isinstance(block, Paragraph | Formula | SheetEquations | SymbolList):
        return _block(block, spelling, width)
    text = _block(block, spelling, None if width is None else width - len(INDENT))
    text = textwrap.indent(text, INDENT)
    return f"{text}\n" if isinstance(block, SheetEquations) else text


def _block(block: Block, spelling: PlainSpelling, width: int | None) -> str:
    """A block as lines; pictures and checks belong to documents."""
    narrow = WIDTH if width is None else min(WIDTH, width)
    match block:
        case FactTable(facts):
            return aligned_text(
                [(spelling.text(fact.label), spelling.text(fact.value)) for fact in facts], width=width
            )
        case Table():
            return table_text(block, spelling, width)
        case Paragraph(text):
            return textwrap.fill(spelling.text(text), max(narrow, 1))
        case Items(texts):
            return "\n".join(
                line for item in texts for line in _lines(f"{INDENT}{spelling.text(item)}", width)
            )
        case Listing(heading, items):
            return listing(spelling.text(heading), [spelling.text(item) for item in items], narrow)
        case Formula(relations):
            return "\n".join(line for one in relations for line in relation_lines(map(spelling.leaf, one)))
        case SheetEquations(matrix, unknowns, right):
            entries = [list(map(spelling.leaf, row)) for row in matrix]
            sides = (list(map(spelling.leaf, side)) for side in (unknowns, right))
            return "\n".join(system_lines(entries, *sides))
        case SymbolList(symbols):
            return "\n".join(symbol_lines([symbol_texts(one, spelling) for one in symbols]))
        case Illustration() | Reference() | Check() | CamPlayer() | WheelPlayer() | MotionPlayer():
            return ""
        case _:
            assert_never(block)


def table_text(table: Table, spelling: PlainSpelling, width: int | None = None) -> str:
    """A table of texts below its caption; numbers without units of their own stand flush right."""
    heads, rows = table_cells(table, spelling)
    right = [number for number, column in enumerate(table.columns) if _stands_right(column)]
    caption = spelling.text(table.caption)
    return (f"{caption}\n" if caption else "") + aligned_text(rows, heads, right, width)


def table_cells(table: Table, spelling: PlainSpelling) -> tuple[list[str], list[tuple[str, ...]]]:
    """Heads with their units, and the rows of a table, as texts."""
    heads = [_head(column, spelling) for column in table.columns]
    cells = [
        [
            spelling.text(
                Number(
                    value,
                    column.units[row] if column.units else column.unit,
                    unit_hidden=True,
                    unit_fixed=column.unit_fixed,
                )
            )
            if isinstance(value, float)
            else spelling.text(value)
            for row, value in enumerate(column.values)
        ]
        for column in table.columns
    ]
    return heads, list(zip(*cells, strict=True))


def symbol_texts(symbol: ExplainedSymbol, spelling: PlainSpelling) -> tuple[str, str, str]:
    """A symbol, its value, and what it stands for."""
    return spelling.leaf(symbol.symbol), spelling.text(symbol.value), spelling.text(symbol.meaning)


def _head(column: Column, spelling: PlainSpelling) -> str:
    """What a column holds, with the unit that is shown behind it."""
    name = spelling.text(column.head) or column.name
    unit = spelling.label_of(spelling.shown_unit(Number(0.0, column.unit, unit_fixed=column.unit_fixed))[1])
    return f"{name}, {unit}" if unit else name


def _stands_right(column: Column) -> bool:
    return column.is_numeric or any(
        isinstance(text, Number) and (text.unit_hidden or text.unit in ("", "1")) for text in column.values
    )
