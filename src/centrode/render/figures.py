"""Plots and diagrams of sheets as figures of matplotlib, in the house style."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, assert_never

import numpy as np
from matplotlib.artist import Artist
from matplotlib.figure import Figure

from centrode.locale import _
from centrode.present.abscissa import CHANGE_POINT, LIMIT
from centrode.present.abscissa import Abscissa as DrawnAbscissa
from centrode.present.curves import Panel, sheet, write_legend, write_title
from centrode.present.saving import save_figures
from centrode.present.style import DASHES, INK, PALETTE, Decimals, Pen, house_style
from centrode.render.span_plots import span_figure
from centrode.render.spelling import FigureSpelling, PlainSpelling
from centrode.sheets.plots import Abscissa, CurvePanel, Diagram, EventKind, Plot, SpanPlot, Trace, TraceKind

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from centrode.model.asked import Display
    from centrode.sheets.sheet import Picture

INCHES = 4.6
"""Height of a diagram's axes, which its legend may take."""
EVENTS = {EventKind.LIMIT: LIMIT, EventKind.CHANGE_POINT: CHANGE_POINT}


def figures_of(pictures: Mapping[str, Picture], display: Display) -> dict[str, Figure]:
    """The pictures of a sheet as figures, by name; those whose every panel is empty are left out."""
    return {
        name: figure_of(picture, display)
        for name, picture in pictures.items()
        if not isinstance(picture, Plot) or any(panel.curves for row in picture.rows for panel in row)
    }


def write_pictures(
    pictures: Mapping[str, Picture],
    folder: Path,
    display: Display,
    say: Callable[[str, int, int], None] = lambda *_progress: None,
) -> None:
    """Write the pictures of a sheet as PNG and SVG; `say` hears which is drawn, its number and how many there are."""
    drawn = figures_of(pictures, display)
    for number, (name, figure) in enumerate(drawn.items(), start=1):
        say(_("drawing {name}").format(name=name), number, len(drawn))
        save_figures({name: figure}, folder)


def figure_of(picture: Picture, display: Display) -> Figure:
    """A plot or a diagram as a figure, lengths and angles in the units of the display."""
    with house_style():
        match picture:
            case Plot():
                return _plot(picture, display)
            case Diagram():
                return _diagram(picture, display)
            case SpanPlot():
                return span_figure(picture, display)
            case _:
                assert_never(picture)


def _plot(plot: Plot, display: Display) -> Figure:
    spelling = FigureSpelling(display)
    rows = [[_panel(panel, spelling) for panel in row] for row in plot.rows]
    title, mechanism = spelling.text(plot.title), PlainSpelling(display).text(plot.mechanism)
    return sheet(title, mechanism, rows, _abscissa(plot.abscissa, spelling))


def _abscissa(abscissa: Abscissa, spelling: FigureSpelling) -> DrawnAbscissa:
    factor, label, unit = spelling.label(abscissa.label)
    cut = abscissa.cut if abscissa.cut.size else np.zeros(len(abscissa.values), dtype=bool)
    events = tuple((factor * value, EVENTS[kind]) for value, kind in abscissa.events)
    return DrawnAbscissa(factor * abscissa.values, abscissa.order, abscissa.breaks, cut, events, label, unit)


def _panel(panel: CurvePanel, spelling: FigureSpelling) -> Panel:
    factor, label, unit = spelling.label(panel.label)
    # legends write names as they are: plain text, in which dollar signs are escaped where it is drawn
    names = [PlainSpelling(spelling.display).text(curve.name) for curve in panel.curves]
    curves = {name: factor * curve.values for name, curve in zip(names, panel.curves, strict=True)}
    pens = {
        name: _pen(curve.place, curve.approximate) for name, curve in zip(names, panel.curves, strict=True)
    }
    return Panel(label, unit, curves, pens, factor * panel.scale, panel.legend)


def _pen(place: int, approximate: bool) -> Pen:
    """Colours in turn, then the same colours dashed; what is approximate is dashed at once."""
    dashes = DASHES[1] if approximate else DASHES[place // len(PALETTE) % len(DASHES)]
    return Pen(PALETTE[place % len(PALETTE)], dashes)


def _diagram(diagram: Diagram, display: Display) -> Figure:
    spelling = FigureSpelling(display)
    across, x_label, _unit = spelling.label(diagram.x)
    up, y_label, _unit = spelling.label(diagram.y)
    figure = Figure(figsize=(9.6, INCHES + 1.2), layout="constrained")
    axes = figure.subplots()
    key = [
        _trace(axes, trace, place, (across, up), PlainSpelling(display))
        for place, trace in enumerate(diagram.traces)
    ]
    axes.set_xlim(across * diagram.across[0], across * diagram.across[1])
    axes.set_xlabel(x_label)
    axes.set_ylabel(y_label)
    axes.yaxis.set_major_formatter(Decimals())
    write_legend(axes, key, inches=INCHES)
    write_title(figure, spelling.text(diagram.title), PlainSpelling(display).text(diagram.mechanism))
    return figure


def _trace(
    axes: Axes, trace: Trace, place: int, factors: tuple[float, float], spelling: PlainSpelling
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
