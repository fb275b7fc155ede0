"""Between which displacements a slider moves: the ends of its stroke, found by the motion itself."""

from __future__ import annotations

from math import tau

import numpy as np
import numpy.typing as npt

from centrode.dynamics.state import length_unit
from centrode.errors import InputError
from centrode.kinematics.path import grid_at
from centrode.kinematics.preparation import ready
from centrode.kinematics.solve import requested_grid, solve
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.numerics.search import extremes

Array = npt.NDArray[np.float64]

NODES = 361
"""Of the mesh over the motion: between two of them a slider turns round at most once."""


def ends_of_stroke(mechanism: Mechanism, guide: str, where: str) -> tuple[float, float]:
    """Least and greatest displacement along a guide [m]: over a turn of a drive that turns, else over the range.

    Raises
    ------
    InputError
        Several drives; positions that are not reached; a slider that does not move.
    """
    prepared = ready(mechanism)
    path = prepared.kinematics.path
    if len(mechanism.drives) != 1 or not prepared.parameter.is_uniform:
        what = _("the stroke is known only of a mechanism with one drive at constant speed")
        raise InputError(where, what, _("give the table over the displacement"))
    if prepared.parameter.turns:
        nodes = path.initial + path.forward * np.linspace(0.0, tau, NODES)
    else:
        nodes = np.asarray(requested_grid(prepared, NODES, None, None).parameter)
    column = solve(prepared, grid_at(path, nodes[:1])).layout.guides.index(guide)

    def slides(places: Array, order: int) -> Array:
        return np.asarray(solve(prepared, grid_at(path, places)).slides[order, 0, :, column])

    growing = nodes if nodes[0] < nodes[-1] else nodes[::-1]
    if not np.isfinite(slides(growing, 0)).all():
        what = _("its stroke is not known: the drive does not turn fully")
        raise InputError(where, what, _("give the table over the displacement"))
    found = extremes(lambda x: slides(x, 0), lambda x: slides(x, 1), growing)
    if not found.range > 0.0:
        raise InputError(where, _("it does not move along its guide"), _("give the force as a value"))
    unit = length_unit(mechanism)
    return found.least * unit, found.greatest * unit
