"""Radicands and divisors of groups at single places of the path, one mechanism for each, over any algebra."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.bends import Bent
from centrode.algebra.jets import Jet
from centrode.algebra.rounding import ROUNDED, Rounded
from centrode.kinematics.bending import BENDS, Bending, bent_frame
from centrode.kinematics.continuation import Continuation
from centrode.kinematics.paths import JETS
from centrode.numerics.search import newton_roots

Array: TypeAlias = npt.NDArray[np.float64]
Lanes: TypeAlias = npt.NDArray[np.intp]


@dataclass(frozen=True)
class Guards:
    """The numbers whose zeros are events; `lanes` are mechanisms and `at` parameters, both (k,)."""

    continuation: Continuation

    def jets(self, group: int, lanes: Lanes, at: Array, order: int) -> Jet:
        """A group's number with derivatives."""
        hooks = self.continuation.hooks(JETS, at, lanes)
        with np.errstate(all="ignore"):
            guard = self.continuation.kinematics.taken(lanes).guard(
                JETS, Jet.variable(at, order), group, hooks
            )
        return (
            guard if isinstance(guard, Jet) else Jet((np.broadcast_to(guard, at.shape), *[0.0 * at] * order))
        )

    def bent(self, group: int, lanes: Lanes, at: Array, half: Array) -> tuple[Array, Array, Array]:
        """Value and slope, and a bound of the second derivative over cells of half widths."""
        used, hooks = self.continuation.kinematics.taken(lanes), Bending(self.continuation, at, lanes)
        with np.errstate(all="ignore"):
            guard = used.guard_behind(bent_frame(used, at, half), BENDS, group, hooks)
        if not isinstance(guard, Bent):
            return np.broadcast_to(guard, at.shape), 0.0 * at, 0.0 * at
        value, slope, bend = (np.broadcast_to(x, at.shape) for x in (*guard.coefficients, guard.bend))
        return value, slope, bend

    def rounded(self, group: int, lanes: Lanes, at: Array) -> tuple[Array, Array]:
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


def guard_with_bound(continuation: Continuation, group: int, lanes: Lanes, at: Array) -> tuple[Array, Array]:
    """Radicand of a group at parameters, one lane for each, with the bound of its rounding error."""
    hooks = continuation.hooks(ROUNDED, at, lanes)
    with np.errstate(all="ignore"):
        used = continuation.kinematics.taken(lanes)
        guard = Rounded.of(used.guard(ROUNDED, Rounded.of(at), group, hooks))
    return np.broadcast_to(guard.value, at.shape), np.broadcast_to(guard.bound, at.shape)
