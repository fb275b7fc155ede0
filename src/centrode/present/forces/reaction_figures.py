"""Figures of reactions: joint forces by magnitude, guides and wheels, drives, the frame."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from centrode.locale import _
from centrode.model.labels import reaction_name, side_name
from centrode.present.abscissa import main_abscissa
from centrode.present.curves import Panel, sheet
from centrode.present.shown import formula, labelled
from centrode.present.style import DASHES, INK, Pen, house_style, pens
from centrode.quantities import QUANTITIES
from centrode.study.forces.bearing_loads import mean_over_time
from centrode.views.motion_plots import deal_to_panels

if TYPE_CHECKING:
    import xarray

    from centrode.model.mechanism import Mechanism

Array = NDArray[np.float64]
Curves = dict[str, Array]
ALIKE = 1e-9
"""Magnitudes that differ by less than this share of the greatest are one curve."""
FORCES = (("guide_normal", "guide"), ("rolling_normal", "rolling"), ("rolling_tangential", "rolling"))


def reaction_figures(mechanism: Mechanism, dataset: xarray.Dataset) -> dict[str, Figure]:
    """Figures of reactions, by name.

    Parameters
    ----------
    mechanism : Mechanism
    dataset : Dataset
        Of `reactions`.

    Returns
    -------
    dict of name -> Figure
        "joint-forces" (magnitudes), on the sphere "joint-components" (x, y and z at the first link of each hinge) and
        "centre-forces" (magnitudes), "other-reactions" (guides, teeth, wheels), "balancing", "friction" (by
        coefficients: its power, the efficiency) and "frame-force" (all of it, and the part of inertia). What there is
        none of, or is not determined, is left out.
    """
    with house_style():
        abscissa = main_abscissa(mechanism, dataset)
        found = {
            "joint-forces": (_("Forces in the hinges"), _hinges(dataset)),
            "joint-components": (_("Forces in the hinges by components"), _components(dataset)),
            "centre-forces": (_("Forces of the centre of the sphere"), _centre(dataset)),
            "other-reactions": (_("Reactions of guides, gears and wheels"), _others(dataset)),
            "balancing": (_("What the drives must give"), _drives(dataset)),
            "friction": (_("What friction takes"), _friction(dataset)),
            "frame-force": (_("Force and moment on the frame"), _frame(dataset)),
        }
        return {
            name: sheet(title, _(mechanism.title), [[panel] for panel in panels], abscissa)
            for name, (title, panels) in found.items()
            if panels
        }


def _hinges(dataset: xarray.Dataset) -> list[Panel]:
    """Magnitudes at the hinges: one curve of a hinge whose sides are alike, else one of each side."""
    points, labels = dataset["side_point"].to_numpy(), dataset["side"].to_numpy()
    sizes = _magnitude(dataset["joint_force"])
    curves: Curves = {}
    for point in dict.fromkeys(points.tolist()):
        sides = np.flatnonzero(points == point)
        first = sizes[:, sides[0]]
        apart = np.abs(sizes[:, sides] - first[:, None])
        if np.nanmax(apart, initial=0.0) <= ALIKE * np.nanmax(first, initial=0.0):
            curves[point] = first
        else:
            curves |= {side_name(str(labels[k])): sizes[:, k] for k in sides}
    return _panels("joint_force", curves, split=True)


def _components(dataset: xarray.Dataset) -> list[Panel]:
    """On the sphere: components of the force on the first link of each hinge, a panel for each axis."""
    if "centre_force" not in dataset:
        return []
    points, labels = dataset["side_point"].to_numpy().tolist(), dataset["side"].to_numpy().tolist()
    first = [labels[points.index(point)] for point in dict.fromkeys(points)]
    panels = []
    for axis in dataset["axis"].to_numpy().tolist():
        values = dataset["joint_force"].sel(axis=axis)
        curves = {side_name(side): values.sel(side=side).to_numpy() for side in first}
        panels += _panels("joint_force", curves, split=True, along=axis)
    return panels


def _centre(dataset: xarray.Dataset) -> list[Panel]:
    """Magnitudes of what the centre of a sphere exerts; none in the plane, or where there is nothing but rounding."""
    if "centre_force" not in dataset:
        return []
    sizes = _magnitude(dataset["centre_force"])
    least = ALIKE * np.nanmax(_magnitude(dataset["joint_force"]), initial=0.0)
    names = dataset["held"].to_numpy().tolist()
    curves = {
        name: sizes[:, k] for k, name in enumerate(names) if np.nanmax(sizes[:, k], initial=0.0) > least
    }
    return _panels("centre_force", curves, split=True)


def _others(dataset: xarray.Dataset) -> list[Panel]:
    forces: Curves = {}
    for variable, dimension in FORCES:
        if variable in dataset:
            forces |= _named(dataset[variable], dimension, "" if variable == "guide_normal" else variable)
    panels = _panels("guide_normal" if "guide_normal" in dataset else "rolling_normal", forces)
    if "guide_moment" in dataset:
        moments = _named(dataset["guide_moment"], "guide", "")
        panels += _panels("guide_moment", {name: m for name, m in moments.items() if np.any(m)})
    if "tooth_force" in dataset:
        teeth = dataset["tooth_force"]
        sizes = _magnitude(teeth)
        panels += _panels("tooth_force", dict(zip(teeth["gear"].to_numpy().tolist(), sizes.T, strict=True)))
    return panels


def _named(values: xarray.DataArray, dimension: str, part: str) -> Curves:
    """Curves by their labels; with what they are in front where that is needed to tell them apart."""
    word = {"rolling_normal": _("normal"), "rolling_tangential": _("tangential")}.get(part, "")
    names = values[dimension].to_numpy().tolist()
    return {f"{name} {word}".rstrip(): values.sel({dimension: name}).to_numpy() for name in names}


def _drives(dataset: xarray.Dataset) -> list[Panel]:
    given = dataset["balancing"]
    units = str(given.attrs["units"]).split(", ")
    names = given["drive"].to_numpy().tolist()
    panels = []
    for unit in dict.fromkeys(units):
        of_unit = [name for k, name in enumerate(names) if units[k % len(units)] == unit]
        curves = {name: given.sel(drive=name).to_numpy() for name in of_unit}
        panels += [_with_mean(panel, dataset) for panel in _panels("balancing", curves, unit)]
    return panels


def _friction(dataset: xarray.Dataset) -> list[Panel]:
    """Power that friction takes at each contact, and the efficiency."""
    if "friction_power" not in dataset:
        return []
    power = dataset["friction_power"]
    powers = {}
    for label in power["friction"].to_numpy().tolist():
        powers[reaction_name(label)] = power.sel(friction=label).to_numpy()
    efficiency = {_("efficiency"): dataset["efficiency"].to_numpy()}
    return [*_panels("friction_power", powers), *_panels("efficiency", efficiency)]


def _with_mean(panel: Panel, dataset: xarray.Dataset) -> Panel:
    """A panel of one curve with its mean over time as a line across; of several it stays as it is."""
    if len(panel.curves) != 1:
        return panel
    (curve,) = panel.curves.values()
    mean, word = mean_over_time(dataset["time"].to_numpy(), curve)[0], _("mean")
    return replace(
        panel,
        curves={**panel.curves, word: np.where(np.isfinite(curve), mean, np.nan)},
        pens={**panel.pens, word: Pen(INK, DASHES[1])},
    )


def _frame(dataset: xarray.Dataset) -> list[Panel]:
    whole, inertia = _("all of it"), _("of inertia alone")
    forces = {whole: _magnitude(dataset["frame_force"]), inertia: _magnitude(dataset["shaking_force"])}
    moments = {whole: _size(dataset["frame_moment"]), inertia: _size(dataset["shaking_moment"])}
    return [*_panels("frame_force", forces), *_panels("frame_moment", moments)]


def _panels(
    variable: str, curves: Mapping[str, Array], unit: str = "", *, split: bool = False, along: str = ""
) -> list[Panel]:
    """One panel of the curves that have numbers, or as many as keep them apart; `along` names an axis."""
    known = {name: curve for name, curve in curves.items() if np.isfinite(curve).any()}
    quantity, drawn = QUANTITIES[variable], pens(known)
    # a drive along a guide or of a cylinder gives a force
    symbol = "F_b" if (variable, unit) == ("balancing", "N") else quantity.symbol
    text = labelled(formula(symbol, along), unit or quantity.unit)
    groups: Sequence[Sequence[str]] = deal_to_panels(known) if split else [list(known)]
    return [
        Panel(
            text,
            unit or quantity.unit,
            {name: known[name] for name in names},
            {name: drawn[name] for name in names},
        )
        for names in groups
        if names
    ]


def _size(moment: xarray.DataArray) -> Array:
    """A moment of the plane with its sign, one of the sphere by its magnitude."""
    return _magnitude(moment) if "axis" in moment.dims else moment.to_numpy()


def _magnitude(values: xarray.DataArray) -> Array:
    return np.asarray(np.hypot.reduce(values.transpose(..., "axis").to_numpy(), axis=-1))
