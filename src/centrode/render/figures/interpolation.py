"""Curves between their samples: cubics with the slopes that are known, else with those of the neighbours; jumps."""

from __future__ import annotations

from itertools import pairwise
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

Array: TypeAlias = NDArray[np.float64]

PLACES = 360
"""A curve of fewer samples is drawn through about so many places."""
EPS = float(np.finfo(np.float64).eps)
STEEP, GREAT = 8.0, 0.05
"""A step is a jump if it is so many times as steep as both its neighbours, and such a part of the curve's range."""


def interpolated_curve(x: Array, y: Array, slopes: Array | None = None) -> tuple[Array, Array]:
    """A curve through more places: on each step the cubic of Hermite; straight where it jumps.

    Parameters
    ----------
    x, y : (n), NaN is a gap; both follow the number of the sample where x turns back
    slopes : (n) dy/dx, NaN where it is not known; there the slope is Akima's

    Notes
    -----
    With exact slopes the curve is off by the fourth power of the step. H. Akima, A new method of interpolation and
    smooth curve fitting based on local procedures, J. ACM 17 (1970): his slopes do not swing beside corners.
    """
    count = len(x)
    parts = -(-PLACES // max(count, 1))
    if parts < 2 or count < 3:
        return x, y
    if not is_monotonic(x):
        number = np.arange(float(count))
        missing = np.where(np.isfinite(x) & np.isfinite(y), 0.0, np.nan)
        return along(number, x + missing, parts)[1], along(number, y + missing, parts)[1]
    return along(x, y, parts, slopes)


def along(x: Array, y: Array, parts: int, slopes: Array | None = None) -> tuple[Array, Array]:
    """The cubics of a curve at so many places a step; a step beside a gap has its first sample alone."""
    known = np.full(len(x), np.nan) if slopes is None else slopes
    t = np.arange(parts) / parts
    across = x[:-1, None] + t * np.diff(x)[:, None]
    curve = y[:-1, None] + t * np.diff(y)[:, None]
    drawn = np.isfinite(across) & np.isfinite(curve)
    across[:, 0], curve[:, 0], drawn[:, 0] = x[:-1], y[:-1], True
    for first, end in smooth_runs(x, y):
        part = slice(first, end)
        slope = np.where(np.isfinite(known[part]), known[part], akima_slopes(x[part], y[part]))
        rise, step = np.diff(y[part])[:, None], np.diff(x[part])[:, None]
        left, right = step * slope[:-1, None], step * slope[1:, None]
        bend = (1.0 - t) * (left - rise) - t * (right - rise)
        curve[first : end - 1] += t * (1.0 - t) * bend
    return np.append(across[drawn], x[-1]), np.append(curve[drawn], y[-1])


def is_monotonic(x: Array) -> bool:
    """Whether a coordinate only grows, or only falls, gaps left out."""
    steps = np.diff(x[np.isfinite(x)])
    return bool((steps > 0.0).all() or (steps < 0.0).all())


def smooth_runs(x: Array, y: Array) -> list[tuple[int, int]]:
    """First sample and the one after the last of each stretch of two samples and more without gap or jump."""
    missing = ~(np.isfinite(x) & np.isfinite(y))
    cuts = np.zeros(len(x) + 1, dtype=bool)
    cuts[:-1] |= missing
    cuts[1:] |= missing
    cuts[jumps(x, y) + 1] = True
    cuts[[0, -1]] = True
    return [(first, end) for first, end in pairwise(np.flatnonzero(cuts).tolist()) if end - first >= 2]


def jumps(x: Array, y: Array) -> NDArray[np.intp]:
    """Numbers of the samples after which a curve jumps."""
    known = y[np.isfinite(y)]
    if known.size < 4:
        return np.array([], dtype=np.intp)
    with np.errstate(divide="ignore", invalid="ignore"):
        steps = np.abs(np.diff(y) / np.diff(x))
        steep = steps[1:-1] > STEEP * np.maximum(steps[:-2], steps[2:])
        # What changes by its rounding alone does not jump.
        least = max(GREAT * float(np.ptp(known)), 64.0 * EPS * float(np.max(np.abs(known))))
        great = np.abs(np.diff(y))[1:-1] > least
    return np.flatnonzero(steep & great) + 1


def akima_slopes(x: Array, y: Array) -> Array:
    """Slopes (n) at the samples of a curve without gaps, each from the four steps beside it."""
    steps = np.diff(y) / np.diff(x)
    if len(steps) < 2:
        return np.full(len(x), steps[0])
    # beyond an end the steps go on as the last two do
    first, last = steps[0] - steps[1], steps[-1] - steps[-2]
    padded = np.concatenate(
        [steps[0] + first * np.array([2.0, 1.0]), steps, steps[-1] + last * np.array([1.0, 2.0])]
    )
    one, other = np.abs(padded[3:] - padded[2:-1]), np.abs(padded[1:-2] - padded[:-3])
    total = one + other
    flat = total <= 1e-9 * (np.abs(padded[1:-2]) + np.abs(padded[2:-1]))
    share = np.divide(one, total, out=np.full(len(x), 0.5), where=~flat)
    return np.asarray(share * padded[1:-2] + (1.0 - share) * padded[2:-1])
