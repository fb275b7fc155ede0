"""Tables of texts as lines of a terminal; what only lists names loads no more than this."""

from __future__ import annotations

import unicodedata
from collections.abc import Sequence

WIDTH = 100
"""Columns of a paragraph and of a listing."""


def aligned_text(rows: Sequence[Sequence[str]], header: Sequence[str] = (), right: Sequence[int] = ()) -> str:
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
