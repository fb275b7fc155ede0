"""A slow scan of what has to be positive for a dyad to close: nodes, minima between them, poles."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
Function = Callable[[Array], Array]
NODES = 4001
HALVINGS = 70
GOLDEN = (math.sqrt(5.0) - 1.0) / 2.0


@dataclass(frozen=True)
class Gap:
    """An interval over which a dyad does not close, open at its ends; `doubtful` where rounding decides of it."""

    low: float
    high: float
    doubtful: bool = False

    @property
    def width(self) -> float:
        """How wide it is [rad]."""
        return self.high - self.low


def gaps_of(
    reserve: Function, divisor: Function | None, low: float, high: float, rounding: float
) -> list[Gap]:
    """Intervals between low and high where `reserve` is negative, in order; `rounding` is what it may be off by."""
    nodes = np.linspace(low, high, NODES)
    extra = [minima(reserve, nodes)]
    if divisor is not None:
        # where the divisor turns round between two nodes it may cross zero twice
        turns = [minima(divisor, nodes), minima(lambda q: -divisor(q), nodes)]
        extra += [*turns, roots(divisor, np.unique(np.concatenate([nodes, *turns])))]
    at = np.unique(np.concatenate([nodes, *extra]))
    with np.errstate(all="ignore"):
        values = reserve(at)
    negative = ~(values > 0.0)
    found = []
    edges = np.flatnonzero(np.diff(negative.astype(int)))
    ends = list(edges_of(reserve, at[edges], at[edges + 1]))
    if negative[0]:
        ends.insert(0, low)
    if negative[-1]:
        ends.append(high)
    for begin, end in zip(ends[::2], ends[1::2], strict=True):
        inside = values[(at >= begin) & (at <= end)]
        doubtful = not (
            np.nanmin(inside, initial=math.inf) < -rounding
            or np.isinf(inside).any()
            or np.isnan(inside).any()
        )
        found.append(Gap(float(begin), float(end), doubtful))
    # a near miss that rounding could make a gap of is not to be judged either
    touching = at[(abs(values) <= rounding) & np.isin(at, extra[0])]
    found += [Gap(float(q), float(q), True) for q in touching if not any(g.low <= q <= g.high for g in found)]
    return sorted(found, key=lambda gap: gap.low)


def minima(reserve: Function, nodes: Array) -> Array:
    """Places of the least values between neighbours that are both greater (golden section, all at once)."""
    with np.errstate(all="ignore"):
        values = reserve(nodes)
    k = np.flatnonzero((values[1:-1] <= values[:-2]) & (values[1:-1] <= values[2:])) + 1
    low, high = nodes[k - 1], nodes[k + 1]
    for _ in range(60):
        first, second = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
        with np.errstate(all="ignore"):
            left = reserve(first) < reserve(second)
        low, high = np.where(left, low, first), np.where(left, second, high)
    return np.asarray(0.5 * (low + high))


def roots(function: Function, nodes: Array) -> Array:
    """Where a continuous function changes its sign."""
    values = function(nodes)
    k = np.flatnonzero(np.signbit(values[1:]) != np.signbit(values[:-1]))
    return bisected(lambda q: function(q) > 0.0, nodes[k], nodes[k + 1])


def edges_of(reserve: Function, low: Array, high: Array) -> Array:
    """Where what is positive at one end ceases to be so."""

    def positive(q: Array) -> npt.NDArray[np.bool_]:
        with np.errstate(all="ignore"):
            return np.asarray(reserve(q) > 0.0)

    return bisected(positive, low, high)


def bisected(holds: Callable[[Array], npt.NDArray[np.bool_]], low: Array, high: Array) -> Array:
    """Where a condition changes between pairs of places."""
    if not len(low):
        return low
    at_low = holds(low)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        same = holds(middle) == at_low
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    return np.asarray(0.5 * (low + high))
