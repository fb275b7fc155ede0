"""States between fixed steps: an interpolant of the order of the scheme, made on the step itself.

On each step the cubic of Hermite through the states and slopes at both ends misses the solution by the fourth power of
the step. Slopes at two places between the ends, taken from that cubic, raise it to a polynomial of fifth degree that
misses by the fifth power (Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, 1993, II.6). No other
step is looked at, so a jump is felt on its own step alone.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

Array: TypeAlias = npt.NDArray[np.float64]
Rates: TypeAlias = Callable[[float, Array], Array]

INNER = (1.0 / 3.0, 2.0 / 3.0)
"""Places between the ends of a step, as shares of it, at which slopes are taken."""


@dataclass(frozen=True)
class Interpolant:
    """States at any time of a course of equal steps.

    Attributes
    ----------
    states : (states, steps + 1)
        At the ends of the steps.
    step : length of a step [s]
    rates : slopes of the states at a time and a state
    """

    states: Array
    step: float
    rates: Rates

    def __call__(self, times: Array) -> Array:
        """States (states, n) at times between the first and the last step; exactly those of the ends there."""
        count = self.states.shape[1] - 1
        places = times / self.step
        nearest = np.clip(np.rint(places).astype(np.intp), 0, count)
        states = np.asarray(self.states[:, nearest])
        # at steps the states themselves: the interpolant would differ by rounding
        between = np.flatnonzero(np.abs(times - nearest * self.step) > 4.0 * np.spacing(times))
        steps = np.clip(np.floor(places[between]).astype(np.intp), 0, max(count - 1, 0))
        for k in np.unique(steps) if count else ():
            some = between[steps == k]
            states[:, some] = self._on_step(int(k), places[some] - k)
        return states

    def _on_step(self, number: int, shares: Array) -> Array:
        """States at shares of a step."""
        h, begun = self.step, number * self.step
        y0, y1 = self.states[:, number], self.states[:, number + 1]
        # slopes times the step, so that shares of the step are the variable
        k0, k1 = h * self.rates(begun, y0), h * self.rates((number + 1) * h, y1)
        way = y1 - y0
        # y0 + way s + s (1 - s) ((k0 - way) (1 - s) - (k1 - way) s) is the cubic of Hermite
        ahead, behind = k0 - way, way - k1

        def cubic(s: Array | float) -> Array:
            inside = np.multiply.outer(ahead, (1.0 - s)) + np.multiply.outer(behind, s)
            return y0.reshape((-1,) + (1,) * np.ndim(s)) + np.multiply.outer(way, s) + s * (1.0 - s) * inside

        def slope(s: float) -> Array:
            return way + (1.0 - 2.0 * s) * ((1.0 - s) * ahead + s * behind) + s * (1.0 - s) * (behind - ahead)

        missed = [h * self.rates(begun + s * h, cubic(s)) - slope(s) for s in INNER]
        # s^2 (1 - s)^2 (a + b s) leaves the ends alone; its slope at the inner places is what the cubic's misses there
        matrix = [[2.0 * s * (1.0 - s) * (1.0 - 2.0 * s), s * s * (1.0 - s) * (3.0 - 5.0 * s)] for s in INNER]
        a, b = np.linalg.solve(np.array(matrix), np.array(missed))
        bump = (shares * (1.0 - shares)) ** 2
        return np.asarray(cubic(shares) + bump * (a[:, None] + np.multiply.outer(b, shares)))
