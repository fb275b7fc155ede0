"""Frames of an animation: the ground is drawn once, and on it, frame by frame, what moves."""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray
from PIL import Image

from centrode.animation.layers import NOTHING, Layer, ScaleArrow
from centrode.render.drawing.style import INK, darken, house_style, recolour
from centrode.render.drawing.texts import plain
from centrode.scenes.places import View

# The colours of a GIF: 256 for all of its frames, so that none flickers.

COLOURS = 256
EXACT = 64
"""Of these the commonest of all frames are kept as they are: paper stays white."""
HEAVIEST = 16
"""Most that a colour counts for when the others are cut into groups."""
AT_ONCE = 4096
"""Colours whose distances to the palette are held in memory together."""

Packed = NDArray[np.uint32]


class Palette:
    """Counts colours, chooses those to keep, and gives the number of the nearest."""

    def __init__(self) -> None:
        self.parts: list[tuple[Packed, NDArray[np.int64]]] = []
        self.colours: Packed = np.empty(0, dtype=np.uint32)
        self.chosen: NDArray[np.int64] = np.empty((0, 3), dtype=np.int64)
        self.nearest: NDArray[np.uint8] = np.empty(0, dtype=np.uint8)

    def count(self, pixels: Packed) -> None:
        """Take the colours of pixels into account."""
        colours, counts = np.unique(pixels, return_counts=True)
        self.parts.append((colours, counts))

    def choose(self) -> None:
        """Choose the palette: the commonest colours as they are, the others cut into groups at medians."""
        every = np.concatenate([colours for colours, _counts in self.parts])
        self.colours, where = np.unique(every, return_inverse=True)
        counts = np.bincount(where, weights=np.concatenate([counts for _colours, counts in self.parts]))
        order = np.lexsort((self.colours, -counts))
        levels = _levels(self.colours)
        exact, rest = order[:EXACT], order[EXACT:]
        self.chosen = levels[exact]
        if len(rest):
            weights = np.clip(np.sqrt(counts[rest]).astype(int), 1, HEAVIEST)
            sheet = np.repeat(levels[rest], weights, axis=0).astype(np.uint8)
            cut = Image.fromarray(sheet[None]).quantize(COLOURS - EXACT, dither=Image.Dither.NONE)
            found = np.array(cut.getpalette() or [], dtype=np.int64).reshape(-1, 3)[: COLOURS - EXACT]
            self.chosen = np.concatenate([self.chosen, found])
        self.nearest = np.concatenate(
            [self._near(levels[first : first + AT_ONCE]) for first in range(0, len(levels), AT_ONCE)]
        )

    @property
    def table(self) -> list[int]:
        """Red, green and blue of every number."""
        numbers: list[int] = self.chosen.reshape(-1).tolist()
        return numbers

    def numbers(self, pixels: Packed) -> NDArray[np.uint8]:
        """Numbers of the nearest colours."""
        return np.asarray(self.nearest[np.searchsorted(self.colours, pixels)])

    def _near(self, levels: NDArray[np.int64]) -> NDArray[np.uint8]:
        """Numbers of the nearest; squares of whole levels are exact in single precision."""
        own, chosen = levels.astype(np.float32), self.chosen.astype(np.float32)
        apart = (chosen**2).sum(axis=1) - 2.0 * own @ chosen.T  # less what all distances of a colour share
        return np.asarray(np.argmin(apart, axis=1), dtype=np.uint8)


def _levels(colours: Packed) -> NDArray[np.int64]:
    """Red, green and blue (n, 3) of pixels as the canvas packs them."""
    return colours.view(np.uint8).reshape(-1, 4)[:, :3].astype(np.int64)


# Arrows as outlines, so that all vectors of a frame are one thing to draw.

Array = NDArray[np.float64]
SHAFT = 0.16
"""Half width of a shaft, in lengths of the head."""
BARB = 0.42
"""Half width of a head, in its lengths."""
MOST_HEAD = 0.5
"""Most of a short arrow that is head."""


def arrow_outlines(starts: Array, along: Array, head: float) -> Array:
    """Corners (n, 7, 2) of arrows from `starts` (n, 2) along `along` (n, 2); their tips are exactly where those end.

    A short arrow has a smaller head and a thinner shaft.
    """
    length = np.hypot(*along.T)
    unit = along / np.maximum(length, np.finfo(float).tiny)[:, None]
    across = np.stack([-unit[:, 1], unit[:, 0]], axis=1)
    size = np.minimum(head, MOST_HEAD * length)
    neck = length - size
    sides = ((0.0, -SHAFT), (1.0, -SHAFT), (1.0, -BARB), (None, 0.0), (1.0, BARB), (1.0, SHAFT), (0.0, SHAFT))
    corners = [
        starts + (length if share is None else share * neck)[:, None] * unit + (side * size)[:, None] * across
        for share, side in sides
    ]
    return np.stack(corners, axis=1)


