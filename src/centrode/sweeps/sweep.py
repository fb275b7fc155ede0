"""Many mechanisms of one structure: their motions, or one number of each, in bounded memory."""

from __future__ import annotations

import functools
import importlib
import json
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.dynamics.reduction import REDUCED, check_reducible, reduction_of
from centrode.errors import InputError
from centrode.kinematics.motion import dataset_of
from centrode.kinematics.preparation import ready
from centrode.kinematics.solve import Solved, requested_grid, solve
from centrode.locale import _
from centrode.model.examples.catalogue import MechanismSource, load, mechanism_of
from centrode.model.mechanism import Mechanism
from centrode.model.reading import nearest, read_file, value_text
from centrode.model.toml import toml_tables
from centrode.model.units import ANGULAR, bare_angle, is_bare
from centrode.numerics.arrays import ARRAYS
from centrode.structure.dimensions import dimensions_of
from centrode.sweeps import designs
from centrode.sweeps.arrays import SweepTask
from centrode.sweeps.designs import METHODS, Design, Grid, Sample, design_of, grid, sample, unit_of
from centrode.sweeps.executors import Executor, check_executor, check_threads, executor_of
from centrode.sweeps.kept_plans import KeptValues
from centrode.sweeps.outputs import Outputs, Reduce, asked_of, with_slopes
from centrode.sweeps.sample_tables import Tables
from centrode.sweeps.store import (
    Blocks,
    InMemory,
    Kept,
    SweepFrame,
    frame_of,
    open_store,
    read_store,
    tally_of,
    with_tally,
)

Progress: TypeAlias = Callable[[int, int], None]

# what analyses of machines need is not loaded for motions
_studies = functools.partial(importlib.import_module, "centrode.sweeps.parameter_studies")


