"""Panels of curves over one abscissa: gaps stay gaps, cut-off parts are grey, events are marked."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, Locator, MultipleLocator
from numpy.typing import NDArray

from centrode.locale import _
from centrode.render.drawing.figure_room import PAGE_HEIGHT, count_across, figure_width
from centrode.render.drawing.style import (
    CENTRE_LINE,
    CURVE,
    CUT,
    DOTS,
    INK,
    JUMP,
    LABEL,
    LETTER,
    MUTED,
    NAME,
    PALETTE,
    SMALL,
    THIN,
    TITLE,
    Decimals,
    Pen,
    marker_options,
)
from centrode.render.drawing.texts import plain
from centrode.render.figures.grid_layout import GridLayout
from centrode.render.figures.interpolation import interpolated_curve, jumps
from centrode.sheets.plots import EventKind

Array = NDArray[np.float64]
STEPS = {
    "deg": (1, 2, 5, 10, 15, 30, 45, 90, 180, 360, 720, 1440, 3600),
    "rad": tuple(np.pi * part for part in (1 / 12, 1 / 6, 1 / 4, 1 / 2, 1, 2, 4, 8, 20)),
}


@dataclass(frozen=True)
class DrawnAbscissa:
    """The horizontal axis of curves.

    Attributes
    ----------
    values : (place) [unit]
        In the order of time.
    order, breaks : (place), (any)
        The samples in the order of time, and the places in it where a limit parts two samples.
    cut : (sample)
        True where the sample is cut off from the initial position.
    marks : tuple of (value, kind)
        Limits and change points within the range.
    label, unit : str
        Text of the axis, and its unit.
    ends : (first, last) or None
        Where the axis begins and ends; at the extreme values if None.
    """

    values: Array
    order: NDArray[np.intp]
    breaks: NDArray[np.intp]
    cut: NDArray[np.bool_]
    marks: tuple[tuple[float, EventKind], ...]
    label: str
    unit: str
    ends: tuple[float, float] | None = None

    @property
    def range(self) -> tuple[float, float] | None:
        """The least and the greatest value that the axis shows; None where nothing lies between."""
        known = [*self.values[np.isfinite(self.values)].tolist(), *(self.ends or ())]
        return (min(known), max(known)) if known and max(known) > min(known) else None

    def parts(self, curve: Array) -> tuple[Array, Array]:
        """A curve in drawing order, as its regular and its cut-off part; a gap parts what must not be joined."""
        ordered, cut = curve[self.order], self.cut[self.order]
        regular, beyond = np.where(cut, np.nan, ordered), np.where(cut, ordered, np.nan)
        return np.insert(regular, self.breaks, np.nan), np.insert(beyond, self.breaks, np.nan)

    @property
    def drawn(self) -> Array:
        """The values with the gaps of `parts` put in."""
        return np.insert(self.values, self.breaks, np.nan)


def angle_ticks(axis: Axis, low: float, high: float, unit: str, most: int) -> None:
    """Ticks at round angles: multiples of 15, 30, 45, 90 degrees, or of parts of pi; others stay as they are."""
    if unit not in STEPS or not high > low or high - low > most * STEPS[unit][-1]:
        return
    steps = [step for step in STEPS[unit] if (high - low) / step <= most]
    if high - low < 2 * steps[0]:
        return
    axis.set_major_locator(RoundAngles(steps, low, high))
    if unit == "rad":
        axis.set_major_formatter(FuncFormatter(lambda value, _position: part_of_pi(value)))


class RoundAngles(Locator):
    """Ticks at multiples of a round angle: the least of some steps whose numbers have room along the axis.

    Parameters
    ----------
    steps : ascending
    low, high : range of the curves
    """

    def __init__(self, steps: Sequence[float], low: float, high: float) -> None:
        self.steps, self.low, self.high = steps, low, high

    def __call__(self) -> Any:
        own: Any = self.axis
        return self.tick_values(*sorted(own.get_view_interval()))

    def tick_values(self, vmin: float, vmax: float) -> Any:
        """The ticks of a view."""
        own: Any = self.axis
        # matplotlib gives a number twice its height: one and a third is enough, and round angles are few
        room = 1.5 * own.get_tick_space()
        chosen = self.steps[0]
        for step in self.steps:
            # one tick alone says nothing of the scale
            if np.floor(self.high / step) - np.ceil(self.low / step) < 1:
                break
            chosen = step
            if (self.high - self.low) / step <= room:
                break
        return MultipleLocator(float(chosen)).tick_values(vmin, vmax)


def part_of_pi(value: float) -> str:
    """An angle in radians as a part of pi: "3π/2" for 4.712..."""
    part = Fraction(value / np.pi).limit_denominator(12)
    if part == 0:
        return "0"
    above = "" if abs(part.numerator) == 1 else str(abs(part.numerator))
    below = "" if part.denominator == 1 else f"/{part.denominator}"
    sign = "−" if part < 0 else ""
    return f"{sign}{above}π{below}"


Parts = tuple[Array, Array]  # regular, cut off
ROUNDING = 1e-9
PANEL_INCHES, LONE_INCHES = 1.85, 2.6
"""Height of a panel of several, and of one alone."""
ABOVE_INCHES = 0.75
"""Height of the title and of the label of the abscissa."""
ENTRY_INCHES = 0.163
"""Height of an entry of a legend."""
BESIDE_INCHES = 1.75
"""A wider legend stands above its axes."""
TICKS = 9
"""The most ticks of an angle, over the width of the figure."""
KEY_INCHES = 0.55
"""Width of what a legend has beside the text of an entry."""
MARK_DASHES = {EventKind.LIMIT: CENTRE_LINE, EventKind.CHANGE_POINT: DOTS}
WILD = 8.0  # a curve that runs to infinity at a limit is shown up to this many times its upper decile


@dataclass(frozen=True)
class QuantityCurves:
    """Curves of one quantity.

    Attributes
    ----------
    label, unit : str
        Text of the vertical axis; the unit of the curves, for round ticks of angles.
    curves : mapping of name -> (sample)
        In shown units, in the dataset's order; NaN is a gap.
    pens : mapping of name -> Pen
        How each curve is drawn.
    scale : float
        What counts as a great value; parts in 10^9 of it are rounding, and no axis is stretched to show them.
    legend : bool
        Put the names beside the panel, or above it.
    slopes : mapping of name -> (sample)
        Derivatives of curves by the abscissa, in shown units, where they are known.
    areas : names of areas, for which the legend needs room too
    """

    label: str
    unit: str
    curves: Mapping[str, Array]
    pens: Mapping[str, Pen]
    scale: float = 0.0
    legend: bool = True
    slopes: Mapping[str, Array] = field(default_factory=dict)
    areas: Sequence[str] = ()


def sheet(
    title: str, subtitle: str, rows: Sequence[Sequence[QuantityCurves]], abscissa: DrawnAbscissa
) -> Figure:
    """A figure of panels in rows and columns, all over the same abscissa."""
    columns = max(map(len, rows))
    width = figure_width() / columns
    # all legends of a figure stand on the same side
    beside = all(
        stands_beside(with_events([*panel.curves, *panel.areas]), PANEL_INCHES, width)
        for panels in rows
        for panel in panels
        if panel.legend
    )
    above = [
        0.0
        if beside
        else max(_height([*panel.curves, *panel.areas], width) if panel.legend else 0.0 for panel in panels)
        for panels in rows
    ]
    each = LONE_INCHES if len(rows) == 1 else PANEL_INCHES
    height = min(PAGE_HEIGHT, ABOVE_INCHES + each * len(rows) + sum(above))
    figure = Figure(figsize=(figure_width(), height), layout=GridLayout())
    grid = figure.subplots(len(rows), columns, sharex=True, squeeze=False)
    told = False
    for row, (axes_row, panels) in enumerate(zip(grid, rows, strict=True)):
        for axes, panel in zip(axes_row, panels, strict=True):
            names = draw_panel(axes, panel, abscissa)
            extra = [] if told else draw_key(abscissa, panel)
            if panel.legend:
                write_legend(axes, names, extra, columns=columns, beside=beside)
                told = True
            wrap_label(axes, each)
            if row == len(rows) - 1:
                axes.set_xlabel(abscissa.label)
    write_title(figure, title, subtitle)
    return figure


def write_title(figure: Figure, title: str, subtitle: str) -> None:
    """What the figure shows, and below it of which mechanism."""
    room = figure.get_figwidth() / LETTER
    size = max(SMALL, min(TITLE, room / max(len(title), 1)))
    lines = [title, *textwrap.wrap(plain(subtitle), int(room / size))]
    figure.suptitle("\n".join(lines), fontsize=size)


def _draw_curve(
    axes: Axes, panel: QuantityCurves, abscissa: DrawnAbscissa, name: str, width: float
) -> Line2D:
    """A curve through its samples; a jump is dashed."""
    parts, pen, across = abscissa.parts(panel.curves[name]), panel.pens[name], abscissa.drawn
    slopes = abscissa.parts(panel.slopes[name]) if name in panel.slopes else (None, None)
    leaps = jumps(across, parts[0])
    for k in leaps:
        axes.plot(
            across[k : k + 2],
            parts[0][k : k + 2],
            color=pen.colour,
            linestyle=JUMP,
            linewidth=THIN,
            zorder=1.9,
        )
    places, heights = np.insert(across, leaps + 1, np.nan), np.insert(parts[0], leaps + 1, np.nan)
    known = None if slopes[0] is None else np.insert(slopes[0], leaps + 1, np.nan)
    regular, beyond = (
        interpolated_curve(places, heights, known),
        interpolated_curve(across, parts[1], slopes[1]),
    )
    return draw_parts(axes, (regular[0], beyond[0]), (regular[1], beyond[1]), name, pen, width)


def wrap_label(axes: Axes, inches: float) -> None:
    """Wrap the label of the vertical axis where it is longer than axes so high; formulas stay whole."""
    label, room = axes.get_ylabel(), int(inches / (LABEL * LETTER))
    if len(label) > room and "$" not in label:
        axes.set_ylabel(
            textwrap.fill(label.replace(", ", ",\N{NO-BREAK SPACE}"), room, break_long_words=False)
        )


def draw_panel(axes: Axes, panel: QuantityCurves, abscissa: DrawnAbscissa) -> list[tuple[Line2D, str]]:
    """Draw the curves with their events; returns a handle and a name for each."""
    widths = band_widths(panel)
    drawn = [(_draw_curve(axes, panel, abscissa, name, widths[name]), name) for name in panel.curves]
    for value, kind in abscissa.marks:
        axes.axvline(value, color=INK, linewidth=THIN, linestyle=MARK_DASHES[kind], zorder=1.5)
    axes.set_ylabel(panel.label)
    axes.yaxis.set_major_formatter(Decimals())
    set_range(axes, panel, abscissa)
    if not any(np.isfinite(curve).any() for curve in panel.curves.values()):
        say_nothing_known(axes)
    return drawn


def band_widths(panel: QuantityCurves) -> dict[str, float]:
    """Widths of the curves: one that later curves cover entirely is wider, so that all of them show."""
    names = list(panel.curves)
    if len(names) > 2 * len(PALETTE):
        return dict.fromkeys(names, CURVE)
    return {name: CURVE + 1.2 * covers(panel, name, names[k + 1 :]) for k, name in enumerate(names)}


def covers(panel: QuantityCurves, name: str, later: Sequence[str]) -> int:
    """How many of the later curves coincide with a curve to the width of a line."""
    curve = panel.curves[name]
    known = curve[np.isfinite(curve)]
    if known.size < 2:
        return 0
    slack = max(ROUNDING * panel.scale, 1e-3 * float(np.ptp(known)))
    return sum(
        np.allclose(curve, panel.curves[other], rtol=0.0, atol=slack, equal_nan=True) for other in later
    )


def draw_parts(
    axes: Axes, x: Parts, y: Parts, name: str, pen: Pen, width: float = CURVE, level: float = 2.0
) -> Line2D:
    """A line: its regular part in its own pen, its cut-off part grey and dashed; returns the regular part."""
    if np.isfinite(y[1]).any():
        cut = f"{name} (" + _("cut off") + ")"
        axes.plot(
            x[1],
            y[1],
            color=MUTED,
            linestyle=CUT,
            linewidth=1.0,
            label=cut,
            zorder=level,
            **lonely(y[1]),
        )
    (line,) = axes.plot(
        x[0],
        y[0],
        color=pen.colour,
        linestyle=pen.dashes,
        linewidth=width,
        label=name,
        zorder=level,
        **marker_options(pen) | lonely(y[0]),
    )
    return line


def lonely(values: Array) -> dict[str, Any]:
    """Dots for samples without neighbours, which a line alone would not show."""
    known = np.isfinite(values)
    alone = known & ~np.insert(known, 0, False)[:-1] & ~np.append(known, False)[1:]
    return (
        {"marker": "o", "markersize": 3.5, "markevery": np.flatnonzero(alone).tolist()} if alone.any() else {}
    )


def set_range(axes: Axes, panel: QuantityCurves, abscissa: DrawnAbscissa) -> None:
    """Limits of both axes: the whole motion across, what can be read up and down."""
    if abscissa.range is not None:
        axes.set_xlim(abscissa.range)
        place = axes.get_subplotspec()
        most = count_across(TICKS) // (1 if place is None else place.get_gridspec().ncols)
        angle_ticks(axes.xaxis, *abscissa.range, abscissa.unit, most)
    heights = np.concatenate([np.empty(0), *(curve[abscissa.order] for curve in panel.curves.values())])
    heights = heights[np.isfinite(heights)]
    if not heights.size:
        return
    low, high = readable(heights, any(kind is EventKind.LIMIT for _value, kind in abscissa.marks))
    greatest = max(abs(low), abs(high))
    if greatest <= ROUNDING * panel.scale:
        low, high = -panel.scale or -1.0, panel.scale or 1.0
    elif high - low < 1e-6 * greatest:
        low, high = low - 0.05 * greatest, high + 0.05 * greatest
    room = 0.05 * (high - low)
    axes.set_ylim(low - room, high + room)
    angle_ticks(axes.yaxis, low, high, panel.unit, 6)


def readable(heights: Array, wild: bool) -> tuple[float, float]:
    """The range of the heights; what runs to infinity at a limit is left outside."""
    low, high = float(heights.min()), float(heights.max())
    if not wild:
        return low, high
    usual = WILD * float(np.quantile(np.abs(heights), 0.9))
    return (max(low, -usual), min(high, usual)) if usual > 0 else (low, high)


def say_nothing_known(axes: Axes) -> None:
    """A sentence instead of an empty panel."""
    axes.text(
        0.5,
        0.5,
        _("no sample has a value here"),
        transform=axes.transAxes,
        ha="center",
        va="center",
        color=MUTED,
    )


def draw_key(abscissa: DrawnAbscissa, panel: QuantityCurves) -> list[tuple[Artist, str]]:
    """Entries of the legend for what is not a curve of its own."""
    kinds = {kind for _value, kind in abscissa.marks}
    words = {EventKind.LIMIT: _("limit"), EventKind.CHANGE_POINT: _("change point")}
    key: list[tuple[Artist, str]] = [
        (Line2D([], [], color=INK, linewidth=THIN, linestyle=MARK_DASHES[kind]), words[kind])
        for kind in EventKind
        if kind in kinds
    ]
    if any(np.isfinite(abscissa.parts(curve)[1]).any() for curve in panel.curves.values()):
        key.append((Line2D([], [], color=MUTED, linewidth=1.0, linestyle=CUT), _("cut off")))
    return key


def write_legend(
    axes: Axes,
    names: Sequence[tuple[Artist, str]],
    extra: Sequence[tuple[Artist, str]] = (),
    inches: float = PANEL_INCHES,
    columns: int = 1,
    beside: bool | None = None,
) -> None:
    """The legend where it covers nothing: at the right of the axes, or above them where it is wide.

    Parameters
    ----------
    inches : height that the legend may have beside the axes
    columns : axes beside each other that share the width of the figure
    beside : where it stands; chosen by the names if None
    """
    entries = [*names, *extra]
    if not entries:
        return
    texts = [name for _handle, name in entries]
    figure = axes.get_figure(root=True)
    assert figure is not None
    width = figure.get_figwidth() / columns
    if stands_beside(texts, inches, width) if beside is None else beside:
        look: dict[str, Any] = {"loc": "upper left", "bbox_to_anchor": (1.01, 1.0)}
        look |= {"ncols": legend_columns(len(texts), inches), "borderaxespad": 0.0}
    else:
        look = {"loc": "lower left", "bbox_to_anchor": (0.0, 1.0), "borderaxespad": 0.25}
        look |= {"ncols": columns_above(texts, width)}
        texts = [textwrap.fill(text, letters_above(width)) for text in texts]
        # the common factor of the ticks ("×10⁴") stands there too
        axes.yaxis.get_offset_text().set_horizontalalignment("right")
        if axes.get_title():
            axes.set_title(axes.get_title(), pad=4.0 + 72.0 * _height(texts, width))
    handles = [handle for handle, _name in entries]
    axes.legend(
        handles, list(map(plain, texts)), handlelength=2.2, columnspacing=1.2, labelspacing=0.3, **look
    )


def stands_beside(names: Sequence[str], inches: float, width: float) -> bool:
    """Whether a legend of these names is narrow enough to stand beside axes in a part of a figure so wide."""
    each = KEY_INCHES + NAME * LETTER * max(map(len, names))
    return legend_columns(len(names), inches) * each <= min(BESIDE_INCHES, 0.45 * width)


def legend_columns(entries: int, inches: float) -> int:
    """Columns of a legend that may be this high."""
    return -(-entries // max(1, int(inches / ENTRY_INCHES)))


def columns_above(names: Sequence[str], width: float) -> int:
    """Columns of a legend above axes."""
    each = KEY_INCHES + NAME * LETTER * max(map(len, names))
    return max(1, min(len(names), int((width - 0.6) / each)))


def letters_above(width: float) -> int:
    """Letters in a line of a legend above axes."""
    return max(12, int((width - 0.6 - KEY_INCHES) / (NAME * LETTER)))


def _height(names: Sequence[str], width: float) -> float:
    """Height [inch] of a legend above axes."""
    lines = max((len(textwrap.wrap(name, letters_above(width))) for name in names), default=1)
    return 0.08 + ENTRY_INCHES * lines * -(-len(names) // columns_above(names, width))


def with_events(names: Sequence[str]) -> list[str]:
    """What a legend may have: the names, and the events."""
    return [*names, _("limit"), _("change point"), _("cut off")]


def legend_height(names: Sequence[str], width: float | None = None, inches: float = PANEL_INCHES) -> float:
    """Room [inch] that a legend of these names needs above its axes; none where it stands beside them."""
    texts, room = with_events(names), figure_width() if width is None else width
    return 0.0 if stands_beside(texts, inches, room) else _height(names or texts, room)


def legend_width(names: Sequence[str], inches: float = PANEL_INCHES, width: float | None = None) -> float:
    """Room [inch] that a legend of these names needs beside its axes; none where it stands above them."""
    texts = with_events(names)
    if not stands_beside(texts, inches, figure_width() if width is None else width):
        return 0.0
    return legend_columns(len(texts), inches) * column_width(texts)


def column_width(names: Sequence[str]) -> float:
    """Width [inch] of a legend whose names stand below each other."""
    return KEY_INCHES + NAME * LETTER * max(map(len, names))
