"""Folds of traced formulas: what is reduced over samples becomes a state of a scan, and then a number of the mechanism.

A fold of what another fold gave (`max(abs(x - mean(x)))`) needs that one first: samples are passed once for each
depth of folds.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

from centrode.algebra.expression_functions import EXPRESSIONS, Expressions
from centrode.algebra.expressions import Node, Operand, as_node, variable
from centrode.algebra.graphs import Graph
from centrode.algebra.reductions import Reduction


@dataclass(frozen=True)
class Fold:
    """A fold: the name of its result, what is folded, and how often samples have been passed before."""

    name: str
    kind: str
    value: Node
    depth: int

    @property
    def state(self) -> Reduction:
        """Its state in a scan over samples; NaN at a sample makes the whole NaN."""
        m, so_far = EXPRESSIONS, variable(self.name)
        if self.kind == "sum":
            return Reduction({self.name: as_node(so_far + self.value)}, {self.name: 0.0})
        extreme, start = (m.min, math.inf) if self.kind == "min" else (m.max, -math.inf)
        return Reduction({self.name: as_node(extreme(self.value, so_far))}, {self.name: start})


@dataclass
class Folds(Expressions):
    """Namespace that traces formulas of so many samples; the folds they ask for are listed in `found`."""

    samples: int
    found: dict[tuple[str, bytes], Fold] = field(default_factory=dict)

    def fold(self, name: str, value: Operand) -> Operand:
        """The number that a fold of FOLDS gives."""
        if name == "range":
            return self.fold("max", value) - self.fold("min", value)
        if name == "mean":
            return self.fold("sum", value) / float(self.samples)
        node = as_node(value)
        key = name, node.key
        if key not in self.found:
            self.found[key] = Fold(f"fold {len(self.found)}", name, node, self._depth(node))
        return variable(self.found[key].name)

    def at_depth(self, depth: int) -> Sequence[Fold]:
        """The folds that need so many passes before their own."""
        return [fold for fold in self.found.values() if fold.depth == depth]

    @property
    def passes(self) -> int:
        """How often samples are passed, at least once."""
        return 1 + max((fold.depth for fold in self.found.values()), default=0)

    def _depth(self, node: Node) -> int:
        used = set(Graph({"": node}).variables)
        return 1 + max((fold.depth for fold in self.found.values() if fold.name in used), default=-1)
