"""Where targets lie on a sampled curve: in their order, on the curve as it stands or moved by the best similarity.

With a free place the curve is turned, scaled and shifted onto the targets: for given places on it the best similarity
is that of Procrustes (P. H. Schoenemann, R. M. Carroll, Psychometrika 35, 1970, 245-255), without a mirror linear in
the complex numbers. The places along the curve are found with it by Gauss-Newton steps, so misses and their derivatives
are those of the free numbers alone (G. H. Golub, V. Pereyra, SIAM J. Numer. Anal. 10, 1973, 413-432).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from centrode.model.similarity import Similarity
from centrode.synthesis.four_bars import Array, Complex
from centrode.synthesis.measures import hermite

SHARES = (0.06, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0)
"""Parts of the curve's length that an open path may be."""
BEGINNINGS = 72
"""Places of the curve at which it may begin."""
ALIGNMENTS = 6
"""The best of them go on."""
FIRST_STEPS, STEPS, FOLLOWED = 4, 30, 2
"""Steps of all of them, and of the two that are nearest then."""
LONGEST_STEP = 4.0
"""Cells by which a place moves at most in one step."""
PASSING = 0.45
"""Of the gap to a neighbour, which a place goes at most: two that approach each other do not meet."""
SETTLED = 1e-7
RIDGE = 1e-12
"""What keeps the equations of targets on a circle, along which a turn and the places do the same, solvable."""
TINY = 1e-300


