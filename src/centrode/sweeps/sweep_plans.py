"""What a sweep computes of each mechanism: its plan, made ready once, and one block of mechanisms after another."""

from __future__ import annotations

import json
import math
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeAlias

import xarray as xr

from centrode.dynamics.reduction import REDUCED, check_reducible, reduction_of
from centrode.errors import InputError
from centrode.kinematics.motion import dataset_of
from centrode.kinematics.preparation import ready
from centrode.kinematics.solve import Solved, requested_grid, solve
from centrode.locale import _
from centrode.model.kept_values import KeptValues
from centrode.model.mechanism import Mechanism
from centrode.model.reading import nearest, value_text
from centrode.numerics import machine_code
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.executors import MACHINE_CODE, lacking_features
from centrode.numerics.machine_code.targets import TARGETS, compiling_for
from centrode.structure.dimensions import dimensions_of
from centrode.sweeps import designs
from centrode.sweeps.arrays import Results, SweepTask
from centrode.sweeps.designs import Design, unit_of
from centrode.sweeps.executors import Executor, executor_of
from centrode.sweeps.outputs import Outputs, Reduce, asked_of, with_slopes
from centrode.sweeps.result_columns import StreamedColumns
from centrode.sweeps.sample_tables import Tables
from centrode.sweeps.store import Blocks, MotionLabels, SweepFrame, Tally, frame_of, tally_of

Span: TypeAlias = tuple[Any, Any, Any]
"""Samples, start and stop, as they were given."""
Progress: TypeAlias = Callable[[int, int], None]

MOST_SAMPLES = 20_000
"""Samples of a sweep whose plan is kept for the next one."""
_plans: KeptValues[tuple[MotionLabels, SweepTask]] = KeptValues(16)


@dataclass(frozen=True)
class SweepPlan:
    """A sweep made ready.

    Attributes
    ----------
    task : what is computed of each mechanism
    executor : what computes it
    frame : dimensions and labels of the result
    target : the processor that kernels are compiled for; None for this machine's, or where nothing is compiled
    """

    task: SweepTask
    executor: Executor
    frame: SweepFrame
    target: str | None

    def compute(
        self, first: int, stop: int, results: StreamedColumns, progress: Callable[[int], None]
    ) -> Tally:
        """Fill in the columns of the mechanisms from `first` up to `stop`; returns what they come to."""
        task, lanes = self.task, self.executor.lanes(self.task)
        # parts that are solved together stay below the working set
        with compiling_for(self.target):
            for low in range(first, stop, lanes):
                high = min(low + lanes, stop)
                self._run(low, high, results.part(slice(low - first, high - first)))
                progress(high - first)
        return tally_of(task.asked, len(task.span.parameter), results)

    def _run(self, low: int, high: int, results: Results) -> None:
        values = self.frame.design.rows(low, high)
        numbers = dimensions_of(self.task.ready.mechanism, values, ARRAYS)
        self.executor.run(self.task, numbers, values, results)

    def seconds_each(self) -> float:
        """Seconds that one mechanism takes, measured on some of the first; what is done once does not count."""
        count, most = 1, min(self.frame.mechanisms, self.executor.lanes(self.task))
        with compiling_for(self.target):
            self._run(0, min(most, TRIED), self.frame.room(min(most, TRIED)))
            while True:
                count = min(most, count)
                room = self.frame.room(count)
                start = time.process_time()
                self._run(0, count, room)
                seconds = time.process_time() - start
                if seconds >= MEASURED or count == most:
                    return max(seconds, 1e-9) / count
                count *= 4


TRIED, MEASURED = 64, 0.05
"""Mechanisms for which kernels are made before time is taken; seconds after which a time counts."""


def plan_of(
    mechanism: Mechanism,
    design: Design,
    name: str,
    outputs: Outputs,
    reduce: Reduce,
    gradient: bool,
    tables: Tables,
    span: Span,
    threads: int = 1,
    target: str | None = None,
) -> SweepPlan:
    """The plan of a sweep; arguments as those of `sweep`, `name` that of the executor."""
    labels, task = _task_of(mechanism, design, outputs, reduce, gradient, tables, span, target)
    with compiling_for(target):
        chosen, told_of_it = executor_of(name, task, design, threads)
    units = {path: unit_of(mechanism, path) for path in design.paths}
    frame = frame_of(labels, design, units, task.asked, told_of_it)
    return SweepPlan(task, chosen, frame, target if chosen.name == MACHINE_CODE else None)


