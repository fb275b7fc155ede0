"""Numbers that carry a bound of their own rounding error: formulas tell how exact their results are.

Running error analysis after Wilkinson; Higham, Accuracy and Stability of Numerical Algorithms (2nd ed.,
2002), section 3.3. First order in the unit roundoff; `SAFETY` covers what that leaves out.
"""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np

from centrode.numerics.arrays import ARRAYS

Number: TypeAlias = Any
UNIT_ROUNDOFF = 2.0**-53
SAFETY = 16.0
"""Bounds are compared multiplied by this: second-order terms and libm errors above half an ulp."""


class Rounded:
    """A value with the bound of its absolute rounding error."""

    __slots__ = ("bound", "value")
    __array_priority__ = 2000
    __array_ufunc__ = None

    def __init__(self, value: Number, bound: Number) -> None:
        self.value = value
        self.bound = bound

    @staticmethod
    def of(x: Number) -> Rounded:
        """A plain number as data known to half a unit of its last place."""
        return x if isinstance(x, Rounded) else Rounded(x, UNIT_ROUNDOFF * abs(x))

    def __repr__(self) -> str:
        return f"Rounded({self.value!r}, {self.bound!r})"

    def __add__(self, other: Number) -> Rounded:
        b = Rounded.of(other)
        value = self.value + b.value
        # what both carry along, and the rounding of this sum: at most half a unit of the last place of its
        # value
        return Rounded(value, self.bound + b.bound + UNIT_ROUNDOFF * abs(value))

    __radd__ = __add__

    def __neg__(self) -> Rounded:
        return Rounded(-self.value, self.bound)

    def __sub__(self, other: Number) -> Rounded:
        return self + (-Rounded.of(other))

    def __rsub__(self, other: Number) -> Rounded:
        return Rounded.of(other) + (-self)

    def __mul__(self, other: Number) -> Rounded:
        b = Rounded.of(other)
        value = self.value * b.value
        # the product of both bounds is of second order and left to `SAFETY`
        carried = abs(self.value) * b.bound + abs(b.value) * self.bound
        return Rounded(value, carried + UNIT_ROUNDOFF * abs(value))

    __rmul__ = __mul__

    def __truediv__(self, other: Number) -> Rounded:
        b = Rounded.of(other)
        value = self.value / b.value
        carried = (self.bound + abs(value) * b.bound) / abs(b.value)
        return Rounded(value, carried + UNIT_ROUNDOFF * abs(value))

    def __rtruediv__(self, other: Number) -> Rounded:
        return Rounded.of(other) / self


class RoundedFunctions:
    """Namespace `m` for bounded numbers over the numbers of another namespace: arrays, or expressions."""

    def __init__(self, base: Number = ARRAYS) -> None:
        self.base = base

    def sin(self, x: Number) -> Rounded:
        x, base = Rounded.of(x), self.base
        # a root, a sine or a cosine is known to half a unit of the last place of 1 at the worst
        return Rounded(base.sin(x.value), abs(base.cos(x.value)) * x.bound + UNIT_ROUNDOFF)

    def cos(self, x: Number) -> Rounded:
        x, base = Rounded.of(x), self.base
        return Rounded(base.cos(x.value), abs(base.sin(x.value)) * x.bound + UNIT_ROUNDOFF)

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
        return Rounded(value, value * x.bound + UNIT_ROUNDOFF * value)

    def log(self, x: Number) -> Rounded:
        x = Rounded.of(x)
        value = self.base.log(x.value)
        return Rounded(value, x.bound / abs(x.value) + UNIT_ROUNDOFF * abs(value))

    def sqrt(self, x: Number) -> Rounded:
        x, base = Rounded.of(x), self.base
        value = base.sqrt(x.value)
        # near zero the slope says nothing: there the root of the bound itself bounds the error
        near = base.sqrt(abs(x.value) + 2.0 * x.bound)
        with np.errstate(divide="ignore", invalid="ignore"):
            # from four bounds on, the slope is right within the same share anywhere between value and truth
            bound = base.where(base.less(4.0 * x.bound, x.value), x.bound / (2.0 * value), near)
        return Rounded(value, bound + UNIT_ROUNDOFF * value)

    def atan2(self, y: Number, x: Number) -> Rounded:
        y, x = Rounded.of(y), Rounded.of(x)
        value = self.base.atan2(y.value, x.value)
        # the differential (x dy - y dx) / (x^2 + y^2), of sizes
        carried = (abs(x.value) * y.bound + abs(y.value) * x.bound) / (x.value * x.value + y.value * y.value)
        return Rounded(value, carried + UNIT_ROUNDOFF * abs(value))


ROUNDED = RoundedFunctions()
