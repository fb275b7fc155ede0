"""How times are taken: what is compared runs in turns, so that a busy machine is busy for all of it."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from statistics import median

Task = Callable[[], object]
Times = Mapping[str, Sequence[float]]

ROUNDS = 5
SHORTEST = 0.02
"""A single measurement runs at least so long [s]."""


def paired_times(
    tasks: Mapping[str, Task], rounds: int = 5, shortest: float = SHORTEST
) -> dict[str, list[float]]:
    """Processor time of one call of each task [s] in each of several rounds, in which the tasks take turns.

    Every task has run before it is timed, so compilers and caches are warm. Processor time leaves out what
    other processes take; all tasks here run in one thread.
    """
    repeats = {name: _repeats(task, shortest) for name, task in tasks.items()}
    found: dict[str, list[float]] = {name: [] for name in tasks}
    for _round in range(rounds):
        for name, task in tasks.items():
            found[name].append(_time(task, repeats[name]))
    return found


def best_times(tasks: Mapping[str, Task], rounds: int = 7, shortest: float = SHORTEST) -> dict[str, float]:
    """Processor time of one call of each task [s]: the least of several rounds."""
    return {name: min(times) for name, times in paired_times(tasks, rounds, shortest).items()}


def best_clock_times(tasks: Mapping[str, Task], rounds: int = 7) -> dict[str, float]:
    """Time of one call of each task by the clock [s], the least of several rounds: for tasks of several threads.

    Processor time would add up what their threads take.
    """
    for task in tasks.values():
        task()
    found = {name: float("inf") for name in tasks}
    for _round in range(rounds):
        for name, task in tasks.items():
            found[name] = min(found[name], _clock(task))
    return found


def ratio(times: Times, one: str, other: str) -> float:
    """Median of the ratios of two tasks, round by round."""
    return median(a / b for a, b in zip(times[one], times[other], strict=True))


@dataclass(frozen=True)
class Shared:
    """What a second thread gains: medians of pairs of runs, by the clock.

    Attributes
    ----------
    gain : time of one thread over that of two
    possible : the same of two runs that have nothing in common, each in a thread of its own
    """

    gain: float
    possible: float


def two_threads(run: Callable[[int], object], halves: Sequence[Task], rounds: int = 5) -> Shared:
    """One thread against two; `halves` are two runs of half the work each, to see what the machine allows now."""
    run(2)
    gains, possible = [], []
    with ThreadPoolExecutor(2) as pool:
        for _round in range(rounds):
            one = _clock(lambda: run(1))
            gains.append(one / _clock(lambda: run(2)))
            possible.append(one / _clock(lambda: list(pool.map(lambda half: half(), halves))))
    return Shared(median(gains), median(possible))


def _clock(task: Task) -> float:
    start = time.perf_counter()
    task()
    return time.perf_counter() - start


def _repeats(task: Task, shortest: float) -> int:
    task()
    once = max(_time(task, 1), 1e-7)
    return max(1, round(shortest / once))


def _time(task: Task, repeats: int) -> float:
    start = time.process_time()
    for _ in range(repeats):
        task()
    return (time.process_time() - start) / repeats
