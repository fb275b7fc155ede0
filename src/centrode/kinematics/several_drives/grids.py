"""Two drives on a grid of their values: where the mechanism closes, and where every grid line meets a limit."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.jets import Jet
from centrode.kinematics.branches import Event, branches_at_start
from centrode.kinematics.continuation import Continuation
from centrode.kinematics.events import Scan
from centrode.kinematics.layout import Layout, layout_of
from centrode.kinematics.mesh import mesh_of
from centrode.kinematics.paths import JETS
from centrode.kinematics.ready import Ready
from centrode.kinematics.sampling import ORDERS, Judging, fill_columns
from centrode.kinematics.several_drives.holding import held_path

Array: TypeAlias = npt.NDArray[np.float64]
Mask: TypeAlias = npt.NDArray[np.bool_]
Number: TypeAlias = Any

AT_A_NODE = 64.0
"""A limit this many units of the last place from a node is that node itself: it parts no neighbours."""
CHUNK = 200_000
"""Lines are followed together as long as lines times mesh nodes stay below this."""


@dataclass(frozen=True)
class Lines:
    """All grid lines along one drive, one for each value of the other.

    Attributes
    ----------
    closed : (lines, nodes) where the mechanism closes
    margins : group -> (lines, nodes) its radicand, or the size of its divisor
    limits : (k,) line, (k,) value, (k,) group of every limit on them
    """

    closed: Mask
    margins: Mapping[int, Array]
    limits: tuple[npt.NDArray[np.intp], Array, npt.NDArray[np.intp]]

    def passages(self, nodes: Array) -> Mask:
        """Where a line is closed at two neighbouring nodes and passes no limit between them: (lines, nodes - 1)."""
        free = self.closed[:, :-1] & self.closed[:, 1:]
        line, value, _group = self.limits
        cell = cells_of(nodes, value)
        margin = AT_A_NODE * np.spacing(np.max(np.abs(nodes)))
        inside = (nodes[cell] + margin < value) & (value < nodes[cell + 1] - margin)
        free[line[inside], cell[inside]] = False
        return free

    def margin(self) -> Array:
        """Smallest radicand of all groups, each over its greatest; NaN where none is known."""
        least = np.full(self.closed.shape, np.nan)
        for values in self.margins.values():
            with np.errstate(all="ignore"):
                greatest = float(np.nanmax(np.abs(values), initial=0.0))
                least = np.fmin(least, values / greatest if greatest > 0.0 else values)
        return least if self.margins else np.ones_like(least)


def cells_of(nodes: Array, values: Array) -> npt.NDArray[np.intp]:
    """Between which node and the next values lie."""
    return np.clip(np.searchsorted(nodes, values, side="right") - 1, 0, len(nodes) - 2)


def lines_along(
    ready: Ready, drive: str, nodes: Array, across: str, places: Array, held: Mapping[str, float]
) -> Lines:
    """Grid lines along `drive` at `nodes`, one for each of `places` of the drive `across`."""
    path = held_path(ready, drive, float(ready.assembled.positions.drives[drive]), held)
    count = max(1, CHUNK // len(mesh_of(path, nodes)))
    parts = [
        _some(ready, drive, nodes, {**held, across: places[first : first + count, None]}, first)
        for first in range(0, len(places), count)
    ]
    limits = tuple(np.concatenate(each) for each in zip(*(part.limits for part in parts), strict=True))
    return Lines(
        np.concatenate([part.closed for part in parts]),
        {group: np.concatenate([part.margins[group] for part in parts]) for group in parts[0].margins},
        (limits[0], limits[1], limits[2]),
    )


def _some(ready: Ready, drive: str, nodes: Array, held: Mapping[str, Any], first: int) -> Lines:
    """Some of the lines together."""
    path = held_path(ready, drive, float(ready.assembled.positions.drives[drive]), held)
    lanes = max(len(value) for value in held.values() if isinstance(value, np.ndarray))
    branches = branches_at_start(
        path, ready.assembled.signs, ready.assembled.angles, smooth=False, lanes=lanes
    )
    kinematics = replace(ready.kinematics, path=path)
    continuation = Continuation(kinematics, branches, ready.assembled.positions, kinematics.numbers)
    Scan(continuation, mesh_of(path, nodes)).run()
    judged = _judged(continuation, layout_of(kinematics), nodes, lanes)
    return Lines(~judged.opened, judged.margins, _limits(branches.events, nodes, first))


def _limits(
    events: list[Event], nodes: Array, first: int
) -> tuple[npt.NDArray[np.intp], Array, npt.NDArray[np.intp]]:
    found = [e for e in events if e.kind == "limit" and nodes[0] <= e.at <= nodes[-1]]
    return (
        np.array([event.lane + first for event in found], dtype=np.intp),
        np.array([event.at for event in found], dtype=np.float64),
        np.array([event.group for event in found], dtype=np.intp),
    )


class _Measuring(Judging):
    """Judges as for a motion, and keeps what decides whether each group closes."""

    def __init__(self, continuation: Continuation, along: Array, shape: tuple[int, ...]) -> None:
        super().__init__(continuation, along, shape)
        self.margins: dict[int, Array] = {}

    def root(self, group: int, radicand: Number) -> Number:
        self.margins[group] = self._spread(radicand)
        return super().root(group, radicand)

    def divisor(self, group: int, divisor: Number) -> Number:
        self.margins[group] = np.abs(self._spread(divisor))
        return divisor

    def _spread(self, number: Number) -> Array:
        value = number.value if isinstance(number, Jet) else number
        return np.array(np.broadcast_to(value, self.shape), dtype=np.float64)


def _judged(continuation: Continuation, layout: Layout, nodes: Array, lanes: int) -> _Measuring:
    columns = np.empty((ORDERS, layout.width, lanes, len(nodes)))
    judging = _Measuring(continuation, nodes[None, :], (lanes, len(nodes)))
    kinematics = continuation.kinematics
    with np.errstate(all="ignore"):
        at = kinematics.positions(JETS, Jet.variable(nodes[None, :], ORDERS - 1), judging)
        fill_columns(kinematics, layout, at, columns)
    judging.opened |= ~np.isfinite(columns[0]).all(axis=0)
    return judging


def reached_from(
    closed: Mask, first: Mask, second: Mask, seed: tuple[int, int], rounds: Sequence[bool]
) -> Mask:
    """Nodes connected with the seed by free passages along the first and the second drive.

    Where a drive comes round within its range, its last line goes on at its first.
    """
    reached = np.zeros(closed.shape, dtype=bool)
    reached[seed] = closed[seed]
    while True:
        before = int(reached.sum())
        for free, here, closes, comes_round in (
            (first, reached, closed, rounds[0]),
            (second.T, reached.T, closed.T, rounds[1]),
        ):
            if comes_round:
                ends = here[0] | here[-1]
                here[0], here[-1] = ends & closes[0], ends & closes[-1]
            for k in range(len(free)):
                here[k + 1] |= here[k] & free[k]
            for k in range(len(free) - 1, -1, -1):
                here[k] |= here[k + 1] & free[k]
        if int(reached.sum()) == before:
            return reached
