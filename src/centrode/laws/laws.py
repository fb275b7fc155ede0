"""Motion at constant speed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

from centrode.errors import InputError
from centrode.laws.rises import Number, Row, plain, row_at
from centrode.laws.segments import SegmentedLaw
from centrode.locale import _
from centrode.numerics.jets import Jet, JetFunctions
from centrode.numerics.text_formula import TextFormula, compile_formula


@dataclass(frozen=True)
class Uniform:
    """s(t) = speed t, with speed in rad/s or m/s."""

    speed: float

    @property
    def span(self) -> tuple[float, float] | None:
        """Defined everywhere."""
        return None

    def jet(self, m: Any, t: Number) -> Number:
        """s(t) [rad or m] over the algebra of `m`."""
        return t * self.speed


# The cubic spline through given points, twice continuously differentiable, with the not-a-knot end condition.

Cubic = tuple[float, float, float, float]
"""Coefficients c0, c1, c2, c3 of powers of the distance from the segment's left knot."""


def spline(x: Sequence[float], y: Sequence[float]) -> list[Cubic]:
    """Cubics of the segments of the spline through (x, y).

    Parameters
    ----------
    x, y : (n) at least two; x increasing
        Two points give a line, three a parabola.

    Returns
    -------
    n - 1 cubics, each in the distance from its left knot.

    Notes
    -----
    The slopes solve a tridiagonal system (C. de Boor, A Practical Guide to Splines, 2001, chapter IV);
    its elimination needs no pivoting, every pivot is positive.
    """
    steps = [b - a for a, b in pairwise(x)]
    rates = [(b - a) / h for a, b, h in zip(y, y[1:], steps, strict=False)]
    if len(x) == 2:
        return [(y[0], rates[0], 0.0, 0.0)]
    if len(x) == 3:
        return _parabola(y, steps, rates)
    slopes = _slopes(steps, rates)
    return [_hermite(*piece) for piece in zip(y, steps, rates, slopes, slopes[1:], strict=False)]


def _parabola(y: Sequence[float], steps: list[float], rates: list[float]) -> list[Cubic]:
    # the second divided difference: half the second derivative of the parabola
    bend = (rates[1] - rates[0]) / (steps[0] + steps[1])
    first = rates[0] - bend * steps[0]
    return [(y[0], first, bend, 0.0), (y[1], first + 2 * bend * steps[0], bend, 0.0)]


def _hermite(y: float, step: float, rate: float, left: float, right: float) -> Cubic:
    # by how much the mean of both slopes exceeds the rate, doubled: it gives the cubic term
    excess = left + right - 2 * rate
    return y, left, (rate - left - excess) / step, excess / step / step


def _slopes(h: list[float], rate: list[float]) -> list[float]:
    """Slopes at the knots: equal second derivatives inside, equal third derivatives at the second and last but one."""
    # the widths of the first two and of the last two segments, which share a cubic each (not-a-knot)
    d, e = h[0] + h[1], h[-1] + h[-2]
    upper = [d, *h[:-1]]
    diagonal = [h[1]] + [2 * (a + b) for a, b in pairwise(h)] + [h[-2]]
    lower = [*h[1:], e]
    # the not-a-knot conditions with the third slope eliminated by its neighbours' equation, so that the
    # system stays tridiagonal
    right = [((h[0] + 2 * d) * h[1] * rate[0] + h[0] ** 2 * rate[1]) / d]
    # equal second derivatives on both sides of a knot
    right += [3 * (h[i] * rate[i - 1] + h[i - 1] * rate[i]) for i in range(1, len(h))]
    right.append((h[-1] ** 2 * rate[-2] + (2 * e + h[-1]) * h[-2] * rate[-1]) / e)
    for i in range(1, len(diagonal)):
        share = lower[i - 1] / diagonal[i - 1]
        diagonal[i] -= share * upper[i - 1]
        right[i] -= share * right[i - 1]
    slopes = [right[-1] / diagonal[-1]]
    for i in range(len(diagonal) - 2, -1, -1):
        slopes.append((right[i] - upper[i] * slopes[-1]) / diagonal[i])
    return slopes[::-1]


# Motion through the rows of a table.

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
        # outside the table there is no law: rows of NaN in front and behind
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
        raise InputError("", _("a table holds finite numbers only"), _("remove rows without a value"))
    for number, (before, after) in enumerate(pairwise(times), 2):
        if not after > before:
            what = _(
                "the times of a table must increase; they do not at row {number}: {before}, then {after}"
            )
            raise InputError("", what.format(number=number, before=before, after=after), _("sort the rows"))


# Motion by a formula of time written as text.


class _Onward(JetFunctions):
    """Jets whose `abs`, `sign`, `min` and `max` take, where they decide by a zero, the sign just behind it."""

    # where a number is zero, the sign of its first coefficient that is not zero holds behind the place
    def sign(self, x: Number) -> Number:
        if not isinstance(x, Jet):
            return self.base.sign(x)
        sense: Number = 0.0
        for coefficient in x.coefficients:
            # once a sign is found its square is 1, and later coefficients are left out: no branch on a value
            # of an array
            sense = sense + (1.0 - sense * sense) * self.base.sign(coefficient)
        return sense

    def abs(self, x: Number) -> Number:
        return x * self.sign(x) if isinstance(x, Jet) else self.base.abs(x)


@dataclass(frozen=True)
class TextLaw:
    """s(t) [rad or m] by a formula in t [s], such as "0.3*sin(2*t)"; raises InputError for any other text."""

    text: str
    formula: TextFormula = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "formula", compile_formula(self.text, ("t",), ""))

    @property
    def span(self) -> tuple[float, float] | None:
        """Defined everywhere, as far as is known before it is computed."""
        return None

    def jet(self, m: Any, t: Number) -> Number:
        """s(t) [rad or m] over the algebra of `m`; derivatives at a kink are those that hold from there on."""
        # only plain jets: an algebra that watches for jumps has its own signs
        if isinstance(t, Jet) and type(m) is JetFunctions:
            m = _Onward(m.base)
        # A constant formula still has to have the shape of t.
        return self.formula(m, t=t) if self.formula.used else t * 0.0 + self.formula(m)


# A law over the angle of an evenly turning shaft, as a law of time: what a cam does to its follower.


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
