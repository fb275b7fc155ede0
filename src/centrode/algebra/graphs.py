"""Graphs of expressions: named outputs, what they depend on, in which order they are computed."""

from __future__ import annotations

import hashlib
from collections import Counter
from collections.abc import Callable, Container, Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property

from centrode.algebra.expressions import Node, Operand, as_node, operated, variable
from centrode.algebra.operations import CONSTANT, VARIABLE


@dataclass(frozen=True)
class Graph:
    """Named expressions that are computed together.

    Attributes
    ----------
    outputs : name -> node
    """

    outputs: Mapping[str, Node]

    @classmethod
    def of(cls, outputs: Mapping[str, Operand]) -> Graph:
        """The graph of outputs that may be plain numbers."""
        return cls({name: as_node(x) for name, x in outputs.items()})

    @cached_property
    def order(self) -> tuple[Node, ...]:
        """All nodes once, arguments before what is computed from them."""
        return tuple(ordered(self.outputs.values()))

    @cached_property
    def variables(self) -> tuple[str, ...]:
        """Names of the variables, in the order in which they are met."""
        return tuple(str(node.detail) for node in self.order if node.operation == VARIABLE)

    @cached_property
    def counts(self) -> Counter[str]:
        """How often each operation is carried out."""
        return Counter(node.operation for node in self.order if node.arguments)

    @cached_property
    def key(self) -> bytes:
        """Digest of the outputs, names included: the same in every process."""
        parts = [name.encode() + b"\0" + node.key for name, node in self.outputs.items()]
        return hashlib.blake2b(b"".join(parts), digest_size=16).digest()

    def substituted(self, values: Mapping[str, Operand]) -> Graph:
        """The graph with expressions or numbers in the place of some variables."""

        def replaced(node: Node, _arguments: tuple[Node, ...]) -> Operand | None:
            return values.get(str(node.detail)) if node.operation == VARIABLE else None

        return Graph(rebuilt(self.outputs, replaced))


def ordered(roots: Iterable[Node]) -> list[Node]:
    """The nodes that roots consist of, arguments first; without recursion, so that depth does not matter."""
    found: dict[Node, None] = {}
    stack = [(node, False) for node in reversed(list(roots))]
    while stack:
        node, arguments_done = stack.pop()
        if node in found:
            continue
        if arguments_done or not node.arguments:
            found[node] = None
            continue
        stack.append((node, True))
        stack.extend((x, False) for x in reversed(node.arguments))
    return list(found)


def rebuilt(
    outputs: Mapping[str, Node], replaced: Callable[[Node, tuple[Node, ...]], Operand | None]
) -> dict[str, Node]:
    """Outputs with some nodes replaced, and everything above these built anew.

    `replaced(node, arguments)` gives what stands for a node, its arguments being rebuilt already, or None.
    """
    new: dict[Node, Node] = {}
    for node in ordered(outputs.values()):
        arguments = tuple(new[x] for x in node.arguments)
        other = replaced(node, arguments)
        if other is not None:
            new[node] = as_node(other)
        elif arguments != node.arguments:
            new[node] = operated(node.operation, *arguments)
        else:
            new[node] = node
    return {name: new[node] for name, node in outputs.items()}


def split(
    graph: Graph, names: Iterable[str], prefix: str, only: Container[str] | None = None
) -> tuple[Graph, Graph]:
    """What depends on some variables alone, and the rest with that as variables.

    The first graph computes the greatest parts that depend on nothing but `names`; they are variables
    `prefix 0`, `prefix 1` ... of the second. With `only`, parts are results of the operations it names.
    """
    wanted = frozenset(names)
    alone: set[Node] = set()
    for node in graph.order:
        if node.operation == VARIABLE:
            if node.detail in wanted:
                alone.add(node)
        elif node.arguments and all(x in alone or x.operation == CONSTANT for x in node.arguments):
            alone.add(node)
    if only is None:
        tops = {x: None for node in graph.order if node not in alone for x in node.arguments if x in alone}
        tops |= {node: None for node in graph.outputs.values() if node in alone}
    else:
        tops = {node: None for node in graph.order if node in alone and node.operation in only}
    parts = {f"{prefix} {i}": x for i, x in enumerate(x for x in tops if x.arguments and not x.is_condition)}
    places = {node: variable(name) for name, node in parts.items()}
    rest = Graph(rebuilt(graph.outputs, lambda node, _arguments: places.get(node)))
    return Graph({name: node for name, node in parts.items() if name in rest.variables}), rest
