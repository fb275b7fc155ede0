"""Whole sweeps and batches of motions: machine code against the arrays, and against the machine's bounds."""

from __future__ import annotations

import functools
import subprocess
import sys
from collections.abc import Callable, Iterator, Sequence
from statistics import median

import numpy as np
import numpy.typing as npt
import xarray as xr

import centrode as ct
from benchmarks import peer
from benchmarks.plans import SIX
from benchmarks.table import Promise, Row
from benchmarks.timing import Times, best_times, paired_times, ratio, two_threads
from centrode.kinematics.machine_code.batch import solve_many
from centrode.kinematics.preparation import ready
from centrode.kinematics.solve import requested_grid, solve
from centrode.numerics import rooms
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
    "third-class-triad": (("links.AB.length", "links.DC.length"), "C"),
    "spherical-four-bar": (("links.BC.length", "links.DC.length"), "C"),
}
"""Dimensions that vary by one per cent, and the point that is looked at."""
CRANKS = {"crank-rocker": "links.OA.length", "spherical-four-bar": "links.AB.length"}
TARGETS, TRIED = 36, 2_000_000
"""Of a path error: places of the drive, and candidates of a sweep."""
CANDIDATES = {"crank-rocker": (4e6, 2e6), "spherical-four-bar": (2e6, 1e6)}
"""Candidates a second and core, of a path error and of one with six derivatives."""
SECONDS = 3.0
"""In which a billion positions are reduced, of one core: two need half as long."""
LONG = 4
"""How many times as many mechanisms two threads are given: what is done once should not count."""
FOUR_BARS, FOUR_BAR_SAMPLES = 4000, 360
"""Four-bars with every sample kept."""
LENGTHS = ("links.OA.length", "links.AB.length", "links.DB.length")
KINDS = ("position", "velocity", "acceleration")
POINTS = tuple(f"{kind}.{point}" for kind in KINDS for point in "AB")
EVERY = (*KINDS, "angle", "angular_velocity", "angular_acceleration")
PEERS, PEER = 200, 60.0
"""Four-bars that pylinkage is given, and how many times as long as ours its motion should take."""
OVER_BOUND = 1.3
"""A sweep in new pages over what NumPy takes to write as many numbers there."""
AGREE = 1e-9
"""Greatest difference of positions that counts as the same, in units of the greatest length."""
BILLION = 1_000_000_000
MOST_MEMORY = 1e9
"""Bytes that a billion positions may take."""
KILOBYTE = 1 if sys.platform == "darwin" else 1024
"""Unit in which the system tells the memory of a process [bytes]."""


def sweeps() -> Iterator[Row]:
    """All rows."""
    for name, (paths, point) in MECHANISMS.items():
        yield from _reduced(name, paths, point)
        yield _written(name, paths, point)
        yield _motions(name, paths)
        yield _gradient(name, point)
        yield _two_threads(name, paths, point)
    yield _gradient("slider-crank-offset", "B")
    for name, (value, gradient) in CANDIDATES.items():
        yield _path_error(name, value, gradient)
    yield _on_the_sphere()
    yield from _with_events()
    yield _everything()
    yield from _two_points()
    yield _two_points_in_threads()
    yield _billion()


def _values(name: str, paths: tuple[str, ...], count: int) -> dict[str, Array]:
    mechanism, draw = ct.example(name), np.random.default_rng(0)
    return {path: ct.value_at(mechanism, path) + draw.uniform(-0.01, 0.01, count) for path in paths}


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
        times = paired_times(
            {
                "code": functools.partial(run, vary=many, executor="machine code"),
                "gradient": functools.partial(run, vary=many, executor="machine code", gradient=True),
                "arrays": functools.partial(run, vary=few, executor="arrays"),
            },
            ROUNDS,
        )
        yield Row(
            f"{name}, {label}",
            {
                "ns": median(times["code"]) / (MANY * SAMPLES) * 1e9,
                "arrays /": ratio(times, "arrays", "code") * MANY / FEW,
                "with gradient /": ratio(times, "gradient", "code"),
            },
        )


