"""Following a group along the parameter of the path itself, as far as no limit and no change point is near.

There the place at a parameter is a root of as many equations as there are free coordinates, and what is known of the
plan before the group is computed for many parameters at once. Where the determinant falls, the curve turns away or a
place is not where it was foretold, the group is followed along its curve (`curve_continuation`).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.kinematics.higher_class.loop_closure import LoopClosure, solve_places
from centrode.kinematics.higher_class.system import Surroundings, total
from centrode.numerics.jets import Jet

Array: TypeAlias = npt.NDArray[np.float64]
Lanes: TypeAlias = npt.NDArray[np.intp]
Mask: TypeAlias = npt.NDArray[np.bool_]

PITCH = 1.0 / 64.0
"""Distance of the places at which a group may stand, in the path's units: steps are whole numbers of it."""
BLOCK = 448
"""Places of a walker for which what is known is computed at once: more than a turn has."""
STEPS = 6
"""Newton steps at a place."""
ENOUGH, CONTRACTION, FAR = 1e-9, 0.2, 3e-4
"""What part of a step along the path the next Newton step may be, and by how much every one must be smaller;
the first counts as one after a step as great as the last of these."""
TARGET, TRUST = 3e-4, 3e-2
"""By how much of its step a foretold place should be wrong, and the most that it may, as along the curve."""
STRAIGHT, LEFT = 0.9, 0.3
"""Cosine of the angle by which the curve may turn in a step, and the part of the determinant that must be left."""
FIRST, GREATEST, GROWTH = 4, 0.8, 3.0
"""The first step in places, the greatest one, in rad and in the greatest length of all free coordinates together, and
by how much one may be longer than the one before. Steps are greater than along curves, as the determinant is looked at
in all places that they pass."""
BEYOND = int(GREATEST / PITCH)
"""Places that the last step may lead beyond the end: those of the longest step, as the pace is at least 1."""
FAST = 8.0
"""How fast free coordinates may move against the path, in its units: faster ones are near a limit."""


@dataclass
class WalkerCourse:
    """Places of one walker: `parameter` and states with their first and second Taylor coefficients by it."""

    parameter: list[float] = field(default_factory=list)
    series: list[Array] = field(default_factory=list)
    sense: float = 0.0
    ended: bool = False
    """Whether it came to its end, or round."""
    regular: bool = True
    """Whether no determinant changed its sign between its places."""

    def add(self, parameter: float, series: Array, sense: float) -> None:
        """Add a place with its series (3, n)."""
        self.parameter.append(parameter)
        self.series.append(series.copy())
        self.sense = sense

    def pieces(self, loops: LoopClosure, first: int = 0) -> Array:
        """Polynomials (k, 6, width + 1) between the places from one on, in the share of the way."""
        way = np.diff(self.parameter[first:])[:, None]
        states = np.stack([loops.state(of_order) for of_order in np.stack(self.series[first:], axis=1)])
        pieces = np.zeros((len(way), 6, states.shape[2] + 1))
        pieces[:, :, :-1] = np.moveaxis(hermite(states[:, :-1], states[:, 1:], way), 0, 1)
        # the parameter counts from the beginning of each piece
        pieces[:, 1, -1:] = way
        return pieces


Closed: TypeAlias = Callable[[Lanes, Sequence[WalkerCourse]], Sequence[np.intp]]
"""Which of some walkers have come round with their last steps."""


class _Ahead:
    """What is known at the places of all walkers, computed in blocks."""

    def __init__(
        self, around: Surroundings, loops: LoopClosure, lane: Lanes, start: float, step: Array, most: Lanes
    ) -> None:
        self.around, self.loops, self.lane = around, loops, lane
        self.start, self.step, self.most = start, step, int(np.max(most))
        self.blocks: dict[int, Array] = {}

    def known(self, who: Lanes, number: Lanes) -> Array:
        """Coefficients (3, k, known) by the parameter at places of walkers."""
        if self.most + BEYOND < BLOCK:
            return self._block(0)[:, who, number]
        blocks = number // BLOCK
        parts = [self._block(int(b))[:, w, n] for b, w, n in zip(blocks, who, number % BLOCK, strict=True)]
        return np.stack(parts, axis=1)

    def _block(self, block: int) -> Array:
        if block not in self.blocks:
            self.blocks[block] = self._computed_block(block)
        return self.blocks[block]

    def _computed_block(self, block: int) -> Array:
        count = min(BLOCK, self.most + 1 + BEYOND - block * BLOCK)
        walkers = len(self.lane)
        number = np.tile(np.arange(count) + block * BLOCK, walkers)
        who = np.repeat(np.arange(walkers), count)
        parameter = self.start + self.step[who] * number
        known = self.around.known(Jet((parameter, np.ones(len(parameter)), 0.0)), self.lane[who])
        numbers = self.loops.known(known, len(parameter), 3)
        return numbers.reshape(3, walkers, count, -1)


