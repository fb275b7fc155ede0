"""Sweeps as machine code: what has no events is computed in one go, the rest as motions with events.

A mechanism is judged on the mesh first, and again at its samples. Those that are clear have the status ok everywhere
and the formulas of `traced`; the motions of all others have the bits of the arrays (`compiled.eventful`), and what is
asked for is taken from them as `ArraysExecutor` does it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra import machine_code
from centrode.algebra.executors import MACHINE_CODE, runner
from centrode.algebra.expression_functions import EXPRESSIONS
from centrode.algebra.expressions import Node, as_node, variable
from centrode.algebra.graph_arrays import evaluate
from centrode.algebra.graphs import Graph
from centrode.algebra.reductions import Reduction, together
from centrode.errors import Status
from centrode.kinematics.compiled.eventful import Eventful
from centrode.kinematics.compiled.judging import scan_of
from centrode.kinematics.compiled.traced import Untraceable, traced
from centrode.kinematics.compiled.variables import taken, varied_of
from centrode.kinematics.residuals import CLOSED
from centrode.locale import mark
from centrode.structure.dimensions import Dimensions
from centrode.sweeps import limits
from centrode.sweeps.arrays import ArraysExecutor, Task, fill_columns
from centrode.sweeps.designs import Rows
from centrode.sweeps.every_sample import NUMBER, EverySample
from centrode.sweeps.expressed import RESIDUAL, SLACK, Expressed
from centrode.sweeps.streams import Columns, columns_for

Array: TypeAlias = npt.NDArray[np.float64]
AnyArray: TypeAlias = npt.NDArray[Any]
Mask: TypeAlias = npt.NDArray[np.bool_]
Lanes: TypeAlias = npt.NDArray[np.intp]
Values: TypeAlias = dict[str, Array]

m = EXPRESSIONS
COPIES = 4
"""Of what a mechanism has while samples are passed: before, after, as kernels are given it."""


@dataclass(frozen=True)
class MachineCodeExecutor:
    """Compiled kernels of one task.

    Attributes
    ----------
    task : what is computed
    asked : the same as expressions
    threads : that share the mechanisms
    kernels : "machine code"; "arrays" runs the same scans on NumPy
    """

    task: Task
    asked: Expressed
    threads: int
    kernels: str
    blocks = limits.BLOCKS_OF_KERNELS
    arrays = ArraysExecutor()

    @property
    def name(self) -> str:
        return self.kernels

    @classmethod
    def of(
        cls, task: Task, numbers: Dimensions, values: Rows, threads: int = 1, kernels: str = MACHINE_CODE
    ) -> MachineCodeExecutor:
        """The executor of a task; the numbers of one mechanism or more say what varies.

        Raises Untraceable, with a reason that is told.
        """
        if kernels == MACHINE_CODE and not machine_code.PRESENT:
            raise Untraceable(mark("llvmlite is not installed"))
        varied = varied_of(numbers, values)
        asked = Expressed(task, varied, traced(task.ready, task.span, varied), kernels, threads)
        if task.asked.slopes:
            _ = asked.slopes  # what cannot be differentiated is told before anything is computed
        return cls(task, asked, threads, kernels)

    def lanes(self, task: Task) -> int:
        """How many mechanisms are computed together."""
        written = 0 if task.asked.reduced else sum(column.bytes for column in task.asked.columns)
        return max(
            1, min(limits.KERNEL_LANES, limits.WORKING_SET // (COPIES * NUMBER * self.asked.states + written))
        )

    def run(self, task: Task, numbers: Dimensions, values: Rows, results: Mapping[str, AnyArray]) -> None:
        """Fill in all columns for the mechanisms of these dimensions."""
        rows = self.asked.varied.values(numbers) | {path: np.asarray(x) for path, x in values.items()}
        judged = self.asked.judging.judge(rows)
        rows |= judged.values
        clear = judged.clear.copy()
        if clear.any():
            everywhere = bool(clear.all())
            at: Any = slice(None) if everywhere else np.nonzero(clear)[0]
            some = rows if everywhere else {name: row[at] for name, row in rows.items()}
            kernels = self._reduced if task.asked.reduced else self._written
            clear[at] = kernels(some, at, results)
        left = np.nonzero(~clear)[0]
        worth = len(left) * task.places >= limits.WORTH_COMPILING and self.kernels == MACHINE_CODE
        if worth and self._eventful.possible:
            self._with_events(left, numbers, values, results)
        else:
            self._on_arrays(left, numbers, values, results)

    @cached_property
    def _eventful(self) -> Eventful:
        task, asked = self.task, self.asked
        return Eventful(task.ready, task.span, asked.varied, asked.traced, self.kernels, self.threads)

    def _with_events(
        self, left: Lanes, numbers: Dimensions, values: Rows, results: Mapping[str, AnyArray]
    ) -> None:
        """Fill in the mechanisms that have events: their motions as machine code, columns as by arrays."""
        for lanes, solved in self._eventful.solved(numbers, left):
            parts = self._room(len(lanes))
            fill_columns(self.task, solved, _rows_at(values, lanes), parts)
            _put(parts, lanes, results)

    def _on_arrays(
        self, left: Lanes, numbers: Dimensions, values: Rows, results: Mapping[str, AnyArray]
    ) -> None:
        """The same for few of them, by arrays alone."""
        most = self.arrays.lanes(self.task)
        for first in range(0, len(left), most):
            lanes = left[first : first + most]
            parts = self._room(len(lanes))
            self.arrays.run(self.task, taken(numbers, lanes), _rows_at(values, lanes), parts)
            _put(parts, lanes, results)

    def _room(self, lanes: int) -> Columns:
        """Columns of mechanisms that do not stand side by side."""
        return columns_for(self.task.asked.columns, lanes)

    # one number a motion

    def _reduced(self, rows: Values, at: Any, results: Mapping[str, AnyArray]) -> Mask:
        """Fill in what is reduced for the mechanisms at some places; returns which of them stay clear."""
        lanes = len(next(iter(rows.values())))
        rows = dict(rows)
        columns = self.asked.final
        for depth in range(self.asked.folds.passes):
            rows |= self._passed(depth, rows, lanes)
        graph = Graph(
            {f"{name} {k}": node for name, nodes in columns.items() for k, node in enumerate(nodes)}
        )
        found = evaluate(graph, rows)
        for name, nodes in columns.items():
            flat = results[name].reshape(len(results[name]), len(nodes))
            for k in range(len(nodes)):
                flat[at, k] = found[f"{name} {k}"]
        return self._judged(rows[RESIDUAL], rows.get(SLACK), at, results)

    def _passed(self, depth: int, rows: Values, lanes: int) -> Values:
        """The states after a pass over the samples."""
        parts = [fold.state for fold in self.asked.folds.at_depth(depth)]
        if self.task.asked.slopes:
            parts += [self.asked.slopes.of_fold(fold) for fold in self.asked.folds.at_depth(depth)]
        if depth == 0:
            parts.append(_judging_states(self.asked.judges))
        return self._states(parts, rows, lanes)

    def _states(self, parts: Sequence[Reduction], rows: Values, lanes: int) -> Values:
        reduction = together(*parts)
        scan = scan_of(reduction, tuple(rows), tuple(self.asked.inputs))
        parameters = np.stack([rows[name] for name in scan.parameters]) if scan.parameters else None
        inputs = np.stack([self.asked.inputs[name] for name in scan.inputs]) if scan.inputs else None
        start = np.repeat([[value] for value in reduction.start.values()], lanes, axis=1)
        # nothing that moves: the samples are counted all the same
        steps = None if scan.inputs else len(self.task.span.parameter)
        state = runner(scan, self.kernels, threads=self.threads)(parameters, inputs, start, steps=steps).state
        return dict(zip(scan.state, state, strict=True))

    def _judged(self, residual: Array, slack: Array | None, at: Any, results: Mapping[str, AnyArray]) -> Mask:
        """Fill in what is said of every mechanism."""
        results["samples_ok"][at] = len(self.task.span.parameter)
        results["worst_residual"][at] = residual
        closed: Mask = residual <= 0.5 * CLOSED
        return closed if slack is None else closed & (slack > 0.0)

    # every sample

    @cached_property
    def _samples(self) -> EverySample:
        return EverySample(self.asked, self.kernels, self.threads)

    def _written(self, rows: Values, at: Any, results: Mapping[str, AnyArray]) -> Mask:
        """Fill in every sample of the mechanisms at some places; returns which of them stay clear."""
        lanes = len(next(iter(rows.values())))
        streams = results.streams if isinstance(results, Columns) else None
        if streams is not None and isinstance(at, slice):
            self._samples.write(rows, streams)
        else:
            self._samples.put(rows, np.arange(len(results["samples_ok"]))[at], results)
        results["status"][at] = Status.OK
        states = self._states([_judging_states(self.asked.judges)], rows, lanes)
        return self._judged(states[RESIDUAL], states.get(SLACK), at, results)


def _judging_states(judges: Mapping[str, Node]) -> Reduction:
    """Greatest residual, least slack; NaN where one is."""
    state = {RESIDUAL: as_node(m.max(judges[RESIDUAL], variable(RESIDUAL)))}
    start = {RESIDUAL: 0.0}
    if SLACK in judges:
        state[SLACK] = as_node(m.min(judges[SLACK], variable(SLACK)))
        start[SLACK] = np.inf
    return Reduction(state, start)


def _rows_at(values: Rows, lanes: Lanes) -> Rows:
    return {path: np.asarray(x)[lanes] for path, x in values.items()}


def _put(parts: Columns, lanes: Lanes, results: Mapping[str, AnyArray]) -> None:
    for name, part in parts.items():
        results[name][lanes] = part