# What stands around the pictures: title and caption above, scales of vectors and the legend below; in inches.

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


Pixels = NDArray[np.uint32]
"""One frame (height, width), red, green, blue and 255 in the bytes of a number."""

PAPER = (8.0, 6.0)
"""Inches that pictures have at least, so that texts have the same share of them at any size, small ones excepted."""
LEGIBLE = 64.0
"""Pixels to an inch below which texts are hard to read."""
SMALLEST = (5.0, 3.75)
"""Inches that legible pictures have at least: below that there is no room for the links."""
MARGIN = 0.07
"""Room around what the layers need, as a part of its extent."""


@dataclass(frozen=True)
class Stage:
    """What is shown, and where.

    Attributes
    ----------
    layers : sequence of Layer
        Those drawn first lie below.
    frames : int
    size : (width, height)
        In pixels.
    title : str
    caption : callable
        What is said below the title of a frame.
    dark : bool
        Light lines on a dark ground.
    """

    layers: Sequence[Layer]
    frames: int
    size: tuple[int, int]
    title: str = ""
    caption: Callable[[int], str] = lambda _frame: ""
    dark: bool = False

    def pictures(self) -> Iterator[Pixels]:
        """The ground alone, then every frame."""
        style: AbstractContextManager[None] = house_style()
        with style:
            figure, axes, paper = self._prepare_figure()
            canvas: Any = FigureCanvasAgg(darken(figure) if self.dark else figure)
            canvas.draw()
            ground = canvas.copy_from_bbox(figure.bbox)
            yield _pixels(canvas)
            standing = set(axes.get_children()) | set(paper.get_children())
            for frame in range(self.frames):
                for layer in self.layers:
                    layer.draw(axes, frame)
                write_caption(paper, self.title, self.caption(frame))
                moving = [one for one in (*axes.get_children(), *paper.get_children()) if one not in standing]
                self._lay(canvas, ground, moving)
                yield _pixels(canvas)
                for one in moving:
                    one.remove()

    def _lay(self, canvas: Any, ground: Any, moving: list[Artist]) -> None:
        """Draw what moves over the ground."""
        if self.dark:
            for one in moving:
                recolour(one)
        canvas.restore_region(ground)
        renderer = canvas.get_renderer()
        for one in sorted(moving, key=lambda artist: artist.get_zorder()):
            one.draw(renderer)

    def _prepare_figure(self) -> tuple[Figure, Axes, Axes]:
        """The figure with its ground: axes for the layers, and axes in inches for texts."""
        usual, least = (
            min(self.size[0] / inches[0], self.size[1] / inches[1]) for inches in (PAPER, SMALLEST)
        )
        dpi = max(usual, min(LEGIBLE, least))
        wide, high = self.size[0] / dpi, self.size[1] / dpi
        figure = Figure(figsize=(wide, high), dpi=dpi)
        paper = figure.add_axes((0.0, 0.0, 1.0, 1.0))
        paper.set_xlim(0.0, wide)
        paper.set_ylim(0.0, high)
        paper.set_axis_off()
        paper.patch.set_visible(False)
        scales = [one for layer in self.layers for one in layer.scales()]
        top = high - write_title(paper, self.title)
        bottom = write_entries(paper, [entry for layer in self.layers for entry in layer.entries()])
        bottom += height_of_scales(scales, wide)
        axes = figure.add_axes((0.0, bottom / high, 1.0, (top - bottom) / high))
        axes.set_axis_off()
        axes.set_zorder(-1.0)
        view = self._view(axes, np.array([wide, top - bottom]))
        for layer in self.layers:
            layer.stand(view)
        for layer in self.layers:
            layer.ground(axes)
        write_scales(paper, scales, view, bottom)
        return figure, axes, paper

    def _view(self, axes: Axes, room: Array) -> View:
        """Limits that hold what the layers reach, in equal scales."""
        places = np.concatenate([NOTHING, *(layer.reach() for layer in self.layers)])
        places = places[np.isfinite(places).all(axis=1)]
        low, high = (places.min(axis=0), places.max(axis=0)) if len(places) else (-np.ones(2), np.ones(2))
        if not (high > low).any():
            low, high = low - 0.5, high + 0.5
        around = MARGIN * float(np.max(high - low))
        per_inch = float(np.max((high - low + 2.0 * around) / room))
        middle, half = (low + high) / 2.0, room * per_inch / 2.0
        axes.set_xlim(middle[0] - half[0], middle[0] + half[0])
        axes.set_ylim(middle[1] - half[1], middle[1] + half[1])
        return View(low, high, per_inch)


def _pixels(canvas: Any) -> Pixels:
    buffer = np.asarray(canvas.buffer_rgba())
    return np.ascontiguousarray(buffer).view(np.uint32)[..., 0].copy()
