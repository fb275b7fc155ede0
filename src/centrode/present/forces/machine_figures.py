"""The figures of a machine in steady motion: moments, works, energies, Wittenbauer's diagram, speed, real motion."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
import xarray
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from centrode.locale import _
from centrode.present.abscissa import Abscissa
from centrode.present.curves import Panel, sheet, write_legend, write_title
from centrode.present.panels import Motion, Rows, of_links, of_points
from centrode.present.shown import formula, labelled, shown_as
from centrode.present.style import DASHES, INK, PALETTE, Decimals, Pen, house_style, pens
from centrode.quantities import QUANTITIES

if TYPE_CHECKING:
    from centrode.model.mechanism import Mechanism

Array = NDArray[np.float64]
INCHES = 4.6


def machine_figures(mechanism: Mechanism, dataset: xarray.Dataset) -> dict[str, Figure]:
    """Figures of a steady motion, by name.

    Parameters
    ----------
    mechanism : Mechanism
    dataset : Dataset
        What `steady_motion` returns.

    Returns
    -------
    dict of name -> Figure
        "moments", "works", "energies", "wittenbauer" (where a fluctuation is asked for), "drive-speed",
        "real-angular-velocities", "real-angular-accelerations", "real-velocities", "real-accelerations".
    """
    with house_style():
        over = over_turned(mechanism, dataset)
        kept = {"link": pens(mechanism.link_names), "point": pens(mechanism.moving_points)}
        motion = Motion(mechanism, dataset, over, kept)
        figures = {
            name: sheet(title, _(mechanism.title), rows, over)
            for name, (title, rows) in _sheets(motion).items()
            if any(panel.curves for row in rows for panel in row)
        }
        if "tangent_slopes" in dataset.attrs:
            figures["wittenbauer"] = _wittenbauer(mechanism, dataset)
    return figures


def over_turned(mechanism: Mechanism, dataset: xarray.Dataset) -> Abscissa:
    """The angle turned in the cycle."""
    factor, unit = shown_as("rad", mechanism.display)
    quantity = QUANTITIES["turned"]
    values = factor * dataset["turned"].to_numpy()
    return Abscissa(
        values,
        np.arange(len(values)),
        np.array([], dtype=np.intp),
        np.zeros(len(values), dtype=bool),
        (),
        labelled(f"{quantity.title} {formula(quantity.symbol)}", unit),
        unit,
    )


def _sheets(motion: Motion) -> dict[str, tuple[str, Rows]]:
    return {
        "moments": (
            _("Moments on the drive and inertia of the links"),
            [
                [_panel(motion, ("moment_of_loads", "driving_moment"), "M")],
                [_panel(motion, ("inertia_of_links",), "J_II")],
                [_panel(motion, ("inertia_slope_of_links",), "J_II′")],
            ],
        ),
        "works": (
            _("Works over the cycle"),
            [[_panel(motion, ("work_of_drive", "work_of_loads", "work"), "A")]],
        ),
        "energies": (
            _("Energies over the cycle"),
            [[_panel(motion, ("work", "energy_of_links", "energy_change"), "T")]],
        ),
        "drive-speed": (
            _("Speed and acceleration of the drive"),
            [
                [_panel(motion, ("drive_speed", "drive_speed_first_order"), "ω")],
                [_panel(motion, ("drive_acceleration", "drive_acceleration_first_order"), "ε")],
            ],
        ),
        "real-angular-velocities": (
            _("Real angular velocities of the links"),
            of_links(motion, "angular_velocity"),
        ),
        "real-angular-accelerations": (
            _("Real angular accelerations of the links"),
            of_links(motion, "angular_acceleration"),
        ),
        "real-velocities": (_("Real velocities of the points"), of_points(motion, "velocity")),
        "real-accelerations": (_("Real accelerations of the points"), of_points(motion, "acceleration")),
    }


def _panel(motion: Motion, variables: Sequence[str], symbol: str) -> Panel:
    """Curves of several variables of one unit, by their titles."""
    factor, unit = shown_as(QUANTITIES[variables[0]].unit, motion.mechanism.display)
    curves = {QUANTITIES[name].title: factor * motion.dataset[name].to_numpy() for name in variables}
    scale = max(float(np.max(np.abs(curve), initial=0.0)) for curve in curves.values())
    first_order = {QUANTITIES[name].title for name in variables if name.endswith("_first_order")}
    drawn = {
        name: Pen(pen.colour, DASHES[1]) if name in first_order else pen for name, pen in pens(curves).items()
    }
    return Panel(labelled(_symbol(symbol), unit), unit, curves, drawn, scale)


def _symbol(symbol: str) -> str:
    """A symbol whose letters behind "_" stand below."""
    base, _sign, index = symbol.partition("_")
    prime = "′" if index.endswith("′") else ""
    return formula(base + prime, rf"\mathrm{{{index.rstrip('′')}}}" if index else "")


def _wittenbauer(mechanism: Mechanism, dataset: xarray.Dataset) -> Figure:
    """Work over the inertia of the links, with the tangents of the least and the greatest speed."""
    inertia = dataset["inertia_of_links"].to_numpy()
    work = (dataset["energy_change"] + dataset["energy_of_links"]).to_numpy()
    figure = Figure(figsize=(9.6, INCHES + 1.2), layout="constrained")
    axes = figure.subplots()
    (curve,) = axes.plot(inertia, work, color=PALETTE[0])
    reach = np.array([0.0, 1.08 * float(inertia.max())])
    key: list[tuple[Artist, str]] = [(curve, _("work of drive and loads"))]
    names = {"lower": _("tangent of the least speed"), "upper": _("tangent of the greatest speed")}
    for number, name in enumerate(names):
        slope, start = (dataset.attrs[f"tangent_{what}"][number] for what in ("slopes", "intercepts"))
        (line,) = axes.plot(reach, start + slope * reach, color=PALETTE[1 + number], linewidth=1.2)
        told = _("{name}, slope {slope:.5g} rad²/s²").format(name=names[name], slope=slope)
        key.append((line, told))
        place = _touching(dataset, number)
        axes.plot([place[0]], [place[1]], "o", color=PALETTE[1 + number], markersize=5)
    key.append(_ordinates(axes, dataset.attrs))
    axes.set_xlim(float(reach[0]), float(reach[1]))
    axes.set_xlabel(labelled(_symbol("J_II"), "kg m^2"))
    axes.set_ylabel(labelled(formula("A"), "J"))
    axes.yaxis.set_major_formatter(Decimals())
    write_legend(axes, key, inches=INCHES)
    write_title(figure, _("Wittenbauer's diagram: work over the inertia of the links"), _(mechanism.title))
    return figure


def _touching(dataset: xarray.Dataset, number: int) -> tuple[float, float]:
    """Where a tangent touches the diagram: its place at the nearest sample, on the line."""
    turned = dataset["turned"].to_numpy()
    at = dataset.attrs["tangents_touch_at"][number]
    inertia = float(np.interp(at, turned, dataset["inertia_of_links"].to_numpy()))
    return (
        inertia,
        dataset.attrs["tangent_intercepts"][number] + dataset.attrs["tangent_slopes"][number] * inertia,
    )


def _ordinates(axes: Axes, attributes: Mapping[str, Sequence[float]]) -> tuple[Artist, str]:
    """The segment that the tangents cut off from the axis of works: over the difference of slopes it is J_I."""
    low, high = attributes["tangent_intercepts"]
    least, greatest = attributes["tangent_slopes"]
    text = _("{length:.5g} J between them; over {slopes:.5g} rad²/s²\nit is J = {inertia:.6g} kg m²").format(
        length=high - low, slopes=greatest - least, inertia=(high - low) / (greatest - least)
    )
    (segment,) = axes.plot([0.0, 0.0], [low, high], color=INK, linewidth=3.0, clip_on=False)
    return segment, text
