"""The search for the smallest change: candidates spread over the bounds, then the best of them drawn towards no change.

Nothing is random: candidates are those of an additive sequence (Roberts, The unreasonable effectiveness of
quasirandom sequences, 2018), so the same question has the same answer.
"""

from __future__ import annotations

import functools
import importlib
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.analysis.repairing.candidates import Candidates
from centrode.analysis.repairing.margins import least, least_by_sector, squared_sines

Array: TypeAlias = npt.NDArray[np.float64]
Progress: TypeAlias = Callable[[int, int], None]

CHUNK, COARSE = 256, 180
"""Candidates evaluated together, and nodes of the turn on which they are looked at first."""
FINE, SECTORS = 720, 12
"""Nodes on which a candidate is improved, and sectors of the turn of which each has a condition of its own."""
SHELLS = (1.0, 0.6, 0.35, 0.2, 0.1, 0.05)
"""Candidates lie in the whole box and in smaller ones about no change, in turn."""
STARTS = 6
"""Candidates that are improved."""
APART = 0.1
"""Starts closer than this, scaled by the box, lead to the same place."""
STEP = 1e-6
"""Of differences, in scaled changes: half the digits of a squared sine."""
SLACK = 1e-5
"""By which part of it the quadratic programming aims above the target, so that its rounding does not fall short."""
CORRECTIONS, ACTIVE = 4, 0.02
"""Small steps back to where all conditions hold, and how near to the target a condition counts for them."""
ITERATIONS = 60
CONTRACTIONS = 40

SAID = 100
"""Progress is said every so many candidates."""

# what is needed for a repair alone is not loaded before
_optimize = functools.partial(importlib.import_module, "scipy.optimize")


@dataclass
class Search:
    """A search among candidates for the least change with squared sines of at least `target`.

    `tried` counts the candidates that were evaluated, `turning` those of the first, even spread that are good enough.
    """

    candidates: Candidates
    target: float
    progress: Progress | None = None
    tried: int = 0
    turning: int = 0
    spread: int = 0
    total: int = 0
    _low: Array = field(init=False)
    _high: Array = field(init=False)

    def __post_init__(self) -> None:
        self._low, self._high = self.candidates.box()

    def margins(self, changes: Array, nodes: int = COARSE) -> Array:
        """Least squared sine over the turn of every candidate (n,)."""
        parts = []
        for first in range(0, len(changes), CHUNK):
            some = changes[first : first + CHUNK]
            parts.append(least(squared_sines(self.candidates.batch(some), nodes)))
            self._count(len(some))
        return np.concatenate(parts)

    def run(self, spread: int) -> list[Array]:
        """Scaled changes that are good enough on the fine nodes, the smallest first."""
        self.spread = spread
        self.total = spread + STARTS * (CONTRACTIONS + ITERATIONS * (2 * len(self._low) + 1))
        changes = self._spread(spread)
        margins = self.margins(changes)
        good = margins >= self.target
        self.turning = int(good.sum())
        starts = self._apart(changes[good], np.linalg.norm(changes[good], axis=1))
        if not starts:
            starts = self._apart(changes, -margins)
        found = [self.improved(start) for start in starts]
        reached = [change for change in found if change is not None]
        if self.progress is not None:
            self.progress(self.total, self.total)
        return sorted(reached, key=lambda change: float(np.linalg.norm(change)))

    def _count(self, more: int) -> None:
        """Count candidates, and say how far it is now and then."""
        before, self.tried = self.tried, self.tried + more
        if self.progress is not None and before // SAID < self.tried // SAID:
            self.progress(min(self.tried, self.total), self.total)

    def _spread(self, count: int) -> Array:
        """No change, then an even spread over the box and over smaller boxes."""
        size = len(self._low)
        root = 2.0
        for _step in range(50):
            root = (1.0 + root) ** (1.0 / (size + 1))
        steps = root ** -np.arange(1.0, size + 1)
        share = (0.5 + np.outer(np.arange(1, count), steps)) % 1.0
        shell = np.resize(SHELLS, count - 1)[:, None]
        inside = (self._low + share * (self._high - self._low)) * shell
        return np.vstack([np.zeros((1, size)), inside])

    def _apart(self, changes: Array, order: Array) -> list[Array]:
        """The first few changes by an order that do not lie close together."""
        width = np.where(self._high > self._low, self._high - self._low, 1.0)
        kept: list[Array] = []
        for k in np.argsort(order, kind="stable"):
            if all(np.linalg.norm((changes[k] - other) / width) > APART for other in kept):
                kept.append(changes[k])
            if len(kept) == STARTS:
                break
        return kept

    def improved(self, start: Array) -> Array | None:
        """The least change near a start that is good enough on the fine nodes; None if there is none."""
        options = []
        drawn = self._drawn(start)
        for first in (start,) if drawn is None else (drawn, start):
            found = self._minimised(first)
            if found is not None:
                options.append(found)
        options += [] if drawn is None else [drawn]
        return min(options, key=lambda change: float(np.linalg.norm(change)), default=None)

    def _drawn(self, start: Array) -> Array | None:
        """The least part of a change that is good enough, if the whole of it is."""
        if self.margins(start[None, :], FINE)[0] < self.target:
            return None
        shares = np.linspace(0.0, 1.0, CONTRACTIONS)[:, None]
        good = self.margins(shares * start, FINE) >= self.target
        return np.asarray(start * shares[int(np.nonzero(good)[0][0])])

    def _minimised(self, start: Array) -> Array | None:
        """Sequential quadratic programming from a start, on the conditions of all sectors."""
        result: Any = _optimize().minimize(
            lambda x: float(x @ x),
            start,
            jac=lambda x: 2.0 * x,
            bounds=list(zip(self._low, self._high, strict=True)),
            constraints={"type": "ineq", "fun": self._conditions, "jac": self._slopes},
            method="SLSQP",
            options={"maxiter": ITERATIONS, "ftol": 1e-12},
        )
        change = np.clip(np.asarray(result.x, dtype=np.float64), self._low, self._high)
        if not np.isfinite(change).all():
            return None
        for _correction in range(CORRECTIONS):
            lack = self.target - float(self.margins(change[None, :], FINE)[0])
            if lack <= 0.0:
                return change
            change = self.raised(change, lack)
        return None

    def raised(self, change: Array, lack: float) -> Array:
        """A change moved as little as lifts its least squared sines by what they lack (and a little more)."""
        values, slopes = self._sectors(change[None, :])[0], self._slopes(change) * self.target
        lowest = values <= float(values.min()) + ACTIVE * self.target
        moved = change + np.linalg.pinv(slopes[lowest], rcond=1e-6) @ np.full(int(lowest.sum()), 1.5 * lack)
        return np.asarray(np.clip(moved, self._low, self._high))

    def _conditions(self, change: Array) -> Array:
        return np.asarray(self._sectors(change[None, :])[0] / self.target - (1.0 + SLACK))

    def _sectors(self, changes: Array) -> Array:
        self._count(len(changes))
        sines = squared_sines(self.candidates.batch(changes), FINE)
        return least_by_sector(sines, SECTORS)

    def _slopes(self, change: Array) -> Array:
        size = len(change)
        moved = np.vstack([change + STEP * np.eye(size), change - STEP * np.eye(size)])
        found = self._sectors(moved)
        return np.asarray((found[:size] - found[size:]).T / (2.0 * STEP * self.target))
