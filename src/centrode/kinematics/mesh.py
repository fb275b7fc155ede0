"""The mesh on which events are looked for, and the cells in which something happens."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.kinematics.continuation import REACH
from centrode.kinematics.pace import OFF_GRID
from centrode.kinematics.paths import Path

Array: TypeAlias = npt.NDArray[np.float64]
Lanes: TypeAlias = npt.NDArray[np.intp]

LOW = 0.25
"""A minimum is looked into if the tangents on both sides meet below this fraction of the values there."""


def mesh_of(path: Path, parameter: Array) -> Array:
    """Nodes on which events are looked for: they belong to the mechanism, only their extent to the samples."""
    low = min(path.initial, float(np.min(parameter)))
    high = max(path.initial, float(np.max(parameter)))
    if path.pace is not None:
        return path.pace.nodes(*path.pace.beyond(low, high, REACH))
    beyond = int(np.ceil(REACH * path.unit / path.step)) + 2
    first = int(np.floor((low - path.initial) / path.step)) - beyond
    last = int(np.ceil((high - path.initial) / path.step)) + beyond
    nodes = np.arange(first, last + 1, dtype=np.float64)
    return path.initial + (nodes + OFF_GRID) * path.step


def largest_of(value: Array) -> Array:
    """Greatest finite magnitude of each row."""
    largest: Array = np.max(np.abs(value), axis=1)
    if np.isfinite(largest).all():
        return largest
    return np.asarray(np.max(np.abs(np.where(np.isfinite(value), value, 0.0)), axis=1))


def low_minima(mesh: Array, value: Array, slope: Array) -> tuple[Lanes, Lanes]:
    """Cells with a minimum that may reach zero."""
    lanes, cells = np.nonzero((slope[:, :-1] < 0.0) & (slope[:, 1:] >= 0.0))
    left, right = value[lanes, cells], value[lanes, cells + 1]
    falls, rises = slope[lanes, cells], slope[lanes, cells + 1]
    with np.errstate(all="ignore"):
        step = mesh[cells + 1] - mesh[cells]
        meeting = (right - left - rises * step) / (falls - rises)
        lowest = left + falls * meeting
        low = lowest <= LOW * np.minimum(left, right)
    return lanes[low], cells[low]


def sign_changes(value: Array) -> tuple[Lanes, Lanes]:
    """Cells between finite values of opposite signs."""
    # most mechanisms of a batch have none, and their least value says so
    rows = np.nonzero(~((np.min(value, axis=1) > 0.0) | (np.max(value, axis=1) < 0.0)))[0]
    some = value[rows]
    with np.errstate(all="ignore"):
        found, cells = np.nonzero(
            np.sign(np.where(np.isfinite(some), some, np.nan))[:, :-1] * np.sign(some[:, 1:]) < 0.0
        )
    return rows[found], cells
