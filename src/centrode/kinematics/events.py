"""Limits and change points: where a group's radicand reaches zero along the path.

The radicand is looked at on a mesh that belongs to the mechanism, not to the samples requested, with its derivative at
each node and a bound of its second derivative in the cell about it. Cells in which it may have more than one zero are
divided (`cells`). A minimum of the radicand is refined by the root of its derivative: zero within the rounding error of
the formulas is a change point, below zero a pair of limits. Other sign changes are limits. A divisor's sign change is a
limit as well (the group's point goes to infinity), and so is a place where it touches zero.

Behind a group of higher class no second derivative is bounded: there minima and sign changes are looked for from node
to node.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.kinematics.cells import (
    FINEST,
    CellPieces,
    changes,
    clear,
    divide_cells,
    parts_of,
    straight,
    towards,
    unsettled_stretches,
    without_sign,
)
from centrode.kinematics.change_points import BranchedPlan, Rough, Windows, inside, numbers_of, set_numbers
from centrode.kinematics.mesh import CLOSING_IN, cut_cells, first_changes, largest_of, low_minima
from centrode.kinematics.path import JETS, Path, nearest_node
from centrode.kinematics.plan_evaluation import (
    Branches,
    Kinematics,
    RadicandZero,
    ReachedRadicand,
    count_turns,
    is_long_row,
)
from centrode.kinematics.quick_turns import QuickTurns
from centrode.numerics.arrays import ARRAYS, of_shape
from centrode.numerics.bends import BendFunctions, Bent, Cells
from centrode.numerics.jets import Jet
from centrode.numerics.rounding_bounds import ROUNDED, SAFETY, Rounded
from centrode.numerics.search import newton_roots, sign_changes
from centrode.structure.constraints import Positions
from centrode.structure.groups import Aim, Meet, Newton

# A plan run over bent numbers: bounds of second derivatives over cells, through interpolated stretches as
# well.

Array: TypeAlias = npt.NDArray[np.float64]
Lanes: TypeAlias = npt.NDArray[np.intp]
Number: TypeAlias = Any
Namespace: TypeAlias = Any

BENDS = BendFunctions(ARRAYS)


INSIDE = 0.95
"""Share of a circle's radius up to which the terms of a series bound its second derivative."""
ROOM = 2.0
"""What is known of a law at three places of a cell is taken this many times for the cell: laws are not bounded."""


def half_widths(mesh: Array) -> Array | float:
    """Half widths of the cells about the nodes of a mesh, which together cover it."""
    # cells reach half way to both neighbours; on an even mesh one number says so, and formulas stay scalar
    # there
    gaps = np.diff(mesh)
    widest = float(np.max(gaps))
    if np.min(gaps) >= 0.99 * widest:
        return 0.5 * widest
    return np.asarray(0.5 * np.maximum(np.append(gaps, 0.0), np.append(0.0, gaps)))


def bent_drives(path: Path, at: Array, cells: Cells) -> dict[str, Number]:
    """Values of all drives over cells about parameters; of laws of time the second derivative is looked at."""
    if not path.by_time:
        return path.drive_values(BENDS, BENDS.variable(at, cells))
    half = cells.half
    # laws are any formulas: their second derivative is looked at in the middle and at the ends of each cell
    looks = [Path.drive_values(path, JETS, Jet.variable(at + shift * half, 2)) for shift in (0.0, -1.0, 1.0)]
    values: dict[str, Number] = {}
    for drive, here in looks[0].items():
        if not isinstance(here, Jet):
            values[drive] = here
            continue
        value, slope = here.coefficients[:2]
        seconds = [look[drive].derivative(2) for look in looks]
        if all(np.ndim(x) == 0 and x == 0.0 for x in seconds):
            values[drive] = Bent(value, slope, 0.0, cells)
        else:
            values[drive] = Bent(
                value, slope, ROOM * np.max(np.abs(np.broadcast_arrays(*seconds)), axis=0), cells
            )
    return values


