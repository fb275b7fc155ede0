"""What may be rounded otherwise than on NumPy: operations that no status depends on.

Whether something closes, which branch is taken and which side is chosen hangs on the last bit of radicands,
divisors and compared numbers; all that these are computed from stays as it is. Of the rest, products and the
sums behind them may be rounded once, and quotients by a common divisor become products with its reciprocal
(which is infinite for a subnormal divisor: there, and only there, NaN may come out for a quotient of zeros).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from centrode.algebra.expressions import Node, Operand
from centrode.algebra.graphs import Graph, rebuilt
from centrode.algebra.operations import CONSTANT, VARIABLE
from centrode.algebra.scans import Scan

DECISIVE = {
    "sqrt": slice(None), "log": slice(None), "power": slice(None), "atan2": slice(None),
    "divide": slice(1, None), "less": slice(None), "less_equal": slice(None),
    "equal": slice(None), "not_equal": slice(None),
}  # fmt: skip
"""Arguments whose last bit may decide; minimum, maximum and the like are continuous in theirs."""


def behind_decisions(graph: Graph) -> frozenset[Node]:
    """Nodes that no decision depends on: a last bit of theirs changes values, never statuses."""
    exact: set[Node] = set()
    for node in reversed(graph.order):
        exact.update(node.arguments if node in exact else _decisive(node))
    return frozenset(node for node in graph.order if node not in exact)


def _decisive(node: Node) -> tuple[Node, ...]:
    if node.operation not in DECISIVE or (node.is_condition and node.arguments[0] is node.arguments[1]):
        return ()  # a number compared with itself tells only whether it is one
    return node.arguments[DECISIVE[node.operation]]


def with_reciprocals(scan: Scan, inner: Sequence[str]) -> Scan:
    """The scan with products in the place of quotients, where one reciprocal serves several.

    `inner` are the variables of the inner loop: a reciprocal that does not depend on them serves all its turns.
    """
    free = behind_decisions(scan.graph)
    quotients = [x for x in scan.graph.order if x.operation == "divide" and x in free]
    times = Counter(node.arguments[1] for node in quotients)
    changing = _changing(scan.graph, {*inner, *scan.state})

    def product(node: Node, arguments: tuple[Node, ...]) -> Operand | None:
        if node.operation != "divide" or node not in free:
            return None
        divisor = node.arguments[1]
        alone = times[divisor] == 1 and (divisor in changing or node.arguments[0].operation == CONSTANT)
        return None if alone else arguments[0] * (1.0 / arguments[1])

    return scan.with_graph(Graph(rebuilt(scan.graph.outputs, product)), scan.parameters, scan.inputs)


def _changing(graph: Graph, names: set[str]) -> set[Node]:
    """Nodes that depend on variables of the inner loop."""
    found: set[Node] = set()
    for node in graph.order:
        if (node.operation == VARIABLE and node.detail in names) or any(x in found for x in node.arguments):
            found.add(node)
    return found
