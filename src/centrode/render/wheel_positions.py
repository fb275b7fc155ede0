"""A walking wheel at some instants, as a figure of matplotlib."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from matplotlib.figure import Figure

from centrode.model.settings import shown_as
from centrode.present.cams.walking_wheel import draw_wheel, wheel_keys, window
from centrode.present.curves import write_title
from centrode.present.displayed_units import label_with_unit
from centrode.render.spelling import DrawingSpelling
from centrode.sheets.texts import Number

if TYPE_CHECKING:
    from centrode.model.settings import Display
    from centrode.sheets.outlines import WheelPositions

COLUMNS = 3
MOST_INSTANTS = 12


def wheel_figure(positions: WheelPositions, display: Display) -> Figure:
    """The wheel in a panel for each instant, at most the first twelve, lengths in the unit of the display."""
    spelling = DrawingSpelling(display)
    factor, unit = shown_as("m", display)
    turned = positions.turned[:MOST_INSTANTS]
    columns = min(COLUMNS, len(turned))
    rows = -(-len(turned) // columns)
    figure = Figure(figsize=(3.6 * columns + 0.6, 3.7 * rows + 1.3), layout="constrained")
    grid = figure.subplots(rows, columns, squeeze=False).reshape(-1)
    for axes in grid[len(turned) :]:
        axes.set_visible(False)
    for axes, angle in zip(grid, turned, strict=False):
        pose = positions.wheel.pose(angle)
        draw_wheel(axes, positions.wheel, pose, factor)
        window(axes, positions.wheel, pose, factor)
        axes.set_title(spelling.text(Number(math.degrees(angle), "deg", ".4g", unit_fixed=True)))
        axes.set_xlabel(label_with_unit("x", unit))
    grid[0].set_ylabel(label_with_unit("y", unit))
    keys = wheel_keys()
    figure.legend(
        [key for key, _name in keys], [name for _key, name in keys], loc="outside lower center", ncols=4
    )
    write_title(figure, spelling.text(positions.title), spelling.text(positions.mechanism))
    return figure
