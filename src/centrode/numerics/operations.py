"""The operations an expression may consist of: how many arguments, how they are written."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from types import SimpleNamespace
from typing import Any, NamedTuple

VARIABLE, CONSTANT = "variable", "constant"


class Operation(NamedTuple):
    """Properties of an operation.

    Attributes
    ----------
    arguments : int
    sign : how it is written between (or, if it is unary, before) its arguments; empty for a function
    strength : how strongly the sign binds
    condition : whether it gives a truth value
    of_conditions : whether its arguments are truth values (of `where`, the first one is)
    commutes : whether its two arguments may change places
    """

    arguments: int
    sign: str = ""
    strength: int = 9
    condition: bool = False
    of_conditions: bool = False
    commutes: bool = False


OPERATIONS: Mapping[str, Operation] = {
    "add": Operation(2, "+", 5, commutes=True),
    "subtract": Operation(2, "-", 5),
    "multiply": Operation(2, "*", 6, commutes=True),
    "divide": Operation(2, "/", 6),
    "negate": Operation(1, "-", 7),
    "sqrt": Operation(1),
    "abs": Operation(1),
    "sin": Operation(1),
    "cos": Operation(1),
    "atan2": Operation(2),
    "exp": Operation(1),
    "log": Operation(1),
    "power": Operation(2, "**", 8),
    "minimum": Operation(2),
    "maximum": Operation(2),
    "least": Operation(2),
    "greatest": Operation(2),
    "less": Operation(2, "<", 4, condition=True),
    "less_equal": Operation(2, "<=", 4, condition=True),
    "equal": Operation(2, "==", 4, condition=True, commutes=True),
    "not_equal": Operation(2, "!=", 4, condition=True, commutes=True),
    "both": Operation(2, "and", 2, condition=True, of_conditions=True, commutes=True),
    "either": Operation(2, "or", 1, condition=True, of_conditions=True, commutes=True),
    "opposite": Operation(1, "not ", 3, condition=True, of_conditions=True),
    "where": Operation(3),
}
"""Names are those of the operations in the listing, in counts, and of the functions that carry them out.

Of two numbers one of which is NaN, `minimum` and `maximum` are NaN, `least` and `greatest` the other one.
"""


# Constants and functions that formulas written as text may use.

Number = Any

CONSTANTS = {"pi": math.pi, "π": math.pi, "e": math.e}
ONE_ARGUMENT = frozenset({"sin", "cos", "tan", "sqrt", "exp", "log", "abs", "sign", "asin", "acos", "atan"})
TWO_ARGUMENTS = frozenset({"atan2", "min", "max"})
FUNCTIONS = ONE_ARGUMENT | TWO_ARGUMENTS

# What follows from sin, cos, sqrt and atan2 where an algebra has no function of its own.
DERIVED: dict[str, Callable[[Any, Number], Number]] = {
    "tan": lambda m, x: m.sin(x) / m.cos(x),
    # both factors near 1 are exact to rounding where 1 - x * x would have lost half of the digits
    "asin": lambda m, x: m.atan2(x, m.sqrt((1.0 - x) * (1.0 + x))),
    "acos": lambda m, x: m.atan2(m.sqrt((1.0 - x) * (1.0 + x)), x),
    "atan": lambda m, x: m.atan2(x, 1.0),
}


def _sign(x: float) -> float:
    # floats: NumPy's numbers compare to truth values that cannot be subtracted
    return x if math.isnan(x) else float(x > 0.0) - float(x < 0.0)


def _least(x: float, y: float) -> float:
    return math.nan if math.isnan(x) or math.isnan(y) else min(x, y)


def _greatest(x: float, y: float) -> float:
    return math.nan if math.isnan(x) or math.isnan(y) else max(x, y)


SCALARS = SimpleNamespace(
    **{name: getattr(math, name) for name in FUNCTIONS if hasattr(math, name)},
    abs=abs,
    min=_least,
    max=_greatest,
    sign=_sign,
)
"""The functions on plain Python numbers."""


# The functions formulas need, on plain floats and on arrays of whatever library these come from.


class Plain:
    """Namespace `m` of plain values for rooms that import no array library: arrays say themselves whose they are."""

    def sin(self, x: Number) -> Number:
        return math.sin(x) if isinstance(x, float | int) else x.__array_namespace__().sin(x)

    def cos(self, x: Number) -> Number:
        return math.cos(x) if isinstance(x, float | int) else x.__array_namespace__().cos(x)

    def sqrt(self, x: Number) -> Number:
        return math.sqrt(x) if isinstance(x, float | int) else x.__array_namespace__().sqrt(x)

    def abs(self, x: Number) -> Number:
        return abs(x)

    def sign(self, x: Number) -> Number:
        if isinstance(x, float | int):
            return math.copysign(1.0, x) if x else 0.0
        return x.__array_namespace__().sign(x)

    def atan2(self, y: Number, x: Number) -> Number:
        if isinstance(y, float | int) and isinstance(x, float | int):
            return math.atan2(y, x)
        library = (x if isinstance(y, float | int) else y).__array_namespace__()
        return library.atan2(library.asarray(y), library.asarray(x))


PLAIN = Plain()