def sweep(
    mechanism: MechanismSource,
    vary: Mapping[str, Any] | Grid | Sample,
    outputs: Outputs = None,
    samples: int | None = None,
    start: float | str | None = None,
    stop: float | str | None = None,
    reduce: Reduce = None,
    gradient: bool = False,
    executor: str = "auto",
    store: str | Path | None = None,
    progress: Progress | None = None,
    threads: int = 1,
    compute: str | None = None,
    dependent: Mapping[str, str] | None = None,
    tables: Tables = None,
    out: npt.NDArray[np.float64] | None = None,
) -> xr.Dataset:
    """Motions of many mechanisms of one structure, or one number of each motion, in bounded memory.

    With `compute` it is a parameter study: the single numbers of an analysis of each mechanism.

    Parameters
    ----------
    vary : path -> values, `grid` or `sample`
        Dimensions that vary; numbers are SI, texts have a unit.
    outputs : names, or name -> formula
        Quantities of the motion: of everything ("velocity"), of one point, link or guide ("position.C", "angle.AC"),
        one coordinate ("position.C.x"). A formula has a value at every sample, or folds them: "mean(position_C_x)".
    samples, start, stop :
        As those of `motion`.
    reduce : None, "min", "max", "range", "mean", a formula, or name -> formula
        One number of the samples that are ok; a formula names the numbers of the motion itself (docs: sweeps).
    gradient : bool
        Also the derivatives of every output, at each sample or reduced, by each of the values that vary; NaN for
        mechanisms that are not ok everywhere.
    executor : "auto", "arrays" or "machine code"
        What computes; the one used stands in the attributes.
    store : a folder for a result too great for memory
        It goes on where an earlier run of the same sweep ended.
    progress : called with (mechanisms done, mechanisms in all)
    threads : that machine code shares the mechanisms among
    compute : None, "simulate", "steady_motion", "flywheel" or "reactions"
        The analysis of which each mechanism keeps its extremes, their places and its unevenness; `outputs` are
        names of these numbers, all if there are none (docs: parameter studies). Loads, machine and simulation may
        vary too.
    dependent : path -> formula
        Of a parameter study: numbers that follow from those that vary, as "pi/3 - links_AB_length".
    tables : name -> (samples,) numbers [SI], or a CSV file with headings
        Targets, measured values: formulas name them. Where one is NaN the sample is omitted.
    out : array of float64
        Room for what is kept of every sample: the result's arrays are views of it. A call after call then writes
        to memory that is there.

    Returns
    -------
    Dataset
        Dimensions of the mechanisms in front (`mechanism`, or those of the grid), then those of each output;
        `samples_ok` and `worst_residual` of every mechanism. Interrupted, a result in memory says how many
        mechanisms it has; the others are NaN.

    Raises
    ------
    InputError
        Anything requested that there is not, a result too great, a store of another sweep, machine code for
        what it cannot compute.

    Examples
    --------
    >>> import centrode as ct
    >>> found = ct.sweep(ct.example("crank-rocker"), {"links.AB.length": [3.4, 3.6]}, ["angle.DB"], 37, reduce="max")
    >>> found.sizes["mechanism"]
    2
    """
    mechanism = mechanism_of(mechanism)
    if compute is not None:
        _refuse_of_motions(
            start=start,
            stop=stop,
            reduce=reduce,
            gradient=gradient or None,
            store=store,
            tables=tables,
            out=out,
        )
        if isinstance(outputs, Mapping):
            what = _("formulas belong to sweeps of motions")
            raise InputError("outputs", what, _("give names, or omit compute"))
        study: xr.Dataset = _studies().parameter_study(
            mechanism, vary, compute, outputs, samples, dependent, progress
        )
        return study
    if dependent:
        raise InputError("dependent", _("it belongs to a parameter study"), _("give compute too"))
    name = check_executor(executor)
    design = design_of(mechanism, vary)
    if store is not None and out is not None:
        raise InputError("out", _("a store keeps its results itself"), _("give one of store and out"))
    motion, task = _task_of(mechanism, design, outputs, reduce, gradient, tables, (samples, start, stop))
    chosen, told_of_it = executor_of(name, task, design, check_threads(threads))
    units = {path: unit_of(mechanism, path) for path in design.coordinates}
    frame = frame_of(motion, design, units, task.asked, told_of_it)
    blocks = _blocks(frame, task, chosen, stored=store is not None)
    if store is None:
        return _in_memory(frame, blocks, task, chosen, progress, out).assign_attrs(topic="sweep")
    _check_size(frame, designs.IN_STORE, _("reduce it, or choose fewer"))
    with open_store(Path(store), frame, blocks, task) as kept:
        finished = kept.tally.mechanisms
        _compute(frame, kept, task, chosen, progress)
    data = with_tally(read_store(Path(store), frame), frame, kept.tally)
    # a store says what was computed, and not how that is shown: the topic is only in what is returned
    return data.assign_attrs(mechanisms_found=finished, topic="sweep")


MOST_SAMPLES = 20_000
"""Samples of a sweep whose plan is kept for the next one."""
_plans: KeptValues[tuple[xr.Dataset, SweepTask]] = KeptValues(16)


def _task_of(
    mechanism: Mechanism,
    design: Design,
    outputs: Outputs,
    reduce: Reduce,
    gradient: bool,
    tables: Tables,
    span: tuple[Any, Any, Any],
) -> tuple[xr.Dataset, SweepTask]:
    """The description's own motion, and the task; what was requested before is not made again."""

    def make() -> tuple[xr.Dataset, SweepTask]:
        prepared = ready(mechanism)
        grid_of_samples = requested_grid(prepared, *span)
        # the description's own motion says what there is to name
        motion = motion_with_names(solve(prepared, grid_of_samples), f"{outputs} {reduce}")
        asked = asked_of(motion, design, outputs, reduce, tables)
        paths = tuple(design.coordinates)
        return motion, SweepTask(
            prepared, grid_of_samples, with_slopes(asked, len(paths)) if gradient else asked, paths
        )

    # tables are compared by nobody; a long motion would stay in memory
    if tables is not None or not isinstance(span[0], int | None) or (span[0] or 0) > MOST_SAMPLES:
        return make()
    try:
        # as text whole numbers, numbers and truth values differ
        key = json.dumps([list(design.coordinates), outputs, reduce, gradient, span])
    except (TypeError, ValueError):
        return make()
    return _plans.get(mechanism, key, make)


