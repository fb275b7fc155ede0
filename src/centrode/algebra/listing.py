"""Graphs as text that a person reads: one line for every intermediate result that is used more than once."""

from __future__ import annotations

import math
from collections import Counter

from centrode.algebra.expressions import Node
from centrode.algebra.graphs import Graph
from centrode.algebra.operations import CONSTANT, OPERATIONS, VARIABLE

LONGEST = 70
"""Characters above which an expression gets a line of its own even if it is used once."""

Text = tuple[str, int]
"""An expression as text and how strongly its outermost sign binds."""


def listing(graph: Graph) -> str:
    """The graph as lines `name = expression`, in the order in which they are computed.

    What is used once stands where it is used; intermediate results are named t1, t2 ...
    """
    uses = Counter(x for node in graph.order for x in node.arguments)
    outputs = set(graph.outputs.values())
    texts: dict[Node, Text] = {}
    lines: list[str] = []
    for node in graph.order:
        text = _text(node, texts)
        long = len(text[0]) > LONGEST and uses[node]
        if node.arguments and (uses[node] > 1 or long or (node in outputs and uses[node])):
            name = f"t{len(lines) + 1}"
            lines.append(f"{name} = {text[0]}")
            text = name, 9
        texts[node] = text
    lines += [f"{name} = {texts[node][0]}" for name, node in graph.outputs.items()]
    return "\n".join(lines)


def counted(graph: Graph) -> str:
    """How many operations of each kind the graph has, the most frequent first."""
    return ", ".join(f"{number} {operation}" for operation, number in graph.counts.most_common())


def _text(node: Node, texts: dict[Node, Text]) -> Text:
    if node.operation == VARIABLE:
        return str(node.detail), 9
    if node.operation == CONSTANT:
        return _number(float(node.detail))
    operation = OPERATIONS[node.operation]
    inside = [texts[x] for x in node.arguments]
    strength = operation.strength
    if not operation.sign:
        return f"{node.operation}({', '.join(text for text, _strength in inside)})", 9
    if operation.arguments == 1:
        return operation.sign + _in_brackets(inside[0], strength), strength
    # of equal strength only the left argument goes without brackets; + and * too, as they are not reassociated
    left, right = _in_brackets(inside[0], strength), _in_brackets(inside[1], strength + 1)
    return f"{left} {operation.sign} {right}", strength


def _in_brackets(text: Text, strength: int) -> str:
    return text[0] if text[1] >= strength else f"({text[0]})"


def _number(x: float) -> Text:
    text = repr(int(x)) if x.is_integer() and abs(x) < 1e6 and (x or math.copysign(1, x) > 0) else repr(x)
    return text, 9 if text[0].isdigit() else 7
