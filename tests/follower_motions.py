"""Lifts of followers by segments, built of the curves of `laws` alone, for tests of profiles."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from centrode.laws.segments import LawSegment, SegmentedLaw
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.jets import Jet, JetFunctions

Array = NDArray[np.float64]
JETS = JetFunctions(ARRAYS)


@dataclass(frozen=True)
class Lift:
    """The lift by a law of segments, whose times are angles [rad] and go over one turn."""

    law: SegmentedLaw

    @property
    def edges(self) -> tuple[float, ...]:
        return self.law.whole.breaks

    def lift(self, phi: Array, order: int = 0) -> Array:
        found = self.law.jet(JETS, Jet.variable(np.asarray(phi, dtype=float), order))
        return np.array([found.derivative(k) + 0.0 * phi for k in range(order + 1)])


def lift_of(*rows: tuple[float, float | None, str]) -> Lift:
    """Rows of (degrees, value at the end, curve); None dwells."""
    found = [LawSegment(math.radians(angle), to, curve) for angle, to, curve in rows]
    return Lift(SegmentedLaw(tuple(found)))


def rise_dwell_fall_dwell(lift: float, curve: str = "cycloidal") -> Lift:
    """Rise, dwell, fall, dwell over 90 degrees each."""
    return lift_of((90, lift, curve), (90, None, "dwell"), (90, 0.0, curve), (90, None, "dwell"))


class Wave:
    """lift = a (1 - cos(n phi)) / 2 all round: harmonic motion without joints."""

    edges = (0.0, math.tau)

    def __init__(self, height: float, count: int = 1) -> None:
        self.height, self.count = height, count

    def lift(self, phi: Array, order: int = 0) -> Array:
        angle = Jet.variable(np.asarray(phi, dtype=float), order) * float(self.count)
        found = (JETS.cos(angle) * -1.0 + 1.0) * (0.5 * self.height)
        return np.array([found.derivative(k) + 0.0 * phi for k in range(order + 1)])
