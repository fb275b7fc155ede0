"""What stands around the pictures: title and caption above, scales of vectors and the legend below; in inches."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from centrode.present.animations.arrows import arrow_outlines
from centrode.present.animations.layers import ScaleArrow, View
from centrode.present.shown import plain
from centrode.present.style import INK

Entry = tuple[Artist, str]

LINE = 0.2
"""Height of a line of the legend."""
SCALE_LINE = 0.24
"""Height of a row of scales."""
LETTER = 0.082
"""Mean width of a letter of the legend."""
TITLE_LINE, TITLE_LETTER, CAPTION = 0.22, 0.12, 0.3
TITLE_LINES = 2
ARROW_HEAD = 0.09
"""Length of the heads of vectors."""
LONGEST_ARROW = 0.18
"""Of a scale, as a part of the width: room that is kept before the view is known."""
BETWEEN = 0.35
MOST_ENTRIES = 24
LEGEND = 0.35
"""Most of the height that is legend."""


def title_lines(title: str, wide: float) -> list[str]:
    """The title in lines as wide as the paper, not more than two."""
    return textwrap.wrap(title, max(8, int(wide / TITLE_LETTER)))[:TITLE_LINES]


def write_title(paper: Axes, title: str) -> float:
    """Write the title at the top; returns how much room it takes with the caption."""
    wide, high = paper.get_xlim()[1], paper.get_ylim()[1]
    lines = title_lines(title, wide)
    for number, line in enumerate(lines):
        at = high - 0.1 - TITLE_LINE * number
        paper.text(wide / 2, at, plain(line), ha="center", va="top", fontsize=12, color=INK)
    return 0.12 + TITLE_LINE * len(lines) + CAPTION


def write_caption(paper: Axes, title: str, text: str) -> None:
    """Write the caption of a frame below the title."""
    wide, high = paper.get_xlim()[1], paper.get_ylim()[1]
    at = high - 0.14 - TITLE_LINE * len(title_lines(title, wide))
    paper.text(wide / 2, at, text, ha="center", va="top", fontsize=10, color=INK)


def write_entries(paper: Axes, entries: Sequence[Entry]) -> float:
    """Write the legend at the bottom, in as many columns as fit; returns its height. Too many entries are cut."""
    if not entries:
        return 0.08
    wide, high = paper.get_xlim()[1], paper.get_ylim()[1]
    entries = _cut(entries, MOST_ENTRIES)
    columns = _columns([text for _handle, text in entries], wide - 0.3)
    entries = _cut(entries, max(1, int(LEGEND * high / LINE)) * columns)
    legend = paper.legend(
        [handle for handle, _text in entries], [plain(text) for _handle, text in entries],
        loc="lower center", bbox_to_anchor=(wide / 2, 0.04), bbox_transform=paper.transData,
        ncols=columns, borderaxespad=0.0, handlelength=2.2, columnspacing=1.4, labelspacing=0.3,
    )  # fmt: skip
    legend.set_zorder(9.0)
    return 0.08 + LINE * -(-len(entries) // columns)


def _cut(entries: Sequence[Entry], most: int) -> list[Entry]:
    """The entries, of too many the first and three dots."""
    if len(entries) <= most:
        return list(entries)
    return [*entries[: most - 1], (Line2D([], [], linewidth=0.0), "…")]


def _columns(texts: Sequence[str], room: float) -> int:
    """The most columns, filled one after the other, that are not wider than the room."""
    for columns in range(len(texts), 1, -1):
        parts = np.array_split(np.array([len(text) for text in texts]), columns)
        if sum(0.75 + LETTER * int(part.max()) for part in parts) <= room:
            return columns
    return 1


def rows_of_scales(scales: Sequence[ScaleArrow], wide: float) -> list[list[ScaleArrow]]:
    """Scales side by side, in as many rows as they need."""
    rows: list[list[ScaleArrow]] = []
    left = 0.0
    for one in scales:
        width = LONGEST_ARROW * wide + 0.12 + LETTER * len(one.text) + BETWEEN
        if not rows or left + width > wide:
            rows.append([])
            left = 0.0
        rows[-1].append(one)
        left += width
    return rows


def write_scales(paper: Axes, scales: Sequence[ScaleArrow], view: View, bottom: float) -> None:
    """Draw arrows that tell what the vectors are worth, row below row from `bottom` down."""
    wide = paper.get_xlim()[1]
    for number, row in enumerate(rows_of_scales(scales, wide)):
        level = bottom - 0.11 - SCALE_LINE * number
        lengths = [one.length / view.per_inch for one in row]
        widths = [length + 0.12 + LETTER * len(one.text) for one, length in zip(row, lengths, strict=True)]
        left = (wide - sum(widths) - BETWEEN * (len(widths) - 1)) / 2.0
        for one, length, width in zip(row, lengths, widths, strict=True):
            outline = arrow_outlines(np.array([[left, level]]), np.array([[length, 0.0]]), ARROW_HEAD)[0]
            paper.fill(*outline.T, facecolor=one.colour, edgecolor="none")
            paper.text(left + length + 0.1, level, plain(one.text), va="center", fontsize=9, color=INK)
            left += width + BETWEEN


def height_of_scales(scales: Sequence[ScaleArrow], wide: float) -> float:
    """How much room they need."""
    return SCALE_LINE * len(rows_of_scales(scales, wide))
