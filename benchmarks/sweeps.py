"""Whole sweeps and batches of motions: machine code against the arrays, and against the machine's bounds."""

from __future__ import annotations

import functools
import time
from collections.abc import Callable, Iterator
from statistics import median

import numpy as np
import numpy.typing as npt

import centrode as ct
from benchmarks.table import Row
from benchmarks.timing import best_times
from centrode.kinematics.compiled.many import solve_many
from centrode.kinematics.ready import ready
from centrode.kinematics.solve import asked_span, solve
from centrode.structure.dimensions import dimensions_of

Array = npt.NDArray[np.float64]
SAMPLES = 361
MANY, FEW = 50_000, 500
"""Mechanisms of a sweep: reduced by machine code; by arrays, or with every sample written."""
ROUNDS = 5
MECHANISMS = {
    "crank-rocker": (("links.AB.length", "links.DB.length"), "B"),
    "six-bar-press": (("links.OA.length", "links.DH.points.H.x"), "D"),
    "third-class-triad": (("links.AB.length", "links.DC.length"), "C"),
    "spherical-four-bar": (("links.AB.length",), "C"),
}
"""Dimensions that vary by one per cent, and the point that is looked at."""


def sweeps() -> Iterator[Row]:
    """All rows."""
    for name, (paths, point) in MECHANISMS.items():
        yield from _reduced(name, paths, point)
        yield _written(name, paths, point)
        yield _motions(name, paths)
    yield _with_limits()


def _values(name: str, paths: tuple[str, ...], count: int) -> dict[str, Array]:
    mechanism, draw = ct.example(name), np.random.default_rng(0)
    return {path: ct.value_at(mechanism, path) * draw.uniform(0.99, 1.01, count) for path in paths}


def _reduced(name: str, paths: tuple[str, ...], point: str) -> Iterator[Row]:
    """One number a mechanism, all that is judged included."""
    mechanism = ct.example(name)
    for label, outputs in (
        ("extremes of a point", [f"position.{point}"]),
        ("of all derivatives", [f"{kind}.{point}" for kind in ("position", "velocity", "acceleration")]),
        ("of all angles", ["angle" if mechanism.space == "plane" else "joint_angle"]),
    ):
        run = functools.partial(ct.sweep, mechanism, outputs=outputs, samples=SAMPLES, reduce="range")
        many, few = _values(name, paths, MANY), _values(name, paths, FEW)
        times = best_times(
            {
                "code": functools.partial(run, vary=many, executor="machine code"),
                "gradient": functools.partial(run, vary=many, executor="machine code", gradient=True),
                "arrays": functools.partial(run, vary=few, executor="arrays"),
            },
            rounds=ROUNDS,
        )
        yield Row(
            f"{name}, {label}",
            {
                "ns": times["code"] / (MANY * SAMPLES) * 1e9,
                "arrays /": times["arrays"] / FEW / (times["code"] / MANY),
                "with gradient /": times["gradient"] / times["code"],
                "1 thread / 2": _two_threads(run, many),
            },
        )


def _two_threads(run: Callable[..., object], many: dict[str, Array]) -> float:
    """Elapsed time of one thread over that of two, median of paired runs."""
    ratios = []
    for _round in range(ROUNDS):
        times = []
        for threads in (1, 2):
            begin = time.perf_counter()
            run(vary=many, executor="machine code", threads=threads)
            times.append(time.perf_counter() - begin)
        ratios.append(times[0] / times[1])
    return median(ratios)


def _written(name: str, paths: tuple[str, ...], point: str) -> Row:
    """Every sample, into memory that is fresh."""
    mechanism, few = ct.example(name), _values(name, paths, 4 * FEW)
    outputs = [f"{kind}.{point}" for kind in ("position", "velocity", "acceleration")]
    run = functools.partial(ct.sweep, mechanism, few, outputs, SAMPLES)
    numbers = 3 * (2 if mechanism.space == "plane" else 3)
    times = best_times(
        {
            "code": functools.partial(run, executor="machine code"),
            "arrays": functools.partial(run, executor="arrays"),
            "fresh": functools.partial(_fresh, 4 * FEW * SAMPLES * numbers),
        },
        rounds=ROUNDS,
    )
    positions = 4 * FEW * SAMPLES
    return Row(
        f"{name}, written",
        {
            "numbers": float(numbers),
            "ns": times["code"] / positions * 1e9,
            "/ fresh memory": times["code"] / times["fresh"],
            "arrays /": times["arrays"] / times["code"],
        },
    )


def _fresh(numbers: int) -> None:
    np.empty(numbers).fill(1.0)


def _motions(name: str, paths: tuple[str, ...]) -> Row:
    """Everything a motion has, of many mechanisms."""
    prepared = ready(ct.example(name))
    values = _values(name, paths, FEW)
    numbers = dimensions_of(prepared.mechanism, values, np)
    span = asked_span(prepared, SAMPLES, None, None)
    times = best_times(
        {
            "code": functools.partial(solve_many, prepared, span, numbers, FEW),
            "arrays": functools.partial(solve, prepared, span, numbers, FEW),
        },
        rounds=ROUNDS,
    )
    each = 1e9 / (FEW * SAMPLES)
    return Row(f"{name}, motions", {"ns": times["code"] * each, "arrays /": times["arrays"] / times["code"]})


def _with_limits() -> Row:
    """A sweep of which some mechanisms meet limits, and are left to the arrays."""
    draw = np.random.default_rng(0)
    vary = {"links.AB.length": draw.uniform(1.5, 3.5, 4 * FEW)}
    run = functools.partial(ct.sweep, ct.example("crank-rocker"), vary, "position.B", SAMPLES, reduce="range")
    times = best_times(
        {name: functools.partial(run, executor=name) for name in ("machine code", "arrays")}, rounds=ROUNDS
    )
    found = run(executor="arrays")
    return Row(
        "crank-rocker, some locked",
        {
            "share of limits": float((found["samples_ok"] < SAMPLES).mean()),
            "arrays /": times["arrays"] / times["machine code"],
        },
    )
