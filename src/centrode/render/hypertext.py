"""Sheets as parts of a page, as notebooks show them: the first picture, facts and tables."""

from __future__ import annotations

import html
import io
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, assert_never

from matplotlib.backends.backend_svg import FigureCanvasSVG

from centrode.present.figure_files import METADATA
from centrode.present.spelled_figures import spell_decimals
from centrode.present.style import house_style
from centrode.render.figures import figures_of
from centrode.render.spelling import PlainSpelling
from centrode.render.terminal import fact_rows, table_cells
from centrode.sheets.outlines import CamPlayer
from centrode.sheets.sheet import (
    Block,
    Check,
    FactTable,
    Formula,
    Illustration,
    Items,
    Listing,
    Paragraph,
    Section,
    Table,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from centrode.model.settings import Display
    from centrode.sheets.sheet import Sheet


def sheet_html(sheet: Sheet, display: Display) -> str:
    """The first picture of a sheet over its facts and what a terminal prints below them, as XHTML."""
    spelling = PlainSpelling(display)
    first = next(iter(sheet.pictures), None)
    drawn = {} if first is None else figures_of({first: sheet.pictures[first]}, display)
    parts = [figure_html(figure) for figure in drawn.values()]
    parts.append(rows_html((), fact_rows(sheet.facts, display)))
    for block in sheet.printed:
        if isinstance(block, Section):
            parts.append(f"<h5>{html.escape(spelling.text(block.title))}</h5>")
        parts += [
            _block(one, spelling, display)
            for one in (block.blocks if isinstance(block, Section) else (block,))
        ]
    return "".join(parts)


def figure_html(figure: Figure) -> str:
    """A figure as SVG within a page."""
    with house_style():
        spell_decimals(figure)
        canvas: Any = FigureCanvasSVG(figure)
        drawn = io.BytesIO()
        canvas.print_svg(drawn, metadata=METADATA["svg"])
    text = drawn.getvalue().decode()
    return f"<div style='max-width: 36em'>{text[text.index('<svg') :]}</div>"


def rows_html(heads: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Rows of texts as a table under their heads; nothing without rows."""
    if not rows:
        return ""
    head = "".join(f"<th style='text-align: left'>{html.escape(cell)}</th>" for cell in heads)
    lines = [
        "<tr>" + "".join(f"<td style='text-align: left'>{html.escape(cell)}</td>" for cell in row) + "</tr>"
        for row in rows
    ]
    return f"<table>{f'<tr>{head}</tr>' if head else ''}{''.join(lines)}</table>"


def _block(block: Block, spelling: PlainSpelling, display: Display) -> str:
    """A block of a sheet; formulas, pictures and checks belong to documents."""
    match block:
        case FactTable(facts):
            return rows_html((), fact_rows(facts, display))
        case Table():
            heads, rows = table_cells(block, spelling)
            return _paragraph(spelling.text(block.caption)) + rows_html(heads, rows)
        case Paragraph(text):
            return _paragraph(spelling.text(text))
        case Items(texts) | Listing(_, texts):
            heading = spelling.text(block.heading) if isinstance(block, Listing) else ""
            items = "".join(f"<li>{html.escape(spelling.text(item))}</li>" for item in texts)
            return f"{_paragraph(heading)}<ul>{items}</ul>"
        case Formula() | Illustration() | Check() | CamPlayer():
            return ""
        case _:
            assert_never(block)


def _paragraph(text: str) -> str:
    return f"<p>{html.escape(text)}</p>" if text else ""
