"""Expressions that are trigonometric polynomials of one variable, with their extremes over a range in closed form.

A sum of waves a cos f q + b sin f q and a constant is found from an expression of the variable q by running through it
once: coefficients are expressions of all other variables. Of a single wave the extremes are known exactly, over a turn
and over a part of it; of several waves they are bounded wave by wave.

Beside the coefficients stands a bound of the sum of their rounding errors, in units of the unit roundoff: running error
analysis of first order, as in `rounding` (Wilkinson; Higham, Accuracy and Stability of Numerical Algorithms, 2nd ed.,
2002, section 3.3). What the arrays make of the same expression at any place lies within the bound as well.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TypeAlias

from centrode.numerics.expressions import EXPRESSIONS, Node, Operand, apply_operation, as_node
from centrode.numerics.graphs import topological_order
from centrode.numerics.operations import CONSTANT, VARIABLE
from centrode.numerics.rounding_bounds import SAFETY, UNIT_ROUNDOFF

m = EXPRESSIONS

TURN = 2.0 * math.pi
FUNCTION = 4.0
"""Roundings that a sine or cosine counts for: libraries are right to two units of the last place."""
BOUNDING = 12.0
"""Roundings of a wave's extremes, from its coefficients on."""
STILL = frozenset({"add", "subtract", "negate", "abs", "multiply", "divide", "sqrt", "sin", "cos"})
"""Operations whose errors are bounded where nothing moves."""
Wave: TypeAlias = tuple[Operand, Operand]
"""Factors of cosine and sine."""


@dataclass(frozen=True)
class TrigonometricPolynomial:
    """A constant and waves; without waves, what does not move.

    Attributes
    ----------
    constant : operand
    waves : frequency above zero -> factors of cosine and sine
    error : so many unit roundoffs bound the rounding errors of all coefficients together
    """

    constant: Operand
    waves: Mapping[float, Wave] = field(default_factory=dict)
    error: Operand = 0.0

    @cached_property
    def norm(self) -> Operand:
        """Sum of the sizes of all coefficients, which bounds the polynomial everywhere."""
        total = size(self.constant)
        for a, b in self.waves.values():
            total = plus(total, plus(size(a), size(b)))
        return total

    def __add__(self, other: TrigonometricPolynomial) -> TrigonometricPolynomial:
        waves = dict(self.waves)
        for frequency, (a, b) in other.waves.items():
            cosine, sine = waves.get(frequency, (0.0, 0.0))
            waves[frequency] = plus(cosine, a), plus(sine, b)
        rounded = TrigonometricPolynomial(plus(self.constant, other.constant), _moving(waves))
        return replace(rounded, error=plus(plus(self.error, other.error), rounded.norm))

    def __neg__(self) -> TrigonometricPolynomial:
        waves = {frequency: (negative(a), negative(b)) for frequency, (a, b) in self.waves.items()}
        return replace(self, constant=negative(self.constant), waves=waves)

    def __mul__(self, other: TrigonometricPolynomial) -> TrigonometricPolynomial:
        constant = times(self.constant, other.constant)
        waves: dict[float, Wave] = {}

        def add(frequency: float, a: Operand, b: Operand) -> None:
            cosine, sine = waves.get(frequency, (0.0, 0.0))
            waves[frequency] = plus(cosine, a), plus(sine, b)

        for one, factor in ((self, other.constant), (other, self.constant)):
            for frequency, (a, b) in one.waves.items():
                add(frequency, times(a, factor), times(b, factor))
        for f, (a, b) in self.waves.items():
            for g, (c, d) in other.waves.items():
                # products of cosines and sines are waves of the sum and of the difference of the frequencies
                ac, bd, ad, bc = times(a, c), times(b, d), times(a, d), times(b, c)
                add(f + g, half(minus(ac, bd)), half(plus(ad, bc)))
                even, odd = half(plus(ac, bd)), half(minus(bc, ad))
                if f == g:
                    constant = plus(constant, even)
                else:
                    add(abs(f - g), even, odd if f > g else negative(odd))
        carried = plus(times(self.norm, other.error), times(other.norm, self.error))
        # a product of coefficients is rounded once, and once in each sum that it is part of
        roundings = 3.0 + len(self.waves) * len(other.waves)
        rounded = times(roundings, times(self.norm, other.norm))
        return TrigonometricPolynomial(constant, _moving(waves), plus(carried, rounded))

    def extremes(self, low: float, high: float) -> PolynomialExtremes:
        """Bounds over a range of the variable: exact but for rounding where there is one wave at most."""
        least = greatest = reached = self.constant
        for k, (frequency, (a, b)) in enumerate(sorted(self.waves.items())):
            lowest, highest = _ends_of_wave(frequency * low, frequency * high, a, b)
            least, greatest = plus(least, lowest), plus(greatest, highest)
            # where the longest wave is lowest, the others add no more than their greatest values
            reached = plus(reached, highest if k else lowest)
        error = times(SAFETY * UNIT_ROUNDOFF, plus(self.error, times(BOUNDING, self.norm)))
        return PolynomialExtremes(least, greatest, reached, error)


