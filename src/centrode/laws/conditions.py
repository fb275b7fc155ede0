"""The polynomial that has given values and derivatives at given times."""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise

from centrode.errors import InputError
from centrode.laws.pieces import Piece
from centrode.locale import _

Condition = tuple[float, tuple[float, ...]]
"""A time with the value and as many derivatives as are given there."""


def polynomial(conditions: Sequence[Condition]) -> list[tuple[float, Piece]]:
    """The polynomial of lowest degree that meets all conditions.

    Parameters
    ----------
    conditions : two or more, times increasing

    Returns
    -------
    The same polynomial in powers of the distance from each of the times, each with the time up to which it
    is the nearest.

    Raises
    ------
    InputError
        The coefficients are beyond what can be computed with.

    Notes
    -----
    The floats given are taken as exact: the coefficients are rounded once, so the conditions are met to
    rounding however high the degree. Times are counted in a fraction of a second of which all of them are
    whole multiples, so that whole numbers do. Confluent divided differences: J. Stoer, R. Bulirsch,
    Introduction to Numerical Analysis, 2002, section 2.1.5.
    """
    ticks = max(time.as_integer_ratio()[1] for time, _given in conditions)
    nodes = [int(Fraction(time) * ticks) for time, _given in conditions]
    series = [_series(given, ticks) for _time, given in conditions]
    powers, divisor = _powers(nodes, series)
    ends = [(a + b) / 2 for (a, _a), (b, _b) in pairwise(conditions)] + [conditions[-1][0]]
    unit = conditions[-1][0] - conditions[0][0]
    found = []
    for end, node, (time, _given) in zip(ends, nodes, conditions, strict=True):
        rounded = _rounded(_about(powers, node), int(Fraction(unit) * ticks), divisor)
        found.append((end, Piece(time, rounded[0], tuple(rounded[1:]), unit=unit)))
    return found


def _series(given: tuple[float, ...], ticks: int) -> list[Fraction]:
    """Taylor coefficients by ticks, from value and derivatives by seconds."""
    return [Fraction(rate) / (ticks**k * math.factorial(k)) for k, rate in enumerate(given)]


def _powers(nodes: list[int], series: list[list[Fraction]]) -> tuple[list[int], int]:
    """Coefficients of powers, and their common divisor."""
    repeated = [node for node, taylor in zip(nodes, series, strict=True) for _number in taylor]
    newton = _differences(nodes, series)
    divisor = math.lcm(*(coefficient.denominator for coefficient in newton))
    powers: list[int] = []
    for coefficient, node in zip(reversed(newton), reversed(repeated), strict=True):
        powers = [b - node * a for a, b in zip([*powers, 0], [0, *powers], strict=True)]
        powers[0] += int(coefficient * divisor)
    return powers, divisor


def _differences(nodes: list[int], series: list[list[Fraction]]) -> list[Fraction]:
    """Divided differences: nodes count as often as numbers are given there."""
    repeated = [(node, taylor) for node, taylor in zip(nodes, series, strict=True) for _number in taylor]
    column = [taylor[0] for _node, taylor in repeated]
    newton = [column[0]]
    for width in range(1, len(repeated)):
        ends = list(zip(repeated, repeated[width:], strict=False))
        column = [
            taylor[width] if left == right else (after - before) / (right - left)
            for ((left, taylor), (right, _taylor)), (before, after) in zip(
                ends, pairwise(column), strict=True
            )
        ]
        newton.append(column[0])
    return newton


def _about(powers: list[int], node: int) -> list[int]:
    """The polynomial in powers of the distance from a node, by repeated division."""
    shifted = list(powers)
    for k in range(len(shifted)):
        for i in reversed(range(k, len(shifted) - 1)):
            shifted[i] += node * shifted[i + 1]
    return shifted


def _rounded(powers: list[int], unit: int, divisor: int) -> list[float]:
    """Coefficients for a distance that is counted in units."""
    try:
        return [c * unit**k / divisor for k, c in enumerate(powers)]
    except OverflowError:
        what = _("a polynomial with these conditions is beyond what can be computed with")
        raise InputError("", what, _("give smaller rates, or a shorter time")) from None
