"""Gradients, from graph to graph: the derivatives of one output by many variables for a few times its cost.

Reverse mode: Griewank and Walther, Evaluating Derivatives (2nd ed., 2008), section 3.2.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from centrode.algebra.expression_functions import EXPRESSIONS
from centrode.algebra.expressions import Node, Operand, operated
from centrode.algebra.graphs import ordered

m = EXPRESSIONS
Rule = Callable[..., tuple[Operand | None, ...]]


def gradient(output: Node, variables: Sequence[Node]) -> list[Operand]:
    """Partial derivatives of a node by variables, as nodes; plain 0.0 where it does not depend on one.

    At a selection the derivative is that of what is selected; what is not selected may be NaN or infinite
    without harm. `abs`, `minimum` and `maximum` take the derivative of the side the value is on.
    """
    order = ordered([output])
    needed = _depending(order, variables)
    guarded = _selected(order)
    by: dict[Node, Operand] = {output: 1.0}
    for node in reversed(order):
        if node not in by or node not in needed or not node.arguments or node.is_condition:
            continue
        for argument, factor in zip(
            node.arguments, _RULES[node.operation](node, *node.arguments), strict=True
        ):
            if factor is not None and argument in needed:
                _collect(by, argument, _chained(node, by[node], factor, node in guarded))
    return [by.get(x, 0.0) for x in variables]


def _depending(order: Sequence[Node], variables: Sequence[Node]) -> set[Node]:
    """Nodes that depend on one of the variables."""
    needed = set(variables)
    for node in order:
        if any(x in needed for x in node.arguments):
            needed.add(node)
    return needed


def _selected(order: Sequence[Node]) -> set[Node]:
    """Nodes below a selection: their derivative may have to vanish although a factor of it is NaN."""
    found: set[Node] = set()
    for node in reversed(order):
        if node in found or node.operation in _SELECTIONS:
            found.update(node.arguments)
    return found


def _collect(by: dict[Node, Operand], node: Node, part: Operand) -> None:
    by[node] = by[node] + part if node in by else part


def _chained(node: Node, outer: Operand, factor: Operand, guarded: bool) -> Operand:
    """Product by the chain rule; a condition as the factor selects instead."""
    if isinstance(factor, Node) and factor.is_condition:
        return m.where(factor, outer, 0.0)
    if isinstance(outer, float) and outer == 1.0:
        return factor
    product = outer * factor
    if not guarded or not isinstance(factor, Node) or not isinstance(outer, Node):
        return product
    return m.where(m.equal(outer, 0.0), 0.0, product)


def _root(node: Node, x: Node) -> tuple[Operand, ...]:
    return (0.5 / node,)


def _quotient(node: Node, a: Node, b: Node) -> tuple[Operand, ...]:
    reciprocal = 1.0 / b
    return reciprocal, -(node * reciprocal)


def _angle(node: Node, y: Node, x: Node) -> tuple[Operand, ...]:
    squared = x * x + y * y
    return x / squared, -(y / squared)


def _power(node: Node, x: Node, exponent: Node) -> tuple[Operand, ...]:
    return exponent * operated("power", x, exponent - 1.0), node * m.log(x)


def _least(node: Node, a: Node, b: Node) -> tuple[Operand, ...]:
    first = m.either(m.less(a, b), m.not_equal(b, b))
    return first, m.opposite(first)


def _greatest(node: Node, a: Node, b: Node) -> tuple[Operand, ...]:
    first = m.either(m.less(b, a), m.not_equal(b, b))
    return first, m.opposite(first)


def _lesser(node: Node, a: Node, b: Node) -> tuple[Operand, ...]:
    first = m.either(m.less(a, b), m.not_equal(a, a))
    return first, m.opposite(first)


def _greater(node: Node, a: Node, b: Node) -> tuple[Operand, ...]:
    first = m.either(m.less(b, a), m.not_equal(a, a))
    return first, m.opposite(first)


_SELECTIONS = frozenset({"where", "minimum", "maximum", "least", "greatest"})
_RULES: Mapping[str, Rule] = {
    "add": lambda node, a, b: (1.0, 1.0),
    "subtract": lambda node, a, b: (1.0, -1.0),
    "multiply": lambda node, a, b: (b, a),
    "divide": _quotient,
    "negate": lambda node, x: (-1.0,),
    "sqrt": _root,
    "abs": lambda node, x: (m.sign(x),),
    "sin": lambda node, x: (m.cos(x),),
    "cos": lambda node, x: (-m.sin(x),),
    "atan2": _angle,
    "exp": lambda node, x: (node,),
    "log": lambda node, x: (1.0 / x,),
    "power": _power,
    "minimum": _lesser,
    "maximum": _greater,
    "least": _least,
    "greatest": _greatest,
    "where": lambda node, condition, a, b: (None, condition, m.opposite(condition)),
}
"""For each operation its partial derivative by each argument; a condition stands for 1 where it holds, else 0."""
