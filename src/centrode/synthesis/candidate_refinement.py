"""Four-bar linkages whose coupler point passes near given points, brought from candidates to their best."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from centrode.synthesis.least_squares import FitLanes, FitProblem, is_ordered, least_squares, ordered_fit

SEMIFINALISTS = 96
FINALISTS = 40
LAST = 12
SHARP = 3000.0
"""Weight of constraints at the end."""
Progress = Callable[[float], None]


def fit_lanes(
    problem: FitProblem,
    candidates: FitLanes,
    closed: bool,
    ordered: bool,
    progress: Progress = lambda share: None,
    stop: Callable[[], bool] = lambda: False,
) -> FitLanes:
    """Candidates brought to their minima, the best of them to the end, in the order of what they miss.

    Those that break a hinge by more than rounding stand behind all others.
    """
    lanes = least_squares(problem, candidates, 40, 1e-6, stop)
    progress(0.3)
    lanes = least_squares(problem, _distinct(lanes, SEMIFINALISTS), 120, 1e-8, stop)
    progress(0.5)
    sharp = replace(problem, weight=SHARP)
    if ordered and problem.targets.crank is None:
        good = is_ordered(lanes.crank * lanes.sense[:, None], closed)
        kept = _distinct(lanes.take(np.flatnonzero(good)), FINALISTS)
        rest = _distinct(lanes.take(np.flatnonzero(~good)), FINALISTS)
        rest = ordered_fit(sharp, rest, closed, 40, stop)
        lanes = kept.join(rest)
    progress(0.6)
    lanes = least_squares(sharp, _distinct(lanes, FINALISTS), 300, 1e-13, stop)
    progress(0.8)
    # Valleys of ever longer links are slow: the best go on alone.
    lanes = _distinct(lanes, LAST)
    if ordered and problem.targets.crank is None:
        lanes = ordered_fit(sharp, lanes, closed, 100, stop)
    lanes = least_squares(sharp, lanes, 600, 1e-13, stop)
    progress(1.0)
    return _distinct(lanes, LAST)


def _distinct(lanes: FitLanes, count: int) -> FitLanes:
    """The best lanes, without those that miss the targets by the same and have the same lengths."""
    chosen: list[int] = []
    for k in _best(lanes).tolist():
        if not np.isfinite(lanes.errors[k]):
            continue
        alike = (
            abs(lanes.errors[k] - lanes.errors[j]) <= 1e-4 * lanes.errors[j] + 1e-20
            and np.allclose(lanes.variables[k, 4:7], lanes.variables[j, 4:7], rtol=1e-2)
            for j in chosen
        )
        if not any(alike):
            chosen.append(k)
        if len(chosen) == count:
            break
    return lanes.take(np.array(chosen, dtype=np.int64))


def _best(lanes: FitLanes) -> np.ndarray[tuple[int, ...], np.dtype[np.int64]]:
    broken = lanes.violation > 1e-3
    order: np.ndarray[tuple[int, ...], np.dtype[np.int64]] = np.lexsort((lanes.errors, broken))
    return order
