"""Samples next to a change point: there the closed forms lose digits, and the motion itself is smooth.

Value and derivatives are each interpolated from nodes on both sides of the change point (barycentric
formula; Berrut and Trefethen, SIAM Review 46, 2004). The nodes belong to the change point, so the result
depends on the drive's value alone.
"""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.errors import Status
from centrode.kinematics.branches import Branches
from centrode.kinematics.evaluate import Kinematics
from centrode.kinematics.sampling import ORDERS, Samples, evaluate_columns

Array: TypeAlias = npt.NDArray[np.float64]

WINDOW = 0.04
"""Half width of the mended stretch, in the path's units (rad for an angle)."""
NODES = 6
"""Chebyshev nodes on each side, between one and two half widths away."""


def mend_change_points(
    kinematics: Kinematics, branches: Branches, samples: Samples, parameter: Array
) -> None:
    """Replace the samples next to change points by interpolation; they become `ok` (or stay cut off)."""
    if not branches.smooth:
        return
    for lane in sorted({event.lane for event in branches.events}):
        events = [event.at for event in branches.events if event.lane == lane]
        for at in sorted({event.at for event in branches.of_kind("change point", lane)}):
            half = _half_width(at, events, branches.unit)
            chosen = np.nonzero(np.abs(parameter - at) < half)[0]
            if len(chosen):
                _mend(kinematics, branches, samples, parameter, lane, at, half, chosen)


def _half_width(at: float, events: list[float], unit: float) -> float:
    others = [abs(other - at) for other in events if abs(other - at) > 1e-9 * unit]
    return min(WINDOW * unit, min(others, default=np.inf) / 3.0)


def _mend(
    kinematics: Kinematics,
    branches: Branches,
    samples: Samples,
    parameter: Array,
    lane: int,
    at: float,
    half: float,
    chosen: npt.NDArray[np.intp],
) -> None:
    side = 1.5 - 0.5 * np.cos((np.arange(NODES) + 0.5) * np.pi / NODES)
    nodes = half * np.concatenate([-side[::-1], side])
    lanes = np.full(len(nodes), lane, dtype=np.intp)
    known = np.empty((ORDERS, samples.layout.width, len(nodes)))
    evaluate_columns(kinematics, samples.layout, branches, at + nodes, lanes, known)
    if not np.isfinite(known).all():
        return  # another event lies inside the stretch: the samples keep the status they have
    weights = np.array([1.0 / np.prod((node - np.delete(nodes, k)) / half) for k, node in enumerate(nodes)])
    away = (parameter[chosen] - at)[:, None] - nodes
    basis = weights / away
    basis /= basis.sum(axis=1, keepdims=True)
    for order in range(ORDERS):
        # node by node: a matrix product rounds differently for different numbers of samples
        samples.columns[order][:, lane, chosen] = sum(
            known[order][:, k, None] * basis[None, :, k] for k in range(len(nodes))
        )
    status = samples.status[lane]
    status[chosen[status[chosen] != Status.CUT_OFF]] = Status.OK