@dataclass
class _WalkerPlaces:
    """Where walkers stand.

    Attributes
    ----------
    series : numbers of the group with their first and second coefficients by the parameter (3, k, n)
    size : determinants (k,)
    pace : length of the curve of the free coordinates for one unit of the path (k,)
    direction : unit vectors of this curve (k, free + 1)
    """

    series: Array
    size: Array
    pace: Array
    direction: Array

    @classmethod
    def at(cls, loops: LoopClosure, free: Array, whole: Array, known: Array, unit: float) -> _WalkerPlaces:
        """Places where the equations hold."""
        numbers = loops.numbers(free, whole, known[0])
        matrix = loops.matrix(numbers)
        series = loops.series(numbers, known, matrix)
        along = np.ones((len(free), loops.free + 1))
        along[:, :-1] = unit * series[1, :, loops.coordinates]
        pace = np.sqrt(total(along * along))
        return cls(series, np.linalg.det(matrix), pace, along / pace[:, None])

    def of(self, which: Mask) -> _WalkerPlaces:
        """Some of the places."""
        return _WalkerPlaces(self.series[:, which], self.size[which], self.pace[which], self.direction[which])

    def lie_straight_behind(self, before: _WalkerPlaces, who: Lanes) -> Mask:
        """Whether the curve leads here from places of some walkers before without a turn, a limit or a change point."""
        slow = (self.pace <= FAST) & (self.size / before.size[who] >= LEFT)
        straight: Mask = total(self.direction * before.direction[who]) >= STRAIGHT
        return slow & straight

    def put(self, which: Lanes, others: _WalkerPlaces) -> None:
        """Put others in some of the places."""
        self.series[:, which], self.size[which] = others.series, others.size
        self.pace[which], self.direction[which] = others.pace, others.direction