def _refuse_of_motions(**options: object) -> None:
    """InputError at the first option of motions that is given beside an analysis."""
    for name, value in options.items():
        if value is not None:
            raise InputError(name, _("it belongs to sweeps of motions"), _("omit it, or omit compute"))


TABLE_ROWS = 100_000
"""Mechanisms of one table."""


@dataclass(frozen=True)
class SweepResults:
    """Many mechanisms of one structure.

    Attributes
    ----------
    mechanism : the one whose numbers vary
    data : what `sweep` gives of it
    """

    mechanism: Mechanism
    data: xr.Dataset


def sweep_results(
    mechanism: Mechanism, vary: Mapping[str, Any] | Grid | Sample, *arguments: Any, **options: Any
) -> SweepResults:
    """What `sweep` computes, with the mechanism whose numbers vary.

    Parameters
    ----------
    mechanism, vary, arguments, options : as of `sweep`
    """
    return SweepResults(mechanism, sweep(mechanism, vary, *arguments, **options))


def check_table(data: xr.Dataset) -> None:
    """Raise InputError where a sweep is no table: it is not reduced, or has more than `TABLE_ROWS` mechanisms."""
    if "sample" in data.dims:
        raise InputError("", _("a table holds reduced results only"), _("reduce them, or write zarr"))
    count = data["samples_ok"].size
    if count > TABLE_ROWS:
        what = _("a table holds at most {most} mechanisms, here are {count}")
        raise InputError("", what.format(most=TABLE_ROWS, count=count), _("write zarr"))


def motion_with_names(solved: Solved, words: str) -> xr.Dataset:
    """The description's own motion, with its reduction where words name a number of it."""
    motion = dataset_of(solved)
    # reductions are computed only where they are named: masses need not be complete otherwise
    if "reduced_" not in words:
        return motion
    check_reducible(solved)
    reduction = reduction_of(solved)
    return motion.assign({name: reduction[name] for name in REDUCED})


def _check_size(frame: SweepFrame, most: int, repair: str) -> None:
    if frame.bytes > most:
        what = _("the result would take {size:.3g} GB").format(size=frame.bytes / 1e9)
        raise InputError("", what, repair)


