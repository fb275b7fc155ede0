"""The functions formulas need, on jets over any other namespace."""

from __future__ import annotations

from typing import Any

from centrode.algebra import jets
from centrode.algebra.jets import Jet, Number

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
        return Jet(jets.square_root(x.coefficients, self.base.sqrt(x.value)))

    def sin(self, x: Number) -> Number:
        if not isinstance(x, Jet):
            return self.base.sin(x)
        return Jet(jets.sine_and_cosine(x.coefficients, self.base.sin(x.value), self.base.cos(x.value))[0])

    def cos(self, x: Number) -> Number:
        if not isinstance(x, Jet):
            return self.base.cos(x)
        return Jet(jets.sine_and_cosine(x.coefficients, self.base.sin(x.value), self.base.cos(x.value))[1])

    def tan(self, x: Number) -> Number:
        return self.sin(x) / self.cos(x)

    def exp(self, x: Number) -> Number:
        if not isinstance(x, Jet):
            return self.base.exp(x)
        return Jet(jets.exponential(x.coefficients, self.base.exp(x.value)))

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
        turning = x.lowered() * y.slope() - y.lowered() * x.slope()
        return jets.integral((turning / (x * x + y * y).lowered()).coefficients, value)

    def abs(self, x: Number) -> Number:
        return x * self.base.sign(x.value) if isinstance(x, Jet) else self.base.abs(x)

    def sign(self, x: Number) -> Number:
        return self.base.sign(x.value if isinstance(x, Jet) else x)

    def min(self, x: Number, y: Number) -> Number:
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
        return jets.integral((x.slope() / divisor.lowered()).coefficients, value)


def _value(x: Number) -> Number:
    return x.value if isinstance(x, Jet) else x


def _as_jets(y: Number, x: Number) -> tuple[Jet, Jet]:
    order = y.order if isinstance(y, Jet) else x.order
    constant = [0.0] * order
    return (
        y if isinstance(y, Jet) else Jet((y, *constant)),
        x if isinstance(x, Jet) else Jet((x, *constant)),
    )
