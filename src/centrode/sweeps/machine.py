"""Sweeps as machine code: what has no events is computed by compiled kernels, the rest by the arrays.

A mechanism is judged on the mesh first, and again at its samples. Those that are clear have the status ok everywhere
and the formulas of `traced`; all others are computed as `ArraysExecutor` does it, so their statuses are the same.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from types import MappingProxyType
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
from centrode.algebra.scans import Scan
from centrode.errors import Status
from centrode.kinematics.compiled.beginnings import beginnings
from centrode.kinematics.compiled.judging import scan_of
from centrode.kinematics.compiled.signs import Untraceable
from centrode.kinematics.compiled.traced import traced
from centrode.kinematics.compiled.variables import PARAMETER, varied_of
from centrode.kinematics.compiled.walks import SURE, Walking
from centrode.kinematics.residuals import CLOSED
from centrode.locale import mark
from centrode.structure.dimensions import Dimensions
from centrode.sweeps import limits
from centrode.sweeps.arrays import ArraysExecutor, Task
from centrode.sweeps.designs import Rows
from centrode.sweeps.expressed import RESIDUAL, SLACK, Expressed

Array: TypeAlias = npt.NDArray[np.float64]
AnyArray: TypeAlias = npt.NDArray[Any]
Mask: TypeAlias = npt.NDArray[np.bool_]
Values: TypeAlias = dict[str, Array]

m = EXPRESSIONS

NUMBER = 8
"""Bytes of a float64."""
NOTHING_MORE: Mapping[str, Array] = MappingProxyType({})
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
            task, varied, traced(task.ready, task.span, varied, bool(task.asked.slopes)), kernels, threads
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
            written = self._walked if self.asked.traced.steps else self._written
            kernels = self._reduced if task.asked.reduced else written
            clear[at] = kernels(some, at, results)
        left = np.nonzero(~clear)[0]
        most = self.arrays.lanes(task)
        for first in range(0, len(left), most):
            some_lanes = left[first : first + most]
            self._on_arrays(some_lanes, numbers, values, results)

    def _on_arrays(
        self, lanes: npt.NDArray[np.intp], numbers: Dimensions, values: Rows, results: Mapping[str, AnyArray]
    ) -> None:
        taken = numbers.mapped(lambda x: x if isinstance(x, float) else x[lanes])
        rows = {path: np.asarray(x)[lanes] for path, x in values.items()}
        parts = {column.name: results[column.name][: len(lanes)].copy() for column in self.task.asked.columns}
        self.arrays.run(self.task, taken, rows, parts)
        for name, part in parts.items():
            results[name][lanes] = part

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
        return self._judged(rows, at, results)

    def _passed(self, depth: int, rows: Values, lanes: int) -> Values:
        """The states after a pass over the samples."""
        parts = [fold.state for fold in self.asked.folds.at_depth(depth)]
        if self.task.asked.slopes:
            parts += [self.asked.slopes.of_fold(fold) for fold in self.asked.folds.at_depth(depth)]
        if depth == 0:
            parts.append(_judging_states(self.asked.judges))
        reduction = together(*parts)
        if self.asked.traced.steps:
            walking = Walking(self.asked.judging.walk, reduction)
            return walking.reduced(self.asked.way, rows, self.kernels, self.threads)
        scan = scan_of(reduction, tuple(rows), tuple(self.asked.inputs))
        parameters = np.stack([rows[name] for name in scan.parameters]) if scan.parameters else None
        inputs = np.stack([self.asked.inputs[name] for name in scan.inputs]) if scan.inputs else None
        start = np.repeat([[value] for value in reduction.start.values()], lanes, axis=1)
        # nothing that moves: the samples are counted all the same
        steps = None if scan.inputs else len(self.task.span.parameter)
        state = runner(scan, self.kernels, threads=self.threads)(parameters, inputs, start, steps=steps).state
        return dict(zip(scan.state, state, strict=True))

    def _judged(self, found: Values, at: Any, results: Mapping[str, AnyArray]) -> Mask:
        """Fill in what is said of every mechanism; returns which of them are clear at their samples too."""
        results["samples_ok"][at] = len(self.task.span.parameter)
        results["worst_residual"][at] = found[RESIDUAL]
        clear: Mask = found[RESIDUAL] <= 0.5 * CLOSED
        for slack in {SLACK, SURE} & found.keys():
            clear &= found[slack] > 0.0
        return clear

    # every sample

    @cached_property
    def _outputs(self) -> dict[str, Node]:
        """All that is written, and what samples are judged by."""
        outputs = {
            f"{name} {k}": node for name, nodes in self.asked.columns.items() for k, node in enumerate(nodes)
        }
        return outputs | self.asked.judges

    @cached_property
    def _written_scan(self) -> Scan:
        """Lanes are samples, steps are mechanisms: every output is written as one stream."""
        outputs = self._outputs
        used = Graph(outputs).variables
        along = tuple(name for name in self.asked.inputs if name in used or name == PARAMETER)
        return Scan(along, tuple(name for name in used if name not in along), outputs)

    def _written(self, rows: Values, at: Any, results: Mapping[str, AnyArray]) -> Mask:
        """Fill in every sample of the mechanisms at some places; returns which of them stay clear."""
        scan, samples = self._written_scan, len(self.task.span.parameter)
        lanes = len(next(iter(rows.values())))
        places = np.arange(len(results["samples_ok"]))[at]
        along = np.stack([self.asked.inputs[name] for name in scan.parameters])
        steps = max(1, limits.KERNEL_BUFFER // (NUMBER * len(scan.outputs) * samples))
        buffer = np.empty((len(scan.outputs), min(steps, lanes), samples))
        clear = np.empty(lanes, dtype=bool)
        run = runner(scan, self.kernels, lanes_inside=True, threads=self.threads)
        for first in range(0, lanes, steps):
            part = slice(first, min(first + steps, lanes))
            inputs = np.stack([rows[name][part] for name in scan.inputs]) if scan.inputs else None
            out = buffer[:, : part.stop - first]
            run(along, inputs, out=out, steps=part.stop - first)
            clear[part] = self._kept(out, places[part], results)
        results["status"][at] = Status.OK
        return clear

    def _walked(self, rows: Values, at: Any, results: Mapping[str, AnyArray]) -> Mask:
        """The same where every place is found from the one before: lanes are mechanisms."""
        outputs = self._outputs
        walking = Walking(self.asked.judging.walk, outputs=outputs)
        lanes, samples = len(next(iter(rows.values()))), len(self.task.span.parameter)
        places = np.arange(len(results["samples_ok"]))[at]
        most = max(1, limits.KERNEL_BUFFER // (NUMBER * len(outputs) * samples))
        clear = np.empty(lanes, dtype=bool)
        for first in range(0, lanes, most):
            part = slice(first, min(first + most, lanes))
            some = {name: row[part] for name, row in rows.items()}
            out = np.empty((len(outputs), part.stop - first, samples))
            state = walking.written(self.asked.way, some, self.kernels, self.threads, out)
            clear[part] = self._kept(out, places[part], results, {SURE: state[SURE]})
        results["status"][at] = Status.OK
        return clear

    def _kept(
        self,
        out: Array,
        places: npt.NDArray[np.intp],
        results: Mapping[str, AnyArray],
        sure: Mapping[str, Array] = NOTHING_MORE,
    ) -> Mask:
        """Take the outputs of some mechanisms from the buffer: (outputs, mechanisms, samples)."""
        whole = slice(int(places[0]), int(places[-1]) + 1)
        where: Any = whole if whole.stop - whole.start == len(places) else places
        row = 0
        for name, nodes in self.asked.columns.items():
            target = results[name].reshape(*results[name].shape[:2], len(nodes))
            for k in range(len(nodes)):
                target[where, :, k] = out[row]
                row += 1
        found = {RESIDUAL: out[row].max(axis=1)}
        if SLACK in self.asked.judges:
            found[SLACK] = out[row + 1].min(axis=1)
        return self._judged(found | dict(sure), where, results)


def _judging_states(judges: Mapping[str, Node]) -> Reduction:
    """Greatest residual, least slack; NaN where one is."""
    state = {RESIDUAL: as_node(m.max(judges[RESIDUAL], variable(RESIDUAL)))}
    start = {RESIDUAL: 0.0}
    if SLACK in judges:
        state[SLACK] = as_node(m.min(judges[SLACK], variable(SLACK)))
        start[SLACK] = np.inf
    return Reduction(state, start)
