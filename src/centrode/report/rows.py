"""Rows of a label and a text, as the commands print them, as tables of a report."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

from centrode.report.blocks import Table, shown
from centrode.report.numbers import respelled

CONDITION = re.compile(r"\b(sin|cos)\(([^()]*\bphi\d+[^()]*)\) = 0")
ANGLE = re.compile(r"\bphi(\d+)")


def told(text: str) -> str:
    """A sentence of results for a cell: numbers in the language's spelling, conditions on angles as mathematics."""
    parts, position = [], 0
    for found in CONDITION.finditer(text):
        inside = ANGLE.sub(r"phi_(\1)", found[2])
        parts += [_spelled(text[position : found.start()]), f"${found[1]} ({inside}) = 0$"]
        position = found.end()
    return "".join([*parts, _spelled(text[position:])])


def _spelled(text: str) -> str:
    return respelled(shown(text))


def rows_table(rows: Iterable[Sequence[str]], head: tuple[str, str], caption: str = "") -> Table:
    """Rows of a label and a text; a row without a label goes on with the one above."""
    return Table(head, tuple((told(label), told(text)) for label, text in rows), caption, (False, False))
