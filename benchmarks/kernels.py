"""Machine code: traced plans against the machine's bounds, NumPy, other compilers and the compiled peer."""

from __future__ import annotations

import functools
import os
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from statistics import median
from typing import Any
from unittest.mock import patch

import numpy as np
import numpy.typing as npt

import centrode as ct
from benchmarks import peer, rivals
from benchmarks.motions import peer_of
from benchmarks.table import Row
from benchmarks.timing import best_times
from centrode.algebra import machine_code
from centrode.algebra.expression_functions import EXPRESSIONS
from centrode.algebra.expressions import Node, variable
from centrode.algebra.graph_arrays import run_on_arrays
from centrode.algebra.graphs import Graph
from centrode.algebra.jet_functions import JetFunctions
from centrode.algebra.jets import Jet
from centrode.algebra.machine_code import cache
from centrode.algebra.reductions import greatest, least, together, total, total_with_gradient
from centrode.algebra.scans import Scan, call_of
from centrode.kinematics.evaluate import FixedSigns
from centrode.kinematics.ready import ready

if machine_code.PRESENT:
    from centrode.algebra.machine_code.kernels import Kernel, forget, kernel_of

Array = npt.NDArray[np.float64]
MISSING = "llvmlite is not installed: pip install 'centrode[fast]'"
MECHANISMS = ("crank-rocker", "six-bar-press")
SAMPLES = 361
LANES = 2000
"""Mechanisms of a batch: the outputs of one take no more than some hundred megabytes."""
DIVIDED = 8
ROUNDS = 7
OF_PEER = ("peer motion", "peer positions")
OTHERS = ("gcc", "numba", *OF_PEER)


@dataclass(frozen=True)
class Traced:
    """A plan as a graph: points and angles with two derivatives, by dimensions and the drive's value.

    The crank, its end and its angle, is left out: they are products with what all mechanisms have in common.
    """

    outputs: Mapping[str, Node]
    names: tuple[str, ...]
    dimensions: Array
    took: float

    @property
    def by_lanes(self) -> Array:
        """Dimensions of a batch, (dimensions, LANES)."""
        spread = np.random.default_rng(0).uniform(0.98, 1.02, (len(self.names), LANES))
        return self.dimensions[:, None] * spread


def traced(name: str) -> Traced:
    """The plan of a built-in mechanism, every dimension of it a variable."""
    prepared = ready(ct.example(name))
    values: list[float] = []

    def vary(x: Any) -> Any:
        if x in (0.0, 1.0, -1.0):  # lengths that are left out of the formulas, and directions of guides
            return x
        values.append(float(x))
        return variable(f"dimension {len(values) - 1}")

    start = time.process_time()
    kinematics = replace(prepared.kinematics, numbers=prepared.kinematics.numbers.mapped(vary))
    jets = JetFunctions(EXPRESSIONS)
    drive = Jet.variable(variable("drive"), 2)
    at = kinematics.positions(jets, drive, FixedSigns(jets, prepared.assembled.signs))
    crank = prepared.mechanism.drives[0].link
    moving = [
        point
        for point in prepared.mechanism.moving_points
        if point not in prepared.mechanism.links[str(crank)].coordinates
    ]
    outputs = {
        f"{point} {axis}, {k}": x.derivative(k)
        for point in moving
        for axis, x in enumerate(at.points[point])
        for k in range(3)
    }
    for link, pose in at.poses.items():
        if link != crank and isinstance(pose.rotor[0], Jet):
            outputs |= {f"angle {link}, {k}": x for k, x in enumerate(_angle(*pose.rotor))}
    names = tuple(f"dimension {i}" for i in range(len(values)))
    return Traced(Graph.of(outputs).outputs, names, np.array(values), time.process_time() - start)


def _angle(cosine: Jet, sine: Jet) -> list[Any]:
    """An angle with two derivatives as a motion has them: those of a rotor, whose length is one."""
    rates = [cosine.value * sine.derivative(k) - sine.value * cosine.derivative(k) for k in (1, 2)]
    return [EXPRESSIONS.atan2(sine.value, cosine.value), *rates]


