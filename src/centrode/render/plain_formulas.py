"""Formulas in plain text: relations in lines of a terminal, matrices between bars, lists of symbols."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import groupby

from centrode.render.plain_table import width_of

WIDTH = 110
"""Columns beyond which a relation is broken before its equality signs."""


def relation_lines(parts: Iterable[str]) -> list[str]:
    """A relation on one line, or, where it is too long, with a line for each part."""
    first, *others = distinct(parts)
    line = " = ".join((first, *others))
    if width_of(line) <= WIDTH:
        return [line]
    return [
        piece
        for number, text in enumerate(others)
        for piece in _broken(f"{'' if number else first} = {text}".lstrip(), number)
    ]


def distinct(parts: Iterable[str]) -> list[str]:
    """Parts of a relation, of more than two without those that are spelled as the one before them."""
    every = list(parts)
    return every if len(every) < 3 else [part for part, _same in groupby(every)]


def _broken(line: str, number: int) -> list[str]:
    """A long line in pieces, each but the first beginning with a sign; brackets inside of brackets stay whole."""
    indent = "  " if number else ""
    pieces = [indent]
    for word in (part for term in split_at_signs(line) for part in _rows(term)):
        if width_of(pieces[-1]) + width_of(word) > WIDTH and pieces[-1].strip():
            pieces.append("      ")
        pieces[-1] += word
    return [piece.rstrip() for piece in pieces]


def _rows(word: str) -> list[str]:
    """A word that no line holds, cut behind the rows of its determinant."""
    if width_of(word) <= WIDTH:
        return [word]
    *rows, last = word.split("; ")
    return [*(f"{row}; " for row in rows), last]


def split_at_signs(line: str) -> list[str]:
    """A line in words, cut before plus and minus signs that are in no more than one bracket, and in no angle."""
    words, depth, angles = [""], 0, 0
    for i, letter in enumerate(line):
        depth += (letter == "(") - (letter == ")")
        if letter == "(" and not angles and line[i - 1 : i] not in ("", " ", "(", "{", "-", "/"):
            angles = depth  # the bracket of a sine or cosine
        angles = angles if depth >= angles else 0
        if (
            letter in "+-"
            and depth <= 1
            and not angles
            and line[i - 1 : i] == " "
            and line[i + 1 : i + 2] == " "
        ):
            words.append("")
        words[-1] += letter
    return words


def system_lines(matrix: Sequence[Sequence[str]], unknowns: Sequence[str], right: Sequence[str]) -> list[str]:
    """A linear system with bars for brackets; equation by equation where no line holds the matrix."""
    widths = [max(width_of(row[i]) for row in matrix) for i in range(len(unknowns))]
    names = max(map(width_of, unknowns))
    values = max(map(width_of, right))
    middle = len(unknowns) // 2
    if sum(widths) + names + values + 3 * len(widths) + 18 > WIDTH:
        return _equations(matrix, unknowns, right)
    lines = []
    for i, row in enumerate(matrix):
        entries = "   ".join(_pad(entry, width) for entry, width in zip(row, widths, strict=True))
        unknown, value = _pad(unknowns[i], names), _pad(right[i], values)
        lines.append(f"| {entries} |   | {unknown} |   {'=' if i == middle else ' '}   | {value} |")
    return lines


def _equations(matrix: Sequence[Sequence[str]], unknowns: Sequence[str], right: Sequence[str]) -> list[str]:
    """The equations one by one, of a matrix that no line holds: entries that are sums in brackets."""
    lines = []
    for row, value in zip(matrix, right, strict=True):
        text = ""
        for entry, unknown in zip(row, unknowns, strict=True):
            if entry == "0":
                continue
            several = not _is_product(entry)
            minus = entry.startswith("-") and not several
            whole = entry.removeprefix("-") if minus else entry
            size = f"({whole})" if several else "" if whole == "1" else whole
            sign = ("- " if minus else "+ ") if text else ("-" if minus else "")
            text += (" " if text else "") + sign + (f"{size} {unknown}" if size else unknown)
        lines += relation_lines((text or "0", value))
    return lines


def _is_product(entry: str) -> bool:
    """Whether every sum of an entry stands in brackets."""
    depth = 0
    for i, letter in enumerate(entry):
        depth += (letter == "(") - (letter == ")")
        if not depth and entry[i - 1 : i + 2] in (" + ", " - "):
            return False
    return True


def symbol_lines(rows: Sequence[tuple[str, str, str]]) -> list[str]:
    """Symbols, their values and what they stand for, aligned."""
    names = max((width_of(name) for name, _value, _words in rows), default=0)
    values = max((width_of(value) for _name, value, _words in rows), default=0)
    return [f"{_pad(name, names)} = {_pad(value, values)}   {words}" for name, value, words in rows]


def _pad(text: str, width: int) -> str:
    return text + " " * (width - width_of(text))
