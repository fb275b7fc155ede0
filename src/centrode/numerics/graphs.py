"""Graphs of expressions: named outputs, what they depend on, in which order they are computed."""

from __future__ import annotations

import hashlib
import math
from collections import Counter
from collections.abc import Callable, Container, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from centrode.numerics.expressions import EXPRESSIONS, Node, Operand, apply_operation, as_node, variable
from centrode.numerics.operations import CONSTANT, OPERATIONS, VARIABLE


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
        return tuple(topological_order(self.outputs.values()))

    @cached_property
    def variables(self) -> tuple[str, ...]:
        """Names of the variables, in the order in which they are met."""
        return tuple(str(node.detail) for node in self.order if node.operation == VARIABLE)

    @cached_property
    def counts(self) -> Counter[str]:
        """Number of nodes of each operation; constants and variables are not counted."""
        return Counter(node.operation for node in self.order if node.arguments)

    @cached_property
    def key(self) -> bytes:
        """Digest of the outputs, names included: the same in every process."""
        parts = [name.encode() + b"\0" + node.key for name, node in self.outputs.items()]
        return hashlib.blake2b(b"".join(parts), digest_size=16).digest()

    def substitute(self, values: Mapping[str, Operand]) -> Graph:
        """The graph with expressions or numbers in the place of some variables."""

        def replacement(node: Node, _arguments: tuple[Node, ...]) -> Operand | None:
            return values.get(str(node.detail)) if node.operation == VARIABLE else None

        return Graph(rebuilt(self.outputs, replacement))


def topological_order(roots: Iterable[Node]) -> list[Node]:
    """The nodes that roots consist of, arguments first; without recursion, so that depth does not matter."""
    ordered: dict[Node, None] = {}
    # a stack gives back the last first: reversed, nodes come in the order of a recursion from the first
    # output on
    stack = [(node, False) for node in reversed(list(roots))]
    while stack:
        node, arguments_done = stack.pop()
        if node in ordered:
            continue
        if arguments_done or not node.arguments:
            ordered[node] = None
            continue
        stack.append((node, True))
        stack.extend((x, False) for x in reversed(node.arguments))
    return list(ordered)


def rebuilt(
    outputs: Mapping[str, Node], replaced: Callable[[Node, tuple[Node, ...]], Operand | None]
) -> dict[str, Node]:
    """Outputs with some nodes replaced, and everything above these built anew.

    `replaced(node, arguments)` gives what stands for a node, its arguments being rebuilt already, or None to keep it.
    """
    new: dict[Node, Node] = {}
    for node in topological_order(outputs.values()):
        arguments = tuple(new[x] for x in node.arguments)
        other = replaced(node, arguments)
        if other is not None:
            new[node] = as_node(other)
        elif arguments != node.arguments:
            # rules are applied again: with other arguments a simpler expression may have the same bits
            new[node] = apply_operation(node.operation, *arguments)
        else:
            new[node] = node
    return {name: new[node] for name, node in outputs.items()}


def split_graph(
    graph: Graph, names: Iterable[str], prefix: str, only: Container[str] | None = None
) -> tuple[Graph, Graph]:
    """Graph of what depends on some variables alone, and the rest of the graph with that as variables.

    The first graph computes the greatest parts that depend on nothing but `names`; they are variables
    `prefix 0`, `prefix 1` ... of the second. With `only`, parts are results of the operations it names.
    """
    wanted = frozenset(names)
    alone: set[Node] = set()
    for node in graph.order:
        if node.operation == VARIABLE:
            if node.detail in wanted:
                alone.add(node)
        # functions of constants alone (sin 2 is not folded) count among them: they are the same everywhere
        elif node.arguments and all(x in alone or x.operation == CONSTANT for x in node.arguments):
            alone.add(node)
    if only is None:
        tops = {x: None for node in graph.order if node not in alone for x in node.arguments if x in alone}
        tops |= {node: None for node in graph.outputs.values() if node in alone}
    else:
        tops = {node: None for node in graph.order if node in alone and node.operation in only}
    # parts are handed over as numbers in rows, and a condition is none
    parts = {f"{prefix} {i}": x for i, x in enumerate(x for x in tops if x.arguments and not x.is_condition)}
    places = {node: variable(name) for name, node in parts.items()}
    rest = Graph(rebuilt(graph.outputs, lambda node, _arguments: places.get(node)))
    # where only some operations are taken out, one part may lie inside another that has been taken out too
    return Graph({name: node for name, node in parts.items() if name in rest.variables}), rest