def _two_threads(name: str, paths: tuple[str, ...], point: str) -> Row:
    """The range of a point by one thread over two, by the clock."""
    values = _values(name, paths, LONG * MANY)
    halves = [{path: x[k::2] for path, x in values.items()} for k in (0, 1)]
    run = functools.partial(
        ct.sweep, ct.example(name), outputs=f"position.{point}", samples=SAMPLES, reduce="range",
        executor="machine code",
    )  # fmt: skip
    threads = two_threads(
        lambda count: run(vary=values, threads=count),
        [functools.partial(run, vary=half) for half in halves],
        ROUNDS,
    )
    return Row(
        f"{name}, two threads",
        {"1 thread / 2": threads.gain, "possible": threads.possible},
        promises=[Promise(f"sweep, {name}, range of a point, 1 thread / 2", threads.gain, at_least=1.6)],
    )


def _gradient(name: str, point: str) -> Row:
    """The range and the mean of a point with their derivatives by six dimensions."""
    values, numbers = _values(name, SIX[name], MANY), {}
    for fold in ("range", "mean"):
        run = functools.partial(
            ct.sweep, ct.example(name), values, f"position.{point}", SAMPLES, reduce=fold,
            executor="machine code",
        )  # fmt: skip
        times = paired_times({"value": run, "gradient": functools.partial(run, gradient=True)}, ROUNDS)
        numbers[f"{fold} with gradient /"] = ratio(times, "gradient", "value")
    promises = [
        Promise(f"sweep, {name}, {label.split()[0]} of a point with its gradient by six", over, 2.5)
        for label, over in numbers.items()
    ]
    return Row(f"{name}, gradient by six", numbers, promises=promises)


def _path_error(name: str, value: float, gradient: float) -> Row:
    """The error of a path over its targets, and its derivatives by six dimensions: candidates a second."""
    point = MECHANISMS[name][1]
    mechanism = ct.example(name)
    axes = "xy" if mechanism.space == "plane" else "xyz"
    drive = f"drive_{mechanism.drives[0].link}"
    terms = " + ".join(f"(position_{point}_{axis} - 0.5 - 0.1 * cos({drive}))^2" for axis in axes)
    run = functools.partial(
        ct.sweep, mechanism, _values(name, SIX[name], TRIED), samples=TARGETS,
        reduce={"error": f"mean({terms})"}, executor="machine code",
    )  # fmt: skip
    times = paired_times({"value": run, "gradient": functools.partial(run, gradient=True)}, ROUNDS)
    rates = {label: TRIED / median(seconds) for label, seconds in times.items()}
    return Row(
        f"{name}, path error of {TARGETS} targets",
        {f"{label}, millions a second": rate / 1e6 for label, rate in rates.items()},
        promises=[
            Promise(f"sweep, {name}, path error, {label}, candidates a second", rates[label], at_least=bound)
            for label, bound in (("value", value), ("gradient", gradient))
        ],
    )


def _on_the_sphere() -> Row:
    """The spherical four-bar linkage over the planar one: coupler and rocker vary, then the crank."""
    numbers = {}
    for label in ("coupler and rocker", "crank"):
        runs = {}
        for name, space in (("spherical-four-bar", "sphere"), ("crank-rocker", "plane")):
            paths, point = MECHANISMS[name]
            values = _values(name, (CRANKS[name],) if label == "crank" else paths, MANY)
            runs[space] = functools.partial(
                ct.sweep, ct.example(name), values, f"position.{point}", SAMPLES,
                reduce="range", executor="machine code",
            )  # fmt: skip
        numbers[label] = ratio(paired_times(runs, ROUNDS), "sphere", "plane")
    promises = [Promise(f"sweep, spherical over planar four-bar, {x} vary", numbers[x], 2.5) for x in numbers]
    return Row("spherical / planar, range of a point", numbers, promises=promises)


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


