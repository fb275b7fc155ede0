"""Between which displacements a slider moves: the ends of its stroke, found by the motion itself."""

from __future__ import annotations

from collections.abc import Iterator
from math import tau

import numpy as np
import numpy.typing as npt

from centrode.dynamics.state import length_unit
from centrode.errors import InputError
from centrode.kinematics.path import grid_at
from centrode.kinematics.preparation import Ready, ready
from centrode.kinematics.solve import requested_grid, solve
from centrode.locale import _
from centrode.model.mechanism import Mechanism, kept_by_mechanism
from centrode.numerics.search import extremes

Array = npt.NDArray[np.float64]

NODES = 361
"""Of the mesh over the motion: between two of them a slider turns round at most once."""


@kept_by_mechanism(16)
def ends_of_stroke(mechanism: Mechanism, guide: str, where: str) -> tuple[float, float]:
    """Least and greatest displacement along a guide [m]: over a turn of a drive that turns fully, else over the range.

    It is kept for whoever asks next: every analysis of a mechanism reads its loads again.

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
    column = solve(prepared, grid_at(path, np.array([path.initial]))).layout.guides.index(guide)

    def slides(places: Array, order: int) -> Array:
        return np.asarray(solve(prepared, grid_at(path, places)).slides[order, 0, :, column])

    for nodes in _meshes(prepared):
        growing = nodes if nodes[0] < nodes[-1] else nodes[::-1]
        if np.isfinite(slides(growing, 0)).all():
            break
    else:
        what = _("its stroke is not known: the drive does not turn fully")
        repair = _("give the range of the motion in [study], or the table over the displacement")
        raise InputError(where, what, repair)
    found = extremes(lambda x: slides(x, 0), lambda x: slides(x, 1), growing)
    if not found.range > 0.0:
        raise InputError(where, _("it does not move along its guide"), _("give the force as a value"))
    unit = length_unit(mechanism)
    return found.least * unit, found.greatest * unit


def _meshes(prepared: Ready) -> Iterator[Array]:
    """Values of the drive over which a stroke may be known: a turn, else the range of the study."""
    path, study = prepared.kinematics.path, prepared.mechanism.study
    if prepared.parameter.turns:
        yield path.initial + path.forward * np.linspace(0.0, tau, NODES)
        if study.range is None and (study.start is None or study.stop is None):
            return
    yield np.asarray(requested_grid(prepared, NODES, None, None).parameter)