def ordered_places(
    curve: Array, targets: Array, ordered: bool
) -> tuple[np.ndarray[tuple[int], np.dtype[np.int64]], Array]:
    """Cells (n,) of a sampled curve that are nearest to targets, and the parts (n,) of the cells.

    In the order of the targets, over less than a turn: the best of all such choices (dynamic programming), run through
    in either sense.
    """
    steps = np.diff(curve, axis=0)
    square = np.maximum((steps**2).sum(axis=1), 1e-300)
    away = targets[:, None] - curve[None, :-1]
    part = np.clip((away * steps).sum(axis=-1) / square, 0.0, 1.0)
    distance = ((away - part[..., None] * steps) ** 2).sum(axis=-1)
    count = np.arange(len(targets))
    if not ordered:
        cells = np.argmin(distance, axis=1)
        return cells, part[count, cells]
    places = len(steps)
    closes = float(np.linalg.norm(curve[0] - curve[-1])) < 1e-6 * float(np.abs(curve).max() + 1e-300)
    cuts = np.arange(0, places, max(1, places // 12)) if closes else np.zeros(1, dtype=np.int64)
    # (senses, cuts, places): which place of the curve comes after which
    ways = (np.arange(places) + cuts[:, None]) % places
    ways = np.stack([ways, places - 1 - ways])
    costs, cells = monotone_places(distance[:, ways])
    sense, cut = divmod(int(np.argmin(costs)), len(cuts))
    chosen = ways[sense, cut][cells[:, sense, cut]]
    return chosen, part[count, chosen]


def monotone_places(distance: Array) -> tuple[Array, np.ndarray[tuple[int, ...], np.dtype[np.int64]]]:
    """Least sums (...) of distances (n, ..., places) over places that do not decrease, and the places (n, ...)."""
    n, places = len(distance), distance.shape[-1]
    total = distance[0]
    before = np.zeros(distance.shape, dtype=np.int64)
    first = np.full((*total.shape[:-1], 1), True)
    for row in range(1, n):
        run = np.minimum.accumulate(total, axis=-1)
        # the last place at which the running minimum was lowered
        lowered = np.concatenate([first, total[..., 1:] < run[..., :-1]], axis=-1)
        before[row] = np.maximum.accumulate(np.where(lowered, np.arange(places), 0), axis=-1)
        total = run + distance[row]
    cells = np.zeros(distance.shape[:-1], dtype=np.int64)
    cells[-1] = np.argmin(total, axis=-1)
    for row in range(n - 1, 0, -1):
        cells[row - 1] = np.take_along_axis(before[row], cells[row][..., None], axis=-1)[..., 0]
    return total.min(axis=-1), cells


@dataclass(frozen=True)
class SampledCurve:
    """A curve by samples (m,) with its tangents: between two samples it is the cubic of both.

    Attributes
    ----------
    points : complex coordinates [m]
    tangents : their change from one sample to the next, by the velocity there
    """

    points: Complex
    tangents: Complex

    @cached_property
    def closes(self) -> bool:
        """Whether its last point is the first."""
        gap = abs(complex(self.points[0] - self.points[-1]))
        return gap < 1e-6 * (float(np.abs(self.points - self.points.mean()).max()) + TINY)

    @property
    def cells(self) -> int:
        """Number of its cells."""
        return len(self.points) - 1

    def within(self, places: Array) -> Array:
        """Places on the curve: a closed one is run through again and again, an open one has ends."""
        return np.mod(places, self.cells) if self.closes else np.clip(places, 0.0, self.cells)

    def weights(self, places: Array) -> tuple[np.ndarray[tuple[int, ...], np.dtype[np.int64]], Array, Array]:
        """Cells of places, and weights of their ends for the point and for its derivative by the place."""
        cells = np.minimum(places.astype(np.int64), self.cells - 1)
        return cells, *hermite(places - cells)

    def at(self, places: Array) -> tuple[Complex, Complex]:
        """Points at places, and their derivatives."""
        cells, weights, slopes = self.weights(places)
        ends = np.array(
            [self.points[cells], self.tangents[cells], self.points[cells + 1], self.tangents[cells + 1]]
        )
        return (weights * ends).sum(axis=0), (slopes * ends).sum(axis=0)


def best_similarity(points: Complex, targets: Complex) -> tuple[Complex, Complex]:
    """Factors and shifts (...) that bring points (..., n) closest to targets (n,)."""
    middle, goal = points.mean(axis=-1), targets.mean()
    own = points - middle[..., None]
    square = np.maximum((np.abs(own) ** 2).sum(axis=-1), TINY)
    factor: Complex = (own.conj() * (targets - goal)).sum(axis=-1) / square
    return factor, goal - factor * middle


@dataclass(frozen=True)
class PlacedCurve:
    """Targets on a curve that was moved onto them.

    Attributes
    ----------
    places : (n,) of the targets on the curve, in cells
    similarity : that moves the curve
    misses : (n,) from the targets to the places of the moved curve [m], complex
    along : (n,) unit tangents of the moved curve; zero at the ends of an open one
    """

    places: Array
    similarity: Similarity
    misses: Complex
    along: Complex

    def project(self, vectors: Complex) -> Array:
        """What of complex vectors (n, k) lies across the curve, as rows (2n, k) of x and y."""
        along = self.along[:, None]
        across = vectors - along * (along.conj() * vectors).real
        return np.concatenate([across.real, across.imag])

    def slopes(self, points: Complex, changes: Complex) -> Array:
        """Derivatives (2n, free) of the projected misses, those of the curve's points at the places being given.

        What a similarity and steps along the curve can undo is taken out.
        """
        undone = np.stack([np.ones_like(points), np.full_like(points, 1j), points, 1j * points], axis=1)
        basis, _triangle = np.linalg.qr(self.project(undone))
        own = self.project(self.similarity.factor * changes)
        return own - basis @ (basis.T @ own)


def place_curve(curve: SampledCurve, targets: Complex, closed: bool, ordered: bool) -> PlacedCurve:
    """The curve turned, scaled and shifted so that targets (n,) in their order are as near to it as can be.

    Begun at the best of many places at which targets that lie on it by arc length may begin, in either sense.
    """
    places = _follow(curve, _alignments(curve, targets, closed), targets, ordered, FIRST_STEPS)
    nearest = np.argsort((np.abs(_misses(curve, places, targets)) ** 2).sum(axis=1), kind="stable")
    places = curve.within(_follow(curve, places[nearest[:FOLLOWED]], targets, ordered, STEPS))
    points, tangents = curve.at(places)
    factor, shift = best_similarity(points, targets)
    misses = factor[:, None] * points + shift[:, None] - targets
    best = int(np.argmin((np.abs(misses) ** 2).sum(axis=1)))
    along = factor[best] * tangents[best]
    along = np.where(_is_inner(curve, places[best]), along / np.maximum(np.abs(along), TINY), 0.0)
    similarity = Similarity(complex(factor[best]), complex(shift[best]))
    return PlacedCurve(places[best], similarity, misses[best], along)


def _is_inner(curve: SampledCurve, places: Array) -> np.ndarray[tuple[int, ...], np.dtype[np.bool_]]:
    return np.full(places.shape, True) if curve.closes else (places > 0.0) & (places < curve.cells)


def _misses(curve: SampledCurve, places: Array, targets: Complex) -> Complex:
    points, _tangents = curve.at(curve.within(places))
    factor, shift = best_similarity(points, targets)
    missed: Complex = factor[:, None] * points + shift[:, None] - targets
    return missed


def _follow(curve: SampledCurve, places: Array, targets: Complex, ordered: bool, steps: int) -> Array:
    """Places (k, n) after so many Gauss-Newton steps along the curve, with the similarity eliminated in each.

    Places of a closed curve are counted on over its seam.
    """
    for _step in range(steps):
        step = np.clip(_gauss_newton_step(curve, places, targets), -LONGEST_STEP, LONGEST_STEP)
        places = places + (_keep_order(curve, places, step) if ordered else step)
        if not curve.closes:
            places = curve.within(places)
        if np.abs(step).max() < SETTLED:
            break
    return places


def _keep_order(curve: SampledCurve, places: Array, step: Array) -> Array:
    """Steps (k, n) cut so that no place passes its neighbours, nor the last one the first on the way around."""
    sense = np.where(places[:, -1:] >= places[:, :1], 1.0, -1.0)
    gaps = sense * np.diff(places)
    around = curve.cells - gaps.sum(axis=1, keepdims=True) if curve.closes else np.full_like(sense, np.inf)
    before, after = np.concatenate([around, gaps], axis=1), np.concatenate([gaps, around], axis=1)
    kept: Array = sense * np.clip(sense * step, -PASSING * before, PASSING * after)
    return kept


def _gauss_newton_step(curve: SampledCurve, places: Array, targets: Complex) -> Array:
    """Steps (k, n) along the curve, the similarity that changes with them being eliminated."""
    points, tangents = curve.at(curve.within(places))
    factor, shift = best_similarity(points, targets)
    points = factor[:, None] * points + shift[:, None]
    tangents = factor[:, None] * tangents
    size = np.maximum(np.abs(tangents), TINY)
    along = np.where(_is_inner(curve, places), tangents / size, 0.0)
    misses = points - targets
    # about the middle and in units of the size the four are nearly perpendicular
    own = points - points.mean(axis=1)[:, None]
    own = own / np.maximum(np.abs(own).max(axis=1), TINY)[:, None]
    undone = np.stack([np.ones_like(own), np.full_like(own, 1j), own, 1j * own], axis=1)
    across = undone - along[:, None] * (along.conj()[:, None] * undone).real
    normal = misses - along * (along.conj() * misses).real
    matrix = (across[:, :, None] * across[:, None].conj()).real.sum(axis=-1)
    right = (across.conj() * normal[:, None]).real.sum(axis=-1)
    change = -np.linalg.solve(matrix + RIDGE * np.eye(4), right[..., None])
    after = misses + (undone * change).sum(axis=1)
    step: Array = -(along.conj() * after).real / size
    return step


def _alignments(curve: SampledCurve, targets: Complex, closed: bool) -> Array:
    """Places (k, n) of targets spread by arc length, the best k of all beginnings, senses and shares of the curve."""
    lengths = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(curve.points)))])
    whole = max(float(lengths[-1]), TINY)
    path = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(targets)))])
    around = closed and curve.closes
    total = float(path[-1]) + (abs(complex(targets[-1] - targets[0])) if around else 0.0)
    shares = np.array([1.0] if around else SHARES) * whole / max(total, TINY)
    begins = np.linspace(0.0, whole, BEGINNINGS, endpoint=not curve.closes)
    senses = np.array([1.0, -1.0])
    at = begins[:, None, None, None] + senses[:, None, None] * shares[:, None] * path
    at = at.reshape(-1, len(targets))
    if not curve.closes:
        at = at[(at.min(axis=1) > -1e-9 * whole) & (at.max(axis=1) < whole * (1 + 1e-9))]
    # where the curve rests its length does not tell the place: any one there will do
    steady = lengths + 1e-12 * whole * np.arange(len(lengths))
    laps = np.floor(at / whole) if curve.closes else np.zeros_like(at)
    within = np.interp(at - laps * whole, steady, np.arange(len(lengths), dtype=np.float64))
    places = curve.cells * laps + within
    points = np.interp(within, np.arange(len(lengths)), curve.points)
    factor, shift = best_similarity(points, targets)
    errors = (np.abs(factor[:, None] * points + shift[:, None] - targets) ** 2).sum(axis=1)
    chosen: list[int] = []
    for index in np.argsort(errors, kind="stable"):
        # neighbours lead to the same place
        if all(np.abs(places[index] - places[k]).max() > 6.0 * curve.cells / BEGINNINGS for k in chosen):
            chosen.append(int(index))
        if len(chosen) == ALIGNMENTS:
            break
    return places[chosen] if curve.closes else curve.within(places[chosen])
