"""The equations of a mechanism as plain text, for the terminal and for .txt files."""

from __future__ import annotations

import unicodedata
from collections.abc import Sequence
from typing import TYPE_CHECKING

from centrode.equations.spelling import FormulaSpelling
from centrode.locale import _
from centrode.present.equations.page import Entry, PageSystem, Relation, Symbols, sections

if TYPE_CHECKING:
    from centrode.equations.derivation import Equations

WIDTH = 110
"""Columns beyond which a relation is broken before its equality signs."""


def equations_text(equations: Equations, points: Sequence[str] | None = None) -> str:
    """The equations as text; `points` are those whose velocities are told, those on guides of the frame if left out."""
    parts = [_(equations.mechanism.title)] if equations.mechanism.title else []
    for section in sections(equations, FormulaSpelling(), equations.sliding if points is None else points):
        lines = [line for entry in section.entries for line in _lines(entry)]
        parts.append("\n".join([section.heading, *(f"  {line}".rstrip() for line in lines)]))
    return "\n\n".join(parts) + "\n"


def equations_rows(equations: Equations, points: Sequence[str] | None = None) -> list[tuple[str, str, str]]:
    """Heading, left side and right side of every relation, for tables and documents."""
    found = []
    for section in sections(equations, FormulaSpelling(), equations.sliding if points is None else points):
        for entry in section.entries:
            if isinstance(entry, Relation):
                found.append((section.heading, entry.parts[0], " = ".join(entry.parts[1:])))
            elif isinstance(entry, Symbols):
                found += [(section.heading, name, f"{value}, {words}") for name, value, words in entry.rows]
    return found


def _lines(entry: Entry) -> list[str]:
    if isinstance(entry, Relation):
        return _relation(entry)
    if isinstance(entry, PageSystem):
        return _system(entry)
    if isinstance(entry, Symbols):
        return _table(entry.rows)
    return [entry.text]


def _relation(relation: Relation) -> list[str]:
    line = " = ".join(relation.parts)
    if _columns(line) <= WIDTH:
        return [line]
    first, *others = relation.parts
    return [
        part
        for i, text in enumerate(others)
        for part in _broken(f"{'' if i else first} = {text}".lstrip(), i)
    ]


def _broken(line: str, number: int) -> list[str]:
    """A long line in pieces, each but the first beginning with a sign; brackets inside of brackets stay whole."""
    indent = "  " if number else ""
    pieces = [indent]
    for word in split_at_signs(line):
        if _columns(pieces[-1]) + _columns(word) > WIDTH and pieces[-1].strip():
            pieces.append("      ")
        pieces[-1] += word
    return [piece.rstrip() for piece in pieces]


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


def _system(system: PageSystem) -> list[str]:
    widths = [max(_columns(row[i]) for row in system.matrix) for i in range(len(system.unknowns))]
    names = max(map(_columns, system.unknowns))
    right = max(map(_columns, system.right))
    middle = len(system.unknowns) // 2
    if sum(widths) + names + right + 3 * len(widths) + 18 > WIDTH:
        return [*_rows(system), ""]
    lines = []
    for i, row in enumerate(system.matrix):
        entries = "   ".join(_pad(entry, width) for entry, width in zip(row, widths, strict=True))
        unknown, value = _pad(system.unknowns[i], names), _pad(system.right[i], right)
        lines.append(f"| {entries} |   | {unknown} |   {'=' if i == middle else ' '}   | {value} |")
    return [*lines, ""]


def _rows(system: PageSystem) -> list[str]:
    """The equations one by one, of a matrix that no line holds: entries that are sums in brackets."""
    lines = []
    for row, right in zip(system.matrix, system.right, strict=True):
        text = ""
        for entry, unknown in zip(row, system.unknowns, strict=True):
            if entry == "0":
                continue
            several = not _is_product(entry)
            minus = entry.startswith("-") and not several
            whole = entry.removeprefix("-") if minus else entry
            size = f"({whole})" if several else "" if whole == "1" else whole
            sign = ("- " if minus else "+ ") if text else ("-" if minus else "")
            text += (" " if text else "") + sign + (f"{size} {unknown}" if size else unknown)
        lines += _relation(Relation((text or "0", right)))
    return lines


def _is_product(entry: str) -> bool:
    """Whether every sum of an entry stands in brackets."""
    depth = 0
    for i, letter in enumerate(entry):
        depth += (letter == "(") - (letter == ")")
        if not depth and entry[i - 1 : i + 2] in (" + ", " - "):
            return False
    return True


def _table(rows: Sequence[tuple[str, str, str]]) -> list[str]:
    names = max((_columns(name) for name, _value, _words in rows), default=0)
    values = max((_columns(value) for _name, value, _words in rows), default=0)
    return [f"{_pad(name, names)} = {_pad(value, values)}   {words}" for name, value, words in rows]


def _pad(text: str, width: int) -> str:
    return text + " " * (width - _columns(text))


def _columns(text: str) -> int:
    return sum(unicodedata.category(letter) not in ("Mn", "Me", "Cf") for letter in text)
