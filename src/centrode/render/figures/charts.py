"""Hodographs, bar charts and linkages with discs as figures of matplotlib, in the house style."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from centrode.locale import _
from centrode.render.drawing.figure_room import PAGE_HEIGHT, figure_width
from centrode.render.drawing.linkage import draw_mechanism
from centrode.render.drawing.style import (
    APPROXIMATE,
    CENTRE_LINE,
    DOTS,
    INK,
    MUTED,
    PALETTE,
    THIN,
    Decimals,
    Pen,
    numbered_pen,
    pens,
)
from centrode.render.drawing.texts import formula, label_with_unit
from centrode.render.figures.curves import legend_height, legend_width, wrap_label, write_legend, write_title
from centrode.render.spelling import FigureSpelling, PrintSpelling
from centrode.scenes.linkage import scene_of
from centrode.scenes.places import LinkageScene, box
from centrode.sheets.charts import (
    BarChart,
    Bars,
    CarriedDisc,
    DesignDot,
    FrontDiagram,
    HistogramPanel,
    Histograms,
    Hodograph,
    HodographCurve,
    LinkageWithDiscs,
    NamedBarChart,
)

if TYPE_CHECKING:
    from centrode.model.settings import Display

Chart: TypeAlias = Hodograph | BarChart | NamedBarChart | Histograms | LinkageWithDiscs
TICKS = 20
"""The most positions of bars that have a tick each."""
BARS = 1.9
"""Height of a panel of bars [inch]."""
LEAST, MOST = 2.4, 4.6
"""Height of a hodograph, and the most of it [inch]."""


def _pen(one: HodographCurve | Bars) -> Pen:
    pen = numbered_pen(one.place)
    return Pen(pen.colour, APPROXIMATE if one.approximate else "-", pen.marker)


def _write_titles(figure: Figure, chart: Chart, display: Display) -> None:
    mechanism = PrintSpelling(display).text(chart.mechanism)
    write_title(figure, FigureSpelling(display).text(chart.title), mechanism)


def hodograph_figure(hodograph: Hodograph, display: Display) -> Figure:
    """Ends of vectors from one origin, to one scale."""
    spelling = FigureSpelling(display)
    (across, x_label, _x), (up, y_label, _y) = spelling.label(hodograph.x), spelling.label(hodograph.y)
    curves = [(one, _pen(one), one.ends * (across, up)) for one in hodograph.curves]
    size = np.ptp(np.concatenate([ends for _one, _pen, ends in curves]), axis=0)
    names = [PrintSpelling(display).text(one.name) for one in hodograph.curves]
    beside, above = legend_width(names, LEAST), legend_height(names, inches=LEAST)
    room = np.array([figure_width() - beside - 0.8, MOST])
    tiny = np.finfo(float).tiny
    inches = size * float(np.min(room / np.maximum(size, tiny)))
    figure = Figure(
        figsize=(figure_width(), max(float(inches[1]), LEAST) + above + 1.1), layout="constrained"
    )
    axes = figure.subplots()
    key: list[tuple[Artist, str]] = []
    for (one, pen, ends), name in zip(curves, names, strict=True):
        word = spelling.text(one.name)
        (line,) = axes.plot(ends[:, 0], ends[:, 1], color=pen.colour, linestyle=pen.dashes, label=word)
        key.append((line, name))
        marks = np.unique(np.linspace(0, len(ends) - 1, 11).round().astype(int))
        axes.plot(ends[marks, 0], ends[marks, 1], ".", color=pen.colour, markersize=5)
        axes.plot(ends[:1, 0], ends[:1, 1], "o", color=pen.colour, markersize=6)
    axes.plot([0.0], [0.0], "+", color=INK, markersize=9)
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_xlabel(x_label)
    axes.set_ylabel(y_label)
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter(Decimals())
    write_legend(axes, key, inches=LEAST)
    _write_titles(figure, hodograph, display)
    return figure


def bar_figure(chart: BarChart, display: Display) -> Figure:
    """Panels of bars below each other; the legend stands in the first."""
    spelling = FigureSpelling(display)
    figure = Figure(
        figsize=(figure_width(), min(PAGE_HEIGHT, 1.0 + BARS * len(chart.panels))), layout="constrained"
    )
    rows = figure.subplots(len(chart.panels), 1, sharex=True, squeeze=False)[:, 0]
    for axes, panel in zip(rows, chart.panels, strict=True):
        factor, label, _unit = spelling.label(panel.label)
        _draw_bars(axes, panel.bars, factor, spelling)
        axes.set_ylabel(label)
        wrap_label(axes, BARS - 0.4)
        axes.yaxis.set_major_formatter(Decimals())
        axes.grid(visible=False, axis="x")
        axes.set_axisbelow(True)
    rows[-1].set_xlabel(spelling.text(chart.across))
    figure.axes[0].legend(loc="upper right")
    _write_titles(figure, chart, display)
    return figure


def _draw_bars(axes: Axes, kinds: Sequence[Bars], factor: float, spelling: FigureSpelling) -> None:
    positions = kinds[0].positions
    width = 0.76 / len(kinds) * float(positions[1] - positions[0] if len(positions) > 1 else 1.0)
    for number, one in enumerate(kinds):
        side = number - (len(kinds) - 1) / 2
        axes.bar(
            one.positions + side * width,
            factor * one.heights,
            width,
            color=_pen(one).colour,
            label=spelling.text(one.name),
        )
    axes.set_xticks(positions if len(positions) <= TICKS else positions[:: -(-len(positions) // TICKS)])
    if not any(one.heights.any() for one in kinds):
        axes.set_ylim(0.0, 1.0)


BAR = 0.24
"""Height of a bar beside its name [inch]."""


def named_bar_figure(chart: NamedBarChart, display: Display) -> Figure:
    """Bars that lie beside their names, those of each panel from the top."""
    spelling, words = FigureSpelling(display), PrintSpelling(display)
    factor, label, _unit = spelling.label(chart.across)
    heights = [BAR * len(panel.names) + 0.35 for panel in chart.panels]
    figure = Figure(figsize=(figure_width(), min(PAGE_HEIGHT, sum(heights) + 1.0)), layout="constrained")
    rows = figure.subplots(len(chart.panels), 1, sharex=True, height_ratios=heights, squeeze=False)[:, 0]
    for number, (axes, panel) in enumerate(zip(rows, chart.panels, strict=True)):
        places = np.arange(len(panel.names))
        axes.barh(places, factor * panel.lengths, 0.7, color=numbered_pen(number).colour)
        # names are plain text: a dollar sign in one is no formula
        axes.set_yticks(places, [words.text(name).replace("$", r"\$") for name in panel.names])
        axes.invert_yaxis()
        axes.axvline(0.0, color=INK, linewidth=THIN)
        axes.set_title(spelling.text(panel.label), loc="left", fontsize="medium")
        axes.xaxis.set_major_formatter(Decimals())
        axes.grid(visible=False, axis="y")
        axes.set_axisbelow(True)
    rows[-1].set_xlabel(label)
    _write_titles(figure, chart, display)
    return figure


def histogram_figure(chart: Histograms, display: Display) -> Figure:
    """Histograms below each other, with marked values."""
    words = PrintSpelling(display)
    names = [words.text(name) for panel in chart.panels for name, _value in panel.levels]
    above = legend_height(list(dict.fromkeys(names)), inches=BARS)
    height = 1.0 + (BARS + 0.5 + above) * len(chart.panels)
    figure = Figure(figsize=(figure_width(), min(PAGE_HEIGHT, height)), layout="constrained")
    rows = figure.subplots(len(chart.panels), 1, squeeze=False)[:, 0]
    for axes, panel in zip(rows, chart.panels, strict=True):
        _draw_histogram(axes, panel, display)
        axes.set_ylabel(words.text(chart.up))
        wrap_label(axes, BARS - 0.4)
    _write_titles(figure, chart, display)
    return figure


def _draw_histogram(axes: Axes, panel: HistogramPanel, display: Display) -> None:
    spelling, words = FigureSpelling(display), PrintSpelling(display)
    factor, label, _unit = spelling.label(panel.x)
    axes.stairs(panel.counts, factor * panel.edges, fill=True, color=numbered_pen(0).colour, alpha=0.6)
    key: dict[str, Artist] = {}
    for name, value in panel.levels:
        text = words.text(name)
        pen = numbered_pen(1 + list(dict.fromkeys([*key, text])).index(text))
        key[text] = axes.axvline(factor * value, color=pen.colour, linestyle=CENTRE_LINE)
    axes.set_ylim(bottom=0.0)
    axes.set_xlabel(label)
    axes.xaxis.set_major_formatter(Decimals())
    axes.set_axisbelow(True)
    write_legend(axes, [(line, text) for text, line in key.items()], inches=BARS)


def linkage_figure(drawing: LinkageWithDiscs, display: Display) -> Figure:
    """The linkage at a sample with its discs, whose names stand in a legend."""
    sample = drawing.sample
    scene = _wide_enough(scene_of(drawing.description, drawing.motion), drawing.discs, sample)
    size = scene.high - scene.low
    colours = pens(drawing.description.link_names)
    names = [PrintSpelling(display).text(one.name) for one in drawing.discs]
    beside = legend_width(names) if names else 0.0
    room = np.array([figure_width() - 0.9 - beside, MOST])
    scene = replace(scene, inches=float(np.min(room * scene.extent / size)))
    height = scene.inches * float(size[1]) / scene.extent
    figure = Figure(figsize=(figure_width(), height + 1.35 + legend_height(names)), layout="constrained")
    axes = figure.subplots()
    draw_mechanism(axes, scene, sample)
    key: list[tuple[Artist, str]] = []
    for one, name in zip(drawing.discs, names, strict=True):
        circle = _draw_disc(axes, scene, sample, one, colours[one.link].colour)
        key += [] if circle is None else [(circle, name)]
    write_legend(axes, key)
    axes.grid(visible=False)
    axes.set_xlabel(label_with_unit(formula("x"), str(display.length)))
    axes.set_ylabel(label_with_unit(formula("y"), str(display.length)))
    _write_titles(figure, drawing, display)
    return figure


def _reach(scene: LinkageScene, one: CarriedDisc) -> float:
    """Radius of the circle that is drawn: the disc's own, else a sign."""
    return 2.4 * scene.sign if one.radius is None else max(one.radius * scene.factor, 1.5 * scene.sign)


