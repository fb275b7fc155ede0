"""Plots and diagrams of sheets as figures of matplotlib, in the house style."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, assert_never

import numpy as np
from matplotlib.artist import Artist
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from centrode.locale import _
from centrode.present.curves import DrawnAbscissa, Panel, sheet, write_legend, write_title
from centrode.present.figure_files import save_figures
from centrode.present.style import DASHES, INK, PALETTE, Decimals, Pen, darkened, house_style
from centrode.render.areas import area_figure
from centrode.render.charts import bar_figure, front_figure, hodograph_figure, linkage_figure
from centrode.render.force_pages import group_page
from centrode.render.instant_pages import instant_figure
from centrode.render.levers import lever_page
from centrode.render.outline_drawings import outline_figure, path_figure
from centrode.render.panel_grids import grid_figure
from centrode.render.position_pages import positions_figure
from centrode.render.scenes import scene_figure
from centrode.render.span_plots import span_figure
from centrode.render.spelling import FigureSpelling, PlainSpelling
from centrode.render.vector_diagrams import vector_diagram_figure
from centrode.render.vector_pages import vector_page
from centrode.render.wheel_positions import wheel_figure
from centrode.sheets.charts import BarChart, FrontDiagram, Hodograph, LinkageWithDiscs
from centrode.sheets.force_pages import GroupPage, LeverPage
from centrode.sheets.outlines import OutlineDrawing, PathDrawing, WheelPositions
from centrode.sheets.pages import InstantPage, PositionsPage, VectorDiagramPage
from centrode.sheets.plots import (
    Abscissa,
    AreaDiagram,
    Curve,
    CurveDiagram,
    CurvePanel,
    CurveRole,
    EventKind,
    Overlay,
    PanelGrid,
    Plot,
    SpanPlot,
    Trace,
    TraceKind,
    VectorPage,
)
from centrode.sheets.scenes import Scene
from centrode.views.abscissa import CHANGE_POINT, LIMIT

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from centrode.model.settings import Display
    from centrode.sheets.sheet import Picture

INCHES = 4.6
"""Height of a diagram's axes, which its legend may take."""
COLOURED = PALETTE[:-1]
"""The palette without its black, which is the sum's among parts."""
MARKED = (0, (6, 2, 1.5, 2))
"""Dashes of the line at a single place."""
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
    *,
    dark: bool = False,
) -> None:
    """Write the pictures of a sheet as PNG and SVG, `dark` with light lines on a dark ground.

    `say` hears which is drawn, its number and how many there are.
    """
    drawn = figures_of(pictures, display)
    for number, (name, figure) in enumerate(drawn.items(), start=1):
        say(_("drawing {name}").format(name=name), number, len(drawn))
        save_figures({name: darkened(figure) if dark else figure}, folder)


def figure_of(picture: Picture, display: Display) -> Figure:
    """A picture of a sheet as a figure, lengths and angles in the units of the display."""
    with house_style():
        match picture:
            case Plot():
                return _plot(picture, display)
            case CurveDiagram():
                return _diagram(picture, display)
            case PanelGrid():
                return grid_figure(picture, display)
            case VectorPage():
                return vector_page(picture)
            case Hodograph():
                return hodograph_figure(picture, display)
            case BarChart():
                return bar_figure(picture, display)
            case LinkageWithDiscs():
                return linkage_figure(picture, display)
            case AreaDiagram():
                return area_figure(picture, display)
            case Scene():
                return scene_figure(picture, display)
            case SpanPlot():
                return span_figure(picture, display)
            case GroupPage():
                return group_page(picture)
            case LeverPage():
                return lever_page(picture)
            case PositionsPage():
                return positions_figure(picture, display)
            case InstantPage():
                return instant_figure(picture, display)
            case VectorDiagramPage():
                return vector_diagram_figure(picture, display)
            case OutlineDrawing():
                return outline_figure(picture, display)
            case PathDrawing():
                return path_figure(picture, display)
            case WheelPositions():
                return wheel_figure(picture, display)
            case FrontDiagram():
                return front_figure(picture, display)
            case _:
                assert_never(picture)


