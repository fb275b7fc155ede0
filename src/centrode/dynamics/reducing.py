"""The reduction of a mechanism to its drive as a cycle asks for it."""

from __future__ import annotations

from collections.abc import Sequence

from centrode.dynamics.cycle import Reduction
from centrode.dynamics.quadrature import Array
from centrode.dynamics.reduction import Reducer
from centrode.model.mechanism import Mechanism


class Reduced:
    """A `Reducer` seen by a cycle."""

    def __init__(self, reducer: Reducer) -> None:
        self.reducer = reducer

    def at(self, values: Array, rate: Array) -> tuple[Array, Array, Array]:
        """Inertia, its derivative and moment at values and rates of the drive."""
        found = self.reducer.at(values, rate)
        return found.inertia, found.slope, found.moment

    def jumps(self, low: float, high: float) -> Sequence[float]:
        """Values of the drive between two where one-sided loads jump."""
        return self.reducer.jumps(low, high)


def reduction_of(mechanism: Mechanism) -> Reduction:
    """A mechanism reduced to its drive."""
    return Reduced(Reducer.of(mechanism))
