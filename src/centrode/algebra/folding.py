"""Operations on constants as the machine does them: quotients by zero and roots below zero are no errors."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

NAN = math.nan


def divided(a: float, b: float) -> float:
    """Quotient by IEEE 754: infinite by zero, NaN for 0/0."""
    if b != 0.0:
        return a / b
    if a == 0.0 or a != a or b != b:
        return NAN
    return math.copysign(math.inf, a) * math.copysign(1.0, b)


def square_root(x: float) -> float:
    """Square root, rounded correctly; NaN below zero."""
    return math.sqrt(x) if x >= 0.0 or x != x else NAN


def minimum(a: float, b: float) -> float:
    """The lesser of two numbers; NaN if one of them is."""
    return a if a < b or a != a else b


def maximum(a: float, b: float) -> float:
    """The greater of two numbers; NaN if one of them is."""
    return a if a > b or a != a else b


def least(a: float, b: float) -> float:
    """The lesser of two numbers; the other one if one is NaN."""
    return a if a < b or b != b else b


def greatest(a: float, b: float) -> float:
    """The greater of two numbers; the other one if one is NaN."""
    return a if a > b or b != b else b


FOLDED: Mapping[str, Callable[..., float]] = {
    "add": lambda a, b: a + b,
    "subtract": lambda a, b: a - b,
    "multiply": lambda a, b: a * b,
    "divide": divided,
    "negate": lambda a: -a,
    "abs": abs,
    "sqrt": square_root,
    "minimum": minimum,
    "maximum": maximum,
    "least": least,
    "greatest": greatest,
}
"""Operations that are rounded correctly everywhere: their value does not depend on who computes it, or when."""


def exact_reciprocal(x: float) -> float | None:
    """1/x if x is a power of two, so that multiplying by it is the same as dividing by x."""
    mantissa, exponent = math.frexp(x)
    # the reciprocals of the outermost powers are subnormal or infinite
    return 1.0 / x if abs(mantissa) == 0.5 and -1020 < exponent < 1020 else None
