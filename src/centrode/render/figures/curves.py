"""Panels of curves over one abscissa: gaps stay gaps, cut-off parts are grey, events are marked."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, MultipleLocator
from numpy.typing import NDArray

from centrode.locale import _
from centrode.render.drawing.style import INK, MUTED, PALETTE, Decimals, Pen
from centrode.render.drawing.texts import plain
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
    values : (sample) [unit]
        In the order of time.
    order, breaks : (sample), (any)
        The samples in the order of time, and the places in it where a limit parts two samples.
    cut : (sample)
        True where the sample is cut off from the initial position.
    marks : tuple of (value, kind)
        Limits and change points within the range.
    label, unit : str
        Text of the axis, and its unit.
    """

    values: Array
    order: NDArray[np.intp]
    breaks: NDArray[np.intp]
    cut: NDArray[np.bool_]
    marks: tuple[tuple[float, EventKind], ...]
    label: str
    unit: str

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
    step = next(step for step in STEPS[unit] if (high - low) / step <= most)
    if high - low < 2 * step:
        return
    axis.set_major_locator(MultipleLocator(float(step)))
    if unit == "rad":
        axis.set_major_formatter(FuncFormatter(lambda value, _position: part_of_pi(value)))


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
WIDTH = 1.5
ROUNDING = 1e-9
PANEL_INCHES = 2.35
ENTRIES_PER_INCH = 4.9
CUT_DASHES = (0, (3, 2))
MARK_DASHES = {EventKind.LIMIT: (0, (6, 2, 1.5, 2)), EventKind.CHANGE_POINT: (0, (1, 1.5))}
WILD = 8.0  # a curve that runs to infinity at a limit is shown up to this many times its upper decile


