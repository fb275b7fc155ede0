"""What other rooms say of their results, as blocks: rows and tables of texts, checks, figures."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from centrode.render.document.blocks import CheckBlock, TableBlock
from centrode.render.document.numbers import NOTHING, Numbers, spelled_number
from centrode.render.document.rows import rows_table, told

_NUMBER = re.compile(rf"[-−+±]?[\d.,]+(·10[⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)?( ?%|°)?|[-–−{NOTHING}]?")


def facts(numbers: Numbers, rows: Iterable[tuple[str, str]], caption: str = "") -> TableBlock:
    """Rows of a label and what is told of it."""
    return rows_table(rows, numbers, caption)


def typeset_table(
    numbers: Numbers, header: Sequence[str], rows: Iterable[Sequence[str]], caption: str = ""
) -> TableBlock:
    """A table of another room; columns of numbers only are set flush right, columns of nothing are left out."""
    cells = [[told(cell, numbers) for cell in row] for row in rows]
    kept = [k for k in range(len(header)) if any(row[k] for row in cells)]
    texts = tuple(tuple(row[k] for k in kept) for row in cells)
    return TableBlock(
        tuple(told(header[k], numbers) for k in kept), texts, caption, numeric(texts, len(kept))
    )


def numeric(cells: Sequence[Sequence[str]], columns: int) -> tuple[bool, ...]:
    """Which columns hold numbers only."""
    return tuple(
        any(row[column] for row in cells) and all(_NUMBER.fullmatch(row[column]) for row in cells)
        for column in range(columns)
    )


def difference_check(text: str, off: float, size: float, allowed: float) -> CheckBlock:
    """How something was verified: by which `share` of its size two routes differ, and whether that is rounding.

    A difference that is no number does not hold; of nothing, no share can be told, and only nothing is right.
    """
    share = off / size if size else off
    return CheckBlock(text.format(share=share_text(share)), bool(share <= allowed))


def share_text(share: float) -> str:
    """A small share as a check tells it."""
    return spelled_number(f"{share:.1e}") if share else "0"


# Text with mathematics between dollar signs, taken apart.

PART = re.compile(r"\$((?:[^$\\]|\\.)*)\$|((?:[^$\\]|\\.)+|.)", re.DOTALL)
"""Mathematics, which keeps its backslashes, or text; a dollar sign or backslash that has no partner is text."""
ESCAPED = re.compile(r"\\([\\$])")


@dataclass(frozen=True)
class TextPart:
    """A stretch of text, or of mathematics."""

    text: str
    mathematics: bool = False


def parts_of(marked: str) -> list[TextPart]:
    """The parts of a text in their order; neighbours of one kind are one part."""
    found: list[TextPart] = []
    for formula, plain in PART.findall(marked):
        if formula:
            found.append(TextPart(formula, mathematics=True))
        elif found and not found[-1].mathematics:
            found[-1] = TextPart(found[-1].text + ESCAPED.sub(r"\1", plain))
        else:
            found.append(TextPart(ESCAPED.sub(r"\1", plain)))
    return [part for part in found if part.text]
