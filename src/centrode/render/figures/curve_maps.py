"""Maps of curves in the plane as a figure of matplotlib, in the house style."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from centrode.render.drawing.figure_room import PAGE_HEIGHT, count_across, figure_width
from centrode.render.drawing.style import INK, MUTED, Decimals, numbered_pen
from centrode.render.figures.curves import write_title
from centrode.render.spelling import FigureSpelling, PrintSpelling

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from centrode.model.settings import Display
    from centrode.sheets.curve_maps import CurveMap, MapPanel

COLUMNS = 2
HIGH = 2.9
"""Of a row of two panels; of one panel alone half as much again [inch]."""
ROOM = 0.08
MOST_TICKS = 5


def map_figure(chart: CurveMap, display: Display) -> Figure:
    """Panels in at most two columns, each with equal scales of both axes."""
    spelling = FigureSpelling(display)
    count = len(chart.panels)
    columns = min(count_across(COLUMNS), count)
    rows = -(-count // columns)
    high = HIGH if columns > 1 else 1.5 * HIGH
    figure = Figure(figsize=(figure_width(), min(PAGE_HEIGHT, rows * high + 0.8)), layout="constrained")
    places = figure.subplots(rows, columns, squeeze=False).ravel()
    factor, x_label, _unit = spelling.label(chart.x)
    _factor, y_label, _unit = spelling.label(chart.y)
    names: dict[str, Line2D] = {}
    for axes, panel in zip(places, chart.panels, strict=False):
        _draw(axes, panel, factor, spelling, names)
        axes.set_title(spelling.text(panel.name))
        axes.set_xlabel(x_label)
        axes.set_ylabel(y_label)
    for axes in places[count:]:
        axes.set_axis_off()
    if any(len(panel.targets) for panel in chart.panels):
        dot = Line2D([], [], color=INK, marker="o", markerfacecolor="none", markersize=4, linestyle="none")
        names[spelling.text(chart.target)] = dot
    figure.legend(
        names.values(), names.keys(), loc="outside lower center", ncols=min(count_across(4), len(names))
    )
    write_title(figure, spelling.text(chart.title), PrintSpelling(display).text(chart.mechanism))
    return figure


def _draw(
    axes: Axes, panel: MapPanel, factor: float, spelling: FigureSpelling, names: dict[str, Line2D]
) -> None:
    for curve in panel.curves:
        pen = numbered_pen(curve.place)
        name = spelling.text(curve.name)
        places = factor * curve.places
        (line,) = axes.plot(places[:, 0], places[:, 1], color=pen.colour, linewidth=1.4, zorder=3)
        names.setdefault(name, line)
    for link in panel.links:
        closed = np.concatenate([link, link[:1]]) if len(link) > 2 else link
        axes.plot(
            *(factor * closed).T,
            color=MUTED,
            linewidth=1.6,
            marker="o",
            markersize=3,
            markerfacecolor="white",
            zorder=2,
        )
    if panel.fixed is not None:
        axes.plot(*(factor * panel.fixed).T, color=INK, marker="^", markersize=6, linestyle="none", zorder=4)
    if len(panel.targets):
        axes.plot(
            *(factor * panel.targets).T,
            color=INK,
            marker="o",
            markerfacecolor="none",
            markersize=4,
            linestyle="none",
            zorder=5,
        )
    if panel.arrows is not None:
        for start, end in factor * panel.arrows:
            axes.annotate("", end, start, arrowprops={"arrowstyle": "->", "color": INK, "linewidth": 0.8})
    axes.set_aspect("equal", adjustable="datalim")
    axes.margins(ROOM)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter(Decimals())
