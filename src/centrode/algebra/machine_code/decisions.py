"""Which operations may be rounded otherwise than on NumPy: those on which no decision depends."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from centrode.algebra.expressions import Node
from centrode.algebra.graphs import Graph

DECISIVE: Mapping[str, Callable[[Node], tuple[Node, ...]]] = {
    "sqrt": lambda node: node.arguments,
    "log": lambda node: node.arguments,
    "power": lambda node: node.arguments,
    "atan2": lambda node: node.arguments,
    "divide": lambda node: node.arguments[1:],
    "minimum": lambda node: node.arguments,
    "maximum": lambda node: node.arguments,
    "less": lambda node: node.arguments,
    "less_equal": lambda node: node.arguments,
    "equal": lambda node: node.arguments,
    "not_equal": lambda node: node.arguments,
}
"""Arguments whose last bit may decide whether something is there, which branch is taken, or which side is chosen."""


def behind_decisions(graph: Graph) -> frozenset[Node]:
    """Nodes that no decision depends on: a last bit of theirs changes values, never statuses."""
    exact: set[Node] = set()
    for node in reversed(graph.order):
        if node in exact:
            exact.update(node.arguments)
        else:
            exact.update(DECISIVE.get(node.operation, lambda _node: ())(node))
    return frozenset(node for node in graph.order if node not in exact)
