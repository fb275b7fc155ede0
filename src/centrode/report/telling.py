"""What other rooms say of their results, as blocks: rows and tables of texts, checks, figures."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

from centrode.render.document.blocks import Check, Picture, Table
from centrode.render.document.figures import picture
from centrode.render.document.numbers import NOTHING, Numbers, spelled_number
from centrode.render.document.rows import rows_table, told
from centrode.render.document.scaled import INCH, drawn_to_scale

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_OPERATOR = re.compile(r"(?<= )-(?= )")
_NUMBER = re.compile(rf"[-−+±]?[\d.,]+(·10[⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)?( ?%|°)?|[-–−{NOTHING}]?")


def worked(numbers: Numbers, text: str) -> str:
    """A line of sums of another room, in which a hyphen between spaces is a minus."""
    return told(_OPERATOR.sub("−", text), numbers)


def facts(numbers: Numbers, rows: Iterable[tuple[str, str]], caption: str = "") -> Table:
    """Rows of a label and what is told of it."""
    return rows_table(rows, numbers, caption)


def listed(
    numbers: Numbers, header: Sequence[str], rows: Iterable[Sequence[str]], caption: str = ""
) -> Table:
    """A table of another room; columns of numbers only are set flush right, columns of nothing are left out."""
    cells = [[told(cell, numbers) for cell in row] for row in rows]
    kept = [k for k in range(len(header)) if any(row[k] for row in cells)]
    texts = tuple(tuple(row[k] for k in kept) for row in cells)
    return Table(tuple(told(header[k], numbers) for k in kept), texts, caption, numeric(texts, len(kept)))


def numeric(cells: Sequence[Sequence[str]], columns: int) -> tuple[bool, ...]:
    """Which columns hold numbers only."""
    return tuple(
        any(row[column] for row in cells) and all(_NUMBER.fullmatch(row[column]) for row in cells)
        for column in range(columns)
    )


def measured(text: str, off: float, size: float, allowed: float) -> Check:
    """How something was verified: by which `share` of its size two routes differ, and whether that is rounding.

    A difference that is no number does not hold; of nothing, no share can be told, and only nothing is right.
    """
    share = off / size if size else off
    return Check(text.format(share=share_text(share)), bool(share <= allowed))


def share_text(share: float) -> str:
    """A small share as a check tells it."""
    return spelled_number(f"{share:.1e}") if share else "0"


TO_SCALE = ("force-vectors",)
"""Figures whose scales are true on paper; they are pages, of which only what is empty is cut off."""


def pictures(figures: Mapping[str, Figure], captions: Mapping[str, str]) -> list[Picture]:
    """Figures by name as pictures, in the order of their captions; what was not drawn is left out."""
    return [
        _to_scale(figures[name], caption) if name in TO_SCALE else picture(figures[name], caption)
        for name, caption in captions.items()
        if name in figures
    ]


def _to_scale(figure: Figure, caption: str) -> Picture:
    width, height = (float(inches) * INCH for inches in figure.get_size_inches())
    return drawn_to_scale(figure, caption, width, height)
