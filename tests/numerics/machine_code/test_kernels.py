"""Kernels of traced plans: the numbers of NumPy, threads, what a call may be given."""

from __future__ import annotations

import math
import threading
import time
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import centrode as ct
from centrode.kinematics.plan_evaluation import FixedSigns
from centrode.kinematics.preparation import ready
from centrode.numerics.expressions import EXPRESSIONS, variable
from centrode.numerics.graphs import Graph
from centrode.numerics.jets import Jet, JetFunctions
from centrode.numerics.scans import Scan, run_on_arrays

NEEDS = "machine code needs llvmlite: pip install 'centrode[fast]'"
kernels = pytest.importorskip("centrode.numerics.machine_code.kernels", reason=NEEDS)

EPS = 2.0**-52
MECHANISMS = ("crank-rocker", "six-bar-press", "slider-between-cranks", "jansen-leg", "wiper")


def traced(name: str) -> tuple[Scan, np.ndarray]:
    """Points of a built-in mechanism with two derivatives, and the angles of its links; its dimensions."""
    prepared = ready(ct.example(name))
    values: list[float] = []

    def vary(x: Any) -> Any:
        if x in (0.0, 1.0, -1.0):
            return x
        values.append(float(x))
        return variable(f"dimension {len(values) - 1}")

    kinematics = prepared.kinematics
    numbers = kinematics.numbers.map_numbers(vary)
    jets = JetFunctions(EXPRESSIONS)
    parameter = Jet.variable(variable("drive"), 2)
    at = replace(kinematics, numbers=numbers).positions(
        jets, parameter, FixedSigns(jets, prepared.assembled.signs)
    )
    found = {f"{point} {axis}": x for point, place in at.points.items() for axis, x in enumerate(place)}
    found |= {f"angle {link}": jets.atan2(pose.rotor[1], pose.rotor[0]) for link, pose in at.poses.items()}
    outputs = {
        f"{label}, {k}": x.derivative(k) for label, x in found.items() if isinstance(x, Jet) for k in range(3)
    }
    names = tuple(f"dimension {i}" for i in range(len(values)))
    return Scan(names, ("drive",), Graph.of(outputs).outputs), np.array(values)


@pytest.mark.parametrize("name", MECHANISMS)
def test_plans_give_the_numbers_of_numpy(name: str) -> None:
    """Machine code against NumPy over a turn, lanes far enough apart that some do not close."""
    scan, dimensions = traced(name)
    random = np.random.default_rng(0)
    lanes = dimensions[:, None] * random.uniform(0.6, 1.5, (len(dimensions), 37))
    drive = np.linspace(0, 2 * math.pi, 91)[None]
    expected = run_on_arrays(scan, lanes, drive).outputs
    assert np.isnan(expected).any()
    assert np.isfinite(expected).mean() > 0.3
    for found in (
        kernels.kernel_of(scan).run(lanes, drive).outputs,
        kernels.kernel_of(Scan(("drive",), scan.parameters, scan.outputs), lanes_inside=True)
        .run(drive, lanes)
        .outputs.transpose(0, 2, 1),
    ):
        assert np.array_equal(np.isnan(found), np.isnan(expected))
        exact = [i for i, node in enumerate(scan.outputs.values()) if node.operation != "atan2"]
        distance = np.abs(found - expected)
        assert np.nanmax(distance[exact]) == 0.0
        angles = np.setdiff1d(np.arange(len(scan.outputs)), exact)
        # both are within their bounds of the true angle, 2 ULP and 1
        assert np.nanmax(distance[angles]) <= 3 * EPS * 4


def test_threads_change_nothing() -> None:
    scan, dimensions = traced("crank-rocker")
    turned = Scan(("drive",), scan.parameters, scan.outputs)
    lanes = dimensions[:, None] * np.linspace(0.95, 1.05, 203)
    drive = np.linspace(0, 6, 50)[None]
    for one, parameters, inputs, inside in ((scan, lanes, drive, False), (turned, drive, lanes, True)):
        kernel = kernels.kernel_of(one, lanes_inside=inside)
        alone = kernel.run(parameters, inputs).outputs
        for threads in (2, 3, 7):
            assert np.array_equal(
                kernel.run(parameters, inputs, threads=threads).outputs, alone, equal_nan=True
            )


def test_states_of_threads() -> None:
    a, x = variable("a"), variable("x")
    kernel = kernels.kernel_of(Scan(("a",), (), {}, {"x": x + a}))
    lanes = np.arange(101.0)[None]
    found = kernel.run(lanes, None, np.ones((1, 101)), steps=10, threads=3).state
    assert np.array_equal(found, 10 * lanes + 1)


def test_other_threads_run_meanwhile() -> None:
    """The interpreter's lock is free while a kernel works: this thread wakes up many times within one call.

    On a busy machine it may sleep through a call, so the calls grow until one is seen.
    """
    x = variable("x")
    kernel = kernels.kernel_of(Scan((), (), {}, {"x": EXPRESSIONS.sqrt(x + 2.0)}))
    turns, seen, done = 0, threading.Event(), threading.Event()

    def work() -> None:
        steps = 1 << 16
        while not seen.is_set() and steps < 1 << 32:
            before = turns
            kernel.run(None, None, [[1.0]], steps=steps)
            if turns > before + 5:  # around the call itself a switch or two
                seen.set()
            steps *= 2
        done.set()

    thread = threading.Thread(target=work)
    thread.start()
    while not done.is_set():
        time.sleep(0.002)
        turns += 1
    thread.join()
    assert seen.is_set()


def test_inputs_of_any_layout() -> None:
    """Transposed, strided and single arrays come out the same as plain ones."""
    a, t = variable("a"), variable("t")
    kernel = kernels.kernel_of(Scan(("a", "b"), ("t",), {"y": a * t + variable("b")}))
    lanes = np.random.default_rng(0).uniform(size=(2, 50)).astype(np.float32).astype(float)
    steps = np.arange(4.0)[None]
    expected = kernel.run(lanes, steps).outputs
    wide = np.repeat(lanes, 2, axis=1)[:, ::2]
    for given in (
        np.asfortranarray(lanes),
        wide,
        lanes.astype(np.float32),
        lanes.tolist(),
        lanes[:, ::-1][:, ::-1],
    ):
        assert np.array_equal(kernel.run(given, steps).outputs, expected)


def test_single_numbers_are_about_as_exact_as_they_can_be() -> None:
    scan, dimensions = traced("crank-rocker")
    lanes = dimensions[:, None] * np.linspace(0.99, 1.01, 20)
    drive = np.linspace(0, 6, 50)[None]
    whole = kernels.kernel_of(scan).run(lanes, drive).outputs
    single = kernels.kernel_of(scan, "float32").run(lanes, drive).outputs
    positions = [
        i for i, name in enumerate(scan.outputs) if name.startswith(("A ", "B ")) and name.endswith(", 0")
    ]
    # the transmission angle of this linkage stays above half a radian; some twenty roundings of numbers below 20
    assert np.abs(single[positions] - whole[positions]).max() <= 40 * 2.0**-24 * 20
