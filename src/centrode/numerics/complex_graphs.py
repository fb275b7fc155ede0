"""Graphs over complex numbers as graphs over real ones: every variable becomes a real and an imaginary part.

Functions are continued analytically from the real axis; where a formula decides, the real part does.
"""

from __future__ import annotations

from collections.abc import Collection
from typing import NamedTuple

from centrode.numerics.expressions import EXPRESSIONS, Node, Operand, as_node, variable
from centrode.numerics.graphs import Graph
from centrode.numerics.operations import CONSTANT, OPERATIONS, VARIABLE

m = EXPRESSIONS
IMAGINARY = "imaginary "
"""Before the name of a variable, or of an output, its imaginary part."""


class Parts(NamedTuple):
    """Real and imaginary part; the latter a plain zero of what is real."""

    real: Operand
    imaginary: Operand = 0.0

    @property
    def is_real(self) -> bool:
        """Whether there is no imaginary part."""
        return isinstance(self.imaginary, float) and self.imaginary == 0.0


def product(a: Parts, b: Parts) -> Parts:
    """Product of two numbers."""
    if b.is_real:
        a, b = b, a
    if a.is_real:
        return Parts(a.real * b.real, 0.0 if b.is_real else a.real * b.imaginary)
    return Parts(a.real * b.real - a.imaginary * b.imaginary, a.real * b.imaginary + a.imaginary * b.real)


def _sum(a: Parts, b: Parts) -> Parts:
    imaginary = b.imaginary if a.is_real else a.imaginary if b.is_real else a.imaginary + b.imaginary
    return Parts(a.real + b.real, imaginary)


def _opposite(a: Parts) -> Parts:
    return Parts(-a.real, 0.0 if a.is_real else -a.imaginary)


def _quotient(a: Parts, b: Parts) -> Parts:
    if b.is_real:
        return Parts(a.real / b.real, 0.0 if a.is_real else a.imaginary / b.real)
    inverse = 1.0 / (b.real * b.real + b.imaginary * b.imaginary)
    return product(a, Parts(b.real * inverse, -b.imaginary * inverse))


def _square_root(a: Parts) -> Parts:
    if a.is_real:
        return Parts(m.sqrt(a.real))
    size = m.sqrt(a.real * a.real + a.imaginary * a.imaginary)
    # of the half plane in which the radicand of a real root lies
    real = m.sqrt(0.5 * (size + a.real))
    return Parts(real, 0.5 * a.imaginary / real)


def _sinh_and_cosh(x: Operand) -> tuple[Operand, Operand]:
    grown = m.exp(x)
    shrunk = 1.0 / grown
    # near zero the difference of the two loses digits that its series has
    square = x * x
    series = x * (
        1.0 + square * (1.0 / 6.0 + square * (1.0 / 120.0 + square * (1.0 / 5040.0 + square / 362880.0)))
    )
    return m.where(m.less(m.abs(x), 0.2), series, 0.5 * (grown - shrunk)), 0.5 * (grown + shrunk)


def _sine(a: Parts) -> Parts:
    if a.is_real:
        return Parts(m.sin(a.real))
    sinh, cosh = _sinh_and_cosh(a.imaginary)
    return Parts(m.sin(a.real) * cosh, m.cos(a.real) * sinh)


def _cosine(a: Parts) -> Parts:
    if a.is_real:
        return Parts(m.cos(a.real))
    sinh, cosh = _sinh_and_cosh(a.imaginary)
    return Parts(m.cos(a.real) * cosh, -(m.sin(a.real) * sinh))


def _exponential(a: Parts) -> Parts:
    grown = m.exp(a.real)
    if a.is_real:
        return Parts(grown)
    return Parts(grown * m.cos(a.imaginary), grown * m.sin(a.imaginary))


def _logarithm(a: Parts) -> Parts:
    if a.is_real:
        return Parts(m.log(a.real))
    return Parts(0.5 * m.log(a.real * a.real + a.imaginary * a.imaginary), m.atan2(a.imaginary, a.real))


def _angle(y: Parts, x: Parts) -> Parts:
    """The angle of a vector: minus i times the logarithm of (x + i y) over its root length."""
    if y.is_real and x.is_real:
        return Parts(m.atan2(y.real, x.real))
    turned = Parts(x.real - y.imaginary, x.imaginary + y.real)
    back = Parts(x.real + y.imaginary, x.imaginary - y.real)
    # half the difference of the logarithms of x + i y and x - i y, over i
    one, other = _logarithm(turned), _logarithm(back)
    return Parts(0.5 * (one.imaginary - other.imaginary), -0.5 * (one.real - other.real))


def _chosen(condition: Node, a: Parts, b: Parts) -> Parts:
    real = m.where(condition, a.real, b.real)
    if a.is_real and b.is_real:
        return Parts(real)
    return Parts(real, m.where(condition, a.imaginary, b.imaginary))


def _power(a: Parts, exponent: Parts) -> Parts:
    if a.is_real and exponent.is_real:
        return Parts(as_node(a.real) ** exponent.real)
    return _exponential(product(exponent, _logarithm(a)))


def _computed_parts(node: Node, inside: list[Parts], conditions: list[Node | None]) -> Parts:
    operation = node.operation
    one = inside[0]
    match operation:
        case "add":
            return _sum(one, inside[1])
        case "subtract":
            return _sum(one, _opposite(inside[1]))
        case "multiply":
            return product(one, inside[1])
        case "divide":
            return _quotient(one, inside[1])
        case "negate":
            return _opposite(one)
        case "sqrt":
            return _square_root(one)
        case "sin":
            return _sine(one)
        case "cos":
            return _cosine(one)
        case "exp":
            return _exponential(one)
        case "log":
            return _logarithm(one)
        case "atan2":
            return _angle(one, inside[1])
        case "power":
            return _power(one, inside[1])
        case "abs":
            return _chosen(m.less(one.real, 0.0), _opposite(one), one)
        case "minimum" | "least":
            return _chosen(m.less(one.real, inside[1].real), one, inside[1])
        case "maximum" | "greatest":
            return _chosen(m.less(inside[1].real, one.real), one, inside[1])
        case "where":
            condition = conditions[0]
            assert condition is not None
            return _chosen(condition, inside[1], inside[2])
        case _:
            raise ValueError(f"{operation} has no complex form")


def complex_parts(graph: Graph, real: Collection[str]) -> dict[str, Parts]:
    """Outputs of a graph over complex variables, as parts; the variables named in `real` have no imaginary part."""
    parts: dict[Node, Parts] = {}
    conditions: dict[Node, Node] = {}
    for node in graph.order:
        if node.operation == CONSTANT:
            parts[node] = Parts(float(node.detail))
        elif node.operation == VARIABLE:
            name = str(node.detail)
            parts[node] = Parts(node) if name in real else Parts(node, variable(IMAGINARY + name))
        elif OPERATIONS[node.operation].of_conditions:
            conditions[node] = getattr(m, node.operation)(*(conditions[x] for x in node.arguments))
        elif node.is_condition:
            conditions[node] = getattr(m, node.operation)(*(parts[x].real for x in node.arguments))
        else:
            inside = [parts.get(x, Parts(0.0)) for x in node.arguments]
            parts[node] = _computed_parts(node, inside, [conditions.get(x) for x in node.arguments])
    return {name: parts[node] for name, node in graph.outputs.items()}
