"""One construct for all that repeats: (state', outputs) = F(parameters, inputs of step k, state).

A sweep of positions has no state; a reduction carries its greatest value so far; a fixed-step scheme and a
Newton iteration carry their unknowns. Lanes are independent of one another: mechanisms of a batch, or
samples of one mechanism.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.expressions import Node
from centrode.algebra.graphs import Graph

Array: TypeAlias = npt.NDArray[Any]
LINE = 64
"""Bytes of a line of the cache, and of the widest vector: one that begins elsewhere is written twice."""
NEXT = "next "
"""Before the name of a state: its value after the step, in the scan's graph."""


@dataclass(frozen=True)
class Scan:
    """What is computed at every step for every lane.

    Attributes
    ----------
    parameters : names of numbers of which every lane has its own, the same at all steps
    inputs : names of numbers of which every step has its own, the same in all lanes
    outputs : name -> node; written at every step for every lane
    state : name -> node; what is handed to the next step under this name
    """

    parameters: tuple[str, ...]
    inputs: tuple[str, ...]
    outputs: Mapping[str, Node] = field(default_factory=dict)
    state: Mapping[str, Node] = field(default_factory=dict)

    def __post_init__(self) -> None:
        names = [*self.parameters, *self.inputs, *self.state]
        if len(set(names)) < len(names):
            raise ValueError("a scan's parameters, inputs and states need different names")
        unknown = [name for name in self.graph.variables if name not in names]
        if unknown:
            raise ValueError(f"neither parameter, input nor state: {', '.join(unknown)}")

    @cached_property
    def graph(self) -> Graph:
        """Outputs and next states together."""
        return Graph({**self.outputs, **{NEXT + name: node for name, node in self.state.items()}})

    @cached_property
    def key(self) -> tuple[object, ...]:
        """What tells the scan from all others, the same in every process."""
        return self.parameters, self.inputs, tuple(self.state), self.graph.key

    def with_graph(self, graph: Graph, parameters: tuple[str, ...], inputs: tuple[str, ...]) -> Scan:
        """The scan with other expressions under the same names."""
        outputs = {name: graph.outputs[name] for name in self.outputs}
        return Scan(parameters, inputs, outputs, {name: graph.outputs[NEXT + name] for name in self.state})


class Scanned(NamedTuple):
    """What a scan gives.

    Attributes
    ----------
    outputs : (outputs, steps, lanes)
    state : (states, lanes), after the last step
    """

    outputs: Array
    state: Array


@dataclass(frozen=True)
class Call:
    """The arrays of one call of a scan, checked and of one type."""

    parameters: Array
    inputs: Array
    state: Array
    outputs: Array

    @property
    def lanes(self) -> int:
        """How many lanes there are."""
        return int(self.outputs.shape[2])

    @property
    def steps(self) -> int:
        """How many steps there are."""
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
    out : (outputs, steps, lanes), written to if given; its last axis has to be contiguous
    steps : how many, if there are no inputs to tell
    """
    of_lanes, of_steps = _rows(scan.parameters, parameters, number), _rows(scan.inputs, inputs, number)
    states = _rows(tuple(scan.state), state, number)
    lanes = _length("lanes", [of_lanes, states], 1)
    count = _length("steps", [of_steps], 1 if steps is None else steps)
    if steps is not None and count != steps:
        raise ValueError(f"inputs have {count} steps, asked are {steps}")
    shape = (len(scan.outputs), count, lanes)
    if out is None:
        out = np.empty(shape, number)
    if out.shape != shape or out.dtype != number or (out.size and out.strides[2] != out.itemsize):
        raise ValueError(f"out has to be {shape} of {np.dtype(number)} with a contiguous last axis")
    return Call(_spread(of_lanes, lanes), _spread(of_steps, count), _spread(states, lanes).copy(), out)


def room_of(outputs: int, steps: int, lanes: int, number: npt.DTypeLike = np.float64) -> Array:
    """A buffer for outputs that is used again, (outputs, steps, lanes): rows begin where lines of the cache do."""
    size = np.dtype(number).itemsize
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