@dataclass(frozen=True)
class Panel:
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
        Put the names at the right.
    """

    label: str
    unit: str
    curves: Mapping[str, Array]
    pens: Mapping[str, Pen]
    scale: float = 0.0
    legend: bool = True


def sheet(title: str, subtitle: str, rows: Sequence[Sequence[Panel]], abscissa: DrawnAbscissa) -> Figure:
    """A figure of panels in rows and columns, all over the same abscissa."""
    columns = max(map(len, rows))
    beside = [
        max(legend_width(list(panel.curves)) if panel.legend else 0.0 for panel in column)
        for column in zip(*rows, strict=True)
    ]
    width = sum(beside) + (6.6 if columns == 1 else 4.7 * columns)
    height = 1.2 + PANEL_INCHES * len(rows) + (1.0 if len(rows) == 1 else 0.0)
    figure = Figure(figsize=(width, height), layout="constrained")
    grid = figure.subplots(len(rows), columns, sharex=True, squeeze=False)
    told = False
    for row, (axes_row, panels) in enumerate(zip(grid, rows, strict=True)):
        for axes, panel in zip(axes_row, panels, strict=True):
            names = draw_panel(axes, panel, abscissa)
            extra = [] if told else draw_key(abscissa, panel)
            if panel.legend:
                write_legend(axes, names, extra)
                told = True
            if row == len(rows) - 1:
                axes.set_xlabel(abscissa.label)
    write_title(figure, title, subtitle)
    return figure


def write_title(figure: Figure, title: str, subtitle: str) -> None:
    """What the figure shows, and below it of which mechanism."""
    width = int(13 * figure.get_figwidth())
    figure.suptitle("\n".join([title, *textwrap.wrap(plain(subtitle), width)]), fontsize=11)


def draw_panel(axes: Axes, panel: Panel, abscissa: DrawnAbscissa) -> list[tuple[Line2D, str]]:
    """Draw the curves with their events; returns a handle and a name for each."""
    across = (abscissa.drawn, abscissa.drawn)
    widths = band_widths(panel)
    drawn = [
        (draw_parts(axes, across, abscissa.parts(curve), name, panel.pens[name], widths[name]), name)
        for name, curve in panel.curves.items()
    ]
    for value, kind in abscissa.marks:
        axes.axvline(value, color=INK, linewidth=0.9, linestyle=MARK_DASHES[kind], zorder=1.5)
    axes.set_ylabel(panel.label)
    axes.yaxis.set_major_formatter(Decimals())
    set_range(axes, panel, abscissa)
    if not any(np.isfinite(curve).any() for curve in panel.curves.values()):
        say_nothing_known(axes)
    return drawn


def band_widths(panel: Panel) -> dict[str, float]:
    """Widths of the curves: one that later curves cover entirely is wider, so that all of them show."""
    names = list(panel.curves)
    if len(names) > 2 * len(PALETTE):
        return dict.fromkeys(names, WIDTH)
    return {name: WIDTH + 1.2 * covers(panel, name, names[k + 1 :]) for k, name in enumerate(names)}


def covers(panel: Panel, name: str, later: Sequence[str]) -> int:
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
    axes: Axes, x: Parts, y: Parts, name: str, pen: Pen, width: float = WIDTH, level: float = 2.0
) -> Line2D:
    """A line: its regular part in its own pen, its cut-off part grey and dashed; returns the regular part."""
    if np.isfinite(y[1]).any():
        cut = f"{name} (" + _("cut off") + ")"
        axes.plot(
            x[1],
            y[1],
            color=MUTED,
            linestyle=CUT_DASHES,
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
        **lonely(y[0]),
    )
    return line


def lonely(values: Array) -> dict[str, Any]:
    """Dots for samples without neighbours, which a line alone would not show."""
    known = np.isfinite(values)
    alone = known & ~np.insert(known, 0, False)[:-1] & ~np.append(known, False)[1:]
    return (
        {"marker": "o", "markersize": 3.5, "markevery": np.flatnonzero(alone).tolist()} if alone.any() else {}
    )


def set_range(axes: Axes, panel: Panel, abscissa: DrawnAbscissa) -> None:
    """Limits of both axes: the whole motion across, what can be read up and down."""
    across = abscissa.values[np.isfinite(abscissa.values)]
    if across.size and across.max() > across.min():
        axes.set_xlim(float(across.min()), float(across.max()))
        angle_ticks(axes.xaxis, float(across.min()), float(across.max()), abscissa.unit, 9)
    heights = np.concatenate([np.empty(0), *panel.curves.values()])
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


def draw_key(abscissa: DrawnAbscissa, panel: Panel) -> list[tuple[Artist, str]]:
    """Entries of the legend for what is not a curve of its own."""
    kinds = {kind for _value, kind in abscissa.marks}
    words = {EventKind.LIMIT: _("limit"), EventKind.CHANGE_POINT: _("change point")}
    key: list[tuple[Artist, str]] = [
        (Line2D([], [], color=INK, linewidth=0.9, linestyle=MARK_DASHES[kind]), words[kind])
        for kind in EventKind
        if kind in kinds
    ]
    if any(np.isfinite(abscissa.parts(curve)[1]).any() for curve in panel.curves.values()):
        key.append((Line2D([], [], color=MUTED, linewidth=1.0, linestyle=CUT_DASHES), _("cut off")))
    return key


def write_legend(
    axes: Axes,
    names: Sequence[tuple[Artist, str]],
    extra: Sequence[tuple[Artist, str]] = (),
    inches: float = PANEL_INCHES,
) -> None:
    """The legend at the right of the axes, where it covers nothing, in as many columns as its height asks for."""
    entries = [*names, *extra]
    if entries:
        axes.legend(
            [handle for handle, _name in entries],
            [plain(name) for _handle, name in entries],
            loc="upper left",
            bbox_to_anchor=(1.01, 1.0),
            borderaxespad=0.0,
            handlelength=2.6,
            ncols=legend_columns(len(entries), inches),
        )


def legend_columns(entries: int, inches: float) -> int:
    """Columns of a legend that may be this high."""
    return -(-entries // max(1, int(ENTRIES_PER_INCH * inches)))


def legend_width(names: Sequence[str], inches: float = PANEL_INCHES) -> float:
    """Room [inch] for a legend of these names that may be this high, the events included."""
    texts = [*names, _("limit"), _("change point"), _("cut off")]
    return legend_columns(len(texts), inches) * (0.65 + 0.085 * max(map(len, texts)))