def _everything() -> Row:
    """All that four-bars have, over writing as many numbers to fresh memory, and to memory that is there."""
    run, numbers = _kept(EVERY)
    room = np.empty(numbers)
    times = paired_times(
        {
            "after another": run,
            "new pages": functools.partial(_in_new_pages, run),
            "with out": functools.partial(run, out=room),
            "bound, new": functools.partial(_fresh, numbers),
            "bound, there": functools.partial(room.fill, 1.0),
        },
        ROUNDS,
    )
    over = ratio(times, "new pages", "bound, new")
    return Row(
        f"crank-rocker, everything of {FOUR_BARS}",
        {
            **_each(times),
            "new pages /": over,
            "after another / there": ratio(times, "after another", "bound, there"),
            "out / there": ratio(times, "with out", "bound, there"),
        },
        promises=[
            Promise("sweep, everything kept in new pages, over writing to new pages", over, OVER_BOUND)
        ],
    )


def _two_points() -> Iterator[Row]:
    """Two moving points with derivatives of four-bars that differ in all lengths, and a peer's compiled motion."""
    run, numbers = _kept(POINTS)
    room = np.empty(numbers)
    tasks: dict[str, Callable[[], object]] = {
        "after another": run,
        "with out": functools.partial(run, out=room),
        "new pages": functools.partial(_in_new_pages, run),
        "bound, there": functools.partial(room.fill, 1.0),
        "bound, new": functools.partial(_fresh, numbers),
    }
    subject = f"crank-rocker, two points of {FOUR_BARS}"
    if not peer.PRESENT:
        yield Row(subject, _each(paired_times(tasks, ROUNDS)), f"pylinkage omitted: {peer.MISSING}")
        return
    peers, difference = _peers(run())
    if difference > AGREE:
        yield Row(subject, note=f"positions differ by {difference:.1e}: not compared")
        return
    times = paired_times({**tasks, "pylinkage": lambda: peer.run_batch(peers, FOUR_BAR_SAMPLES)}, ROUNDS)
    share = FOUR_BARS / len(peers)
    over = {name: ratio(times, "pylinkage", name) * share for name in tasks}
    nanoseconds = {**_each(times), "pylinkage": _each(times)["pylinkage"] * share}
    yield Row(subject, nanoseconds, f"ns a position; positions agree to {difference:.0e}")
    bound = ratio(times, "new pages", "bound, new")
    yield Row(
        "crank-rocker, two points, pylinkage /",
        over,
        "the last two: writing as many numbers and nothing else",
        promises=[
            *(
                Promise(f"sweep, pylinkage / two points kept, {name}", over[name], at_least=PEER)
                for name in ("after another", "with out", "new pages")
            ),
            # what the machine itself takes is printed beside what is asked
            Promise(
                "sweep, pylinkage / writing as many numbers to new pages", over["bound, new"], at_least=PEER
            ),
            Promise("sweep, two points in new pages, over writing to new pages", bound, at_most=OVER_BOUND),
        ],
    )


def _in_new_pages(run: Callable[[], object]) -> None:
    """A sweep whose memory is made for it: as the first of a process, or while the result before is there."""
    # nothing was given back: memory is made as for the first result of a process
    kept, rooms._given_back = rooms._given_back, rooms._GivenBack()
    try:
        run()
    finally:
        rooms._given_back = kept


