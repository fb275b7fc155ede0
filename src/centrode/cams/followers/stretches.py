"""The lift between breaks: one analytic formula on each closed stretch, and extremes of what is made of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from math import isclose

import numpy as np
from numpy.typing import NDArray

from centrode.algebra.arrays import ARRAYS
from centrode.algebra.jet_functions import JetFunctions
from centrode.algebra.jets import Jet
from centrode.cams.nodes import mesh
from centrode.laws import SegmentedLaw
from centrode.numerics.search import Extremes, extremes

Array = NDArray[np.float64]
JETS = JetFunctions(ARRAYS)
SAME = 1e-12
"""Sizes that part by a smaller share are equal but for rounding."""
Made = Callable[[Array], tuple[Array, Array]]
"""A value and its slope from the derivatives (order + 1, n) of the lift."""


@dataclass(frozen=True)
class Stretch:
    """A part of the lift with one formula, at both ends its own."""

    law: SegmentedLaw
    number: int

    @property
    def ends(self) -> tuple[float, float]:
        """First and last angle [rad]."""
        first, last = self.law.whole.breaks[self.number : self.number + 2]
        return first, last

    def derivatives(self, phi: Array, order: int) -> Array:
        """Lift and derivatives (order + 1, n)."""
        jet = self.law.whole.at_row(self.number + 1, JETS, Jet.variable(phi, order))
        return np.stack([np.broadcast_to(jet.derivative(k), phi.shape) for k in range(order + 1)])

    def extremes(self, order: int, made: Made) -> Extremes:
        """Extremes of what is made of derivatives up to an order."""
        return extremes(
            lambda phi: made(self.derivatives(phi, order))[0],
            lambda phi: made(self.derivatives(phi, order))[1],
            mesh(*self.ends),
        )


def stretches(law: SegmentedLaw, segment: int | None = None) -> list[Stretch]:
    """The stretches of one segment, counted from 0, or of all."""
    edges = law.whole.breaks
    first, last = 0.0, edges[-1]
    if segment is not None:
        first, last = (0.0, *law.ends)[segment : segment + 2]
    return [Stretch(law, k) for k, (low, high) in enumerate(pairwise(edges)) if first <= low and high <= last]


def extremes_of(law: SegmentedLaw, order: int, made: Made, segment: int | None = None) -> Extremes:
    """Extremes over a segment or the whole, limits from both sides of each break included.

    Of what is taken more than once the first place counts.
    """
    found = [stretch.extremes(order, made) for stretch in stretches(law, segment)]
    low = min(found, key=lambda one: (one.least, one.at_least))
    high = max(found, key=lambda one: (one.greatest, -one.at_greatest))
    return Extremes(low.least, low.at_least, high.greatest, high.at_greatest)


def derivative(order: int) -> Made:
    """The derivative of an order of the lift; ask for derivatives up to one more."""
    return lambda found: (found[order], found[order + 1])


def power(found: Array) -> tuple[Array, Array]:
    """First times second derivative: a mass's share in the torque of the camshaft; ask for derivatives up to 3."""
    return found[1] * found[2], found[2] ** 2 + found[1] * found[3]


def greatest_size(one: Extremes) -> tuple[float, float]:
    """The greatest size with its sign, and its place; of equal sizes the one that comes first."""
    up, down = (one.greatest, one.at_greatest), (one.least, one.at_least)
    if isclose(up[0], -down[0], rel_tol=SAME):
        return min(up, down, key=lambda size: size[1])
    return up if up[0] > -down[0] else down
