"""Forces between cam and follower over the angle of the cam."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure

from centrode.locale import _
from centrode.present.abscissa import Abscissa
from centrode.present.curves import Panel, sheet
from centrode.present.shown import formula, labelled, shown_as
from centrode.present.style import house_style, pens
from centrode.quantities import QUANTITIES

if TYPE_CHECKING:
    import xarray

    from centrode.model.cam_files import AnyCam

PANELS = ("follower_push", "follower_moment", "contact_force", "cam_torque", "contact_stress")
SCALES = {"Pa": (1e-6, "MPa")}
"""Factors and units of what no display names."""


def cam_forces_figure(cam: AnyCam, forces: xarray.Dataset) -> Figure:
    """Push, contact force, torque and contact stress over a turn of the cam (`ct.cam_forces`)."""
    with house_style():
        rows = []
        for name in PANELS:
            if name not in forces:
                continue
            quantity = QUANTITIES[name]
            factor, unit = SCALES.get(quantity.unit, (1.0, quantity.unit))
            title = _(quantity.title)
            curves = {title: factor * forces[name].to_numpy()}
            text = labelled(formula(quantity.symbol), unit)
            rows.append([Panel(text, unit, curves, pens(curves))])
        return sheet(_("Forces on cam and follower"), _(cam.title), rows, _over_turn(cam, forces))


def _over_turn(cam: AnyCam, forces: xarray.Dataset) -> Abscissa:
    """The cam's angle, in the unit of the display."""
    factor, unit = shown_as("rad", cam.display)
    phi = forces["cam_angle"].to_numpy() * factor
    order = np.argsort(phi, kind="stable")
    none = np.zeros(0, dtype=np.intp)
    quantity = QUANTITIES["cam_angle"]
    label = labelled(f"{_(quantity.title)} {formula(quantity.symbol)}", unit)
    return Abscissa(phi[order], order, none, np.zeros(len(phi), dtype=bool), (), label, unit)
