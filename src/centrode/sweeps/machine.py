"""Sweeps as machine code: what has no events is computed in one go, the rest as motions with events.

A mechanism is judged on the mesh first, and again at its samples. Those that are clear have the status ok everywhere
and the formulas of `traced`. The motions of all others have the bits of the arrays (`compiled.events`; with groups of
higher class they are computed by arrays), and what is asked for is taken from them as `ArraysExecutor` does it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra import machine_code
from centrode.algebra.executors import MACHINE_CODE
from centrode.algebra.graph_arrays import evaluate
from centrode.algebra.graphs import Graph
from centrode.algebra.reductions import Reduction, together
from centrode.errors import Status
from centrode.kinematics.compiled.events import Eventful
from centrode.kinematics.compiled.path_following import SURE, beginnings
from centrode.kinematics.compiled.trace import Untraceable, traced
from centrode.kinematics.compiled.variables import taken, varied_of
from centrode.kinematics.sampling import CLOSED
from centrode.locale import mark
from centrode.structure.dimensions import Dimensions
from centrode.sweeps import limits
from centrode.sweeps.arrays import NUMBER, ArraysExecutor, Task, fill_columns
from centrode.sweeps.designs import Rows
from centrode.sweeps.every_sample import EverySample
from centrode.sweeps.expressed import RESIDUAL, SLACK, Expressed
from centrode.sweeps.passing import Passing, judging_states, passing_of
from centrode.sweeps.streams import Columns, columns_for

Array: TypeAlias = npt.NDArray[np.float64]
AnyArray: TypeAlias = npt.NDArray[Any]
Mask: TypeAlias = npt.NDArray[np.bool_]
Lanes: TypeAlias = npt.NDArray[np.intp]
Values: TypeAlias = dict[str, Array]

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
        asked = Expressed(
            task,
            varied,
            traced(task.ready, task.span, varied, differentiable=bool(task.asked.slopes)),
            kernels,
            threads,
        )
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
        if self.asked.traced.steps:
            rows |= beginnings(task.ready, numbers, len(next(iter(rows.values()))))
        judged = self.asked.judging.judge(rows)
        rows |= judged.values
        clear = judged.clear.copy()
        if clear.any():
            everywhere = bool(clear.all())
            at: Any = slice(None) if everywhere else np.nonzero(clear)[0]
            some = rows if everywhere else {name: row[at] for name, row in rows.items()}
            clear[at] = self._without_events(some, at, results)
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

    # without events

    @cached_property
    def _passing(self) -> Passing:
        return passing_of(self.asked)

    def _without_events(self, rows: Values, at: Any, results: Mapping[str, AnyArray]) -> Mask:
        """Fill in clear mechanisms; returns which of them stay clear at their samples too."""
        found = (
            self._reduced(rows, at, results) if self.task.asked.reduced else self._written(rows, at, results)
        )
        results["samples_ok"][at] = self.asked.samples
        results["worst_residual"][at] = found[RESIDUAL]
        clear: Mask = found[RESIDUAL] <= 0.5 * CLOSED
        for slack in {SLACK, SURE} & found.keys():
            clear &= found[slack] > 0.0
        return clear

    def _reduced(self, rows: Values, at: Any, results: Mapping[str, AnyArray]) -> Values:
        """Fill in one number, or a few, of each motion; returns what mechanisms are judged by."""
        rows = dict(rows)
        columns = self.asked.final
        for depth in range(self.asked.folds.passes):
            rows |= self._passing.reduced(self._states(depth), rows)
        nodes = {f"{name} {k}": node for name, nodes in columns.items() for k, node in enumerate(nodes)}
        found = evaluate(Graph(nodes), rows)
        for name, numbers in columns.items():
            flat = results[name].reshape(len(results[name]), len(numbers))
            for k in range(len(numbers)):
                flat[at, k] = found[f"{name} {k}"]
        return rows

    def _states(self, depth: int) -> Reduction:
        """What is handed on in a pass over the samples."""
        folds = self.asked.folds.at_depth(depth)
        parts = [fold.state for fold in folds]
        if self.task.asked.slopes:
            parts += [self.asked.slopes.of_fold(fold) for fold in folds]
        if depth == 0:
            parts.append(judging_states(self.asked))
        return together(*parts)

    def _written(self, rows: Values, at: Any, results: Mapping[str, AnyArray]) -> Values:
        """Fill in every sample of the motions; returns what mechanisms are judged by."""
        results["status"][at] = Status.OK
        every = EverySample(self.asked.columns, results, at, self.asked.samples)
        return self._passing.written(rows, every.rooms())


def _rows_at(values: Rows, lanes: Lanes) -> Rows:
    return {path: np.asarray(x)[lanes] for path, x in values.items()}


def _put(parts: Columns, lanes: Lanes, results: Mapping[str, AnyArray]) -> None:
    for name, part in parts.items():
        results[name][lanes] = part
