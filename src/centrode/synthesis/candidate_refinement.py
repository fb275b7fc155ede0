"""Four-bar linkages whose coupler point passes near given points, brought from candidates to their best."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from centrode.synthesis.least_squares import FitLanes, FitProblem, is_ordered, least_squares, ordered_fit
from centrode.synthesis.processes import HERE, Processes

SEMIFINALISTS = 96
FINALISTS = 40
LAST = 12
SHARP = 3000.0
"""Weight of constraints at the end."""
CENTRES, NEIGHBOURS, NEAREST, LAST_NEAR = 3, 40, 16, 6
"""Best linkages around which others are tried, how many around each at each distance, and how many of them go on."""
DISTANCES = (0.1, 0.3)
"""Of neighbours, as the standard deviation of the logarithm of what makes a linkage."""
SHARE = 64
"""Linkages that are brought to their minima together."""
Progress = Callable[[float], None]
Neighbours = Callable[[FitLanes, float, int], FitLanes]
"""(linkages, distance, how many of each) -> linkages near them."""


@dataclass(frozen=True)
class _LaneFits:
    """Least squares of lanes, share by share.

    Attributes
    ----------
    closed : whether the path is
    ordered : whether crank angles that nobody gives have to grow from target to target
    """

    closed: bool
    ordered: bool
    stop: Callable[[], bool]
    processes: Processes

    def squares(self, problem: FitProblem, lanes: FitLanes, iterations: int, tolerance: float) -> FitLanes:
        """Without the order."""
        work = functools.partial(least_squares, problem, iterations=iterations, tolerance=tolerance)
        return self._spread(problem, lanes, work)

    def in_order(self, problem: FitProblem, lanes: FitLanes, iterations: int) -> FitLanes:
        """With the order, where it is asked for."""
        if not self.ordered or problem.targets.crank is not None:
            return lanes
        return self._spread(
            problem, lanes, functools.partial(ordered_fit, problem, closed=self.closed, iterations=iterations)
        )

    def to_the_end(self, problem: FitProblem, lanes: FitLanes) -> FitLanes:
        """As near as rounding allows, in the order."""
        return self.squares(problem, self.in_order(problem, lanes, 100), 600, 1e-13)

    def _spread(self, problem: FitProblem, lanes: FitLanes, work: Callable[..., FitLanes]) -> FitLanes:
        count = len(lanes.side)
        shares = [lanes.take(np.arange(k, min(k + SHARE, count))) for k in range(0, count, SHARE)]
        fitted: dict[int, FitLanes] = dict(self.processes.compute(work, shares, self.stop))
        if len(fitted) < max(len(shares), 1):
            # stopped: what has not been reached stays where it is
            fitted = {
                k: least_squares(problem, share, 0) for k, share in enumerate(shares or [lanes])
            } | fitted
        return functools.reduce(FitLanes.join, (fitted[k] for k in sorted(fitted)))


def fit_lanes(
    problem: FitProblem,
    candidates: FitLanes,
    closed: bool,
    ordered: bool,
    progress: Progress = lambda share: None,
    stop: Callable[[], bool] = lambda: False,
    neighbours: Neighbours | None = None,
    processes: Processes = HERE,
) -> FitLanes:
    """Candidates brought to their minima, the best of them to the end, in the order of what they miss.

    Those that break a hinge by more than rounding stand behind all others. Around the best, `neighbours` are tried.
    """
    fit = _LaneFits(closed, ordered, stop, processes)
    lanes = fit.squares(problem, candidates, 40, 1e-6)
    progress(0.3)
    lanes = fit.squares(problem, _distinct(lanes, SEMIFINALISTS), 120, 1e-8)
    progress(0.5)
    sharp = replace(problem, weight=SHARP)
    if ordered and problem.targets.crank is None:
        good = is_ordered(lanes.crank * lanes.sense[:, None], closed)
        kept = _distinct(lanes.take(np.flatnonzero(good)), FINALISTS)
        rest = _distinct(lanes.take(np.flatnonzero(~good)), FINALISTS)
        lanes = kept.join(fit.in_order(sharp, rest, 40))
    progress(0.6)
    lanes = fit.squares(sharp, _distinct(lanes, FINALISTS), 300, 1e-13)
    progress(0.7)
    # Valleys of ever longer links are slow: the best go on alone.
    lanes = fit.to_the_end(sharp, _distinct(lanes, LAST))
    progress(0.8)
    if neighbours is not None and not stop():
        nearby = _fit_neighbours(sharp, _distinct(lanes, CENTRES), fit, neighbours)
        # beside the others: they must not crowd out what is different
        lanes = lanes.join(fit.to_the_end(sharp, _distinct(nearby, LAST_NEAR)))
    progress(1.0)
    return _distinct(lanes, LAST + LAST_NEAR)


def _fit_neighbours(problem: FitProblem, lanes: FitLanes, fit: _LaneFits, neighbours: Neighbours) -> FitLanes:
    """Minima beside those that were reached.

    Where a path has a sharp turn, each share of its targets on either side of the turn is a minimum of its own, and
    candidates of an atlas meet one of them by chance (basin hopping: D. J. Wales, J. P. K. Doye, J. Phys. Chem. A 101,
    1997, 5111-5116).
    """
    reached = lanes.take(np.empty(0, dtype=np.int64))
    for distance in DISTANCES:
        near = fit.squares(problem, neighbours(lanes, distance, NEIGHBOURS), 60, 1e-8)
        reached = reached.join(fit.in_order(problem, _distinct(near, NEAREST), 60))
    return reached


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