def _blocks(frame: SweepFrame, task: SweepTask, executor: Executor, stored: bool) -> Blocks:
    most = executor.blocks * designs.BLOCK_POSITIONS // task.places
    if stored:
        # positions of a block by time, its bytes by memory: the lesser of both. A result in memory has its own room
        each = max(1, sum(column.bytes for column in task.asked.columns))
        most = min(most, designs.BLOCK_BYTES // each)
    return Blocks.of(frame.design.shape, max(1, most))


def _in_memory(
    frame: SweepFrame,
    blocks: Blocks,
    task: SweepTask,
    executor: Executor,
    progress: Progress | None,
    out: npt.NDArray[np.float64] | None,
) -> xr.Dataset:
    if out is None:
        _check_size(frame, designs.IN_MEMORY, _("reduce it, choose fewer, or give a store"))
    kept = InMemory(frame, blocks, out)
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


def _compute(
    frame: SweepFrame, kept: Kept, task: SweepTask, executor: Executor, progress: Progress | None
) -> None:
    """Compute the blocks that are not there, one after the other."""
    lanes = executor.lanes(task)
    for block in kept.blocks:
        if kept.has(block):
            continue
        first, stop = kept.blocks.mechanisms(block)
        # parts that are solved together stay below the working set; a block is kept as a whole
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


# Sweeps in files: which mechanism, what varies, what is requested.

WAYS = ("vary", "grid", "sample")
KEYS = (
    "mechanism", "compute", *WAYS, "dependent", "outputs", "samples", "from", "to", "reduce", "gradient", "executor",
    "tables",
)  # fmt: skip
RANGE = ("from", "to", "count")
SAMPLE = ("count", "method", "seed", "ranges")


@dataclass(frozen=True)
class SweepStudy:
    """A sweep as a file describes it; its parts are arguments of `sweep`.

    Attributes
    ----------
    name : of the mechanism, as the file says it
    start, stop : ends of the range as written (numbers in SI or texts with a unit); None for the motion's own
    """

    name: str
    mechanism: Mechanism
    vary: Mapping[str, Any] | Grid | Sample
    outputs: tuple[str, ...] | Mapping[str, str]
    samples: int | None
    start: float | str | None
    stop: float | str | None
    reduce: Reduce
    gradient: bool
    executor: str
    compute: str | None = None
    dependent: Mapping[str, str] = field(default_factory=dict)
    tables: Tables = None


def read_sweep(path: str | Path) -> SweepStudy:
    """The sweep described in a TOML file; raises InputError that says where it is wrong.

    The mechanism is a file (looked for in the study's own folder) or a built-in one.
    """
    path = Path(path)
    tables = toml_tables(read_file(path), path.name)
    try:
        return _study(tables, path.parent)
    except InputError as error:
        raise InputError(
            ", ".join(filter(None, (path.name, error.where))), error.what, error.repair
        ) from error


def _study(tables: Mapping[str, Any], folder: Path) -> SweepStudy:
    _refuse_unknown("", tables, KEYS)
    name = tables.get("mechanism")
    if not isinstance(name, str) or not name:
        example = _('write mechanism = "press.toml", or the name of a built-in one')
        raise InputError("mechanism", _("it is missing"), example)
    # a file beside the study comes before a built-in mechanism of that name
    near = folder / name
    samples = tables.get("samples")
    if samples is not None and (isinstance(samples, bool) or not isinstance(samples, int)):
        raise InputError(
            "samples", _("expected a whole number, got {value}").format(value=value_text(samples))
        )
    mechanism = load(near if near.is_file() else name)
    if mechanism.display.refuses_bare_angles:
        _refuse_bare_angles(mechanism, tables)
    return SweepStudy(
        name,
        mechanism,
        _vary(tables),
        _outputs(tables.get("outputs", [])),
        samples,
        _end("from", tables.get("from")),
        _end("to", tables.get("to")),
        _reduce(tables.get("reduce")),
        _switch("gradient", tables.get("gradient", False)),
        _text("executor", tables.get("executor", "auto")),
        _text("compute", tables["compute"]) if "compute" in tables else None,
        _dependent(tables.get("dependent", {})),
        _tables(tables.get("tables"), folder),
    )


def _refuse_bare_angles(mechanism: Mechanism, tables: Mapping[str, Any]) -> None:
    """InputError at the first angle without a unit in the tables of a study; texts are read later, with their paths."""
    if mechanism.motion_parameter.instant.kind == "angle":
        for key in ("from", "to"):
            _refuse_bare(key, [tables.get(key)])
    ranges = tables.get("sample")
    varied: list[tuple[str, Any]] = []
    for table in (
        tables.get("vary"),
        tables.get("grid"),
        ranges.get("ranges") if isinstance(ranges, dict) else None,
    ):
        varied += _paths(table, RANGE[:2]) if isinstance(table, dict) else []
    for path, value in varied:
        values = [value.get(key) for key in RANGE[:2]] if isinstance(value, dict) else value
        if designs.kind_of(mechanism, path) in ANGULAR:
            _refuse_bare(path, values if isinstance(values, list) else [values])


def _refuse_bare(where: str, values: Sequence[Any]) -> None:
    for value in values:
        if not isinstance(value, str) and is_bare(value, "angle"):
            error = bare_angle(value)
            raise InputError(where, error.what, error.repair)


def _switch(key: str, value: Any) -> bool:
    if not isinstance(value, bool):
        raise InputError(key, _("expected true or false, got {value}").format(value=value_text(value)))
    return value


def _refuse_unknown(where: str, table: Mapping[str, Any], known: tuple[str, ...]) -> None:
    for key in table:
        if key not in known:
            raise InputError(where, _("unknown key {key}").format(key=value_text(key)), nearest(key, known))


def _vary(tables: Mapping[str, Any]) -> Mapping[str, Any] | Grid | Sample:
    given = [way for way in WAYS if way in tables]
    if len(given) != 1:
        what = _("exactly one of {ways} defines what varies").format(
            ways=", ".join(f"[{way}]" for way in WAYS)
        )
        raise InputError(", ".join(f"[{way}]" for way in given), what, _("give one of them"))
    way = given[0]
    table = tables[way]
    if not isinstance(table, dict):
        raise InputError(way, _("expected a table, got {value}").format(value=value_text(table)))
    if way == "vary":
        return dict(_paths(table, ()))
    if way == "grid":
        return grid({path: _range(path, value) for path, value in _paths(table, RANGE)})
    return _sample(table)


def _paths(table: Mapping[str, Any], leaf: tuple[str, ...], above: str = "") -> Iterator[tuple[str, Any]]:
    """(path, value) of a table whose keys are paths, in quotes or as TOML's dotted keys.

    A table inside is a value if it has one of the keys in `leaf`, and no table under it.
    """
    for key, value in table.items():
        path = f"{above}.{key}" if above else key
        if not isinstance(value, dict) or any(
            word in value and not isinstance(value[word], dict) for word in leaf
        ):
            yield path, value
        else:
            yield from _paths(value, leaf, path)


def _range(path: str, value: object) -> Any:
    """A range of a grid: a table with from, to and count; values as they are."""
    if not isinstance(value, dict):
        return value
    _refuse_unknown(path, value, RANGE)
    for key in RANGE:
        if key not in value:
            example = '{ from = "0.9 m", to = "1.1 m", count = 21 }'
            raise InputError(
                path, _("{key} is missing").format(key=key), _("write {example}").format(example=example)
            )
    return (value["from"], value["to"], value["count"])


def _dependent(given: object) -> Mapping[str, str]:
    if not isinstance(given, dict):
        raise InputError("dependent", _("expected a table, got {value}").format(value=value_text(given)))
    return dict(_paths(given, ()))


def _tables(given: object, folder: Path) -> Tables:
    """Tables by name, or the path of a CSV file that lies beside the study."""
    if given is None:
        return None
    if isinstance(given, str):
        return folder / given
    if not isinstance(given, dict):
        what = _("expected a table of lists, or the path of a CSV file, got {value}")
        raise InputError("tables", what.format(value=value_text(given)))
    return given


def _sample(table: Mapping[str, Any]) -> Sample:
    _refuse_unknown("[sample]", table, SAMPLE)
    ranges = table.get("ranges")
    if not isinstance(ranges, dict) or "count" not in table:
        raise InputError(
            "[sample]", _("it needs count and ranges"), _("write count = 1000 and [sample.ranges]")
        )
    spans = {path: _range_of_sample(path, value) for path, value in _paths(ranges, RANGE[:2])}
    return sample(spans, table["count"], table.get("method", METHODS[0]), table.get("seed", 0))


def _range_of_sample(path: str, value: object) -> Any:
    if not isinstance(value, dict):
        return value
    _refuse_unknown(path, value, RANGE[:2])
    return tuple(value.get(key) for key in RANGE[:2])


def _outputs(given: object) -> tuple[str, ...] | Mapping[str, str]:
    if isinstance(given, str):
        return (given,)
    if isinstance(given, dict):
        return given
    if (
        not isinstance(given, list)
        or len(given) > designs.OUTPUTS
        or not all(isinstance(x, str) for x in given)
    ):
        raise InputError(
            "outputs", _("expected a list of texts, such as {example}").format(example='["position.C"]')
        )
    return tuple(given)


def _end(key: str, given: object) -> float | str | None:
    if given is None or isinstance(given, str):
        return given
    if isinstance(given, bool) or not isinstance(given, int | float):
        raise InputError(
            key, _("expected a number or a text with a unit, got {value}").format(value=value_text(given))
        )
    return float(given)


def _reduce(given: object) -> Reduce:
    if given is None or isinstance(given, str):
        return given
    if not isinstance(given, dict) or not all(isinstance(text, str) for text in given.values()):
        raise InputError("reduce", _("expected a text, or a table of formulas"))
    return given


def _text(key: str, given: object) -> str:
    if not isinstance(given, str):
        raise InputError(key, _("expected a text, got {value}").format(value=value_text(given)))
    return given