def _plot(plot: Plot, display: Display) -> Figure:
    spelling = FigureSpelling(display)
    rows = [[_panel(panel, spelling) for panel in row] for row in plot.rows]
    title, mechanism = spelling.text(plot.title), PlainSpelling(display).text(plot.mechanism)
    abscissa = _abscissa(plot.abscissa, spelling)
    if plot.sizes_above is not None:
        figure = _sizes([panel for row in rows for panel in row], abscissa, plot.sizes_above)
        write_title(figure, title, mechanism)
    else:
        figure = sheet(title, mechanism, rows, abscissa)
    if plot.overlay is not None:
        _lay_over(figure, plot.overlay, spelling)
    across = spelling.label(plot.abscissa.label)[0]
    for axes, panel in zip(figure.axes, (panel for row in plot.rows for panel in row), strict=True):
        _add_dots(axes, panel, across, spelling)
        if panel.from_zero:
            axes.set_ylim(bottom=0.0)
    _mark_places(figure, plot, across, spelling)
    return figure


def _add_dots(axes: Axes, panel: CurvePanel, across: float, spelling: FigureSpelling) -> None:
    """Draw the single values of a panel, with their entries in its legend."""
    up, entries = spelling.label(panel.label)[0], []
    for name, x, y in panel.dots:
        (dot,) = axes.plot([across * x], [up * y], "o", color=INK, markersize=5, clip_on=False, zorder=5)
        entries.append((dot, PlainSpelling(spelling.display).text(name)))
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
            axes.axvline(place, color=INK, linewidth=0.9, linestyle=MARKED)
        beside = -4 if place > 0.5 * (low + high) else 12
        figure.axes[0].annotate(
            spelling.text(name), (place, 0.34), xycoords=("data", "axes fraction"), xytext=(beside, 0),
            textcoords="offset points", rotation=90, ha="right", va="center", color=INK, fontsize=8.5,
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
    abscissa = _abscissa(overlay.abscissa, spelling)
    look: dict[str, Any] = {"color": INK, "linestyle": (0, (2.5, 2.5)), "linewidth": 0.9}
    panels = [_panel(panel, spelling) for row in overlay.rows for panel in row]
    for axes, panel in zip(figure.axes, panels, strict=True):
        for curve in panel.curves.values():
            axes.plot(abscissa.values, curve[abscissa.order], zorder=3, **look)
        if entries := _entries(axes):
            name = PlainSpelling(spelling.display).text(overlay.name)
            write_legend(axes, [*entries, (Line2D([], [], **look), name)])


def _sizes(panels: Sequence[Panel], abscissa: DrawnAbscissa, least: float) -> Figure:
    """Panels below each other with the sizes of their curves on logarithmic scales."""
    figure = Figure(figsize=(8.2, 3.0 * len(panels)), layout="constrained")
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
            )
            handles.append((line, name))
        axes.set_yscale("log")
        if abscissa.values[0] < abscissa.values[-1]:
            axes.set_xlim(float(abscissa.values[0]), float(abscissa.values[-1]))
        axes.set_ylabel(panel.label)
        write_legend(axes, handles)
    grid[-1, 0].set_xlabel(abscissa.label)
    return figure


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
    pens = {name: _pen(curve) for name, curve in zip(names, panel.curves, strict=True)}
    return Panel(label, unit, curves, pens, factor * panel.scale, panel.legend)


def _pen(curve: Curve) -> Pen:
    """Colours in turn, then the same colours dashed; what is approximate is dashed at once, black is a sum's alone."""
    if curve.role is CurveRole.LEVEL:
        return Pen(INK, DASHES[1])
    if curve.role is CurveRole.SUM:
        return Pen(INK)
    place = curve.place
    colours: Sequence[str] = COLOURED if curve.role is CurveRole.PART else PALETTE
    dashes = DASHES[1] if curve.approximate else DASHES[place // len(colours) % len(DASHES)]
    return Pen(colours[place % len(colours)], dashes)


def _diagram(diagram: CurveDiagram, display: Display) -> Figure:
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