# Graphs as plain data: rows of words and numbers, from which the same graph is built again in another process.

Row = list[str | float | int]


def graph_rows(graph: Graph) -> list[Row]:
    """The nodes in order, each as [operation, places of its arguments ...] or [operation, detail]; then the outputs.

    Outputs are rows ["output", name, place of the node].
    """
    places = {node: k for k, node in enumerate(graph.order)}
    rows: list[Row] = [
        [node.operation, *(places[x] for x in node.arguments)]
        if node.arguments
        else [node.operation, node.detail]
        for node in graph.order
    ]
    return rows + [["output", name, places[node]] for name, node in graph.outputs.items()]


def graph_of_rows(rows: Iterable[Row]) -> Graph:
    """The graph of such rows.

    Raises ValueError where they are none.
    """
    nodes: list[Node] = []
    outputs: dict[str, Node] = {}
    try:
        for operation, *rest in rows:
            if operation == "output":
                outputs[str(rest[0])] = nodes[int(rest[1])]
            elif operation == VARIABLE:
                nodes.append(variable(str(rest[0])))
            elif operation == CONSTANT:
                nodes.append(as_node(float(rest[0])))
            else:
                nodes.append(apply_operation(str(operation), *(nodes[int(k)] for k in rest)))
    except (IndexError, KeyError, TypeError) as error:
        raise ValueError("the rows are no graph") from error
    return Graph(outputs)


# Gradients, from graph to graph: the derivatives of one output by many variables for a few times its cost.
#
# Reverse mode: Griewank and Walther, Evaluating Derivatives (2nd ed., 2008), section 3.2.

m = EXPRESSIONS
Rule = Callable[..., tuple[Operand | None, ...]]


def gradient(output: Node, variables: Sequence[Node]) -> list[Operand]:
    """Partial derivatives of a node by variables, as nodes; plain 0.0 where it does not depend on one.

    At a selection the derivative is that of what is selected; what is not selected may be NaN or infinite
    without harm. `abs`, `minimum` and `maximum` take the derivative of the side the value is on.
    """
    order = topological_order([output])
    needed = _dependent_nodes(order, variables)
    guarded = _nodes_below_selections(order)
    by: dict[Node, Operand] = {output: 1.0}
    # backwards, a node comes after all that is computed from it: its derivative is whole when it is handed on
    for node in reversed(order):
        if node not in by or node not in needed or not node.arguments or node.is_condition:
            continue
        for argument, factor in zip(
            node.arguments, _RULES[node.operation](node, *node.arguments), strict=True
        ):
            if factor is not None and argument in needed:
                _collect(by, argument, _chain_rule_product(node, by[node], factor, node in guarded))
    return [by.get(x, 0.0) for x in variables]


def directional_derivatives(
    outputs: Sequence[Node], directions: Sequence[Mapping[Node, Operand]]
) -> list[list[Operand]]:
    """Derivatives of nodes along directions, a list for each direction: forward mode, for outputs more than directions.

    A direction tells how fast variables change. What is said of selections in `gradient` holds here.
    """
    order = topological_order(outputs)
    changes: list[dict[Node, Operand]] = [dict(direction) for direction in directions]
    for node in order:
        if (
            not node.arguments
            or node.is_condition
            or not any(x in c for c in changes for x in node.arguments)
        ):
            continue
        factors = _RULES[node.operation](node, *node.arguments)
        for change in changes:
            for argument, factor in zip(node.arguments, factors, strict=True):
                if factor is not None and argument in change:
                    _collect(change, node, _chain_rule_product(node, change[argument], factor, False))
    return [[change.get(x, 0.0) for x in outputs] for change in changes]


