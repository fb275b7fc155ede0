"""Many mechanisms of one structure: their motions, or one number of each, in bounded memory."""

from __future__ import annotations

import functools
import importlib
import warnings
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.errors import InputError
from centrode.locale import _
from centrode.model.examples.catalogue import MechanismSource, load, mechanism_of
from centrode.model.mechanism import Mechanism
from centrode.model.reading import nearest, read_file, value_text
from centrode.model.toml import toml_tables
from centrode.model.units import ANGULAR, bare_angle, is_bare
from centrode.numerics.executors import MACHINE_CODE
from centrode.numerics.machine_code.targets import baseline
from centrode.sweeps import designs
from centrode.sweeps.cluster_blocks import check_libraries, compute_on_cluster, work_text
from centrode.sweeps.clusters import ClusterSource, check_cluster, wanted_libraries
from centrode.sweeps.designs import METHODS, Grid, Sample, design_of, grid, sample
from centrode.sweeps.executors import check_executor, check_threads
from centrode.sweeps.outputs import Outputs, Reduce
from centrode.sweeps.sample_tables import Tables
from centrode.sweeps.storage import storage_of
from centrode.sweeps.store import InMemory, Kept, SweepFrame, open_store, read_store, study_of, with_tally
from centrode.sweeps.sweep_plans import (
    Progress,
    Span,
    SweepPlan,
    blocks_of,
    check_target,
    measured_blocks_of,
    plan_of,
    stored_blocks_of,
)

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
    cluster: ClusterSource = None,
    target: str | None = None,
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
    store : a folder, or an address such as "s3://bucket/sweep.zarr", for a result too great for memory
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
    cluster : a number of workers on this machine, "tcp://..." or "tls://...", a client of `distributed`
        Workers compute the blocks and write them to the store, which all of them reach (docs: clusters).
    target : "x86-64-v2", "x86-64-v3", "x86-64-v4" or "aarch64"
        The processor that machine code is compiled for; this machine's by default, with a cluster a baseline.

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
            target=target,
        )
        if isinstance(outputs, Mapping):
            what = _("formulas belong to sweeps of motions")
            raise InputError("outputs", what, _("give names, or omit compute"))
        study: xr.Dataset = _studies().parameter_study(
            mechanism, vary, compute, outputs, samples, dependent, progress, cluster
        )
        return study
    if dependent:
        raise InputError("dependent", _("it belongs to a parameter study"), _("give compute too"))
    name = check_executor(executor)
    named = _target_of(target, cluster, threads, store)
    design = design_of(mechanism, vary)
    if store is not None and out is not None:
        raise InputError("out", _("a store keeps its results itself"), _("give one of store and out"))
    span = samples, start, stop
    plan = plan_of(
        mechanism, design, name, outputs, reduce, gradient, tables, span, check_threads(threads), named
    )
    if store is None:
        data = _in_memory(plan, progress, out)
        data.attrs["topic"] = "sweep"
        return data
    requested = outputs, reduce, gradient, span
    return _in_store(plan, store, requested, progress, cluster)


def _in_store(
    plan: SweepPlan,
    store: str | Path,
    requested: tuple[Outputs, Reduce, bool, Span],
    progress: Progress | None,
    cluster: ClusterSource,
) -> xr.Dataset:
    """The sweep of a plan, kept in a store: only what is not there yet is computed.

    Parameters
    ----------
    requested : outputs, reduction, gradient and samples as they were given, for workers of a cluster
    """
    _check_size(plan.frame, designs.IN_STORE, _("reduce it, or choose fewer"))
    storage = storage_of(store)
    facts = study_of(plan.frame, plan.task, plan.target)
    # a cluster's store may be greater than what can be read at every beginning
    blocks = functools.partial(stored_blocks_of if cluster is None else measured_blocks_of, plan)
    with open_store(
        storage, plan.frame, blocks, facts, thorough=cluster is None and storage.reads_back
    ) as kept:
        finished = kept.tally.mechanisms
        wanted = wanted_libraries(machine_code=plan.executor.name == MACHINE_CODE)
        check_libraries(storage, wanted)
        if cluster is None:
            _compute(plan, kept, progress)
        else:
            text = work_text(plan, *requested, wanted, kept.blocks)
            compute_on_cluster(kept, text, wanted, cluster, progress)
    data = with_tally(read_store(storage, plan.frame), plan.frame, kept.tally)
    # a store says what was computed, and not how that is shown: the topic is only in what is returned
    return data.assign_attrs(mechanisms_found=finished, topic="sweep")


def _target_of(target: str | None, cluster: ClusterSource, threads: int, store: object) -> str | None:
    """The processor that kernels are compiled for; InputError where options of a cluster do not fit."""
    if cluster is None:
        return check_target(target)
    check_cluster(cluster)
    if store is None:
        what = _("workers write to a store, which is missing")
        raise InputError("store", what, _("name a folder or an address that all workers reach"))
    if threads != 1:
        raise InputError(
            "threads", _("workers of a cluster have one thread each"), _("omit it, or omit cluster")
        )
    return check_target(baseline() if target is None else target)


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


def _check_size(frame: SweepFrame, most: int, repair: str) -> None:
    if frame.bytes > most:
        what = _("the result would take {size:.3g} GB").format(size=frame.bytes / 1e9)
        raise InputError("", what, repair)


def _in_memory(plan: SweepPlan, progress: Progress | None, out: npt.NDArray[np.float64] | None) -> xr.Dataset:
    frame = plan.frame
    if out is None:
        _check_size(frame, designs.IN_MEMORY, _("reduce it, choose fewer, or give a store"))
    kept = InMemory(frame, blocks_of(plan), out)
    try:
        _compute(plan, kept, progress)
    except KeyboardInterrupt:
        if not kept.tally.mechanisms:
            raise
        kept.leave_the_rest_empty()
        what = _("interrupted: {done} of {all} mechanisms are computed, the others are NaN")
        warnings.warn(
            what.format(done=kept.tally.mechanisms, all=frame.mechanisms), RuntimeWarning, stacklevel=3
        )
    return kept.dataset()


def _compute(plan: SweepPlan, kept: Kept, progress: Progress | None) -> None:
    """Compute the blocks that are not there, one after the other."""
    for block in kept.blocks:
        if kept.has(block):
            continue
        first, stop = kept.blocks.mechanisms(block)
        before = kept.tally.mechanisms

        def tell(done: int, before: int = before) -> None:
            if progress is not None:
                progress(before + done, plan.frame.mechanisms)

        # a block is kept as a whole
        results = kept.room(block)
        kept.put(block, results, plan.compute(first, stop, results, tell))


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
