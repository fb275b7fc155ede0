"""Extremes over a turn of a cam of what a follower's motion decides, with both sides of every edge."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar

from centrode.cams.followers.forces.demand import Lifting

Array = NDArray[np.float64]
OfRows = Callable[[Array], Array]
"""From lift and derivatives (3, n) to values (n)."""

NODES = 97
"""Nodes of a stretch among which an extreme is looked for before it is refined."""

ASIDE = 1e-13
"""A stretch's end is looked at from inside: by this share of the stretch before it."""

FINE = 1e-11
"""An angle is refined to this share of its stretch; a flat top is known to some 1e-8 of it."""

STEP = 1e-9
"""Slopes at an edge that differ by less, over the greatest slope, are taken for equal."""


@dataclass(frozen=True)
class Extreme:
    """A greatest value and the angle of the cam [rad] where it is; minus infinity at NaN where nothing is known."""

    value: float
    angle: float


def greatest(motion: Lifting, value: OfRows) -> Extreme:
    """The greatest value over a turn; values that are NaN do not count.

    Every stretch is looked at by itself, its end from inside, so that what jumps at an edge counts on both sides.
    """
    best = Extreme(-math.inf, math.nan)
    for start, stop in pairwise(motion.edges):
        best = max(best, _within(motion, value, start, stop), key=lambda one: one.value)
    return best


def least(motion: Lifting, value: OfRows) -> Extreme:
    """The least value over a turn, as `greatest`."""
    found = greatest(motion, lambda rows: -value(rows))
    return Extreme(-found.value, found.angle)


def slope_drops(motion: Lifting) -> list[float]:
    """Edges [rad] at which the slope of the lift falls by a step: no spring keeps the contact there."""
    starts = np.array(motion.edges[:-1])
    ends = np.array([_inside(start, stop) for start, stop in pairwise(motion.edges)])
    after = motion.lift(starts, 1)[1]
    before = np.roll(motion.lift(ends, 1)[1], 1)
    scale = greatest(motion, lambda rows: np.abs(rows[1])).value
    return [float(at) for at, step in zip(starts, after - before, strict=True) if step < -STEP * scale]


def _inside(start: float, stop: float) -> float:
    """The end of a stretch, seen from inside."""
    return stop - max(ASIDE * (stop - start), 2 * np.spacing(stop))


def _within(motion: Lifting, value: OfRows, start: float, stop: float) -> Extreme:
    def known(phi: Array) -> Array:
        values = value(motion.lift(phi, 2))
        return np.where(np.isnan(values), -np.inf, values)

    phi = np.linspace(start, _inside(start, stop), NODES)
    values = known(phi)
    top = int(np.argmax(values))
    node = Extreme(float(values[top]), float(phi[top]))
    low, high = phi[max(top - 1, 0)], phi[min(top + 1, NODES - 1)]
    if not math.isfinite(node.value):
        return node
    found = minimize_scalar(
        lambda at: -max(float(known(np.array([at]))[0]), -1e300),
        bounds=(low, high),
        method="bounded",
        options={"xatol": FINE * (stop - start)},
    )
    inner = Extreme(-float(found.fun), float(found.x))
    return inner if inner.value > node.value else node
