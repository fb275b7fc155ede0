"""Sweeps as machine code: what has no events is computed in one go, the rest as motions with events.

A mechanism is judged on the mesh first, and again at its samples. Those that are clear have the status ok everywhere
and the formulas of `trace_motion`. The motions of all others have the bits of the arrays (`machine_code.events`; with
groups of higher class they are computed by arrays), and what is requested is taken from them as `ArraysExecutor` does.
"""

from __future__ import annotations

import threading
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.errors import Status
from centrode.kinematics.machine_code.events import Eventful
from centrode.kinematics.machine_code.path_continuation import SURE, beginnings
from centrode.kinematics.machine_code.trace import Untraceable, trace_motion
from centrode.kinematics.machine_code.variables import (
    LaneRows,
    Pass,
    take_lanes,
    varied_of,
)
from centrode.kinematics.samples import CLOSED
from centrode.locale import mark
from centrode.numerics import machine_code
from centrode.numerics.executors import MACHINE_CODE
from centrode.numerics.graphs import Graph
from centrode.numerics.scans import Reduction, evaluate, together
from centrode.structure.dimensions import Dimensions
from centrode.sweeps import designs
from centrode.sweeps.arrays import NUMBER, ArraysExecutor, SweepTask, fill_columns
from centrode.sweeps.designs import Rows
from centrode.sweeps.result_columns import EverySample, StreamedColumns, columns_for
from centrode.sweeps.traced_sweep import (
    END,
    RESIDUAL,
    SLACK,
    Expressed,
    Passing,
    Reducing,
    judging_states,
    passing_of,
)

Array: TypeAlias = npt.NDArray[np.float64]
Values: TypeAlias = dict[str, Array]
AnyArray: TypeAlias = npt.NDArray[Any]
Mask: TypeAlias = npt.NDArray[np.bool_]
Lanes: TypeAlias = npt.NDArray[np.intp]

WORTH_A_KERNEL = 2_000_000
"""Operations on numbers from which on what is left to do at the end is worth compiling."""
COPIES = 4
"""Of what a mechanism has while samples are passed: before, after, as kernels are given it."""


