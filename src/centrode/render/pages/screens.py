"""Drawings to scale on a screen: no wider than its room, with bars that tell their scales at any size."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence

import numpy as np

from centrode.numerics.round_scales import SCALES, round_scale
from centrode.quantities import spelled_unit
from centrode.render.drawing.figure_room import screen_width
from centrode.render.drawing.style import INK, SMALL, THIN
from centrode.render.pages.page import INCH, Array, Page

BAR = 24.0
"""The most that a bar is long [mm]."""
TICK, BESIDE, BETWEEN = 1.6, 1.5, 5.0
"""Height of the ends of a bar, and what is between it and its text, and between one bar and the next [mm]."""
BELOW = 7.0
"""How far bars stand below the lowest of a drawing's lines and names: supports hang from them [mm]."""
EDGE = 1.5
"""From the lower edge of the page to the bars at least [mm]."""
ROUND = (5.0, 2.0, 1.0)


def screen_millimetres() -> float:
    """How wide a drawing may be [mm]: as a page where it is drawn for paper."""
    screen = screen_width()
    return math.inf if screen is None else screen * INCH


def size_on_screen(size: Array, beside: float) -> Array:
    """Sides of a drawing [mm] of a size on paper, where so much stands on its left and its right together [mm]."""
    return np.array([min(float(size[0]), screen_millimetres() - beside), size[1]])


def scale_on_screen(scale: float, fits: Callable[[float], bool], series: Sequence[float] = SCALES) -> float:
    """The scale of paper, or the finest coarser one at which a drawing fits in the room of a screen."""
    if screen_width() is None:
        return scale
    while not fits(scale):
        scale = round_scale(1.01 * scale, series=series)
    return scale


def write_scale_bars(page: Page, left: float, scales: Iterable[tuple[float, str]], when: str = "") -> None:
    """Below a drawing on a screen, lengths that stand for a round number of units: nothing on paper.

    Parameters
    ----------
    left : where the first begins [mm]
    scales : what a millimetre stands for, with its unit
    when : the instant, where nothing about the drawing says it
    """
    if screen_width() is None:
        return
    low = [float(np.min(box)) for box in _heights(page)]
    y = max(EDGE, min(low, default=BELOW) - BELOW)
    for scale, unit in scales:
        size = round_size(BAR * scale)
        end = left + size / scale
        path = np.array([(left, y + TICK), (left, y), (end, y), (end, y + TICK)])
        page.overlay.plot(*path.T, color=INK, linewidth=THIN, zorder=8, solid_joinstyle="miter")
        text = page.write(end + BESIDE, y, f"{size:g} {spelled_unit(unit)}", size=SMALL, va="bottom")
        left = float(page.box_of(text)[1, 0]) + BETWEEN
    page.write(left, y, when, size=SMALL, va="bottom")


def round_size(most: float) -> float:
    """The greatest of 1, 2 and 5 times a power of ten that is no greater."""
    power = 10.0 ** math.floor(math.log10(most))
    return next(float(f"{step * power:.3g}") for step in ROUND if step * power <= most * (1 + 1e-9))


def _heights(page: Page) -> Iterable[Array]:
    """Heights of what is known to stand on a page [mm]."""
    yield from (np.array([start[1], end[1]]) for start, end in page.segments)
    yield from (box[:, 1] for box in page.boxes)
