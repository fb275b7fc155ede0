"""Pressure angle and radius of curvature of a profile under a follower, over the angle of the cam."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from centrode.locale import _
from centrode.present.abscissa import angle_ticks
from centrode.present.curves import write_title
from centrode.present.shown import formula, labelled, shown_as
from centrode.present.style import GROUND, INK, MUTED, PALETTE, Decimals, house_style
from centrode.quantities import QUANTITIES

if TYPE_CHECKING:
    import xarray

    from centrode.model.follower_cam import PlateCam
    from centrode.present.scene import Array

WIDTH, PANEL = 7.6, 2.4
"""Inches of the figure, and of the height of each panel."""
SHOWN = 4.0
"""Radii of curvature are shown up to so many base radii: where the profile is straight they are infinite."""
BOUND = (0, (6, 2, 1.5, 2))


def plate_curves_figure(cam: PlateCam, dataset: xarray.Dataset) -> Figure:
    """Pressure angle and radius of curvature of a cam's profile (`ct.cam_profile`), with what is admissible."""
    with house_style():
        steep, bend = cam.bounds.pressure_angle, cam.bounds.curvature_radius
        back = cam.bounds.return_pressure_angle or steep
        rows = [("profile_bend", [bend])]
        if "face_place" in dataset:
            rows.append(("face_place", []))
        if cam.follower.contact != "flat" or cam.follower.kind == "oscillating":
            rows.insert(0, ("cam_pressure_angle", [steep, None if back is None else -back]))
        figure = Figure(figsize=(WIDTH, 1.3 + PANEL * len(rows)), layout="constrained")
        grid = figure.subplots(len(rows), 1, sharex=True, squeeze=False)[:, 0]
        factor, unit = shown_as("rad", cam.display)
        phi = factor * dataset["cam_angle"].to_numpy()
        for axes, (name, bounds) in zip(grid, rows, strict=True):
            _panel(axes, cam, dataset, name, [one for one in bounds if one is not None], phi)
        grid[-1].set_xlabel(labelled(_("angle of the cam") + " " + formula("φ"), unit))
        grid[-1].set_xlim(float(phi[0]), float(phi[-1]))
        angle_ticks(grid[-1].xaxis, float(phi[0]), float(phi[-1]), unit, 12)
        write_title(figure, _("Pressure angle and curvature of the cam"), _(cam.title))
        return figure


def _panel(
    axes: Axes, cam: PlateCam, dataset: xarray.Dataset, name: str, bounds: list[float], phi: Array
) -> None:
    quantity = QUANTITIES[name]
    factor, unit = shown_as(quantity.unit, cam.display)
    values = factor * dataset[name].to_numpy()
    if name == "profile_bend":
        values = _bounded(values, SHOWN * factor * float(dataset.attrs["base_radius"]))
    axes.plot(phi, values, color=PALETTE[0])
    for bound in bounds:
        axes.axhline(factor * bound, color=PALETTE[1], linewidth=0.9, linestyle=BOUND)
        axes.annotate(
            _("admissible"), (1.0, factor * bound), xycoords=("axes fraction", "data"), xytext=(-4, 2),
            textcoords="offset points", ha="right", va="bottom", color=GROUND, fontsize=8.5,
        )  # fmt: skip
    if name != "face_place" or np.nanmin(values) < 0.0:
        axes.axhline(0.0, color=INK, linewidth=0.6, zorder=1)
    turn, _unit = shown_as("rad", cam.display)
    ends = turn * np.cumsum([one.angle for one in cam.segments])[:-1]
    for end in ends:
        axes.axvline(float(end), color=MUTED, linewidth=0.6, zorder=1.6)
    axes.set_title(quantity.title, fontsize=9.5)
    axes.set_ylabel(labelled(formula(quantity.symbol), unit))
    axes.yaxis.set_major_formatter(Decimals())
    axes.margins(y=0.1)


def _bounded(values: Array, most: float) -> Array:
    """Values up to a size; beyond it a gap, as between opposite signs of a radius that passes infinity."""
    return np.where(np.abs(values) <= most, values, math.nan)
