"""One pass over places of the path for many mechanisms: what is left of it are a few numbers of each."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.executors import runner
from centrode.algebra.expression_functions import EXPRESSIONS
from centrode.algebra.expressions import Node, as_node, variable
from centrode.algebra.graphs import Graph
from centrode.algebra.reductions import Reduction
from centrode.algebra.scans import Scan

Array: TypeAlias = npt.NDArray[np.float64]
Values: TypeAlias = Mapping[str, Array]

m = EXPRESSIONS
INFINITE = float("inf")


@dataclass(frozen=True)
class Pass:
    """A reduction over places that have nothing to do with one another.

    Attributes
    ----------
    names : what may be known of mechanisms
    places : name -> (places,), what may be known of places
    """

    reduction: Reduction
    names: Sequence[str]
    places: Values

    @cached_property
    def scan(self) -> Scan:
        """The scan, with those of the names that are used."""
        used = frozenset(Graph(self.reduction.state).variables)
        return Scan(
            tuple(name for name in dict.fromkeys(self.names) if name in used),
            tuple(name for name in self.places if name in used),
            {},
            self.reduction.state,
        )

    def run(self, values: Values, kernels: str, threads: int, steps: int = 1) -> dict[str, Array]:
        """The states behind all places, name -> (lanes,); `steps` says how many there are where nothing tells."""
        scan = self.scan
        if not scan.state:
            return {}
        parameters = np.stack([values[name] for name in scan.parameters]) if scan.parameters else None
        inputs = np.stack([self.places[name] for name in scan.inputs]) if scan.inputs else None
        lanes = len(next(iter(values.values())))
        start = np.repeat([[value] for value in self.reduction.start.values()], lanes, axis=1)
        run = runner(scan, kernels, threads=threads)
        state = run(parameters, inputs, start, steps=None if scan.inputs else steps).state
        return dict(zip(scan.state, state, strict=True))


def greatest(name: str, value: Node, start: float = -INFINITE) -> Reduction:
    """The greatest of all places; NaN where one is: such a mechanism is not clear."""
    return Reduction({name: as_node(m.max(value, variable(name)))}, {name: start})


def least(name: str, value: Node) -> Reduction:
    """The least of all places; NaN where one is."""
    return Reduction({name: as_node(m.min(value, variable(name)))}, {name: INFINITE})


def least_of(values: Sequence[Node]) -> Node:
    """The least of several; NaN where one is."""
    found = values[0]
    for value in values[1:]:
        found = as_node(m.min(found, value))
    return found
