"""Graphs as JavaScript: a loop over places, with what is the same at all of them computed before it.

A function `name(v, p, n, o)` takes the numbers of one mechanism `v`, rows of the variables of places `p` one after the
other, n numbers each, and writes rows of outputs into `o`. What is rounded is what the graph says: JavaScript's numbers
are those of IEEE 754, and no engine may reassociate or contract them.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from centrode.numerics.expressions import Node
from centrode.numerics.graphs import (
    ALONE,
    Graph,
    Notation,
    Text,
    is_worth_a_line,
    number_text,
    split_graph,
    topological_order,
)
from centrode.numerics.operations import CONSTANT, OPERATIONS, VARIABLE

MATHEMATICAL = ("sqrt", "abs", "sin", "cos", "atan2", "exp", "log")
SIGNS = {"equal": "===", "not_equal": "!==", "both": "&&", "either": "||"}
"""Operations whose signs are other ones than in the table of operations."""
FUNCTIONS = {
    **{name: f"Math.{name}" for name in MATHEMATICAL},
    "minimum": "smaller",
    "maximum": "larger",
    "power": "power",
    "least": "least",
    "greatest": "greatest",
    # a sign there would bind more strongly than in the table: its argument always stands in brackets
    "opposite": "!",
}
HELPERS = """const larger = (a, b) => a > b || a !== a ? a : b;
const smaller = (a, b) => a < b || a !== a ? a : b;
const least = (a, b) => a < b || b !== b ? a : b;
const greatest = (a, b) => a > b || b !== b ? a : b;
const power = (a, b) => a === 1 || (a === -1 && Math.abs(b) === Infinity) ? 1 : Math.pow(a, b);
"""
"""What printed functions call beside the functions of JavaScript.

