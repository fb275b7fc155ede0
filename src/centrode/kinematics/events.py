"""Limits and change points: where a group's radicand reaches zero along the path.

The radicand is sampled with its derivative on a mesh that belongs to the mechanism, not to the samples
asked for. A minimum of the radicand is refined by the root of its derivative: zero within the rounding
error of the formulas is a change point, below zero a pair of limits. Other sign changes are limits. A
divisor's sign change is a limit as well (the group's point goes to infinity).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.jets import Jet
from centrode.algebra.rounding import ROUNDED, SAFETY, Rounded
from centrode.kinematics.branches import Branches, Event
from centrode.kinematics.evaluate import Kinematics
from centrode.kinematics.paths import JETS
from centrode.kinematics.roots import bracketed_roots
from centrode.structure.constraints import Positions

Array: TypeAlias = npt.NDArray[np.float64]
Lanes: TypeAlias = npt.NDArray[np.intp]
Number: TypeAlias = Any

LOW = 0.25
"""A minimum is looked into if the tangents on both sides meet below this fraction of the values there."""


@dataclass(frozen=True)
class Scan:
    """Search for the events of all groups of a plan, one group after the other."""

    kinematics: Kinematics
    branches: Branches
    mesh: Array

    def run(self) -> Positions:
        """Find all events, record them in the branches, and return the positions on the mesh with first derivatives."""
        with np.errstate(all="ignore"):
            return self.kinematics.positions(
                JETS, Jet.variable(self.mesh[None, :], 1), self._branch, self._divisor
            )

    def _branch(self, group: int, radicand: Jet) -> Jet:
        value, slope = self._on_mesh(radicand)
        self.branches.largest[group] = np.nanmax(np.abs(np.where(np.isfinite(value), value, 0.0)), axis=1)
        self.branches.add(group, self._events(group, value, slope))
        root: Jet = JETS.sqrt(radicand) * self.branches.sign(group, self.mesh[None, :])
        return root

    def _divisor(self, group: int, divisor: Number) -> Number:
        if isinstance(divisor, Jet):
            value, _slope = self._on_mesh(divisor)
            lanes, cells = _sign_changes(value)
            found = self._roots(group, lanes, self.mesh[cells], self.mesh[cells + 1])
            self.branches.add(group, _limits(group, lanes, found))
        return divisor

    def _on_mesh(self, jet: Number) -> tuple[Array, Array]:
        shape = (self.branches.lanes, len(self.mesh))
        if not isinstance(jet, Jet):
            return np.broadcast_to(jet, shape), np.zeros(shape)
        return np.broadcast_to(jet.value, shape), np.broadcast_to(jet.derivative(1), shape)

    def _events(self, group: int, value: Array, slope: Array) -> list[Event]:
        found: list[Event] = []
        settled = np.zeros((value.shape[0], value.shape[1] - 1), dtype=bool)
        lanes, cells = _low_minima(self.mesh, value, slope)
        if len(lanes):
            at = self._minima(group, lanes, self.mesh[cells], self.mesh[cells + 1])
            least, bound = self.with_bound(group, lanes, at)
            touches = np.abs(least) <= SAFETY * bound
            found += [
                Event("change point", group, int(lane), float(x))
                for lane, x in zip(lanes[touches], at[touches], strict=True)
            ]
            self._settle(settled, value, lanes[touches], cells[touches], SAFETY * bound[touches])
            dips = ~touches & (least < 0.0)
            for first, last in ((self.mesh[cells], at), (at, self.mesh[cells + 1])):
                edge = value[lanes, cells] if last is at else value[lanes, cells + 1]
                chosen = dips & (edge > 0.0)
                roots = self._roots(group, lanes[chosen], first[chosen], last[chosen])
                found += _limits(group, lanes[chosen], roots)
            settled[lanes[dips], cells[dips]] = True
        lanes, cells = _sign_changes(np.where(np.isfinite(value), value, np.nan))
        rest = ~settled[lanes, cells]
        roots = self._roots(group, lanes[rest], self.mesh[cells[rest]], self.mesh[cells[rest] + 1])
        return found + _limits(group, lanes[rest], roots)

    def _settle(
        self, settled: npt.NDArray[np.bool_], value: Array, lanes: Lanes, cells: Lanes, bound: Array
    ) -> None:
        """Cells next to a change point whose signs are only rounding are not looked at again."""
        settled[lanes, cells] = True
        near = np.maximum(np.abs(value[lanes, cells]), np.abs(value[lanes, cells + 1])) <= 100.0 * bound
        last = settled.shape[1] - 1
        settled[lanes[near], np.maximum(cells[near] - 1, 0)] = True
        settled[lanes[near], np.minimum(cells[near] + 1, last)] = True

    def _guard(self, group: int, lanes: Lanes, at: Array, order: int) -> Jet:
        taken = self.kinematics.taken(lanes)

        def branch(i: int, radicand: Number) -> Number:
            return JETS.sqrt(radicand) * self.branches.sign(i, at, lanes)

        with np.errstate(all="ignore"):
            guard = taken.guard(JETS, Jet.variable(at, order), group, branch)
        return (
            guard if isinstance(guard, Jet) else Jet((np.broadcast_to(guard, at.shape), *[0.0 * at] * order))
        )

    def _minima(self, group: int, lanes: Lanes, low: Array, high: Array) -> Array:
        def slope(x: Array) -> tuple[Array, Array]:
            jet = self._guard(group, lanes, x, 2)
            return jet.derivative(1), jet.derivative(2)

        return bracketed_roots(slope, low, high)

    def _roots(self, group: int, lanes: Lanes, low: Array, high: Array) -> Array:
        def guard(x: Array) -> tuple[Array, Array]:
            jet = self._guard(group, lanes, x, 1)
            return jet.value, jet.derivative(1)

        return bracketed_roots(guard, low, high) if len(lanes) else np.zeros(0)

    def with_bound(self, group: int, lanes: Lanes, at: Array) -> tuple[Array, Array]:
        """Radicand of a group with the bound of its rounding error."""
        return guard_with_bound(self.kinematics, self.branches, group, lanes, at)


def guard_with_bound(
    kinematics: Kinematics, branches: Branches, group: int, lanes: Lanes, at: Array
) -> tuple[Array, Array]:
    """Radicand of a group at parameters, one lane for each, with the bound of its rounding error."""

    def branch(i: int, radicand: Number) -> Number:
        return ROUNDED.sqrt(radicand) * branches.sign(i, at, lanes)

    with np.errstate(all="ignore"):
        guard = Rounded.of(kinematics.taken(lanes).guard(ROUNDED, Rounded.of(at), group, branch))
    return np.broadcast_to(guard.value, at.shape), np.broadcast_to(guard.bound, at.shape)


def _low_minima(mesh: Array, value: Array, slope: Array) -> tuple[Lanes, Lanes]:
    """Cells with a minimum that may reach zero."""
    left, right = value[:, :-1], value[:, 1:]
    falls, rises = slope[:, :-1], slope[:, 1:]
    with np.errstate(all="ignore"):
        step = np.diff(mesh)
        meeting = (right - left - rises * step) / (falls - rises)
        lowest = left + falls * meeting
        low = lowest <= LOW * np.minimum(left, right)
    lanes, cells = np.nonzero((falls < 0.0) & (rises >= 0.0) & low)
    return lanes, cells


def _sign_changes(value: Array) -> tuple[Lanes, Lanes]:
    with np.errstate(all="ignore"):
        lanes, cells = np.nonzero(value[:, :-1] * value[:, 1:] < 0.0)
    return lanes, cells


def _limits(group: int, lanes: Lanes, at: Array) -> list[Event]:
    return [Event("limit", group, int(lane), float(x)) for lane, x in zip(lanes, at, strict=True)]
