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
"""Mechanisms of a sweep: reduced by machine code; by arrays."""
KEPT = 10_000
"""Mechanisms of a sweep by machine code with every sample written: what is done once should not count."""
ROUNDS = 5
MECHANISMS = {
    "crank-rocker": (("links.AB.length", "links.DB.length"), "B"),
    "six-bar-press": (("links.OA.length", "links.DH.points.H.x"), "D"),
    "spherical-four-bar": (("links.AB.length",), "C"),
}
"""Dimensions that vary by one per cent, and the point that is looked at."""


def sweeps() -> Iterator[Row]:
    """All rows."""
    for name, (paths, point) in MECHANISMS.items():
        yield from _reduced(name, paths, point)
        yield _written(name, paths, point)
        yield _motions(name, paths)
    yield from _with_events()


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
    mechanism = ct.example(name)
    many, few = _values(name, paths, KEPT), _values(name, paths, FEW)
    outputs = [f"{kind}.{point}" for kind in ("position", "velocity", "acceleration")]
    run = functools.partial(ct.sweep, mechanism, outputs=outputs, samples=SAMPLES)
    numbers = 3 * (2 if mechanism.space == "plane" else 3)
    times = best_times(
        {
            "code": functools.partial(run, vary=many, executor="machine code"),
            "arrays": functools.partial(run, vary=few, executor="arrays"),
            "fresh": functools.partial(_fresh, KEPT * SAMPLES * numbers),
        },
        rounds=ROUNDS,
    )
    return Row(
        f"{name}, written",
        {
            "numbers": float(numbers),
            "ns": times["code"] / (KEPT * SAMPLES) * 1e9,
            "/ fresh memory": times["code"] / times["fresh"],
            "arrays /": times["arrays"] / FEW / (times["code"] / KEPT),
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


def _with_events() -> Iterator[Row]:
    """Sweeps and motions of mechanisms that meet limits, or pass change points."""
    draw = np.random.default_rng(0)
    size = draw.uniform(0.9, 1.1, 4 * FEW)
    press = ct.value_at(ct.example("six-bar-press"), "links.OA.length")
    for label, name, point, vary in (
        ("some locked", "crank-rocker", "B", {"links.AB.length": draw.uniform(1.5, 3.5, 4 * FEW)}),
        ("all locked", "crank-rocker", "B", {"links.AB.length": draw.uniform(1.1, 1.9, 4 * FEW)}),
        ("most locked", "six-bar-press", "D", {"links.OA.length": press * draw.uniform(1.5, 3.0, 4 * FEW)}),
        ("two change points", "parallelogram", "B", {"links.OA.length": size, "links.DB.length": size}),
    ):
        few = {path: values[:FEW] for path, values in vary.items()}
        run = functools.partial(ct.sweep, ct.example(name), outputs=f"position.{point}", samples=SAMPLES)
        prepared = ready(ct.example(name))
        span = asked_span(prepared, SAMPLES, None, None)
        numbers = dimensions_of(prepared.mechanism, few, np)
        times = best_times(
            {
                "reduced": functools.partial(run, vary=vary, reduce="range", executor="machine code"),
                "written": functools.partial(run, vary=vary, executor="machine code"),
                "motions": functools.partial(solve_many, prepared, span, numbers, FEW),
                "arrays reduced": functools.partial(run, vary=few, reduce="range", executor="arrays"),
                "arrays written": functools.partial(run, vary=few, executor="arrays"),
                "arrays motions": functools.partial(solve, prepared, span, numbers, FEW),
            },
            rounds=ROUNDS,
        )
        found = run(vary=few, reduce="range", executor="arrays")
        yield Row(
            f"{name}, {label}",
            {
                "not whole": float((found["samples_ok"] < SAMPLES).mean()),
                "ns reduced": times["reduced"] / (4 * FEW * SAMPLES) * 1e9,
                "arrays / reduced": 4 * times["arrays reduced"] / times["reduced"],
                "ns written": times["written"] / (4 * FEW * SAMPLES) * 1e9,
                "arrays / written": 4 * times["arrays written"] / times["written"],
                "ns motions": times["motions"] / (FEW * SAMPLES) * 1e9,
                "arrays / motions": times["arrays motions"] / times["motions"],
            },
        )