@dataclass(frozen=True)
class PolynomialExtremes:
    """What a polynomial does not leave over a range, and a value that it falls to or below; each known to `error`."""

    least: Operand
    greatest: Operand
    reached: Operand
    error: Operand


@dataclass(frozen=True)
class _Angle:
    """The variable itself, times a constant and with another angle added."""

    rate: float
    shift: TrigonometricPolynomial


def _ends_of_wave(low: float, high: float, a: Operand, b: Operand) -> tuple[Operand, Operand]:
    """Least and greatest of a cos t + b sin t for t between low and high."""
    amplitude = length(a, b)
    if high - low >= TURN:
        return negative(amplitude), amplitude
    # seen from the middle of the range the wave is p cos t + s sin t
    middle, reach = 0.5 * (low + high), 0.5 * (high - low)
    p = plus(times(a, math.cos(middle)), times(b, math.sin(middle)))
    s = minus(times(b, math.cos(middle)), times(a, math.sin(middle)))
    at_ends, apart = times(p, math.cos(reach)), times(m.abs(s), math.sin(reach))
    # the crest lies where cos t = p / amplitude; on the border both answers are the same
    border = times(amplitude, math.cos(reach))
    least = m.where(m.less_equal(border, negative(p)), negative(amplitude), minus(at_ends, apart))
    greatest = m.where(m.less_equal(border, p), amplitude, plus(at_ends, apart))
    return least, greatest


def polynomials_of(roots: Sequence[Node], name: str) -> dict[Node, TrigonometricPolynomial]:
    """The polynomials in the variable of a name that roots and the expressions below them are; others are missing."""
    known: dict[Node, TrigonometricPolynomial | _Angle] = {}
    for node in topological_order(roots):
        found = _polynomial(node, name, known)
        if found is not None:
            known[node] = found
    return {node: found for node, found in known.items() if isinstance(found, TrigonometricPolynomial)}


def factors_of(node: Node, polynomials: Mapping[Node, TrigonometricPolynomial]) -> list[Node]:
    """The factors of a product, those that are products being taken apart; of a number that does not move, itself."""
    still = node in polynomials and not polynomials[node].waves
    if still or node.operation != "multiply":
        return [node]
    return [factor for x in node.arguments for factor in factors_of(x, polynomials)]


def _polynomial(
    node: Node, name: str, known: Mapping[Node, TrigonometricPolynomial | _Angle]
) -> TrigonometricPolynomial | _Angle | None:
    if node.operation == CONSTANT:
        value = float(node.detail)
        return TrigonometricPolynomial(value)
    if node.operation == VARIABLE:
        if node.detail == name:
            return _Angle(1.0, TrigonometricPolynomial(0.0))
        return TrigonometricPolynomial(node)
    if not all(x in known for x in node.arguments):
        return None
    arguments = [known[x] for x in node.arguments]
    numbers = [x for x in arguments if isinstance(x, TrigonometricPolynomial)]
    if len(numbers) < len(arguments):
        return _of_angle(node.operation, arguments)
    if any(x.waves for x in numbers):
        return _of_polynomials(node.operation, numbers)
    return _still(node, numbers)


def _of_angle(
    operation: str, arguments: Sequence[TrigonometricPolynomial | _Angle]
) -> TrigonometricPolynomial | _Angle | None:
    """An operation of which one argument at least is an angle that runs with the variable."""
    first, *rest = arguments
    if operation in ("cos", "sin") and isinstance(first, _Angle):
        return _wave_of(operation, first)
    if operation == "negate" and isinstance(first, _Angle):
        return _Angle(-first.rate, -first.shift)
    if operation in ("add", "subtract"):
        one, other = (
            x if isinstance(x, _Angle) else _Angle(0.0, x) if not x.waves else None for x in arguments
        )
        if one is None or other is None:
            return None
        sign = 1.0 if operation == "add" else -1.0
        shift = one.shift + (other.shift if sign > 0.0 else -other.shift)
        rate = one.rate + sign * other.rate
        return _Angle(rate, shift) if rate else shift
    if operation == "multiply":
        angle, factor = (rest[0], first) if isinstance(rest[0], _Angle) else (first, rest[0])
        # a ratio that differs from mechanism to mechanism would be a frequency that does
        if isinstance(angle, _Angle) and isinstance(factor, TrigonometricPolynomial) and not factor.waves:
            ratio = factor.constant
            return (
                _Angle(angle.rate * ratio, angle.shift * factor)
                if isinstance(ratio, float) and ratio
                else None
            )
    return None


