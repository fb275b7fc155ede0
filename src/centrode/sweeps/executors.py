"""What computes the motions of a sweep, chosen by name: the one place where another way to compute plugs in.

An executor is given mechanisms that fit into its working set and fills in the columns of the result.
"""

from __future__ import annotations

import math
from typing import Protocol

from centrode.errors import InputError
from centrode.kinematics.machine_code.trace import Untraceable
from centrode.locale import _, mark
from centrode.model.reading import nearest, value_text
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.executors import AUTO, MACHINE_CODE, choose_executor
from centrode.structure.dimensions import Dimensions, dimensions_of
from centrode.sweeps import designs
from centrode.sweeps.arrays import ArraysExecutor, Results, SweepTask
from centrode.sweeps.designs import Design, Rows
from centrode.sweeps.machine import MachineCodeExecutor, check_present

KNOWN = (AUTO, ArraysExecutor.name, MACHINE_CODE)


class Executor(Protocol):
    """Way to compute the motions of a sweep."""

    @property
    def name(self) -> str:
        """Name of the executor in results."""

    @property
    def blocks(self) -> int:
        """Size of its blocks in `designs.BLOCK_POSITIONS`, so that one takes a few seconds."""

    def lanes(self, task: SweepTask) -> int:
        """Number of mechanisms computed together."""

    def run(self, task: SweepTask, numbers: Dimensions, values: Rows, results: Results) -> None:
        """Fill in all columns for the mechanisms of these dimensions; `values` are those that vary, one a mechanism."""


def check_executor(name: object) -> str:
    """The name of an executor, or "auto"; InputError for any other."""
    if not isinstance(name, str) or name not in KNOWN:
        raise InputError(
            "executor", _("unknown executor {name}").format(name=value_text(name)), nearest(str(name), KNOWN)
        )
    return name


def check_threads(given: object) -> int:
    """A number of threads; InputError for any other than 1 to `designs.THREADS`."""
    if isinstance(given, bool) or not isinstance(given, int) or not 1 <= given <= designs.THREADS:
        what = _("{count} is not a valid number of threads").format(count=value_text(given))
        raise InputError(
            "threads", what, _("give a whole number from 1 to {most}").format(most=designs.THREADS)
        )
    return given


def executor_of(name: str, task: SweepTask, design: Design, threads: int = 1) -> tuple[Executor, str]:
    """The executor of a name for a task, and what a result says of it.

    "auto" is machine code where it can compute the task and the task is long enough to be worth compiling for.
    Raises InputError where machine code is requested and cannot.
    """
    arrays = ArraysExecutor()
    if task.asked.slopes:
        return _with_slopes(name, task, design, threads)
    positions = math.prod(design.shape) * task.places
    # a short sweep is done before its kernels would be compiled
    if name == arrays.name or (name == AUTO and positions < designs.WORTH_COMPILING):
        return arrays, arrays.name
    try:
        executor = _machine_code_executor(task, design, threads, MACHINE_CODE)
    except Untraceable as why:
        if name == AUTO:
            # chosen by itself it may fall back, and the result says why; by name it must not
            return arrays, f"{arrays.name} ({why.reason})"
        what = _("machine code cannot compute this: {reason}").format(reason=_(why.reason))
        raise InputError("executor", what, _('use executor = "auto" or "arrays"')) from None
    return executor, executor.name


def _machine_code_executor(
    task: SweepTask, design: Design, threads: int, kernels: str
) -> MachineCodeExecutor:
    if task.asked.has_hinge_angles:
        raise Untraceable(mark("angles at hinges, whose turns are counted on the mesh"))
    check_present(kernels)
    found = task.kept.get((kernels, threads))
    if isinstance(found, MachineCodeExecutor):
        return found
    # one mechanism shows which numbers vary, and by what algebra
    values = design.rows(0, 1)
    numbers = dimensions_of(task.ready.mechanism, values, ARRAYS)
    executor = MachineCodeExecutor.of(task, numbers, values, threads, kernels)
    # what expressions cannot say is told before anything is computed; all are known then, and threads share them
    _ = executor.asked.written_columns, executor.asked.final
    task.kept[kernels, threads] = executor
    return executor


def _with_slopes(name: str, task: SweepTask, design: Design, threads: int) -> tuple[Executor, str]:
    """Derivatives are those of expressions: on arrays these are computed by NumPy."""
    # arrays cannot differentiate: with them too the motion is traced, and NumPy runs the expressions
    kernels = choose_executor(name) if name == AUTO else name
    try:
        executor = _machine_code_executor(task, design, threads, kernels)
    except Untraceable as why:
        what = _("derivatives cannot be computed here: {reason}").format(reason=_(why.reason))
        raise InputError("gradient", what, _("omit gradient")) from None
    return executor, executor.name


def bare(executor: str) -> str:
    """Name of the executor without the reason why it is this one: the part that decides the bits."""
    return executor.partition(" (")[0]


def reason_of(executor: str) -> str:
    """Why it is this executor, marked for the catalogues; nothing where that needs no reason."""
    return executor.partition(" (")[2].removesuffix(")")
