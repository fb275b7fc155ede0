"""What is computed before a kernel runs, on NumPy: expressions that all lanes, or all steps, have in common."""

from __future__ import annotations

from dataclasses import dataclass

from centrode.algebra.graph_arrays import evaluate
from centrode.algebra.graphs import Graph, split
from centrode.algebra.scans import Array, Call, Scan, room_of

FUNCTIONS = frozenset({"sin", "cos", "atan2", "exp", "log", "power"})
"""Operations that are not rounded alike everywhere."""
KEPT = 1 << 20
"""Bytes of the arrays whose table is kept for the next call."""


class Table:
    """Expressions of some variables alone, computed for arrays of these.

    Calls in turn often have the same samples: the last table is kept.
    """

    def __init__(self, names: tuple[str, ...], graph: Graph) -> None:
        self.names = names
        self.graph = graph
        self._last: tuple[bytes, Array] | None = None

    def below(self, rows: Array) -> Array:
        """The rows of the variables, (variables, n), with those of the expressions below them."""
        if not self.graph.outputs:
            return rows
        if rows.nbytes > KEPT:
            return self._computed(rows)
        key, last = rows.tobytes() + rows.dtype.char.encode(), self._last
        if last is None or last[0] != key:
            self._last = last = key, self._computed(rows)
        return last[1]

    def _computed(self, rows: Array) -> Array:
        whole = room_of(len(rows) + len(self.graph.outputs), 1, rows.shape[1], rows.dtype)[:, 0]
        whole[: len(rows)] = rows
        found = evaluate(self.graph, dict(zip(self.names, rows, strict=True)), rows.dtype)
        for i, values in enumerate(found.values(), len(rows)):
            whole[i] = values
        return whole


@dataclass(frozen=True)
class Tables:
    """A scan with what is computed beforehand taken out of it.

    What depends on the inner loop's variables alone would be computed again at every turn of the outer loop.
    Functions of inputs or parameters alone are taken out in any case: so sine and cosine of the drive, and of arcs
    on the sphere, and the statuses that hang on them, are NumPy's whichever loop is inside.

    Attributes
    ----------
    of_steps, of_lanes : what is computed from inputs alone, and from parameters alone
    rest : the scan with that as further inputs and parameters
    """

    of_steps: Table
    of_lanes: Table
    rest: Scan

    @classmethod
    def of(cls, scan: Scan, lanes_inside: bool) -> Tables:
        """The tables of a scan."""
        steps, graph = split(scan.graph, scan.inputs, "of step", FUNCTIONS if lanes_inside else None)
        # of one step that hands nothing on nothing is computed twice
        known = scan.parameters if lanes_inside or scan.inputs or scan.state else ()
        lanes, graph = split(graph, known, "of lane", None if lanes_inside else FUNCTIONS)
        rest = scan.with_graph(graph, (*scan.parameters, *lanes.outputs), (*scan.inputs, *steps.outputs))
        return cls(Table(scan.inputs, steps), Table(scan.parameters, lanes), rest)

    def added(self, call: Call) -> Call:
        """The arrays of a call of the scan as those of the rest."""
        parameters, inputs = self.of_lanes.below(call.parameters), self.of_steps.below(call.inputs)
        return Call(parameters, inputs, call.state, call.outputs)
