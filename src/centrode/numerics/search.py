"""Roots and extremes of functions of one variable: sampled first, then narrowed down between their samples.

A search has two steps. The nodes of a mesh tell the brackets: where a function changes its sign, or where it has a
top. The brackets are then narrowed down, all at once, by a method that fits what is known of the function:

- `newton_roots` where the slope is known, `interpolated_roots` where it is not (`zero_between` for one bracket of a
  function of plain numbers), `bisect` where only a statement is known that holds at one end and not at the other;
- `extremes` by the roots of the slope, `maxima_between` where no slope is known.

What lies between two nodes and leaves no trace at them (two roots, two tops) is missed: the mesh is the caller's, who
knows how quickly the function changes. Functions take arrays and are evaluated elementwise; NaN is absence, never a
sign and never an extreme. Over a whole period both its ends are nodes, so that nothing is lost at the seam.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.numerics.rounding_bounds import UNIT_ROUNDOFF

Array: TypeAlias = npt.NDArray[np.float64]
Lanes: TypeAlias = npt.NDArray[np.intp]
Mask: TypeAlias = npt.NDArray[np.bool_]
Function: TypeAlias = Callable[[Array], Array]
WithSlope: TypeAlias = Callable[[Array], tuple[Array, Array]]
"""From places (n) to values (n) and slopes (n)."""

STEPS = 100
"""Bisection alone halves a bracket to the last bit in fewer steps than this."""
PARTS = 32
"""Into so many parts the stretch about a top is cut at a time."""
ROUNDS = 12
"""So often: a stretch is left that is narrower than rounding."""
LEVEL = 64.0 * 2.0**-52
"""Values that differ by a smaller share are one but for rounding: a top as level as this is found."""
MOST_TURNS = 1000
"""Changes of a slope's sign that are looked into; a constant has as many as nodes, all of rounding."""


@dataclass(frozen=True)
class Extremes:
    """Least and greatest value of a function, and where they lie."""

    least: float
    at_least: float
    greatest: float
    at_greatest: float

    @property
    def range(self) -> float:
        """Greatest less least."""
        return self.greatest - self.least


def sign_changes(value: Array) -> tuple[Lanes, Lanes]:
    """Rows and cells (k) of values (rows, nodes) between finite neighbours of opposite signs."""
    # most rows of a batch have none, and their least value says so comparisons with NaN are false, so rows
    # with gaps are looked into
    rows = np.nonzero(~((np.min(value, axis=1) > 0.0) | (np.max(value, axis=1) < 0.0)))[0]
    some = value[rows]
    with np.errstate(all="ignore"):
        # A NaN at either end makes the product NaN, which is not below zero. An infinite value has a sign all the
        # same: on the left it is masked, so that no bracket begins there; on the right it is let through, as what
        # narrows a bracket uses its sign alone. Neither the examples nor 19 random mechanisms with groups of higher
        # class have an infinite value here.
        lanes, cells = np.nonzero(
            np.sign(np.where(np.isfinite(some), some, np.nan))[:, :-1] * np.sign(some[:, 1:]) < 0.0
        )
    return rows[lanes], cells


def crossing_brackets(nodes: Array, values: Array) -> tuple[Array, Array]:
    """Ends (k) of the stretches between growing nodes (n) on which values (n) change their sign, growing.

    One node at which the value is zero may lie between the ends; zeros in a row, as on a dwell, are no crossing, and
    neither is a zero between values of one sign. Nodes that are neighbouring floating-point numbers stand for the two
    sides of a jump: no stretch reaches over them.
    """
    known = np.flatnonzero(np.isfinite(values) & (values != 0.0))
    sides = np.cumsum(np.append(False, nodes[1:] <= np.nextafter(nodes[:-1], np.inf)))
    gaps = np.cumsum(~np.isfinite(values))
    first, last = known[:-1], known[1:]
    # one zero may stand at a node between the two; two of them in a row are a dwell
    crossed = (np.sign(values[first]) != np.sign(values[last])) & (last - first <= 2)
    crossed &= (sides[first] == sides[last]) & (gaps[first] == gaps[last])
    return nodes[first[crossed]], nodes[last[crossed]]


