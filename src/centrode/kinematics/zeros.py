"""Where a group's radicand or divisor passes zero on a mesh, or touches it: by bounds of its second derivative.

Cells that are known need nothing but the signs at their nodes. In the others the least sizes are found by the root of
the derivative, as far as nodes foretell them; then the cells are divided until they are known (`cells`). What is left
are places: a sign that is only rounding is none, and a least size within the rounding error of the formulas is zero.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.rounding import SAFETY
from centrode.kinematics.bending import half_widths
from centrode.kinematics.branches import Branches
from centrode.kinematics.cells import (
    FINEST,
    Pieces,
    changes,
    clear,
    divided,
    parts_of,
    straight,
    towards,
    unsettled,
    without_sign,
)
from centrode.kinematics.guards import Guards
from centrode.kinematics.mesh import low_minima
from centrode.kinematics.pace import nearest_node

Array: TypeAlias = npt.NDArray[np.float64]
Lanes: TypeAlias = npt.NDArray[np.intp]
Mask: TypeAlias = npt.NDArray[np.bool_]
Found: TypeAlias = tuple[Lanes, Array]
"""Lanes and places, both (k,)."""

NOWHERE: Found = np.zeros(0, dtype=np.intp), np.zeros(0)
DOUBTFUL = 1e-8
"""Values below this fraction of the greatest one are compared with their rounding error."""
QUICK = 4.0
"""Circles of series below this many half widths of cells: about their change points a group turns fast."""
SLACK = 8.0
"""How many times the finest half width cells of a chain may be apart: what lies between is one place."""


@dataclass(frozen=True)
class _Places:
    """Places on the paths of chosen mechanisms, with the nearest nodes: arrays (k,)."""

    lane: Lanes
    at: Array
    node: Lanes


@dataclass(frozen=True)
class _Stops(_Places):
    """Where groups before stop, or turn fast.

    Nothing passes `walls`; where places are `blind`, nodes beside them foretell nothing.
    """

    walls: Mask
    blind: Mask


@dataclass(frozen=True)
class _Minima(_Places):
    """Where the size of a guard is least, zero where that is rounding; `touches` are those that are events."""

    least: Array
    touches: Mask


@dataclass(frozen=True)
class Zeros:
    """The search for zeros on a mesh."""

    guards: Guards
    mesh: Array

    @property
    def branches(self) -> Branches:
        """What was found of the groups before."""
        return self.guards.continuation.branches

    @cached_property
    def half(self) -> Array | float:
        """Half width of the cells about the nodes."""
        return half_widths(self.mesh)

    def found(
        self, group: int, value: Array, slope: Array, bend: Array, greatest: Array
    ) -> tuple[Found, Found]:
        """Lanes and places where a guard passes zero, and where it touches zero; `greatest` is its greatest size."""
        with np.errstate(all="ignore"):
            known = clear(value, slope, bend, self.half)
            if known.all():
                return NOWHERE, NOWHERE
            known |= straight(slope, bend, self.half)
            there = np.isfinite(value)
            stops = self._stops(group)
            rough = there & ~known
            rough[stops.lane, stops.node] |= ~known[stops.lane, stops.node]
            lanes, cells = np.nonzero(
                there[:, :-1]
                & there[:, 1:]
                & (value[:, :-1] * value[:, 1:] < 0.0)
                & ~(rough[:, :-1] | rough[:, 1:])
            )
            ends = lanes, self.mesh[cells], self.mesh[cells + 1]
            if not rough.any():
                return (lanes, self.guards.roots(group, *ends)), NOWHERE
            minima = self._looked_into(group, value, slope, rough, stops)
            pieces = self._divided(group, value, rough, (stops, minima))
            pieces = self._signed(group, pieces, stops, minima, greatest)
            others = self._unforeseen(group, pieces, minima)
        more = changes(pieces, SLACK * self._finest)
        lanes, low, high = (
            np.concatenate([ends[0], more[0]]),
            np.concatenate([ends[1], more[1]]),
            np.concatenate([ends[2], more[2]]),
        )
        found = (minima, others)
        touched = (
            np.concatenate([each.lane[each.touches] for each in found]),
            np.concatenate([each.at[each.touches] for each in found]),
        )
        return (lanes, self.guards.roots(group, lanes, low, high)), touched

    @property
    def _finest(self) -> float:
        return FINEST * self.branches.unit

    def _nodes_at(self, at: Array) -> Lanes:
        return nearest_node(self.mesh, at)

    def _stops(self, group: int) -> _Stops:
        """Where groups before this one stop; where signs do not flip, also where they meet their other assembly.

        And change points about which a group before turns fast: most happens next to them.
        """
        kinds = ("limit",) if self.branches.smooth else ("limit", "change point")
        found = [e for e in self.branches.events if e.group < group and e.kind in kinds]
        quick = [self._quick(before) for before in range(group)]
        lanes = np.concatenate(
            [np.array([e.lane for e in found], dtype=np.intp), *(each[0] for each in quick)]
        )
        at = np.concatenate([np.array([e.at for e in found], dtype=np.float64), *(each[1] for each in quick)])
        walls, blind = np.zeros(len(at), dtype=bool), np.zeros(len(at), dtype=bool)
        walls[: len(found)] = [e.kind == "limit" for e in found]
        blind[: len(found)] = True
        inside = (self.mesh[0] <= at) & (at <= self.mesh[-1])
        at = at[inside]
        return _Stops(lanes[inside], at, self._nodes_at(at), walls[inside], blind[inside])

    def _quick(self, group: int) -> Found:
        """The change points of a group about which it turns fast."""
        windows = self.guards.continuation.windows_of(group)
        if windows is None:
            return NOWHERE
        half = np.broadcast_to(self.half, self.mesh.shape)[self._nodes_at(windows.centre)]
        quick = windows.radius < QUICK * half
        return windows.lane[quick], windows.centre[quick]

    def _looked_into(self, group: int, value: Array, slope: Array, rough: Mask, stops: _Stops) -> _Minima:
        """The least sizes between nodes, where cells are not known and no group before this one stops."""
        sign = np.sign(value)
        looked = rough[:, :-1] | rough[:, 1:]
        blind = stops.blind
        looked[stops.lane[blind], np.searchsorted(self.mesh, stops.at[blind]) - 1] = False
        looked &= sign[:, :-1] == sign[:, 1:]
        lanes, cells = low_minima(self.mesh, sign * value, sign * slope, looked)
        at = self.guards.minima(group, lanes, self.mesh[cells], self.mesh[cells + 1])
        return self._touching(group, lanes, at, sign[lanes, cells])

    def _touching(self, group: int, lanes: Lanes, at: Array, sign: Array) -> _Minima:
        least, bound = self.guards.rounded(group, lanes, at) if len(lanes) else (at, at)
        near = np.abs(least) <= SAFETY * bound
        # a radicand that touches zero from below closes in one place, and is not passed
        touches = near & ((sign > 0.0) | (group not in self.branches.signs))
        return _Minima(lanes, at, self._nodes_at(at), np.where(near, 0.0, least), touches)

    def _divided(self, group: int, value: Array, rough: Mask, places: Sequence[_Places]) -> Pieces:
        """The rough cells in parts that are known, with the nodes beside them."""
        half = np.broadcast_to(self.half, self.mesh.shape)
        lanes = np.concatenate([each.lane for each in places])
        at = np.concatenate([each.at for each in places])
        nodes = np.concatenate([each.node for each in places])
        inside = rough[lanes, nodes] & np.isfinite(at)
        lanes, at, nodes = lanes[inside], at[inside], nodes[inside]
        order = np.lexsort((at, lanes))
        lanes, at, nodes = lanes[order], at[order], nodes[order]
        low, high = self.mesh[nodes] - half[nodes], self.mesh[nodes] + half[nodes]
        together = (np.diff(lanes) == 0) & (np.diff(nodes) == 0)
        middle = 0.5 * (at[1:] + at[:-1])[together]
        low[1:][together], high[:-1][together] = middle, middle
        plain = rough.copy()
        plain[lanes, nodes] = False
        rows, cells = np.nonzero(plain)
        parts = Pieces.joined(
            parts_of(Pieces.of(rows, self.mesh[cells], half[cells])), towards(lanes, low, high, at)
        )
        found = divided(parts, lambda *cell: self.guards.bent(group, *cell), self.branches.unit)
        beside = np.zeros(rough.shape, dtype=bool)
        beside[:, 1:] |= rough[:, :-1]
        beside[:, :-1] |= rough[:, 1:]
        rows, cells = np.nonzero(beside & ~rough & np.isfinite(value))
        return Pieces.joined(
            found, Pieces.of(rows, self.mesh[cells], half[cells], value[rows, cells], nodes=True)
        )

    def _signed(self, group: int, pieces: Pieces, stops: _Stops, minima: _Minima, greatest: Array) -> Pieces:
        """Cells in the order of the path, with the least sizes as cells of their own; zero where a sign is rounding."""
        size = np.where(np.isfinite(pieces.value), np.abs(pieces.value), 0.0)
        most = greatest.copy()  # where a group before turns fast, the nodes may have seen little of it
        np.maximum.at(most, pieces.lane, size)
        faint = np.abs(pieces.value) <= DOUBTFUL * most[pieces.lane]
        doubtful = np.nonzero(~pieces.nodes & (~pieces.known | faint))[0]
        value = pieces.value.copy()
        if len(doubtful):
            _value, bound = self.guards.rounded(group, pieces.lane[doubtful], pieces.centre[doubtful])
            value[doubtful[~(np.abs(value[doubtful]) > SAFETY * bound)]] = 0.0
        cores = Pieces.of(minima.lane, minima.at, self._finest, minima.least)
        walls = Pieces.of(stops.lane, stops.at, self._finest, np.inf).taken(stops.walls)
        cores = cores.taken(np.isfinite(minima.least))
        return Pieces.joined(replace(pieces, value=value), cores, walls).sorted()

    def _unforeseen(self, group: int, pieces: Pieces, minima: _Minima) -> _Minima:
        """The least sizes between cells of one sign, where no node foretold one.

        They are looked for where zeros lie between two cells, and where a cell was not divided until it was known.
        """
        slack = SLACK * self._finest
        lanes, low, high, sign = (
            np.concatenate(both)
            for both in zip(without_sign(pieces, slack), unsettled(pieces, slack), strict=True)
        )
        foretold = np.zeros(len(lanes), dtype=bool)
        for k in range(len(lanes)):
            near = minima.at[minima.lane == lanes[k]]
            foretold[k] = ((near > low[k]) & (near < high[k])).any()
        lanes, low, high, sign = lanes[~foretold], low[~foretold], high[~foretold], sign[~foretold]
        if len(lanes):
            falls, rises = (sign * self.guards.jets(group, lanes, x, 1).derivative(1) for x in (low, high))
            turns = (falls < 0.0) & (rises >= 0.0)
            lanes, low, high, sign = lanes[turns], low[turns], high[turns], sign[turns]
        return self._touching(group, lanes, self.guards.minima(group, lanes, low, high), sign)
