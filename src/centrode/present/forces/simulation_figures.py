"""The figures of a simulation: speed and moments over time, the speed over the drive's value, energies and works."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
import xarray
from matplotlib.figure import Figure
from numpy.typing import NDArray

from centrode.locale import _
from centrode.present.abscissa import Abscissa
from centrode.present.curves import Panel, sheet
from centrode.present.shown import formula, labelled, plain, shown_as
from centrode.present.style import house_style, pens
from centrode.quantities import QUANTITIES

if TYPE_CHECKING:
    from centrode.model.mechanism import Mechanism

Array = NDArray[np.float64]
TURN = 2.0 * np.pi


def simulation_figures(mechanism: Mechanism, dataset: xarray.Dataset) -> dict[str, Figure]:
    """Figures of a simulation, by name.

    Parameters
    ----------
    mechanism : Mechanism
    dataset : Dataset
        What `simulate` returns.

    Returns
    -------
    dict of name -> Figure
        "simulation-speed" (speed, acceleration and moments over time), "simulation-phase" (the speed over the
        drive's value, turn upon turn), "simulation-energies" (energies and works over time, and what is left over).
    """
    with house_style():
        time = _over(dataset, dataset["time"].to_numpy(), _time_label(), "s")
        sheets: dict[str, tuple[str, list[tuple[str, ...]], Abscissa]] = {
            "simulation-speed": (
                _("Speed of the drive and what moves it"),
                [("drive_speed",), ("drive_acceleration",), ("driving_moment", "moment_of_loads")],
                time,
            ),
            "simulation-phase": (
                _("Speed over the value of the drive"),
                [("drive_speed",)],
                _phase(mechanism, dataset),
            ),
            "simulation-energies": (
                _("Energies and works"),
                [
                    ("kinetic_energy", "potential_energy"),
                    ("work_of_drive", "work_of_friction", "work_of_other_loads"),
                    ("energy_residual",),
                ],
                time,
            ),
        }
        return {
            name: sheet(title, _(mechanism.title), [[_panel(mechanism, dataset, of)] for of in panels], over)
            for name, (title, panels, over) in sheets.items()
        }


def _time_label() -> str:
    return labelled(f"{QUANTITIES['time'].title} {formula('t')}", "s")


def _over(
    dataset: xarray.Dataset, values: Array, label: str, unit: str, breaks: NDArray[np.intp] | None = None
) -> Abscissa:
    count = dataset.sizes["sample"]
    none = np.array([], dtype=np.intp)
    parted = none if breaks is None else breaks
    return Abscissa(values, np.arange(count), parted, np.zeros(count, dtype=bool), (), label, unit)


def _phase(mechanism: Mechanism, dataset: xarray.Dataset) -> Abscissa:
    """The drive's value; of one that turns on and on within one turn, with gaps where a new one begins."""
    values = dataset["drive_value"].to_numpy()[:, 0]
    factor, unit = shown_as(mechanism.motion_parameter.drives[0].unit, mechanism.display)
    quantity = QUANTITIES["drive_value"]
    label = labelled(f"{quantity.title} {formula(quantity.symbol)}", unit)
    breaks: NDArray[np.intp] | None = None
    if mechanism.motion_parameter.turns and np.ptp(values) > TURN:
        turn = np.floor(values / TURN)
        values, breaks = values - TURN * turn, np.flatnonzero(np.diff(turn)) + 1
    return _over(dataset, factor * values, label, unit, breaks)


def _panel(mechanism: Mechanism, dataset: xarray.Dataset, variables: Sequence[str]) -> Panel:
    """Curves of several variables of one unit, by their titles."""
    factor, unit = shown_as(str(dataset[variables[0]].attrs["units"]), mechanism.display)
    curves = {QUANTITIES[name].title: factor * dataset[name].to_numpy() for name in variables}
    scale = max(float(np.max(np.abs(curve), initial=0.0)) for curve in curves.values())
    symbol = QUANTITIES[variables[0]].symbol.partition("_")[0]
    return Panel(labelled(plain(symbol), unit), unit, curves, pens(curves), scale, legend=True)
