"""Tables of loads as formulas without branches: straight lines between rows, over any algebra."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import nan
from typing import Any, TypeAlias

from centrode.dynamics.loads import SLACK, ContinuousLaw, EnergyClass, LoadDiagram, LoadTable, Situation
from centrode.laws.rises import whole_turns

Number: TypeAlias = Any


@dataclass(frozen=True)
class BrokenLine(ContinuousLaw):
    """Straight lines between rows of a place and a force; NaN beside them.

    Attributes
    ----------
    rows : ((place, force) ...)
    of : what the place is: the load's coordinate "x", the drive's value "q" or time "t"
    period : after which the rows repeat; 0 where they do not
    """

    rows: tuple[tuple[Number, Number], ...]
    of: str
    period: Number = 0.0
    energy_class = EnergyClass.OTHER

    @property
    def uses(self) -> frozenset[str]:
        """Which of t, q, x it depends on."""
        return frozenset(self.of)

    def map_numbers(self, function: Callable[[Number], Number]) -> BrokenLine:
        """The line with every number replaced by function(number)."""
        rows = tuple((function(at), function(force)) for at, force in self.rows)
        return replace(self, rows=rows, period=function(self.period))

    def __call__(self, now: Situation) -> Number:
        m, place = now.m, {"x": now.x, "q": now.q, "t": now.t}[self.of]
        (first, force), (last, _force) = self.rows[0], self.rows[-1]
        beside = None
        if isinstance(self.period, float) and self.period == 0.0:
            slack = SLACK * (last - first)
            beside = m.either(m.less(place, first - slack), m.less(last + slack, place))
        else:
            place = place - whole_turns(place - first, self.period) * self.period
        # one line's force after the other, as far as the place has come on each
        for (low, below), (high, above) in zip(self.rows, self.rows[1:], strict=False):
            share = m.least(m.greatest((place - low) / (high - low), 0.0), 1.0)
            force = force + (above - below) * share
        return force if beside is None else m.where(beside, nan, force)


def broken_line_of(law: LoadDiagram | LoadTable) -> BrokenLine:
    """The table of a load as such a formula; it has one column."""
    rows = tuple((float(row[0]), float(row[1])) for row in law.rows)
    if isinstance(law, LoadDiagram):
        return BrokenLine(rows, "x")
    return BrokenLine(rows, law.of, law.period)
