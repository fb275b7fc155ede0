"""One construct for all that repeats: (state', outputs) = F(parameters, inputs of step k, state).

A sweep of positions has no state; a reduction carries its greatest value so far; a fixed-step scheme and a
Newton iteration carry their unknowns. Lanes are independent of one another: mechanisms of a batch, or
samples of one mechanism.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from types import MappingProxyType
from typing import Any, NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.numerics.expressions import EXPRESSIONS, Node, Operand, as_node, variable
from centrode.numerics.graphs import Graph, gradient, split_graph
from centrode.numerics.operations import CONSTANT, VARIABLE

Array: TypeAlias = npt.NDArray[Any]
LINE = 64
"""Bytes of a line of the cache, and of the widest vector: one that begins elsewhere is written twice."""
NEXT, EXTREME = "next ", "extreme "
"""Before the name of a state, its value after the step; before that of an extreme, its number in a lane."""


class LaneExtreme(NamedTuple):
    """The greatest ("maximum") or least ("minimum") number of all lanes of a step, or `start`; NaN where one is."""

    operation: str
    value: Node
    start: float


@dataclass(frozen=True)
class Scan:
    """Recurrence that is computed at every step for every lane.

    Attributes
    ----------
    parameters : names of numbers of which every lane has its own, the same at all steps
    inputs : names of numbers of which every step has its own, the same in all lanes
    outputs : name -> node; written at every step for every lane
    state : name -> node; what is handed to the next step under this name
    extremes : name -> extreme over all lanes, one number a step; only without a state
    places : rows of `out` in which the outputs stand; one behind the other where there are none
    """

    parameters: tuple[str, ...]
    inputs: tuple[str, ...]
    outputs: Mapping[str, Node] = field(default_factory=dict)
    state: Mapping[str, Node] = field(default_factory=dict)
    extremes: Mapping[str, LaneExtreme] = field(default_factory=dict)
    places: tuple[int, ...] = ()

    def __post_init__(self) -> None:
        names = [*self.parameters, *self.inputs, *self.state]
        if len(set(names)) < len(names):
            raise ValueError("a scan's parameters, inputs and states need different names")
        unknown = [name for name in self.graph.variables if name not in names]
        if unknown:
            raise ValueError(f"neither parameter, input nor state: {', '.join(unknown)}")
        if self.extremes and self.state:
            raise ValueError("a scan with a state has no extremes over lanes")
        if self.places and len(self.places) != len(self.outputs):
            raise ValueError(f"{len(self.outputs)} outputs have {len(self.places)} places")

    @cached_property
    def graph(self) -> Graph:
        """Outputs, next states and what extremes are taken of, together."""
        states = {NEXT + name: node for name, node in self.state.items()}
        return Graph({**self.outputs, **states, **{EXTREME + x: y.value for x, y in self.extremes.items()}})

    @cached_property
    def rows(self) -> tuple[int, ...]:
        """The row of `out` for each output."""
        return self.places or tuple(range(len(self.outputs)))

    @property
    def height(self) -> int:
        """Rows that `out` has at least."""
        return max(self.rows, default=-1) + 1

    @cached_property
    def key(self) -> tuple[object, ...]:
        """Key that distinguishes the scan from all others, equal in every process."""
        extremes = tuple((name, x.operation, x.start) for name, x in self.extremes.items())
        return self.parameters, self.inputs, tuple(self.state), extremes, self.places, self.graph.key

    def with_graph(self, graph: Graph, parameters: tuple[str, ...], inputs: tuple[str, ...]) -> Scan:
        """The scan with other expressions under the same names."""
        outputs = {name: graph.outputs[name] for name in self.outputs}
        state = {name: graph.outputs[NEXT + name] for name in self.state}
        extremes = {
            name: x._replace(value=graph.outputs[EXTREME + name]) for name, x in self.extremes.items()
        }
        return Scan(parameters, inputs, outputs, state, extremes, self.places)


class Scanned(NamedTuple):
    """Result of a scan.

    Attributes
    ----------
    outputs : (outputs, steps, lanes)
    state : (states, lanes), after the last step
    extremes : (extremes, steps), over the lanes
    """

    outputs: Array
    state: Array
    extremes: Array = np.empty((0, 0))


@dataclass(frozen=True)
class Call:
    """The arrays of one call of a scan, checked and of one type."""

    parameters: Array
    inputs: Array
    state: Array
    outputs: Array

    @property
    def lanes(self) -> int:
        """Number of lanes."""
        return int(self.outputs.shape[2])

    @property
    def steps(self) -> int:
        """Number of steps."""
        return int(self.outputs.shape[1])


def call_of(
    scan: Scan,
    parameters: npt.ArrayLike | None,
    inputs: npt.ArrayLike | None,
    state: npt.ArrayLike | None = None,
    out: Array | None = None,
    steps: int | None = None,
    number: npt.DTypeLike = np.float64,
) -> Call:
    """The arrays of a call.

    Parameters
    ----------
    parameters : (parameters, lanes), or (parameters, 1) for all lanes; may be left out if there are none
    inputs : (inputs, steps); may be left out if there are none
    state : (states, lanes) or (states, 1), before the first step; is left as it is
    out : (outputs, steps, lanes), written to if given; its last axis has to be contiguous; of a scan with places it
        has a row for each of them
    steps : how many, if there are no inputs to tell
    """
    of_lanes, of_steps = _rows(scan.parameters, parameters, number), _rows(scan.inputs, inputs, number)
    states = _rows(tuple(scan.state), state, number)
    lanes = _length("lanes", [of_lanes, states], 1)
    count = _length("steps", [of_steps], 1 if steps is None else steps)
    if steps is not None and count != steps:
        raise ValueError(f"inputs have {count} steps, asked are {steps}")
    if out is None:
        out = np.empty((scan.height, count, lanes), number)
    check_room(scan, out, count, lanes, number)
    return Call(_spread(of_lanes, lanes), _spread(of_steps, count), _spread(states, lanes), out)


def check_room(scan: Scan, out: Array, steps: int, lanes: int, number: npt.DTypeLike) -> None:
    """Raise ValueError where outputs cannot be written to an array."""
    # rows may be left over where places say so, or where nothing is written
    sparse = bool(scan.places) or not scan.outputs
    fits = out.ndim == 3 and (len(out) == scan.height or (len(out) > scan.height and sparse))
    contiguous = not out.size or out.strides[-1] == out.itemsize
    if not fits or out.shape[1:] != (steps, lanes) or out.dtype != number or not contiguous:
        shape = (scan.height, steps, lanes)
        raise ValueError(f"out has to be {shape} of {np.dtype(number)} with a contiguous last axis")


def room_of(outputs: int, steps: int, lanes: int, number: npt.DTypeLike = np.float64) -> Array:
    """A buffer for outputs that is used again, (outputs, steps, lanes): rows begin where lines of the cache do."""
    size = np.dtype(number).itemsize
    # rows are filled up to whole lines, and one line more is taken to shift the first row onto a line's
    # beginning
    row = -(-lanes * size // LINE) * LINE
    whole = np.empty(outputs * steps * row + LINE, np.uint8)
    first = -whole.ctypes.data % LINE
    rows = whole[first : first + outputs * steps * row].view(number)
    return rows.reshape(outputs, steps, row // size)[:, :, :lanes]


def _rows(names: tuple[str, ...], values: npt.ArrayLike | None, number: npt.DTypeLike) -> Array:
    """Values as (names, n)."""
    if values is None:
        if names:
            raise ValueError(f"values are missing: {', '.join(names)}")
        return np.empty((0, 1), number)
    rows = np.asarray(values, number)
    if rows.ndim != 2 or len(rows) != len(names):
        raise ValueError(f"expected ({len(names)}, n) values, got {rows.shape}")
    return rows


def _spread(rows: Array, length: int) -> Array:
    """Rows of that length; one number stands for all. Short kernels are called often, so nothing is done twice."""
    if not len(rows):
        return np.empty((0, length), rows.dtype)
    if rows.shape[1] != length:
        rows = np.broadcast_to(rows, (len(rows), length))
    return np.ascontiguousarray(rows)


def _length(what: str, arrays: Sequence[Array], otherwise: int) -> int:
    lengths = {rows.shape[1] for rows in arrays if len(rows)} or {otherwise}
    if len(lengths) > 1:
        lengths -= {1}  # one for all
    if len(lengths) > 1:
        raise ValueError(f"numbers of {what} differ: {sorted(lengths)}")
    (length,) = lengths
    return int(length)


# Reductions as states of a scan: what is left of all steps is one number a lane. NaN is left out.
#
# Each gives the next values of states and what they start with, for `Scan(state=...)` and its first state.

m = EXPRESSIONS


class Reduction(NamedTuple):
    """States of a scan.

    Attributes
    ----------
    state : name -> its next value
    start : name -> its value before the first step
    at_end : name -> what the last states and the lane's parameters make, once a lane
    """

    state: Mapping[str, Node]
    start: Mapping[str, float]
    at_end: Mapping[str, Node] = MappingProxyType({})


def greatest(name: str, value: Node) -> Reduction:
    """The greatest value of all steps; NaN if there is none."""
    # NaN loses against any number, so a NaN to start with is left only where there was no number at all
    return Reduction({name: as_node(m.greatest(value, variable(name)))}, {name: math.nan})


def least(name: str, value: Node) -> Reduction:
    """The least value of all steps; NaN if there is none."""
    return Reduction({name: as_node(m.least(value, variable(name)))}, {name: math.nan})


def total(name: str, value: Node) -> Reduction:
    """The sum of all values."""
    return Reduction({name: _more(name, value, value)}, {name: 0.0})


def number_of(name: str, value: Node) -> Reduction:
    """Reduction that counts the values that are not NaN."""
    return Reduction({name: _more(name, value, 1.0)}, {name: 0.0})


def total_with_gradient(name: str, value: Node, by: Sequence[Node], moving: Collection[str]) -> Reduction:
    """The sum and its derivatives: `at_end` has `name` and `name by variable`.

    `moving` are the variables that differ from step to step. A sum is linear in its derivatives by the parts of the
    formula that stand meanwhile: these are what the states carry, and the chain from there to the variables `by` is
    gone through once a lane.
    """
    variables = [x for x in Graph({"": value}).variables if x not in moving]
    parts, rest = split_graph(Graph({"": value}), variables, f"{name} part")
    own = {x: variable(x) for x in rest.variables if x in variables}
    standing = {**parts.outputs, **own}
    slopes = Graph.of(
        dict(zip(standing, gradient(rest.outputs[""], [variable(x) for x in standing]), strict=True))
        # first by the parts that stand while the steps go on, as if they were variables: these derivatives are
        # added up
    )
    # then the parts are put back in, so that the scan needs no further parameters
    carried = slopes.substitute(parts.outputs).outputs
    labels = {x: f"{name} through {x}" for x in standing}
    state = {name: _more(name, value, value)}
    state |= {labels[x]: _more(labels[x], value, carried[x]) for x in standing}
    ends: dict[str, Operand] = {name: variable(name)}
    for x in by:
        ends[f"{name} by {x.detail}"] = 0.0
    for part, node in standing.items():
        for x, factor in zip(by, gradient(node, by), strict=True):
            ends[f"{name} by {x.detail}"] = ends[f"{name} by {x.detail}"] + variable(labels[part]) * factor
    return Reduction(state, dict.fromkeys(state, 0.0), Graph.of(ends).outputs)


def greatest_with_gradient(name: str, value: Node, by: Sequence[Node]) -> Reduction:
    """The greatest value and its derivatives there; of equals the first one counts."""
    so_far = variable(name)
    # NaN stands before the first value: nothing is greater than it, so that is looked for by itself
    better = m.either(m.less(so_far, value), m.opposite(m.is_number(so_far)))
    state = {name: m.where(better, value, so_far)}
    for x, part in zip(by, gradient(value, by), strict=True):
        label = f"{name} by {x.detail}"
        state[label] = m.where(better, part, variable(label))
    return Reduction(state, dict.fromkeys(state, math.nan))


def together(*reductions: Reduction) -> Reduction:
    """Several reductions in one pass."""
    state = {name: node for reduction in reductions for name, node in reduction.state.items()}
    start = {name: value for reduction in reductions for name, value in reduction.start.items()}
    return Reduction(
        state, start, {name: node for reduction in reductions for name, node in reduction.at_end.items()}
    )


def end_of(reduction: Reduction, parameters: Sequence[str]) -> Scan:
    """The scan of one step that computes `at_end`: parameters and then the last states are its parameters."""
    return Scan((*parameters, *reduction.state), (), reduction.at_end)


def _more(name: str, value: Node, part: Operand) -> Node:
    # a gap adds nothing, and does not make the whole sum a gap
    so_far = variable(name)
    return m.where(m.is_number(value), so_far + part, so_far)


# Graphs and scans on NumPy: the executor that is always there, and what machine code is compared with.

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

EXTREMES: Mapping[str, np.ufunc] = {"minimum": np.minimum, "maximum": np.maximum}
"""What is taken of all lanes."""


def evaluate(
    graph: Graph, values: Mapping[str, Number], number: npt.DTypeLike = np.float64
) -> dict[str, Number]:
    """Outputs of a graph at values of its variables; arrays broadcast, NaN and infinity pass without a warning."""
    # how many nodes still wait for each result; an output waits until the end
    left = Counter(x for node in graph.order for x in node.arguments)
    left.update(graph.outputs.values())
    values_of_nodes: dict[Any, Number] = {}
    with np.errstate(all="ignore"):
        for node in graph.order:
            if node.operation == VARIABLE:
                values_of_nodes[node] = np.asarray(values[str(node.detail)], number)
            elif node.operation == CONSTANT:
                values_of_nodes[node] = np.asarray(node.detail, number)[()]
            else:
                values_of_nodes[node] = FUNCTIONS[node.operation](
                    *(values_of_nodes[x] for x in node.arguments)
                )
            for x in node.arguments:
                left[x] -= 1
                if not left[x]:
                    del values_of_nodes[x]  # memory stays that of the widest place of the graph
    return {name: values_of_nodes[node] for name, node in graph.outputs.items()}


def run_on_arrays(
    scan: Scan,
    parameters: npt.ArrayLike | None,
    inputs: npt.ArrayLike | None,
    state: npt.ArrayLike | None = None,
    out: Array | None = None,
    steps: int | None = None,
    new_state: Array | None = None,
    number: npt.DTypeLike = np.float64,
) -> Scanned:
    """Run a scan on NumPy arrays; shapes as in `call_of`, `new_state` as the state is written to if given."""
    call = call_of(scan, parameters, inputs, state, out, steps, number)
    if not scan.state:
        return Scanned(call.outputs, call.state, _all_steps(scan, call, number))
    rows = call.state.copy()
    for k in range(call.steps):
        results = evaluate(scan.graph, _values(scan, call, slice(k, k + 1), rows), number)
        for i, name in zip(scan.rows, scan.outputs, strict=True):
            call.outputs[i, k] = results[name]
        rows = np.array(
            [np.broadcast_to(results[NEXT + name], (1, call.lanes))[0] for name in scan.state], number
        )
    if new_state is not None:
        new_state[...] = rows
    return Scanned(call.outputs, rows if new_state is None else new_state)


def _all_steps(scan: Scan, call: Call, number: npt.DTypeLike) -> Array:
    """Steps that do not hang on each other, as many at a time as the cache holds; returns extremes over lanes."""
    extremes = np.empty((len(scan.extremes), call.steps), number)
    # as many steps as fill `CHUNK` numbers: one step of many lanes, or many of few
    size = max(1, CHUNK // max(1, call.lanes))
    for first in range(0, call.steps, size):
        some = slice(first, first + size)
        results = evaluate(scan.graph, _values(scan, call, some, call.state), number)
        for i, name in zip(scan.rows, scan.outputs, strict=True):
            call.outputs[i, some] = results[name]
        for i, (name, extreme) in enumerate(scan.extremes.items()):
            shape = call.outputs[:, some].shape[1:]
            of_lanes = np.broadcast_to(results[EXTREME + name], shape)
            extremes[i, some] = EXTREMES[extreme.operation].reduce(of_lanes, axis=1, initial=extreme.start)
    return extremes


def _values(scan: Scan, call: Call, steps: slice, state: Array) -> dict[str, Array]:
    """Values of all variables: parameters and states along the last axis, inputs along the one before."""
    values = {name: call.parameters[i] for i, name in enumerate(scan.parameters)}
    values |= {name: call.inputs[i, steps, None] for i, name in enumerate(scan.inputs)}
    return values | {name: state[i] for i, name in enumerate(scan.state)}
