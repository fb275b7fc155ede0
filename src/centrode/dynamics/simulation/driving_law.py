"""What drives a machine left to itself: a moment or force by a formula of time, value and speed of the drive."""

from __future__ import annotations

from dataclasses import dataclass
from math import nan
from typing import TYPE_CHECKING, Any, TypeAlias

from centrode.model.simulation import DRIVING_LAW_VARIABLES
from centrode.numerics.operations import SCALARS
from centrode.numerics.text_formula import TextFormula, compile_formula

if TYPE_CHECKING:
    from centrode.model.simulation import Simulation

Number: TypeAlias = Any


@dataclass(frozen=True)
class Driving:
    """Moment [N m or N] of a drive; `sense` is +1.0 or -1.0, that of the drive, in which the formula counts."""

    formula: TextFormula
    sense: float

    @classmethod
    def of(cls, settings: Simulation, sense: float) -> Driving:
        """The drive that a simulation asks for."""
        return cls(compile_formula(settings.law, DRIVING_LAW_VARIABLES, "[simulation] driving"), float(sense))

    @property
    def of_time(self) -> bool:
        """Whether it depends on time."""
        return "t" in self.formula.used

    @property
    def of_speed(self) -> bool:
        """Whether it depends on the speed."""
        return "v" in self.formula.used

    def over(self, m: Any, t: Number, q: Number, rate: Number) -> Number:
        """Generalised force at a rate of the drive's value, over any algebra."""
        return self.sense * self.formula(m, t=t, q=q, v=self.sense * rate)

    def at(self, t: float, q: float, rate: float) -> float:
        """Generalised force of plain numbers t [s], q and rate; NaN where the formula has no value."""
        try:
            return float(self.over(SCALARS, float(t), float(q), float(rate)))
        except (ArithmeticError, ValueError):
            return nan
