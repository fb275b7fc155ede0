"""A drawing board that the conventional signs draw on as they draw on axes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.colors import to_rgba
from matplotlib.patches import Circle, FancyArrowPatch, Patch, Polygon

from centrode.present.drafting.strokes import CAPITAL, Cover, Drawing, Ring, Stroke, Words

WHITE = to_rgba("white")
ROUND = 48
"""Corners of a circle that covers."""
HEAD = (7.0, 2.2)
"""Length and half width of an arrow's head, in points of the letters."""
OPEN, CLOSED = "hinges", "pitch-circles"
ROLLING = ("cams",)
"""Layers whose open circles are rollers, not hinges."""


class Board:
    """Takes what `signs` adds to axes, and keeps it as strokes on the layer chosen.

    Parameters
    ----------
    scale : float
        Millimetres in a unit of what is drawn.
    """

    def __init__(self, scale: float) -> None:
        self.scale = scale
        self.layer = "links"
        self.drawing = Drawing()

    @contextmanager
    def on(self, layer: str) -> Iterator[None]:
        """Draw on a layer."""
        before, self.layer = self.layer, layer
        try:
            yield
        finally:
            self.layer = before

    def add_patch(self, patch: Patch) -> None:
        """A circle, a polygon or an arrow."""
        level = float(patch.get_zorder())
        if isinstance(patch, Circle):
            self._circle(patch, level)
        elif isinstance(patch, FancyArrowPatch):
            self._arrow(patch, level)
        elif isinstance(patch, Polygon):
            corners = self.scale * np.asarray(patch.get_xy(), dtype=float)
            if _is_drawn(patch.get_edgecolor()):
                self.drawing.strokes.append(Stroke(self.layer, corners, level))
            if tuple(patch.get_facecolor()) == WHITE:
                self.drawing.covers.append(Cover(corners[:-1], level))

    def _circle(self, patch: Circle, level: float) -> None:
        x, y = self.scale * np.asarray(patch.center, dtype=float)
        radius = self.scale * patch.radius
        white = tuple(patch.get_facecolor()) == WHITE
        open_hinge = white and self.layer not in ROLLING
        layer = OPEN if open_hinge else CLOSED if patch.get_linestyle() not in ("-", "solid") else self.layer
        filled = not (white or _is_faint(patch.get_facecolor()))
        if filled or _is_drawn(patch.get_edgecolor()):
            self.drawing.rings.append(Ring(layer, (float(x), float(y)), float(radius), level, filled))
        if white:
            turns = np.linspace(0.0, 2.0 * np.pi, ROUND, endpoint=False)
            corners = np.array([x, y]) + radius * np.stack([np.cos(turns), np.sin(turns)], axis=1)
            self.drawing.covers.append(Cover(corners, level))

    def _arrow(self, patch: FancyArrowPatch, level: float) -> None:
        """A line with a head at its end."""
        outline: Any = patch
        places = self.scale * np.array(outline._path_original.vertices, dtype=np.float64)
        along = places[-1] - places[-2]
        along /= float(np.hypot(*along))
        across = np.array([-along[1], along[0]])
        length, half = (self.letters * points for points in HEAD)
        back, tip = places[-1] - 0.5 * length * along, places[-1] + 0.5 * length * along
        head = [tip, back + half * across, back - half * across, tip]
        self.drawing.strokes += [Stroke(self.layer, places, level), Stroke(self.layer, np.array(head), level)]

    def add_collection(self, collection: LineCollection, autolim: bool = True) -> None:
        """Lines."""
        level = float(collection.get_zorder())
        for segment in collection.get_segments():
            self.drawing.strokes.append(
                Stroke(self.layer, self.scale * np.asarray(segment, dtype=float), level)
            )

    def plot(self, x: Sequence[float], y: Sequence[float], **how: Any) -> None:
        """A line through places."""
        places = self.scale * np.stack([np.asarray(x, dtype=float), np.asarray(y, dtype=float)], axis=1)
        self.drawing.strokes.append(Stroke(self.layer, places, float(how.get("zorder", 2.0))))

    def text(self, x: float, y: float, text: str, *, fontsize: float, **how: Any) -> None:
        """Words; the size of the letters is in points on paper, drawings want the height of their capitals."""
        height = CAPITAL * fontsize * self.letters
        self.drawing.words.append(Words(self.layer, text, (self.scale * x, self.scale * y), height))

    letters: float = 1.0
    """Millimetres in a point of the letters' size."""

    def set_aspect(self, *_ratio: object, **_how: object) -> None:
        """Nothing: a drawing has equal scales."""

    def set_xlim(self, *_limits: object) -> None:
        """Nothing: a drawing is as large as what is on it."""

    def set_ylim(self, *_limits: object) -> None:
        """Nothing: a drawing is as large as what is on it."""


def _is_drawn(colour: Any) -> bool:
    return len(colour) == 4 and colour[3] > 0.0


def _is_faint(colour: Any) -> bool:
    """A filling that only tints."""
    return len(colour) != 4 or colour[3] < 0.5


def on_paper(scene_extent: float, inches: float, scale: float) -> float:
    """Millimetres in a point of a letter's size, where the drawing was meant for so many inches of paper."""
    return scene_extent / (72.0 * inches) * scale
