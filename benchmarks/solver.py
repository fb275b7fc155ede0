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
from centrode.kinematics.machine_code.frame_calls import MOVE, TURN
from centrode.kinematics.machine_code.frame_kernels import PlaceScan
from centrode.kinematics.machine_code.frame_plan import DirectPlan
from centrode.numerics.machine_code.kernels import Stream, address
from centrode.sweeps.solver import Solver

SAMPLES = 361
MOST = {"crank-rocker": 0.5, "six-bar-press": 0.75, "spherical-four-bar": None}
"""Milliseconds that a move may take on the machine of docs/benchmarks.md."""
OVER_DIRECT, OVER_VALUE = 1.5, 4.0
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
    yield _with_reactions()
    yield _first_frame()


def _move(name: str, most: float | None) -> Row:
    mechanism = ct.example(name)
    lever, steps = ct.solver(mechanism, SIX[name], SAMPLES), count()

    def values() -> list[float]:
        return [x * (1.0 + 1e-7 * (next(steps) % 1000)) for x in lever.own]

    def changed() -> object:
        return ct.motion(ct.with_value(mechanism, lever.free[0], values()[0]), SAMPLES)

    tasks = {
        "move": lambda: lever.move(values()),
        "direct": _direct(lever),
        "called": _called(lever),
        "motion": changed,
    }
    times = paired_times(tasks)
    took = 1e3 * median(times["move"])
    against, over = ratio(times, "move", "direct"), ratio(times, "move", "called")
    promises = [Promise(f"{name}: move over judging and writing called directly", over, at_most=OVER_DIRECT)]
    if most is not None:
        promises.append(Promise(f"{name}: move [ms]", took, at_most=most))
    numbers = {
        "move [ms]": took,
        "over judging and writing": over,
        "over bare kernels": against,
        "motion over move": ratio(times, "motion", "move"),
    }
    return Row(name, numbers, promises=promises)


def _called(lever: Solver) -> Task:
    """The machine code that judges and writes, called with addresses, and NumPy's arc tangents: no Python besides."""
    plan = lever._plan
    assert isinstance(plan, DirectPlan)
    called = plan.called_frames
    assert called is not None
    memory = called.memory()
    assert called.move(lever.own, memory)
    run, at, sines, cosines, angles = called.run, memory.address, memory.sines, memory.cosines, memory.angles

    # the table has addresses alone: what they lead to has to be there as long as the task
    def task(_kept: object = memory) -> None:
        run(at, MOVE)
        np.arctan2(sines, cosines, angles)
        run(at, TURN)

    return task


def _direct(lever: Solver) -> Task:
    """The solver's own kernels at nodes and samples, called with addresses and nothing around them."""
    plan = lever._plan
    assert isinstance(plan, DirectPlan)
    kernels, memory, known = plan.kernels, plan.kernels.memory(), plan.numbers.known(lever.own)
    further = kernels.judge.judge(known, memory)
    assert further is not None
    rooms = (memory.mesh, memory.sparse, memory.room)
    calls = [_bare_call(x, known | further, room) for x, room in zip(kernels.scans, rooms, strict=True)]

    def run() -> None:
        for call in calls:
            call()

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


def _with_reactions() -> Row:
    """The greatest force in a hinge of a press with its gradient by six dimensions, against `reactions`."""
    force = "max(sqrt(joint_force_B_AB_x**2 + joint_force_B_AB_y**2))"
    mechanism, free = ct.example("six-bar-press"), SIX["six-bar-press"]
    lever = ct.solver(mechanism, free, SAMPLES, outputs=force)
    every = ct.solver(mechanism, free, SAMPLES, outputs=["joint_force", "balancing"])
    times = paired_times(
        {
            "value": lambda: lever.outputs(lever.own),
            "gradient": lambda: lever.gradient(lever.own),
            "every value": lambda: every.outputs(every.own),
            "every gradient": lambda: every.gradient(every.own),
            "reactions": lambda: ct.reactions(mechanism, SAMPLES),
        }
    )
    reduced, whole = ratio(times, "gradient", "value"), ratio(times, "every gradient", "every value")
    promises = [
        Promise("six-bar-press: gradient of a reaction over its value", reduced, at_most=OVER_VALUE),
        Promise("six-bar-press: gradients of all reactions over the values", whole, at_most=OVER_VALUE),
    ]
    numbers = {
        "value [ms]": 1e3 * median(times["value"]),
        "gradient over value": reduced,
        "all values [ms]": 1e3 * median(times["every value"]),
        "all gradients over values": whole,
        "reactions over all values": ratio(times, "reactions", "every value"),
    }
    return Row("six-bar-press, reactions", numbers, promises=promises)


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
