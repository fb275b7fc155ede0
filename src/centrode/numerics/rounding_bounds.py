"""Numbers that carry a bound of their own rounding error: formulas tell how exact their results are.

Running error analysis after Wilkinson; Higham, Accuracy and Stability of Numerical Algorithms (2nd ed.,
2002), section 3.3. First order in the unit roundoff; `SAFETY` covers what that leaves out.

Bounds of coordinates alone forget that the errors of x and y of one point belong together: each step of a long
computation then turns a slanted error into the box around it, and the bound grows exponentially with the number
of steps while the error does not (the wrapping effect: Moore, Interval Analysis, 1966, chapter 10). So a number
may name the sources of its error, with the rate at which it feels each (affine forms: Stolfi and de Figueiredo,
Self-Validated Numerical Methods and Applications, 1997, chapter 3), and after each step the error of a vector is
gathered along directions that turn with it (Lohner, Enclosing the solutions of ordinary initial and boundary
value problems, in: Computer Arithmetic, 1987).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import reduce
from operator import add
from typing import Any, TypeAlias

import numpy as np

from centrode.numerics.arrays import ARRAYS
from centrode.numerics.expressions import EXPRESSIONS, Node

Number: TypeAlias = Any
UNIT_ROUNDOFF = 2.0**-53
SAFETY = 16.0
"""Bounds are compared multiplied by this: second-order terms and libm errors above half an ulp."""


class ErrorSource:
    """An unknown error that several numbers feel, with the bound of its size; `owner` is what it was gathered for."""

    __slots__ = ("owner", "size")

    def __init__(self, size: Number, owner: object = None) -> None:
        self.size = size
        self.owner = owner


NO_SOURCES: Mapping[ErrorSource, Number] = {}


class Rounded:
    """A value with the bound of its absolute rounding error.

    Attributes
    ----------
    box : bound of the whole error, from those of the numbers it comes from one by one
    rates : how the value changes with each source of error that it shares with other numbers
    rest : bound of the error that is in none of the sources
    """

    __slots__ = ("box", "rates", "rest", "value")
    __array_priority__ = 2000
    __array_ufunc__ = None

    def __init__(
        self,
        value: Number,
        box: Number,
        rates: Mapping[ErrorSource, Number] = NO_SOURCES,
        rest: Number = None,
    ) -> None:
        self.value = value
        self.box = box
        self.rates = rates
        self.rest = rest if rates else box

    @staticmethod
    def of(x: Number) -> Rounded:
        """A plain number as data known to half a unit of its last place."""
        return x if isinstance(x, Rounded) else Rounded(x, UNIT_ROUNDOFF * abs(x))

    @property
    def bound(self) -> Number:
        """Bound of the error: the lesser of what both ways of counting give."""
        if not self.rates:
            return self.box
        shared = self.rest
        for source, rate in self.rates.items():
            shared = shared + abs(rate) * source.size
        return lesser(self.box, shared)

    def __repr__(self) -> str:
        return f"Rounded({self.value!r}, {self.bound!r})"

    def __add__(self, other: Number) -> Rounded:
        b = Rounded.of(other)
        value = self.value + b.value
        # what both carry along, and the rounding of this sum: at most half a unit of the last place of its
        # value
        last = UNIT_ROUNDOFF * abs(value)
        box = self.box + b.box + last
        if not self.rates and not b.rates:
            return Rounded(value, box)
        return Rounded(value, box, _sum_rates(self.rates, b.rates), self.rest + b.rest + last)

    __radd__ = __add__

    def __neg__(self) -> Rounded:
        if not self.rates:
            return Rounded(-self.value, self.box)
        return Rounded(-self.value, self.box, {s: -rate for s, rate in self.rates.items()}, self.rest)

    def __sub__(self, other: Number) -> Rounded:
        return self + (-Rounded.of(other))

    def __rsub__(self, other: Number) -> Rounded:
        return Rounded.of(other) + (-self)

    def __mul__(self, other: Number) -> Rounded:
        b = Rounded.of(other)
        value = self.value * b.value
        last, of_self, of_other = UNIT_ROUNDOFF * abs(value), abs(b.value), abs(self.value)
        # the product of both bounds is of second order and left to `SAFETY`
        box = of_other * b.box + of_self * self.box + last
        if not self.rates and not b.rates:
            return Rounded(value, box)
        rates = _sum_rates(_scale_rates(self.rates, b.value), _scale_rates(b.rates, self.value))
        return Rounded(value, box, rates, of_other * b.rest + of_self * self.rest + last)

    __rmul__ = __mul__

    def __truediv__(self, other: Number) -> Rounded:
        b = Rounded.of(other)
        value = self.value / b.value
        last, size, divisor = UNIT_ROUNDOFF * abs(value), abs(value), abs(b.value)
        box = (self.box + size * b.box) / divisor + last
        if not self.rates and not b.rates:
            return Rounded(value, box)
        inverse = 1.0 / b.value
        rates = _sum_rates(_scale_rates(self.rates, inverse), _scale_rates(b.rates, -(value * inverse)))
        return Rounded(value, box, rates, (self.rest + size * b.rest) / divisor + last)

    def __rtruediv__(self, other: Number) -> Rounded:
        return Rounded.of(other) / self


def lesser(a: Number, b: Number) -> Number:
    """The lesser of two bounds; the other one if one is NaN."""
    return EXPRESSIONS.least(a, b) if isinstance(a, Node) or isinstance(b, Node) else np.fmin(a, b)


def _scale_rates(rates: Mapping[ErrorSource, Number], factor: Number) -> Mapping[ErrorSource, Number]:
    return {source: rate * factor for source, rate in rates.items()} if rates else rates


def _sum_rates(
    one: Mapping[ErrorSource, Number], other: Mapping[ErrorSource, Number]
) -> Mapping[ErrorSource, Number]:
    if not one or not other:
        return one or other
    rates = dict(one)
    for source, rate in other.items():
        rates[source] = rates[source] + rate if source in rates else rate
    return rates


class RoundedFunctions:
    """Namespace `m` for bounded numbers over the numbers of another namespace: arrays, or expressions.

    With `gathers` the errors of each group of a linkage are gathered along directions; without, they stay boxes, which
    takes fewer operations and does as well where few groups follow each other.
    """

    def __init__(self, base: Number = ARRAYS, gathers: bool = True) -> None:
        self.base = base
        self.gathers = gathers

    def sin(self, x: Number) -> Rounded:
        x, base = Rounded.of(x), self.base
        # a root, a sine or a cosine is known to half a unit of the last place of 1 at the worst
        return _follow_slope(x, base.sin(x.value), base.cos(x.value), UNIT_ROUNDOFF)

    def cos(self, x: Number) -> Rounded:
        x, base = Rounded.of(x), self.base
        return _follow_slope(x, base.cos(x.value), -base.sin(x.value), UNIT_ROUNDOFF)

    def sign(self, x: Number) -> Number:
        """Sign of the value, a plain number."""
        return self.base.sign(Rounded.of(x).value)

    def abs(self, x: Number) -> Rounded:
        x = Rounded.of(x)
        return Rounded(abs(x.value), x.bound)

    def min(self, x: Number, y: Number) -> Rounded:
        x, y = Rounded.of(x), Rounded.of(y)
        # the lesser of two numbers moves no further than the one that moves more
        return Rounded(self.base.min(x.value, y.value), self.base.max(x.bound, y.bound))

    def max(self, x: Number, y: Number) -> Rounded:
        x, y = Rounded.of(x), Rounded.of(y)
        return Rounded(self.base.max(x.value, y.value), self.base.max(x.bound, y.bound))

    def exp(self, x: Number) -> Rounded:
        x = Rounded.of(x)
        value = self.base.exp(x.value)
        return _follow_slope(x, value, value, UNIT_ROUNDOFF * value)

    def log(self, x: Number) -> Rounded:
        x = Rounded.of(x)
        value = self.base.log(x.value)
        return Rounded(value, x.bound / abs(x.value) + UNIT_ROUNDOFF * abs(value))

    def sqrt(self, x: Number) -> Rounded:
        x, base = Rounded.of(x), self.base
        value = base.sqrt(x.value)
        with np.errstate(divide="ignore", invalid="ignore"):
            whole, last = x.bound, UNIT_ROUNDOFF * value
            # near zero the slope says nothing: there the root of the bound itself bounds the error
            near = base.sqrt(abs(x.value) + 2.0 * whole)
            # from four bounds on, the slope is right within the same share anywhere between value and truth
            sloped = base.less(4.0 * whole, x.value)
            box = base.where(sloped, whole / (2.0 * value), near) + last
            if not x.rates:
                return Rounded(value, box)
            slope = base.where(sloped, 0.5 / value, 0.0)
            rates = dict(_scale_rates(x.rates, slope))
            # what is behind moves by this error in one direction: a source of its own keeps it
            rates[ErrorSource(near)] = base.where(sloped, 0.0, 1.0)
            return Rounded(value, box, rates, slope * x.rest + last)

    def atan2(self, y: Number, x: Number) -> Rounded:
        y, x = Rounded.of(y), Rounded.of(x)
        value = self.base.atan2(y.value, x.value)
        squared, last = x.value * x.value + y.value * y.value, UNIT_ROUNDOFF * abs(value)
        # the differential (x dy - y dx) / (x^2 + y^2), of sizes
        box = (abs(x.value) * y.box + abs(y.value) * x.box) / squared + last
        if not x.rates and not y.rates:
            return Rounded(value, box)
        inverse = 1.0 / squared
        rates = _sum_rates(
            _scale_rates(y.rates, x.value * inverse), _scale_rates(x.rates, -(y.value * inverse))
        )
        rest = (abs(x.value) * y.rest + abs(y.value) * x.rest) / squared + last
        return Rounded(value, box, rates, rest)

    def without_bounds(self, part: Any) -> Any:
        """The value of a number, or of each number of a vector or a curve, as tuples."""
        if isinstance(part, tuple):
            return tuple(map(self.without_bounds, part))
        return part.value if isinstance(part, Rounded) else part

    def sources_of(self, part: Any) -> set[ErrorSource]:
        """The sources of error that a number, or the numbers of a vector or a curve, share with others."""
        if isinstance(part, tuple):
            return set().union(*map(self.sources_of, part))
        return set(part.rates) if isinstance(part, Rounded) else set()

    def gather_errors(
        self, vector: Sequence[Number], directions: Sequence[Sequence[Number]], owner: object
    ) -> tuple[Rounded, ...]:
        """A vector whose errors are those along orthonormal directions, each a source of its own.

        The directions are plain numbers; `owner` is noted with the sources.
        """
        numbers = [Rounded.of(x) for x in vector]
        shared = list(dict.fromkeys(source for x in numbers for source in x.rates))
        sources = []
        for direction in directions:
            size = _total(abs(axis) * x.rest for x, axis in zip(numbers, direction, strict=True))
            for source in shared:
                felt = _total(
                    axis * x.rates[source]
                    for x, axis in zip(numbers, direction, strict=True)
                    if source in x.rates
                )
                size = size + abs(felt) * source.size
            sources.append(ErrorSource(size, owner))
        gathered = []
        for k, x in enumerate(numbers):
            along = Rounded(x.value, x.box, {s: d[k] for s, d in zip(sources, directions, strict=True)}, 0.0)
            # from here on a box is no greater than what the directions leave
            gathered.append(Rounded(x.value, along.bound, along.rates, 0.0))
        return tuple(gathered)


def _follow_slope(x: Rounded, value: Number, slope: Number, last: Number) -> Rounded:
    """A function's value whose slope is given, `last` being what its own rounding adds."""
    box = abs(slope) * x.box + last
    if not x.rates:
        return Rounded(value, box)
    return Rounded(value, box, _scale_rates(x.rates, slope), abs(slope) * x.rest + last)


def _total(terms: Iterable[Number]) -> Number:
    return reduce(add, terms)


ROUNDED = RoundedFunctions()
