"""Graphs as functions of Python: for single numbers, real or complex, where no machine code is there or none is wanted.

The text of a function is made from the graph's operations alone: its names are counted here, its constants are written
as floats are, its operations come from a table. Names of variables, which may hold what a user wrote, do not get there.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import Any, TypeAlias

from centrode.numerics.expressions import greatest as greatest_number
from centrode.numerics.expressions import ieee_quotient, maximum, minimum, square_root
from centrode.numerics.expressions import least as least_number
from centrode.numerics.graphs import Graph
from centrode.numerics.operations import CONSTANT, VARIABLE

Number: TypeAlias = Any
Function: TypeAlias = Callable[[Sequence[Number]], tuple[Number, ...]]

SIGNS = {"add": "+", "subtract": "-", "multiply": "*"}
COMPARED = {"less": "<", "less_equal": "<=", "equal": "==", "not_equal": "!="}
LOGIC = {"both": "and", "either": "or"}


def _real(x: Number) -> float:
    return float(x.real)


def _complex_quotient(a: Number, b: Number) -> Number:
    return a / b if b != 0.0 else complex(math.nan, math.nan)


def _power(x: Number, exponent: Number) -> Number:
    try:
        return x**exponent
    except (OverflowError, ZeroDivisionError):
        return math.nan


def _guarded_function(function: Callable[..., Number]) -> Callable[..., Number]:
    """A function that has no value where Python raises an error."""

    def call_guardedly(*arguments: Number) -> Number:
        try:
            return function(*arguments)
        except (OverflowError, ValueError):
            return math.nan

    return call_guardedly


REAL: dict[str, Callable[..., Number]] = {
    "divide": ieee_quotient,
    "sqrt": square_root,
    "abs": abs,
    "sin": _guarded_function(math.sin),
    "cos": _guarded_function(math.cos),
    "atan2": math.atan2,
    "exp": _guarded_function(math.exp),
    "log": _guarded_function(math.log),
    "power": _power,
    "minimum": minimum,
    "maximum": maximum,
    "least": least_number,
    "greatest": greatest_number,
    "key": float,
}


def _angle(y: Number, x: Number) -> Number:
    """The angle of a vector next to a real one, continued from there."""
    angle = math.atan2(_real(y), _real(x))
    cosine, sine = math.cos(angle), math.sin(angle)
    return angle + cmath.atan((y * cosine - x * sine) / (x * cosine + y * sine))


COMPLEX: dict[str, Callable[..., Number]] = {
    "divide": _complex_quotient,
    "sqrt": cmath.sqrt,
    "abs": lambda x: -x if _real(x) < 0.0 else x,
    "sin": _guarded_function(cmath.sin),
    "cos": _guarded_function(cmath.cos),
    "atan2": _angle,
    "exp": _guarded_function(cmath.exp),
    "log": _guarded_function(cmath.log),
    "power": _power,
    "minimum": lambda a, b: a if _real(a) < _real(b) else b,
    "maximum": lambda a, b: a if _real(a) > _real(b) else b,
    "least": lambda a, b: a if _real(a) < _real(b) else b,
    "greatest": lambda a, b: a if _real(a) > _real(b) else b,
    "key": _real,
}
"""Functions continued analytically from the real axis; where a formula decides, the real part does."""


NUMBERS = {"nan": math.nan, "infinity": math.inf}
"""Numbers that have no digits, by the names that they have in the text."""


def function_text(graph: Graph, arguments: Sequence[str], is_complex: bool) -> str:
    """The text of `function(given)`, which returns the graph's outputs in order.

    Raises KeyError for a variable that is no argument, and for an operation that is none.
    """
    places = {name: f"given[{k}]" for k, name in enumerate(arguments)}
    names: dict[Any, str] = {}
    lines = ["def function(given):"]
    for node in graph.order:
        if node.operation == VARIABLE:
            names[node] = f"v{len(names)}"
            lines.append(f" {names[node]} = {places[str(node.detail)]}")
        elif node.operation == CONSTANT:
            names[node] = _constant_text(float(node.detail))
        else:
            names[node] = f"v{len(names)}"
            lines.append(
                f" {names[node]} = {_operation(node.operation, [names[x] for x in node.arguments], is_complex)}"
            )
    lines.append(f" return ({''.join(names[node] + ', ' for node in graph.outputs.values())})")
    return "\n".join(lines)


def _constant_text(value: float) -> str:
    """A number as its shortest digits that give it back; what has no digits by a name of `NUMBERS`."""
    if math.isfinite(value):
        return f"({value!r})"
    return "nan" if math.isnan(value) else f"({'-' if value < 0.0 else ''}infinity)"


def _operation(operation: str, inside: Sequence[str], is_complex: bool) -> str:
    if operation in SIGNS:
        return f"{inside[0]} {SIGNS[operation]} {inside[1]}"
    if operation == "negate":
        return f"-{inside[0]}"
    if operation in COMPARED:
        one, other = (f"key({x})" for x in inside) if is_complex else inside
        return f"{one} {COMPARED[operation]} {other}"
    if operation in LOGIC:
        return f"{inside[0]} {LOGIC[operation]} {inside[1]}"
    if operation == "opposite":
        return f"not {inside[0]}"
    if operation == "where":
        return f"{inside[1]} if {inside[0]} else {inside[2]}"
    if operation not in REAL:
        raise KeyError(operation)
    return f"{operation}({', '.join(inside)})"


@lru_cache(maxsize=128)
def _compiled_function(text: str, is_complex: bool) -> Function:
    names: dict[str, Any] = {**(COMPLEX if is_complex else REAL), **NUMBERS, "__builtins__": {}}
    # Nothing that a user writes is in this text. `function_text` is its only source: variables are v0, v1 ... and
    # given[0], given[1] ... by their order, constants the digits of floats, operations words of a table. So names of
    # links and the text of formulas cannot run anything. Beyond that no built-in function has a name here.
    exec(compile(text, "<graph>", "exec"), names)
    function: Function = names["function"]
    return function


def python_function(graph: Graph, arguments: Sequence[str], is_complex: bool = False) -> Function:
    """A function of the numbers of some variables, in that order, that returns the outputs of a graph in order."""
    return _compiled_function(function_text(graph, arguments, is_complex), is_complex)
