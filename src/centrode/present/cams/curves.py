"""Figures of a cam: the roller's path about its centre, curves over the carrier's angle, what parts the routes."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from centrode.locale import _
from centrode.present.curves import (
    DrawnAbscissa,
    Panel,
    angle_ticks,
    legend_width,
    sheet,
    write_legend,
    write_title,
)
from centrode.present.displayed_units import formula, label_with_unit, shown_as
from centrode.present.style import DASHES, GROUND, INK, MUTED, PALETTE, Decimals, house_style, pens
from centrode.quantities import QUANTITIES

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


CURVES = ("path_radius", "cam_pressure_angle", "law_curvature")
RAYS = 15.0
"""Degrees between the rays of the path's figure."""

INCHES = 5.6
"""Length on paper of the longer side of the path."""

NORMAL = 0.5
"""Length of a drawn normal over rho."""

ROUNDING = 1e-17
"""Differences [m] below this are not drawn."""


def over_carrier(cam: AnyCam, dataset: xarray.Dataset) -> DrawnAbscissa:
    """The carrier's angle, in the unit of the display."""
    factor, unit = shown_as("rad", cam.display)
    phi = dataset["carrier_angle"].to_numpy() * factor
    order = np.argsort(phi, kind="stable")
    none = np.zeros(0, dtype=np.intp)
    quantity = QUANTITIES["carrier_angle"]
    label = label_with_unit(f"{quantity.title} {formula(quantity.symbol)}", unit)
    return DrawnAbscissa(phi[order], order, none, np.zeros(len(phi), dtype=bool), (), label, unit)


def cam_curves_figure(cam: AnyCam, dataset: xarray.Dataset) -> Figure:
    """Radius, pressure angle and curvature of a cam's path (`ct.cam`) over the carrier's angle."""
    with house_style():
        rows = []
        for variable in CURVES:
            quantity = QUANTITIES[variable]
            factor, unit = shown_as(quantity.unit, cam.display)
            values = factor * dataset[variable].to_numpy()
            curves = {quantity.title: values}
            text = label_with_unit(formula(quantity.symbol), unit)
            rows.append([Panel(text, unit, curves, pens(curves), legend=False)])
        figure = sheet(_("Path of the roller's centre"), _(cam.title), rows, over_carrier(cam, dataset))
        _mark_stall(figure.axes, cam, dataset)
        return figure


def _mark_stall(panels: list[Axes], cam: AnyCam, dataset: xarray.Dataset) -> None:
    stall = float(dataset.attrs["stall"])
    if not math.isfinite(stall):
        return
    factor, _unit = shown_as("rad", cam.display)
    for axes in panels:
        axes.axvline(stall * factor, color=INK, linewidth=0.9, linestyle=(0, (6, 2, 1.5, 2)))
    panels[0].annotate(
        _("stall"), (stall * factor, 1.0), xycoords=("data", "axes fraction"), xytext=(-4, -3),
        textcoords="offset points", ha="right", va="top", color=INK,
    )  # fmt: skip


def cam_path_figure(cam: AnyCam, dataset: xarray.Dataset) -> Figure:
    """The path of a cam's roller about its centre, with rays to it and the normals that the pressure angle is from."""
    with house_style():
        factor, unit = shown_as("m", cam.display)
        x, y = (factor * dataset["roller_centre"].sel(axis=axis).to_numpy() for axis in ("x", "y"))
        width, height = (float(np.nanmax([*one, 0.0]) - np.nanmin([*one, 0.0])) for one in (x, y))
        scale = INCHES / (max(width, height) or 1.0)
        figure = Figure(figsize=(scale * width + 4.2, max(scale * height + 1.5, 3.2)), layout="constrained")
        axes = figure.subplots()
        _draw_rays(axes, dataset, factor)
        (line,) = axes.plot(x, y, color=PALETTE[0], linewidth=2.0)
        handles: list[tuple[Artist, str]] = [
            (line, _("path of the roller's centre")),
            (Line2D([], [], color=MUTED, linewidth=0.7), _("ray from the cam's centre")),
            (Line2D([], [], color=PALETTE[1], linewidth=1.1), _("normal of the path")),
        ]
        axes.plot([0.0], [0.0], marker="+", markersize=11, color=INK, markeredgewidth=1.4)
        axes.set_aspect("equal")
        axes.margins(0.14)
        for axis, name in ((axes.xaxis, "x"), (axes.yaxis, "y")):
            axis.set_major_formatter(Decimals())
            axis.set_label_text(label_with_unit(formula(name), unit))
        write_legend(axes, handles)
        write_title(figure, _("Path of the roller's centre, and its normals"), _(cam.title))
        return figure


