"""Figures of masses and loads reduced to the drives: the whole, and the share of every link and load."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from centrode.locale import _
from centrode.model.labels import load_name
from centrode.present.abscissa import main_abscissa
from centrode.present.curves import Panel, sheet
from centrode.present.shown import formula, labelled, plain
from centrode.present.style import DASHES, INK, PALETTE, Pen, house_style, pens
from centrode.quantities import QUANTITIES

if TYPE_CHECKING:
    import xarray

    from centrode.model.mechanism import Mechanism

Array = NDArray[np.float64]
MOST = 11
"""Curves in one panel, besides the sum; of more, the greatest are drawn."""
HIDDEN = 0.05
"""Parts below this share of the greatest get a panel of their own."""


def reduction_figures(mechanism: Mechanism, dataset: xarray.Dataset) -> dict[str, Figure]:
    """Figures of a reduction, by name.

    Parameters
    ----------
    mechanism : Mechanism
    dataset : Dataset
        Of `reduce`.

    Returns
    -------
    dict of name -> Figure
        "reduced-inertia" (with its derivative) and "reduced-moment", each with its parts; with several drives
        "inertia-matrix" and "generalised-forces". What has no masses or no loads is left out.
    """
    with house_style():
        abscissa = main_abscissa(mechanism, dataset)
        if "reduced_inertia" in dataset:
            found = _of_one_drive(mechanism, dataset)
        else:
            found = _of_several(mechanism, dataset)
        return {
            name: sheet(title, _(mechanism.title), [[panel] for panel in panels], abscissa)
            for name, (title, panels) in found.items()
            if any(panel.curves for panel in panels)
        }


def _of_one_drive(mechanism: Mechanism, dataset: xarray.Dataset) -> dict[str, tuple[str, list[Panel]]]:
    moment = _parts(mechanism, dataset, "reduced_moment", "load")
    inertia = [
        _parts(mechanism, dataset, name, "link") for name in ("reduced_inertia", "reduced_inertia_slope")
    ]
    return {
        "reduced-inertia": (_("Reduced moment of inertia and its derivative"), inertia),
        "reduced-moment": (_("Reduced moment of the loads"), [moment, *_small(moment)]),
    }


def _parts(mechanism: Mechanism, dataset: xarray.Dataset, name: str, dimension: str) -> Panel:
    """The parts of a quantity along links or loads, and their sum."""
    parts = dataset[f"{name}_part"]
    labels = [str(label) for label in parts[dimension].to_numpy()]
    names = [load_name(mechanism, label) if dimension == "load" else label for label in labels]
    curves = {
        name: parts.sel({dimension: label}).to_numpy() for name, label in zip(names, labels, strict=True)
    }
    return _panel(name, str(parts.attrs["units"]), curves, dataset[name].to_numpy())


def _of_several(mechanism: Mechanism, dataset: xarray.Dataset) -> dict[str, tuple[str, list[Panel]]]:
    drives = [str(name) for name in dataset["drive"].to_numpy()]
    forces, matrix = dataset["generalised_force_part"], dataset["inertia_matrix"]
    units = str(forces.attrs["units"]).split(", ")
    panels = []
    for number, drive in enumerate(drives):
        chosen = forces.isel(drive=number)
        labels = [str(label) for label in forces["load"].to_numpy()]
        curves = {load_name(mechanism, label): chosen.sel(load=label).to_numpy() for label in labels}
        total = dataset["generalised_force"].isel(drive=number).to_numpy()
        panels.append(_panel("generalised_force", units[number % len(units)], curves, total, drive))
    pairs = [(i, j) for i in range(len(drives)) for j in range(i, len(drives))]
    elements = {f"{drives[i]}, {drives[j]}": matrix.isel(drive=i, drive_2=j).to_numpy() for i, j in pairs}
    masses = dataset.sizes["link"] > 0
    unit = str(matrix.attrs["units"])
    shown = unit if "," not in unit else ""
    label = labelled(formula(QUANTITIES["inertia_matrix"].symbol), shown)
    return {
        "inertia-matrix": (
            _("Elements of the inertia matrix"),
            [Panel(label, shown, elements if masses else {}, pens(elements))],
        ),
        "generalised-forces": (_("Generalised forces of the loads"), panels),
    }


def _panel(name: str, unit: str, curves: Mapping[str, Array], total: Array, by: str = "") -> Panel:
    """Curves of parts under a black one of their sum; a single part is its own sum."""
    kept = _greatest(curves)
    of_parts = _pens(kept)
    # any name may stand here, so not as a subscript of a formula
    text = f"{formula(QUANTITIES[name].symbol)} {plain(by)}".rstrip()
    label = labelled(text, unit)
    if len(curves) < 2:
        return Panel(label, unit, kept, of_parts)
    whole = _("sum")
    return Panel(label, unit, {**kept, whole: total}, {**of_parts, whole: Pen(INK)})


def _small(panel: Panel) -> list[Panel]:
    """A panel of the parts that the scale of the greatest hides; none where there are none, or nothing else."""
    parts = {name: curve for name, curve in panel.curves.items() if name != _("sum")}
    reach = {name: _reach(curve) for name, curve in parts.items()}
    small = {
        name: curve
        for name, curve in parts.items()
        if 0 < reach[name] < HIDDEN * max(reach.values(), default=0.0)
    }
    return (
        [Panel(panel.label, panel.unit, small, {name: panel.pens[name] for name in small})] if small else []
    )


def _pens(names: Iterable[str]) -> dict[str, Pen]:
    """A pen for each part; black is the sum's."""
    colours = [colour for colour in PALETTE if colour != "#000000"]
    return {
        name: Pen(colours[k % len(colours)], DASHES[k // len(colours) % len(DASHES)])
        for k, name in enumerate(names)
    }


def _greatest(curves: Mapping[str, Array]) -> dict[str, Array]:
    """The curves that reach farthest, in their own order."""
    kept = sorted(curves, key=lambda name: _reach(curves[name]), reverse=True)[:MOST]
    return {name: curves[name] for name in curves if name in kept}


def _reach(curve: Array) -> float:
    known = curve[np.isfinite(curve)]
    return float(np.max(np.abs(known), initial=0.0))