def foretold_brackets(function: WithSlope, nodes: Array, value: Array, slope: Array) -> tuple[Array, Array]:
    """Ends (k) of stretches between nodes (n), each with one change of sign of a function with its slope.

    Beside the changes of sign between neighbouring nodes these are pairs of roots in one cell, where the tangents at
    its ends meet beyond zero and the function is beyond zero at that place too.
    """
    step = np.diff(nodes)
    with np.errstate(all="ignore"):
        change = value[:-1] * value[1:] < 0.0
        # where v0 + v0' t = v1 - v1' (h - t): the tangents bound what a curve without a turn of its curvature
        # can reach
        meet = (value[1:] - value[:-1] - slope[1:] * step) / (slope[:-1] - slope[1:])
        there = value[:-1] + slope[:-1] * meet
        dips = (value[:-1] * value[1:] > 0.0) & (there * value[:-1] <= 0.0) & (meet > 0.0) & (meet < step)
    cells, dipping = np.flatnonzero(change), np.flatnonzero(dips)
    inner = nodes[dipping] + meet[dipping]
    if len(dipping):
        # tangents overstate how far it goes: a pair of roots is there only if the function itself is beyond
        # zero
        deep = function(inner)[0] * value[dipping] < 0.0
        dipping, inner = dipping[deep], inner[deep]
    low = np.concatenate([nodes[cells], nodes[dipping], inner])
    high = np.concatenate([nodes[cells + 1], inner, nodes[dipping + 1]])
    return low, high


def newton_roots(function: WithSlope, low: Array, high: Array) -> Array:
    """Roots of a function with sign changes between `low` and `high`, elementwise.

    Newton steps, replaced by bisection where they leave the bracket. The result is exact to a few units of
    the last place of the root, as far as the function's own rounding allows.
    """
    if not len(low):
        return np.empty(0)
    low, high = low.copy(), high.copy()
    # which side of the root a place is on follows from the sign at the lower end: the function may fall or grow
    sign_low = np.sign(function(low)[0])
    x = 0.5 * (low + high)
    active = np.ones(x.shape, dtype=bool)
    for _ in range(STEPS):
        value, slope = function(x)
        left = np.sign(value) == sign_low
        low = np.where(active & left, x, low)
        high = np.where(active & ~left, x, high)
        with np.errstate(all="ignore"):
            step = x - value / slope
        inside = (step > low) & (step < high) & np.isfinite(step)
        # bisection keeps the bracket shrinking where the slope is zero or points elsewhere
        following = np.where(inside, step, 0.5 * (low + high))
        # a Newton step of the last bits may point out of the bracket: it has arrived, nothing throws it back
        last_bits = 2.0 * np.spacing(np.abs(x))
        done = (value == 0.0) | (np.abs(step - x) <= last_bits) | (high - low <= last_bits)
        x = np.where(active & ~done, following, x)
        active &= ~done
        if not active.any():
            break
    return x


def interpolated_roots(function: Function, low: Array, high: Array) -> Array:
    """Roots of a function with sign changes between `low` and `high`, elementwise, without its slope.

    Inverse quadratic interpolation through the last three places where it can be trusted, else bisection. Exact to
    two units in the last place of the greater end of the bracket, as far as the function's own rounding allows;
    where the function jumps over zero, the place of the jump. Where it has one sign at both ends, the end at which it
    is nearer to zero. NaN where a place without a value is met.
    Source: T. R. Chandrupatla, Advances in Engineering Software 28 (1997) 145-149.
    """
    if not len(low):
        return np.empty(0)
    width = 2.0 * np.spacing(np.maximum(np.abs(low), np.abs(high)))
    x, other = np.array(low, dtype=np.float64), np.array(high, dtype=np.float64)
    value, value_other = function(x), function(other)
    best, share = np.where(np.abs(value) <= np.abs(value_other), x, other), np.full(len(x), 0.5)
    best = np.where(np.isnan(value) | np.isnan(value_other), np.nan, best)
    active = np.sign(value) * np.sign(value_other) < 0.0
    # Bisection takes 53 steps, as a bracket has at most 2^54 units in the last place of its greater end. An
    # interpolated step may shorten it by less than half: powers up to the 41st took 63 steps, poles, jumps and cube
    # roots 53, steep and exponential curves fewer. More are allowed, which costs nothing where all are found.
    for _step in range(2 * STEPS):
        if not active.any():
            break
        place = np.where(active, x + share * (other - x), x)
        middle = np.where(active, function(place), value)
        # the third place is the one that leaves the bracket, the second the far end of what is left
        same = np.sign(middle) == np.sign(value)
        third, value_third = np.where(same, x, other), np.where(same, value, value_other)
        other, value_other = np.where(same, other, x), np.where(same, value_other, value)
        x, value = place, middle
        nearest = np.where(np.abs(value) < np.abs(value_other), x, other)
        best = np.where(active, np.where(np.isnan(value), np.nan, nearest), best)
        apart = np.abs(other - x)
        active &= (value != 0.0) & (apart > width) & ~np.isnan(value)
        with np.errstate(all="ignore"):
            along, rise = (x - other) / (third - other), (value - value_other) / (value_third - value_other)
            # Chandrupatla's criterion: the inverse quadratic through the three places is monotone between the
            # two of the bracket
            monotone = (rise**2 < along) & ((1.0 - rise) ** 2 < 1.0 - along)
            straight = value / (value_other - value) * value_third / (value_other - value_third)
            bent = value / (value_third - value) * value_other / (value_third - value_other)
            share = np.where(monotone, straight + (third - x) / (other - x) * bent, 0.5)
            least = 0.5 * width / apart  # never so short a step that the other end stays where it is
        share = np.clip(
            np.where(np.isfinite(share), share, 0.5), np.fmin(least, 0.5), np.fmax(1.0 - least, 0.5)
        )
    return best


