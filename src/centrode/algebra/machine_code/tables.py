"""What is computed before a kernel runs, on NumPy: expressions that all lanes, or all steps, have in common."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from centrode.algebra.graph_arrays import evaluate
from centrode.algebra.graphs import Graph, split
from centrode.algebra.scans import Array, Call, Scan

FUNCTIONS = frozenset({"sin", "cos", "atan2", "exp", "log", "power"})
"""Operations that are not rounded alike everywhere."""


@dataclass(frozen=True)
class Tables:
    """A scan with what is computed beforehand taken out of it.

    What depends on the inner loop's variables alone would be computed again at every turn of the outer loop.
    Functions of the inputs alone are taken out in any case: so the drive's sine and cosine, and the statuses
    that hang on them, are NumPy's whichever loop is inside.

    Attributes
    ----------
    of_steps, of_lanes : what is computed from inputs alone, and from parameters alone
    rest : the scan with that as further inputs and parameters
    """

    of_steps: Graph
    of_lanes: Graph
    rest: Scan

    @classmethod
    def of(cls, scan: Scan, lanes_inside: bool) -> Tables:
        """The tables of a scan."""
        only = FUNCTIONS if lanes_inside else None
        of_steps, graph = split(scan.graph, scan.inputs, "of step", only)
        of_lanes, graph = split(graph, scan.parameters if lanes_inside else (), "of lane")
        rest = scan.with_graph(
            graph, (*scan.parameters, *of_lanes.outputs), (*scan.inputs, *of_steps.outputs)
        )
        return cls(of_steps, of_lanes, rest)

    def added(self, scan: Scan, call: Call, number: np.dtype[Any]) -> Call:
        """The arrays of a call of the scan as those of the rest."""
        return replace(
            call,
            inputs=_longer(call.inputs, scan.inputs, self.of_steps, number),
            parameters=_longer(call.parameters, scan.parameters, self.of_lanes, number),
        )


def _longer(rows: Array, names: Iterable[str], table: Graph, number: npt.DTypeLike) -> Array:
    """Rows with those of a table below."""
    if not table.outputs:
        return rows
    values: Mapping[str, Array] = dict(zip(names, rows, strict=True))
    found = evaluate(table, values, number)
    return np.concatenate([rows, [np.broadcast_to(one, rows.shape[1]) for one in found.values()]])
