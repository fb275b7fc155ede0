"""The functions formulas need, on expression nodes: the namespace that traces."""

from __future__ import annotations

import math
from typing import Any, TypeAlias

from centrode.algebra.expressions import Node, Operand, operated
from centrode.algebra.folding import square_root
from centrode.algebra.vocabulary import DERIVED

Number: TypeAlias = Any


class Expressions:
    """Namespace `m` of nodes. Plain numbers pass through to plain numbers, so jets keep their literal zeros."""

    def sqrt(self, x: Operand) -> Operand:
        return operated("sqrt", x) if isinstance(x, Node) else square_root(x)

    def sin(self, x: Operand) -> Operand:
        return operated("sin", x) if isinstance(x, Node) else math.sin(x)

    def cos(self, x: Operand) -> Operand:
        return operated("cos", x) if isinstance(x, Node) else math.cos(x)

    def atan2(self, y: Operand, x: Operand) -> Operand:
        return operated("atan2", y, x) if _any_node(y, x) else math.atan2(_plain(y), _plain(x))

    def exp(self, x: Operand) -> Operand:
        return operated("exp", x) if isinstance(x, Node) else math.exp(x)

    def log(self, x: Operand) -> Operand:
        return operated("log", x) if isinstance(x, Node) else math.log(x)

    def tan(self, x: Operand) -> Number:
        return DERIVED["tan"](self, x)

    def asin(self, x: Operand) -> Number:
        return DERIVED["asin"](self, x)

    def acos(self, x: Operand) -> Number:
        return DERIVED["acos"](self, x)

    def atan(self, x: Operand) -> Number:
        return DERIVED["atan"](self, x)

    def abs(self, x: Operand) -> Operand:
        return operated("abs", x) if isinstance(x, Node) else math.fabs(x)

    def sign(self, x: Operand) -> Number:
        # zeros and NaN stay what they are
        return self.where(self.less(0.0, x), 1.0, self.where(self.less(x, 0.0), -1.0, x))

    def min(self, x: Operand, y: Operand) -> Operand:
        return operated("minimum", x, y)

    def max(self, x: Operand, y: Operand) -> Operand:
        return operated("maximum", x, y)

    def least(self, x: Operand, y: Operand) -> Operand:
        return operated("least", x, y)

    def greatest(self, x: Operand, y: Operand) -> Operand:
        return operated("greatest", x, y)

    def is_number(self, x: Operand) -> Node:
        return operated("equal", x, x)

    def less(self, x: Operand, y: Operand) -> Node:
        return operated("less", x, y)

    def less_equal(self, x: Operand, y: Operand) -> Node:
        return operated("less_equal", x, y)

    def equal(self, x: Operand, y: Operand) -> Node:
        return operated("equal", x, y)

    def not_equal(self, x: Operand, y: Operand) -> Node:
        return operated("not_equal", x, y)

    def both(self, p: Node, q: Node) -> Node:
        return operated("both", p, q)

    def either(self, p: Node, q: Node) -> Node:
        return operated("either", p, q)

    def opposite(self, p: Node) -> Node:
        return operated("opposite", p)

    def where(self, condition: Node, x: Operand, y: Operand) -> Node:
        return operated("where", condition, x, y)


def _any_node(*operands: Operand) -> bool:
    return any(isinstance(x, Node) for x in operands)


def _plain(x: Operand) -> float:
    assert not isinstance(x, Node)
    return x


EXPRESSIONS = Expressions()
