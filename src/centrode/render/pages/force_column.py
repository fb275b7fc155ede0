"""A sheet of forces: its margins, its title, and the column of text at the right."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from typing import TYPE_CHECKING

from centrode.locale import _
from centrode.render.drawing.style import LEAST_POINTS, NAME, SMALL, TITLE
from centrode.render.drawing.texts import plain
from centrode.render.figures.files import AS_WRITTEN
from centrode.render.pages.page import Page

if TYPE_CHECKING:
    from centrode.model.mechanism import Mechanism

LEFT, GUTTER, FOOT, TOP = 7.0, 4.0, 7.0, 14.0
"""Margins of a sheet, room between its columns, below and above [mm]."""
LINE = 3.7
"""From line to line [mm]."""
LETTER = 1.5
"""Width of a letter [mm]."""


def write_title(page: Page, column: float, title: str, mechanism: Mechanism) -> None:
    """What the sheet shows, and of which mechanism."""
    _wide, high = page.size
    page.write(LEFT, high - TOP + 3.0, title, size=TITLE, va="bottom")
    name = textwrap.shorten(plain(_(mechanism.title)), 50, placeholder=" …")
    page.write(column, high - TOP + 3.0, name, size=NAME, va="bottom", label=AS_WRITTEN)


def write_column(page: Page, column: float, title: str, heads: Sequence[str], lines: Sequence[str]) -> None:
    """What the sheet is about, then lines; what does not fit is left out with dots."""
    wide, high = page.size
    letters = int((wide - column - 3.0) / LETTER)
    y = high - TOP - 1.0
    for text in textwrap.wrap(title, int(0.8 * letters)):
        page.write(column, y, plain(text), size=SMALL, va="top", weight="bold")
        y -= 1.1 * LINE
    for text in heads:
        page.write(column, y - 0.5, text, size=NAME, va="top")
        y -= 1.35 * LINE
    y -= 0.6 * LINE
    page.write_lines(column, y, lines, letters=letters, step=LINE, size=LEAST_POINTS, indent=3)
