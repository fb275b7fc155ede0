"""Motion by segments: one curve after the other, with dwells between, once or again and again."""

from __future__ import annotations

import functools
import math
import re
from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from itertools import pairwise
from typing import Any

from centrode.errors import InputError
from centrode.laws.rises import CURVES, Number, Piece, Pieces, TextPiece, plain, whole_turns
from centrode.locale import _
from centrode.numerics.operations import FUNCTIONS
from centrode.numerics.text_formula import TextFormula, compile_formula

# The polynomial that has given values and derivatives at given times.

Condition = tuple[float, tuple[float, ...]]
"""A time with the value and as many derivatives as are given there."""


def polynomial(conditions: Sequence[Condition]) -> list[tuple[float, Piece]]:
    """The polynomial of lowest degree that meets all conditions.

    Parameters
    ----------
    conditions : two or more, times increasing

    Returns
    -------
    The same polynomial in powers of the distance from each of the times, each with the time up to which it
    is the nearest.

    Raises
    ------
    InputError
        The coefficients are beyond what can be computed with.

    Notes
    -----
    The floats given are taken as exact: the coefficients are rounded once, so the conditions are met to
    rounding however high the degree. Times are counted in a fraction of a second of which all of them are
    whole multiples, so that whole numbers do. Confluent divided differences: J. Stoer, R. Bulirsch,
    Introduction to Numerical Analysis, 2002, section 2.1.5.
    """
    # denominators of floats are powers of two: the greatest of them serves all
    ticks = max(time.as_integer_ratio()[1] for time, _given in conditions)
    nodes = [int(Fraction(time) * ticks) for time, _given in conditions]
    series = [_series(given, ticks) for _time, given in conditions]
    powers, divisor = _powers(nodes, series)
    ends = [(a + b) / 2 for (a, _a), (b, _b) in pairwise(conditions)] + [conditions[-1][0]]
    unit = conditions[-1][0] - conditions[0][0]
    pieces = []
    for end, node, (time, _given) in zip(ends, nodes, conditions, strict=True):
        # whole numbers up to here: each coefficient is rounded once
        rounded = _coefficients_in_units(_about(powers, node), int(Fraction(unit) * ticks), divisor)
        pieces.append((end, Piece(time, rounded[0], tuple(rounded[1:]), unit=unit)))
    return pieces


def _series(given: tuple[float, ...], ticks: int) -> list[Fraction]:
    """Taylor coefficients by ticks, from value and derivatives by seconds."""
    return [Fraction(rate) / (ticks**k * math.factorial(k)) for k, rate in enumerate(given)]


def _powers(nodes: list[int], series: list[list[Fraction]]) -> tuple[list[int], int]:
    """Coefficients of powers, and their common divisor."""
    repeated = [node for node, taylor in zip(nodes, series, strict=True) for _number in taylor]
    newton = _differences(nodes, series)
    divisor = math.lcm(*(coefficient.denominator for coefficient in newton))
    powers: list[int] = []
    # Newton's form multiplied out from the last factor on: powers * (x - node) + coefficient
    for coefficient, node in zip(reversed(newton), reversed(repeated), strict=True):
        powers = [b - node * a for a, b in zip([*powers, 0], [0, *powers], strict=True)]
        powers[0] += int(coefficient * divisor)
    return powers, divisor


def _differences(nodes: list[int], series: list[list[Fraction]]) -> list[Fraction]:
    """Divided differences: nodes count as often as numbers are given there."""
    repeated = [(node, taylor) for node, taylor in zip(nodes, series, strict=True) for _number in taylor]
    column = [taylor[0] for _node, taylor in repeated]
    newton = [column[0]]
    for width in range(1, len(repeated)):
        ends = list(zip(repeated, repeated[width:], strict=False))
        column = [
            # where a node is repeated the divided difference is the Taylor coefficient
            taylor[width] if left == right else (after - before) / (right - left)
            for ((left, taylor), (right, _taylor)), (before, after) in zip(
                ends, pairwise(column), strict=True
            )
        ]
        newton.append(column[0])
    return newton


def _about(powers: list[int], node: int) -> list[int]:
    """The polynomial in powers of the distance from a node, by repeated division."""
    shifted = list(powers)
    # Horner's scheme again and again: the remainders are the coefficients about the node
    for k in range(len(shifted)):
        for i in reversed(range(k, len(shifted) - 1)):
            shifted[i] += node * shifted[i + 1]
    return shifted


