"""Limits and change points: where a group's radicand reaches zero along the path.

The radicand is looked at on a mesh that belongs to the mechanism, not to the samples asked for, with its derivative at
each node and a bound of its second derivative in the cell about it. Cells in which it may have more than one zero are
divided (`cells`). A minimum of the radicand is refined by the root of its derivative: zero within the rounding error of
the formulas is a change point, below zero a pair of limits. Other sign changes are limits. A divisor's sign change is a
limit as well (the group's point goes to infinity), and so is a place where it touches zero.

Behind a group of higher class no second derivative is bounded: there minima and sign changes are looked for from node
to node.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.arrays import ARRAYS
from centrode.algebra.bends import Bent
from centrode.algebra.jets import Jet
from centrode.algebra.rounding import SAFETY
from centrode.kinematics.bending import BENDS, Bending, bent_frame
from centrode.kinematics.branches import Branches, Event
from centrode.kinematics.continuation import Continuation, Rough
from centrode.kinematics.counted_turns import counted
from centrode.kinematics.evaluate import Kinematics, Reached
from centrode.kinematics.guards import Guards
from centrode.kinematics.mesh import (
    CLOSING_IN,
    cut_cells,
    first_changes,
    largest_of,
    low_minima,
)
from centrode.kinematics.quick_turns import QuickTurns
from centrode.kinematics.zeros import Zeros
from centrode.numerics.search import sign_changes
from centrode.structure.constraints import Positions
from centrode.structure.groups import Aim, Meet

Array: TypeAlias = npt.NDArray[np.float64]
Lanes: TypeAlias = npt.NDArray[np.intp]
Mask: TypeAlias = npt.NDArray[np.bool_]
Number: TypeAlias = Any
Namespace: TypeAlias = Any

BESIDE_POLE = 1e-6
"""Share of a cell beside a place at infinity where a radicand has its sign again, and not that of rounding."""


@dataclass(frozen=True)
class Scan:
    """Search for the events of all groups of a plan, one group after the other."""

    continuation: Continuation
    mesh: Array

    @property
    def kinematics(self) -> Kinematics:
        """The plan that is searched."""
        return self.continuation.kinematics

    @property
    def branches(self) -> Branches:
        """What is found is recorded here."""
        return self.continuation.branches

    def run(self) -> Positions:
        """Find all events, record them in the branches, and return the positions on the mesh as plain arrays."""
        groups = self.kinematics.structure.groups
        last = max((i for i, group in enumerate(groups) if isinstance(group, (Meet, Aim))), default=0)
        along = self.mesh[None, :]
        with np.errstate(all="ignore"):
            at = bent_frame(self.kinematics, along, self.zeros.half)
            with suppress(Reached):  # slopes are needed up to the last radicand, and not beyond
                self.kinematics.advance(at, range(last + 1), BENDS, _Searching(self, last))
            plain = at.mapped(lambda x: x.value if isinstance(x, Jet) else x)
            self.kinematics.advance(plain, range(last, len(groups)), ARRAYS, _Counting(self, ARRAYS))
        return plain

    def trace(self, group: int) -> None:
        """Follow a group of higher class over the mesh."""
        self.continuation.trace(group, (float(self.mesh[0]), float(self.mesh[-1])))

    @property
    def guards(self) -> Guards:
        """Radicands and divisors at single places."""
        return Guards(self.continuation)

    @cached_property
    def zeros(self) -> Zeros:
        """What looks for their zeros, as far as their second derivatives are bounded."""
        return Zeros(self.guards, self.mesh)

    def find(self, group: int, radicand: Number) -> None:
        """Record where a group's radicand is zero."""
        value, slope = self._on_mesh(radicand)
        self.branches.largest[group] = largest_of(value)
        bend = self._bend_on_mesh(radicand)
        if bend is None:
            events = self._events(group, value, slope)
        else:
            limits, touches = self.zeros.found(group, value, slope, bend, self.branches.largest[group])
            events = self._limits(group, *limits)
            events += [Event("change point", group, int(k), float(x)) for k, x in zip(*touches, strict=True)]
        self.branches.add(group, events)

    def find_poles(self, group: int, divisor: Number) -> None:
        """Record where a group goes to infinity."""
        value, slope = self._on_mesh(divisor)
        bend = self._bend_on_mesh(divisor)
        if bend is None:
            lanes, cells = sign_changes(value)
            found = self.guards.roots(group, lanes, self.mesh[cells], self.mesh[cells + 1])
            places = [(lanes, found), self._beside_limits(group, value)]
        else:
            places = list(self.zeros.found(group, value, slope, bend, largest_of(value)))
        limits = [
            Event("limit", group, int(k), float(x)) for place in places for k, x in zip(*place, strict=True)
        ]
        self.branches.add(group, limits)

    def _on_mesh(self, jet: Number) -> tuple[Array, Array]:
        shape = (self.branches.lanes, len(self.mesh))
        if not isinstance(jet, Jet):
            return np.broadcast_to(jet, shape), np.zeros(shape)
        return np.broadcast_to(jet.value, shape), np.broadcast_to(jet.derivative(1), shape)

    def _bend_on_mesh(self, jet: Number) -> Array | None:
        """Bound of the second derivative about each node; None where nothing is known of it."""
        shape = (self.branches.lanes, len(self.mesh))
        if isinstance(jet, Bent):
            return np.broadcast_to(jet.bend, shape)
        return None if isinstance(jet, Jet) else np.zeros(shape)

    def _events(self, group: int, value: Array, slope: Array) -> list[Event]:
        found: list[Event] = []
        settled = np.zeros((value.shape[0], value.shape[1] - 1), dtype=bool)
        lanes, cells = low_minima(self.mesh, value, slope)
        if len(lanes):
            at = self.guards.minima(group, lanes, self.mesh[cells], self.mesh[cells + 1])
            least, bound = self.guards.rounded(group, lanes, at)
            # where a group before this one goes to infinity, the radicand's error exceeds the radicand itself
            certain = SAFETY * bound <= self.branches.largest[group][lanes]
            touches = certain & (np.abs(least) <= SAFETY * bound)
            found += [
                Event("change point", group, int(lane), float(x))
                for lane, x in zip(lanes[touches], at[touches], strict=True)
            ]
            self._settle(settled, value, lanes[touches], cells[touches], SAFETY * bound[touches])
            dips = ~touches & (~certain | (least < 0.0))
            aside = np.where(certain, 0.0, BESIDE_POLE * (self.mesh[cells + 1] - self.mesh[cells]))
            for first, last, edge in (
                (self.mesh[cells], at - aside, value[lanes, cells]),
                (at + aside, self.mesh[cells + 1], value[lanes, cells + 1]),
            ):
                chosen = dips & (edge > 0.0)
                roots = self.guards.roots(group, lanes[chosen], first[chosen], last[chosen])
                found += self._limits(group, lanes[chosen], roots)
            settled[lanes[dips], cells[dips]] = True
        lanes, cells = sign_changes(value)
        rest = ~settled[lanes, cells]
        roots = self.guards.roots(group, lanes[rest], self.mesh[cells[rest]], self.mesh[cells[rest] + 1])
        beside = self._beside_limits(group, value)
        return found + self._limits(group, lanes[rest], roots) + self._limits(group, *beside)

    def _beside_limits(self, group: int, value: Array) -> tuple[Lanes, Array]:
        """Lanes and places of limits in the part of a cell that is left of it where an earlier group stops.

        Behind that group's limit there is no radicand, and before it the radicand may run like a square root: it is
        looked at on places that close in on the limit.
        """
        lanes, cells, ends = cut_cells(self.branches.events, self.mesh, value)
        if not len(lanes):
            return lanes, ends
        nodes = np.where(np.isfinite(value[lanes, cells]), self.mesh[cells], self.mesh[cells + 1])
        places = ends[:, None] + (nodes - ends)[:, None] * CLOSING_IN
        guard, bound = self.guards.rounded(group, np.repeat(lanes, len(CLOSING_IN)), places.ravel())
        # what is rounding has no sign: groups that stop together do not stop each other
        signs = np.where(np.abs(guard) > SAFETY * bound, np.sign(guard), 0.0).reshape(places.shape)
        rows, last, first = first_changes(signs)
        ends = np.sort([places[rows, last], places[rows, first]], axis=0)
        return lanes[rows], self.guards.roots(group, lanes[rows], *ends)

    def _limits(self, group: int, lanes: Lanes, at: Array) -> list[Event]:
        if not len(lanes):
            return []
        rises = self.guards.jets(group, lanes, at, 1).derivative(1) > 0.0
        return [
            Event("limit", group, int(lane), float(x), bool(up))
            for lane, x, up in zip(lanes, at, rises, strict=True)
        ]

    def _settle(
        self, settled: npt.NDArray[np.bool_], value: Array, lanes: Lanes, cells: Lanes, bound: Array
    ) -> None:
        """Cells next to a change point whose signs are only rounding are not looked at again."""
        settled[lanes, cells] = True
        near = np.maximum(np.abs(value[lanes, cells]), np.abs(value[lanes, cells + 1])) <= 100.0 * bound
        last = settled.shape[1] - 1
        settled[lanes[near], np.maximum(cells[near] - 1, 0)] = True
        settled[lanes[near], np.minimum(cells[near] + 1, last)] = True


