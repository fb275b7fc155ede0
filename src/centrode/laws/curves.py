"""Curves of a rise: s(u) from s(0) = 0 to s(1) = 1, without a dimension; drives and cams use them."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import pi
from typing import Any

from centrode.laws.law import Number
from centrode.laws.pieces import Piece, Pieces


@dataclass(frozen=True)
class Curve:
    """A rise s(u) by formulas between breaks 0 < ... < 1; outside 0 to 1 those at the ends go on."""

    breaks: tuple[float, ...]
    pieces: tuple[Piece, ...]
    whole: Pieces = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        pieces = (self.pieces[0], *self.pieces, self.pieces[-1])
        object.__setattr__(self, "whole", Pieces.of(self.breaks, pieces))

    def jet(self, m: Any, u: Number) -> Number:
        """s(u) over the algebra of `m`, which needs sin (with cos, on jets)."""
        return self.whole.jet(m, u)


def _symmetric(*half: tuple[float, Piece]) -> Curve:
    """The curve with s(u) + s(1 - u) = 1 from the pieces of its first half, each with its end."""
    ends = [end for end, _piece in half]
    pieces = [piece for _end, piece in half]
    other = [piece.mirrored() for piece in reversed(pieces)]
    breaks = (0.0, *ends, *(1.0 - end for end in reversed(ends[:-1])), 1.0)
    return Curve(breaks, (*pieces, *other))


_SINE = 1.0 / (4.0 + pi)
_TRAPEZOID = 1.0 / (2.0 + pi)

CURVES: dict[str, Curve] = {
    "uniform": _symmetric((0.5, Piece(0.0, 0.0, (1.0,)))),
    "harmonic": _symmetric((0.5, Piece(0.0, 0.0, wave=pi / 2, square=1.0))),
    "cycloidal": _symmetric((0.5, Piece(0.0, 0.0, wave=2 * pi, cycloid=0.5 / pi))),
    "3-4-5": _symmetric((0.5, Piece(0.0, 0.0, (0.0, 0.0, 10.0, -15.0, 6.0)))),
    "4-5-6-7": _symmetric((0.5, Piece(0.0, 0.0, (0.0, 0.0, 0.0, 35.0, -84.0, 70.0, -20.0)))),
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

Accelerations of the modified ones (R. L. Norton, Cam Design and Manufacturing Handbook, 2009, chapter 3),
in terms of the greatest one a:

- modified sine, a = 4 pi^2 / (4 + pi): a sin(4 pi u) up to u = 1/8, then a cos(4 pi/3 (u - 1/8)) up to 7/8;
- modified trapezoid, a = 8 pi / (2 + pi): a sin(4 pi u) up to 1/8, a up to 3/8, a cos(4 pi (u - 3/8)) up to 1/2.

The constants follow from s(1/2) = 1/2 and from equal values and speeds where the formulas meet.
"""