def root(function: Callable[[float], float], low: float, high: float) -> float:
    """The root of a function of one number that changes its sign between two places, as `interpolated_roots`."""

    def at(place: Array) -> Array:
        return np.array([function(float(x)) for x in place])

    return float(interpolated_roots(at, np.array([low]), np.array([high]))[0])


def bisect(holds: Callable[[Array], Mask], low: Array, high: Array) -> tuple[Array, Array]:
    """Where a statement ceases to hold between `low`, where it does, and `high`, where it does not, elementwise.

    Returns
    -------
    last, first : (k)
        The last place at which it holds and the first at which it does not: neighbouring floating-point numbers, or
        as near as those at the greater end of the bracket. `high` may lie below `low`.
    """
    width = np.spacing(np.maximum(np.abs(low), np.abs(high)))
    for _halving in range(STEPS if len(low) else 0):
        middle = 0.5 * (low + high)
        # the middle of two neighbouring numbers rounds to one of them: then there is nothing between to look
        # at
        if ((np.abs(high - low) <= width) | (middle == low) | (middle == high)).all():
            break
        before = holds(middle)
        low, high = np.where(before, middle, low), np.where(before, high, middle)
    return low, high


def roots(function: Function, nodes: Array) -> Array:
    """Where a function changes its sign between growing nodes (n), growing: see `crossing_brackets`."""
    return interpolated_roots(function, *crossing_brackets(nodes, function(nodes)))


def extremes(function: Function, slope: Function, nodes: Array) -> Extremes:
    """Least and greatest value of a continuous function over growing nodes (n), found between them by its slope.

    Parameters
    ----------
    function, slope : places (n) -> (n)
        The function, and something that has the sign of its derivative, which may jump.
    nodes : (n)
        Ends and kinks of the function among them: extremes there are found whatever the slope says.

    Notes
    -----
    Values are exact to rounding, places to rounding over curvature. Of equal values the first node counts. Two
    extremes between neighbouring nodes are missed.
    """
    values = function(nodes)
    size = float(np.nanmax(np.abs(values)))
    places = nodes
    # a level function has slopes of rounding alone, and any node is as good an extreme as another
    if float(np.nanmax(values) - np.nanmin(values)) > LEVEL * size:
        places = np.append(nodes, _turns(slope, nodes, values))
        values = np.append(values, function(places[len(nodes) :]))
    low, high = int(np.nanargmin(values)), int(np.nanargmax(values))
    return Extremes(float(values[low]), float(places[low]), float(values[high]), float(places[high]))