@dataclass(frozen=True)
class MachineCodeExecutor:
    """Compiled kernels of one task.

    Attributes
    ----------
    task : what is computed
    asked : the outputs as expressions
    threads : that share the mechanisms
    kernels : "machine code"; "arrays" runs the same scans on NumPy
    """

    task: SweepTask
    asked: Expressed
    threads: int
    kernels: str
    _foldings: dict[tuple[int, bool], Reducing] = field(default_factory=dict)
    _one_at_a_time: threading.Lock = field(default_factory=threading.Lock)
    blocks = designs.BLOCKS_OF_KERNELS
    arrays = ArraysExecutor()

    @property
    def name(self) -> str:
        return self.kernels

    @classmethod
    def of(
        cls, task: SweepTask, numbers: Dimensions, values: Rows, threads: int = 1, kernels: str = MACHINE_CODE
    ) -> MachineCodeExecutor:
        """The executor of a task; the numbers of one mechanism or more say what varies.

        Raises Untraceable, with a reason for the user.
        """
        # reported before anything is traced
        check_present(kernels)
        varied = varied_of(numbers, values).with_traced_scale()
        asked = Expressed(
            task,
            varied,
            trace_motion(task.ready, task.span, varied, differentiable=bool(task.asked.slopes)),
            kernels,
            threads,
        )
        if task.asked.slopes:
            _ = asked.slopes  # what cannot be differentiated is told before anything is computed
        return cls(task, asked, threads, kernels)

    def lanes(self, task: SweepTask) -> int:
        """Number of mechanisms computed together."""
        # a mechanism that is written takes the room of its columns beside its states
        written = 0 if task.asked.is_reduced else sum(column.bytes for column in task.asked.columns)
        return max(
            1,
            min(designs.KERNEL_LANES, designs.WORKING_SET // (COPIES * NUMBER * self.asked.states + written)),
        )

    def run(
        self, task: SweepTask, numbers: Dimensions, values: Rows, results: Mapping[str, AnyArray]
    ) -> None:
        """Fill in all columns for the mechanisms of these dimensions."""
        known = self.asked.varied.values(numbers) | {path: np.asarray(x) for path, x in values.items()}
        if self.asked.traced.steps:
            known |= beginnings(task.ready, numbers, len(next(iter(known.values()))))
        rows = LaneRows.of(known | self.asked.functions(known), self._spare)
        judged = self.asked.judging.judge(rows)
        rows = rows | judged.values
        # mechanisms that turn out doubtful at a sample are taken out again below
        clear = judged.clear.copy()
        # every sample that is kept has its residual judged; of reduced ones that are certain a few do
        certain = judged.certain if self.task.asked.is_reduced else np.zeros_like(clear)
        for which, sure in ((certain, True), (judged.clear & ~certain, False)):
            if which.any():
                everywhere = bool(which.all())
                at: Any = slice(None) if everywhere else np.nonzero(which)[0]
                some = rows if everywhere else rows.take(at)
                clear[at] = self._without_events(some, at, results, sure)
        left = np.nonzero(~clear)[0]
        if not len(left):
            return
        # few mechanisms with events are not worth a kernel of their own
        worth = len(left) * task.places >= designs.WORTH_COMPILING and self.kernels == MACHINE_CODE
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
        # an executor is kept, so two sweeps may share it; what is written for one part is overwritten by the next
        with self._one_at_a_time:
            for lanes, solved in self._eventful.solve_lanes(numbers, left):
                parts = self._room(len(lanes))
                fill_columns(self.task, solved, _rows_at(values, lanes), parts)
                _put_columns(parts, lanes, results)

    def _on_arrays(
        self, left: Lanes, numbers: Dimensions, values: Rows, results: Mapping[str, AnyArray]
    ) -> None:
        """Fill in mechanisms that have events by arrays alone: for a few of them nothing is compiled."""
        most = self.arrays.lanes(self.task)
        for first in range(0, len(left), most):
            lanes = left[first : first + most]
            parts = self._room(len(lanes))
            self.arrays.run(self.task, take_lanes(numbers, lanes), _rows_at(values, lanes), parts)
            _put_columns(parts, lanes, results)

    def _room(self, lanes: int) -> StreamedColumns:
        """Columns of mechanisms that do not stand side by side."""
        return columns_for(self.task.asked.columns, lanes)

    # without events

    @cached_property
    def _passing(self) -> Passing:
        return passing_of(self.asked)

    def _without_events(
        self, rows: LaneRows, at: Any, results: Mapping[str, AnyArray], certain: bool
    ) -> Mask:
        """Fill in clear mechanisms; returns which of them stay clear at their samples too."""
        states = (
            self._fill_reductions(rows, at, results, certain)
            if self.task.asked.is_reduced
            else self._fill_samples(rows, at, results)
        )
        results["samples_ok"][at] = self.asked.samples
        results["worst_residual"][at] = states[RESIDUAL]
        # a kernel may round a residual otherwise: half of the bound is kept free, and what lies in it goes to
        # the arrays
        clear: Mask = states[RESIDUAL] <= 0.5 * CLOSED
        for slack in {SLACK, SURE} & states.keys():
            clear &= states[slack] > 0.0
        return clear

    def _fill_reductions(
        self, rows: LaneRows, at: Any, results: Mapping[str, AnyArray], certain: bool
    ) -> LaneRows:
        """Fill in one number, or a few, of each motion; returns what is known of mechanisms then."""
        columns = self.asked.final
        # folds of folds: each pass knows the results of those before
        for depth in range(self.asked.folds.passes):
            rows = self._folding(depth, certain)(rows)
            rows = rows | self.asked.inputs_at_extremes(rows, depth)
        if certain:
            rows = rows | self.asked.check_some(rows)
        values = self._at_end(rows)
        for name, numbers in columns.items():
            flat = results[name].reshape(len(results[name]), len(numbers))
            for k in range(len(numbers)):
                flat[at, k] = values[f"{END}{name} {k}"]
        return rows

    def _at_end(self, rows: LaneRows) -> Values:
        """The numbers of all columns from the last states; by a kernel where that is worth compiling."""
        graph, lanes = self._ends, len(next(iter(rows.values())))
        if lanes * len(graph.order) < WORTH_A_KERNEL:
            return evaluate(graph, rows)
        return self._at_once.run(rows, self.kernels, self.threads)

    @cached_property
    def _at_once(self) -> Pass:
        outputs = self._ends.outputs
        return Pass(Reduction(outputs, dict.fromkeys(outputs, 0.0)), self.asked.names, {})

    @cached_property
    def _ends(self) -> Graph:
        columns = self.asked.final.items()
        return Graph({f"{END}{name} {k}": node for name, nodes in columns for k, node in enumerate(nodes)})

    def _folding(self, depth: int, certain: bool) -> Reducing:
        """One of the passes over the samples; the same for all batches."""
        key = depth, certain
        if key not in self._foldings:
            self._foldings[key] = self._passing.reducer_of(self._states(depth, certain))
        return self._foldings[key]

    @cached_property
    def _spare(self) -> int:
        """Rows that passes over the samples add to what is known of mechanisms."""
        if not self.asked.columns:
            return 0
        return sum(len(self._states(depth, False).state) for depth in range(self.asked.folds.passes))

    def _states(self, depth: int, certain: bool) -> Reduction:
        """States handed on in a pass over the samples."""
        folds = self.asked.folds.at_depth(depth)
        parts = [fold.state for fold in folds]
        if self.task.asked.slopes:
            parts += [self.asked.slopes.of_fold(fold) for fold in folds]
        # judging is done with the first pass; what is certain has no sample to be judged
        if depth == 0 and not certain:
            parts.append(judging_states(self.asked))
        return together(*parts)

    def _fill_samples(self, rows: LaneRows, at: Any, results: Mapping[str, AnyArray]) -> Mapping[str, Array]:
        """Fill in every sample of the motions; returns what mechanisms are judged by."""
        results["status"][at] = Status.OK
        # formulas of every sample may name what is folded
        if self.asked.final or self.asked.folds.found:
            rows = self._fill_reductions(rows, at, results, certain=False)
            # what is written is judged as it is written
            judged = {RESIDUAL, SLACK, SURE}
            rows = replace(rows, more={name: row for name, row in rows.more.items() if name not in judged})
        every = EverySample(
            self.asked.written_columns, results, at, self.asked.samples, self._passing.fixed_numbers
        )
        return self._passing.write_samples(rows, every.rooms())


def check_present(kernels: str) -> None:
    """Raise Untraceable where machine code is requested and llvmlite is not installed."""
    if kernels == MACHINE_CODE and not machine_code.PRESENT:
        raise Untraceable(mark("llvmlite is not installed"))


def _rows_at(values: Rows, lanes: Lanes) -> Rows:
    return {path: np.asarray(x)[lanes] for path, x in values.items()}


def _put_columns(parts: StreamedColumns, lanes: Lanes, results: Mapping[str, AnyArray]) -> None:
    for name, part in parts.items():
        results[name][lanes] = part
