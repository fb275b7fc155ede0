"""Tables of texts as lines of a terminal; what only lists names loads no more than this."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator, Sequence
from itertools import zip_longest

WIDTH = 100
"""Columns of a paragraph and of a listing."""
GAP = "  "
"""Stands between two columns."""
BREAK = re.compile(r"(?<!=) (?!= )(?!(?<=[0-9] )[^\W\d]\S{0,5}(?!\S))")
"""Where a line may end: at a space, but neither beside "=" nor between a number and its unit."""


def aligned_text(
    rows: Sequence[Sequence[str]],
    header: Sequence[str] = (),
    right: Sequence[int] = (),
    width: int | None = None,
) -> str:
    """Rows as plain text, columns aligned and two spaces apart; the columns numbered in `right` align right.

    Where a row is longer than `width` columns, the widest cells and heads take several lines, broken at spaces alone.
    """
    lines = [list(header), *rows] if header else list(rows)
    widths = [max(width_of(cell) for cell in column) for column in zip(*lines, strict=True)]
    if width is not None:
        widths = _narrow_widths(widths, lines, width)
        lines = [
            line
            for number, row in enumerate(lines)
            for line in _broken_row(row, widths, from_below=bool(header) and number == 0)
        ]
    texts = []
    for line in lines:
        gaps = [" " * (width - width_of(cell)) for cell, width in zip(line, widths, strict=True)]
        cells = [
            gap + cell if number in right else cell + gap
            for number, (cell, gap) in enumerate(zip(line, gaps, strict=True))
        ]
        texts.append(GAP.join(cells).rstrip())
    return "\n".join(texts)


def _narrow_widths(widths: Sequence[int], rows: Sequence[Sequence[str]], width: int) -> list[int]:
    """Widths of columns that a line holds: the widest give way, none below its longest word."""
    narrowed = list(widths)
    least = [max(_longest_word(cell) for cell in column) for column in zip(*rows, strict=True)]
    for _column in range(sum(widths) + len(GAP) * (len(widths) - 1) - width):
        wide = [number for number, own in enumerate(narrowed) if own > least[number]]
        if not wide:
            break
        narrowed[max(wide, key=narrowed.__getitem__)] -= 1
    return narrowed


def _longest_word(cell: str) -> int:
    """Columns of the longest piece that is not broken, with the indentation of the cell."""
    return len(_indentation(cell)) + max(map(width_of, BREAK.split(cell)))


def _indentation(cell: str) -> str:
    return cell[: len(cell) - len(cell.lstrip(" "))]


def _broken_row(row: Sequence[str], widths: Sequence[int], *, from_below: bool) -> Iterator[list[str]]:
    """A row as the lines that its cells take; heads stand right above the first row, so theirs begin from below."""
    cells = [broken_text(cell, width) for cell, width in zip(row, widths, strict=True)]
    if from_below:
        most = max(map(len, cells))
        cells = [[""] * (most - len(cell)) + cell for cell in cells]
    return map(list, zip_longest(*cells, fillvalue=""))


def broken_text(text: str, width: int, further: str = "") -> list[str]:
    """Lines of at most `width` columns if no piece is longer; the further ones as far in, and by `further` more."""
    indent = _indentation(text)
    first, *others = BREAK.split(text[len(indent) :])
    lines = [indent + first]
    for piece in others:
        longer = f"{lines[-1]} {piece}"
        if width_of(longer) <= width:
            lines[-1] = longer
        else:
            lines.append(indent + further + piece)
    return lines


def width_of(text: str) -> int:
    """Columns that a text takes on a terminal: marks over letters take none, East Asian letters two."""
    marks = sum(unicodedata.category(letter) in ("Mn", "Me", "Cf") for letter in text)
    wide = sum(unicodedata.east_asian_width(letter) in ("W", "F") for letter in text)
    return len(text) - marks + wide


def listing(heading: str, items: Sequence[str], width: int = WIDTH) -> str:
    """A heading with items behind it, or indented below it where one line does not hold them; no item is broken."""
    line = ", ".join(items)
    if len(heading) + 2 + len(line) <= width:
        return f"{heading}: {line}"
    lines = [f"{heading}:", ""]
    for number, item in enumerate(items, start=1):
        piece = item if number == len(items) else f"{item},"
        longer = f"{lines[-1]} {piece}" if lines[-1] else f"  {piece}"
        if lines[-1] and len(longer) > width:
            lines.append(f"  {piece}")
        else:
            lines[-1] = longer
    return "\n".join(lines)
