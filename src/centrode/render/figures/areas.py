"""Areas of the plane of two quantities as figures of matplotlib, in the house style."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.artist import Artist
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from centrode.render.drawing.figure_room import PAGE_HEIGHT, count_across, figure_width
from centrode.render.drawing.style import (
    APPROXIMATE,
    CURVE,
    INK,
    MUTED,
    PALETTE,
    Decimals,
)
from centrode.render.figures.curves import (
    PANEL_INCHES,
    angle_ticks,
    column_width,
    legend_height,
    legend_width,
    write_legend,
    write_title,
)
from centrode.render.spelling import FigureSpelling, PrintSpelling
from centrode.sheets.plots import Area, AreaDiagram, AreaKind, AreaPath

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from centrode.model.settings import Display

LEAST, TALLEST, EDGES, HEAD = 1.8, 4.6, 0.75, 1.1
"""The least side of the axes, the most of their height, and what stands beside and above them [inch]."""
MANY, ENTRY = 8, 0.19
"""Names of which more stand below each other beside the axes, and the height of one [inch]."""
COLOURS = {AreaKind.MAIN: "#CFE3F2", AreaKind.BESIDE: "#E4E4E4"}


def area_figure(diagram: AreaDiagram, display: Display) -> Figure:
    """Areas with their borders, paths over them, places over these, lengths and angles in the units of the display."""
    spelling, words = FigureSpelling(display), PrintSpelling(display)
    (x_factor, x_label, x_unit), (y_factor, y_label, y_unit) = map(spelling.label, (diagram.x, diagram.y))
    x, y = x_factor * diagram.across, y_factor * diagram.up
    # room for what other regions of the same kind show, so that pictures have one size
    names = [area.name for area in diagram.areas] + [path.name for path in diagram.paths]
    names += [name for name, _x, _y in diagram.places]
    texts = [words.text(name) for name in names]
    # many names above the axes would leave no room for these
    many = len(texts) > MANY
    inches = TALLEST if many else PANEL_INCHES
    beside = column_width(texts) if many else legend_width(texts)
    above = 0.0 if many else legend_height(texts)
    wide, high = _inches(diagram, figure_width() - EDGES - beside, min(TALLEST, PAGE_HEIGHT - HEAD - above))
    least = ENTRY * len(texts) if many else 0.0
    figure = Figure(figsize=(figure_width(), max(high, least) + HEAD + above), layout="constrained")
    axes = figure.subplots()
    axes.set_box_aspect(high / wide)
    shown = [area for area in diagram.areas if (area.levels > 0.0).any()]
    for area in reversed(shown):
        _draw_area(axes, area, (x, y))
    key: list[tuple[Artist, str]] = [
        (Patch(facecolor=COLOURS[area.kind], edgecolor=INK), words.text(area.name)) for area in shown
    ]
    for path in diagram.paths:
        line = _draw_path(axes, path, (x_factor, y_factor))
        key.append((line, words.text(path.name)))
    for name, x_place, y_place in diagram.places:
        ring = {"marker": "o", "markersize": 6.0, "color": INK, "markerfacecolor": "white"}
        axes.plot([x_factor * x_place], [y_factor * y_place], zorder=3.0, **ring)  # type: ignore[arg-type]
        key.append((Line2D([], [], linestyle="none", **ring), words.text(name)))  # type: ignore[arg-type]
    axes.set_xlim(float(x[0]), float(x[-1]))
    axes.set_ylim(float(y[0]), float(y[-1]))
    for values, unit, label, axis in ((x, x_unit, x_label, axes.xaxis), (y, y_unit, y_label, axes.yaxis)):
        axis.set_major_formatter(Decimals())
        angle_ticks(axis, float(values[0]), float(values[-1]), unit, count_across(9))
        axis.set_label_text(label)
    write_legend(axes, key, inches=inches, beside=True if many else None)
    write_title(figure, spelling.text(diagram.title), words.text(diagram.mechanism))
    return figure


def _inches(diagram: AreaDiagram, wide: float, high: float) -> tuple[float, float]:
    """Width and height of the axes in this room: of one unit in their proportions, otherwise square."""
    if diagram.x.unit != diagram.y.unit:
        return wide, min(wide, high)
    sides = np.array([np.ptp(diagram.across), np.ptp(diagram.up)])
    across, up = np.maximum(sides * float(np.min(np.array([wide, high]) / sides)), LEAST).tolist()
    return across, up


def _draw_area(axes: Axes, area: Area, lines: Sequence[np.ndarray]) -> None:
    (x, y), colour = lines, COLOURS[area.kind]
    if area.levels.min() < 0.0:
        axes.contourf(x, y, area.levels.T, levels=[0.0, 2.0], colors=[colour], zorder=1.2)
        axes.contour(x, y, area.levels.T, levels=[0.0], colors=[INK], linewidths=1.1, zorder=1.4)
    else:  # the whole grid lies inside, so there is no border to draw
        axes.axvspan(x[0], x[-1], facecolor=colour, zorder=1.2)


def _draw_path(axes: Axes, path: AreaPath, factors: tuple[float, float]) -> Line2D:
    main = path.kind is AreaKind.MAIN
    colour, dashes = (PALETTE[1], "-") if main else (MUTED, APPROXIMATE)
    if path.pen is not None:  # a second round through the colours is dashed
        colour = PALETTE[path.pen % len(PALETTE)]
        dashes = "-" if path.pen < len(PALETTE) else APPROXIMATE
    (line,) = axes.plot(
        factors[0] * path.x,
        factors[1] * path.y,
        color=colour,
        linestyle=dashes,
        linewidth=CURVE,
        zorder=2.5,
    )
    return line
