"""Figures of a follower's motion: lift and derivatives over a turn, laws of motion beside each other."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from centrode.locale import _
from centrode.present.abscissa import angle_ticks
from centrode.present.curves import legend_width, write_legend, write_title
from centrode.present.shown import formula, labelled, shown_as
from centrode.present.style import GROUND, INK, MUTED, PALETTE, Decimals, house_style, pens
from centrode.quantities import QUANTITIES

if TYPE_CHECKING:
    import xarray

    from centrode.model.cam_files import AnyCam

Array = NDArray[np.float64]
WIDTH, PANEL = 7.6, 1.75
"""Inches of the motion's figure, and of the height of each panel."""
LETTER = 0.085
"""Inches of a letter of a curve's name."""
JUMP = (0, (2, 1.5))
ROUNDING = 1e-9
"""Share of the greatest value below which a jump is not drawn."""


def cam_motion_figure(cam: AnyCam, dataset: xarray.Dataset) -> Figure:
    """Lift, velocity, acceleration and jerk of a cam's follower (`ct.cam`) over a turn; in time if there is a speed."""
    with house_style():
        front = "swing" if "swing" in dataset else "lift"
        timed = "speed" in dataset.attrs
        ends = ("", "_velocity", "_acceleration", "_jerk") if timed else ("", "_slope", "_second", "_third")
        figure = Figure(figsize=(WIDTH, 1.4 + PANEL * len(ends)), layout="constrained")
        grid = figure.subplots(len(ends), 1, sharex=True)
        factor, unit = shown_as("rad", cam.display)
        for order, (axes, end) in enumerate(zip(grid, ends, strict=True)):
            rate = dataset.attrs["speed"] ** order if timed else 1.0
            _draw_order(axes, cam, dataset, front + end, order, rate, factor)
        _name_segments(grid[0], dataset, factor)
        grid[-1].set_xlabel(labelled(_("angle of the cam") + " " + formula("φ"), unit))
        last = float(dataset["joint_angle"][-1]) * factor
        angle_ticks(grid[-1].xaxis, 0.0, last, unit, 12)
        grid[-1].set_xlim(0.0, last)
        write_title(figure, _("Motion of the follower"), _(cam.title))
        return figure


def _draw_order(
    axes: Axes, cam: AnyCam, dataset: xarray.Dataset, name: str, order: int, rate: float, turn: float
) -> None:
    """One derivative, segment by segment, so that a jump is drawn as one."""
    quantity = QUANTITIES[name]
    factor, unit = shown_as(quantity.unit, cam.display)
    phi = turn * dataset["drawn_angle"].to_numpy()
    values = factor * rate * dataset["drawn_motion"].to_numpy()[:, order]
    for part in np.split(np.arange(len(phi)), 1 + np.flatnonzero(np.diff(phi) == 0.0)):
        axes.plot(phi[part], values[part], color=PALETTE[0])
    places = turn * dataset["joint_angle"].to_numpy()
    before, after = (
        factor * rate * dataset[f"joint_{side}"].to_numpy()[:, order] for side in ("before", "after")
    )
    size = float(np.abs(values).max())
    for place, down, up in zip([0.0, *places], [before[-1], *before], [after[-1], *after], strict=True):
        if abs(up - down) > ROUNDING * size:
            at_end = place in (0.0, places[-1])
            axes.plot([place] * 2, [down, up], color=PALETTE[1], linestyle=JUMP, clip_on=not at_end)
        axes.axvline(place, color=MUTED, linewidth=0.6, zorder=1)
    axes.axhline(0.0, color=INK, linewidth=0.6, zorder=1)
    axes.set_ylabel(labelled(formula(quantity.symbol), unit))
    axes.yaxis.set_major_formatter(Decimals())
    axes.margins(y=0.08)


def _name_segments(axes: Axes, dataset: xarray.Dataset, turn: float) -> None:
    """The curve of each segment above it, its number where there is no room."""
    ends = turn * np.array([0.0, *dataset["joint_angle"].to_numpy()])
    room = (WIDTH - 1.1) / (ends[-1] - ends[0])
    curves = str(dataset.attrs["curves"]).split(", ")
    for number, (curve, low, high) in enumerate(zip(curves, ends[:-1], ends[1:], strict=True)):
        name = _(curve)
        text = name if LETTER * len(name) < room * (high - low) else str(number + 1)
        axes.annotate(
            text, (0.5 * (low + high), 1.0), xycoords=("data", "axes fraction"), xytext=(0, 3),
            textcoords="offset points", ha="center", va="bottom", color=GROUND, fontsize=8.5,
        )  # fmt: skip


def laws_figure(dataset: xarray.Dataset, title: str = "") -> Figure:
    """Laws of motion beside each other (`ct.cam_laws`, `ct.compare_laws`): lift and derivatives over the rise."""
    with house_style():
        names = dataset["law"].to_numpy().tolist()
        shown = {name: _(name) for name in names}
        symbols = ("s/h", r"v\,\beta/h", r"a\,\beta^2/h", r"j\,\beta^3/h")
        width = 6.6 + legend_width(list(shown.values()))
        figure = Figure(figsize=(width, 1.4 + 1.9 * len(symbols)), layout="constrained")
        grid = figure.subplots(len(symbols), 1, sharex=True)
        share, kept = dataset["share"].to_numpy(), pens(names)
        handles: list[tuple[Any, str]] = []
        for order, (axes, symbol) in enumerate(zip(grid, symbols, strict=True)):
            for name in names:
                values = dataset["rise_share"].sel(law=name, derivative=order).to_numpy()
                axes.plot(share, values, color=kept[name].colour, linestyle=kept[name].dashes)
            axes.axhline(0.0, color=INK, linewidth=0.6, zorder=1)
            axes.set_ylabel(f"${symbol}$")
            axes.yaxis.set_major_formatter(Decimals())
        for name in names:
            handles.append(
                (Line2D([], [], color=kept[name].colour, linestyle=kept[name].dashes), shown[name])
            )
        grid[-1].set_xlim(0.0, 1.0)
        grid[-1].set_xlabel(_("share of the angle") + r" $\varphi/\beta$")
        write_legend(grid[0], handles)
        write_title(figure, _("Laws of motion for one rise"), title)
        return figure
