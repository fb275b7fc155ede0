"""A linkage whose motion through change points is known, and what rounding makes of it.

A parallelogram and its like have a coupler curve that falls apart into two factors. To pass a change point
smoothly is to stay on one of them, so the truth needs no decision. Dimensions and values of the drive are taken as
the very doubles that the program has.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import mpmath
import numpy as np

Place = tuple[Any, ...]
"""Coordinates of a point as numbers of mpmath."""
Places = dict[str, Place]
DIGITS = 80
STEP = mpmath.mpf(10) ** -20
"""Step of difference quotients: at `DIGITS` their errors are below 1e-28 of the derivative, however sharp the bend."""
NUDGE = mpmath.mpf(10) ** -30
"""Relative change of a dimension by which the answer to its rounding is measured."""
ULP = 2.0**-53
"""Relative error of a rounded number."""


@dataclass(frozen=True)
class Linkage:
    """A linkage with change points whose motion is known.

    `dimensions` are the doubles by their paths; `places` gives the points' places from them and the drive's value
    (numbers of mpmath, all equal dimensions equal), `closures` the conditions that hold of them if each dimension is a
    number of its own. `spots` are the change points and sharp bends within a turn, with the width of the bend [rad].
    """

    kind: str
    ratio: float
    parts: dict[str, Any]
    dimensions: dict[str, float]
    places: Callable[[Mapping[str, Any], Any], Places]
    closures: Callable[[Mapping[str, Any], Any, Places], list[Any]]
    free: tuple[str, ...]
    spots: list[tuple[float, float]]
    size: float
    vary: dict[str, str] = field(default_factory=dict)
    reach: float = math.inf

    @property
    def gap(self) -> float:
        """How far the ratio is from 1."""
        return abs(1.0 - self.ratio)

    @property
    def chained(self) -> bool:
        """Whether groups stand on one another, so that their conditions multiply."""
        return len(self.free) > 1

    @property
    def row(self) -> str:
        """The row of the table that the linkage belongs to."""
        return f"{self.kind}, {decade(self.gap)}"

    def exact(self, value: float) -> list[Places]:
        """Places of the points with two derivatives by the drive's value."""
        with mpmath.workdps(DIGITS):
            numbers = {path: mpmath.mpf(x) for path, x in self.dimensions.items()}
            at = mpmath.mpf(value)
            return differenced(lambda q: self.places(numbers, q), at)

    def answer(self, value: float) -> list[float]:
        """What rounding of each dimension and of the drive's value makes of the places and their derivatives."""
        with mpmath.workdps(DIGITS + 20):
            numbers = {path: mpmath.mpf(x) for path, x in self.dimensions.items()}
            at = mpmath.mpf(value)
            base = differenced(lambda q: self.places(numbers, q), at)
            total = [mpmath.mpf(0)] * 3
            for path, x in [*numbers.items(), ("", at)]:
                by = abs(x) * NUDGE
                changed = {**numbers, path: x + by} if path else numbers
                shift = mpmath.mpf(0) if path else by
                moved = differenced(partial(self.shifted, changed, shift), at)
                for order in range(3):
                    total[order] += distance(moved[order], base[order], self.free) / NUDGE * ULP
            return [float(x) / self.size for x in total]

    def shifted(self, numbers: Mapping[str, Any], shift: Any, q: Any) -> Places:
        """The places at a value of the drive a little off."""
        return self.solved(numbers, q + shift)

    def solved(self, numbers: Mapping[str, Any], q: Any) -> Places:
        """The places that close with dimensions a little off, by Newton's method from those without."""
        exact = self.places({path: mpmath.mpf(x) for path, x in self.dimensions.items()}, q)
        labels = [(name, k) for name in self.free for k in range(len(exact[name]))]
        places = dict(exact)
        for _ in range(2):
            residual = self.closures(numbers, q, places)
            rows = mpmath.matrix(len(residual), len(labels))
            for column, (name, k) in enumerate(labels):
                nudged = dict(places)
                by = NUDGE * self.size
                nudged[name] = tuple(x + by if i == k else x for i, x in enumerate(places[name]))
                for row, (after, before) in enumerate(
                    zip(self.closures(numbers, q, nudged), residual, strict=True)
                ):
                    rows[row, column] = (after - before) / by
            step = mpmath.lu_solve(rows, mpmath.matrix([-x for x in residual]))
            for column, (name, k) in enumerate(labels):
                places[name] = tuple(x + step[column] if i == k else x for i, x in enumerate(places[name]))
        return places


def differenced(places: Callable[[Any], Places], at: Any) -> list[Places]:
    """A curve with its first and second derivative, by difference quotients."""
    before, here, after = places(at - STEP), places(at), places(at + STEP)
    first, second = {}, {}
    for name in here:
        ends = list(zip(before[name], here[name], after[name], strict=True))
        first[name] = tuple((c - a) / (2 * STEP) for a, _b, c in ends)
        second[name] = tuple((a - 2 * b + c) / STEP**2 for a, b, c in ends)
    return [here, first, second]


def distance(one: Places, other: Places, names: tuple[str, ...]) -> Any:
    """Greatest difference of two sets of places."""
    return max(abs(x - y) for name in names for x, y in zip(one[name], other[name], strict=True))


def decade(gap: float) -> str:
    """The decade of |1 - ratio| in words."""
    if gap == 0.0:
        return "no ratio"
    power = math.floor(math.log10(gap) + 1e-9)
    return "|1 - ratio| from 0.1" if power >= -1 else f"|1 - ratio| from 1e{power}"


def bend(one: float, other: float) -> float:
    """Width of the bend of a linkage whose pin passes close by the other pivot [rad]."""
    return min(0.5, abs(one - other) / (one + other))


def dyadic(x: float) -> float:
    """The nearest number with few digits, so that sums of such are exact."""
    return math.ldexp(round(math.ldexp(float(x), 40)), -40)


def beginning(random: np.random.Generator) -> float:
    """A start of the drive away from change points at 0 and pi."""
    return float(random.choice([-1.0, 1.0]) * random.uniform(0.6, 2.5))
