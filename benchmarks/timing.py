"""How times are taken: what is compared runs in turns, so that a busy machine is busy for all of it."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping

SHORTEST = 0.02
"""A single measurement runs at least so long [s]."""


def best_times(
    tasks: Mapping[str, Callable[[], object]], rounds: int = 7, shortest: float = SHORTEST
) -> dict[str, float]:
    """Processor time of one call of each task [s]: the least of several rounds, in which the tasks take turns.

    Every task has run before it is timed, so compilers and caches are warm. Processor time leaves out what
    other processes take; all tasks here run in one thread.
    """
    repeats = {name: _repeats(task, shortest) for name, task in tasks.items()}
    found: dict[str, list[float]] = {name: [] for name in tasks}
    for _round in range(rounds):
        for name, task in tasks.items():
            found[name].append(_time(task, repeats[name]))
    return {name: min(times) for name, times in found.items()}


def _repeats(task: Callable[[], object], shortest: float) -> int:
    task()
    once = max(_time(task, 1), 1e-7)
    return max(1, round(shortest / once))


def _time(task: Callable[[], object], repeats: int) -> float:
    start = time.process_time()
    for _ in range(repeats):
        task()
    return (time.process_time() - start) / repeats
