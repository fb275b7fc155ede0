"""Plots of sheets as figures of matplotlib: panels of curves, their sizes on logarithmic scales, diagrams."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, TypeAlias, assert_never

import numpy as np
from matplotlib.artist import Artist
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from centrode.render.drawing.figure_room import PAGE_HEIGHT, count_across, figure_width
from centrode.render.drawing.style import (
    APPROXIMATE,
    CENTRE_LINE,
    INK,
    PALETTE,
    SMALL,
    THIN,
    Decimals,
    Pen,
    marker_options,
    numbered_pen,
)
from centrode.render.figures.curves import (
    ABOVE_INCHES,
    LONE_INCHES,
    PANEL_INCHES,
    DrawnAbscissa,
    QuantityCurves,
    angle_ticks,
    legend_height,
    sheet,
    wrap_label,
    write_legend,
    write_title,
)
from centrode.render.figures.grid_layout import GridLayout
from centrode.render.spelling import FigureSpelling, PrintSpelling
from centrode.sheets.plots import CurveRole, TraceKind

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from centrode.model.settings import Display
    from centrode.sheets.plots import Abscissa, Curve, CurveDiagram, CurvePanel, Overlay, Plot, Trace

Rows: TypeAlias = "tuple[tuple[CurvePanel, ...], ...]"
INCHES = 3.4
"""Height of a diagram's axes, which its legend may take."""
COLOURED = PALETTE[:-1]
"""The palette without its black, which is the sum's among parts."""
COLUMNS = 2
"""The most columns of panels."""
TICKS = 9
"""The most ticks of an angle."""
PALE = 0.25
"""Opacity of a band."""
SHADE = 0.08
"""Opacity of a stretch of the abscissa that is shaded."""
ROOM = 0.08
"""Share of the panel that the name of a single place takes at its right."""


def plot_figure(plot: Plot, display: Display) -> Figure:
    """A figure of panels over one abscissa."""
    spelling = FigureSpelling(display)
    plot = _turn_columns(plot)
    across = spelling.label(plot.abscissa.label)[0]
    rows = [[_panel(panel, spelling, across) for panel in row] for row in plot.rows]
    title, mechanism = spelling.text(plot.title), PrintSpelling(display).text(plot.mechanism)
    abscissa = drawn_abscissa(plot.abscissa, spelling)
    if plot.sizes_above is not None:
        figure = _sizes([panel for row in rows for panel in row], abscissa, plot.sizes_above)
        write_title(figure, title, mechanism)
    else:
        figure = sheet(title, mechanism, rows, abscissa)
    if plot.overlay is not None:
        _lay_over(figure, plot.overlay, spelling)
    for axes, panel in zip(figure.axes, (panel for row in plot.rows for panel in row), strict=True):
        _add_bands(axes, panel, abscissa, spelling)
        _add_dots(axes, panel, across, spelling)
        if panel.from_zero:
            axes.set_ylim(bottom=0.0)
    _mark_places(figure, plot, across, spelling)
    for low, high in plot.shaded:
        for axes in figure.axes:
            axes.axvspan(across * low, across * high, color=INK, alpha=SHADE, linewidth=0.0, zorder=0.5)
    return figure


def _turn_columns(plot: Plot) -> Plot:
    """The plot with its columns as rows where it has more columns than find room; names stand beside the last.

    A figure that is narrower than a page has one column.
    """
    columns = max(map(len, plot.rows))
    if count_across(COLUMNS) < columns <= COLUMNS:
        return _with_rows(plot, lambda rows: tuple((panel,) for row in rows for panel in row))
    if columns <= COLUMNS:
        return plot

    def turn(rows: Rows) -> Rows:
        return tuple(
            tuple(replace(panel, legend=panel is row[-1] and row[0].legend) for panel in row)
            for row in zip(*rows, strict=True)
        )

    return _with_rows(plot, turn)


def _with_rows(plot: Plot, arrange: Callable[[Rows], Rows]) -> Plot:
    """The plot with its panels in other rows, and those of what lies over it."""
    overlay = plot.overlay and replace(plot.overlay, rows=arrange(plot.overlay.rows))
    return replace(plot, rows=arrange(plot.rows), overlay=overlay)


