"""Least and greatest values of a function on panels, found between its nodes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from centrode.dynamics.steady_motion.quadrature import Array, Function, Panels

PARTS = 32
ROUNDS = 11
"""Into so many parts a stretch about an extreme is cut, so often: down to rounding."""
NEAR = 0.01
"""Share of the range within which a second extreme at the nodes may be the greater one between them."""


@dataclass(frozen=True)
class Extremes:
    """Least and greatest value, and where they lie."""

    least: float
    at_least: float
    greatest: float
    at_greatest: float

    @property
    def range(self) -> float:
        """Greatest less least."""
        return self.greatest - self.least


def extremes(panels: Panels, value: Function, slope: Function) -> Extremes:
    """Extremes of a periodic function over its panels.

    Parameters
    ----------
    value, slope : places (n) -> (n)
        The function, and something of the sign of its derivative; it may jump at edges of panels.

    Notes
    -----
    Extremes at the nodes are narrowed down by the sign of the slope, so also where it jumps: places are exact to
    rounding over curvature, values to rounding. Two extremes between neighbouring nodes are missed.
    """
    places = np.unique(np.concatenate([panels.nodes, panels.edges]))
    values = value(places)
    at_greatest, greatest = _greatest(places, values, value, slope, 1.0)
    at_least, least = _greatest(places, -values, value, slope, -1.0)
    return Extremes(least, at_least, greatest, at_greatest)


def _greatest(
    places: Array, values: Array, value: Function, slope: Function, sign: float
) -> tuple[float, float]:
    """Place and value of the greatest of `sign` times a function."""
    floor = float(values.max()) - NEAR * float(np.ptp(values))
    before, after = np.append(-np.inf, values[:-1]), np.append(values[1:], -np.inf)
    tops = np.flatnonzero((values >= before) & (values >= after) & (values >= floor))
    tops = tops[:1000]  # a constant has nothing but tops
    low, high = places[np.maximum(tops - 1, 0)], places[np.minimum(tops + 1, len(places) - 1)]
    shares, rows = np.linspace(0.0, 1.0, PARTS + 1), np.arange(len(tops))
    for _round in range(ROUNDS):
        cuts = low[:, None] + shares * (high - low)[:, None]
        cuts[:, -1] = high
        rises = sign * slope(cuts[:, 1:-1].reshape(-1)).reshape(len(tops), -1) > 0.0
        first = np.cumprod(rises, axis=1).sum(axis=1)
        low, high = cuts[rows, first], cuts[rows, first + 1]
    found = np.concatenate([0.5 * (low + high), places[tops]])
    heights = value(found)
    best = int(np.argmax(sign * heights))
    return float(found[best]), float(heights[best])
