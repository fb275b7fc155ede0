"""Drawings to scale in reports: cut from their pages, so that they keep their size and a millimetre stays one."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.figure import Figure
from matplotlib.transforms import Bbox

from centrode.render.document.blocks import Picture
from centrode.render.document.figures import svg_of
from centrode.render.drawing.style import house_style
from centrode.render.figures.document_canvas import MeasuringCanvas
from centrode.render.figures.files import spell_decimals

INCH = 25.4
ROOM = 2.0
"""What is left about a drawing [mm]."""


def drawn_to_scale(figure: Figure, caption: str, right: float, top: float) -> Picture:
    """The drawing on the left of a page without the page's head and column, as a block of its natural size.

    Parameters
    ----------
    figure : a page as `new_page` makes it, its overlay measured in millimetres
    caption : what it is, with its scale
    right, top : where the page's column and its head begin [mm]
    """
    spell_decimals(figure)
    canvas: Any = MeasuringCanvas(figure)
    renderer = canvas.get_renderer()
    kept: list[Any] = []
    with house_style():
        for axes in figure.axes:
            for text in list(axes.texts):
                x, y = (float(value) for value in text.get_position())
                if _is_overlay(axes, figure) and (x >= right or y >= top):
                    text.remove()
            boxes = [_extent(artist, axes, renderer) for artist in axes.get_children()]
            kept += [box for box in boxes if box is not None]
    inches = Bbox.union(kept).transformed(figure.dpi_scale_trans.inverted()) if kept else figure.bbox_inches
    page = np.array([right, top]) / INCH
    low = np.clip(np.array([inches.x0, inches.y0]) - ROOM / INCH, 0.0, page)
    high = np.clip(np.array([inches.x1, inches.y1]) + ROOM / INCH, 0.0, page)
    svg = svg_of(figure, Bbox([low, high]))
    return Picture(svg, caption, float(high[0] - low[0]), to_scale=True)


def _is_overlay(axes: Any, figure: Figure) -> bool:
    """Whether axes are the page's own, in millimetres."""
    return bool(np.isclose(axes.get_xlim()[1], figure.get_figwidth() * INCH))


def _extent(artist: Artist, axes: Any, renderer: Any) -> Bbox | None:
    """Where an artist draws, in pixels; None of what draws nothing, such as the frame of axes that are switched off."""
    frame = (axes.patch, axes.title, *axes.spines.values(), axes.xaxis, axes.yaxis)
    if artist in frame or not artist.get_visible():
        return None
    box = artist.get_window_extent(renderer)
    if not np.isfinite(box.get_points()).all() or (box.width <= 0 and box.height <= 0):
        return None
    return box


def scale_of(figure: Figure) -> float:
    """What a millimetre of the drawing on a page stands for, in the drawing's own units."""
    axes: Any = figure.axes[-1]
    low, high = axes.get_xlim()
    return float((high - low) / (axes.get_position().width * figure.get_figwidth() * INCH))
