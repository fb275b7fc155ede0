"""How fast several drives move together: the unit of time on which events are looked for, stretch by stretch.

Stretches of time are counted from zero and double in length (dyadic), whatever range is asked for, so that the
mesh belongs to the mechanism: a longer range adds nodes, and moves none.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from math import frexp, tau
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

Array: TypeAlias = npt.NDArray[np.float64]

NODES_PER_TURN = 720
"""Mesh on which events are looked for: two events closer than half a degree may be missed."""
OFF_GRID = 0.37
"""Mesh nodes stand this share of a step away from the initial position: events like to lie at round values."""
RATES = 1000
"""Times at which the rates of the drives are compared on one stretch."""
SHORTEST, LONGEST = -40, 20
"""Powers of two [s] between which the first stretch is chosen."""


@dataclass(frozen=True)
class Pace:
    """Units of time in which the fastest drive moves 1 rad, or the mechanism's greatest length.

    Attributes
    ----------
    rates : times [s] -> the fastest drive's rate at each, in units (1 rad, the greatest length) per second
    base : float [s]
        Length of the first stretch, a power of two: the drives move at most a turn on it.
    """

    rates: Callable[[Array], Array]
    base: float
    _units: dict[int, float] = field(default_factory=dict, compare=False, repr=False)

    @classmethod
    def of(cls, rates: Callable[[Array], Array]) -> Pace:
        """The pace of drives with these rates."""
        powers = 2.0 ** np.arange(SHORTEST, LONGEST + 1)
        times = powers[:, None] * np.linspace(0.5, 1.0, RATES // 4)
        fastest = np.maximum.accumulate(
            np.max(_finite(rates(times.reshape(-1))).reshape(times.shape), axis=1)
        )
        with np.errstate(over="ignore"):  # a law may grow without bound long after any range
            slow = np.nonzero(fastest * powers <= tau)[0]
        return cls(rates, float(powers[slow[-1]] if len(slow) else powers[0]))

    def unit_at(self, time: float) -> float:
        """Unit of time [s] of the stretch that a time lies in."""
        return self._unit(self._stretch(time))

    def finest(self, low: float, high: float) -> float:
        """The least unit of the stretches between two times."""
        return min(self._unit(k) for k in self._stretches(low, high))

    def turns(self, low: float, high: float) -> float:
        """How many turns of the fastest drive, at its greatest rate on each stretch, lie between two times."""
        total = 0.0
        for k in self._stretches(low, high):
            first, last = _ends(k, self.base)
            total += max(0.0, min(high, last) - max(low, first)) / (tau * self._unit(k))
        return total

    def beyond(self, low: float, high: float, units: float) -> tuple[float, float]:
        """A range with so many units added at both ends; those of the next stretches count where they are near."""
        return self._moved(low, -units), self._moved(high, units)

    def nodes(self, low: float, high: float) -> Array:
        """Mesh nodes from the last one below `low` to the first one above `high`."""
        found = []
        for k in self._stretches(self._moved(low, -0.1), self._moved(high, 0.1)):
            first, last = _ends(k, self.base)
            step = self._unit(k) * tau / NODES_PER_TURN
            least = max(0, int(np.floor((low - first) / step)) - 2)
            most = int(np.ceil((min(high, last) - first) / step)) + 2
            nodes = first + (np.arange(least, most + 1, dtype=np.float64) + OFF_GRID) * step
            found.append(nodes[nodes < last])
        return np.concatenate(found)

    def _moved(self, time: float, units: float) -> float:
        here = self._stretch(time)
        there = here + (1 if units > 0.0 else -1)
        reached = time + units * self._unit(here)
        return (
            min(reached, time + units * self._unit(there))
            if units < 0.0
            else max(reached, time + units * self._unit(there))
        )

    def _stretch(self, time: float) -> int:
        """Number of the stretch: 0 from zero to the base, then doubling; -1 the base before zero, doubling too."""
        ratio = abs(time) / self.base
        power = max(frexp(ratio)[1], 0) if ratio >= 1.0 else 0
        if time >= 0.0:
            return power
        # a stretch holds its lower end, so a power of two before zero belongs to the stretch nearer to zero
        return -power if frexp(ratio)[0] == 0.5 and ratio >= 1.0 else -power - 1

    def _stretches(self, low: float, high: float) -> range:
        return range(self._stretch(low), self._stretch(high) + 1)

    def _unit(self, stretch: int) -> float:
        if stretch not in self._units:
            first, last = _ends(stretch, self.base)
            fastest = float(np.max(_finite(self.rates(np.linspace(first, last, RATES)))))
            length = last - first
            # drives at rest tell nothing: then the stretch itself has to do
            self._units[stretch] = 1.0 / fastest if fastest * length > 1.0 else length
        return self._units[stretch]


def _ends(stretch: int, base: float) -> tuple[float, float]:
    """First and last time of a stretch."""
    if stretch < 0:
        last, first = _ends(-1 - stretch, base)
        return -first, -last
    return (base * 2.0 ** (stretch - 1) if stretch else 0.0), base * 2.0**stretch


def _finite(rates: Array) -> Array:
    """Rates with those that do not exist counted as rest."""
    return np.where(np.isfinite(rates), rates, 0.0)


def nearest_node(mesh: Array, parameter: Array) -> npt.NDArray[np.intp]:
    """Number of the mesh node nearest to each parameter."""
    return np.searchsorted(0.5 * (mesh[1:] + mesh[:-1]), parameter)
