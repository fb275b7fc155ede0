"""The mesh on which events are looked for, and the cells in which something happens."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.kinematics.change_points import REACH
from centrode.kinematics.path import OFF_GRID, Path
from centrode.kinematics.plan_evaluation import RadicandZero

Array: TypeAlias = npt.NDArray[np.float64]
Lanes: TypeAlias = npt.NDArray[np.intp]
Mask: TypeAlias = npt.NDArray[np.bool_]

LOW = 0.25
"""A minimum is looked into if the tangents on both sides meet below this fraction of the values there."""
CLOSING_IN = 4.0 ** -np.arange(27.0)
"""Parts of the way from a limit to the node before it: the last one is rounding."""


def mesh_of(path: Path, parameter: Array) -> Array:
    """Nodes on which events are looked for: they belong to the mechanism, only their extent to the samples."""
    low = min(path.initial, float(np.min(parameter)))
    high = max(path.initial, float(np.max(parameter)))
    if path.pace is not None:
        return path.pace.nodes(*path.pace.beyond(low, high, REACH))
    # events beyond the samples matter to them: their windows reach back
    beyond = int(np.ceil(REACH * path.unit / path.step)) + 2
    first = int(np.floor((low - path.initial) / path.step)) - beyond
    last = int(np.ceil((high - path.initial) / path.step)) + beyond
    # whole numbers of steps from the initial position: the same nodes for any range
    nodes = np.arange(first, last + 1, dtype=np.float64)
    return path.initial + (nodes + OFF_GRID) * path.step


def largest_of(value: Array) -> Array:
    """Greatest finite magnitude of each row."""
    # NaN makes the first attempt NaN, and only then a masked copy is made
    largest: Array = np.max(np.abs(value), axis=1)
    if np.isfinite(largest).all():
        return largest
    return np.asarray(np.max(np.abs(np.where(np.isfinite(value), value, 0.0)), axis=1))


def low_minima(mesh: Array, value: Array, slope: Array, looked: Mask | None = None) -> tuple[Lanes, Lanes]:
    """Cells with a minimum that may reach zero, among all or those that are `looked` at."""
    turning = (slope[:, :-1] < 0.0) & (slope[:, 1:] >= 0.0)
    lanes, cells = np.nonzero(turning if looked is None else turning & looked)
    left, right = value[lanes, cells], value[lanes, cells + 1]
    falls, rises = slope[lanes, cells], slope[lanes, cells + 1]
    with np.errstate(all="ignore"):
        step = mesh[cells + 1] - mesh[cells]
        # where the tangents at both nodes meet: a convex curve does not get below that
        meeting = (right - left - rises * step) / (falls - rises)
        lowest = left + falls * meeting
        low = lowest <= LOW * np.minimum(left, right)
    return lanes[low], cells[low]


def cut_cells(events: Sequence[RadicandZero], mesh: Array, value: Array) -> tuple[Lanes, Lanes, Array]:
    """Cells with a value at one end only: their lanes, numbers, and the limit that is nearest to that end."""
    finite = np.isfinite(value)
    limits = [] if finite.all() else [event for event in events if event.kind == "limit"]
    at = np.array([event.at for event in limits])
    lanes = np.array([event.lane for event in limits], dtype=np.intp)
    # the cell that holds the limit
    cells = np.searchsorted(mesh, at) - 1
    inside = (cells >= 0) & (cells < len(mesh) - 1)
    at, lanes, cells = at[inside], lanes[inside], cells[inside]
    before, behind = finite[lanes, cells], finite[lanes, cells + 1]
    cut = before != behind
    # from the end with a value towards the limit
    at, lanes, cells, way = at[cut], lanes[cut], cells[cut], np.where(before[cut], 1.0, -1.0)
    # of several limits in a cell the one nearest to the end with a value ends it
    order = np.lexsort((way * at, cells, lanes))
    first = np.ones(len(order), dtype=bool)
    first[1:] = (np.diff(lanes[order]) != 0) | (np.diff(cells[order]) != 0)
    nearest = order[first]
    return lanes[nearest], cells[nearest], at[nearest]


def first_changes(signs: Array) -> tuple[Lanes, Lanes, Lanes]:
    # zero has no sign: rows that begin with it are rounding from the start
    """Rows whose sign turns from the one they begin with: the last place before that, and the first behind it."""
    rows = np.nonzero((signs == -signs[:, :1]).any(axis=1) & (signs[:, 0] != 0.0))[0]
    some = signs[rows]
    first = np.argmax(some == -some[:, :1], axis=1)
    before = (some == some[:, :1]) & (np.arange(some.shape[1]) < first[:, None])
    # the last place before the change that has a sign: zeros between do not bracket
    last = before.shape[1] - 1 - np.argmax(before[:, ::-1], axis=1)
    return rows, last, first
