"""What a sweep is asked for as expressions: columns of a sample, or of folds over samples, and derivatives."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.expressions import Node, as_node, variable
from centrode.algebra.graphs import Graph
from centrode.kinematics.compiled.event_screening import EventScreening
from centrode.kinematics.compiled.path_following import Walk, Way, way_of
from centrode.kinematics.compiled.trace import Traced
from centrode.kinematics.compiled.variables import (
    ALONG,
    SCALE,
    Varied,
    before_of,
    boxed,
    centre_of,
    inputs_of,
)
from centrode.sweeps.arrays import Task
from centrode.sweeps.folds import Folds
from centrode.sweeps.slopes import Slopes

Array: TypeAlias = npt.NDArray[np.float64]
Values: TypeAlias = dict[str, Array]

RESIDUAL, SLACK = "worst residual", "slack at samples"


@dataclass(frozen=True)
class Expressed:
    """A task as expressions.

    Attributes
    ----------
    varied : the numbers that vary as variables
    traced : the motion at one sample
    kernels : what runs scans, see `algebra.executors`
    threads : that share the mechanisms
    """

    task: Task
    varied: Varied
    traced: Traced
    kernels: str
    threads: int

    @cached_property
    def folds(self) -> Folds:
        """What is folded over samples, once `columns` are known."""
        return Folds(len(self.task.span.parameter))

    @cached_property
    def columns(self) -> dict[str, list[Node]]:
        """Column -> its numbers: of a sample, or reduced."""
        asked, solved = self.task.asked, self.traced.solved
        given = {path: boxed([variable(path)]) for path in self.task.paths}
        if asked.formulas:
            return {
                formula.name: [as_node(formula.traced(self.folds, solved, given))]
                for formula in asked.formulas
            }
        found = {output.name: output.of(solved, given).ravel().tolist() for output in asked.outputs}
        if asked.reduction is None:
            return {name: [as_node(x) for x in nodes] for name, nodes in found.items()}
        return {
            name: [as_node(self.folds.fold(asked.reduction, x)) for x in nodes]
            for name, nodes in found.items()
        }

    @cached_property
    def outputs(self) -> dict[str, Node]:
        """All numbers of a sample, column by column."""
        return {f"{name} {k}": node for name, nodes in self.columns.items() for k, node in enumerate(nodes)}

    @cached_property
    def slopes(self) -> Slopes:
        """How derivatives are found. Raises Untraceable."""
        return Slopes.of(self.task.paths, self.varied, self.traced, self.folds, self._moving)

    @property
    def _moving(self) -> frozenset[str]:
        """Variables that differ from sample to sample."""
        walked = Walk(self.traced, tuple(self.traced.turning)).state if self.traced.steps else ()
        return frozenset([*self.inputs, *ALONG, *walked])

    @cached_property
    def final(self) -> dict[str, list[Node]]:
        """Reduced columns, and those of derivatives, from the folds."""
        found = dict(self.columns)
        for name, slope in self.task.asked.slopes.items():
            found[slope] = [x for node in found[name] for x in self.slopes.of_node(node).values()]
        return found

    @cached_property
    def judging(self) -> EventScreening:
        """How mechanisms are judged before."""
        residual = as_node(self.traced.solved.residual[0, 0])
        nodes = [node for column in self.columns.values() for node in column]
        nodes += [fold.value for fold in self.folds.found.values()]
        used = frozenset(Graph({str(k): node for k, node in enumerate([*nodes, residual])}).variables)
        told_by = before_of if self.traced.steps else centre_of
        links = tuple(link for link in self.traced.turning if told_by(link) in used)
        names = tuple(dict.fromkeys([*self.varied.names, SCALE]))
        return EventScreening(self.traced, self.task.span.parameter, names, links, self.kernels, self.threads)

    @cached_property
    def judges(self) -> dict[str, Node]:
        """What is looked at in every sample: greatest residual, least slack of radicands."""
        found = {RESIDUAL: as_node(self.traced.solved.residual[0, 0])}
        slack = self.judging.slack_at_samples
        return found if slack is None else {**found, SLACK: slack}

    @property
    def samples(self) -> int:
        """How many there are."""
        return len(self.task.span.parameter)

    @cached_property
    def inputs(self) -> Values:
        """What the variables of a place stand for at the samples."""
        return inputs_of(self.task.ready.kinematics.path, self.task.span)

    @cached_property
    def way(self) -> Way:
        """The way past all samples, where there are groups of higher class."""
        return way_of(self.task.ready.kinematics.path, self.inputs)

    @property
    def states(self) -> int:
        """Numbers of one mechanism while samples are passed."""
        folds = len(self.folds.found) if self.columns else 0
        if self.task.asked.slopes:
            folds += sum(len(self.slopes.states_of(fold.name).parts) for fold in self.folds.found.values())
        angles = 10 * len(self.judging.links)
        walked = 2 * len(self.judging.walk.state) if self.traced.steps else 0
        return len(self.varied.names) + folds + angles + walked + 2 * len(self.traced.radicands) + 2