def _wide_enough(scene: LinkageScene, discs: Sequence[CarriedDisc], sample: int) -> LinkageScene:
    """The scene with corners that hold the discs too."""
    corners = [np.array([scene.low, scene.high])]
    for one in discs:
        at = scene.carried_places(one.link, one.place, sample)
        if at is not None:
            corners.append(np.array([at - _reach(scene, one), at + _reach(scene, one)]))
    low, high = box(corners)
    return replace(scene, low=low, high=high)


def _draw_disc(axes: Axes, scene: LinkageScene, sample: int, one: CarriedDisc, colour: str) -> Circle | None:
    """An arm from the base, and a filled circle; great discs lie behind the links."""
    at, base = scene.carried_places(one.link, one.place, sample), scene.at(sample).get(one.base)
    if at is None or base is None:
        return None
    axes.plot([base[0], at[0]], [base[1], at[1]], color=colour, linewidth=2.4, zorder=2.9)
    circle = Circle(
        (at[0], at[1]), _reach(scene, one), facecolor=colour, edgecolor=INK, linewidth=0.9, zorder=1.9
    )
    circle.set_alpha(0.55)
    axes.add_patch(circle)
    return circle


FRONT, CHOSEN, START, BOUND = PALETTE[0], PALETTE[1], INK, PALETTE[3]
HIGH, LOW = 2.8, 1.15
"""Inches of the panel of the front, and of each below it."""