def _turns(slope: Function, nodes: Array, values: Array) -> Array:
    """Where a slope changes its sign, at the highest and the lowest places where these are too many."""
    low, high = crossing_brackets(nodes, slope(nodes))
    # more turns than a smooth function has on a mesh: all but the most extreme ones are rounding
    if len(low) > MOST_TURNS:
        beside = values[np.searchsorted(nodes, low)]
        order = np.argsort(beside, kind="stable")
        chosen = np.unique(np.append(order[: MOST_TURNS // 2], order[-MOST_TURNS // 2 :]))
        low, high = low[chosen], high[chosen]
    return interpolated_roots(slope, low, high)


def maxima_between(function: Function, low: Array, high: Array) -> tuple[Array, Array]:
    """Places and values (k) of the greatest values of functions with one top each, without their slopes.

    Parameters
    ----------
    function : places (k, cuts) -> values (k, cuts)
        A function for each row; NaN where it has no value.
    low, high : (k)
        Ends of the stretch of each row.

    Notes
    -----
    Each stretch is cut into `PARTS` and the two parts about the best cut are cut again, until the top is level but
    for rounding. So values are exact to `LEVEL` of themselves, at kinks and edges too; places of smooth tops to 2e-7
    times the square root of value over curvature. Of equal values the first cut counts. Minus infinity where a row
    has no value at all.
    """
    place, value = np.array(low, dtype=np.float64), np.full(len(low), -np.inf)
    shares, rows = np.linspace(0.0, 1.0, PARTS + 1), np.arange(len(low))
    for _round in range(ROUNDS if len(low) else 0):
        cuts = low[:, None] + shares * (high - low)[:, None]
        # the last cut may miss the end by rounding, and extremes like to lie there
        cuts[:, -1] = high
        values = np.asarray(function(cuts), dtype=np.float64)
        values = np.where(np.isnan(values), -np.inf, values)
        best = np.argmax(values, axis=1)
        top = values[rows, best]
        # strictly: of equal values the first one is kept
        better = top > value
        place, value = np.where(better, cuts[rows, best], place), np.where(better, top, value)
        before, after = np.maximum(best - 1, 0), np.minimum(best + 1, PARTS)
        # what is still above the best cut is less than its fall to the cuts beside it; beside an edge beyond which
        # nothing is known that fall has no bound, and the stretch is cut down to rounding
        with np.errstate(invalid="ignore"):
            beside = np.minimum(values[rows, before], values[rows, after])
            level = np.isinf(top) | (beside >= top - LEVEL * np.abs(top))
        low, high = cuts[rows, before], cuts[rows, after]
        if level.all():
            break
    return place, value


def tops(
    function: Function,
    nodes: Array,
    *,
    near: float | None = None,
    most: int = MOST_TURNS,
    period: bool = False,
) -> tuple[Array, Array]:
    """Places and values (k) of the highest tops of a function, the highest node's first.

    Parameters
    ----------
    function : places (n) -> (n)
        NaN where it has no value.
    nodes : (n)
        Growing; a node is a top if neither neighbour exceeds it.
    near : float
        Share of the greatest magnitude below the highest node within which another top may be the greater one
        between the nodes; without it every top may be.
    most : int
        So many of the highest tops are looked into.
    period : bool
        The nodes lie evenly over a period, the last one before its end: then the first and the last are neighbours, and
        places of tops may lie beyond them by less than a step.

    Notes
    -----
    As exact as `maxima_between`. Empty where the function has no value.
    """
    values = np.asarray(function(nodes), dtype=np.float64)
    known = np.where(np.isnan(values), -np.inf, values)
    if not (known > -np.inf).any():
        return np.empty(0), np.empty(0)
    if period:
        before, after = np.roll(known, 1), np.roll(known, -1)
    else:
        before, after = np.append(-np.inf, known[:-1]), np.append(known[1:], -np.inf)
    peaks = np.flatnonzero((known >= before) & (known >= after) & (known > -np.inf))
    if near is not None:
        size = np.max(np.abs(known), where=np.isfinite(known), initial=0.0)
        peaks = peaks[known[peaks] >= known.max() - near * size]
    peaks = peaks[np.argsort(-known[peaks], kind="stable")][:most]
    if period:
        step = abs(nodes[1] - nodes[0])
        low, high = nodes[peaks] - step, nodes[peaks] + step
    else:
        low, high = nodes[np.maximum(peaks - 1, 0)], nodes[np.minimum(peaks + 1, len(nodes) - 1)]
    places, heights = maxima_between(lambda x: np.reshape(function(x.reshape(-1)), x.shape), low, high)
    # the node itself is no cut where its neighbours are not equally far from it
    at_node = known[peaks] >= heights
    return np.where(at_node, nodes[peaks], places), np.where(at_node, known[peaks], heights)


def zero_between(function: Callable[[float], float], low: float, high: float, width: float) -> float:
    """Where a function of one number with different signs at both ends is zero, as far as digits go, or to a width.

    For functions that take less time than a call by SciPy.
    Source: T. R. Chandrupatla, Advances in Engineering Software 28 (1997) 145-149; it begins with the secant here.
    """
    a, b, at_a, at_b = low, high, function(low), function(high)
    if at_a == 0.0 or at_b == 0.0:
        return a if at_a == 0.0 else b
    share = at_a / (at_a - at_b)
    for _trial in range(2 * STEPS):
        x = a + share * (b - a)
        at_x = function(x)
        if (at_x > 0.0) is (at_a > 0.0):
            c, at_c = a, at_a
        else:
            c, at_c, b, at_b = b, at_b, a, at_a
        a, at_a = x, at_x
        best, least = (a, at_a) if abs(at_a) < abs(at_b) else (b, at_b)
        near = 4.0 * UNIT_ROUNDOFF * abs(best) + 0.5 * width
        between = abs(b - a)
        if least == 0.0 or between <= 2.0 * near:
            return best
        # the parabola of the inverse function, where it has no turning point between the three
        place, value = (a - b) / (c - b), (at_a - at_b) / (at_c - at_b)
        share = 0.5
        if value * value < place and (1.0 - value) ** 2 < 1.0 - place:
            share = at_a / (at_b - at_a) * at_c / (at_b - at_c)
            share += (c - a) / (b - a) * at_a / (at_c - at_a) * at_b / (at_c - at_b)
        share = min(max(share, near / between), 1.0 - near / between)
    return best
