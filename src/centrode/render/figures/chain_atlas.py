"""Sketches of kinematic chains and Assur groups side by side as a figure of matplotlib, in the house style."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure

from centrode.render.drawing import signs
from centrode.render.drawing.figure_room import count_across, figure_width
from centrode.render.drawing.style import INK, LINK, NAME, THIN
from centrode.render.figures.curves import write_title
from centrode.render.spelling import FigureSpelling, PrintSpelling
from centrode.sheets.chain_atlas import AtlasCell, ChainAtlas

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from centrode.model.settings import Display

COLUMNS, SIDE, BELOW, HEAD = 4, 1.35, 0.3, 0.55
"""Sketches beside each other; side of the room of one, room of the name below it and of the title [inch]."""
SIGN = 0.1
"""Radius of a joint [length of a side]."""
BODY = "#DCE6EE"


def atlas_figure(atlas: ChainAtlas, display: Display) -> Figure:
    """Sketches in rows below the title, each with its name."""
    most = count_across(COLUMNS)
    columns = min(most, len(atlas.cells))
    rows = math.ceil(len(atlas.cells) / columns)
    high = rows * (SIDE + BELOW) + HEAD
    figure = Figure(figsize=(figure_width(), high))
    wide = figure_width() / most
    left = (figure_width() - columns * wide) / 2.0
    reach = SIGN + 0.52 * max(float(np.ptp(cell.places, axis=0).max()) for cell in atlas.cells)
    words = PrintSpelling(display)
    for number, cell in enumerate(atlas.cells):
        row, column = divmod(number, columns)
        x = left + column * wide + (wide - SIDE) / 2.0
        y = high - HEAD - row * (SIDE + BELOW) - SIDE
        axes = figure.add_axes((x / figure_width(), y / high, SIDE / figure_width(), SIDE / high))
        _draw_cell(axes, cell, reach)
        figure.text(
            (x + SIDE / 2.0) / figure_width(),
            (y - 0.06) / high,
            words.text(cell.name),
            size=NAME,
            ha="center",
            va="top",
        )
    write_title(figure, FigureSpelling(display).text(atlas.title), words.text(atlas.key))
    return figure


def _draw_cell(axes: Axes, cell: AtlasCell, reach: float) -> None:
    """Links as bars and polygons, hinges on them, outer joints filled."""
    axes.set_axis_off()
    axes.set_aspect("equal")
    middle = (cell.places.min(axis=0) + cell.places.max(axis=0)) / 2.0
    axes.set_xlim(middle[0] - reach, middle[0] + reach)
    axes.set_ylim(middle[1] - reach, middle[1] + reach)
    for outline in cell.outlines:
        corners = cell.places[list(outline)]
        if len(outline) > 2:
            axes.fill(
                *corners.T, facecolor=BODY, edgecolor=INK, linewidth=THIN, joinstyle="round", zorder=2.0
            )
        else:
            axes.plot(*corners.T, color=INK, linewidth=0.8 * LINK, solid_capstyle="round", zorder=2.1)
    for joint in range(len(cell.places)):
        signs.hinge(axes, cell.places[joint], SIGN)
        if joint in cell.outer:
            signs.traced_point(axes, cell.places[joint], 2.0 * SIGN, INK)