def bent_frame(kinematics: Kinematics, at: Array, half: Array | float) -> Positions:
    """Positions before the first group of the plan, as numbers with bounded bends over cells about parameters."""
    cells = Cells(half, ARRAYS, holds=is_long_row(kinematics.structure))
    return Positions.of_frame(kinematics.numbers, bent_drives(kinematics.path, at, cells), BENDS)


class Bending(Rough):
    """Signs and interpolated stretches as the branches have them, over bent numbers."""

    def __init__(self, continuation: BranchedPlan, parameter: Array, lanes: Lanes | None) -> None:
        super().__init__(continuation, BENDS, parameter, lanes)

    def higher(self, group: int, m: Namespace, at: Positions) -> None:
        """What a group of higher class gives are jets: nothing is known of their second derivatives."""
        # jets without a bound: the numbers behind this group are jets too, and their guards are searched
        # without bounds
        known = at.map_numbers(lambda x: Jet(x.coefficients) if isinstance(x, Bent) else x)
        super().higher(group, JETS, known)
        which = self.continuation.kinematics.structure.groups[group]
        assert isinstance(which, Newton)
        at.points.update({name: known.points[name] for name in which.points})
        at.poses.update({name: known.poses[name] for name in which.links})
        at.angles.update({name: known.angles[name] for name in which.links if name in known.angles})

    def after(self, group: int, at: Positions) -> None:
        continuation = self.continuation
        windows = continuation.windows_of(group)
        if windows is None:
            return
        # the closed form's numbers, before the series replaces them: their bends hold outside the circle
        before = numbers_of(continuation.kinematics, group, at)
        super().after(group, at)
        index, chosen = inside(windows, self.parameter.reshape(-1), self.lanes)
        if not len(chosen):
            return
        shape = self.parameter.shape
        if self.lanes is None:
            shape = continuation.branches.lanes, shape[-1]
        along = self.parameter.reshape(-1)[index[-1]]
        numbers = []
        for old, new, series in zip(
            before,
            numbers_of(continuation.kinematics, group, at),
            continuation.series_of(group).numbers,
            strict=True,
        ):
            if isinstance(old, Bent) and isinstance(new, Jet):
                half = np.broadcast_to(old.cells.half, shape)[index]
                bend = np.array(np.broadcast_to(old.bend, shape), dtype=np.float64)
                bend[index] = _bends(series, windows.of(chosen), chosen, along, half, bend[index])
                new = Bent(new.coefficients[0], new.coefficients[1], bend, old.cells)
            numbers.append(new)
        set_numbers(continuation.kinematics, group, at, numbers)


def _bends(series: Array, windows: Windows, chosen: Lanes, along: Array, half: Array, closed: Array) -> Array:
    """Bends over cells about places in windows, by the terms of the series; those of closed forms beyond it."""
    # the farthest place of the cell counts, in radii of the circle
    share = (np.abs(along - windows.centre) + half) / windows.radius
    bound = np.zeros(len(chosen))
    for k in range(series.shape[1] - 1, 1, -1):
        # the second derivative of each term at the edge of the cell, in absolute value, by Horner's rule
        bound = bound * share + k * (k - 1.0) * np.abs(series[chosen, k])
    # near the circle the remainder of the series is unknown: there the bound of the closed form is kept
    return np.where(share <= INSIDE, bound / windows.radius**2, closed)


# Radicands and divisors of groups at single places of the path, one mechanism for each, over any algebra.


