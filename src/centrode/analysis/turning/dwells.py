"""Dwells of links and sliders: where they stay within a band of their stroke for long."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from math import tau
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.analysis.turning.watched import Course

Array: TypeAlias = npt.NDArray[np.float64]

DWELL_BAND = 0.01
"""Part of a stroke within which a member stays in a dwell."""
LEAST_DWELL = tau / 8
"""Least length of a dwell, in the units of the drive: an eighth of a turn, which no harmonic motion reaches."""


@dataclass(frozen=True)
class Dwell:
    """A stretch of the drive over which a member keeps its value within a band, as finely as the nodes lie."""

    first: float
    last: float
    value: float
    band: float


def dwells_of(course: Course, k: int, shift: float, stroke: float) -> list[Dwell]:
    """Longest stretches of nodes within the band that do not overlap, each at least as long as a dwell is."""
    nodes, values = course.nodes, course.values[k]
    if not np.isfinite(values).all():
        return []
    band = DWELL_BAND * stroke
    tour = course.tour
    least = LEAST_DWELL * (1.0 if tour.angular else tour.continuation.branches.unit)
    count = len(nodes)
    if tour.comes_round:
        nodes = np.concatenate([nodes[:-1], nodes[:-1] + (tour.span[1] - tour.span[0])])
        values = np.concatenate([values[:-1], values[:-1]])
        count -= 1
    windows = sorted(_windows(values, band), key=lambda w: nodes[w[0]] - nodes[w[1]])
    kept: list[tuple[int, int]] = []
    for first, last in windows:
        if nodes[last] - nodes[first] < least or first >= count:
            continue
        taken = [(a + turn, b + turn) for a, b in kept for turn in (-count, 0, count)]
        if all(last < a or first > b for a, b in taken):
            kept.append((first, last))
    return [
        Dwell(
            float(nodes[a]),
            float(nodes[b]),
            float(values[a : b + 1].mean()) + shift,
            float(np.ptp(values[a : b + 1])),
        )
        for a, b in sorted(kept)
    ]


def _windows(values: Array, band: float) -> list[tuple[int, int]]:
    """For every first node the longest stretch within the band; only those that are not part of another.

    Two queues hold what may still become the greatest and the least value, so each node is looked at once.
    """
    found: list[tuple[int, int]] = []
    numbers, first = values.tolist(), 0
    high: deque[int] = deque()
    low: deque[int] = deque()
    for last, value in enumerate(numbers):
        before = first
        while high and not numbers[high[-1]] > value:
            high.pop()
        while low and not numbers[low[-1]] < value:
            low.pop()
        high.append(last)
        low.append(last)
        while not numbers[high[0]] - numbers[low[0]] <= band:
            first += 1
            for queue in (high, low):
                if queue[0] < first:
                    queue.popleft()
            if first == last:
                break
        if first > before:
            found.append((before, last - 1))
    return [*found, (first, len(numbers) - 1)]
