"""Machine code: traced plans against the machine's bounds, NumPy, other compilers and the compiled peer."""

from __future__ import annotations

import functools
import os
import tempfile
import time
from collections import Counter
from collections.abc import Iterator, Mapping
from pathlib import Path
from statistics import median
from unittest.mock import patch

import numpy as np
import numpy.typing as npt

import centrode as ct
from benchmarks.plans import DIMENSIONS, DRIVE, EACH, LANES, SAMPLES, SIX, Plan, plan_of
from benchmarks.table import Promise, Row
from benchmarks.timing import ROUNDS, Shared, Task, best_times, paired_times, ratio, two_threads
from benchmarks.written import FEW, in_cache, streamed, to_memory
from centrode.kinematics.machine_code.variables import PARAMETER
from centrode.numerics import machine_code
from centrode.numerics.expressions import Node, apply_operation, variable
from centrode.numerics.machine_code import cache
from centrode.numerics.scans import (
    Reduction,
    Scan,
    end_of,
    greatest,
    least,
    run_on_arrays,
    together,
    total,
    total_with_gradient,
)
from centrode.structure.dimensions import SPACES

if machine_code.PRESENT:
    from centrode.numerics.machine_code.kernels import Kernel, forget, kernel_of

Array = npt.NDArray[np.float64]
MISSING = "llvmlite is not installed: pip install 'centrode[fast]'"
DIVIDED = 8
FOUR_BAR, SPHERICAL = "crank-rocker", "spherical-four-bar"
MADE = {FOUR_BAR: 150.0, "six-bar-press": 400.0, SPHERICAL: 400.0}
"""Greatest times of tracing and compiling together [ms]."""


def kernels() -> Iterator[Row]:
    """All rows."""
    write, divide, root = _write_bound(), _divider_bound("divide"), _divider_bound("sqrt")
    yield Row("bounds [ns]", {"a number written": write, "a division": divide, "a root": root})
    plans = {name: plan_of(name, paths) for name, paths in DIMENSIONS.items()}
    for name, plan in plans.items():
        yield to_memory(name, plan)
        yield in_cache(name, plan)
        yield from _reduced(name, plan, divide, root)
        yield _gradient(name)
        yield _compiled(name)
    yield _on_the_sphere(plans[SPHERICAL], plans[FOUR_BAR])


def _write_bound() -> float:
    """Time to write a number to memory [ns]."""
    large = np.zeros(1 << 24)
    return best_times({"write": functools.partial(large.fill, 1.0)})["write"] / large.size * 1e9


def _divider_bound(operation: str) -> float:
    """Time of a division or a root in vectors as wide as the kernels' [ns]: several that do not wait for each other."""
    drive, states = variable(PARAMETER), [variable(f"s{i}") for i in range(DIVIDED)]
    found = [drive / x if operation == "divide" else apply_operation("sqrt", x) for x in states]
    scan = Scan((), (PARAMETER,), {}, {f"s{i}": x for i, x in enumerate(found)})
    run = functools.partial(kernel_of(scan).run, None, DRIVE + 1.0, np.ones((DIVIDED, LANES)))
    return best_times({"": run})[""] / (LANES * SAMPLES * DIVIDED) * 1e9


def _running(plan: Plan, reduction: Reduction, relaxed: bool = False) -> tuple[Kernel, list[list[float]]]:
    scan = Scan(plan.names, (PARAMETER,), {}, reduction.state)
    return kernel_of(scan, relaxed=relaxed), [[value] for value in reduction.start.values()]


def _reductions(plan: Plan) -> dict[str, Reduction]:
    """One number a mechanism: path extremes of a coordinate, and all outputs together."""
    coordinate = next(iter(plan.outputs.values()))
    whole = functools.reduce(lambda a, b: a + b, plan.outputs.values())
    return {
        "extremes of a coordinate": together(greatest("hi", coordinate), least("lo", coordinate)),
        "all outputs to one number": total("sum", whole),
    }


def _reduced(name: str, plan: Plan, divide: float, root: float) -> Iterator[Row]:
    lanes = plan.by_lanes
    for label, reduction in _reductions(plan).items():
        (kernel, start), (relaxed, _start) = _running(plan, reduction), _running(plan, reduction, True)
        on_arrays = Scan(plan.names, (PARAMETER,), _values(reduction.state))
        times = paired_times(
            {
                "kernel": functools.partial(kernel.run, lanes, DRIVE, start),
                "relaxed": functools.partial(relaxed.run, lanes, DRIVE, start),
                "numpy": functools.partial(run_on_arrays, on_arrays, lanes[:, :FEW], DRIVE),
            },
            ROUNDS,
        )
        times["numpy"] = [x * LANES / FEW for x in times["numpy"]]
        quotients, roots = _divided(kernel)
        ns = median(times["kernel"]) * EACH
        over = ns / (quotients * divide + roots * root)
        threads = _two_threads(kernel, lanes, start)
        yield Row(
            f"{name}, {label}",
            {
                "divisions": float(quotients),
                "roots": float(roots),
                "ns": ns,
                "/ divider": over,
                "relaxed /": ratio(times, "relaxed", "kernel"),
                "numpy /": ratio(times, "numpy", "kernel"),
                "1 thread / 2": threads.gain,
                "possible": threads.possible,
            },
            promises=[
                *([Promise(f"{name}, {label}, over the divider", over, 2.4)] if name != SPHERICAL else []),
                Promise(f"{name}, {label}, 1 thread / 2", threads.gain, at_least=1.6),
            ],
        )


