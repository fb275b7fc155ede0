"""Motion through the rows of a table."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

from centrode.errors import InputError
from centrode.laws.law import Number
from centrode.laws.pieces import Row, plain, row_at
from centrode.laws.spline import Cubic, spline
from centrode.locale import _

_NOWHERE: Cubic = (math.nan, math.nan, math.nan, math.nan)


@dataclass(frozen=True)
class TableLaw:
    """s(t) by the cubic spline through rows of time [s] and value [rad or m]; NaN outside the table.

    Raises
    ------
    InputError
        Fewer than two rows, times that do not increase, or numbers that are not finite.
    """

    times: tuple[float, ...]
    values: tuple[float, ...]
    cubics: tuple[Cubic, ...] = field(init=False, repr=False, compare=False)
    rows: tuple[Row, ...] = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        _check(self.times, self.values)
        cubics = (_NOWHERE, *_cubics(self.times, self.values), _NOWHERE)
        lefts = (self.times[0], *self.times)
        rows = tuple((left, *cubic) for left, cubic in zip(lefts, cubics, strict=True))
        object.__setattr__(self, "cubics", cubics)
        object.__setattr__(self, "rows", rows)

    @property
    def span(self) -> tuple[float, float] | None:
        """First and last time of the table."""
        return self.times[0], self.times[-1]

    def jet(self, m: Any, t: Number) -> Number:
        """s(t) [rad or m] over the algebra of `m`; the segment is chosen by the plain value of t."""
        left, c0, c1, c2, c3 = row_at(self.times, self.rows, plain(t))
        u = t - left
        return ((u * c3 + c2) * u + c1) * u + c0


def _cubics(times: tuple[float, ...], values: tuple[float, ...]) -> list[Cubic]:
    try:
        cubics = spline(times, values)
    except ArithmeticError:
        cubics = [_NOWHERE]
    if not all(math.isfinite(c) for cubic in cubics for c in cubic):
        raise InputError("", _("the rows lie too close for a smooth curve through them"), _("thin them out"))
    return cubics


def _check(times: tuple[float, ...], values: tuple[float, ...]) -> None:
    if len(times) < 2 or len(times) != len(values):
        raise InputError("", _("a table needs at least two rows of a time and a value"), _("add rows"))
    if not all(math.isfinite(number) for number in (*times, *values)):
        raise InputError("", _("a table holds finite numbers only"), _("take out rows without a value"))
    for number, (before, after) in enumerate(pairwise(times), 2):
        if not after > before:
            what = _("the times of a table increase, row {number} does not: {before}, then {after}")
            raise InputError("", what.format(number=number, before=before, after=after), _("sort the rows"))
