"""What pages with vectors have in common: where things stand, arrows, symbols, the head and the column."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.patches import FancyArrowPatch

from centrode.locale import _
from centrode.present.displayed_units import plain
from centrode.present.page import Array, Page
from centrode.present.spelled_figures import AS_WRITTEN

if TYPE_CHECKING:
    from centrode.model.mechanism import Mechanism

CORNER, SIZE = np.array([6.0, 6.0]), np.array([128.0, 128.0])
COLUMN, TOP = 138.0, 140.0
LINE = 3.8
"""From line to line of the column at the right [mm]."""
COLUMNS = 52
"""Letters in a line of it."""
MARKS = {"normal": "ⁿ", "tangential": "ᵗ", "coriolis": "ᵏ", "driven": "ʳ", "sliding": "ʳ"}
LETTERS = {"ⁿ": "n", "ᵗ": "t", "ᵏ": "k", "ʳ": "r"}
GREEK = {"ω": r"\omega", "ε": r"\varepsilon", "μ": r"\mu"}
TERM = re.compile(r"(?<!\w)([vapωεμP])([ⁿᵗᵏʳ]?)_([A-Za-z0-9′]+)")


def flat(places: Sequence[complex]) -> Array:
    """Complex numbers as rows of x and y."""
    return np.array([[place.real, place.imag] for place in places])


def arrow(page: Page, start: Array, end: Array, colour: str, dashes: Any = "-", width: float = 1.0) -> None:
    """An arrow on the page [mm], with names kept off it; a short one has a small head."""
    head = min(7.0, 2.5 * float(np.hypot(*(end - start))) + 1.0)
    page.overlay.add_patch(
        FancyArrowPatch(
            (float(start[0]), float(start[1])),
            (float(end[0]), float(end[1])),
            arrowstyle="-|>",
            mutation_scale=head,
            shrinkA=0.0,
            shrinkB=0.0,
            color=colour,
            linewidth=width,
            linestyle=dashes,
            zorder=5,
        )
    )
    page.avoid([(start, end)])


def symbol(letter: str, name: str, kind: str = "relative") -> str:
    """v_BA, a^n_BA as text of a figure."""
    return typeset(f"{letter}{MARKS.get(kind, '')}_{name}")


def typeset(text: str) -> str:
    """The symbols of an equation as mathematical text; names with letters that this does not know stay as they are."""
    return TERM.sub(_typeset, plain(text))


def _typeset(found: re.Match[str]) -> str:
    letter, mark, name = found.groups()
    below = name.replace("′", r"{}^{\prime}")
    above = f"^{{{LETTERS[mark]}}}" if mark else ""
    return rf"${GREEK.get(letter, letter)}{above}_{{{below}}}$"


def write_head(
    page: Page, title: str, mechanism: Mechanism, head: Sequence[str], lines: Sequence[str]
) -> None:
    """Title and mechanism above, at the right what the page is about and how it was drawn."""
    page.write(6.0, TOP, title, size=11.0, va="bottom")
    name = textwrap.shorten(plain(_(mechanism.title)), 60, placeholder=" …")
    page.write(COLUMN, TOP, textwrap.fill(name, 40), size=7.5, va="bottom", label=AS_WRITTEN)
    y = TOP - 6.0
    for text in head:
        page.write(COLUMN, y, text if "$" in text else typeset(text), size=8.0, va="top")
        y -= 1.4 * LINE
    y -= 0.5 * LINE
    wrapped = [
        part for line in lines for part in textwrap.wrap(line, COLUMNS, subsequent_indent="    ") or [""]
    ]
    room = int((y - 4.0) / LINE)
    if len(wrapped) > room:
        wrapped = [*wrapped[: room - 1], "…"]
    for text in wrapped:
        if text:
            page.write(COLUMN, y, typeset(text), size=6.5, va="top")
        y -= LINE
