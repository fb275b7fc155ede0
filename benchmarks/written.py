"""Kernels whose every output is written: to memory, and into a buffer that stays in the cache as a sweep's does."""

from __future__ import annotations

import functools
import tempfile
from collections.abc import Mapping
from pathlib import Path
from statistics import median

import numpy as np

import centrode as ct
from benchmarks import peer, rivals
from benchmarks.motions import peer_of
from benchmarks.plans import DRIVE, EACH, LANES, SAMPLES, Plan
from benchmarks.table import Promise, Row
from benchmarks.timing import ROUNDS, Task, Times, paired_times, ratio
from centrode.kinematics.machine_code.variables import PARAMETER
from centrode.kinematics.preparation import ready
from centrode.numerics import machine_code
from centrode.numerics.expressions import Node
from centrode.numerics.scans import Scan, call_of, room_of, run_on_arrays
from centrode.sweeps.designs import KERNEL_BUFFER

if machine_code.PRESENT:
    from centrode.numerics.machine_code.kernels import Stream, kernel_of

FEW = LANES // 20
"""Mechanisms that NumPy computes: its time for a position does not depend on their number."""
LARGEST_CACHE = 400_000_000
"""Bytes; a server's last cache holds much of a buffer that is smaller, and filling it is no writing to memory."""
OVER_WRITING = {"crank-rocker": 1.5, "six-bar-press": 1.6}
OVER_PEER = {"crank-rocker": {"peer motion": 60.0, "peer positions": 20.0}}


def to_memory(name: str, plan: Plan) -> Row:
    """All outputs, into a large buffer that is there: lanes are samples, so that each output is one stream."""
    scan = Scan((PARAMETER,), plan.names, plan.outputs)
    times_over = -(-LARGEST_CACHE // (8 * len(plan.outputs) * LANES * SAMPLES))
    kernel, lanes = kernel_of(scan, lanes_inside=True), np.tile(plan.by_lanes, times_over)
    count = lanes.shape[1]
    out = np.zeros((len(plan.outputs), count, SAMPLES))
    tasks: dict[str, Task] = {
        "kernel": functools.partial(kernel.run, DRIVE, lanes, out=out),
        "write": functools.partial(out.fill, 1.0),
        "numpy": functools.partial(run_on_arrays, scan, DRIVE, lanes[:, :FEW], out=out[:, :FEW].copy()),
    }
    with tempfile.TemporaryDirectory() as folder:
        prepared = kernel.tables.split_call(call_of(scan, DRIVE, lanes, out=out))
        for rival, there, build in (
            ("gcc", rivals.HAS_GCC, rivals.by_gcc), ("numba", rivals.HAS_NUMBA, rivals.by_numba),
        ):  # fmt: skip
            if there:
                tasks[rival] = functools.partial(build(kernel.rest, Path(folder)), prepared)
        times = paired_times(tasks, ROUNDS)
    times["numpy"] = [x * count / FEW for x in times["numpy"]]
    over, each = ratio(times, "kernel", "write"), EACH / times_over
    numbers = {"outputs": float(len(plan.outputs)), "ns": median(times["kernel"]) * each, "/ writing": over}
    numbers |= {f"{x} /": ratio(times, x, "kernel") for x in ("numpy", "gcc", "numba") if x in times}
    what = f"{name}, {len(plan.outputs)} numbers written to memory, over writing"
    promises = [Promise(what, over, OVER_WRITING[name])] if name in OVER_WRITING else []
    return Row(f"{name}, written to memory", numbers, promises=promises)


def streamed(plan: Plan, outputs: Mapping[str, Node], relaxed: bool = False) -> tuple[Task, Task]:
    """The batch through a buffer that stays in the cache, as a sweep takes it; the same buffer only filled."""
    scan = Scan((PARAMETER,), plan.names, outputs)
    kernel, lanes = kernel_of(scan, lanes_inside=True, relaxed=relaxed), plan.by_lanes
    chunk = KERNEL_BUFFER // (8 * len(outputs) * SAMPLES)
    buffer = room_of(len(outputs), chunk, SAMPLES)
    parts = [lanes[:, first : first + chunk] for first in range(0, LANES, chunk)]

    def run() -> None:
        stream = Stream(kernel, DRIVE)
        for part in parts:
            stream(part, buffer[:, : part.shape[1]])

    def fill() -> None:
        for part in parts:
            buffer[:, : part.shape[1]] = 1.0

    return run, fill


def in_cache(name: str, plan: Plan) -> Row:
    """All outputs, those of points, and positions alone, into a small buffer that is used again.

    The peer keeps nothing either; it has no angles.
    """
    tasks = _peers(name) if peer.PRESENT and ct.example(name).space == "plane" else {}
    tasks["kernel"], tasks["write"] = streamed(plan, plan.outputs)
    tasks["relaxed"], _ = streamed(plan, plan.outputs, relaxed=True)
    tasks["positions"], _ = streamed(plan, plan.positions)
    tasks["points"], _ = streamed(plan, plan.of_points)
    times = paired_times(tasks, ROUNDS)
    for run in ("peer motion", "peer positions"):
        if run in times:
            times[run] = [x * LANES for x in times[run]]
    return Row(
        f"{name}, written in cache",
        {
            "outputs": float(len(plan.outputs)),
            "ns": median(times["kernel"]) * EACH,
            "/ writing": ratio(times, "kernel", "write"),
            "relaxed /": ratio(times, "relaxed", "kernel"),
            "points alone, ns": median(times["points"]) * EACH,
            "positions alone, ns": median(times["positions"]) * EACH,
            **_over_peer(times),
        },
        promises=_promised_over_peer(name, times) if "peer motion" in times else (),
    )


def _over_peer(times: Times) -> dict[str, float]:
    if "peer motion" not in times:
        return {}
    return {
        "peer motion /": ratio(times, "peer motion", "kernel"),
        "peer positions /": ratio(times, "peer positions", "kernel"),
        "peer motion / points": ratio(times, "peer motion", "points"),
        "peer positions / positions": ratio(times, "peer positions", "positions"),
    }


def _promised_over_peer(name: str, times: Times) -> list[Promise]:
    promises = []
    for label, run in (("", "kernel"), (", relaxed", "relaxed"), (", points without angles", "points")):
        for theirs, bound in OVER_PEER.get(name, {}).items():
            what = f"{name}, written in cache{label}: pylinkage's {theirs.removeprefix('peer ')}, times"
            promises.append(Promise(what, ratio(times, theirs, run), at_least=bound))
    return promises


def _peers(name: str) -> dict[str, Task]:
    """The peer's linkage, built and compiled, through one turn: with velocities and accelerations, and positions."""
    mechanism = ct.example(name)
    prepared, motion = ready(mechanism), ct.motion(mechanism, SAMPLES)
    other = peer_of(prepared, prepared.structure.dimensions, motion)
    return {
        "peer motion": functools.partial(other.motion, SAMPLES),
        "peer positions": functools.partial(other.positions, SAMPLES),
    }