def _wave_of(operation: str, angle: _Angle) -> TrigonometricPolynomial:
    """Sine or cosine of an angle that runs with the variable."""
    shift, rate = angle.shift, abs(angle.rate)
    cosine, sine = m.cos(shift.constant), m.sin(shift.constant)
    side = 1.0 if angle.rate > 0.0 else -1.0
    # cos(f q + c) = cos c cos fq - sin c sin fq, sin(f q + c) = sin c cos fq + cos c sin fq
    pair = (cosine, times(-side, sine)) if operation == "cos" else (sine, times(side, cosine))
    return TrigonometricPolynomial(0.0, _moving({rate: pair}), plus(times(2.0, shift.error), 2.0 * FUNCTION))


def _of_polynomials(
    operation: str, arguments: Sequence[TrigonometricPolynomial]
) -> TrigonometricPolynomial | None:
    if operation == "add":
        return arguments[0] + arguments[1]
    if operation == "subtract":
        return arguments[0] + -arguments[1]
    if operation == "negate":
        return -arguments[0]
    if operation == "multiply":
        return arguments[0] * arguments[1]
    if operation == "divide" and not arguments[1].waves:
        return arguments[0] * _reciprocal(arguments[1])
    return None


def _reciprocal(x: TrigonometricPolynomial) -> TrigonometricPolynomial:
    quotient = 1.0 / as_node(x.constant)
    return TrigonometricPolynomial(quotient, {}, plus(times(x.error, quotient * quotient), size(quotient)))


def _still(node: Node, arguments: Sequence[TrigonometricPolynomial]) -> TrigonometricPolynomial | None:
    """An operation on what does not move, with the bound of its error."""
    values, errors = [x.constant for x in arguments], [x.error for x in arguments]
    if node.operation not in STILL:
        return None
    # where waves have cancelled, the arguments are other expressions than those that the variable stands in
    result = apply_operation(node.operation, *values)
    if node.operation in ("negate", "abs"):
        return TrigonometricPolynomial(result, {}, errors[0])
    if node.operation in ("add", "subtract"):
        carried = plus(*errors)
    elif node.operation == "multiply":
        carried = plus(times(size(values[0]), errors[1]), times(size(values[1]), errors[0]))
    elif node.operation == "divide":
        carried = times(plus(errors[0], times(size(result), errors[1])), 1.0 / as_node(size(values[1])))
    elif node.operation == "sqrt":
        carried = times(errors[0], 0.5 / result)
    else:
        carried = plus(errors[0], FUNCTION)
    return TrigonometricPolynomial(result, {}, plus(carried, size(result)))


# Arithmetic of coefficients: what is plainly zero costs nothing, and what is taken from itself is nothing.


def plus(a: Operand, b: Operand) -> Operand:
    """Sum."""
    if _is(a, 0.0) or _is(b, 0.0):
        return b if _is(a, 0.0) else a
    if isinstance(a, float) and isinstance(b, float):
        return a + b
    # the squares of a moving point's two coordinates have opposite second waves
    return 0.0 if as_node(a) is as_node(negative(b)) else a + b


def minus(a: Operand, b: Operand) -> Operand:
    """Difference."""
    return plus(a, negative(b))


def negative(a: Operand) -> Operand:
    """Opposite; plainly zero of zero."""
    return 0.0 if _is(a, 0.0) else -a


def times(a: Operand, b: Operand) -> Operand:
    """Product."""
    return 0.0 if _is(a, 0.0) or _is(b, 0.0) else a * b


def size(a: Operand) -> Operand:
    """Magnitude."""
    return m.abs(a)


def half(a: Operand) -> Operand:
    """Half of a number."""
    return times(0.5, a)


def length(a: Operand, b: Operand) -> Operand:
    """Length of a vector."""
    if _is(a, 0.0) or _is(b, 0.0):
        return m.abs(b if _is(a, 0.0) else a)
    return m.sqrt(a * a + b * b)


def _moving(waves: Mapping[float, Wave]) -> dict[float, Wave]:
    return {f: (a, b) for f, (a, b) in waves.items() if not (_is(a, 0.0) and _is(b, 0.0))}


def _is(x: Operand, value: float) -> bool:
    return (x.operation == CONSTANT and x.detail == value) if isinstance(x, Node) else x == value
