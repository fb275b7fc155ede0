"""Motion by segments: one curve after the other, with dwells between, once or again and again."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Any

from centrode.errors import InputError
from centrode.laws.b_spline import b_spline
from centrode.laws.conditions import Condition, polynomial
from centrode.laws.curves import CURVES
from centrode.laws.law import Number
from centrode.laws.pieces import Piece, Pieces, plain
from centrode.locale import _

DWELL = "dwell"
POLYNOMIAL = "polynomial"
B_SPLINE = "b-spline"
THROUGH_POINTS = (POLYNOMIAL, B_SPLINE)
"""Curves by conditions: values on the way, derivatives at the ends."""
SEGMENT_CURVES = (*CURVES, DWELL, *THROUGH_POINTS)

DEGREE = 5
"""Of a B-spline: with it speed, acceleration, jerk and the rate of the jerk are continuous."""
MOST_DEGREE = 15
INNER_JUMPS = {"modified sine": 4, "modified trapezoid": 4}
"""Curves of several formulas, and the lowest derivative that jumps where these meet."""


@dataclass(frozen=True)
class Segment:
    """A stretch of a motion.

    Attributes
    ----------
    time : float [s], positive
        How long it lasts.
    to : float [rad or m]
        The law's value at its end; a dwell has none.
    curve : str
        One of `SEGMENT_CURVES`.
    at_start, at_end : tuple of float [rad/s or m/s, and so on]
        Of a polynomial or a B-spline: speed, acceleration, ... as far as they are given.
    through : tuple of (time [s], value [rad or m])
        Of a polynomial or a B-spline: values on the way, at times from the segment's start.
    degree : int
        Of a B-spline.

    Raises
    ------
    InputError
        Numbers that are not finite, or times that do not increase.
    """

    time: float
    to: float | None
    curve: str
    at_start: tuple[float, ...] = ()
    at_end: tuple[float, ...] = ()
    through: tuple[tuple[float, float], ...] = ()
    degree: int = DEGREE

    def __post_init__(self) -> None:
        numbers = [self.time, self.to or 0.0, *self.at_start, *self.at_end]
        if not all(math.isfinite(number) for number in (*numbers, *(v for row in self.through for v in row))):
            raise InputError("", _("a segment holds finite numbers only"), _("correct them"))
        if self.time <= 0:
            raise InputError("", _("the time of a segment is positive"), _("correct it"))
        if self.curve not in SEGMENT_CURVES or (self.to is None) != (self.curve == DWELL):
            raise InputError("", _("a segment has a known curve, and a value at its end unless it dwells"))
        times = (0.0, *(time for time, _value in self.through), self.time)
        if not all(before < after for before, after in pairwise(times)):
            what = _("the times of `through` increase and lie inside the segment, counted from its start")
            raise InputError("", what, _("correct them, or the segment's time"))
        if not 1 <= self.degree <= MOST_DEGREE:
            what = _("the degree of a B-spline lies between 1 and {most}").format(most=MOST_DEGREE)
            raise InputError("", what)
        rates = max(len(self.at_start), len(self.at_end))
        if self.curve == B_SPLINE and rates >= self.degree:
            what = _("a B-spline of degree {degree} takes fewer derivatives at an end than that, got {count}")
            told = what.format(degree=self.degree, count=rates)
            raise InputError("", told, _("raise the degree, or give fewer"))

    @property
    def inner_jump(self) -> int | None:
        """The lowest derivative that jumps inside the segment; None: all are continuous."""
        if self.curve == B_SPLINE:
            count = 2 + len(self.at_start) + len(self.at_end) + len(self.through)
            return self.degree if count > self.degree + 1 else None
        return INNER_JUMPS.get(self.curve)

    def pieces(self, start: float, before: float) -> list[tuple[float, Piece]]:
        """Its formulas, each with the time [s] at which it ends, from a time and a value of the law."""
        if self.curve in THROUGH_POINTS:
            asked = self._conditions(before)
            found = polynomial(asked) if self.curve == POLYNOMIAL else b_spline(asked, self.degree)
            return [(start + end, replace(piece, origin=start + piece.origin)) for end, piece in found]
        after = before if self.to is None else self.to
        curve = CURVES["uniform" if self.curve == DWELL else self.curve]
        ends = [start + end * self.time for end in curve.breaks[1:]]
        placed = [piece.placed(start, self.time, before, after) for piece in curve.pieces]
        return list(zip(ends, placed, strict=True))

    def _conditions(self, before: float) -> list[Condition]:
        """What is asked of the polynomial or the B-spline, at times from the segment's start."""
        way: list[Condition] = [(time, (value,)) for time, value in self.through]
        return [(0.0, (before, *self.at_start)), *way, (self.time, (self.to or 0.0, *self.at_end))]


@dataclass(frozen=True)
class SegmentedLaw:
    """s(t) by segments from s(0) = 0; before them it stays at 0, after them at its last value.

    At a joint derivatives are those of the segment that begins there, at the very end those of the last
    one. With `repeat` the segments follow each other again and again, also before t = 0, and the value runs
    on: each turn adds what the last segment ends at.

    Raises
    ------
    InputError
        No segments, or one so short that it is lost beside the others.
    """

    segments: tuple[Segment, ...]
    repeat: bool = False
    whole: Pieces = field(init=False, repr=False, compare=False)
    ends: tuple[float, ...] = field(init=False, repr=False, compare=False)
    gain: float = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        if not self.segments:
            raise InputError("", _("a law of segments needs at least one"), _("add a segment"))
        breaks, pieces, value, ends = [0.0], [], 0.0, []
        for number, segment in enumerate(self.segments, 1):
            for end, piece in segment.pieces(breaks[-1], value):
                if not end > breaks[-1]:
                    what = _("segment {number} is too short beside those before it").format(number=number)
                    raise InputError("", what, _("give it more time"))
                breaks.append(end)
                pieces.append(piece)
            value = value if segment.to is None else segment.to
            ends.append(breaks[-1])
        # A turn may lack a rounding error of the period: the formulas at its ends then go on.
        before, after = (pieces[0], pieces[-1]) if self.repeat else (Piece(0.0, 0.0), Piece(0.0, value))
        object.__setattr__(self, "whole", Pieces.of(breaks, (before, *pieces, after)))
        object.__setattr__(self, "ends", tuple(ends))
        object.__setattr__(self, "gain", value)

    @property
    def period(self) -> float:
        """How long all segments last together [s]."""
        return self.whole.breaks[-1]

    @property
    def span(self) -> tuple[float, float] | None:
        """From 0 to the end of the last segment; None if the segments repeat."""
        return None if self.repeat else (0.0, self.period)

    def at_joint(self, number: int, m: Any, t: Number) -> tuple[Number, Number]:
        """What the formulas before and behind the end of a segment, counted from 0, give at t over the algebra of `m`.

        At the last end the formula behind it is that of the first segment, a period later, where they repeat.
        """
        place = self.whole.breaks.index(self.ends[number])
        before = self.whole.at_row(place, m, t)
        if self.repeat and number == len(self.ends) - 1:
            return before, self.whole.at_row(1, m, t - self.period) + self.gain
        return before, self.whole.at_row(place + 1, m, t)

    def jet(self, m: Any, t: Number) -> Number:
        """s(t) [rad or m] over the algebra of `m`; the segment is chosen by the plain value of t."""
        if not self.repeat:
            return self.whole.jet(m, t)
        turn = plain(t) // self.period
        return self.whole.jet(m, t - turn * self.period) + turn * self.gain
