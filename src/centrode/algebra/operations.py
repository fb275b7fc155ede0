"""The operations an expression may consist of: how many arguments, how they are written."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

VARIABLE, CONSTANT = "variable", "constant"


class Operation(NamedTuple):
    """What is known of an operation.

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
