"""Drawings to scale, cut from their pages: in reports they keep their size, so that a millimetre stays one."""

from __future__ import annotations

from typing import Any, TypeAlias, assert_never

import numpy as np
from matplotlib.artist import Artist
from matplotlib.figure import Figure
from matplotlib.transforms import Bbox

from centrode.render.document.blocks import Picture
from centrode.render.document.figures import svg_of
from centrode.render.drawing.figure_room import screen_width
from centrode.render.drawing.looks import either_look, screen_figure
from centrode.render.drawing.style import house_style
from centrode.render.figures.document_canvas import MeasuringCanvas
from centrode.render.figures.files import spell_decimals
from centrode.render.pages.force_polygons import drawing_end
from centrode.render.pages.instants import drawing_end as instant_end
from centrode.render.pages.positions import drawing_end as positions_end
from centrode.render.pages.several_instants import drawing_end as instants_end
from centrode.sheets.force_pages import GroupPage, LeverPage
from centrode.sheets.pages import InstantPage, InstantsPage, PositionsPage, VectorDiagramPage
from centrode.sheets.pictures import Picture as AnyPicture
from centrode.sheets.plots import VectorPage

Pages: TypeAlias = (
    GroupPage | LeverPage | PositionsPage | InstantPage | InstantsPage | VectorDiagramPage | VectorPage
)
INCH = 25.4
ROOM = 2.0
"""What is left about a drawing [mm]."""


def page_end(page: Pages, figure: Figure) -> tuple[float, float]:
    """Where the drawing of a page ends at its column of text, and at its head [mm]."""
    match page:
        case GroupPage() | LeverPage():
            return drawing_end(page, figure)
        case InstantsPage():
            return instants_end()
        case PositionsPage():
            return positions_end()
        case InstantPage() | VectorDiagramPage():
            return instant_end()
        case VectorPage() if screen_width() is not None:
            return instant_end()
        case VectorPage():  # only what is empty is cut off
            return figure.get_figwidth() * INCH, figure.get_figheight() * INCH
        case _:
            assert_never(page)


def screen_svg(figure: Figure, picture: AnyPicture) -> str:
    """A figure as SVG for a light or a dark screen, where its title stands beside it: of a page its drawing alone."""
    if isinstance(picture, Pages):
        drawn = drawn_to_scale(figure, "", *page_end(picture, figure)).svg
    else:
        figure.suptitle("").set_in_layout(False)
        spell_decimals(figure)
        drawn = svg_of(figure)
    return screen_figure(drawn.decode(), either_look)


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