def _coefficients_in_units(powers: list[int], unit: int, divisor: int) -> list[float]:
    """Coefficients for a distance that is counted in units."""
    try:
        return [c * unit**k / divisor for k, c in enumerate(powers)]
    except OverflowError:
        what = _("a polynomial with these conditions cannot be computed")
        raise InputError("", what, _("give smaller rates, or a shorter time")) from None


# The B-spline through given values, with given derivatives at both ends.

Numbers = list[float]


def b_spline(conditions: Sequence[Condition], degree: int) -> list[tuple[float, Piece]]:
    """The spline of a degree that meets all conditions; inside it degree - 1 derivatives are continuous.

    Parameters
    ----------
    conditions : two or more, times increasing
        Values, and at both ends as many derivatives as are given there.
    degree : int, at least 1
        With fewer conditions than degree + 1 it is the polynomial through them.

    Returns
    -------
    Polynomials, each with the time up to which it holds. That of the last stretch is given about its beginning
    and about its end, so that the conditions at the ends hold there exactly.

    Raises
    ------
    InputError
        The coefficients are beyond what can be computed with.

    Notes
    -----
    Knots lie at the times of the values where the conditions at both ends are as many as such a spline needs,
    (degree + 1)/2 for an odd degree: the natural end of a smoothest spline. Else each is the mean of the `degree`
    times that follow each other there (C. de Boor, A Practical Guide to Splines, 2001, chapter XIII), so that the
    spline exists. Coefficients at the ends follow from the conditions there one by one; the others solve a
    totally positive banded system, whose elimination needs no pivoting (ibid.).
    """
    first, last = conditions[0][0], conditions[-1][0]
    unit = last - first
    rates = [[rate * unit**k for k, rate in enumerate(given)] for _time, given in conditions]
    places = [(time - first) / unit for time, _given in conditions]
    # with few conditions the polynomial through them is the spline of the greatest degree they determine
    degree = min(degree, sum(map(len, rates)) - 1)
    knots = _knots(places, rates, degree)
    coefficients = _coefficients(places, rates, knots, degree)
    if not all(map(math.isfinite, coefficients)):
        what = _("a spline with these conditions cannot be computed")
        raise InputError("", what, _("give smaller rates, or a shorter time"))
    pieces = []
    for place, end, taylor in _stretches(knots, coefficients, degree):
        # what is given at the ends is put in as it is: sums of basis functions would round it
        given = {0.0: rates[0], 1.0: rates[-1]}.get(place, [])
        taylor[: len(given)] = [rate / math.factorial(k) for k, rate in enumerate(given)][: degree + 1]
        origin = last if place == 1.0 else first + place * unit
        pieces.append((first + end * unit, Piece(origin, taylor[0], tuple(taylor[1:]), unit=unit)))
    # the last stretch holds up to its end: the two polynomials about its ends are one
    return [*pieces[:-1], (last, pieces[-1][1])]


def _knots(places: Numbers, rates: list[Numbers], degree: int) -> Numbers:
    """All knots from 0 to 1, those at the ends degree + 1 times."""
    # as many conditions at the ends as the ends of such a spline need: then knots lie at the inner times
    needed = (degree + 1) / 2
    inner = places[1:-1]
    if not len(rates[0]) == len(rates[-1]) == needed:
        repeated = [place for place, given in zip(places, rates, strict=True) for _rate in given]
        count = len(repeated) - degree - 1
        # else at means of neighbouring times, which keeps the system regular (Schoenberg and Whitney)
        inner = [math.fsum(repeated[k : k + degree]) / degree for k in range(1, count + 1)]
    return [0.0] * (degree + 1) + inner + [1.0] * (degree + 1)