def check_target(target: object) -> str | None:
    """The name of a processor that this machine can stand for, or None; InputError for any other."""
    if target is None:
        return None
    if not isinstance(target, str) or target not in TARGETS:
        what = _("unknown processor {name}").format(name=value_text(target))
        raise InputError("target", what, nearest(str(target), TARGETS))
    lacking = lacking_features(target) if machine_code.PRESENT else ()
    if lacking:
        what = _("this machine cannot run code for {target}: it has no {features}")
        repair = _("name another processor: {names}").format(names=", ".join(TARGETS))
        raise InputError("target", what.format(target=target, features=", ".join(lacking)), repair)
    return target


def blocks_of(plan: SweepPlan) -> Blocks:
    """Blocks of a sweep in memory, whose result has its own room: by time alone."""
    return Blocks.of(plan.frame.design.shape, max(1, _most_by_time(plan)))


def stored_blocks_of(plan: SweepPlan) -> Blocks:
    """Blocks of a sweep into a store on this machine: positions by time, bytes by memory, the lesser of both."""
    return Blocks.of(plan.frame.design.shape, max(1, min(_most_by_time(plan), _most_by_bytes(plan))))


def measured_blocks_of(plan: SweepPlan) -> Blocks:
    """Blocks of a sweep on a cluster: some seconds of work each, but not too many; a power of two of mechanisms."""
    by_time = 2 ** max(0, math.floor(math.log2(designs.BLOCK_SECONDS / plan.seconds_each())))
    # so many that marks can be listed
    least = -(-plan.frame.mechanisms // designs.BLOCKS)
    return Blocks.of(plan.frame.design.shape, max(1, min(max(by_time, least), _most_by_bytes(plan))))


def _most_by_time(plan: SweepPlan) -> int:
    return plan.executor.blocks * designs.BLOCK_POSITIONS // plan.task.places


def _most_by_bytes(plan: SweepPlan) -> int:
    return designs.BLOCK_BYTES // max(1, sum(column.bytes for column in plan.task.asked.columns))


def _task_of(
    mechanism: Mechanism,
    design: Design,
    outputs: Outputs,
    reduce: Reduce,
    gradient: bool,
    tables: Tables,
    span: Span,
    target: str | None,
) -> tuple[MotionLabels, SweepTask]:
    """The labels of results, and the task; what was requested before is not made again."""

    def make() -> tuple[MotionLabels, SweepTask]:
        prepared = ready(mechanism)
        grid_of_samples = requested_grid(prepared, *span)
        # the description's own motion says what there is to name
        motion = motion_with_names(solve(prepared, grid_of_samples), f"{outputs} {reduce}")
        asked = asked_of(motion, design, outputs, reduce, tables)
        if gradient:
            asked = with_slopes(asked, len(design.paths))
        task = SweepTask(prepared, grid_of_samples, asked, design.paths)
        return MotionLabels.of(motion, asked), task

    # tables are compared by nobody; a long motion would stay in memory
    if tables is not None or not isinstance(span[0], int | None) or (span[0] or 0) > MOST_SAMPLES:
        return make()
    try:
        # as text whole numbers, numbers and truth values differ; kernels of another target are others
        key = json.dumps([list(design.paths), outputs, reduce, gradient, span, target])
    except (TypeError, ValueError):
        return make()
    return _plans.get(mechanism, key, make)


def motion_with_names(solved: Solved, words: str) -> xr.Dataset:
    """The description's own motion, with its reduction where words name a number of it."""
    motion = dataset_of(solved)
    # reductions are computed only where they are named: masses need not be complete otherwise
    if "reduced_" not in words:
        return motion
    check_reducible(solved)
    reduction = reduction_of(solved)
    return motion.assign({name: reduction[name] for name in REDUCED})
