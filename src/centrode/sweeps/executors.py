"""What computes the motions of a sweep, chosen by name: the one place where another way to compute plugs in.

An executor is given mechanisms that fit into its working set and returns the columns of the result.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Protocol, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.errors import InputError, NotComputedYet, Status
from centrode.kinematics.layout import layout_of
from centrode.kinematics.mesh import mesh_of
from centrode.kinematics.ready import Ready
from centrode.kinematics.solve import solve
from centrode.kinematics.spans import Span
from centrode.locale import _
from centrode.model.problems import nearest, shown
from centrode.structure.dimensions import Dimensions
from centrode.structure.groups import Newton
from centrode.sweeps import limits
from centrode.sweeps.asked import Asked
from centrode.sweeps.designs import Rows

AnyArray: TypeAlias = npt.NDArray[Any]
Results: TypeAlias = Mapping[str, AnyArray]
"""Column -> (lanes, ...)."""

AUTO = "auto"
NUMBER = 8
"""Bytes of a float64."""
AT_SAMPLES, ON_MESH = 9, 2
"""Numbers alive at once for each column of the layout, at a sample and at a node of the mesh (measured)."""
OF_ANCHORS = 5
"""The same at a node of the mesh where a group of higher class is followed along it."""


@dataclass(frozen=True)
class Task:
    """What is computed for every mechanism: a mechanism made ready, its samples, what is asked for of them."""

    ready: Ready
    span: Span
    asked: Asked

    @property
    def places(self) -> int:
        """Samples or nodes of the mesh, whichever are more: what the work of one mechanism grows with."""
        return max(len(self.span.parameter), len(mesh_of(self.ready.kinematics.path, self.span.parameter)))


class Executor(Protocol):
    """One way to compute."""

    name: str

    def lanes(self, task: Task) -> int:
        """How many mechanisms may be computed together: as many as `limits.WORKING_SET` holds, at least one."""

    def run(self, task: Task, numbers: Dimensions, values: Rows) -> Results:
        """All columns for the mechanisms of these dimensions; `values` are those that vary, one a mechanism."""


class ArraysExecutor:
    """The motion as `motion` computes it, on NumPy arrays; so its numbers are the motion's to the last bit."""

    name = "arrays"

    def lanes(self, task: Task) -> int:
        layout = layout_of(task.ready.kinematics)
        samples = len(task.span.parameter)
        mesh = len(mesh_of(task.ready.kinematics.path, task.span.parameter))
        columns = layout.width + layout.axes * len(task.ready.kinematics.numbers.frame) + len(layout.angles)
        higher = any(isinstance(group, Newton) for group in task.ready.structure.groups)
        each = NUMBER * columns * (AT_SAMPLES * samples + (OF_ANCHORS if higher else ON_MESH) * mesh)
        each += sum(column.bytes for column in task.asked.columns)
        return max(1, limits.WORKING_SET // each)

    def run(self, task: Task, numbers: Dimensions, values: Rows) -> Results:
        lanes = len(next(iter(values.values())))
        solved = solve(task.ready, task.span, numbers, lanes)
        ok = solved.status == Status.OK
        return {
            **task.asked.results(solved, values, ok),
            "samples_ok": ok.sum(axis=1, dtype=np.int32),
            "worst_residual": np.fmax.reduce(solved.residual, axis=1),
        }


MACHINE_CODE = "machine code"
EXECUTORS: Mapping[str, Executor] = {ArraysExecutor.name: ArraysExecutor()}


def executor_of(name: object) -> Executor:
    """The executor of a name; "auto" is the fastest there is. Raises InputError, NotComputedYet for machine code."""
    known = (AUTO, ArraysExecutor.name, MACHINE_CODE)
    if name == MACHINE_CODE:
        raise NotComputedYet(
            "executor", _("machine code is not available yet"), _('say executor = "arrays" or "auto"')
        )
    if not isinstance(name, str) or name not in known:
        raise InputError(
            "executor", _("unknown executor {name}").format(name=shown(name)), nearest(str(name), known)
        )
    return EXECUTORS[ArraysExecutor.name if name == AUTO else name]
