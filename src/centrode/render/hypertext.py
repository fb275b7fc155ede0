"""Sheets as parts of a page, as notebooks show them: the first picture, facts and tables."""

from __future__ import annotations

import html
import io
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from matplotlib.backends.backend_svg import FigureCanvasSVG

from centrode.render.drawing.looks import INK, ColourLooks, screen_figure
from centrode.render.drawing.style import house_style
from centrode.render.figures.files import METADATA, spell_decimals
from centrode.render.figures.pictures import figures_of
from centrode.render.latex import aligned_relations
from centrode.render.markup import MarkupPage

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from centrode.model.settings import Display
    from centrode.sheets.sheet import Sheet


def sheet_html(sheet: Sheet, display: Display) -> str:
    """The first picture of a sheet over its facts and what a terminal prints below them, as XHTML."""
    first = next(iter(sheet.pictures), None)
    drawn = {} if first is None else figures_of({first: sheet.pictures[first]}, display)
    return "".join(map(figure_html, drawn.values())) + HypertextPage(display).page(sheet, "")


DARK_NOTEBOOKS = (
    "html[theme=dark]",
    "html[data-theme=dark]",
    "body[data-theme=dark]",
    "body[data-jp-theme-light=false]",
    "body.vscode-dark",
)
"""How notebooks say that they are dark: they have a choice of their own, whatever the system asks for."""


def figure_html(figure: Figure) -> str:
    """A figure as SVG within a page, which follows the look of notebooks; without their word it is as on paper."""
    with house_style():
        spell_decimals(figure)
        canvas: Any = FigureCanvasSVG(figure)
        drawn = io.BytesIO()
        canvas.print_svg(drawn, metadata=METADATA["svg"])
    looks: dict[str, ColourLooks] = {}

    def spell(look: ColourLooks) -> str:
        name = f"--centrode-{look.printed[1:]}-{look.dark[1:]}"
        looks[name] = look
        return f"var({name}, {look.printed})"

    ink = spell(INK)
    svg = screen_figure(drawn.getvalue().decode(), spell)
    dark = "; ".join(f"{name}: {look.dark}" for name, look in looks.items())
    places = ", ".join(f"{one} .centrode-figure" for one in DARK_NOTEBOOKS)
    style = f"<style>{places} {{ {dark} }}</style>"
    return f"{style}<div class='centrode-figure' style='max-width: 36em; color: {ink}'>{svg}</div>"


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


class HypertextPage(MarkupPage):
    """Sheets as XHTML; whatever users called something is shown as it is."""

    def page(self, sheet: Sheet, title: str) -> str:
        """A part of a page, with the title above it."""
        return (self.heading(title) if title else "") + "".join(self.parts(sheet))

    def heading(self, text: str) -> str:
        """A small heading."""
        return f"<h4>{html.escape(text)}</h4>"

    def table(self, heads: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
        """Cells flush left."""
        return rows_html(heads, rows)

    def items(self, texts: Sequence[str], numbered: bool) -> str:
        """A list, with numbers where the order matters."""
        kind = "ol" if numbered else "ul"
        return f"<{kind}>{''.join(f'<li>{html.escape(text)}</li>' for text in texts)}</{kind}>"

    def paragraph(self, text: str) -> str:
        """Sentences."""
        return f"<p>{html.escape(text)}</p>" if text else ""

    def relations(self, lines: Sequence[Sequence[str]]) -> str:
        """Relations, aligned, as notebooks typeset them."""
        return self.display_mathematics(f"\\begin{{aligned}}\n{aligned_relations(lines)}\n\\end{{aligned}}")

    def display_mathematics(self, mathematics: str) -> str:
        """Mathematics on lines of its own."""
        return f"<p>$$ {html.escape(mathematics)} $$</p>"