def partial_derivatives(node: Node) -> tuple[Operand | None, ...]:
    """Partial derivative of an operation by each argument: None by a condition, a condition where it is 1 or 0."""
    return _RULES[node.operation](node, *node.arguments)


def _dependent_nodes(order: Sequence[Node], variables: Sequence[Node]) -> set[Node]:
    """Nodes that depend on one of the variables."""
    needed = set(variables)
    for node in order:
        if any(x in needed for x in node.arguments):
            needed.add(node)
    return needed


def _nodes_below_selections(order: Sequence[Node]) -> set[Node]:
    """Nodes below a selection: their derivative may have to vanish although a factor of it is NaN."""
    below: set[Node] = set()
    for node in reversed(order):
        if node in below or node.operation in _SELECTIONS:
            below.update(node.arguments)
    return below


def _collect(by: dict[Node, Operand], node: Node, part: Operand) -> None:
    by[node] = by[node] + part if node in by else part


def _chain_rule_product(node: Node, outer: Operand, factor: Operand, guarded: bool) -> Operand:
    """Product by the chain rule; a condition as the factor selects instead."""
    if isinstance(factor, Node) and factor.is_condition:
        # a condition stands for 1 or 0: selecting takes in NaN beside it, a product would not
        return m.where(factor, outer, 0.0)
    # nothing is multiplied by the 1 with which the output begins
    if isinstance(outer, float) and outer == 1.0:
        return factor
    product = outer * factor
    if not guarded or not isinstance(factor, Node) or not isinstance(outer, Node):
        return product
    # what is not selected has the outer derivative 0, and its own may be infinite: 0 times that is NaN
    return m.where(m.equal(outer, 0.0), 0.0, product)


def _root(node: Node, x: Node) -> tuple[Operand, ...]:
    return (0.5 / node,)


def _quotient(node: Node, a: Node, b: Node) -> tuple[Operand, ...]:
    # a power of two over b is 1 / b but for the exponent: no second division
    whole = a.operation == CONSTANT and abs(math.frexp(float(a.detail))[0]) == 0.5
    reciprocal = node * (1.0 / float(a.detail)) if whole else 1.0 / b
    # -a / b^2 from the quotient itself: no second division
    return reciprocal, -(node * reciprocal)


def _angle(node: Node, y: Node, x: Node) -> tuple[Operand, ...]:
    squared = x * x + y * y
    return x / squared, -(y / squared)


def _power(node: Node, x: Node, exponent: Node) -> tuple[Operand, ...]:
    return exponent * apply_operation("power", x, exponent - 1.0), node * m.log(x)


def _least(node: Node, a: Node, b: Node) -> tuple[Operand, ...]:
    # NaN loses here: the first argument counts also where the second is NaN
    first = m.either(m.less(a, b), m.not_equal(b, b))
    return first, m.opposite(first)


def _greatest(node: Node, a: Node, b: Node) -> tuple[Operand, ...]:
    first = m.either(m.less(b, a), m.not_equal(b, b))
    return first, m.opposite(first)


def _lesser(node: Node, a: Node, b: Node) -> tuple[Operand, ...]:
    # NaN wins here: the first argument counts also where it is NaN itself
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


# Graphs as text: one line for every intermediate result that is used more than once. How each operation is written
# stands in the one table of operations, and what a language writes otherwise in its notation.

LONGEST = 70
"""Characters above which an expression gets a line of its own even if it is used once."""

Text = tuple[str, int]
"""An expression as text and how strongly its outermost sign binds."""
ALONE = 9
"""How strongly a name, a number or a call binds: it needs no brackets anywhere."""


