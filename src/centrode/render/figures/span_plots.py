"""Plots over spans as figures of matplotlib: curves with their jumps, the spans named above them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from centrode.locale import _
from centrode.render.drawing.figure_room import PAGE_HEIGHT, count_across, figure_width
from centrode.render.drawing.style import (
    CENTRE_LINE,
    GROUND,
    HAIR,
    INK,
    JUMP,
    LETTER,
    MUTED,
    PALETTE,
    SMALL,
    THIN,
    Decimals,
    marker_options,
    numbered_pen,
)
from centrode.render.figures.curves import angle_ticks, legend_height, wrap_label, write_legend, write_title
from centrode.render.figures.grid_layout import GridLayout
from centrode.render.spelling import FigureSpelling, PrintSpelling

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from centrode.model.settings import Display
    from centrode.sheets.plots import SpanPanel, SpanPlot

PANEL, HEADED = 1.45, 1.9
"""Inches of a panel's height: of a plain one, and with a heading."""
EDGES, TICKS = 0.9, 12
"""Inches of what is beside the axes; the most ticks of an angle."""
ROUNDING = 1e-9
"""Share of the greatest value below which a jump is not drawn."""


def span_figure(plot: SpanPlot, display: Display) -> Figure:
    """A figure of panels below each other; with more than one curve their names stand beside the first panel."""
    spelling, words = FigureSpelling(display), PrintSpelling(display)
    names = [words.text(curve.name) for curve in plot.panels[0].curves]
    keyed, headed = len(names) > 1, bool(words.text(plot.panels[0].heading))
    each = HEADED if headed else PANEL
    height = 1.1 + each * len(plot.panels) + (legend_height(names) if keyed else 0.0)
    figure = Figure(figsize=(figure_width(), min(height, PAGE_HEIGHT)), layout=GridLayout())
    grid = figure.subplots(len(plot.panels), 1, sharex=True, squeeze=False)[:, 0]
    factor, label, unit = spelling.label(plot.label)
    pieces = np.split(np.arange(len(plot.values)), 1 + np.flatnonzero(np.diff(plot.values) == 0.0))
    for axes, panel in zip(grid, plot.panels, strict=True):
        _draw(axes, panel, factor * plot.values, pieces, spelling)
        for jump in panel.jumps:
            at_end = jump[0] in (plot.ends[0], plot.ends[-1])
            _draw_jump(axes, panel, jump, factor, spelling, clipped=not at_end)
        for end in plot.ends if plot.names else plot.ends[1:-1]:
            axes.axvline(factor * end, color=MUTED, linewidth=HAIR, zorder=1)
    _name_spans(grid[0], plot, factor, words)
    low, high = factor * plot.ends[0], factor * plot.ends[-1]
    grid[-1].set_xlabel(label)
    angle_ticks(grid[-1].xaxis, low, high, unit, count_across(TICKS))
    grid[-1].set_xlim(low, high)
    if keyed:
        pens = [numbered_pen(curve.place) for curve in plot.panels[0].curves]
        keys = [Line2D([], [], color=pen.colour, **marker_options(pen, None)) for pen in pens]
        write_legend(grid[0], list(zip(keys, names, strict=True)))
    write_title(figure, spelling.text(plot.title), words.text(plot.mechanism))
    return figure


def _draw(
    axes: Axes, panel: SpanPanel, across: np.ndarray, pieces: list[np.ndarray], spelling: FigureSpelling
) -> None:
    """The curves span by span, so that a jump is drawn as one; what is admissible; the line of zero."""
    factor, label, _unit = spelling.label(panel.label)
    for curve in panel.curves:
        for piece in pieces:
            pen = numbered_pen(curve.place)
            axes.plot(across[piece], factor * curve.values[piece], color=pen.colour, **marker_options(pen))
    for bound in panel.bounds:
        axes.axhline(factor * bound, color=PALETTE[1], linewidth=THIN, linestyle=CENTRE_LINE)
        axes.annotate(
            _("admissible"), (1.0, factor * bound), xycoords=("axes fraction", "data"), xytext=(-4, 2),
            textcoords="offset points", ha="right", va="bottom", color=GROUND, fontsize=SMALL,
        )  # fmt: skip
    if panel.zero_line:
        axes.axhline(0.0, color=INK, linewidth=HAIR, zorder=1)
    if heading := spelling.text(panel.heading):
        axes.set_title(heading)
    axes.set_ylabel(label)
    wrap_label(axes, PANEL)
    axes.yaxis.set_major_formatter(Decimals())
    axes.margins(y=0.05 if len(panel.curves) > 1 else 0.08)


def _draw_jump(
    axes: Axes,
    panel: SpanPanel,
    jump: tuple[float, float, float],
    across: float,
    spelling: FigureSpelling,
    *,
    clipped: bool,
) -> None:
    """A dashed line from one side of a jump to the other; none of what is rounding."""
    place, low, high = jump
    factor = spelling.label(panel.label)[0]
    size = max(float(np.abs(curve.values).max()) for curve in panel.curves)
    if abs(high - low) > ROUNDING * size:
        heights = [factor * low, factor * high]
        axes.plot([across * place] * 2, heights, color=PALETTE[1], linestyle=JUMP, clip_on=clipped)


def _name_spans(axes: Axes, plot: SpanPlot, factor: float, words: PrintSpelling) -> None:
    """The name of each span above it, its number where there is no room."""
    ends = factor * np.array(plot.ends)
    room = (figure_width() - EDGES) / (ends[-1] - ends[0])
    for number, (text, low, high) in enumerate(
        zip(map(words.text, plot.names), ends, ends[1:], strict=False)
    ):
        name = text if SMALL * LETTER * (len(text) + 1) < room * (high - low) else str(number + 1)
        axes.annotate(
            name, (0.5 * (low + high), 1.0), xycoords=("data", "axes fraction"), xytext=(0, 3),
            textcoords="offset points", ha="center", va="bottom", color=GROUND, fontsize=SMALL,
        )  # fmt: skip
