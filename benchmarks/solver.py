"""One mechanism whose numbers change: a move of a solver, against kernels called directly and against `motion`."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Mapping
from itertools import count
from statistics import median

import numpy as np

import centrode as ct
from benchmarks.plans import SIX
from benchmarks.table import Promise, Row
from benchmarks.timing import Task, paired_times, ratio
from centrode.kinematics.machine_code.frame_kernels import PlaceScan
from centrode.kinematics.machine_code.frame_plan import DirectPlan
from centrode.numerics.machine_code.kernels import Stream, address
from centrode.sweeps.solver import Solver

SAMPLES = 361
MOST = {"crank-rocker": 0.5, "six-bar-press": 0.75, "spherical-four-bar": None}
"""Milliseconds that a move may take on the machine of docs/benchmarks.md."""
OVER_DIRECT = 1.5
FIRST, FROM_DISK = 70.0, 20.0
"""Milliseconds from a six-bar's description to its first frame, LLVM loaded: nothing kept, and all on disk."""
FIRST_FRAME = """
import time
import centrode as ct
from benchmarks.plans import SIX
ct.solver("crank-rocker", ["links.AB.length"]).move([3.5])
start = time.process_time()
lever = ct.solver("six-bar-press", SIX["six-bar-press"])
lever.move(lever.own)
print(1e3 * (time.process_time() - start))
"""


def moves() -> Iterator[Row]:
    """All rows."""
    for name, most in MOST.items():
        yield _move(name, most)
    yield _with_outputs()
    yield _first_frame()


def _move(name: str, most: float | None) -> Row:
    mechanism = ct.example(name)
    lever, steps = ct.solver(mechanism, SIX[name], SAMPLES), count()

    def values() -> list[float]:
        return [x * (1.0 + 1e-7 * (next(steps) % 1000)) for x in lever.own]

    def changed() -> object:
        return ct.motion(ct.with_value(mechanism, lever.free[0], values()[0]), SAMPLES)

    tasks = {"move": lambda: lever.move(values()), "direct": _direct(lever), "motion": changed}
    times = paired_times(tasks)
    took = 1e3 * median(times["move"])
    against = ratio(times, "move", "direct")
    promises = [
        Promise(f"{name}: move over judging and writing called directly", against, at_most=OVER_DIRECT)
    ]
    if most is not None:
        promises.append(Promise(f"{name}: move [ms]", took, at_most=most))
    numbers = {"move [ms]": took, "over direct": against, "motion over move": ratio(times, "motion", "move")}
    return Row(name, numbers, promises=promises)


def _direct(lever: Solver) -> Task:
    """The solver's own two kernels, called with addresses and nothing around them."""
    plan = lever._plan
    assert isinstance(plan, DirectPlan)
    memory, known = plan.memory(), plan.numbers.known(lever.own)
    further = plan.kernels.judge.judge(known, memory)
    assert further is not None
    judge = _bare_call(plan.kernels.judge.scan, known, memory.mesh)
    write = _bare_call(plan.kernels.write, known | further, memory.room)

    def run() -> None:
        judge()
        write()

    return run


def _bare_call(scan: PlaceScan, known: Mapping[str, float], room: np.ndarray) -> Task:
    """The call of a kernel with one mechanism, all its arguments made before."""
    stream = scan.take
    assert isinstance(stream, Stream)
    size, call = room.itemsize, stream.kernel.function.call
    rows = stream.kernel.tables.of_steps.below(np.array([[known[name]] for name in scan.names]))
    lanes = stream.kernel.tables.of_lanes.below(stream.parameters)
    arguments = (
        stream.lanes, 1, address(lanes), lanes.strides[0] // size, address(rows), rows.strides[0] // size,
        0, 0, 0, 0, address(room), room.strides[0] // size, room.strides[1] // size,
    )  # fmt: skip

    def run(_kept: object = (rows, lanes, room)) -> None:
        call(*arguments)

    return run


def _with_outputs() -> Row:
    """A path error of 36 positions with its gradient by six dimensions."""
    error = "sum((position_B_x - 1)**2 + (position_B_y - 2)**2)"
    lever = ct.solver("crank-rocker", SIX["crank-rocker"], 36, outputs=error)
    times = paired_times(
        {"value": lambda: lever.outputs(lever.own), "gradient": lambda: lever.gradient(lever.own)}
    )
    numbers = {
        "value [ms]": 1e3 * median(times["value"]),
        "gradient over value": ratio(times, "gradient", "value"),
    }
    return Row("crank-rocker, path error", numbers)


def _first_frame() -> Row:
    """Processor time of a six-bar's first frame in processes of their own, after another mechanism loaded LLVM."""
    empty: list[float] = []
    kept: list[float] = []
    for _round in range(5):
        with tempfile.TemporaryDirectory() as folder:
            environment = os.environ | {"CENTRODE_CACHE": folder}
            for times in (empty, kept):
                told = subprocess.run(
                    [sys.executable, "-c", FIRST_FRAME],
                    env=environment,
                    capture_output=True,
                    text=True,
                    check=True,
                )
                times.append(float(told.stdout))
    promises = [
        Promise("six-bar-press: first frame, empty cache [ms]", median(empty), at_most=FIRST),
        Promise("six-bar-press: first frame from disk [ms]", median(kept), at_most=FROM_DISK),
    ]
    numbers = {"empty [ms]": median(empty), "from disk [ms]": median(kept)}
    return Row("six-bar-press, first frame", numbers, promises=promises)