class Unwritten(Exception):
    """An operation that a notation has no words for; `operation` is its name."""

    def __init__(self, operation: str) -> None:
        self.operation = operation
        super().__init__(operation)


@dataclass(frozen=True)
class Notation:
    """How a language writes operations.

    Attributes
    ----------
    functions : operation -> name of the function that carries it out
    number : a constant as text
    signs : operation -> its sign where it is not that of the table of operations
    selection : pattern of a choice between two values by a condition; empty where that is a function too
    """

    functions: Mapping[str, str]
    number: Callable[[float], Text]
    signs: Mapping[str, str]
    selection: str = ""

    def text(self, node: Node, inside: Sequence[Text]) -> Text:
        """A node on arguments that are texts. Raises Unwritten for an operation that the language does not have."""
        return self.operation_text(node.operation, inside)

    def operation_text(self, name: str, inside: Sequence[Text]) -> Text:
        """An operation, by its name, on arguments that are texts. Raises Unwritten."""
        operation = OPERATIONS[name]
        strength, sign = operation.strength, self.signs.get(name, operation.sign)
        if name == "where" and self.selection:
            return self.selection.format(*(text for text, _strength in inside)), ALONE
        if not sign or name in self.functions:
            if name not in self.functions:
                raise Unwritten(name)
            return f"{self.functions[name]}({', '.join(text for text, _strength in inside)})", ALONE
        if operation.arguments == 1:
            return sign + _in_brackets(inside[0], strength), strength
        # of equal strength only the left argument goes without brackets; + and * too, as they are not reassociated
        left, right = _in_brackets(inside[0], strength), _in_brackets(inside[1], strength + 1)
        return f"{left} {sign} {right}", strength


def is_worth_a_line(node: Node, text: Text, uses: int, is_output: bool) -> bool:
    """Whether an expression gets a line of its own: what is used more than once, and what is long."""
    long = len(text[0]) > LONGEST and uses
    return bool(node.arguments) and bool(uses > 1 or long or (is_output and uses))


def graph_listing(graph: Graph) -> str:
    """The graph as lines `name = expression`, in the order in which they are computed.

    What is used once stands where it is used; intermediate results are named t1, t2 ...
    """
    uses = Counter(x for node in graph.order for x in node.arguments)
    outputs = set(graph.outputs.values())
    texts: dict[Node, Text] = {}
    lines: list[str] = []
    for node in graph.order:
        text = _text(node, texts)
        if is_worth_a_line(node, text, uses[node], node in outputs):
            name = f"t{len(lines) + 1}"
            lines.append(f"{name} = {text[0]}")
            text = name, ALONE
        texts[node] = text
    lines += [f"{name} = {texts[node][0]}" for name, node in graph.outputs.items()]
    return "\n".join(lines)


def operation_counts(graph: Graph) -> str:
    """Numbers of operations of each kind as text, the most frequent first."""
    return ", ".join(f"{number} {operation}" for operation, number in graph.counts.most_common())


def _text(node: Node, texts: dict[Node, Text]) -> Text:
    if node.operation == VARIABLE:
        return str(node.detail), ALONE
    if node.operation == CONSTANT:
        return number_text(float(node.detail))
    return _LISTED.text(node, [texts[x] for x in node.arguments])


def _in_brackets(text: Text, strength: int) -> str:
    return text[0] if text[1] >= strength else f"({text[0]})"


def number_text(x: float) -> Text:
    """A constant with all its digits; a leading minus binds as a sign before a product does."""
    # repr of a whole number would lose the sign of -0
    text = repr(int(x)) if x.is_integer() and abs(x) < 1e6 and (x or math.copysign(1, x) > 0) else repr(x)
    return text, ALONE if text[0].isdigit() else OPERATIONS["negate"].strength


_LISTED = Notation({name: name for name, each in OPERATIONS.items() if not each.sign}, number_text, {})
