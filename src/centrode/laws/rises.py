"""Motion laws."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import pi
from typing import Any, Protocol

from centrode.numerics.text_formula import TextFormula

Number = Any


class Law(Protocol):
    """A motion law s(t); with jets as t it gives its derivatives."""

    @property
    def span(self) -> tuple[float, float] | None:
        """First and last t [s] at which the law is defined; None: everywhere."""

    def jet(self, m: Any, t: Number) -> Number:
        """s(t) [rad or m] over the algebra whose functions `m` holds."""


# Formulas that hold one after the other: what curves, laws of segments and tables are made of.

Row = tuple[Any, ...]


@dataclass(frozen=True)
class Piece:
    """value + powers of x + cycloid (y - sin y) + square (sin y)^2, with x = (t - origin) / unit, y = wave x.

    Written so that what vanishes at the origin vanishes there exactly, with as many derivatives as it
    should: the sense in which a drive sets out is that of its first derivative that is not zero.

    Attributes
    ----------
    powers : tuple of float
        Coefficients of x, x^2, ...
    """

    origin: float
    value: float
    powers: tuple[float, ...] = ()
    wave: float = 0.0
    cycloid: float = 0.0
    square: float = 0.0
    unit: float = 1.0

    def mirror(self) -> Piece:
        """The piece of 1 - s(1 - u): the other half of a curve that is symmetric about its middle."""
        # 1 - s(1 - u): odd powers keep their sign, even ones and the square change it
        powers = tuple(c if k % 2 else -c for k, c in enumerate(self.powers, 1))
        return replace(
            self, origin=1.0 - self.origin, value=1.0 - self.value, powers=powers, square=-self.square
        )

    def place(self, start: float, unit: float, before: float, after: float) -> Piece:
        """The piece of a curve that runs from (start, before) to (start + unit, after), not from (0, 0) to (1, 1)."""
        rise = after - before
        return Piece(
            # by shares of the ends, so that the last piece ends at the given value exactly
            between(start, start + unit, self.origin),
            between(before, after, self.value),
            tuple(c * rise for c in self.powers),
            self.wave,
            self.cycloid * rise,
            self.square * rise,
            unit,
        )

    def row(self, degree: int) -> Row:
        """The numbers of this formula as a row of a table, its powers filled up with zeros to a degree."""
        missing = (0.0,) * (degree - len(self.powers))
        numbers = (self.origin, self.unit, self.wave, self.cycloid, self.square)
        return (*numbers, self.value, *self.powers, *missing)


@dataclass(frozen=True)
class TextPiece:
    """A formula that is written as text, in the distance x = t - origin.

    Attributes
    ----------
    formula : of the variable `phi` and of `numbers`
    length : of the stretch on which it holds
    numbers : name -> value of its other variables
    """

    origin: float
    formula: TextFormula
    length: float
    numbers: Mapping[str, float]
    wave: float = field(default=0.0, init=False)
    powers: tuple[float, ...] = field(default=(), init=False)

    def row(self, degree: int) -> Row:
        """The row of zero, which stands for this formula in a table of rows."""
        return Piece(self.origin, 0.0).row(degree)

    def jet(self, m: Any, t: Number) -> Number:
        """The value at t over the algebra of `m`, which needs what the formula uses."""
        x = t - self.origin
        # with x times zero a constant formula too has the shape and the order of t
        return x * 0.0 + self.formula(m, phi=x, **self.numbers)

    def jet_where(self, here: Number, m: Any, t: Number) -> Number:
        """The same where `here` is 1, and 0 where it is 0: there the formula is taken at the middle of its stretch."""
        middle = self.origin + 0.5 * self.length
        return self.jet(m, t * here + (1.0 - here) * middle) * here


@dataclass(frozen=True)
class Pieces:
    """Formulas by stretches: before the first break, between the breaks, after the last.

    At a break the right one holds, at the last break the left one, with its derivatives.
    """

    breaks: tuple[float, ...]
    rows: tuple[Row, ...]
    waves: bool
    texts: Mapping[int, TextPiece] = field(default_factory=dict)

    @classmethod
    def of(cls, breaks: Sequence[float], pieces: Sequence[Piece | TextPiece]) -> Pieces:
        """From pieces, one more than breaks."""
        degree = max(len(piece.powers) for piece in pieces)
        rows = tuple(piece.row(degree) for piece in pieces)
        texts = {place: piece for place, piece in enumerate(pieces) if isinstance(piece, TextPiece)}
        return cls(tuple(breaks), rows, any(piece.wave for piece in pieces), texts)

    def jet(self, m: Any, t: Number) -> Number:
        """The value at t over the algebra of `m`, which needs sin (with cos, on jets)."""
        if self.texts:
            return self._jet_with_texts(m, t)
        return self._formula(row_at(self.breaks, self.rows, plain(t)), m, t)

    def at_row(self, place: int, m: Any, t: Number) -> Number:
        """The value at t by one formula, wherever t lies: 0 is the one before the first break."""
        if place in self.texts:
            return self.texts[place].jet(m, t)
        return self._formula(self.rows[place], m, t)

    def _jet_with_texts(self, m: Any, t: Number) -> Number:
        """The value at t where some formulas are no rows: of an array each of these is evaluated for itself."""
        if hasattr(plain(t), "is_condition"):
            raise TypeError("text formulas of segments are chosen by a value")
        places = places_at(self.breaks, plain(t))
        if isinstance(places, int):
            return self.at_row(places, m, t)
        value = self._formula(row_at(self.breaks, self.rows, plain(t)), m, t)
        for place, text in self.texts.items():
            value = value + text.jet_where((places == place) * 1.0, m, t)
        return value

    def _formula(self, row: Row, m: Any, t: Number) -> Number:
        origin, unit, wave, cycloid, square, *powers = row
        x = (t - origin) / unit
        # with x times zero the number has the shape and the order of t
        value = x * 0.0 + powers.pop()
        while powers:
            value = value * x + powers.pop()
        if not self.waves:
            return value
        y = x * wave
        sine = m.sin(y)
        return value + (y - sine) * cycloid + sine * sine * square


def between(first: float, last: float, share: float) -> float:
    """The number at a share of the way; exactly the ends at 0 and 1."""
    return first * (1.0 - share) + last * share


def plain(t: Number) -> Number:
    """The plain value of a jet or a bounded number."""
    return getattr(t, "value", t)


ROUNDER = 1.5 * 2.0**52
"""Adding it and taking it off again rounds to a whole number."""


def whole_turns(t: Number, period: Number) -> Number:
    """The whole periods before a plain t; of an expression by rounding, as it has no floor."""
    if not hasattr(t, "is_condition"):
        return t // period
    m, turns = t.__array_namespace__(), t / period
    nearest = (turns + ROUNDER) - ROUNDER
    return nearest - m.where(m.less(turns, nearest), 1.0, 0.0)


def row_at(breaks: Sequence[float], rows: Sequence[Row], t: Number) -> Row:
    """The row of the stretch that a plain t lies in; of an array a row of arrays, of an expression one of choices.

    Rows are one more than breaks. At a break the right one is taken, at the last break the left one.
    """
    if hasattr(t, "is_condition"):
        return _chosen_row(breaks, rows, t)
    places = places_at(breaks, t)
    if isinstance(places, int):
        return rows[places]
    # The array says itself which library it belongs to: this room imports none.
    xp = t.__array_namespace__()
    return tuple(xp.moveaxis(xp.asarray(rows)[places], -1, 0))


def _chosen_row(breaks: Sequence[float], rows: Sequence[Row], t: Number) -> Row:
    """The row as an expression: numbers that conditions on t choose."""
    m = t.__array_namespace__()
    row = tuple(rows[0])
    for place, later in enumerate(rows[1:]):
        last = place == len(breaks) - 1
        before = m.less_equal(t, breaks[place]) if last else m.less(t, breaks[place])
        row = tuple(m.where(before, x, y) for x, y in zip(row, later, strict=True))
    return row


def places_at(breaks: Sequence[float], t: Number) -> Any:
    """The number of the stretch that a plain t lies in, as of `row_at`; of an array an array of numbers."""
    if isinstance(t, float | int) or not hasattr(t, "__array_namespace__"):
        # bisect_right takes the right piece at a break; at the last break the left one is meant
        return bisect_right(breaks, t) - (1 if t == breaks[-1] else 0)
    xp = t.__array_namespace__()
    return xp.searchsorted(xp.asarray(breaks), t, side="right") - (t == breaks[-1])


# Curves of a rise: s(u) from s(0) = 0 to s(1) = 1, without a dimension; drives and cams use them.


@dataclass(frozen=True)
class RiseCurve:
    """A rise s(u) by formulas between breaks 0 < ... < 1; outside 0 to 1 those at the ends go on."""

    breaks: tuple[float, ...]
    pieces: tuple[Piece, ...]
    whole: Pieces = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        # beyond both ends the formulas there go on: jets at the very ends need a neighbourhood
        pieces = (self.pieces[0], *self.pieces, self.pieces[-1])
        object.__setattr__(self, "whole", Pieces.of(self.breaks, pieces))

    def jet(self, m: Any, u: Number) -> Number:
        """s(u) over the algebra of `m`, which needs sin (with cos, on jets)."""
        return self.whole.jet(m, u)


def _symmetric(*half: tuple[float, Piece]) -> RiseCurve:
    # given to the middle; the other half mirrors it, so both meet there exactly
    """The curve with s(u) + s(1 - u) = 1 from the pieces of its first half, each with its end."""
    ends = [end for end, _piece in half]
    pieces = [piece for _end, piece in half]
    other = [piece.mirror() for piece in reversed(pieces)]
    breaks = (0.0, *ends, *(1.0 - end for end in reversed(ends[:-1])), 1.0)
    return RiseCurve(breaks, (*pieces, *other))


_SINE = 1.0 / (4.0 + pi)
_TRAPEZOID = 1.0 / (2.0 + pi)

CURVES: dict[str, RiseCurve] = {
    "uniform": _symmetric((0.5, Piece(0.0, 0.0, (1.0,)))),
    "parabolic": _symmetric((0.5, Piece(0.0, 0.0, (0.0, 2.0)))),
    "harmonic": _symmetric((0.5, Piece(0.0, 0.0, wave=pi / 2, square=1.0))),
    "cycloidal": _symmetric((0.5, Piece(0.0, 0.0, wave=2 * pi, cycloid=0.5 / pi))),
    "3-4-5": _symmetric((0.5, Piece(0.0, 0.0, (0.0, 0.0, 10.0, -15.0, 6.0)))),
    "4-5-6-7": _symmetric((0.5, Piece(0.0, 0.0, (0.0, 0.0, 0.0, 35.0, -84.0, 70.0, -20.0)))),
    "trapezoid": _symmetric(
        (1 / 8, Piece(0.0, 0.0, (0.0, 0.0, 64 / 9))),
        (3 / 8, Piece(1 / 8, 1 / 72, (1 / 3, 8 / 3))),
        (0.5, Piece(0.5, 0.5, (2.0, 0.0, -64 / 9))),
    ),
    "modified sine": _symmetric(
        (1 / 8, Piece(0.0, 0.0, wave=4 * pi, cycloid=_SINE / 4)),
        (0.5, Piece(0.5, 0.5, (4 * pi * _SINE,), wave=4 * pi / 3, cycloid=-9 * _SINE / 4)),
    ),
    "modified trapezoid": _symmetric(
        (1 / 8, Piece(0.0, 0.0, wave=4 * pi, cycloid=_TRAPEZOID / (2 * pi))),
        (3 / 8, Piece(1 / 8, (0.25 - 0.5 / pi) * _TRAPEZOID, (2 * _TRAPEZOID, 4 * pi * _TRAPEZOID))),
        (0.5, Piece(0.5, 0.5, (2.0,), wave=4 * pi, cycloid=-_TRAPEZOID / (2 * pi))),
    ),
}
"""Curves by name.

The acceleration of the parabolic one is 4 up to u = 1/2; that of the trapezoid 128 u/3 up to 1/8, 16/3 up to 3/8,
128 (1/2 - u)/3 up to 1/2.

Accelerations of the modified ones (R. L. Norton, Cam Design and Manufacturing Handbook, 2009, chapter 3),
in terms of the greatest one a:

- modified sine, a = 4 pi^2 / (4 + pi): a sin(4 pi u) up to u = 1/8, then a cos(4 pi/3 (u - 1/8)) up to 7/8;
- modified trapezoid, a = 8 pi / (2 + pi): a sin(4 pi u) up to 1/8, a up to 3/8, a cos(4 pi (u - 3/8)) up to 1/2.

The constants follow from s(1/2) = 1/2 and from equal values and speeds where the formulas meet.
"""
