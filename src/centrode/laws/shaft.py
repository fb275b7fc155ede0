"""A law over the angle of an evenly turning shaft, as a law of time: what a cam does to its follower."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from centrode.laws.law import Number
from centrode.laws.segments import SegmentedLaw


@dataclass(frozen=True)
class ShaftLaw:
    """s(t) = lift(angle + speed t), or less that.

    Attributes
    ----------
    lift : SegmentedLaw
        Over the shaft's angle [rad], turn after turn.
    speed : float [rad/s], positive
    angle : float [rad]
        Of the shaft at t = 0.
    lowers : bool
        Whether the lift lowers the value.
    """

    lift: SegmentedLaw
    speed: float
    angle: float = 0.0
    lowers: bool = False

    @property
    def span(self) -> tuple[float, float] | None:
        """Defined everywhere: the shaft turns on."""
        return None

    @property
    def period(self) -> float:
        """Time of a turn [s]."""
        return self.lift.period / self.speed

    def jet(self, m: Any, t: Number) -> Number:
        """s(t) [rad or m] over the algebra of `m`."""
        lift = self.lift.jet(m, t * self.speed + self.angle)
        # Not the lift times -1: at rest that is a zero with a minus.
        return lift * 0.0 - lift if self.lowers else lift
