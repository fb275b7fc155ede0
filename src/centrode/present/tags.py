"""Names beside places, placed by the boxes of their texts: none covers another, nor a place that has one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.transforms import Bbox

from centrode.present.scene import Array
from centrode.present.style import INK, MUTED

SIDES = 24
STEP = 0.45  # between the rings on which a text is tried, in its height
RINGS = 26
GAP = 2.0  # between texts [pixels at 72 dpi]
SOLID, THIN = 1.6, 0.5  # cost of a line under a text, in rings
LEADER = 1.5  # a text farther than so many of its heights gets a thin line to its place


@dataclass(frozen=True)
class Tag:
    """A text that belongs to a place."""

    place: Array
    text: str


def write_tags(
    axes: Axes,
    tags: Sequence[Tag],
    solid: Sequence[tuple[Array, Array]],
    thin: Sequence[tuple[Array, Array]],
    size: float,
    reach: float,
) -> None:
    """Write texts beside their places, in points of `size`, clear of each other and where possible of lines.

    Solid lines are avoided more than thin ones. `reach` is the radius of the sign at a place [pt]. The axes have
    to stand where they will be drawn.
    """
    figure = axes.figure
    assert isinstance(figure, Figure)
    figure.draw_without_rendering()
    pixel = figure.dpi / 72.0
    lines = np.array([[axes.transData.transform(end) for end in segment] for segment in (*solid, *thin)])
    lines = lines.reshape(-1, 2, 2)
    weights = np.repeat([SOLID, THIN], [len(solid), len(thin)])
    anchors = [np.asarray(axes.transData.transform(tag.place)) for tag in tags]
    room = axes.get_window_extent()
    taken: list[Bbox] = []
    for number, tag in enumerate(tags):
        width, height = _extent(figure, tag.text, size)
        signs = [_around(anchor, reach * pixel) for k, anchor in enumerate(anchors) if k != number]
        box = _best(
            anchors[number], (width, height), reach * pixel, [*taken, *signs], (lines, weights), room, pixel
        )
        taken.append(box)
        centre = 0.5 * (box.p0 + box.p1)
        _write(axes, tag, centre, box, anchors[number], size, height)


def _extent(figure: Figure, text: str, size: float) -> tuple[float, float]:
    """Width and height of a text [pixel]."""
    written = figure.text(0.5, 0.5, text, fontsize=size, linespacing=1.05)
    canvas: Any = FigureCanvasAgg(figure)
    box = written.get_window_extent(canvas.get_renderer())
    written.remove()
    return float(box.width), float(box.height)


def _around(anchor: Array, radius: float) -> Bbox:
    return Bbox([anchor - radius, anchor + radius])


def _best(
    anchor: Array,
    extent: tuple[float, float],
    reach: float,
    taken: Sequence[Bbox],
    lines: tuple[Array, Array],
    room: Bbox,
    pixel: float,
) -> Bbox:
    """The box of the least cost: free of all others, near its place, on few lines."""
    half = 0.5 * np.array(extent)
    turns = np.pi / 4 + 2 * np.pi * np.arange(SIDES) / SIDES
    ways = np.stack([np.cos(turns), np.sin(turns)], axis=1)
    # the box touches a circle about the place from outside, whichever side it stands on
    sides = np.minimum(
        half[0] / np.maximum(np.abs(ways[:, 0]), 1e-9), half[1] / np.maximum(np.abs(ways[:, 1]), 1e-9)
    )
    best, least = None, np.inf
    for ring in range(RINGS):
        away = reach + GAP * pixel + 2.0 * STEP * half[1] * ring
        for way, side in zip(ways, sides, strict=True):
            centre = anchor + way * (away + side)
            box = Bbox([centre - half, centre + half])
            padded = Bbox([box.p0 - GAP * pixel, box.p1 + GAP * pixel])
            cost = 0.35 * ring + _lines_through(padded, *lines)
            if any(padded.overlaps(other) for other in taken):
                cost += 1000.0
            if box.x0 < room.x0 or box.x1 > room.x1 or box.y0 < room.y0 or box.y1 > room.y1:
                cost += 300.0
            if cost < least - 1e-9:
                best, least = box, cost
        if least <= 0.35 * (ring + 1):
            break
    assert best is not None
    return best


def _lines_through(box: Bbox, lines: Array, weights: Array) -> float:
    """Weights of the segments that pass through a box (slab method)."""
    if not len(lines):
        return 0.0
    start, along = lines[:, 0], lines[:, 1] - lines[:, 0]
    along = np.where(np.abs(along) < 1e-12, 1e-12, along)
    low, high = (box.p0 - start) / along, (box.p1 - start) / along
    enter = np.minimum(low, high).max(axis=1)
    leave = np.maximum(low, high).min(axis=1)
    return float(np.sum(weights[(enter < leave) & (leave > 0.0) & (enter < 1.0)]))


def _write(axes: Axes, tag: Tag, centre: Array, box: Bbox, anchor: Array, size: float, height: float) -> None:
    place = axes.transData.inverted().transform(centre)
    axes.text(
        place[0],
        place[1],
        tag.text,
        fontsize=size,
        color=INK,
        ha="center",
        va="center",
        linespacing=1.05,
        zorder=9,
        gid="tag",
    )
    nearest = np.clip(anchor, box.p0, box.p1)
    if np.hypot(*(nearest - anchor)) > LEADER * height:
        ends = axes.transData.inverted().transform([anchor, nearest])
        axes.plot(ends[:, 0], ends[:, 1], color=MUTED, linewidth=0.5, zorder=8.5)
