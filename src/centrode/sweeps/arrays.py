"""Sweeps on NumPy arrays, and the job of every executor: the motions of some mechanisms, column by column."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.errors import Status
from centrode.kinematics.mesh import mesh_of
from centrode.kinematics.path import SampleGrid
from centrode.kinematics.plan_evaluation import layout_of
from centrode.kinematics.preparation import Ready
from centrode.kinematics.solve import Solved, solve
from centrode.structure.dimensions import Dimensions
from centrode.structure.groups import Newton
from centrode.sweeps import designs
from centrode.sweeps.designs import Rows
from centrode.sweeps.outputs import SweepOutputs

AnyArray: TypeAlias = npt.NDArray[Any]
Results: TypeAlias = Mapping[str, AnyArray]
"""Column -> (lanes, ...)."""

NUMBER = 8
"""Bytes of a float64."""
AT_SAMPLES, ON_MESH = 9, 2
"""Numbers alive at once for each column of the layout, at a sample and at a node of the mesh (measured)."""
OF_ANCHORS = 5
"""Numbers alive at once for each column, at a node of the mesh where a group of higher class is followed along it."""


@dataclass(frozen=True)
class SweepTask:
    """Job of a sweep for every mechanism: a mechanism made ready, its samples, its outputs, what varies."""

    ready: Ready
    span: SampleGrid
    asked: SweepOutputs
    paths: tuple[str, ...]
    kept: dict[tuple[str, int], Any] = field(default_factory=dict, compare=False, repr=False)
    """What executors have made ready of the task, by their kernels and threads: a task computed again finds it."""

    @property
    def places(self) -> int:
        """Samples or nodes of the mesh, whichever are more: what the work of one mechanism grows with."""
        return max(len(self.span.parameter), len(mesh_of(self.ready.kinematics.path, self.span.parameter)))


class ArraysExecutor:
    """The motion as `motion` computes it, on NumPy arrays; so its numbers are the motion's to the last bit."""

    name = "arrays"
    blocks = 1

    def lanes(self, task: SweepTask) -> int:
        """Number of mechanisms computed together: as many as `designs.WORKING_SET` holds, at least one."""
        layout = layout_of(task.ready.kinematics)
        samples = len(task.span.parameter)
        mesh = len(mesh_of(task.ready.kinematics.path, task.span.parameter))
        columns = layout.width + layout.axes * len(task.ready.kinematics.numbers.frame) + len(layout.angles)
        higher = any(isinstance(group, Newton) for group in task.ready.structure.groups)
        each = NUMBER * columns * (AT_SAMPLES * samples + (OF_ANCHORS if higher else ON_MESH) * mesh)
        each += sum(column.bytes for column in task.asked.columns)
        return max(1, designs.WORKING_SET // each)

    def run(self, task: SweepTask, numbers: Dimensions, values: Rows, results: Results) -> None:
        """Fill in all columns for the mechanisms of these dimensions; `values` are those that vary, one a mechanism."""
        lanes = len(next(iter(values.values())))
        fill_columns(task, solve(task.ready, task.span, numbers, lanes), values, results)


def fill_columns(task: SweepTask, solved: Solved, values: Rows, results: Results) -> None:
    """Fill in all columns from the motions of some mechanisms."""
    ok = solved.status == Status.OK
    # copied at once: what is requested may be a view of everything that was computed
    for name, part in task.asked.results(solved, values, ok).items():
        results[name][...] = part
    for name in task.asked.slopes.values():
        results[name][...] = np.nan
    results["samples_ok"][...] = ok.sum(axis=1, dtype=np.int32)
    results["worst_residual"][...] = np.fmax.reduce(solved.residual, axis=1)
