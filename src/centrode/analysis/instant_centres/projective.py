"""Places and lines of the plane with its points at infinity, each with a bound on its rounding error.

A place is a unit vector (x, y, w) in coordinates of the order of one, a line one with the places on it square to
it. Errors are angles between unit vectors [rad]: the same for near places and for those at infinity.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from math import sqrt
from typing import TypeAlias

Triple: TypeAlias = tuple[float, float, float]
EPS = sys.float_info.epsilon


@dataclass(frozen=True, slots=True)
class Spot:
    """A place, perhaps at infinity, or a line, and a bound on its error."""

    vector: Triple
    error: float

    @property
    def at_infinity(self) -> bool:
        """Whether it cannot be told from a place at infinity."""
        return abs(self.vector[2]) <= self.error


def spot(x: complex, w: float, error: float) -> Spot:
    """A place x / w, or with w = 0 the place at infinity in a direction; the error is that of (x, w)."""
    length = sqrt(x.real * x.real + x.imag * x.imag + w * w)
    return Spot((x.real / length, x.imag / length, w / length), error / length)


def cross(a: Triple, b: Triple) -> Triple:
    """Vector square to two others."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def dot(a: Triple, b: Triple) -> float:
    """Scalar product: zero where a place lies on a line."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def length(a: Triple) -> float:
    """Length of a vector."""
    return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2])


def crossing(first: Spot, second: Spot) -> Spot | None:
    """The line through two places, or the place where two lines meet; nothing if they cannot be told apart."""
    normal = cross(first.vector, second.vector)
    sine = length(normal)
    unsure = first.error + second.error + EPS
    if sine <= unsure:
        return None
    return Spot((normal[0] / sine, normal[1] / sine, normal[2] / sine), unsure / sine)


def differ(first: Spot, second: Spot) -> bool:
    """Whether two places are told apart by more than their errors."""
    return crossing(first, second) is not None


def best_crossing(lines: Sequence[tuple[Spot, int]], worst: float) -> tuple[Spot, tuple[int, int]] | None:
    """Where the two lines meet that tell the place best, and which they are; nothing if it may be off by `worst`."""
    best: tuple[Spot, tuple[int, int]] | None = None
    for (one, first), (other, second) in combinations(lines, 2):
        place = crossing(one, other)
        if place is not None and place.error < (worst if best is None else best[0].error):
            best = place, (first, second)
    return best
