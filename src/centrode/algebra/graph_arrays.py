"""Graphs and scans on NumPy: the executor that is always there, and what machine code is compared with."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.graphs import Graph
from centrode.algebra.operations import CONSTANT, VARIABLE
from centrode.algebra.scans import NEXT, Array, Call, Scan, Scanned, call_of

Number: TypeAlias = Any
CHUNK = 1 << 15
"""Numbers in an intermediate result: several of these stay in the cache."""

FUNCTIONS: Mapping[str, Callable[..., Number]] = {
    "add": np.add,
    "subtract": np.subtract,
    "multiply": np.multiply,
    "divide": np.divide,
    "negate": np.negative,
    "sqrt": np.sqrt,
    "abs": np.abs,
    "sin": np.sin,
    "cos": np.cos,
    "atan2": np.arctan2,
    "exp": np.exp,
    "log": np.log,
    "power": np.power,
    "minimum": np.minimum,
    "maximum": np.maximum,
    "least": np.fmin,
    "greatest": np.fmax,
    "less": np.less,
    "less_equal": np.less_equal,
    "equal": np.equal,
    "not_equal": np.not_equal,
    "both": np.logical_and,
    "either": np.logical_or,
    "opposite": np.logical_not,
    "where": np.where,
}


def evaluate(
    graph: Graph, values: Mapping[str, Number], number: npt.DTypeLike = np.float64
) -> dict[str, Number]:
    """Outputs of a graph at values of its variables; arrays broadcast, NaN and infinity pass without a warning."""
    left = Counter(x for node in graph.order for x in node.arguments)
    left.update(graph.outputs.values())
    found: dict[Any, Number] = {}
    with np.errstate(all="ignore"):
        for node in graph.order:
            if node.operation == VARIABLE:
                found[node] = np.asarray(values[str(node.detail)], number)
            elif node.operation == CONSTANT:
                found[node] = np.asarray(node.detail, number)[()]
            else:
                found[node] = FUNCTIONS[node.operation](*(found[x] for x in node.arguments))
            for x in node.arguments:
                left[x] -= 1
                if not left[x]:
                    del found[x]  # memory stays that of the widest place of the graph
    return {name: found[node] for name, node in graph.outputs.items()}


def run_on_arrays(
    scan: Scan,
    parameters: npt.ArrayLike | None,
    inputs: npt.ArrayLike | None,
    state: npt.ArrayLike | None = None,
    out: Array | None = None,
    steps: int | None = None,
    number: npt.DTypeLike = np.float64,
) -> Scanned:
    """Run a scan on NumPy arrays; shapes as in `call_of`."""
    call = call_of(scan, parameters, inputs, state, out, steps, number)
    if not scan.state:
        _all_steps(scan, call, number)
        return Scanned(call.outputs, call.state)
    rows = call.state
    for k in range(call.steps):
        found = evaluate(scan.graph, _values(scan, call, slice(k, k + 1), rows), number)
        for i, name in enumerate(scan.outputs):
            call.outputs[i, k] = found[name]
        rows = np.array(
            [np.broadcast_to(found[NEXT + name], (1, call.lanes))[0] for name in scan.state], number
        )
    return Scanned(call.outputs, rows)


def _all_steps(scan: Scan, call: Call, number: npt.DTypeLike) -> None:
    """Steps that do not hang on each other, as many at a time as the cache holds."""
    size = max(1, CHUNK // max(1, call.lanes))
    for first in range(0, call.steps, size):
        some = slice(first, first + size)
        found = evaluate(scan.graph, _values(scan, call, some, call.state), number)
        for i, name in enumerate(scan.outputs):
            call.outputs[i, some] = found[name]


def _values(scan: Scan, call: Call, steps: slice, state: Array) -> dict[str, Array]:
    """Values of all variables: parameters and states along the last axis, inputs along the one before."""
    values = {name: call.parameters[i] for i, name in enumerate(scan.parameters)}
    values |= {name: call.inputs[i, steps, None] for i, name in enumerate(scan.inputs)}
    return values | {name: state[i] for i, name in enumerate(scan.state)}
