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
RING, SOLID, THIN = 0.35, 1.6, 0.5  # cost of each ring further out, of a line under a text, of a thin one
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
    axes.apply_aspect()
    pixel = figure.dpi / 72.0
    lines = np.array([[axes.transData.transform(end) for end in segment] for segment in (*solid, *thin)])
    lines = lines.reshape(-1, 2, 2)
    weights = np.repeat([SOLID, THIN], [len(solid), len(thin)])
    anchors = [np.asarray(axes.transData.transform(tag.place)) for tag in tags]
    room = axes.get_window_extent()
    taken: list[Array] = []
    for number, tag in enumerate(tags):
        extent = _extent(figure, tag.text, size)
        signs = [_square(anchor, reach * pixel) for k, anchor in enumerate(anchors) if k != number]
        others = np.array([*taken, *signs]).reshape(-1, 4)
        box = _best(
            _candidates(anchors[number], extent, reach * pixel, pixel), others, (lines, weights), room, pixel
        )
        taken.append(box)
        _write(axes, tag, box, anchors[number], size)


def _extent(figure: Figure, text: str, size: float) -> Array:
    """Width and height of a text [pixel]."""
    written = figure.text(0.5, 0.5, text, fontsize=size, linespacing=1.05)
    canvas: Any = FigureCanvasAgg(figure)
    box = written.get_window_extent(canvas.get_renderer())
    written.remove()
    return np.array([float(box.width), float(box.height)])


def _square(anchor: Array, radius: float) -> Array:
    return np.concatenate([anchor - radius, anchor + radius])


def _candidates(anchor: Array, extent: Array, reach: float, pixel: float) -> Array:
    """Boxes (rings * sides, 4) about a place, the nearest ring first: lower left and upper right corners."""
    half = 0.5 * extent
    turns = np.pi / 4 + 2 * np.pi * np.arange(SIDES) / SIDES
    ways = np.stack([np.cos(turns), np.sin(turns)], axis=1)
    # the box touches a circle about the place from outside, whichever side it stands on
    sides = np.min(half / np.maximum(np.abs(ways), 1e-9), axis=1)
    away = reach + GAP * pixel + 2.0 * STEP * half[1] * np.arange(RINGS)
    centres = anchor + ways * (away[:, None, None] + sides[:, None])
    centres = centres.reshape(-1, 2)
    return np.concatenate([centres - half, centres + half], axis=1)


def _best(boxes: Array, others: Array, lines: tuple[Array, Array], room: Bbox, pixel: float) -> Array:
    """The box of the least cost: free of all others, near its place, on few lines."""
    padded = boxes + GAP * pixel * np.array([-1.0, -1.0, 1.0, 1.0])
    cost = RING * np.repeat(np.arange(RINGS), SIDES) + _weight_below(padded, *lines)
    low, high = padded[:, None, :2], padded[:, None, 2:]
    apart = np.asarray(((low >= others[:, 2:]) | (high <= others[:, :2])).any(axis=2))
    covers = ~apart.all(axis=1)
    outside = (boxes[:, :2] < room.p0).any(axis=1) | (boxes[:, 2:] > room.p1).any(axis=1)
    return np.asarray(boxes[int(np.argmin(np.round(cost + 1000.0 * covers + 300.0 * outside, 6)))])


def _weight_below(boxes: Array, lines: Array, weights: Array) -> Array:
    """Weights of the segments that pass through each box (slab method)."""
    start, along = lines[:, 0], lines[:, 1] - lines[:, 0]
    along = np.where(np.abs(along) < 1e-12, 1e-12, along)
    enter: Array = np.full((len(boxes), len(lines)), -np.inf)
    leave: Array = np.full((len(boxes), len(lines)), np.inf)
    for axis in (0, 1):
        low, high = ((boxes[:, None, axis + side] - start[:, axis]) / along[:, axis] for side in (0, 2))
        enter, leave = np.maximum(enter, np.minimum(low, high)), np.minimum(leave, np.maximum(low, high))
    return np.asarray(((enter < leave) & (leave > 0.0) & (enter < 1.0)) @ weights)


def _write(axes: Axes, tag: Tag, box: Array, anchor: Array, size: float) -> None:
    """A text in its box, with a thin line to its place where that is far."""
    place = axes.transData.inverted().transform(0.5 * (box[:2] + box[2:]))
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
    nearest = np.clip(anchor, box[:2], box[2:])
    if np.hypot(*(nearest - anchor)) > LEADER * size * axes.figure.dpi / 72.0:
        ends = axes.transData.inverted().transform([anchor, nearest])
        axes.plot(ends[:, 0], ends[:, 1], color=MUTED, linewidth=0.5, zorder=8.5)
