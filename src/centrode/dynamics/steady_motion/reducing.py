"""The reduction of a mechanism to its drive as a cycle asks for it."""

from __future__ import annotations

from collections.abc import Sequence

from centrode.dynamics.reducer import Reducer
from centrode.dynamics.steady_motion.cycle import Reduction
from centrode.dynamics.steady_motion.quadrature import Array
from centrode.model.mechanism import Mechanism


class Reduced:
    """A `Reducer` seen by a cycle; the time in formulas of loads runs as at the mean speed."""

    def __init__(self, reducer: Reducer) -> None:
        self.reducer = reducer
        path = reducer.ready.kinematics.path
        self.first, self.steady = path.driven[0].start, reducer.default_rate or path.forward

    def at(self, values: Array, rate: Array) -> tuple[Array, Array, Array]:
        """Inertia, its derivative and moment at values and rates of the drive."""
        found = self.reducer.at(values, rate, time=(values - self.first) / self.steady)
        return found.inertia, found.inertia_slope, found.moment

    def jumps(self, low: float, high: float) -> Sequence[float]:
        """Values of the drive between two where one-sided loads jump."""
        found: list[float] = self.reducer.jumps(low, high).tolist()
        return found


def reduction_of(mechanism: Mechanism) -> Reduction:
    """A mechanism reduced to its drive."""
    return Reduced(Reducer.of(mechanism))