def _coefficients(places: Numbers, rates: list[Numbers], knots: Numbers, degree: int) -> Numbers:
    left = _at_end(rates[0], knots, degree)
    mirrored = [1.0 - knot for knot in reversed(knots)]
    # seen from the other end odd derivatives change their sign
    flipped = [-rate if k % 2 else rate for k, rate in enumerate(rates[-1])]
    right = _at_end(flipped, mirrored, degree)[::-1]
    inner = [given[0] for given in rates[1:-1]]
    count = len(left) + len(inner) + len(right)
    known = [*left, *([0.0] * len(inner)), *right]
    rows, sides = [], []
    for number, (place, value) in enumerate(zip(places[1:-1], inner, strict=True)):
        span = bisect_right(knots, place) - 1
        start = span - degree
        basis = _basis(knots, span, degree, place)
        # what the known coefficients at both ends give is taken to the right side
        side = value - math.fsum(b * known[start + k] for k, b in enumerate(basis))
        width = {start + k - len(left): b for k, b in enumerate(basis)}
        rows.append({k: b for k, b in width.items() if 0 <= k < len(inner)})
        rows[number].setdefault(number, 0.0)
        sides.append(side)
    solved = _solve_banded(rows, sides)
    return [*left, *solved, *right][:count]


def _at_end(rates: Numbers, knots: Numbers, degree: int) -> Numbers:
    """The first coefficients, from value and derivatives at the beginning.

    There the k-th derivative is the first coefficient of the k-th derived spline, and coefficients of derived
    splines are differences of those above them.
    """
    column = [rates[0]]
    known = [rates[0]]
    for order in range(1, len(rates)):
        derived = [rates[order]]
        for k in range(order):
            # From the highest derivative down: each difference gives the next coefficient of the one below it.
            low = order - 1 - k
            step = (knots[degree + 1 + k] - knots[low + k + 1]) / (degree - low)
            derived.append(column[low] + derived[-1] * step)
        column = derived[::-1]
        known.append(column[0])
    return known


def _solve_banded(rows: list[dict[int, float]], sides: Numbers) -> Numbers:
    """The solution of a banded system by elimination without pivoting."""
    count = len(rows)
    # B-splines are positive where they are not zero, and their collocation matrices need no pivoting
    for k in range(count):
        for below in range(k + 1, count):
            if k not in rows[below]:
                # below the band there is nothing
                break
            share = rows[below].pop(k) / rows[k][k]
            for column, number in rows[k].items():
                if column > k:
                    rows[below][column] = rows[below].get(column, 0.0) - share * number
            sides[below] -= share * sides[k]
    solved = [0.0] * count
    for k in reversed(range(count)):
        rest = math.fsum(number * solved[column] for column, number in rows[k].items() if column > k)
        solved[k] = (sides[k] - rest) / rows[k][k]
    return solved


def _basis(knots: Numbers, span: int, degree: int, place: float) -> Numbers:
    """The degree + 1 B-splines that are not zero on a stretch (Cox and de Boor)."""
    values = [1.0]
    for order in range(1, degree + 1):
        raised = [0.0] * (order + 1)
        for k, value in enumerate(values):
            low, high = knots[span + 1 + k - order], knots[span + 1 + k]
            # the share of the stretch that the two lower splines have
            share = (place - low) / (high - low)
            raised[k] += (1.0 - share) * value
            raised[k + 1] += share * value
        values = raised
    return values


def _stretches(knots: Numbers, coefficients: Numbers, degree: int) -> list[tuple[float, float, Numbers]]:
    """Origin, end and Taylor coefficients of each stretch between knots; the last one twice."""
    edges = knots[degree : len(knots) - degree]
    derived = [coefficients]
    for order in range(1, degree + 1):
        above, width = derived[-1], degree + 1 - order
        # knots differ by one less from derivative to derivative
        steps = [knots[order + k + width] - knots[order + k] for k in range(len(above) - 1)]
        derived.append([width * (b - a) / step for (a, b), step in zip(pairwise(above), steps, strict=True)])
    stretches = []
    for number, (low, high) in enumerate(pairwise(edges)):
        span = degree + number
        middle = low + (high - low) / 2
        last = number == len(edges) - 2
        # the last stretch twice: about its beginning for its first half, and about its end
        parts = [(low, middle), (high, high)] if last else [(low, high)]
        for origin, end in parts:
            taylor = []
            for order, row in enumerate(derived):
                # The derived spline has one knot less at each end a step.
                basis = _basis(knots, span, degree - order, origin)
                local = row[number : number + degree - order + 1]
                rate = math.fsum(b * c for b, c in zip(basis, local, strict=True))
                taylor.append(rate / math.factorial(order))
            stretches.append((origin, end, taylor))
    return stretches