def _draw_rays(axes: Axes, dataset: xarray.Dataset, factor: float) -> None:
    """Rays from the cam's centre with their angles, and normals of the path: between them is the pressure angle."""
    phi = dataset["carrier_angle"].to_numpy()
    radius = factor * dataset["path_radius"].to_numpy()
    gamma = dataset["cam_pressure_angle"].to_numpy()
    known = np.isfinite(radius)
    if not known.any():
        return
    low, high = np.degrees(phi[known].min()), np.degrees(phi[known].max())
    greatest = float(radius[known].max())
    for degrees in np.arange(RAYS * math.ceil(low / RAYS - 1e-9), high + 1e-9, RAYS):
        if degrees >= low + 360.0 - 1e-9:
            break
        nearest = int(np.argmin(np.abs(np.degrees(phi) - degrees) + np.where(known, 0.0, np.inf)))
        if abs(np.degrees(phi[nearest]) - degrees) > RAYS / 4:
            continue
        turn, rho = phi[nearest], radius[nearest]
        ray = np.array([math.sin(turn), math.cos(turn)])
        normal = np.array([math.sin(turn - gamma[nearest]), math.cos(turn - gamma[nearest])])
        inwards = rho * ray - NORMAL * rho * normal
        x, y = (ray * (rho + 0.075 * greatest)).tolist()
        axes.plot(*zip((0.0, 0.0), rho * ray, strict=True), color=MUTED, linewidth=0.7)
        axes.plot(*zip(inwards, rho * ray, strict=True), color=PALETTE[1], linewidth=1.1)
        axes.text(
            x, y, f"{degrees:.0f}°".replace("-", "−"), color=GROUND, ha="center", va="center", fontsize=8
        )


def cam_routes_figure(cam: AnyCam, dataset: xarray.Dataset) -> Figure:
    """What parts the three routes to a cam's path (`ct.cam_routes`), on a logarithmic scale."""
    with house_style():
        factor, unit = shown_as("m", cam.display)
        abscissa = over_carrier(cam, dataset)
        figure = Figure(figsize=(8.6, 5.2), layout="constrained")
        axes = figure.subplots()
        words = {
            "parting": _("series: (16) less (15)"),
            "foretold_error": _("series: foretold by its next terms"),
            "series_error": _("series less steps"),
            "routes_difference": _("integrated less steps"),
        }
        kept = pens(words)
        handles = []
        for name, text in words.items():
            sizes = np.abs(dataset[name].to_numpy()[abscissa.order])
            shown = np.where(sizes > ROUNDING, factor * sizes, np.nan)
            pen = kept[name]
            (line,) = axes.plot(abscissa.values, shown, color=pen.colour, linestyle=pen.dashes)
            handles.append((line, text))
        axes.set_yscale("log")
        axes.set_ylim(bottom=factor * ROUNDING)
        axes.set_xlim(float(abscissa.values[0]), float(abscissa.values[-1]))
        angle_ticks(axes.xaxis, float(abscissa.values[0]), float(abscissa.values[-1]), abscissa.unit, 9)
        axes.set_xlabel(abscissa.label)
        axes.set_ylabel(label_with_unit(formula("|Δρ|").replace("ρ", r"\rho "), unit))
        _mark_circle(axes, cam, dataset)
        write_legend(axes, handles)
        title = _("Differences of the radius, series cut after {last}").format(
            last=f"$a_{{{int(dataset.attrs['terms'])}}}$"
        )
        write_title(figure, title, _(cam.title))
        return figure


def _mark_circle(axes: Axes, cam: AnyCam, dataset: xarray.Dataset) -> None:
    """Where the series ends to converge."""
    factor, _unit = shown_as("rad", cam.display)
    radius = float(dataset.attrs["radius_of_convergence"]) * factor
    low, high = axes.get_xlim()
    for place in (-radius, radius):
        if low < place < high:
            axes.axvline(place, color=INK, linewidth=0.9, linestyle=(0, (6, 2, 1.5, 2)))
            axes.annotate(
                _("circle of convergence"), (place, 0.34), xycoords=("data", "axes fraction"),
                xytext=(-4 if place > 0 else 12, 0), textcoords="offset points", rotation=90, ha="right", va="center",
                color=INK, fontsize=8.5,
            )  # fmt: skip


CAM_FIGURES: Mapping[str, tuple[str, Callable[[Any, xarray.Dataset], Figure]]] = {
    "cam-path": ("cam-path", cam_path_figure),
    "cam-curves": ("cam-path", cam_curves_figure),
    "cam-routes": ("cam-routes", cam_routes_figure),
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
