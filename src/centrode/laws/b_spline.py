"""The B-spline through given values, with given derivatives at both ends."""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Sequence
from itertools import pairwise

from centrode.errors import InputError
from centrode.laws.conditions import Condition
from centrode.laws.pieces import Piece
from centrode.locale import _

Numbers = list[float]


def b_spline(conditions: Sequence[Condition], degree: int) -> list[tuple[float, Piece]]:
    """The spline of a degree that meets all conditions; inside it degree - 1 derivatives are continuous.

    Parameters
    ----------
    conditions : two or more, times increasing
        Values, and at both ends as many derivatives as are given there.
    degree : int, at least 1
        With fewer conditions than degree + 1 it is the polynomial through them.

    Returns
    -------
    Polynomials, each with the time up to which it holds. That of the last stretch is given about its beginning
    and about its end, so that what is asked for at the ends holds there exactly.

    Raises
    ------
    InputError
        The coefficients are beyond what can be computed with.

    Notes
    -----
    Knots lie at the times of the values where the conditions at both ends are as many as such a spline needs,
    (degree + 1)/2 for an odd degree: the natural end of a smoothest spline. Else each is the mean of the `degree`
    times that follow each other there (C. de Boor, A Practical Guide to Splines, 2001, chapter XIII), so that the
    spline exists. Coefficients at the ends follow from the conditions there one by one; the others solve a
    totally positive banded system, whose elimination needs no pivoting (ibid.).
    """
    first, last = conditions[0][0], conditions[-1][0]
    unit = last - first
    rates = [[rate * unit**k for k, rate in enumerate(given)] for _time, given in conditions]
    places = [(time - first) / unit for time, _given in conditions]
    degree = min(degree, sum(map(len, rates)) - 1)
    knots = _knots(places, rates, degree)
    coefficients = _coefficients(places, rates, knots, degree)
    if not all(map(math.isfinite, coefficients)):
        what = _("a spline with these conditions is beyond what can be computed with")
        raise InputError("", what, _("give smaller rates, or a shorter time"))
    found = []
    for place, end, taylor in _stretches(knots, coefficients, degree):
        given = {0.0: rates[0], 1.0: rates[-1]}.get(place, [])
        taylor[: len(given)] = [rate / math.factorial(k) for k, rate in enumerate(given)][: degree + 1]
        origin = last if place == 1.0 else first + place * unit
        found.append((first + end * unit, Piece(origin, taylor[0], tuple(taylor[1:]), unit=unit)))
    return [*found[:-1], (last, found[-1][1])]


def _knots(places: Numbers, rates: list[Numbers], degree: int) -> Numbers:
    """All knots from 0 to 1, those at the ends degree + 1 times."""
    needed = (degree + 1) / 2
    inner = places[1:-1]
    if not len(rates[0]) == len(rates[-1]) == needed:
        repeated = [place for place, given in zip(places, rates, strict=True) for _rate in given]
        count = len(repeated) - degree - 1
        inner = [math.fsum(repeated[k : k + degree]) / degree for k in range(1, count + 1)]
    return [0.0] * (degree + 1) + inner + [1.0] * (degree + 1)


def _coefficients(places: Numbers, rates: list[Numbers], knots: Numbers, degree: int) -> Numbers:
    left = _at_end(rates[0], knots, degree)
    mirrored = [1.0 - knot for knot in reversed(knots)]
    flipped = [-rate if k % 2 else rate for k, rate in enumerate(rates[-1])]
    right = _at_end(flipped, mirrored, degree)[::-1]
    inner = [given[0] for given in rates[1:-1]]
    count = len(left) + len(inner) + len(right)
    known = [*left, *([0.0] * len(inner)), *right]
    rows, sides = [], []
    for number, (place, value) in enumerate(zip(places[1:-1], inner, strict=True)):
        span = bisect_right(knots, place) - 1
        start = span - degree
        basis = _basis(knots, span, degree, place)
        side = value - math.fsum(b * known[start + k] for k, b in enumerate(basis))
        width = {start + k - len(left): b for k, b in enumerate(basis)}
        rows.append({k: b for k, b in width.items() if 0 <= k < len(inner)})
        rows[number].setdefault(number, 0.0)
        sides.append(side)
    solved = _eliminated(rows, sides)
    return [*left, *solved, *right][:count]


def _at_end(rates: Numbers, knots: Numbers, degree: int) -> Numbers:
    """The first coefficients, from value and derivatives at the beginning.

    There the k-th derivative is the first coefficient of the k-th derived spline, and coefficients of derived
    splines are differences of those above them.
    """
    column = [rates[0]]
    found = [rates[0]]
    for order in range(1, len(rates)):
        derived = [rates[order]]
        for k in range(order):
            # From the highest derivative down: each difference gives the next coefficient of the one below it.
            low = order - 1 - k
            step = (knots[degree + 1 + k] - knots[low + k + 1]) / (degree - low)
            derived.append(column[low] + derived[-1] * step)
        column = derived[::-1]
        found.append(column[0])
    return found


def _eliminated(rows: list[dict[int, float]], sides: Numbers) -> Numbers:
    """The solution of a banded system by elimination without pivoting."""
    count = len(rows)
    for k in range(count):
        for below in range(k + 1, count):
            if k not in rows[below]:
                break
            share = rows[below].pop(k) / rows[k][k]
            for column, number in rows[k].items():
                if column > k:
                    rows[below][column] = rows[below].get(column, 0.0) - share * number
            sides[below] -= share * sides[k]
    solved = [0.0] * count
    for k in reversed(range(count)):
        rest = math.fsum(number * solved[column] for column, number in rows[k].items() if column > k)
        solved[k] = (sides[k] - rest) / rows[k][k]
    return solved


def _basis(knots: Numbers, span: int, degree: int, place: float) -> Numbers:
    """The degree + 1 B-splines that are not zero on a stretch (Cox and de Boor)."""
    values = [1.0]
    for order in range(1, degree + 1):
        raised = [0.0] * (order + 1)
        for k, value in enumerate(values):
            low, high = knots[span + 1 + k - order], knots[span + 1 + k]
            share = (place - low) / (high - low)
            raised[k] += (1.0 - share) * value
            raised[k + 1] += share * value
        values = raised
    return values


def _stretches(knots: Numbers, coefficients: Numbers, degree: int) -> list[tuple[float, float, Numbers]]:
    """Origin, end and Taylor coefficients of each stretch between knots; the last one twice."""
    edges = knots[degree : len(knots) - degree]
    derived = [coefficients]
    for order in range(1, degree + 1):
        above, width = derived[-1], degree + 1 - order
        steps = [knots[order + k + width] - knots[order + k] for k in range(len(above) - 1)]
        derived.append([width * (b - a) / step for (a, b), step in zip(pairwise(above), steps, strict=True)])
    found = []
    for number, (low, high) in enumerate(pairwise(edges)):
        span = degree + number
        middle = low + (high - low) / 2
        last = number == len(edges) - 2
        parts = [(low, middle), (high, high)] if last else [(low, high)]
        for origin, end in parts:
            taylor = []
            for order, row in enumerate(derived):
                # The derived spline has one knot less at each end a step.
                basis = _basis(knots, span, degree - order, origin)
                local = row[number : number + degree - order + 1]
                rate = math.fsum(b * c for b, c in zip(basis, local, strict=True))
                taylor.append(rate / math.factorial(order))
            found.append((origin, end, taylor))
    return found