DWELL = "dwell"
POLYNOMIAL = "polynomial"
B_SPLINE = "b-spline"
THROUGH_POINTS = (POLYNOMIAL, B_SPLINE)
"""Curves by conditions: values on the way, derivatives at the ends."""
FORMULA = "formula"
"""A segment that is written as text."""
SEGMENT_CURVES = (*CURVES, DWELL, *THROUGH_POINTS)
LIFT_CURVES = (*SEGMENT_CURVES, FORMULA)
"""Of a cam: a drive has formulas of time instead."""
VARIABLES = ("phi", "beta", "h", "s0", "s1")
"""Of a formula: angle from the segment's start, angle of the segment, rise, value at its start and at its end."""
SMOOTH = ("sin", "cos", "tan", "sqrt", "exp", "log")
"""Functions that a formula of a segment may use: inside a segment all derivatives are continuous."""
CURVE_SYNONYMS = {
    "linear": "uniform",
    "constant velocity": "uniform",
    "constant acceleration": "parabolic",
    "parabola": "parabolic",
    "cosine": "harmonic",
    "cosine acceleration": "harmonic",
    "sine": "cycloidal",
    "sinusoidal": "cycloidal",
    "sine acceleration": "cycloidal",
    "quintic": "3-4-5",
    "polynomial 3-4-5": "3-4-5",
    "septic": "4-5-6-7",
    "polynomial 4-5-6-7": "4-5-6-7",
    "trapezoidal": "trapezoid",
    "trapezoidal acceleration": "trapezoid",
    "modified sinusoidal": "modified sine",
    "modified trapezoidal": "modified trapezoid",
    "constant": DWELL,
    "pause": DWELL,
    "rest": DWELL,
}
"""What textbooks also call these curves: an error proposes the curve."""

DEGREE = 5
"""Of a B-spline: with it speed, acceleration, jerk and the rate of the jerk are continuous."""
MOST_DEGREE = 15
INNER_JUMPS = {"parabolic": 2, "trapezoid": 3, "modified sine": 4, "modified trapezoid": 4}
"""Curves of several formulas, and the lowest derivative that jumps where these meet."""


@dataclass(frozen=True)
class LawSegment:
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
    text : str
        Of a formula in `VARIABLES`, whose value is that of the law.

    Raises
    ------
    InputError
        Numbers that are not finite, times that do not increase, a text that is no formula.
    """

    time: float
    to: float | None
    curve: str
    at_start: tuple[float, ...] = ()
    at_end: tuple[float, ...] = ()
    through: tuple[tuple[float, float], ...] = ()
    degree: int = DEGREE
    text: str = ""

    def __post_init__(self) -> None:
        if self.curve == FORMULA:
            segment_formula(self.text)
        numbers = [self.time, self.to or 0.0, *self.at_start, *self.at_end]
        if not all(math.isfinite(number) for number in (*numbers, *(v for row in self.through for v in row))):
            raise InputError("", _("a segment holds finite numbers only"), _("correct them"))
        if self.time <= 0:
            raise InputError("", _("the time of a segment must be positive"), _("correct it"))
        if self.curve not in LIFT_CURVES or (self.to is None) != (self.curve == DWELL):
            raise InputError("", _("a segment has a known curve, and a value at its end unless it dwells"))
        times = (0.0, *(time for time, _value in self.through), self.time)
        if not all(before < after for before, after in pairwise(times)):
            what = _(
                "the times of `through` must increase and lie inside the segment, counted from its start"
            )
            raise InputError("", what, _("correct them, or the segment's time"))
        if not 1 <= self.degree <= MOST_DEGREE:
            what = _("the degree of a B-spline must lie between 1 and {most}").format(most=MOST_DEGREE)
            raise InputError("", what)
        rates = max(len(self.at_start), len(self.at_end))
        if self.curve == B_SPLINE and rates >= self.degree:
            what = _(
                "a B-spline of degree {degree} admits fewer derivatives at an end than its degree, got {count}"
            )
            told = what.format(degree=self.degree, count=rates)
            raise InputError("", told, _("raise the degree, or give fewer"))

    @property
    def inner_jump(self) -> int | None:
        """The lowest derivative that jumps inside the segment; None: all are continuous."""
        if self.curve == B_SPLINE:
            count = 2 + len(self.at_start) + len(self.at_end) + len(self.through)
            return self.degree if count > self.degree + 1 else None
        return INNER_JUMPS.get(self.curve)

    def text_piece(self, start: float, before: float) -> TextPiece:
        """The formula of a segment that is written as text, from `start` [s] and the law's value there on."""
        after = before if self.to is None else self.to
        numbers = {"beta": self.time, "h": after - before, "s0": before, "s1": after}
        return TextPiece(start, segment_formula(self.text), self.time, numbers)

    def pieces(self, start: float, before: float) -> list[tuple[float, Piece]]:
        """Formulas of the segment, each with the time [s] of its end; `before` is the law's value at `start` [s].

        Of a segment that is written as text see `text_piece`.
        """
        if self.curve in THROUGH_POINTS:
            asked = self._conditions(before)
            formulas = polynomial(asked) if self.curve == POLYNOMIAL else b_spline(asked, self.degree)
            return [(start + end, replace(piece, origin=start + piece.origin)) for end, piece in formulas]
        after = before if self.to is None else self.to
        curve = CURVES["uniform" if self.curve == DWELL else self.curve]
        ends = [start + end * self.time for end in curve.breaks[1:]]
        placed = [piece.place(start, self.time, before, after) for piece in curve.pieces]
        return list(zip(ends, placed, strict=True))

    def _conditions(self, before: float) -> list[Condition]:
        """Derivatives that are requested of the polynomial or the B-spline, at times from the segment's start."""
        way: list[Condition] = [(time, (value,)) for time, value in self.through]
        return [(0.0, (before, *self.at_start)), *way, (self.time, (self.to or 0.0, *self.at_end))]