def _two_points_in_threads() -> Row:
    """Two moving points by one thread over two, by the clock, to memory that is there."""
    run, numbers = _kept(POINTS, LONG * FOUR_BARS)
    room = np.empty(numbers)
    halves = [_kept(POINTS, LONG * FOUR_BARS // 2)[0] for _half in (0, 1)]
    threads = two_threads(
        lambda count: run(threads=count, out=room),
        [functools.partial(half, out=part) for half, part in zip(halves, np.split(room, 2), strict=True)],
        ROUNDS,
    )
    return Row(
        "crank-rocker, two points, two threads", {"1 thread / 2": threads.gain, "possible": threads.possible}
    )


def _kept(outputs: Sequence[str], count: int = FOUR_BARS) -> tuple[Callable[..., xr.Dataset], int]:
    """A sweep of four-bars, called with what else it takes, and how many numbers it keeps of samples."""
    run = functools.partial(
        ct.sweep, ct.example("crank-rocker"), _values("crank-rocker", LENGTHS, count), list(outputs),
        FOUR_BAR_SAMPLES, executor="machine code",
    )  # fmt: skip
    found = run()
    return run, sum(
        array.size
        for array in found.data_vars.values()
        if array.dtype == np.float64 and "sample" in array.dims
    )


def _each(times: Times) -> dict[str, float]:
    """Medians [ns] of a position."""
    return {name: median(x) / (FOUR_BARS * FOUR_BAR_SAMPLES) * 1e9 for name, x in times.items()}


def _peers(found: xr.Dataset) -> tuple[list[peer.Peer], float]:
    """The first of these four-bars in pylinkage, and how far its positions are from those found, over the greatest."""
    prepared = ready(ct.example("crank-rocker"))
    values = {path: found[path].values[:PEERS] for path in LENGTHS}
    numbers = dimensions_of(prepared.mechanism, values, np)
    moving = prepared.mechanism.moving_points
    positions = np.stack([found[f"position.{name}"].values[:PEERS] for name in moving], axis=2)
    peers = []
    for lane in range(PEERS):
        own = numbers.map_numbers(functools.partial(_number_of, lane))
        places = {name: (float(x), float(y)) for name, (x, y) in zip(moving, positions[lane, 0], strict=True)}
        peers.append(peer.build(prepared, own, places, FOUR_BAR_SAMPLES))
    runs = peer.run_batch(peers, FOUR_BAR_SAMPLES)
    theirs = np.stack([run[0][:, one.columns] for run, one in zip(runs, peers, strict=True)])
    return peers, float(np.abs(theirs - positions).max() / np.abs(positions).max())


def _number_of(lane: int, x: float | Array) -> float:
    return x if isinstance(x, float) else float(x[lane])


def _fresh(numbers: int) -> None:
    np.empty(numbers).fill(1.0)


def _motions(name: str, paths: tuple[str, ...]) -> Row:
    """Everything a motion has, of many mechanisms."""
    prepared = ready(ct.example(name))
    values = _values(name, paths, FEW)
    numbers = dimensions_of(prepared.mechanism, values, np)
    span = requested_grid(prepared, SAMPLES, None, None)
    times = best_times(
        {
            "code": functools.partial(solve_many, prepared, span, numbers, FEW),
            "arrays": functools.partial(solve, prepared, span, numbers, FEW),
        },
        rounds=ROUNDS,
    )
    each = 1e9 / (FEW * SAMPLES)
    return Row(f"{name}, motions", {"ns": times["code"] * each, "arrays /": times["arrays"] / times["code"]})


def _billion() -> Row:
    """A billion positions reduced, in a process of its own: time of two threads, memory at most."""
    count = BILLION // SAMPLES
    program = f"""
import numpy as np, resource, time
import centrode as ct
values = np.linspace(3.4, 3.6, {count})
clock, start = time.perf_counter(), time.process_time()
ct.sweep(ct.example("crank-rocker"), {{"links.AB.length": values}}, "position.B", {SAMPLES}, reduce="range", threads=2)
print(time.perf_counter() - clock, time.process_time() - start, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    clock, seconds, most = (float(word) for word in done.stdout.split())
    memory = most * KILOBYTE
    return Row(
        "crank-rocker, a billion positions",
        {"s by the clock": clock, "processor s": seconds, "MB": memory / 1e6},
        promises=[
            Promise("sweep, a billion positions, memory [MB]", memory / 1e6, MOST_MEMORY / 1e6),
            Promise(
                "sweep, a billion positions, processor time of two threads over two [s]",
                seconds / 2.0,
                SECONDS,
            ),
        ],
    )


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
        span = requested_grid(prepared, SAMPLES, None, None)
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
