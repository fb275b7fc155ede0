"""Curves of transmission and pressure angles over a motion."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure

from centrode.locale import _
from centrode.present.abscissa import main_abscissa
from centrode.present.curves import Panel, sheet
from centrode.present.shown import formula, labelled
from centrode.present.style import house_style, pens
from centrode.quantities import QUANTITIES

if TYPE_CHECKING:
    import xarray

    from centrode.model.mechanism import Mechanism

VARIABLES = ("transmission_angle", "pressure_angle")


def transmission_figure(mechanism: Mechanism, angles: xarray.Dataset) -> Figure:
    """Transmission and pressure angles of every group over the drive's value, in degrees.

    Parameters
    ----------
    angles : Dataset
        Result of `transmission_angles`.
    """
    names = angles["group"].to_numpy().tolist()
    with house_style():
        rows = []
        for variable in VARIABLES:
            curves = {name: np.degrees(angles[variable].sel(group=name).to_numpy()) for name in names}
            text = labelled(formula(QUANTITIES[variable].symbol), "°")
            first = variable == VARIABLES[0]
            rows.append([Panel(text, "deg", curves, pens(names), scale=90.0, legend=first)])
        abscissa = main_abscissa(mechanism, angles)
        return sheet(_("Transmission and pressure angles"), _(mechanism.title), rows, abscissa)
