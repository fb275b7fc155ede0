"""Constants and functions that formulas written as text may use."""

from __future__ import annotations

import math
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

Number = Any

CONSTANTS = {"pi": math.pi, "π": math.pi, "e": math.e}
ONE_ARGUMENT = frozenset({"sin", "cos", "tan", "sqrt", "exp", "log", "abs", "sign", "asin", "acos", "atan"})
TWO_ARGUMENTS = frozenset({"atan2", "min", "max"})
FUNCTIONS = ONE_ARGUMENT | TWO_ARGUMENTS

# What follows from sin, cos, sqrt and atan2 where an algebra has no function of its own.
DERIVED: dict[str, Callable[[Any, Number], Number]] = {
    "tan": lambda m, x: m.sin(x) / m.cos(x),
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
