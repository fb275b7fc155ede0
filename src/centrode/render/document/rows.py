"""Rows of a label and a text, as the commands print them, as tables of a report."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

from centrode.equations.symbols import Letter
from centrode.locale import _
from centrode.render.document.blocks import TableBlock, shown
from centrode.render.document.numbers import Numbers, respell
from centrode.render.document.typst import TypstSpelling, decimal

CONDITION = re.compile(r"\b(sin|cos)\(([^()]*\bphi\d+[^()]*)\) = 0")
NUMBER = re.compile(r"\d+(?:\.\d+)?(?:e[+-]\d+)?")
POWER = re.compile(r"(?<![\w.,])(\d\.\d+)(?=e[+-]\d+(?![\w.]))")
LONG = re.compile(r"(?<![\w.,])\d+\.\d+(?![\w.,]*\w)")
DEGREES = re.compile(r"(?<=\d) deg\b(/?)|(?<=, )deg\b")

SCALE = re.compile(r"μ_([lva])\b")
PAIR = re.compile(r"\((-?\d[\w.+-]*), (-?\d[\w.+-]*)\)")


def told(text: str, numbers: Numbers) -> str:
    """A sentence of results for a cell: digits and decimal mark of the report, conditions on angles as mathematics."""
    parts, position = [], 0
    for found in CONDITION.finditer(text):
        inside = " ".join(map(_term, found[2].split(" ")))
        parts += [_spell(text[position : found.start()], numbers), f"${found[1]} ({inside}) = 0$"]
        position = found.end()
    spelled = "".join([*parts, _spell(text[position:], numbers)])
    return SCALE.sub(r"$mu_\1$", spelled)


def _term(term: str) -> str:
    """A sign, a letter or a number of a sum of angles, as mathematics."""
    if term[:1] in ("+", "-"):
        return term[0] + (_term(term[1:]) if term[1:] else "")
    return decimal(term) if NUMBER.fullmatch(term) else TypstSpelling().letter(Letter(0, term))


def sentence(text: str, numbers: Numbers) -> str:
    """A clause of results as a sentence of its own."""
    text = told(text, numbers)
    return f"{text[:1].upper()}{text[1:]}."


def _spell(text: str, numbers: Numbers) -> str:
    apart = PAIR.sub(r"(\1; \2)", text)  # a comma would be taken for a decimal mark
    mantissas = POWER.sub(lambda found: _round(found[0], numbers.digits), apart)
    short = LONG.sub(lambda found: _round(found[0], numbers.digits), mantissas)
    return respell(shown(degrees(short)))


def degrees(text: str) -> str:
    """A text with "30 deg" and "30 deg/s" as "30°" and "30 °/s"."""
    return DEGREES.sub(lambda found: f" °{found[1]}" if found[1] else "°", text)


def _round(text: str, digits: int) -> str:
    """A decimal with at most so many digits; its whole part stays."""
    whole = len(text.partition(".")[0])
    if len(text.replace(".", "").lstrip("0")) <= digits:
        return text
    if whole >= digits:
        return f"{float(text):.0f}"
    value = f"{float(text):.{digits}g}"
    return text if "e" in value else value


def rows_table(
    rows: Iterable[Sequence[str]], numbers: Numbers, caption: str = "", head: tuple[str, str] | None = None
) -> TableBlock:
    """Rows of a label and a text; a row without a label goes on with the one above."""
    cells = tuple((told(label, numbers), told(text, numbers)) for label, text in rows)
    return TableBlock(head or (_("what"), _("value")), cells, caption, (False, False))


def small(value: float) -> str:
    """A difference in two figures; nothing as nothing."""
    return respell(f"{value:.1e}") if value else "0"
