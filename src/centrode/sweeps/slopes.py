"""Derivatives of what is reduced by the values that vary, as expressions: reverse mode through samples and folds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from centrode.algebra.expression_functions import EXPRESSIONS
from centrode.algebra.expressions import Node, Operand, as_node, variable
from centrode.algebra.gradients import gradient
from centrode.algebra.graphs import Graph, rebuilt
from centrode.algebra.reductions import Reduction
from centrode.kinematics.compiled.signs import Untraceable
from centrode.kinematics.compiled.traced import Traced
from centrode.kinematics.compiled.variables import Varied
from centrode.locale import mark
from centrode.structure.gearing import Straight
from centrode.sweeps.folds import Fold, Folds

Through: TypeAlias = Sequence[tuple[Node, Operand]]
"""The variables that a value moves, each with its derivative by that value."""

m = EXPRESSIONS


@dataclass(frozen=True)
class Slopes:
    """Derivatives by values at paths.

    Attributes
    ----------
    through : path -> the variables of the plan that it moves
    standing : name -> whole turns in angles, which jump and have no derivative; what is found by iteration
    folds : whose results have derivatives of their own, variables called by `by`
    """

    through: Mapping[str, Through]
    standing: Mapping[str, Node]
    folds: Folds

    @classmethod
    def of(cls, paths: Sequence[str], varied: Varied, traced: Traced, folds: Folds) -> Slopes:
        """Derivatives by all paths that vary. Raises Untraceable for one that moves more than is known here."""
        through = {path: _through(path, varied) for path in paths}
        return cls(through, traced.standing, folds)

    def of_node(self, node: Node) -> dict[str, Node]:
        """Path -> derivative of an expression, that of the folds it uses included."""
        standing = {node: variable(name) for name, node in self.standing.items()}
        still = rebuilt({"": node}, lambda x, _arguments: standing.get(x))[""]
        used = frozenset(Graph({"": still}).variables)
        names = [fold.name for fold in self.folds.found.values() if fold.name in used]
        moved = list(dict.fromkeys(x for path in self.through.values() for x, _factor in path))
        parts = gradient(still, [*moved, *map(variable, names)])
        partial = dict(zip(moved, parts, strict=False))
        of_folds = dict(zip(names, parts[len(moved) :], strict=True))
        found: dict[str, Operand] = {}
        for path, through in self.through.items():
            total: Operand = 0.0
            for x, factor in through:
                total = total + partial[x] * factor
            for name, part in of_folds.items():
                total = total + part * variable(by(name, path))
            found[path] = total
        return dict(Graph.of(found).substituted(self.standing).outputs)

    def of_fold(self, fold: Fold) -> Reduction:
        """The states of a fold's derivatives; at an extreme they are those of the first sample that has it."""
        so_far = variable(fold.name)
        better = m.less(fold.value, so_far) if fold.kind == "min" else m.less(so_far, fold.value)
        state = {}
        for path, part in self.of_node(fold.value).items():
            label = by(fold.name, path)
            more = variable(label) + part if fold.kind == "sum" else m.where(better, part, variable(label))
            state[label] = as_node(more)
        return Reduction(state, dict.fromkeys(state, 0.0))


def by(name: str, path: str) -> str:
    """Name of the derivative of a fold by the value at a path."""
    return f"{name} by {path}"


def _through(path: str, varied: Varied) -> Through:
    """The variables that the value at a path moves: itself, or cosine and sine of a direction."""
    if path in varied.names:
        return [(variable(path), 1.0)]
    directions = {f"guides.{guide}.direction": x for guide, x in varied.numbers.direction.items()}
    for wheel, track in varied.numbers.gearing.track.items():
        if isinstance(track, Straight):
            directions[f"rolling.{wheel}.along.direction"] = track.direction
    if path not in directions or not all(isinstance(x, Node) for x in directions[path]):
        raise Untraceable(mark("derivatives by what moves nothing"))
    cosine, sine = directions[path]
    return [(cosine, -sine), (sine, cosine)]
