"""Where targets of a point, and of the link that carries it, lie on a sampled motion of the mechanism.

Each target has a place of its own, the nearest one in the order of the targets, or all have given places up to a
common shift. Either way the places depend on the mechanism; what is missed, and its derivatives by the mechanism, are
taken across the direction in which the places may still move (G. H. Golub, V. Pereyra, SIAM J. Numer. Anal. 10, 1973,
413-432). A turn of a link counts as a length, by an arm.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from centrode.model.similarity import Similarity
from centrode.synthesis.curve_places import TINY, ordered_places
from centrode.synthesis.four_bars import Array, Complex
from centrode.synthesis.measures import hermite

FOOT_STEPS, SHIFT_STEPS = 30, 30
"""Steps along the motion to the nearest places, and to the best common shift."""
COARSE = 180
"""Cells of which the nearest ones are chosen; finer samples serve the places in them."""
BESIDE = 0.6
"""Cells by which the nearest place may lie beside the cell of which the chord is nearest."""
SETTLED = 1e-11
"""Step in cells after which places do not move any more."""
SCANNED = 60
"""Targets by which shifts and alignments are compared, at most."""
BEGINNINGS, WINDOW = 36, 0.08
"""Places at which a path of poses may begin, and the part of the motion in which a pose looks for its nearest place."""
SHARES = (0.06, 0.1, 0.15, 0.2, 0.27, 0.35, 0.45, 0.6, 0.8, 1.0)
"""Parts of the motion that the targets may take."""
ALIGNMENTS, ALIGNED = 6, 3
"""Alignments that go on, and how often."""
Cells = np.ndarray[tuple[int, ...], np.dtype[np.int64]]


@dataclass(frozen=True)
class BodyTargets:
    """Points to pass, of poses with the direction of the link.

    Attributes
    ----------
    rows : (n, 2) x and y [m], or (n, 3) with the arm times the direction
    arm : length [m] that an angle of one radian counts for
    """

    rows: Array
    arm: float

    def misses(self, rows: Array) -> Array:
        """Rows (..., n, k) less the targets; directions differ by half a turn at most."""
        missed: Array = rows - self.rows
        if missed.shape[-1] == 3:
            turn = 2 * math.pi * self.arm
            missed[..., 2] -= turn * np.round(missed[..., 2] / turn)
        return missed

    def embed(self, rows: Array) -> Array:
        """Rows (..., k) with directions as points of a circle, where those a turn apart are the same."""
        if rows.shape[-1] == 2:
            return rows
        angle = rows[..., 2] / self.arm
        return np.concatenate(
            [rows[..., :2], self.arm * np.stack([np.cos(angle), np.sin(angle)], axis=-1)], axis=-1
        )

    def take(self, which: Cells) -> BodyTargets:
        """Some of the targets."""
        return BodyTargets(self.rows[which], self.arm)


@dataclass(frozen=True)
class SampledMotion:
    """A motion by samples (m, k) of the rows of `BodyTargets` and their rates: between two samples a cubic of both.

    Attributes
    ----------
    rows : (m, k)
    rates : (m, k), change from one sample to the next by the velocity there
    closes : whether its last sample is the first
    """

    rows: Array
    rates: Array
    closes: bool

    @property
    def cells(self) -> int:
        """Number of its cells."""
        return len(self.rows) - 1

    def within(self, places: Array) -> Array:
        """Places on the motion: one that closes is run through again and again, another one has ends."""
        return np.mod(places, self.cells) if self.closes else np.clip(places, 0.0, self.cells)

    def split(self, places: Array) -> tuple[Cells, Array]:
        """Cells of places, and the parts of the cells."""
        within = self.within(places)
        cells = np.minimum(within.astype(np.int64), self.cells - 1)
        return cells, within - cells

    def at(self, places: Array) -> tuple[Array, Array]:
        """Rows (n, k) at places (n,), and their derivatives by the place."""
        cells, part = self.split(places)
        weights, slopes = hermite(part)
        return mix(self.rows, self.rates, cells, weights), mix(self.rows, self.rates, cells, slopes)


def sampled_motion(rows: Array, rates: Array, arm: float) -> SampledMotion:
    """The motion of these samples, which closes where its ends agree but for a whole turn."""
    gap = rows[-1] - rows[0]
    if rows.shape[1] == 3:
        turn = 2 * math.pi * arm
        gap[2] -= turn * round(float(gap[2]) / turn)
    size = float(np.abs(rows - rows.mean(axis=0)).max()) + TINY
    return SampledMotion(rows, rates, bool(np.linalg.norm(gap) < 1e-6 * size))


def mix(values: Array, rates: Array, cells: Cells, weights: Array) -> Array:
    """Weighted ends (n, ...) of cells: values and rates (m, ...) at both samples of each, weights (4, n)."""
    shape = (slice(None), *(None,) * (values.ndim - 1))
    ends = (values[cells], rates[cells], values[cells + 1], rates[cells + 1])
    total: Array = sum(weight[shape] * end for weight, end in zip(weights, ends, strict=True))
    return total


@dataclass(frozen=True)
class TargetPlaces:
    """Targets on a motion.

    Attributes
    ----------
    places : (n,) in cells
    misses : (n, k)
    along : (n, k) directions in which the places may move: unit vectors of each, or one unit vector of all together;
        zero where a place stays
    common : whether the places move together
    """

    places: Array
    misses: Array
    along: Array
    common: bool

    def project(self, vectors: Array) -> Array:
        """What of vectors (n, k, free) no move of the places can undo, as rows (n k, free)."""
        if self.common:
            amount = np.einsum("nk,nkp->p", self.along, vectors)
            across = vectors - self.along[:, :, None] * amount
        else:
            amounts = np.einsum("nk,nkp->np", self.along, vectors)
            across = vectors - self.along[:, :, None] * amounts[:, None, :]
        rows: Array = across.reshape(-1, vectors.shape[-1])
        return rows


def nearest_places(motion: SampledMotion, targets: BodyTargets, ordered: bool) -> TargetPlaces:
    """Targets at the nearest places of the motion, in their order where that is kept."""
    every = motion.cells // COARSE if motion.cells % COARSE == 0 else 1
    coarse = targets.embed(motion.rows[::every])
    cells, part = ordered_places(coarse, targets.embed(targets.rows), ordered)
    first = every * (cells + part)
    low, high = every * (cells - BESIDE), every * (cells + 1 + BESIDE)
    if not motion.closes:
        low, high = np.maximum(low, 0.0), np.minimum(high, motion.cells)
    places = first
    for _step in range(FOOT_STEPS):
        rows, rates = motion.at(places)
        square = np.maximum((rates**2).sum(axis=1), TINY)
        before = places
        places = np.clip(places - (targets.misses(rows) * rates).sum(axis=1) / square, low, high)
        if np.abs(places - before).max() < SETTLED:
            break
    rows, rates = motion.at(places)
    inner = (places > low) & (places < high)
    length = np.maximum(np.linalg.norm(rates, axis=1), TINY)
    along = np.where(inner[:, None], rates / length[:, None], 0.0)
    return TargetPlaces(motion.within(places), targets.misses(rows), along, False)


def shifted_places(motion: SampledMotion, targets: BodyTargets, offsets: Array) -> TargetPlaces:
    """Targets at given places (n,) but for a common shift, with which they are missed least."""
    shift, ends = best_shift(motion, targets, offsets), shift_range(motion, offsets)
    for _step in range(SHIFT_STEPS):
        rows, rates = motion.at(offsets + shift)
        square = max(float((rates**2).sum()), TINY)
        step = float(np.clip(-(targets.misses(rows) * rates).sum() / square, -1.0, 1.0))
        moved = float(np.clip(shift + step, *ends))
        shift, step = moved, moved - shift
        if abs(step) < SETTLED:
            break
    rows, rates = motion.at(offsets + shift)
    length = max(float(np.linalg.norm(rates)), TINY)
    along = rates / length if ends[0] < shift < ends[1] else np.zeros_like(rates)
    return TargetPlaces(motion.within(offsets + shift), targets.misses(rows), along, True)


def shift_range(motion: SampledMotion, offsets: Array) -> tuple[float, float]:
    """Least and greatest shift with which all places lie on the motion; any one of a motion that closes."""
    if motion.closes:
        return -math.inf, math.inf
    return -float(offsets.min()), motion.cells - float(offsets.max())


def best_shift(motion: SampledMotion, targets: BodyTargets, offsets: Array) -> float:
    """The best of the shifts by whole cells, by chords."""
    which = _few(len(offsets))
    shifts, rows = _shifted_rows(motion, offsets[which])
    costs = (targets.take(which).misses(rows) ** 2).sum(axis=(1, 2))
    return float(shifts[int(np.argmin(costs))])


def _few(count: int) -> Cells:
    return np.unique(np.linspace(0, count - 1, min(count, SCANNED)).round().astype(np.int64))


def _shifted_rows(motion: SampledMotion, offsets: Array) -> tuple[Array, Array]:
    """Shifts (s,) by a cell each, and the rows (s, n, k) that places have there."""
    if motion.closes:
        shifts = np.arange(motion.cells, dtype=np.float64)
    else:
        low, high = shift_range(motion, offsets)
        shifts = np.linspace(low, max(low, high), max(2, int(high - low) + 1))
    cells, part = motion.split(shifts[:, None] + offsets)
    rows = motion.rows[cells] + part[..., None] * (motion.rows[cells + 1] - motion.rows[cells])
    return shifts, rows


# Where the whole mechanism may stand anywhere: a first similarity, from which least squares go on.


def shifted_similarity(motion: SampledMotion, targets: BodyTargets, offsets: Array) -> Similarity:
    """What brings given places but for a common shift nearest to the targets, over all shifts by a cell."""
    which = _few(len(offsets))
    _shifts, rows = _shifted_rows(motion, offsets[which])
    return _best_similarity(rows, targets.take(which))[0]


def aligned_similarity(motion: SampledMotion, targets: BodyTargets) -> Similarity:
    """What brings the motion nearest to targets in their order whose places nobody gives.

    Places are spread as the targets are by their distances, by their turns, or evenly, over parts of the motion from
    all beginnings in either sense; the best of them are then moved to where they are nearest.
    """
    targets = targets.take(_few(len(targets.rows)))
    places = np.concatenate(list(_alignments(motion, targets)))
    cells, _part = motion.split(places)
    _best, factors, shifts, costs = _best_similarity(motion.rows[cells], targets)
    chosen: list[int] = []
    for index in np.argsort(costs, kind="stable").tolist():
        if all(np.abs(places[index] - places[k]).max() > 2.0 * motion.cells / BEGINNINGS for k in chosen):
            chosen.append(index)
        if len(chosen) == ALIGNMENTS:
            break
    places, factors, shifts = places[chosen], factors[chosen], shifts[chosen]
    for _round in range(ALIGNED):
        places = _nearby(motion, targets, places, factors, shifts)
        cells, _part = motion.split(places)
        best, factors, shifts, costs = _best_similarity(motion.rows[cells], targets)
    return best


def _alignments(motion: SampledMotion, targets: BodyTargets) -> Iterator[Array]:
    """Places (..., n) of targets, by each way to spread them."""
    steps = np.diff(targets.rows, axis=0)
    begins = motion.cells * np.linspace(0.0, 1.0, BEGINNINGS, endpoint=not motion.closes)
    senses, shares = np.array([1.0, -1.0]), motion.cells * np.array(SHARES)
    for spread in (np.linalg.norm(steps[:, :2], axis=1), np.abs(steps[:, -1]), np.ones(len(steps))):
        if not spread.sum() > 0:
            continue
        part = np.concatenate([[0.0], np.cumsum(spread)]) / spread.sum()
        places = begins[:, None, None, None] + senses[:, None, None] * shares[:, None] * part
        places = places.reshape(-1, len(part))
        if not motion.closes:
            places = places[(places.min(axis=1) >= -1e-9) & (places.max(axis=1) <= motion.cells + 1e-9)]
        yield places


def _best_similarity(rows: Array, targets: BodyTargets) -> tuple[Similarity, Complex, Complex, Array]:
    """The best similarity of places whose rows are (..., n, k); factors and shifts of all, and what they miss.

    Of points it is that of Procrustes. With directions, turn and scale are improved in turns: each is best for the
    other one then.
    """
    points, goal = rows[..., 0] + 1j * rows[..., 1], targets.rows[:, 0] + 1j * targets.rows[:, 1]
    middle = points.mean(axis=-1)
    own = points - middle[..., None]
    square = np.maximum((np.abs(own) ** 2).sum(axis=-1), TINY)
    pull = (own.conj() * (goal - goal.mean())).sum(axis=-1)
    turned = np.zeros_like(pull)
    if rows.shape[-1] == 3:
        turned = targets.arm**2 * np.exp(1j * (targets.rows[:, 2] - rows[..., 2]) / targets.arm).sum(axis=-1)
    scale = np.maximum(np.abs(pull) / square, 1e-9)
    for _turn in range(4 if rows.shape[-1] == 3 else 1):
        way = scale * pull + turned
        direction = way / np.maximum(np.abs(way), TINY)
        scale = np.maximum((direction.conj() * pull).real / square, 1e-9)
    factors = scale * direction
    shifts = goal.mean() - factors * middle
    missed = targets.misses(_move_rows(rows, factors[..., None], shifts[..., None], targets.arm))
    costs = (missed**2).sum(axis=(-2, -1))
    best = int(np.argmin(costs))
    return Similarity(complex(factors[best]), complex(shifts[best])), factors, shifts, costs


def _move_rows(rows: Array, factors: Complex, shifts: Complex, arm: float) -> Array:
    points = factors * (rows[..., 0] + 1j * rows[..., 1]) + shifts
    parts = [points.real, points.imag]
    if rows.shape[-1] == 3:
        parts.append(rows[..., 2] + arm * np.angle(factors))
    return np.stack(parts, axis=-1)


def _nearby(
    motion: SampledMotion, targets: BodyTargets, places: Array, factors: Complex, shifts: Complex
) -> Array:
    """Places (k, n) moved to the nearest sample of the moved motion, within a window of each."""
    reach = max(1, round(WINDOW * motion.cells))
    window = places[..., None] + np.arange(-reach, reach + 1)
    cells, _part = motion.split(window)
    rows = _move_rows(
        motion.rows[cells].swapaxes(-3, -2), factors[:, None, None], shifts[:, None, None], targets.arm
    )
    distance = (targets.misses(rows) ** 2).sum(axis=-1)
    best = np.argmin(distance, axis=1)
    moved: Array = np.take_along_axis(window, best[..., None], axis=-1)[..., 0]
    return moved