def front_figure(diagram: FrontDiagram, display: Display) -> Figure:
    """Best designs over the bound that moves; the legend stands beside the first panel."""
    spelling, words = FigureSpelling(display), PrintSpelling(display)
    across, label, _unit = spelling.label(diagram.x)
    first, *below = diagram.panels
    names = [_("best designs"), *(words.text(dot.name) for dot in first.dots)]
    height = HIGH + LOW * len(below) + 0.9 + legend_height(names, inches=HIGH)
    figure = Figure(figsize=(figure_width(), min(PAGE_HEIGHT, height)), layout="constrained")
    rows = figure.subplots(
        len(diagram.panels), 1, sharex=True, height_ratios=[HIGH, *([LOW] * len(below))], squeeze=False
    )[:, 0]
    key: list[tuple[Artist, str]] = []
    for axes, panel in zip(rows, diagram.panels, strict=True):
        up, y_label, _unit = spelling.label(panel.label)
        marks = {"marker": "o", "markersize": 3.5} if panel is first else {}
        (line,) = axes.plot(
            across * diagram.values, up * panel.values, color=FRONT, label=_("best designs"), **marks
        )
        key.append((line, _("best designs")))
        if panel is first and diagram.bound is not None:
            bound = axes.axvline(across * diagram.bound, color=BOUND, linestyle=CENTRE_LINE, linewidth=THIN)
            key.append((bound, _("bound")))
        for level in panel.levels:
            axes.axhline(up * level, color=MUTED, linewidth=THIN, linestyle=DOTS)
        key += [(_dot(axes, dot, (across, up)), words.text(dot.name)) for dot in panel.dots]
        axes.set_ylabel(y_label)
        wrap_label(axes, HIGH if panel is first else LOW)
        axes.yaxis.set_major_formatter(Decimals())
        if panel is first:
            axes.xaxis.set_major_formatter(Decimals())
            write_legend(axes, key, inches=HIGH)
    rows[-1].set_xlabel(label)
    write_title(figure, spelling.text(diagram.title), words.text(diagram.mechanism))
    return figure


def _dot(axes: Axes, dot: DesignDot, factors: tuple[float, float]) -> Artist:
    """A design as its sign: empty where it misses a bound."""
    colour = CHOSEN if dot.chosen else START
    look: dict[str, Any] = {"color": colour, "marker": "D" if dot.chosen else "s"}
    look["markerfacecolor"] = colour if dot.admissible else "white"
    (drawn,) = axes.plot(
        [factors[0] * dot.x], [factors[1] * dot.y], linestyle="none", markersize=6, zorder=5, **look
    )
    return drawn