def _add_bands(axes: Axes, panel: CurvePanel, abscissa: DrawnAbscissa, spelling: FigureSpelling) -> None:
    """Fill the areas of a panel behind its curves, with their entries in its legend."""
    up, entries = spelling.label(panel.label)[0], []
    for band in panel.bands:
        low, high = (abscissa.parts(up * curve)[0] for curve in (band.low, band.high))
        # a wide band first: what lies upon it stays visible
        area = axes.fill_between(
            abscissa.drawn,
            low,
            high,
            color=numbered_pen(band.place).colour,
            alpha=PALE,
            linewidth=0.0,
            zorder=1.0,
        )
        entries.append((area, PrintSpelling(spelling.display).text(band.name)))
    if entries:
        axes.relim()
        heights = np.concatenate([up * curve for band in panel.bands for curve in (band.low, band.high)])
        known = heights[np.isfinite(heights)]
        if known.size:
            bottom, top = axes.get_ylim()
            room = 0.05 * float(np.ptp(known))
            axes.set_ylim(min(bottom, float(known.min()) - room), max(top, float(known.max()) + room))
        write_legend(axes, [*_entries(axes), *entries])


def _add_dots(axes: Axes, panel: CurvePanel, across: float, spelling: FigureSpelling) -> None:
    """Draw the single values of a panel, with their entries in its legend."""
    up, entries = spelling.label(panel.label)[0], []
    for name, x, y in panel.dots:
        (dot,) = axes.plot([across * x], [up * y], "o", color=INK, markersize=5, clip_on=False, zorder=5)
        entries.append((dot, PrintSpelling(spelling.display).text(name)))
    if entries:
        write_legend(axes, [*_entries(axes), *entries])


def _mark_places(figure: Figure, plot: Plot, across: float, spelling: FigureSpelling) -> None:
    """A line at each place that the panels show, its name along that in the first one."""
    for name, value in plot.places:
        place = across * value
        low, high = figure.axes[0].get_xlim()
        if not low <= place <= high:
            continue
        for axes in figure.axes:
            axes.axvline(place, color=INK, linewidth=THIN, linestyle=CENTRE_LINE)
        beside = 12 if high - place > ROOM * (high - low) else -4
        figure.axes[0].annotate(
            spelling.text(name), (place, 0.34), xycoords=("data", "axes fraction"), xytext=(beside, 0),
            textcoords="offset points", rotation=90, ha="right", va="center", color=INK, fontsize=SMALL,
        )  # fmt: skip


def _entries(axes: Axes) -> list[tuple[Artist, str]]:
    """What the legend of a panel has."""
    legend = axes.get_legend()
    if legend is None:
        return []
    return [
        (handle, text.get_text())
        for handle, text in zip(legend.legend_handles, legend.get_texts(), strict=True)
        if handle is not None
    ]


def _lay_over(figure: Figure, overlay: Overlay, spelling: FigureSpelling) -> None:
    """Draw the curves of a second route over those of a figure, with one entry in its legends."""
    abscissa = drawn_abscissa(overlay.abscissa, spelling)
    look: dict[str, Any] = {"color": INK, "linestyle": APPROXIMATE, "linewidth": THIN}
    panels = [_panel(panel, spelling) for row in overlay.rows for panel in row]
    for axes, panel in zip(figure.axes, panels, strict=True):
        for curve in panel.curves.values():
            axes.plot(abscissa.values, curve[abscissa.order], zorder=3, **look)
        if entries := _entries(axes):
            name = PrintSpelling(spelling.display).text(overlay.name)
            write_legend(axes, [*entries, (Line2D([], [], **look), name)])


def _sizes(panels: Sequence[QuantityCurves], abscissa: DrawnAbscissa, least: float) -> Figure:
    """Panels below each other with the sizes of their curves on logarithmic scales."""
    each = LONE_INCHES if len(panels) == 1 else PANEL_INCHES
    height = ABOVE_INCHES + sum(each + legend_height(list(panel.curves)) for panel in panels)
    figure = Figure(figsize=(figure_width(), min(PAGE_HEIGHT, height)), layout=GridLayout())
    grid = figure.subplots(len(panels), 1, sharex=True, squeeze=False)
    for axes, panel in zip(grid.ravel(), panels, strict=True):
        handles: list[tuple[Artist, str]] = []
        for name, curve in panel.curves.items():
            size = np.abs(curve[abscissa.order])
            pen = panel.pens[name]
            (line,) = axes.plot(
                abscissa.values,
                np.where(size > least, size, np.nan),  # the scale would show nothing but rounding
                color=pen.colour,
                linestyle=pen.dashes,
                label=name,
                **marker_options(pen),
            )
            handles.append((line, name))
        axes.set_yscale("log")
        axes.margins(y=0.12)  # the lowest power stands clear of the ticks below
        if abscissa.range is not None:
            axes.set_xlim(abscissa.range)
            angle_ticks(axes.xaxis, *abscissa.range, abscissa.unit, count_across(TICKS))
        axes.set_ylabel(panel.label)
        wrap_label(axes, each)
        write_legend(axes, handles)
    grid[-1, 0].set_xlabel(abscissa.label)
    return figure