def _divided(kernel: Kernel) -> tuple[int, int]:
    """Divisions (the arc tangent has one) and roots of one step: what does not depend on the step is done before."""
    moving = {variable(name) for name in (*kernel.rest.inputs, *kernel.rest.state)}
    counts: Counter[str] = Counter()
    for node in kernel.rest.graph.order:
        if any(x in moving for x in node.arguments):
            moving.add(node)
            counts[node.operation] += 1
    return counts["divide"] + counts["atan2"], counts["sqrt"]


def _values(state: Mapping[str, Node]) -> dict[str, Node]:
    """What is reduced, as outputs: NumPy reduces arrays by itself."""
    return {
        name: node.arguments[0] if node.operation != "where" else node.arguments[1].arguments[1]
        for name, node in state.items()
    }


def _two_threads(kernel: Kernel, lanes: Array, start: list[list[float]]) -> Shared:
    many = np.tile(lanes, 40)  # long enough for a processor that slept to wake
    halves = [np.ascontiguousarray(half) for half in np.split(many, 2, axis=1)]
    return two_threads(
        lambda threads: kernel.run(many, DRIVE, start, threads=threads),
        [functools.partial(kernel.run, half, DRIVE, start) for half in halves],
    )


def _gradient(name: str) -> Row:
    """A path error and its derivatives by six dimensions, over the error alone."""
    plan = plan_of(name, SIX[name])
    point = list(plan.positions.values())[: len(SPACES[ct.example(name).space].axes)]
    error = functools.reduce(lambda a, b: a + b, [(x - 0.5) * (x - 0.5) for x in point])
    by = [variable(path) for path in SIX[name]]
    runs: dict[str, Task] = {}
    kernel, start = _running(plan, total("error", error))
    runs["value"] = functools.partial(kernel.run, plan.by_lanes, DRIVE, start)
    reduction = total_with_gradient("error", error, by, [PARAMETER])
    ending = kernel_of(end_of(reduction, plan.names))
    for label, relaxed in (("gradient", False), ("relaxed", True)):
        carrying, starts = _running(plan, reduction, relaxed)
        runs[label] = functools.partial(_to_the_end, plan, carrying, starts, ending)
    times = paired_times(runs, ROUNDS)
    exact, over = (ratio(times, label, "value") for label in ("gradient", "relaxed"))
    ns = median(times["value"]) * EACH
    what = f"{name}, path error with its gradient by {len(by)} relaxed, over the error"
    return Row(
        f"{name}, path error and gradient",
        {"by": float(len(by)), "ns": ns, "with gradient / value": exact, "relaxed / value": over},
        promises=[Promise(what, over, 3.0)],
    )


def _to_the_end(plan: Plan, carrying: Kernel, starts: list[list[float]], ending: Kernel) -> Array:
    last = carrying.run(plan.by_lanes, DRIVE, starts).state
    return ending.run(np.concatenate([plan.by_lanes, last]), None).outputs


def _compiled(name: str) -> Row:
    """Processor time from a plan to a kernel: traced, compiled, found on disk, found in memory; medians."""
    found: dict[str, list[float]] = {"trace": [], "compile": [], "from disk": [], "from memory": []}
    with tempfile.TemporaryDirectory() as folder, patch.dict(os.environ, {cache.FOLDER: folder}):
        for _round in range(ROUNDS):
            plan = plan_of(name, DIMENSIONS[name])
            scan = Scan((PARAMETER,), plan.names, plan.outputs)
            found["trace"].append(plan.took)
            for entry in Path(folder).iterdir():
                entry.unlink()
            forget()
            for label in ("compile", "from disk", "from memory"):
                begin = time.process_time()
                kernel_of(scan, lanes_inside=True)
                found[label].append(time.process_time() - begin)
                if label == "compile":
                    forget()
    numbers = {label: 1e3 * median(times) for label, times in found.items()}
    made = numbers["trace"] + numbers["compile"]
    return Row(
        f"{name}, made [ms]",
        numbers,
        promises=[
            Promise(f"{name}, traced and compiled [ms]", made, MADE[name]),
            Promise(f"{name}, from the disk cache [ms]", numbers["from disk"], 20.0),
        ],
    )


def _on_the_sphere(sphere: Plan, plane: Plan) -> Row:
    """The spherical four-bar linkage over the planar one: the same outputs in the same way."""
    ways: dict[str, list[Task]] = {"written in cache": [streamed(x, x.outputs)[0] for x in (sphere, plane)]}
    for label in _reductions(plane):
        ways[label] = []
        for plan in (sphere, plane):
            kernel, start = _running(plan, _reductions(plan)[label])
            ways[label].append(functools.partial(kernel.run, plan.by_lanes, DRIVE, start))
    numbers = {}
    for label, (on_sphere, in_plane) in ways.items():
        times = paired_times({"sphere": on_sphere, "plane": in_plane}, ROUNDS)
        numbers[label] = ratio(times, "sphere", "plane")
    promises = [
        Promise(f"spherical four-bar, {label}, over the planar", x, 2.5) for label, x in numbers.items()
    ]
    return Row("spherical four-bar / planar", numbers, promises=promises)
