"""Jets: truncated Taylor series whose arithmetic gives exact derivatives of any order of any formula.

Rules of the coefficients: Griewank and Walther, Evaluating Derivatives (2nd ed., 2008), chapter 13.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import factorial, frexp
from typing import Any, TypeAlias, Union

Number: TypeAlias = Any
Coefficients: TypeAlias = tuple[Number, ...]
Operand: TypeAlias = Union["Jet", Number]


class Jet:
    """A value with its derivatives along one variable, as Taylor coefficients.

    `coefficients[k]` is the k-th derivative divided by k!, over any algebra with `+ - * /` (arrays, mpmath
    numbers, expression nodes). Two jets that meet have the same order; a plain number is a constant.
    """

    __slots__ = ("coefficients",)
    # arrays leave operators to the jet, else they would make an array of jets
    __array_priority__ = 1000
    __array_ufunc__ = None

    def __init__(self, coefficients: Sequence[Number]) -> None:
        self.coefficients: Coefficients = tuple(coefficients)

    @classmethod
    def variable(cls, value: Number, order: int) -> Jet:
        """The variable itself at `value`: derivative one, higher derivatives zero."""
        return cls((value, 1.0, *([0.0] * (order - 1)))[: order + 1])

    @property
    def order(self) -> int:
        """Highest derivative carried."""
        return len(self.coefficients) - 1

    @property
    def value(self) -> Number:
        """The plain value."""
        return self.coefficients[0]

    def derivative(self, order: int) -> Number:
        """The derivative of the given order; order 0 is the value."""
        # a product with 0! or 1! would be a pass over an array for nothing
        return self.coefficients[order] * factorial(order) if order > 1 else self.coefficients[order]

    def slope(self) -> Jet:
        """The derivative as a jet, one order lower."""
        return Jet([k * c for k, c in enumerate(self.coefficients)][1:])

    def lower_order(self) -> Jet:
        """Jet without its highest coefficient, of the order that `slope` has."""
        return Jet(self.coefficients[:-1])

    def __repr__(self) -> str:
        return f"Jet{self.coefficients!r}"

    def __add__(self, other: Operand) -> Jet:
        if isinstance(other, Jet):
            return Jet([_sum(a, b) for a, b in zip(self.coefficients, other.coefficients, strict=True)])
        return self if _is_zero(other) else Jet((self.coefficients[0] + other, *self.coefficients[1:]))

    __radd__ = __add__

    def __neg__(self) -> Jet:
        return Jet([-a for a in self.coefficients])

    def __pos__(self) -> Jet:
        return self

    def __sub__(self, other: Operand) -> Jet:
        if isinstance(other, Jet):
            return Jet(
                [_difference(a, b) for a, b in zip(self.coefficients, other.coefficients, strict=True)]
            )
        return self if _is_zero(other) else Jet((self.coefficients[0] - other, *self.coefficients[1:]))

    def __rsub__(self, other: Number) -> Jet:
        return Jet((other - self.coefficients[0], *(-a for a in self.coefficients[1:])))

    def __mul__(self, other: Operand) -> Jet:
        if isinstance(other, Jet):
            return Jet(product(self.coefficients, other.coefficients))
        # a literal zero stays one, so that what is computed from it is skipped too
        return Jet([a if _is_zero(a) else a * other for a in self.coefficients])

    __rmul__ = __mul__

    def __truediv__(self, other: Operand) -> Jet:
        if isinstance(other, Jet):
            return Jet(quotient(self.coefficients, other.coefficients))
        return Jet([a / other for a in self.coefficients])

    def __rtruediv__(self, other: Number) -> Jet:
        # a number over a series: the number is a series whose derivatives are literal zeros
        return Jet(quotient((other, *([0.0] * self.order)), self.coefficients))

    def __pow__(self, exponent: float) -> Jet:
        if exponent == int(exponent) and exponent >= 0:
            # products alone, so that a base below zero has a power and any algebra will do; `power` divides
            # by the base
            result: Operand = 1.0
            for _ in range(int(exponent)):
                result = self * result
            # the zeroth power is a constant, but of the same order as what it meets
            return result if isinstance(result, Jet) else self * 0.0 + 1.0
        return Jet(power(self.coefficients, exponent))


def _is_zero(x: Number) -> bool:
    # only the literal zeros that seeds and constants bring along: skipping them saves work on whole arrays
    return type(x) is float and x == 0.0


def _is_power_of_two(x: Number) -> bool:
    return type(x) is float and abs(frexp(x)[0]) == 0.5


def _sum(a: Number, b: Number) -> Number:
    return b if _is_zero(a) else a if _is_zero(b) else a + b


def _difference(a: Number, b: Number) -> Number:
    return -b if _is_zero(a) else a if _is_zero(b) else a - b


def product(a: Coefficients, b: Coefficients) -> list[Number]:
    """Coefficients of the product of two series (Cauchy)."""
    result = []
    for k in range(len(a)):
        total: Number = 0.0
        # The order is a convention: it decides the last bits and nothing else (graphs of motions and of equations of
        # motion have as many operations either way). It is kept, as compiled and plain formulas have the same bits.
        for i in range(k, -1, -1):
            if not (_is_zero(a[i]) or _is_zero(b[k - i])):
                # the new product stays unnamed, so that NumPy adds in its place
                total = a[i] * b[k - i] if _is_zero(total) else total + a[i] * b[k - i]
        result.append(total)
    return result


def quotient(a: Coefficients, b: Coefficients) -> list[Number]:
    """Coefficients of the quotient of two series."""
    if len(a) == 1:
        return [a[0] / b[0]]
    # the value is divided, so that it has the bits of the plain formula; derivatives share one reciprocal, as
    # a division costs several products
    inverse = 1.0 / b[0]
    # by a power of two the product has the quotient's bits
    result: list[Number] = [a[0] * inverse if _is_power_of_two(a[0]) else a[0] / b[0]]
    for k in range(1, len(a)):
        total = a[k]
        for i in range(k):
            if not (_is_zero(result[i]) or _is_zero(b[k - i])):
                total = _difference(total, result[i] * b[k - i])
        result.append(total if _is_zero(total) else total * inverse)
    return result


def square_root(a: Coefficients, root: Number) -> list[Number]:
    """Coefficients of the square root, given that of the value."""
    result: list[Number] = [root]
    # s s = a gives 2 s_0 s_k = a_k - sum of s_i s_(k-i) over 0 < i < k, so one division serves all orders
    half = 0.5 / root
    for k in range(1, len(a)):
        total = a[k]
        for i in range(1, k):
            total = total - result[i] * result[k - i]
        result.append(total * half)
    return result


def power(a: Coefficients, exponent: float) -> list[Number]:
    """Coefficients of a real power."""
    # with p = a^e, from a p' = e a' p, coefficient by coefficient
    result: list[Number] = [a[0] ** exponent]
    for k in range(1, len(a)):
        total: Number = 0.0
        for j in range(1, k + 1):
            total = total + (j * exponent - (k - j)) * a[j] * result[k - j]
        result.append(total / (k * a[0]))
    return result


def exponential(a: Coefficients, value: Number) -> list[Number]:
    """Coefficients of the exponential, given that of the value."""
    result: list[Number] = [value]
    # from p' = a' p
    for k in range(1, len(a)):
        total: Number = 0.0
        for j in range(1, k + 1):
            total = total + j * a[j] * result[k - j]
        result.append(total / k)
    return result


def sine_and_cosine(a: Coefficients, sine: Number, cosine: Number) -> tuple[list[Number], list[Number]]:
    """Coefficients of sine and cosine, given those of the value."""
    sines, cosines = [sine], [cosine]
    # from s' = a' c and c' = -a' s
    for k in range(1, len(a)):
        s: Number = 0.0
        c: Number = 0.0
        # j / k is exact for powers of two; other quotients would cut numbers of many digits to a float's
        exact = k & (k - 1) == 0
        for j in range(1, k + 1):
            if not _is_zero(a[j]):
                part = (j / k if exact else j) * a[j]
                s = s + part * cosines[k - j]
                c = c - part * sines[k - j]
        sines.append(s if exact else s / k)
        cosines.append(c if exact else c / k)
    return sines, cosines


def integral(derivative: Sequence[Number], value: Number) -> Jet:
    """The jet whose derivative has the given coefficients."""
    return Jet((value, *(c / (k + 1) for k, c in enumerate(derivative))))


# The functions formulas need, on jets over any other namespace.

Namespace = Any


class JetFunctions:
    """Namespace `m` for jets: the same formulas give derivatives of any order.

    `abs`, `sign`, `min`, `max` and `where` take the derivatives of the side the value is on. Plain numbers pass
    through to the base namespace, so a formula may mix constants and jets.
    """

    def __init__(self, base: Namespace) -> None:
        self.base = base

    def sqrt(self, x: Number) -> Number:
        if not isinstance(x, Jet):
            return self.base.sqrt(x)
        return Jet(square_root(x.coefficients, self.base.sqrt(x.value)))

    def sin(self, x: Number) -> Number:
        if not isinstance(x, Jet):
            return self.base.sin(x)
        return Jet(sine_and_cosine(x.coefficients, self.base.sin(x.value), self.base.cos(x.value))[0])

    def cos(self, x: Number) -> Number:
        if not isinstance(x, Jet):
            return self.base.cos(x)
        return Jet(sine_and_cosine(x.coefficients, self.base.sin(x.value), self.base.cos(x.value))[1])

    def sine_and_cosine(self, x: Number) -> tuple[Number, Number]:
        """Both at once: each needs the derivatives of the other."""
        if not isinstance(x, Jet):
            return self.base.sin(x), self.base.cos(x)
        sines, cosines = sine_and_cosine(x.coefficients, self.base.sin(x.value), self.base.cos(x.value))
        return Jet(sines), Jet(cosines)

    def tan(self, x: Number) -> Number:
        sine, cosine = self.sine_and_cosine(x)
        return sine / cosine

    def exp(self, x: Number) -> Number:
        if not isinstance(x, Jet):
            return self.base.exp(x)
        return Jet(exponential(x.coefficients, self.base.exp(x.value)))

    def log(self, x: Number) -> Number:
        if not isinstance(x, Jet):
            return self.base.log(x)
        return self._from_derivative(self.base.log(x.value), x, x)

    def atan(self, x: Number) -> Number:
        if not isinstance(x, Jet):
            return self.base.atan(x)
        return self._from_derivative(self.base.atan(x.value), x, 1.0 + x * x)

    def asin(self, x: Number) -> Number:
        if not isinstance(x, Jet):
            return self.base.asin(x)
        return self._from_derivative(self.base.asin(x.value), x, self.sqrt(1.0 - x * x))

    def acos(self, x: Number) -> Number:
        if not isinstance(x, Jet):
            return self.base.acos(x)
        return self._from_derivative(self.base.acos(x.value), x, -self.sqrt(1.0 - x * x))

    def atan2(self, y: Number, x: Number) -> Number:
        if not isinstance(y, Jet) and not isinstance(x, Jet):
            return self.base.atan2(y, x)
        y, x = _as_jets(y, x)
        value = self.base.atan2(y.value, x.value)
        if not x.order:
            return Jet((value,))
        # the angle's derivative is a quotient of series, so no arc tangent of a series is needed; it is
        # integrated term by term
        turning = x.lower_order() * y.slope() - y.lower_order() * x.slope()
        return integral((turning / (x * x + y * y).lower_order()).coefficients, value)

    def abs(self, x: Number) -> Number:
        return x * self.base.sign(x.value) if isinstance(x, Jet) else self.base.abs(x)

    def sign(self, x: Number) -> Number:
        return self.base.sign(x.value if isinstance(x, Jet) else x)

    def min(self, x: Number, y: Number) -> Number:
        # by abs, so that the sides' derivatives follow from the sign; where x = y, with sign 0, it is their
        # mean
        return 0.5 * (x + y - self.abs(x - y))

    def max(self, x: Number, y: Number) -> Number:
        return 0.5 * (x + y + self.abs(x - y))

    def less(self, x: Number, y: Number) -> Number:
        return self.base.less(_value(x), _value(y))

    def less_equal(self, x: Number, y: Number) -> Number:
        return self.base.less_equal(_value(x), _value(y))

    def is_number(self, x: Number) -> Number:
        return self.base.is_number(_value(x))

    def both(self, p: Number, q: Number) -> Number:
        return self.base.both(p, q)

    def either(self, p: Number, q: Number) -> Number:
        return self.base.either(p, q)

    def opposite(self, p: Number) -> Number:
        return self.base.opposite(p)

    def where(self, condition: Number, x: Number, y: Number) -> Number:
        if not isinstance(x, Jet) and not isinstance(y, Jet):
            return self.base.where(condition, x, y)
        x, y = _as_jets(x, y)
        pairs = zip(x.coefficients, y.coefficients, strict=True)
        return Jet([self.base.where(condition, a, b) for a, b in pairs])

    def _from_derivative(self, value: Number, x: Jet, divisor: Jet) -> Jet:
        """The jet with the given value whose derivative is x' / divisor."""
        if not x.order:
            return Jet((value,))
        return integral((x.slope() / divisor.lower_order()).coefficients, value)


def _value(x: Number) -> Number:
    return x.value if isinstance(x, Jet) else x


def _as_jets(y: Number, x: Number) -> tuple[Jet, Jet]:
    order = y.order if isinstance(y, Jet) else x.order
    constant = [0.0] * order
    return (
        y if isinstance(y, Jet) else Jet((y, *constant)),
        x if isinstance(x, Jet) else Jet((x, *constant)),
    )