def walk_by_parameter(
    around: Surroundings,
    loops: LoopClosure,
    lane: Lanes,
    start: Array,
    initial: float,
    ends: Array,
    closed: Closed,
) -> list[WalkerCourse]:
    """Follow walkers from states (k, width) in the initial position towards the ends (k,) of their ways."""
    courses = [WalkerCourse() for _walker in lane]
    pitch = PITCH * around.unit
    steps = np.where(ends < initial, -pitch, pitch)
    most = np.ceil(np.abs(ends - initial) / pitch).astype(np.intp)
    everyone, number = np.arange(len(lane)), np.zeros(len(lane), dtype=np.intp)
    ahead = _Ahead(around, loops, lane, initial, steps, most)
    free, whole = loops.free_of(start)
    with np.errstate(all="ignore"):
        here = _WalkerPlaces.at(loops, free, whole, ahead.known(everyone, number), around.unit)
        for walker, course in enumerate(courses):
            course.add(initial, here.series[:, walker], float(np.sign(here.size[walker])))
        # polynomials of the last steps in the share of these: to begin with there are none
        last, strides = np.full((6, len(lane), loops.free), np.nan), np.full(len(lane), FIRST, dtype=np.intp)
        passed = np.ones(len(lane), dtype=np.intp)
        going = (most > 0) & np.isfinite(here.pace) & (here.size != 0.0)
        while going.any():
            who = np.nonzero(going)[0]
            # the last step may lead beyond the end, so that steps, and with them last bits, do not hang on the range
            stride: Lanes = strides[who]
            foretold = _foretold(
                loops,
                here.series[:, who],
                last[:, who],
                np.multiply(stride, steps[who]),
                np.divide(stride, passed[who]),
            )
            known = ahead.known(who, number[who] + stride)
            way = stride * PITCH * here.pace[who]
            found, reached, wrong = _newton(loops, foretold - whole[who], whole[who], known[0], way)
            there = _WalkerPlaces.at(loops, reached, whole[who], known, around.unit)
            good = found & (wrong <= TRUST * way) & there.lie_straight_behind(here, who)
            going[who[~good]] = stride[~good] > 1
            strides[who[~good]] = np.maximum(stride[~good] * 2 // 5, 1)
            if not good.any():
                continue
            who, stride, there, way, wrong = who[good], stride[good], there.of(good), way[good], wrong[good]
            number[who] += stride
            last[:, who] = hermite(
                here.series[:, who][:, :, loops.coordinates],
                there.series[:, :, loops.coordinates],
                np.multiply(stride, steps[who])[:, None],
            )
            passed[who] = stride
            here.put(who, there)
            for k, walker in enumerate(who.tolist()):
                at = float(initial + steps[walker] * number[walker])
                courses[walker].add(at, there.series[:, k], courses[walker].sense)
            strides[who] = _next_strides(stride, way, wrong, there.pace)
            for walker in (*who[number[who] >= most[who]], *closed(who, courses)):
                courses[walker].ended, going[walker] = True, False
        for walker, course in enumerate(courses):
            course.regular = _is_regular(loops, course, ahead, walker, whole[walker])
    return courses


def _next_strides(stride: Lanes, way: Array, wrong: Array, pace: Array) -> Lanes:
    """Strides after steps of a way each that the polynomials foretold wrong by so much: their fifth order decides."""
    longer = np.minimum(stride * np.clip((TARGET * way / wrong) ** 0.2, 0.3, 2.0), GREATEST / (PITCH * pace))
    return np.maximum(longer, 1.0).astype(np.intp)


def _is_regular(loops: LoopClosure, course: WalkerCourse, ahead: _Ahead, walker: int, whole: Array) -> bool:
    """Whether the determinant keeps its sign in all places that the steps of a walker have passed."""
    edges = np.array(course.parameter)
    ways = np.diff(edges)
    if not len(ways):
        return True
    numbers = np.arange(1, round(float((edges[-1] - edges[0]) / ahead.step[walker])))
    at = ahead.start + ahead.step[walker] * numbers
    # parameters of a walker that goes back fall
    sense = np.sign(ahead.step[walker])
    piece = np.searchsorted(sense * edges[1:-1], sense * at)
    series = np.stack(course.series, axis=1)[:, :, loops.coordinates]
    powers = hermite(series[:, :-1], series[:, 1:], ways[:, None])[:, piece]
    share = ((at - edges[piece]) / ways[piece])[:, None]
    free = powers[5]
    for of_order in powers[4::-1]:
        free = free * share + of_order
    known = ahead.known(np.full(len(numbers), walker), numbers)[0]
    places = loops.numbers(free - whole, np.broadcast_to(whole, free.shape), known)
    return bool((np.sign(np.linalg.det(loops.matrix(places))) == course.sense).all())


def _foretold(loops: LoopClosure, series: Array, last: Array, way: Array, share: Array) -> Array:
    """Free coordinates a way ahead: by the last polynomials, or by Taylor's polynomial at the start."""
    here, first, second = series[:, :, loops.coordinates]
    taylor = way[:, None] * (first + way[:, None] * second)
    beyond = 1.0 + share[:, None]
    value = last[5]
    for coefficient in last[4::-1]:
        value = value * beyond + coefficient
    # only the change since the end of the last step is taken: rounding of the polynomials does not add up
    change = value - np.add.reduce(last, axis=0)
    return np.asarray(here + np.where(np.isfinite(change), change, taylor))


def _newton(
    loops: LoopClosure, start: Array, whole: Array, known: Array, way: Array
) -> tuple[Mask, Array, Array]:
    """Free coordinates near foretold ones: whether they are found, where they are, and how wrong these were."""
    free, last = start, np.full(len(start), FAR)
    arrived, active = np.zeros(len(start), dtype=bool), np.ones(len(start), dtype=bool)
    wrong = last
    for k in range(STEPS):
        left, matrix = loops.equations(loops.numbers(free, whole, known))
        step = solve_places(matrix, left[:, :, None])[:, :, 0]
        size = np.maximum.reduce(np.abs(step), axis=1)
        if k == 0:
            wrong = size
        good = active & (size < 1.0)
        free = np.where(good[:, None], free - step, free)
        # until the next step, foretold by quadratic convergence, is small beside the way
        done = good & (size * (size / last) ** 2 <= ENOUGH * way)
        arrived |= done
        active = good & ~done & ((k == 0) | (size <= np.maximum(CONTRACTION * last, 1e-9)))
        last = size
        if not active.any():
            break
    return arrived, free, wrong


def hermite(here: Array, there: Array, way: Array) -> Array:
    """Polynomials (6, ...) in the share of ways between places with their first and second coefficients (3, ...)."""
    # the first three match here; a, b, c are what these leave of value, slope and second derivative there
    c0, c1, c2 = here[0], here[1] * way, here[2] * way**2
    a = there[0] - c0 - c1 - c2
    b, c = there[1] * way - c1 - 2.0 * c2, 2.0 * there[2] * way**2 - 2.0 * c2
    powers = np.empty((6, *a.shape))
    powers[0], powers[1], powers[2] = c0, c1, c2
    powers[3] = 10.0 * a - 4.0 * b + 0.5 * c
    powers[4] = -15.0 * a + 7.0 * b - c
    powers[5] = 6.0 * a - 3.0 * b + 0.5 * c
    return powers