DRIVE = np.linspace(0.0, 2.0 * np.pi, SAMPLES)[None]


def kernels() -> Iterator[Row]:
    """All rows."""
    write, divide = _write_bound(), _divider_bound()
    yield Row("bounds [ns]", {"a number written": write, "a division": divide})
    for name in MECHANISMS:
        plan = traced(name)
        yield _written(name, plan, write)
        yield from _reduced(name, plan, divide)
        yield _gradient(name, plan)
        yield _compiled(name, plan)


def _write_bound() -> float:
    """Time to write a number to memory [ns]."""
    large = np.zeros(1 << 24)
    return best_times({"write": functools.partial(large.fill, 1.0)})["write"] / large.size * 1e9


def _divider_bound() -> float:
    """Time of a division or a root in vectors as wide as the kernels' [ns]: several that do not wait for each other."""
    states = [variable(f"s{i}") for i in range(DIVIDED)]
    scan = Scan((), ("drive",), {}, {f"s{i}": variable("drive") / state for i, state in enumerate(states)})
    run = functools.partial(kernel_of(scan).run, None, DRIVE + 1.0, np.ones((DIVIDED, LANES)))
    return best_times({"divide": run})["divide"] / (LANES * SAMPLES * DIVIDED) * 1e9


def _written(name: str, plan: Traced, write: float) -> Row:
    """All outputs, into a buffer that is there: lanes are samples, so that each output is one stream."""
    scan = Scan(("drive",), plan.names, plan.outputs)
    kernel, lanes = kernel_of(scan, lanes_inside=True), plan.by_lanes
    out = np.zeros((len(plan.outputs), LANES, SAMPLES))
    few = lanes[:, : LANES // 20]
    tasks: dict[str, Callable[[], object]] = {
        "kernel": functools.partial(kernel.run, DRIVE, lanes, out=out),
        "write": functools.partial(out.fill, 1.0),
        "numpy": functools.partial(run_on_arrays, scan, DRIVE, few, out=out[:, : few.shape[1]].copy()),
    }
    with tempfile.TemporaryDirectory() as folder:
        prepared = kernel.tables.added(call_of(scan, DRIVE, lanes, out=out))
        for rival, there, build in (
            ("gcc", rivals.HAS_GCC, rivals.by_gcc), ("numba", rivals.HAS_NUMBA, rivals.by_numba),
        ):  # fmt: skip
            if there:
                tasks[rival] = functools.partial(build(kernel.rest, Path(folder)), prepared)
        if peer.PRESENT:
            tasks |= _peers(name)
        times = best_times(tasks, rounds=ROUNDS)
    times["numpy"] *= LANES / few.shape[1]
    for run in OF_PEER:
        if run in times:
            times[run] *= LANES
    each = 1e9 / (LANES * SAMPLES)
    numbers = {
        "outputs": float(len(plan.outputs)),
        "ns": times["kernel"] * each,
        "/ writing": times["kernel"] / times["write"],
        "numpy /": times["numpy"] / times["kernel"],
    }
    numbers |= {f"{rival} /": times[rival] / times["kernel"] for rival in OTHERS if rival in times}
    return Row(f"{name}, written", numbers)


def _peers(name: str) -> dict[str, Callable[[], object]]:
    """The peer's compiled runs of one mechanism: with velocities and accelerations, and positions alone."""
    mechanism = ct.example(name)
    prepared, motion = ready(mechanism), ct.motion(mechanism, SAMPLES)
    other = peer_of(prepared, prepared.structure.dimensions, motion)
    return {
        "peer motion": functools.partial(other.motion, SAMPLES),
        "peer positions": functools.partial(other.positions, SAMPLES),
    }


def _reduced(name: str, plan: Traced, divide: float) -> Iterator[Row]:
    """One number a mechanism: path extremes of a point, and all outputs together."""
    point = next(iter(plan.outputs.values()))
    whole = functools.reduce(lambda a, b: a + b, plan.outputs.values())
    for label, reduction in (
        ("extremes of a coordinate", together(greatest("hi", point), least("lo", point))),
        ("all outputs to one number", total("sum", whole)),
    ):
        scan = Scan(plan.names, ("drive",), {}, reduction.state)
        start = [[value] for value in reduction.start.values()]
        kernel, relaxed = kernel_of(scan), kernel_of(scan, relaxed=True)
        lanes = plan.by_lanes
        few = lanes[:, : LANES // 20]
        tasks = {
            "kernel": functools.partial(kernel.run, lanes, DRIVE, start),
            "relaxed": functools.partial(relaxed.run, lanes, DRIVE, start),
            "numpy": functools.partial(
                run_on_arrays, Scan(plan.names, ("drive",), _values(reduction.state)), few, DRIVE
            ),
        }
        times = best_times(tasks, rounds=ROUNDS)
        times["numpy"] *= LANES / few.shape[1]
        counts = kernel.rest.graph.counts
        divisions = counts["divide"] + counts["sqrt"] + counts["atan2"]
        each = 1e9 / (LANES * SAMPLES)
        yield Row(
            f"{name}, {label}",
            {
                "divisions": float(divisions),
                "ns": times["kernel"] * each,
                "/ divider": times["kernel"] * each / (divisions * divide),
                "relaxed /": times["relaxed"] / times["kernel"],
                "numpy /": times["numpy"] / times["kernel"],
                "1 thread / 2": _two_threads(kernel, lanes, start),
            },
        )


def _values(state: Mapping[str, Node]) -> dict[str, Node]:
    """What is reduced, as outputs: NumPy reduces arrays by itself."""
    return {
        name: node.arguments[0] if node.operation != "where" else node.arguments[1].arguments[1]
        for name, node in state.items()
    }


def _two_threads(kernel: Kernel, lanes: Array, start: list[list[float]]) -> float:
    """Elapsed time of one thread over that of two, median of paired runs."""
    lanes, ratios = np.tile(lanes, 10), []  # long enough for threads to begin
    for _round in range(ROUNDS):
        times = []
        for threads in (1, 2):
            begin = time.perf_counter()
            kernel.run(lanes, DRIVE, start, threads=threads)
            times.append(time.perf_counter() - begin)
        ratios.append(times[0] / times[1])
    return median(ratios)


def _gradient(name: str, plan: Traced) -> Row:
    """A path error and its derivatives by six dimensions (or as many as there are), over the error alone."""
    x, y = (plan.outputs[key] for key in list(plan.outputs)[:6:3])
    error = (x - 1.0) * (x - 1.0) + (y - 2.0) * (y - 2.0)
    by = [variable(name) for name in plan.names[:6]]
    runs = {}
    for label, reduction in (
        ("value", total("error", error)),
        ("gradient", total_with_gradient("error", error, by)),
    ):
        scan = Scan(plan.names, ("drive",), {}, reduction.state)
        start = [[value] for value in reduction.start.values()]
        runs[label] = functools.partial(kernel_of(scan).run, plan.by_lanes, DRIVE, start)
    times = best_times(runs, rounds=ROUNDS)
    each = 1e9 / (LANES * SAMPLES)
    return Row(
        f"{name}, path error and gradient",
        {
            "by": float(len(by)),
            "ns": times["value"] * each,
            "with gradient / value": times["gradient"] / times["value"],
        },
    )


def _compiled(name: str, plan: Traced) -> Row:
    """Processor time from a plan to a kernel: traced, compiled, found on disk, found in memory; medians."""
    scan = Scan(("drive",), plan.names, plan.outputs)
    found: dict[str, list[float]] = {"trace": [], "compile": [], "from disk": [], "from memory": []}
    with tempfile.TemporaryDirectory() as folder, patch.dict(os.environ, {cache.FOLDER: folder}):
        for _round in range(ROUNDS):
            found["trace"].append(traced(name).took)
            for entry in Path(folder).iterdir():
                entry.unlink()
            forget()
            for label in ("compile", "from disk", "from memory"):
                begin = time.process_time()
                kernel_of(scan, lanes_inside=True)
                found[label].append(time.process_time() - begin)
                if label == "compile":
                    forget()
    return Row(f"{name}, made [ms]", {label: 1e3 * median(times) for label, times in found.items()})
