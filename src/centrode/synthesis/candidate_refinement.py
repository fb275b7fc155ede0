"""Four-bar linkages whose coupler point passes near given points, brought from candidates to their best."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from centrode.synthesis.least_squares import Lanes, Problem, is_ordered, least_squares, ordered_fit

SEMIFINALISTS = 96
FINALISTS = 40
LAST = 12
SHARP = 3000.0
"""Weight of constraints at the end."""
CENTRES, NEIGHBOURS, NEAREST = 3, 60, 30
"""Best linkages around which others are tried, how many around each at each distance, and how many of them go on."""
DISTANCES = (0.1, 0.3)
"""Of neighbours, as the standard deviation of the logarithm of what makes a linkage."""
Progress = Callable[[float], None]
Neighbours = Callable[[Lanes, float, int], Lanes]
"""(linkages, distance, how many of each) -> linkages near them."""


def fit_lanes(
    problem: Problem,
    candidates: Lanes,
    closed: bool,
    ordered: bool,
    progress: Progress = lambda share: None,
    stop: Callable[[], bool] = lambda: False,
    neighbours: Neighbours | None = None,
) -> Lanes:
    """Candidates brought to their minima, the best of them to the end, in the order of what they miss.

    Those that break a hinge by more than rounding stand behind all others. Around the best, `neighbours` are tried.
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
    progress(0.7)
    # Valleys of ever longer links are slow: the best go on alone.
    lanes = _fit_to_the_end(sharp, _distinct(lanes, LAST), closed, ordered, stop)
    progress(0.8)
    if neighbours is not None and not stop():
        nearby = _fit_neighbours(sharp, _distinct(lanes, CENTRES), closed, ordered, neighbours, stop)
        lanes = _fit_to_the_end(sharp, _distinct(lanes.join(nearby), LAST), closed, ordered, stop)
    progress(1.0)
    return _distinct(lanes, LAST)


def _fit_to_the_end(
    problem: Problem, lanes: Lanes, closed: bool, ordered: bool, stop: Callable[[], bool]
) -> Lanes:
    if ordered and problem.targets.crank is None:
        lanes = ordered_fit(problem, lanes, closed, 100, stop)
    return least_squares(problem, lanes, 600, 1e-13, stop)


def _fit_neighbours(
    problem: Problem,
    lanes: Lanes,
    closed: bool,
    ordered: bool,
    neighbours: Neighbours,
    stop: Callable[[], bool],
) -> Lanes:
    """Minima beside those that were reached.

    Where a path has a sharp turn, each share of its targets on either side of the turn is a minimum of its own, and
    candidates of an atlas meet one of them by chance (basin hopping: D. J. Wales, J. P. K. Doye, J. Phys. Chem. A 101,
    1997, 5111-5116).
    """
    reached = lanes.take(np.empty(0, dtype=np.int64))
    for distance in DISTANCES:
        near = least_squares(problem, neighbours(lanes, distance, NEIGHBOURS), 60, 1e-8, stop)
        near = _distinct(near, NEAREST)
        if ordered and problem.targets.crank is None:
            near = ordered_fit(problem, near, closed, 60, stop)
        reached = reached.join(near)
    return reached


def _distinct(lanes: Lanes, count: int) -> Lanes:
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


def _best(lanes: Lanes) -> np.ndarray[tuple[int, ...], np.dtype[np.int64]]:
    broken = lanes.violation > 1e-3
    order: np.ndarray[tuple[int, ...], np.dtype[np.int64]] = np.lexsort((lanes.errors, broken))
    return order
