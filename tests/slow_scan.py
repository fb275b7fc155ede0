"""How far a mechanism gets, found slowly: plain values of what decides whether groups close, on ever finer places.

Nothing is taken from the search for events: no derivatives, no bounds, no mesh. A stretch between two places is looked
at more closely while a radicand or divisor changes by more than a share of itself in it, or anything moves far.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from centrode.kinematics.plan_evaluation import FixedSigns, Kinematics
from centrode.numerics.arrays import ARRAYS
from centrode.structure.constraints import Positions

BASE = 4000
"""Places a turn to begin with."""
INTO = 8
FINEST = 1e-9
"""Stretches shorter than this are one place."""
SHARE, WAY = 0.1, 0.05
"""How much a number may change from place to place, in itself; how far anything may move, in rad or in lengths of 1."""
MOST = 40_000


@dataclass
class Guards(FixedSigns):
    """Keeps what decides whether groups close."""

    m: Any
    signs: Any
    found: list[Any] = field(default_factory=list)

    def __post_init__(self) -> None:
        super().__init__(self.m, self.signs)

    def root(self, group: int, radicand: Any) -> Any:
        self.found.append(radicand)
        return super().root(group, radicand)

    def divisor(self, group: int, divisor: Any) -> Any:
        self.found.append(divisor)
        return divisor


@dataclass
class Places:
    """Mechanisms with constant signs, at places of their paths."""

    kinematics: Kinematics
    signs: dict[int, float]

    def at(self, lanes: Any, q: Any) -> tuple[Any, Any]:
        """Guards (groups, k), and all that moves (numbers, k)."""
        used = self.kinematics.take(lanes)
        guards = Guards(ARRAYS, self.signs)
        with np.errstate(all="ignore"):
            at = used.positions(ARRAYS, q, guards)
        wide = [np.broadcast_to(np.asarray(x, dtype=float), q.shape) for x in guards.found]
        return (np.array(wide) if wide else np.ones((1, *q.shape))), self._moving(at, q.shape)

    def _moving(self, at: Positions, shape: Any) -> Any:
        vectors = [*at.points.values(), *(vector for pose in at.poses.values() for vector in pose)]
        return np.array([np.broadcast_to(np.asarray(x, dtype=float), shape) for v in vectors for x in v])


def reaches(kinematics: Kinematics, signs: dict[int, float], lanes: int, width: float) -> Any:
    """First places in both directions at which some group does not close or passes infinity: (lanes, 2).

    Infinite where there is none within `width` of the initial position, NaN where that does not close itself.
    """
    places = Places(kinematics, signs)
    start = kinematics.path.initial
    every = np.arange(lanes)
    first, _moving = places.at(every, np.full(lanes, start))
    found = np.full((lanes, 2), np.nan)
    # radicands are positive where a mechanism starts; divisors have either sign
    alive = np.isfinite(first).all(axis=0)
    for side, sense in ((0, -1.0), (1, 1.0)):
        found[alive, side] = _first(places, every[alive], np.sign(first[:, alive]), start, sense, width)
    return found


def _first(places: Places, lanes: Any, signs: Any, start: float, sense: float, width: float) -> Any:
    count = int(BASE * width / (2.0 * np.pi))
    steps = np.arange(count + 1) * (width / count)
    q = start + sense * steps
    guards, moving = places.at(np.repeat(lanes, count + 1), np.tile(q, len(lanes)))
    shape = (-1, len(lanes), count + 1)
    guards, moving = guards.reshape(shape), moving.reshape(shape)
    bad = (~(guards * signs[:, :, None] > 0.0)).any(axis=0)
    reach = np.where(bad.any(axis=1), np.argmax(bad, axis=1), count + 1)  # first bad node
    first = np.where(bad.any(axis=1), sense * steps[np.minimum(reach, count)], np.inf)
    rows, cells = np.nonzero(np.arange(count)[None, :] < reach[:, None])
    ends = [(guards[:, rows, cells + k], moving[:, rows, cells + k]) for k in (0, 1)]
    low, high = steps[cells], steps[cells + 1]
    first = np.abs(first)
    while len(rows):
        split = (
            (high - low > FINEST)
            & (_doubtful(*ends) | (np.abs(high - first[rows]) < FINEST))
            & (low < first[rows])
        )
        rows, low, high = rows[split], low[split], high[split]
        if not len(rows) or len(rows) > MOST:
            break
        parts = low[:, None] + (high - low)[:, None] * (np.arange(INTO + 1) / INTO)
        g, x = places.at(np.repeat(lanes[rows], INTO + 1), (start + sense * parts).ravel())
        g, x = g.reshape(-1, len(rows), INTO + 1), x.reshape(-1, len(rows), INTO + 1)
        bad = (~(g * signs[:, rows, None] > 0.0)).any(axis=0)
        hit = bad.any(axis=1)
        np.minimum.at(first, rows[hit], parts[hit, np.argmax(bad[hit], axis=1)])
        ends = [
            (y[:, :, k].reshape(len(y), -1), z[:, :, k].reshape(len(z), -1))
            for k, (y, z) in ((slice(0, -1), (g, x)), (slice(1, None), (g, x)))
        ]
        rows, low, high = np.repeat(rows, INTO), parts[:, :-1].ravel(), parts[:, 1:].ravel()
    return start + sense * first


def _doubtful(one: Any, other: Any) -> Any:
    (g, x), (h, y) = one, other
    with np.errstate(all="ignore"):
        near = np.abs(g - h) > SHARE * np.minimum(np.abs(g), np.abs(h))
        # what runs to infinity moves far, and is told by its share
        far = np.abs(x - y) > WAY * np.maximum(1.0, np.minimum(np.abs(x), np.abs(y)))
    return near.any(axis=0) | far.any(axis=0)
