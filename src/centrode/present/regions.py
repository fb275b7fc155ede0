"""The reachable region of two drives as a picture, with the path that the drives take through it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from numpy.typing import NDArray

from centrode.errors import Status
from centrode.locale import _
from centrode.present.abscissa import angle_ticks, text_of_drive
from centrode.present.curves import CUT_DASHES, legend_width, write_legend, write_title
from centrode.present.shown import labelled, shown_as
from centrode.present.style import INK, MUTED, PALETTE, Decimals, house_style

if TYPE_CHECKING:
    import xarray

    from centrode.model.mechanism import Mechanism

Array = NDArray[np.float64]
REACHED, CUT_OFF = "#CFE3F2", "#E4E4E4"
INCHES = 5.2
TURN = 2 * np.pi


def region_figure(
    mechanism: Mechanism, region: xarray.Dataset, motion: xarray.Dataset | None = None
) -> Figure:
    """The region of two drives that is reached from the initial position.

    Parameters
    ----------
    mechanism : Mechanism
    region : Dataset
        Of `reachable_region`.
    motion : Dataset, optional
        Its motion: the path that the drives take in time is drawn over the region, whole turns taken out where the
        region is a turn wide.
    """
    with house_style():
        names = [
            _("reached"),
            _("closes, but cut off"),
            _("path of the drives in time"),
            _("initial position"),
        ]
        wide, high = _inches(region)
        figure = Figure(figsize=(wide + 0.9 + legend_width(names, high), high + 1.3), layout="constrained")
        axes = figure.subplots()
        key = _fill(axes, mechanism, region)
        if motion is not None:
            key += _path(axes, mechanism, region, motion)
        key += _start(axes, mechanism, region)
        _frame(axes, mechanism, region)
        write_legend(axes, key, inches=high)
        write_title(figure, _("Reachable region of two drives"), _(mechanism.title))
    return figure


def _inches(region: xarray.Dataset) -> tuple[float, float]:
    """Width and height of the axes: of angles in their proportions, otherwise square."""
    if region["first"].attrs["units"] != region["second"].attrs["units"]:
        return INCHES, INCHES
    first, second = (float(np.ptp(region[name].to_numpy())) for name in ("first", "second"))
    longer = max(first, second)
    return max(INCHES * first / longer, 2.0), max(INCHES * second / longer, 2.0)


def _factor(mechanism: Mechanism, region: xarray.Dataset, name: str) -> tuple[float, str]:
    return shown_as(str(region[name].attrs["units"]), mechanism.display)


def _shown(mechanism: Mechanism, region: xarray.Dataset) -> tuple[Array, Array]:
    """Values of both drives at the grid lines as they are shown."""
    first, second = (
        _factor(mechanism, region, name)[0] * region[name].to_numpy() for name in ("first", "second")
    )
    return first, second


def _fill(axes: Axes, mechanism: Mechanism, region: xarray.Dataset) -> list[tuple[Artist, str]]:
    """What is reached and what is cut off, each with its border."""
    x, y = _shown(mechanism, region)
    status, margin = region["status"].to_numpy(), region["margin"].to_numpy()
    key: list[tuple[Artist, str]] = []
    for kind, colour, name in (
        (Status.CUT_OFF, CUT_OFF, _("closes, but cut off")),
        (Status.OK, REACHED, _("reached")),
    ):
        if not (status == kind).any():
            continue
        level = _level(status, margin, kind)
        if level.min() < 0.0:
            axes.contourf(x, y, level.T, levels=[0.0, 2.0], colors=[colour], zorder=1.2)
            axes.contour(x, y, level.T, levels=[0.0], colors=[INK], linewidths=1.1, zorder=1.4)
        else:
            axes.axvspan(x[0], x[-1], facecolor=colour, zorder=1.2)
        key.insert(0, (Patch(facecolor=colour, edgecolor=INK), name))
    return key


def _level(status: NDArray[np.int8], margin: Array, kind: Status) -> Array:
    """A number that is positive where a status is and passes through zero at the limits around it."""
    size = np.nan_to_num(np.abs(margin), nan=1.0)
    inside = status == kind
    # between two parts of different status, both closed, the border lies half way
    return np.where(inside, np.maximum(size, 1e-12), -size - 1e-300)


def _path(
    axes: Axes, mechanism: Mechanism, region: xarray.Dataset, motion: xarray.Dataset
) -> list[tuple[Artist, str]]:
    """The path of the drives in time; dashed where the mechanism does not get."""
    x, y = (
        _wrapped(mechanism, region, name, motion["drive_value"].sel(drive=drive).to_numpy())
        for name, drive in zip(("first", "second"), region["drive"].to_numpy(), strict=True)
    )
    ok = motion["status"].to_numpy() == Status.OK
    jump = np.flatnonzero(
        (np.abs(np.diff(x)) > 0.5 * TURN * _factor(mechanism, region, "first")[0])
        | (np.abs(np.diff(y)) > 0.5 * TURN * _factor(mechanism, region, "second")[0])
    )
    key: list[tuple[Artist, str]] = []
    for regular, dashes, colour, name in (
        (ok, "-", PALETTE[1], _("path of the drives in time")),
        (~ok, CUT_DASHES, MUTED, _("path that is not reached")),
    ):
        if not regular.any():
            continue
        shown = [np.insert(np.where(regular, values, np.nan), jump + 1, np.nan) for values in (x, y)]
        (line,) = axes.plot(*shown, color=colour, linestyle=dashes, linewidth=1.5, zorder=2.5)
        key.append((line, name))
    return key


def _wrapped(mechanism: Mechanism, region: xarray.Dataset, name: str, values: Array) -> Array:
    """Values of a drive as they are shown; whole turns are taken out where the region is a turn wide."""
    ends = region[name].to_numpy()[[0, -1]]
    number = 0 if name == "first" else 1
    drive = next(one for one in mechanism.drives if one.id == region["drive"].to_numpy()[number])
    if drive.kind == "angle" and ends[1] - ends[0] >= TURN * (1 - 1e-9):
        values = values - TURN * np.floor((values - ends[0]) / TURN)
    return np.asarray(_factor(mechanism, region, name)[0] * values)


def _start(axes: Axes, mechanism: Mechanism, region: xarray.Dataset) -> list[tuple[Artist, str]]:
    """The initial position."""
    x, y = (
        _factor(mechanism, region, name)[0] * float(region["initial_value"][number])
        for number, name in enumerate(("first", "second"))
    )
    axes.plot([x], [y], marker="o", markersize=6, color=INK, markerfacecolor="white", zorder=3.0)
    handle = Line2D([], [], linestyle="none", marker="o", markersize=6, color=INK, markerfacecolor="white")
    return [(handle, _("initial position"))]


def _frame(axes: Axes, mechanism: Mechanism, region: xarray.Dataset) -> None:
    """Limits, ticks and texts of both axes."""
    x, y = _shown(mechanism, region)
    axes.set_xlim(float(x[0]), float(x[-1]))
    axes.set_ylim(float(y[0]), float(y[-1]))
    for name, shown, axis in (("first", x, axes.xaxis), ("second", y, axes.yaxis)):
        unit = _factor(mechanism, region, name)[1]
        axis.set_major_formatter(Decimals())
        angle_ticks(axis, float(shown[0]), float(shown[-1]), unit, 9)
        drive = region["drive"].to_numpy()[0 if name == "first" else 1]
        text = text_of_drive(mechanism.motion_parameter.drive(str(drive)))
        axis.set_label_text(labelled(text, unit))
