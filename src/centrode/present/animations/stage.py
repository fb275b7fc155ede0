"""Frames of an animation: the ground is drawn once, and on it, frame by frame, what moves."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray

from centrode.present.animations.layers import NOTHING, Array, Layer, View
from centrode.present.animations.margins import (
    height_of_scales,
    write_caption,
    write_entries,
    write_scales,
    write_title,
)
from centrode.present.dark import darkened, recolour
from centrode.present.style import house_style

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
            figure, axes, paper = self._prepared()
            canvas: Any = FigureCanvasAgg(darkened(figure) if self.dark else figure)
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

    def _prepared(self) -> tuple[Figure, Axes, Axes]:
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
