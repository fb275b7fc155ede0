"""Figures of a cam over its angle."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from centrode.locale import _
from centrode.present.curves import (
    angle_ticks,
    legend_width,
    write_legend,
    write_title,
)
from centrode.present.displayed_units import formula, label_with_unit, shown_as
from centrode.present.style import DASHES, INK, PALETTE, Decimals, house_style

if TYPE_CHECKING:
    from centrode.model.cam_files import AnyCam
    from centrode.present.scene import Array


# Contact stress of a cam over the angle of the carrier, with what the roller leans on.

HIGH, LOW = 3.6, 2.0
"""Inches of the panel of stresses, and of that of lengths."""
MEGA = 1e-6


def contact_figure(cam: AnyCam, contact: xarray.Dataset) -> Figure:
    """Stress by both formulas with its greatest value, shear, half width and depth of the strip.

    Parameters
    ----------
    cam : Cam
    contact : Dataset
        Of `cam_contact`.
    """
    with house_style():
        names = [_("greatest shear below the contact"), _("depth of the greatest shear")]
        width = 6.6 + legend_width([*names, _("by the source's formula (0.418)")], LOW)
        figure = Figure(figsize=(width, HIGH + LOW + 1.4), layout="constrained")
        upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=[HIGH, LOW])
        factor, unit = shown_as("rad", cam.display)
        phi = factor * contact["carrier_angle"].to_numpy()
        _draw_stress(upper, contact, phi, factor, unit)
        _draw_strip(lower, contact, phi)
        lower.set_xlabel(label_with_unit(_("angle of the carrier") + " " + formula("φ"), unit))
        angle_ticks(lower.xaxis, float(phi[0]), float(phi[-1]), unit, 12)
        lower.set_xlim(phi[0], phi[-1])
        write_title(figure, _("Contact of roller and cam"), _(cam.title))
    return figure


def _draw_stress(axes: Axes, contact: xarray.Dataset, phi: Array, factor: float, unit: str) -> None:
    stress, source, shear = (
        MEGA * contact[name].to_numpy()
        for name in ("contact_stress", "contact_stress_by_source", "contact_shear")
    )
    key: list[tuple[Artist, str]] = []
    (line,) = axes.plot(phi, stress, color=PALETTE[0], linewidth=2.6)
    key.append((line, _("greatest pressure (Hertz)")))
    (line,) = axes.plot(phi, source, color=PALETTE[1], linestyle=DASHES[1])
    key.append((line, _("by the source's formula (0.418)")))
    (line,) = axes.plot(phi, shear, color=PALETTE[2])
    key.append((line, _("greatest shear below the contact")))
    admissible = contact.attrs.get("admissible_stress")
    if admissible is not None:
        line = axes.axhline(MEGA * admissible, color=PALETTE[3], linestyle="--", linewidth=1.2)
        key.append((line, _("admissible stress")))
    greatest, at = MEGA * contact.attrs["greatest_stress"], factor * contact.attrs["greatest_stress_at"]
    if np.isfinite(greatest):
        told = _("{stress:.5g} MPa at {angle:.5g} {unit}").format(stress=greatest, angle=at, unit=unit)
        (dot,) = axes.plot([at], [greatest], "o", color=INK, markersize=5, clip_on=False, zorder=5)
        key.append((dot, told))
    axes.set_ylim(bottom=0)
    axes.set_ylabel(label_with_unit(formula("σ") + ", " + formula("τ"), "MPa"))
    axes.yaxis.set_major_formatter(Decimals())
    write_legend(axes, key, inches=HIGH)


def _draw_strip(axes: Axes, contact: xarray.Dataset, phi: Array) -> None:
    """Half width and depth, which are fractions of a millimetre whatever the cam's unit."""
    key: list[tuple[Artist, str]] = []
    names = {
        "contact_half_width": _("half width of the strip"),
        "contact_depth": _("depth of the greatest shear"),
    }
    for number, (name, told) in enumerate(names.items()):
        (line,) = axes.plot(phi, 1e3 * contact[name].to_numpy(), color=PALETTE[4 + number])
        key.append((line, told))
    axes.set_ylim(bottom=0)
    axes.set_ylabel(label_with_unit(formula("a") + ", " + formula("z"), "mm"))
    axes.yaxis.set_major_formatter(Decimals())
    write_legend(axes, key, inches=LOW)


CAM_FIGURES: Mapping[str, tuple[str, Callable[[Any, xarray.Dataset], Figure]]] = {
    "cam-contact": ("cam-contact", contact_figure),
}
"""Figures of a cam's results: name of the file -> name of the dataset, and what draws it."""


def cam_figures(cam: AnyCam, datasets: Mapping[str, xarray.Dataset]) -> dict[str, Figure]:
    """Figures of a cam by name, of those datasets that are there."""
    return {
        name: draw(cam, datasets[source])
        for name, (source, draw) in CAM_FIGURES.items()
        if source in datasets and (name != "cam-curvature" or "segments" in type(cam).model_fields)
    }
