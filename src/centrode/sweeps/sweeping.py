"""Many mechanisms of one structure: their motions, or one number of each, in bounded memory."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeAlias

import xarray as xr

from centrode.algebra.arrays import ARRAYS
from centrode.dynamics.reduction import REDUCED, check_reducible, reduction_of
from centrode.errors import InputError
from centrode.kinematics.motion import dataset_of
from centrode.kinematics.prepared import ready
from centrode.kinematics.solve import Solved, asked_span, solve
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.structure.dimensions import dimensions_of
from centrode.sweeps import limits
from centrode.sweeps.arrays import Task
from centrode.sweeps.asked import Reduce, asked_of, with_slopes
from centrode.sweeps.blocks import Blocks
from centrode.sweeps.designs import Grid, design_of
from centrode.sweeps.drawing import Sample
from centrode.sweeps.executors import Executor, check_executor, check_threads, executor_of
from centrode.sweeps.results import Frame, InMemory, Kept, frame_of, told
from centrode.sweeps.store import opened, read
from centrode.sweeps.tallies import tally_of
from centrode.sweeps.values import unit_of

Progress: TypeAlias = Callable[[int, int], None]


def sweep(
    mechanism: Mechanism,
    vary: Mapping[str, Any] | Grid | Sample,
    outputs: Sequence[str] | str | None = None,
    samples: int | None = None,
    start: float | None = None,
    stop: float | None = None,
    reduce: Reduce = None,
    gradient: bool = False,
    executor: str = "auto",
    store: str | Path | None = None,
    progress: Progress | None = None,
    threads: int = 1,
) -> xr.Dataset:
    """Motions of many mechanisms of one structure, or one number of each motion, in bounded memory.

    Parameters
    ----------
    vary : path -> values, `grid` or `sample`
        Dimensions that vary; numbers are SI, texts have a unit.
    outputs : names
        Quantities of the motion: of everything ("velocity"), of one point, link or guide ("position.C", "angle.AC"),
        one coordinate ("position.C.x").
    samples, start, stop :
        As those of `motion`.
    reduce : None, "min", "max", "range", "mean", a formula, or name -> formula
        One number of the samples that are ok; a formula names the numbers of the motion itself (docs: sweeps).
    gradient : bool
        Also the derivatives of every reduced output by each of the values that vary; NaN for mechanisms that
        are not ok everywhere.
    executor : "auto", "arrays" or "machine code"
        What computes; the one used stands in the attributes.
    store : a folder for a result too great for memory
        It goes on where an earlier run of the same sweep ended.
    progress : called with (mechanisms done, mechanisms in all)
    threads : that machine code shares the mechanisms among

    Returns
    -------
    Dataset
        Dimensions of the mechanisms in front (`mechanism`, or those of the grid), then those of each output;
        `samples_ok` and `worst_residual` of every mechanism. Interrupted, a result in memory says how many
        mechanisms it has; the others are NaN.

    Raises
    ------
    InputError
        Anything asked for that there is not, a result too great, a store of another sweep, machine code for
        what it cannot compute.
    """
    name = check_executor(executor)
    design = design_of(mechanism, vary)
    prepared = ready(mechanism)
    span = asked_span(prepared, samples, start, stop)
    motion = _first(solve(prepared, span), outputs, reduce)
    paths = tuple(design.coordinates)
    asked = asked_of(motion, design, outputs, reduce)
    task = Task(prepared, span, with_slopes(asked, len(paths)) if gradient else asked, paths)
    chosen, told_of_it = executor_of(name, task, design, check_threads(threads))
    units = {path: unit_of(mechanism, path) for path in design.coordinates}
    frame = frame_of(motion, design, units, task.asked, told_of_it)
    blocks = _blocks(frame, task, chosen)
    if store is None:
        return _in_memory(frame, blocks, task, chosen, progress)
    _check_size(frame, limits.IN_STORE, _("reduce it, or ask for fewer"))
    with opened(Path(store), frame, blocks, task) as kept:
        found = kept.tally.mechanisms
        _compute(frame, kept, task, chosen, progress)
    data = told(read(Path(store), frame), frame, kept.tally)
    return data.assign_attrs(mechanisms_found=found)


def _first(solved: Solved, outputs: Sequence[str] | str | None, reduce: Reduce) -> xr.Dataset:
    """The description's own motion, with its reduction where that is asked for."""
    motion = dataset_of(solved)
    if "reduced_" not in f"{outputs} {reduce}":
        return motion
    check_reducible(solved)
    reduction = reduction_of(solved)
    return motion.assign({name: reduction[name] for name in REDUCED})


def _check_size(frame: Frame, most: int, repair: str) -> None:
    if frame.bytes > most:
        what = _("the result would take {size:.3g} GB").format(size=frame.bytes / 1e9)
        raise InputError("", what, repair)


def _blocks(frame: Frame, task: Task, executor: Executor) -> Blocks:
    each = max(1, sum(column.bytes for column in task.asked.columns))
    most = min(executor.blocks * limits.BLOCK_POSITIONS // task.places, limits.BLOCK_BYTES // each)
    return Blocks.of(frame.design.shape, max(1, most))


def _in_memory(
    frame: Frame, blocks: Blocks, task: Task, executor: Executor, progress: Progress | None
) -> xr.Dataset:
    _check_size(frame, limits.IN_MEMORY, _("reduce it, ask for fewer, or give a store"))
    kept = InMemory(frame, blocks)
    try:
        _compute(frame, kept, task, executor, progress)
    except KeyboardInterrupt:
        if not kept.tally.mechanisms:
            raise
        kept.leave_the_rest_empty()
        what = _("interrupted: {done} of {all} mechanisms are computed, the others are NaN")
        warnings.warn(
            what.format(done=kept.tally.mechanisms, all=frame.mechanisms), RuntimeWarning, stacklevel=3
        )
    return kept.dataset()


def _compute(frame: Frame, kept: Kept, task: Task, executor: Executor, progress: Progress | None) -> None:
    """Compute the blocks that are not there, one after the other."""
    lanes = executor.lanes(task)
    for block in kept.blocks:
        if kept.has(block):
            continue
        first, stop = kept.blocks.mechanisms(block)
        before = kept.tally.mechanisms
        results = kept.room(block)
        for low in range(first, stop, lanes):
            high = min(low + lanes, stop)
            values = frame.design.rows(low, high)
            numbers = dimensions_of(task.ready.mechanism, values, ARRAYS)
            executor.run(task, numbers, values, results.part(slice(low - first, high - first)))
            if progress is not None:
                progress(before + high - first, frame.mechanisms)
        kept.put(block, results, tally_of(task.asked, len(task.span.parameter), results))