def drawn_abscissa(abscissa: Abscissa, spelling: FigureSpelling) -> DrawnAbscissa:
    """An abscissa in the unit that is shown, with its label."""
    factor, label, unit = spelling.label(abscissa.label)
    cut = abscissa.cut if abscissa.cut.size else np.zeros(len(abscissa.values), dtype=bool)
    events = tuple((factor * value, kind) for value, kind in abscissa.events)
    ends = None if abscissa.ends is None else (factor * abscissa.ends[0], factor * abscissa.ends[1])
    return DrawnAbscissa(
        factor * abscissa.values, abscissa.order, abscissa.breaks, cut, events, label, unit, ends
    )


def _panel(panel: CurvePanel, spelling: FigureSpelling, across: float = 1.0) -> QuantityCurves:
    factor, label, unit = spelling.label(panel.label)
    # legends write names as they are: plain text, in which dollar signs are escaped where it is drawn
    names = [PrintSpelling(spelling.display).text(curve.name) for curve in panel.curves]
    curves = {name: factor * curve.values for name, curve in zip(names, panel.curves, strict=True)}
    pens = {name: _pen(curve) for name, curve in zip(names, panel.curves, strict=True)}
    slopes = {
        name: factor / across * curve.slopes
        for name, curve in zip(names, panel.curves, strict=True)
        if curve.slopes is not None
    }
    areas = [PrintSpelling(spelling.display).text(band.name) for band in panel.bands]
    return QuantityCurves(label, unit, curves, pens, factor * panel.scale, panel.legend, slopes, areas)


def _pen(curve: Curve) -> Pen:
    """Colours in turn, then the same colours with markers; what is approximate is dashed, black is a sum's alone."""
    if curve.role is CurveRole.LEVEL:
        return Pen(INK, APPROXIMATE)
    if curve.role is CurveRole.SUM:
        return Pen(INK)
    pen = numbered_pen(curve.place, COLOURED if curve.role is CurveRole.PART else PALETTE)
    return Pen(pen.colour, APPROXIMATE if curve.approximate else "-", pen.marker)


def diagram_figure(diagram: CurveDiagram, display: Display) -> Figure:
    """A figure of one quantity over another."""
    spelling = FigureSpelling(display)
    across, x_label, _unit = spelling.label(diagram.x)
    up, y_label, _unit = spelling.label(diagram.y)
    names = [PrintSpelling(display).text(trace.name) for trace in diagram.traces]
    height = INCHES + ABOVE_INCHES + legend_height(names, inches=INCHES)
    figure = Figure(figsize=(figure_width(), height), layout=GridLayout())
    axes = figure.subplots()
    key = [
        _trace(axes, trace, place, (across, up), PrintSpelling(display))
        for place, trace in enumerate(diagram.traces)
    ]
    axes.set_xlim(across * diagram.across[0], across * diagram.across[1])
    axes.set_xlabel(x_label)
    axes.set_ylabel(y_label)
    axes.yaxis.set_major_formatter(Decimals())
    write_legend(axes, key, inches=INCHES)
    write_title(figure, spelling.text(diagram.title), PrintSpelling(display).text(diagram.mechanism))
    return figure


def _trace(
    axes: Axes, trace: Trace, place: int, factors: tuple[float, float], spelling: PrintSpelling
) -> tuple[Artist, str]:
    """Draw a trace with its marks; returns its entry in the legend."""
    colour = PALETTE[place % len(PALETTE)]
    x, y = factors[0] * trace.x, factors[1] * trace.y
    match trace.kind:
        case TraceKind.CURVE:
            (line,) = axes.plot(x, y, color=colour)
        case TraceKind.LINE:
            (line,) = axes.plot(x, y, color=colour, linewidth=1.2)
        case TraceKind.SEGMENT:
            (line,) = axes.plot(x, y, color=INK, linewidth=3.0, clip_on=False)
        case _:
            assert_never(trace.kind)
    for mark in trace.marks * factors:
        axes.plot([mark[0]], [mark[1]], "o", color=colour, markersize=5)
    return line, spelling.text(trace.name)
