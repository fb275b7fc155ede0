"""What a simulation needs to know at a value of the drive, computed by the reduction itself."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.amounts import Diagram
from centrode.dynamics.coordinates import Coordinate
from centrode.dynamics.inertia import shares
from centrode.dynamics.loads import Acting
from centrode.dynamics.reducer import Reducer
from centrode.dynamics.simulation.sorts import SORTS, Sorted, formulas_of, sorted_efforts
from centrode.dynamics.states import Moving, State
from centrode.errors import InputError, Status
from centrode.locale import _

Array: TypeAlias = npt.NDArray[np.float64]
Known: TypeAlias = npt.NDArray[np.bool_]

INERTIA, SLOPE, FORWARDS, BACKWARDS = 0, 1, 2, 2 + len(SORTS)
FORMULAS = BACKWARDS + len(SORTS)
"""Rows: J, J', moments of placed loads by sort for either sense of the value, then three for each formula."""
COORDINATE, SPEED, ALONG, GATE = 0, 1, 2, 3
EACH = 4
"""Rows of a formula: its coordinate and the derivative of that; that of what it works along, where the drive's value
grows, and of the coordinate that lets it act."""
STILL = 1e-9
"""Derivative by the drive, over lengths, of what stands still: near change points it is known no better."""
FLOOR = 1e-3
"""Functions below this share of the greatest of their kind need be no more exact than that share."""


@dataclass(frozen=True)
class Rows:
    """Functions of the drive's value.

    Attributes
    ----------
    reducer : Reducer
    added : float [kg m^2]
        Inertia of what turns with the drive at a constant ratio.
    ends_at_change_points : bool
        Whether the motion goes no farther than to the change points next to the initial position.
    """

    reducer: Reducer
    added: float
    ends_at_change_points: bool = False

    @cached_property
    def efforts(self) -> tuple[Sorted, ...]:
        """All efforts of loads."""
        return sorted_efforts(self.reducer.ready.mechanism, self.reducer.burden.loads)

    @cached_property
    def formulas(self) -> tuple[Sorted, ...]:
        """Efforts that are computed anew at every time."""
        return formulas_of(self.efforts)

    @property
    def sense(self) -> float:
        """Sense of the drive: +1.0 or -1.0."""
        return self.reducer.ready.kinematics.path.forward

    @property
    def count(self) -> int:
        """How many rows there are."""
        return FORMULAS + EACH * len(self.formulas)

    def at(self, values: Array) -> Array:
        """All rows (rows, n); NaN where the motion or its derivatives do not exist."""
        found = np.empty((self.count, len(values)))
        for first, sense in ((BACKWARDS, -1.0), (FORWARDS, 1.0)):
            state, known = self.state(values, sense)
            for k, sort in enumerate(SORTS):
                placed = [one for one in self.efforts if one.placed and one.sort == sort]
                found[first + k] = sum((_moment(one, state, known) for one in placed), np.zeros(len(values)))
        inertia, slope = shares(state, self.reducer.burden.masses, (1, len(values)))
        found[INERTIA], found[SLOPE] = inertia.sum(axis=0)[0] + self.added, slope.sum(axis=0)[0]
        for j, one in enumerate(self.formulas):
            row, effort = FORMULAS + EACH * j, one.effort
            # some turnings on the sphere have no value, and nothing that asks for it
            found[row + COORDINATE] = effort.coordinate.value(state) if "x" in effort.amount.uses else 0.0
            found[row + SPEED] = effort.coordinate.slope(state).value
            found[row + ALONG] = effort.along(state)
            found[row + GATE] = 1.0 if effort.gate is None else effort.gate.slope(state).value
        found[:, ~known] = np.nan
        return found

    def state(self, values: Array, sense: float = 1.0) -> tuple[State, Known]:
        """Positions at values of the drive, and where they exist with their derivatives."""
        ones = np.ones(len(values))
        state, status = self.reducer.state(values, Moving(0.0 * ones, values, sense * ones))
        reached = np.isin(status, (Status.OK, Status.SINGULAR))
        return state, reached & np.broadcast_to(state.exists, (1, len(values)))[0]

    def jumps(self, low: float, high: float, some: Array) -> Array:
        """Values of the drive at which loads jump, between two; `some` values tell what moves at all.

        What does not move but for rounding does not turn round either.
        """
        state, known = self.state(some)
        least = STILL * max(1.0, self.reducer.ready.kinematics.path.scale)

        def moves(coordinate: Coordinate) -> bool:
            slope = np.broadcast_to(coordinate.slope(state).value, (1, len(some)))[0]
            return bool(np.max(np.abs(slope[known]), initial=0.0) > least)

        loads = [
            Acting(load.label, tuple(effort for effort in load.efforts if all(map(moves, effort.switches))))
            for load in self.reducer.burden.loads
        ]
        return self.reducer.jumps(low, high, loads)

    def scales(self, peaks: Array) -> Array:
        """What counts as the greatest value of each row, where one may be nothing but rounding beside others."""
        found = peaks.copy()
        found[SLOPE] = max(peaks[SLOPE], peaks[INERTIA])
        moments = slice(FORWARDS, FORMULAS)
        found[moments] = np.maximum(peaks[moments], FLOOR * np.max(peaks[moments]))
        along = FLOOR * max(1.0, self.reducer.ready.kinematics.path.scale)
        found[FORMULAS:] = np.maximum(peaks[FORMULAS:], along)
        return np.where(found > 0.0, found, 1.0)

    def energy(self, values: Array) -> Array:
        """Potential energy [J] of weights and springs (n), zero where their coordinates are."""
        state, _known = self.state(values)
        stored = [one for one in self.efforts if one.sort == SORTS[0]]
        return sum(
            (np.broadcast_to(one.energy(state), (1, len(values)))[0] for one in stored), np.zeros(len(values))
        )


def _moment(one: Sorted, state: State, known: Known) -> Array:
    """The reduced moment of a placed effort (n); InputError where it has none."""
    strength = np.broadcast_to(one.effort.strength(state), (1, len(known)))[0]
    lacking = known & ~np.isfinite(strength)
    if lacking.any():
        at = int(np.flatnonzero(lacking)[0])
        if isinstance(one.effort.amount, Diagram):
            x = np.broadcast_to(one.effort.coordinate.value(state), (1, len(known)))[0]
            raise one.effort.amount.refusal(float(x[at]))
        what = _("it has no finite value at {value:.6g}").format(value=float(state.parameter[at]))
        raise InputError(f"[[loads]] {one.label}", what, _("correct it"))
    return np.asarray(strength * one.effort.along(state)).reshape(-1)[: len(known)] + np.zeros(len(known))
