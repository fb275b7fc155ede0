"""Extremes over a turn of a cam of what a follower's motion decides, with both sides of every edge."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from centrode.cams.followers.forces.demand import Lifting
from centrode.numerics.search import tops

Array = NDArray[np.float64]
OfRows = Callable[[Array], Array]
"""From lift and derivatives (3, n) to values (n)."""

NODES = 181
"""Angles of a stretch among which an extreme is looked for before it is refined."""

STEP = 1e-9
"""Slopes at an edge that differ by less, over the greatest slope, are taken for equal."""


@dataclass(frozen=True)
class Extreme:
    """A greatest or least value and the angle of the cam [rad] where it is; NaN where nothing is known."""

    value: float
    angle: float


def greatest(motion: Lifting, value: OfRows) -> Extreme:
    """The greatest value over a turn; values that are NaN do not count, NaN where there are no others.

    Every stretch is looked at by itself, its end from inside, so that what jumps at an edge counts on both sides.
    """
    return greatest_between(motion.edges, lambda phi: value(motion.lift(phi, 2)))


def greatest_between(edges: Sequence[float], value: Callable[[Array], Array]) -> Extreme:
    """The greatest value of a function of angles (n) [rad], smooth between edges, as `greatest`."""
    best = Extreme(math.nan, edges[0])
    for start, stop in pairwise(edges):
        places, values = tops(value, np.linspace(start, inside(start, stop), NODES), most=1)
        if places.size and not values[0] <= best.value:
            best = Extreme(float(values[0]), float(places[0]))
    return best


def least(motion: Lifting, value: OfRows) -> Extreme:
    """The least value over a turn, as `greatest`."""
    found = greatest(motion, lambda rows: -value(rows))
    return Extreme(0.0 - found.value, found.angle)  # no zero below zero


def slope_drops(motion: Lifting) -> list[float]:
    """Edges [rad] at which the slope of the lift falls by a step: no spring keeps the contact there."""
    starts = np.array(motion.edges[:-1])
    ends = np.array([inside(start, stop) for start, stop in pairwise(motion.edges)])
    after = motion.lift(starts, 1)[1]
    before = np.roll(motion.lift(ends, 1)[1], 1)
    scale = greatest(motion, lambda rows: np.abs(rows[1])).value
    return [float(at) for at, step in zip(starts, after - before, strict=True) if step < -STEP * scale]


def inside(start: float, stop: float) -> float:
    """The end of a stretch, seen from inside: at the edge itself holds what begins there."""
    return float(np.nextafter(stop, start))
