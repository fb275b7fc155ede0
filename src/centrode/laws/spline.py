"""The cubic spline through given points, twice continuously differentiable, with the not-a-knot end condition."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

Cubic = tuple[float, float, float, float]
"""Coefficients c0, c1, c2, c3 of powers of the distance from the segment's left knot."""


def spline(x: Sequence[float], y: Sequence[float]) -> list[Cubic]:
    """Cubics of the segments of the spline through (x, y).

    Parameters
    ----------
    x, y : (n) at least two; x increasing
        Two points give a line, three a parabola.

    Returns
    -------
    n - 1 cubics, each in the distance from its left knot.

    Notes
    -----
    The slopes solve a tridiagonal system (C. de Boor, A Practical Guide to Splines, 2001, chapter IV);
    its elimination needs no pivoting, every pivot is positive.
    """
    steps = [b - a for a, b in pairwise(x)]
    rates = [(b - a) / h for a, b, h in zip(y, y[1:], steps, strict=False)]
    if len(x) == 2:
        return [(y[0], rates[0], 0.0, 0.0)]
    if len(x) == 3:
        return _parabola(y, steps, rates)
    slopes = _slopes(steps, rates)
    return [_hermite(*piece) for piece in zip(y, steps, rates, slopes, slopes[1:], strict=False)]


def _parabola(y: Sequence[float], steps: list[float], rates: list[float]) -> list[Cubic]:
    bend = (rates[1] - rates[0]) / (steps[0] + steps[1])
    first = rates[0] - bend * steps[0]
    return [(y[0], first, bend, 0.0), (y[1], first + 2 * bend * steps[0], bend, 0.0)]


def _hermite(y: float, step: float, rate: float, left: float, right: float) -> Cubic:
    excess = left + right - 2 * rate
    return y, left, (rate - left - excess) / step, excess / step / step


def _slopes(h: list[float], rate: list[float]) -> list[float]:
    """Slopes at the knots: equal second derivatives inside, equal third derivatives at the second and last but one."""
    d, e = h[0] + h[1], h[-1] + h[-2]
    upper = [d, *h[:-1]]
    diagonal = [h[1]] + [2 * (a + b) for a, b in pairwise(h)] + [h[-2]]
    lower = [*h[1:], e]
    right = [((h[0] + 2 * d) * h[1] * rate[0] + h[0] ** 2 * rate[1]) / d]
    right += [3 * (h[i] * rate[i - 1] + h[i - 1] * rate[i]) for i in range(1, len(h))]
    right.append((h[-1] ** 2 * rate[-2] + (2 * e + h[-1]) * h[-2] * rate[-1]) / e)
    for i in range(1, len(diagonal)):
        share = lower[i - 1] / diagonal[i - 1]
        diagonal[i] -= share * upper[i - 1]
        right[i] -= share * right[i - 1]
    slopes = [right[-1] / diagonal[-1]]
    for i in range(len(diagonal) - 2, -1, -1):
        slopes.append((right[i] - upper[i] * slopes[-1]) / diagonal[i])
    return slopes[::-1]