class _Counting(Rough):
    """Counts the turns of angles along the mesh, for all that is asked for afterwards."""

    def __init__(self, scan: Scan, m: Namespace) -> None:
        super().__init__(scan.continuation, m, scan.mesh[None, :], None)
        self.scan = scan

    def continued(self, group: int, key: str, angle: Number) -> Number:
        count(self.scan, group, key, angle)
        return super().continued(group, key, angle)

    def higher(self, group: int, m: Namespace, at: Positions) -> None:
        self.scan.trace(group)
        super().higher(group, m, at)


class _Searching(Bending):
    """Looks for the events of every group before it asks for its sign; goes no further than the last radicand."""

    def __init__(self, scan: Scan, last: int) -> None:
        super().__init__(scan.continuation, scan.mesh[None, :], None)
        self.scan = scan
        self.last = last

    def continued(self, group: int, key: str, angle: Number) -> Number:
        count(self.scan, group, key, angle)
        return super().continued(group, key, angle)

    def root(self, group: int, radicand: Jet) -> Number:
        self.scan.find(group, radicand)
        if group == self.last:
            raise Reached(radicand)
        return super().root(group, radicand)

    def higher(self, group: int, m: Namespace, at: Positions) -> None:
        if group == self.last:
            raise Reached(None)  # no radicand at all
        self.scan.trace(group)
        super().higher(group, m, at)

    def divisor(self, group: int, divisor: Number) -> Number:
        if isinstance(divisor, Jet):
            self.scan.find_poles(group, divisor)
        return divisor


def count(scan: Scan, group: int, key: str, angle: Number) -> None:
    """Count the turns of an angle on the mesh."""
    branches, mesh = scan.branches, scan.mesh
    quick = QuickTurns(scan.continuation, mesh, group).in_plan(group, key)
    branches.turns[key] = counted(angle, mesh, branches.angles.get(key, 0.0), branches.initial, quick)