@dataclass(frozen=True)
class Guards:
    """The numbers whose zeros are events; `lanes` are mechanisms and `at` parameters, both (k,)."""

    continuation: BranchedPlan

    def jets(self, group: int, lanes: Lanes, at: Array, order: int) -> Jet:
        """A group's number with derivatives."""
        hooks = self.continuation.hooks(JETS, at, lanes)
        with np.errstate(all="ignore"):
            guard = self.continuation.kinematics.take(lanes).guard(
                JETS, Jet.variable(at, order), group, hooks
            )
        return (
            guard if isinstance(guard, Jet) else Jet((np.broadcast_to(guard, at.shape), *[0.0 * at] * order))
        )

    def bend_bound(self, group: int, lanes: Lanes, at: Array, half: Array) -> tuple[Array, Array, Array]:
        """Value and slope, and a bound of the second derivative over cells of half widths."""
        used, hooks = self.continuation.kinematics.take(lanes), Bending(self.continuation, at, lanes)
        with np.errstate(all="ignore"):
            guard = used.guard_behind(bent_frame(used, at, half), BENDS, group, hooks)
        if not isinstance(guard, Bent):
            return np.broadcast_to(guard, at.shape), 0.0 * at, 0.0 * at
        value, slope, bend = (np.broadcast_to(x, at.shape) for x in (*guard.coefficients, guard.bend))
        return value, slope, bend

    def rounding_bound(self, group: int, lanes: Lanes, at: Array) -> tuple[Array, Array]:
        """Value with the bound of its rounding error."""
        return guard_with_bound(self.continuation, group, lanes, at)

    def roots(self, group: int, lanes: Lanes, low: Array, high: Array) -> Array:
        """Zeros between places of opposite signs."""

        def guard(x: Array) -> tuple[Array, Array]:
            jet = self.jets(group, lanes, x, 1)
            return jet.value, jet.derivative(1)

        return newton_roots(guard, low, high)

    def minima(self, group: int, lanes: Lanes, low: Array, high: Array) -> Array:
        """Zeros of the slope between places at which it has opposite signs."""

        def slope(x: Array) -> tuple[Array, Array]:
            jet = self.jets(group, lanes, x, 2)
            return jet.derivative(1), jet.derivative(2)

        return newton_roots(slope, low, high)


def guard_with_bound(continuation: BranchedPlan, group: int, lanes: Lanes, at: Array) -> tuple[Array, Array]:
    """Radicand of a group at parameters, one lane for each, with the bound of its rounding error."""
    hooks = continuation.hooks(ROUNDED, at, lanes)
    with np.errstate(all="ignore"):
        used = continuation.kinematics.take(lanes)
        guard = Rounded.of(used.guard(ROUNDED, Rounded.of(at), group, hooks))
    return np.broadcast_to(guard.value, at.shape), np.broadcast_to(guard.bound, at.shape)