The greater and the lesser of two numbers, NaN where one of them is: Math.max takes longer, as it looks at the signs of
zeros. Of two numbers the one that is a number; powers of 1 by what is no number, which IEEE 754 has and JavaScript has
not.
"""
COSTLY = frozenset({"sin", "cos", "atan2", "exp", "log", "power", "sqrt"})
"""Operations that are worth a row of their own where they depend on the place alone."""


def number_of(x: float) -> Text:
    """A constant as JavaScript reads it: with all digits, infinite ones and NaN by name."""
    if math.isfinite(x):
        return number_text(x)
    if math.isnan(x):
        return "NaN", ALONE
    return ("Infinity", ALONE) if x > 0.0 else ("-Infinity", OPERATIONS["negate"].strength)


JAVASCRIPT = Notation(FUNCTIONS, number_of, SIGNS, "({} ? {} : {})")


@dataclass(frozen=True)
class PlaceFunction:
    """A graph as two functions: what depends on the place alone, and all outputs.

    Attributes
    ----------
    name : of the function that gives the outputs
    of_mechanism : variable of a mechanism -> its place in `v`
    fixed : variables of a place that stay when numbers of the mechanism change
    moving : those that change with them
    outputs : rows that are written
    stages : numbers of outputs behind which a call may end; with them `run` takes the stage that is the last one
    stride : numbers from one row to the next, of n or more; n where it is None
        A constant one spares the loop a product for each row.
    """

    name: str
    of_mechanism: Mapping[str, int]
    fixed: tuple[str, ...]
    moving: tuple[str, ...]
    outputs: tuple[Node, ...]
    stages: tuple[int, ...] = ()
    stride: int | None = None

    @property
    def _split(self) -> tuple[Graph, Graph]:
        graph = Graph({str(k): node for k, node in enumerate(self.outputs)})
        return split_graph(graph, self.fixed, "part", COSTLY)

    @property
    def source(self) -> str:
        """An object with both functions and the names of their rows. Raises Unwritten."""
        parts, rest = self._split
        used = frozenset(rest.variables) | frozenset(parts.variables)
        fixed = [name for name in self.fixed if name in used]
        moving = [name for name in self.moving if name in used]
        before = _function(list(parts.outputs.values()), {}, fixed, self.stride)
        rows = [*fixed, *parts.outputs, *moving]
        nodes = [rest.outputs[str(k)] for k in range(len(self.outputs))]
        run = _function(nodes, self.of_mechanism, rows, self.stride, self.stages)
        stride = "" if self.stride is None else f"stride: {self.stride}, "
        lists = (
            f"{stride}fixed: {_names(fixed)}, moving: {_names(moving)}, "
            f"parts: {len(parts.outputs)}, count: {len(nodes)}"
        )
        return f"{self.name}: {{{lists},\nbefore: {before},\nrun: {run}}}"


def once(outputs: Sequence[Node], of_mechanism: Mapping[str, int]) -> str:
    """A function `(v, o)` of the numbers of a mechanism alone. Raises Unwritten."""
    lines, texts = _lines(
        topological_order(outputs), {name: f"v[{k}]" for name, k in of_mechanism.items()}, outputs, "c"
    )
    lines += [f"o[{k}] = {texts[node][0]};" for k, node in enumerate(outputs)]
    return "(v, o) => {\n" + "\n".join(lines) + "\n}"


def _names(names: Sequence[str]) -> str:
    # names of users stand in them: as JSON writes texts, with what would end a script escaped
    quoted = (f'"{_escape(name)}"' for name in names)
    return f"[{', '.join(quoted)}]"


def _escape(text: str) -> str:
    return "".join(
        c if (c.isalnum() and c.isascii()) or c in " _-.,:" else f"\\u{{{ord(c):x}}}" for c in text
    )


def _function(
    outputs: Sequence[Node],
    of_mechanism: Mapping[str, int],
    rows: Sequence[str],
    stride: int | None = None,
    stages: Sequence[int] = (),
) -> str:
    """A function over places: what is the same everywhere before its loop, the rest inside, stage by stage."""
    order = topological_order(outputs)
    along = {name: k for k, name in enumerate(rows)}
    moving: set[Node] = set()
    for node in order:
        own = node.operation == VARIABLE and node.detail in along
        if own or any(x in moving for x in node.arguments):
            moving.add(node)
    still = [node for node in order if node not in moving]
    # what the loop takes from before it needs a name
    taken = {x for node in order if node in moving for x in node.arguments if x not in moving}
    taken |= {node for node in outputs if node not in moving}
    names = {name: f"v[{k}]" for name, k in of_mechanism.items()}
    before, texts = _lines(still, names, list(taken), "c", of_loop=True)
    filled = [
        f"o.fill({texts[node][0]}, {_start(k, stride)}, {_start(k + 1, stride)});"
        for k, node in enumerate(outputs)
        if node not in moving
    ]
    inside = _stages(outputs, [node for node in order if node in moving], along, texts, stride, stages)
    used = [
        k for name, k in along.items() if any(x.operation == VARIABLE and x.detail == name for x in order)
    ]
    read = [f"const x{k} = p[{_row(k, stride)}];" for k in used]
    loop = ["for (let i = 0; i < n; i++) {", *read, *inside, "}"] if inside else []
    last = ", last" if stages else ""
    return f"(v, p, n, o{last}) => {{\n" + "\n".join([*before, *filled, *loop]) + "\n}"


def _stages(
    outputs: Sequence[Node],
    order: Sequence[Node],
    along: Mapping[str, int],
    texts: dict[Node, Text],
    stride: int | None,
    stages: Sequence[int],
) -> list[str]:
    """What stands in the loop: lines that compute the moving outputs of each stage, then those that write them."""
    names, moving = {name: f"x{k}" for name, k in along.items()}, frozenset(order)
    ends = [node for node in outputs if node in moving]
    uses = Counter(x for node in order for x in node.arguments)
    lines: list[str] = []
    first, begun, computed = 0, 0, set[Node]()
    for stage, end in enumerate(sorted({*stages, len(outputs)})):
        # nodes come in the order of the outputs: those of a stage are not needed before
        own = [
            node for node in topological_order(outputs[first:end]) if node in moving and node not in computed
        ]
        computed.update(own)
        more, texts = _lines(own, names, ends, "t", texts, uses=uses, begun=begun)
        begun += len(more)
        lines += more
        lines += [
            f"o[{_row(k, stride)}] = {texts[outputs[k]][0]};"
            for k in range(first, end)
            if outputs[k] in moving
        ]
        if end < len(outputs):
            lines.append(f"if (last === {stage}) continue;")
        first = end
    return lines


def _start(k: int, stride: int | None) -> str:
    if stride is not None:
        return str(k * stride)
    return "0" if k == 0 else "n" if k == 1 else f"{k} * n"


def _row(k: int, stride: int | None) -> str:
    return "i" if k == 0 else f"{_start(k, stride)} + i"


def _lines(
    order: Sequence[Node],
    names: Mapping[str, str],
    outputs: Sequence[Node],
    letter: str,
    known: Mapping[Node, Text] | None = None,
    of_loop: bool = False,
    uses: Counter[Node] | None = None,
    begun: int = 0,
) -> tuple[list[str], dict[Node, Text]]:
    """Lines of nodes in order, and the text that stands for each; what the loop takes has a name or is a constant.

    `uses` counts how often each node is taken, where lines of others follow; `begun` lines precede these.
    """
    uses = Counter(x for node in order for x in node.arguments) if uses is None else uses
    ends = set(outputs)
    texts: dict[Node, Text] = dict(known or {})
    lines: list[str] = []
    for node in order:
        if node.operation == CONSTANT:
            text = JAVASCRIPT.number(float(node.detail))
        elif node.operation == VARIABLE:
            text = names[str(node.detail)], ALONE
            if of_loop and node in ends:
                text = _give_name(lines, f"{letter}{begun + len(lines)}", text)
        else:
            text = JAVASCRIPT.text(node, [texts[x] for x in node.arguments])
            if (of_loop and node in ends) or is_worth_a_line(node, text, uses[node], node in ends):
                text = _give_name(lines, f"{letter}{begun + len(lines)}", text)
        texts[node] = text
    return lines, texts


def _give_name(lines: list[str], name: str, text: Text) -> Text:
    lines.append(f"const {name} = {text[0]};")
    return name, ALONE