@functools.lru_cache(maxsize=256)
def segment_formula(text: str) -> TextFormula:
    """The formula of a segment from its text; raises InputError for any other text, and for a function with kinks."""
    formula = compile_formula(text, VARIABLES, "")
    for name in sorted(FUNCTIONS.difference(SMOOTH)):
        if re.search(rf"\b{name}\b", text):
            what = _("the function {name} is not allowed in the formula of a segment").format(
                name=f'"{name}"'
            )
            repair = _("use {names}, and a segment for each part of the law")
            raise InputError("", what, repair.format(names=" ".join(SMOOTH)))
    return formula


def _placed_pieces(
    segment: LawSegment, start: float, before: float
) -> Sequence[tuple[float, Piece | TextPiece]]:
    """Formulas of a segment behind others, each with its end."""
    if segment.curve == FORMULA:
        return [(start + segment.time, segment.text_piece(start, before))]
    return segment.pieces(start, before)


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

    segments: tuple[LawSegment, ...]
    repeat: bool = False
    whole: Pieces = field(init=False, repr=False, compare=False)
    ends: tuple[float, ...] = field(init=False, repr=False, compare=False)
    gain: float = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        if not self.segments:
            raise InputError("", _("a law of segments needs at least one"), _("add a segment"))
        breaks, value, ends = [0.0], 0.0, list[float]()
        pieces: list[Piece | TextPiece] = []
        for number, segment in enumerate(self.segments, 1):
            for end, piece in _placed_pieces(segment, breaks[-1], value):
                if not end > breaks[-1]:
                    what = _("segment {number} is too short compared with those before it").format(
                        number=number
                    )
                    raise InputError("", what, _("give it more time"))
                breaks.append(end)
                pieces.append(piece)
            value = value if segment.to is None else segment.to
            ends.append(breaks[-1])
        # A turn may lack a rounding error of the period: the formulas at its ends then go on.
        # a law that repeats has its own formulas before 0 and behind the end: a place may lie there by
        # rounding
        before, after = pieces[0], pieces[-1]
        if not self.repeat:
            before, after = Piece(0.0, 0.0), Piece(0.0, value)
        object.__setattr__(self, "whole", Pieces.of(breaks, (before, *pieces, after)))
        object.__setattr__(self, "ends", tuple(ends))
        object.__setattr__(self, "gain", value)

    @property
    def period(self) -> float:
        """Duration of all segments together [s]."""
        return self.whole.breaks[-1]

    @property
    def span(self) -> tuple[float, float] | None:
        """From 0 to the end of the last segment; None if the segments repeat."""
        return None if self.repeat else (0.0, self.period)

    def at_joint(self, number: int, m: Any, t: Number) -> tuple[Number, Number]:
        """Values at t of the formulas before and behind the end of a segment, counted from 0, over the algebra of `m`.

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
        # whole turns are taken off the time and their gains added, so that formulas stay within a period
        turn = whole_turns(plain(t), self.period)
        return self.whole.jet(m, t - turn * self.period) + turn * self.gain