# Where a group's radicand or divisor passes zero on a mesh, or touches it: by bounds of its second
# derivative.
#
# Cells that are known need nothing but the signs at their nodes. In the others the least sizes are found by
# the root of the derivative, as far as nodes foretell them; then the cells are divided until they are known
# (`cells`). What is left are places: a sign that is only rounding is none, and a least size within the
# rounding error of the formulas is zero.

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
        """Signs and events of the groups solved before."""
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
            # NaN, of groups that are open there, is not looked into: events lie where there is a value
            there = np.isfinite(value)
            stops = self._stops(group)
            # a cell beside which a group before stops, or turns fast, is looked into though nodes say nothing
            rough = there & ~known
            rough[stops.lane, stops.node] |= ~known[stops.lane, stops.node]
            lanes, cells = np.nonzero(
                there[:, :-1]
                & there[:, 1:]
                & (value[:, :-1] * value[:, 1:] < 0.0)
                & ~(rough[:, :-1] | rough[:, 1:])
                # known cells: the signs at neighbouring nodes tell everything
            )
            ends = lanes, self.mesh[cells], self.mesh[cells + 1]
            if not rough.any():
                return (lanes, self.guards.roots(group, *ends)), NOWHERE
            minima = self._looked_into(group, value, slope, rough, stops)
            pieces = self._divide_cells(group, value, rough, (stops, minima))
            pieces = self._sign_cells(group, pieces, stops, minima, greatest)
            others = self._unforeseen(group, pieces, minima)
        more = changes(pieces, SLACK * self._finest)
        lanes, low, high = (
            np.concatenate([ends[0], more[0]]),
            np.concatenate([ends[1], more[1]]),
            np.concatenate([ends[2], more[2]]),
        )
        zeros = (minima, others)
        touched = (
            np.concatenate([each.lane[each.touches] for each in zeros]),
            np.concatenate([each.at[each.touches] for each in zeros]),
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
        events = [e for e in self.branches.events if e.group < group and e.kind in kinds]
        quick = [self._quick(before) for before in range(group)]
        lanes = np.concatenate(
            [np.array([e.lane for e in events], dtype=np.intp), *(each[0] for each in quick)]
        )
        at = np.concatenate(
            [np.array([e.at for e in events], dtype=np.float64), *(each[1] for each in quick)]
        )
        walls, blind = np.zeros(len(at), dtype=bool), np.zeros(len(at), dtype=bool)
        walls[: len(events)] = [e.kind == "limit" for e in events]
        blind[: len(events)] = True
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
        # beside a stop, nodes foretell nothing, as slopes run like a square root there
        looked[stops.lane[blind], np.searchsorted(self.mesh, stops.at[blind]) - 1] = False
        looked &= sign[:, :-1] == sign[:, 1:]
        lanes, cells = low_minima(self.mesh, sign * value, sign * slope, looked)
        at = self.guards.minima(group, lanes, self.mesh[cells], self.mesh[cells + 1])
        return self._touching(group, lanes, at, sign[lanes, cells])

    def _touching(self, group: int, lanes: Lanes, at: Array, sign: Array) -> _Minima:
        least, bound = self.guards.rounding_bound(group, lanes, at) if len(lanes) else (at, at)
        near = np.abs(least) <= SAFETY * bound
        # a radicand that touches zero from below closes in one place, and is not passed
        touches = near & ((sign > 0.0) | (group not in self.branches.signs))
        return _Minima(lanes, at, self._nodes_at(at), np.where(near, 0.0, least), touches)

    def _divide_cells(self, group: int, value: Array, rough: Mask, places: Sequence[_Places]) -> CellPieces:
        """The rough cells in parts that are known, with the nodes beside them."""
        half = np.broadcast_to(self.half, self.mesh.shape)
        lanes = np.concatenate([each.lane for each in places])
        # places in which something happens divide their own cells unevenly: parts get shorter towards them
        at = np.concatenate([each.at for each in places])
        nodes = np.concatenate([each.node for each in places])
        inside = rough[lanes, nodes] & np.isfinite(at)
        lanes, at, nodes = lanes[inside], at[inside], nodes[inside]
        order = np.lexsort((at, lanes))
        lanes, at, nodes = lanes[order], at[order], nodes[order]
        low, high = self.mesh[nodes] - half[nodes], self.mesh[nodes] + half[nodes]
        # of two places in one cell each gets the part up to the middle between them
        together = (np.diff(lanes) == 0) & (np.diff(nodes) == 0)
        middle = 0.5 * (at[1:] + at[:-1])[together]
        low[1:][together], high[:-1][together] = middle, middle
        # all other rough cells are cut evenly
        plain = rough.copy()
        plain[lanes, nodes] = False
        rows, cells = np.nonzero(plain)
        parts = CellPieces.join(
            parts_of(CellPieces.of(rows, self.mesh[cells], half[cells])), towards(lanes, low, high, at)
        )
        divided = divide_cells(parts, lambda *cell: self.guards.bend_bound(group, *cell), self.branches.unit)
        # nodes beside rough cells close the chain: their signs are known
        beside = np.zeros(rough.shape, dtype=bool)
        beside[:, 1:] |= rough[:, :-1]
        beside[:, :-1] |= rough[:, 1:]
        rows, cells = np.nonzero(beside & ~rough & np.isfinite(value))
        return CellPieces.join(
            divided, CellPieces.of(rows, self.mesh[cells], half[cells], value[rows, cells], nodes=True)
        )

    def _sign_cells(
        self, group: int, pieces: CellPieces, stops: _Stops, minima: _Minima, greatest: Array
    ) -> CellPieces:
        # walls and minima become cells of their own, so that neighbours in the order of the path tell what
        # lies between
        """Cells in the order of the path, with the least sizes as cells of their own; zero where a sign is rounding."""
        size = np.where(np.isfinite(pieces.value), np.abs(pieces.value), 0.0)
        most = greatest.copy()  # where a group before turns fast, the nodes may have seen little of it
        np.maximum.at(most, pieces.lane, size)
        faint = np.abs(pieces.value) <= DOUBTFUL * most[pieces.lane]
        doubtful = np.nonzero(~pieces.nodes & (~pieces.known | faint))[0]
        value = pieces.value.copy()
        if len(doubtful):
            _value, bound = self.guards.rounding_bound(group, pieces.lane[doubtful], pieces.centre[doubtful])
            # a sign within the rounding error of the formulas is none
            value[doubtful[~(np.abs(value[doubtful]) > SAFETY * bound)]] = 0.0
        cores = CellPieces.of(minima.lane, minima.at, self._finest, minima.least)
        walls = CellPieces.of(stops.lane, stops.at, self._finest, np.inf).take(stops.walls)
        cores = cores.take(np.isfinite(minima.least))
        return CellPieces.join(replace(pieces, value=value), cores, walls).sort_by_path()

    def _unforeseen(self, group: int, pieces: CellPieces, minima: _Minima) -> _Minima:
        """The least sizes between cells of one sign, where no node foretold one.

        They are looked for where zeros lie between two cells, and where a cell was not divided until it was known.
        """
        slack = SLACK * self._finest
        lanes, low, high, sign = (
            np.concatenate(both)
            for both in zip(without_sign(pieces, slack), unsettled_stretches(pieces, slack), strict=True)
            # of these stretches those with a minimum between their ends that nodes had foretold are looked into
            # already
        )
        foretold = np.zeros(len(lanes), dtype=bool)
        for k in range(len(lanes)):
            near = minima.at[minima.lane == lanes[k]]
            foretold[k] = ((near > low[k]) & (near < high[k])).any()
        lanes, low, high, sign = lanes[~foretold], low[~foretold], high[~foretold], sign[~foretold]
        if len(lanes):
            falls, rises = (sign * self.guards.jets(group, lanes, x, 1).derivative(1) for x in (low, high))
            # only a size that falls at the first end and rises at the last has a least value between them
            turns = (falls < 0.0) & (rises >= 0.0)
            lanes, low, high, sign = lanes[turns], low[turns], high[turns], sign[turns]
        return self._touching(group, lanes, self.guards.minima(group, lanes, low, high), sign)


BESIDE_POLE = 1e-6
"""Share of a cell beside a place at infinity where a radicand has its sign again, and not that of rounding."""


@dataclass(frozen=True)
class EventScan:
    """Search for the events of all groups of a plan, one group after the other."""

    continuation: BranchedPlan
    mesh: Array

    @property
    def kinematics(self) -> Kinematics:
        """The plan that is searched."""
        return self.continuation.kinematics

    @property
    def branches(self) -> Branches:
        """Record of signs and events, which the scan fills."""
        return self.continuation.branches

    def run(self) -> Positions:
        """Find all events, record them in the branches, and return the positions on the mesh as plain arrays."""
        groups = self.kinematics.structure.groups
        # the last group with a radicand or divisor: behind it nothing can lock
        last = max((i for i, group in enumerate(groups) if isinstance(group, (Meet, Aim))), default=0)
        along = self.mesh[None, :]
        with np.errstate(all="ignore"):
            at = bent_frame(self.kinematics, along, self.zeros.half)
            with suppress(ReachedRadicand):  # slopes are needed up to the last radicand, and not beyond
                self.kinematics.advance(at, range(last + 1), BENDS, _Searching(self, last))
            # from there on values suffice, and angles are still counted
            plain = at.map_numbers(lambda x: x.value if isinstance(x, Jet) else x)
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
        """Search for zeros of radicands and divisors whose second derivatives are bounded."""
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
            events += [
                RadicandZero("change point", group, int(k), float(x)) for k, x in zip(*touches, strict=True)
            ]
        # recorded before the group's sign is requested
        self.branches.add(group, events)

    def find_poles(self, group: int, divisor: Number) -> None:
        """Record where a group goes to infinity."""
        value, slope = self._on_mesh(divisor)
        bend = self._bend_on_mesh(divisor)
        if bend is None:
            lanes, cells = sign_changes(value)
            poles = self.guards.roots(group, lanes, self.mesh[cells], self.mesh[cells + 1])
            places = [(lanes, poles), self._beside_limits(group, value)]
        else:
            places = list(self.zeros.found(group, value, slope, bend, largest_of(value)))
        limits = [
            RadicandZero("limit", group, int(k), float(x))
            for place in places
            for k, x in zip(*place, strict=True)
        ]
        self.branches.add(group, limits)

    def _on_mesh(self, jet: Number) -> tuple[Array, Array]:
        shape = (self.branches.lanes, len(self.mesh))
        if not isinstance(jet, Jet):
            return of_shape(jet, shape), np.zeros(shape)
        return of_shape(jet.value, shape), of_shape(jet.derivative(1), shape)

    def _bend_on_mesh(self, jet: Number) -> Array | None:
        """Bound of the second derivative about each node; None where nothing is known of it."""
        shape = (self.branches.lanes, len(self.mesh))
        if isinstance(jet, Bent):
            return of_shape(jet.bend, shape)
        return None if isinstance(jet, Jet) else np.zeros(shape)

    def _events(self, group: int, value: Array, slope: Array) -> list[RadicandZero]:
        events: list[RadicandZero] = []
        settled = np.zeros((value.shape[0], value.shape[1] - 1), dtype=bool)
        lanes, cells = low_minima(self.mesh, value, slope)
        if len(lanes):
            at = self.guards.minima(group, lanes, self.mesh[cells], self.mesh[cells + 1])
            least, bound = self.guards.rounding_bound(group, lanes, at)
            # where a group before this one goes to infinity, the radicand's error exceeds the radicand itself
            certain = SAFETY * bound <= self.branches.largest[group][lanes]
            touches = certain & (np.abs(least) <= SAFETY * bound)
            events += [
                RadicandZero("change point", group, int(lane), float(x))
                for lane, x in zip(lanes[touches], at[touches], strict=True)
            ]
            self._settle(settled, value, lanes[touches], cells[touches], SAFETY * bound[touches])
            dips = ~touches & (~certain | (least < 0.0))
            aside = np.where(certain, 0.0, BESIDE_POLE * (self.mesh[cells + 1] - self.mesh[cells]))
            # on both sides of a minimum below zero the radicand passes zero once
            for first, last, edge in (
                (self.mesh[cells], at - aside, value[lanes, cells]),
                (at + aside, self.mesh[cells + 1], value[lanes, cells + 1]),
            ):
                chosen = dips & (edge > 0.0)
                roots = self.guards.roots(group, lanes[chosen], first[chosen], last[chosen])
                events += self._limits(group, lanes[chosen], roots)
            settled[lanes[dips], cells[dips]] = True
        # what a minimum explained is not explained again
        lanes, cells = sign_changes(value)
        rest = ~settled[lanes, cells]
        roots = self.guards.roots(group, lanes[rest], self.mesh[cells[rest]], self.mesh[cells[rest] + 1])
        beside = self._beside_limits(group, value)
        return events + self._limits(group, lanes[rest], roots) + self._limits(group, *beside)

    def _beside_limits(self, group: int, value: Array) -> tuple[Lanes, Array]:
        """Lanes and places of limits in the part of a cell that is left of it where an earlier group stops.

        Behind that group's limit there is no radicand, and before it the radicand may run like a square root: it is
        looked at on places that close in on the limit.
        """
        lanes, cells, ends = cut_cells(self.branches.events, self.mesh, value)
        if not len(lanes):
            return lanes, ends
        # the node of the cell that still has a value
        nodes = np.where(np.isfinite(value[lanes, cells]), self.mesh[cells], self.mesh[cells + 1])
        places = ends[:, None] + (nodes - ends)[:, None] * CLOSING_IN
        guard, bound = self.guards.rounding_bound(group, np.repeat(lanes, len(CLOSING_IN)), places.ravel())
        # what is rounding has no sign: groups that stop together do not stop each other
        signs = np.where(np.abs(guard) > SAFETY * bound, np.sign(guard), 0.0).reshape(places.shape)
        # only the first change of sign counts: behind it the mechanism is locked
        rows, last, first = first_changes(signs)
        ends = np.sort([places[rows, last], places[rows, first]], axis=0)
        return lanes[rows], self.guards.roots(group, lanes[rows], *ends)

    def _limits(self, group: int, lanes: Lanes, at: Array) -> list[RadicandZero]:
        if not len(lanes):
            return []
        rises = self.guards.jets(group, lanes, at, 1).derivative(1) > 0.0
        return [
            RadicandZero("limit", group, int(lane), float(x), bool(up))
            for lane, x, up in zip(lanes, at, rises, strict=True)
        ]

    def _settle(
        self, settled: npt.NDArray[np.bool_], value: Array, lanes: Lanes, cells: Lanes, bound: Array
    ) -> None:
        """Cells next to a change point whose signs are only rounding are not looked at again."""
        settled[lanes, cells] = True
        # a radicand this near to its rounding error may change its sign by rounding in the next cells too
        near = np.maximum(np.abs(value[lanes, cells]), np.abs(value[lanes, cells + 1])) <= 100.0 * bound
        last = settled.shape[1] - 1
        settled[lanes[near], np.maximum(cells[near] - 1, 0)] = True
        settled[lanes[near], np.minimum(cells[near] + 1, last)] = True


class _Counting(Rough):
    """Counts the turns of angles along the mesh, for all that is requested afterwards."""

    def __init__(self, scan: EventScan, m: Namespace) -> None:
        super().__init__(scan.continuation, m, scan.mesh[None, :], None)
        self.scan = scan

    def continue_angle(self, group: int, key: str, angle: Number) -> Number:
        count(self.scan, group, key, angle)
        return super().continue_angle(group, key, angle)

    def higher(self, group: int, m: Namespace, at: Positions) -> None:
        self.scan.trace(group)
        super().higher(group, m, at)


class _Searching(Bending):
    """Looks for the events of every group before it asks for its sign; goes no further than the last radicand."""

    def __init__(self, scan: EventScan, last: int) -> None:
        super().__init__(scan.continuation, scan.mesh[None, :], None)
        self.scan = scan
        self.last = last

    def continue_angle(self, group: int, key: str, angle: Number) -> Number:
        count(self.scan, group, key, angle)
        return super().continue_angle(group, key, angle)

    def root(self, group: int, radicand: Jet) -> Number:
        self.scan.find(group, radicand)
        if group == self.last:
            raise ReachedRadicand(radicand)
        return super().root(group, radicand)

    def higher(self, group: int, m: Namespace, at: Positions) -> None:
        if group == self.last:
            raise ReachedRadicand(None)  # no radicand at all
        self.scan.trace(group)
        super().higher(group, m, at)

    def divisor(self, group: int, divisor: Number) -> Number:
        if isinstance(divisor, Jet):
            self.scan.find_poles(group, divisor)
        return divisor


def count(scan: EventScan, group: int, key: str, angle: Number) -> None:
    """Count the turns of an angle on the mesh."""
    branches, mesh = scan.branches, scan.mesh
    quick = QuickTurns(scan.continuation, mesh, group).in_plan(group, key)
    branches.turns[key] = count_turns(angle, mesh, branches.angles.get(key, 0.0), branches.initial, quick)
