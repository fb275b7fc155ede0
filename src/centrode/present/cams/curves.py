"""Figures of a cam over its angle."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from centrode.locale import _
from centrode.present.curves import (
    angle_ticks,
    write_title,
)
from centrode.present.displayed_units import formula, label_with_unit, shown_as
from centrode.present.style import GROUND, INK, MUTED, PALETTE, Decimals, house_style
from centrode.quantities import QUANTITIES

if TYPE_CHECKING:
    from centrode.model.cam_files import AnyCam
    from centrode.model.follower_cam import PlateCam
    from centrode.present.scene import Array

# Pressure angle and radius of curvature of a profile under a follower, over the angle of the cam.

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
        grid[-1].set_xlabel(label_with_unit(_("angle of the cam") + " " + formula("φ"), unit))
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
        values = _cut_at(values, SHOWN * factor * float(dataset.attrs["base_radius"]))
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
    axes.set_ylabel(label_with_unit(formula(quantity.symbol), unit))
    axes.yaxis.set_major_formatter(Decimals())
    axes.margins(y=0.1)


def _cut_at(values: Array, most: float) -> Array:
    """Values up to a size; beyond it a gap, as between opposite signs of a radius that passes infinity."""
    return np.where(np.abs(values) <= most, values, math.nan)


CAM_FIGURES: Mapping[str, tuple[str, Callable[[Any, xarray.Dataset], Figure]]] = {
    "cam-curvature": ("cam-profile", plate_curves_figure),
}
"""Figures of a cam's results: name of the file -> name of the dataset, and what draws it."""


def cam_figures(cam: AnyCam, datasets: Mapping[str, xarray.Dataset]) -> dict[str, Figure]:
    """Figures of a cam by name, of those datasets that are there."""
    return {
        name: draw(cam, datasets[source])
        for name, (source, draw) in CAM_FIGURES.items()
        if source in datasets and (name != "cam-curvature" or "segments" in type(cam).model_fields)
    }
