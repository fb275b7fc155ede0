"""What a group gives next to its change points: power series about the change point.

Beside a change point the closed form of a group loses digits, while its motion is analytic there. So its positions
are taken on a circle of complex values of the path's parameter around the change point, where nothing is lost, and
Cauchy's integral gives the coefficients of their power series (Lyness and Moler, SIAM Journal on Numerical Analysis
4, 1967; Fornberg, ACM Transactions on Mathematical Software 7, 1981). The coefficients tell by themselves whether
the circle holds a singularity: those that a power series does not have, of negative powers, are not zero then.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.jets import Jet
from centrode.algebra.rounding import UNIT_ROUNDOFF, Rounded
from centrode.kinematics.evaluate import Kinematics
from centrode.structure.constraints import Positions, mapped_pose
from centrode.structure.groups import links_of, points_of

Array: TypeAlias = npt.NDArray[np.float64]
Lanes: TypeAlias = npt.NDArray[np.intp]
Mask: TypeAlias = npt.NDArray[np.bool_]
Number: TypeAlias = Any
Index: TypeAlias = tuple[Any, ...]

NODES = 128
"""Values on a circle; positions at conjugate values are conjugate, so half of them are computed."""
TERMS = NODES // 2
"""Powers that a series keeps; the other coefficients have to vanish."""
NOISE = 1.0 / 64
"""Part of the rounding error of the values on a circle below which a coefficient says nothing."""
HALF_CIRCLE = np.exp(1j * np.pi * np.arange(TERMS + 1) / TERMS)
"""From the real node above the change point to the one below it."""
HALF_CIRCLE[[0, -1]] = 1.0, -1.0


@dataclass(frozen=True)
class Windows:
    """The stretches about the change points of a group, of all mechanisms of a batch: arrays (windows,).

    `radius` is that of the circle on which a series rests, 0 where there is none.
    """

    lane: Lanes
    centre: Array
    half: Array
    radius: Array

    def __len__(self) -> int:
        return len(self.lane)

    def of(self, which: Lanes | Mask) -> Windows:
        """Some of the stretches."""
        return Windows(self.lane[which], self.centre[which], self.half[which], self.radius[which])


@dataclass(frozen=True)
class Series:
    """What a group gives about its change points.

    Attributes
    ----------
    numbers : for each number of the group (windows, TERMS): coefficients of powers of (parameter - centre) / radius
    bounds : for each number of the group (windows,): rounding error of its values on the circle
    """

    numbers: list[Array]
    bounds: list[Array]

    def put(self, into: Series | None, places: Lanes, chosen: Mask, windows: int) -> Series:
        """Other series, of so many windows, with the chosen ones of these at their places."""
        if into is None:
            into = Series(
                [np.zeros((windows, TERMS)) for _ in self.numbers], [np.zeros(windows) for _ in self.bounds]
            )
        for whole, part in zip((*into.numbers, *into.bounds), (*self.numbers, *self.bounds), strict=True):
            whole[places] = part[chosen]
        return into

    def without_rounding(self) -> Series:
        """The series without the last terms of each, as far as these are rounding errors."""
        numbers = []
        for number, bound in zip(self.numbers, self.bounds, strict=True):
            counts = np.abs(number) > NOISE * bound[:, None]
            counts = np.logical_or.accumulate(counts[:, ::-1], axis=1)[:, ::-1]
            length = int(np.max(np.sum(counts, axis=1), initial=1))
            numbers.append(np.where(counts, number, 0.0)[:, :length])
        return Series(numbers, self.bounds)


def inside(windows: Windows, along: Array, lanes: Lanes | None) -> tuple[Index, Lanes]:
    """Index of the parameters inside a window, and which window that is; of two the later one counts.

    `along` are parameters (n,) of all mechanisms, or with `lanes` one mechanism's each; then they may be complex.
    """
    if lanes is None:
        order = np.argsort(along, kind="stable")
        ends = windows.centre - windows.half, windows.centre + windows.half
        # one more on both sides: the last bit is left to the comparison below
        first = np.maximum(np.searchsorted(along[order], ends[0]) - 1, 0)
        last = np.minimum(np.searchsorted(along[order], ends[1], side="right") + 1, len(along))
    else:
        order = np.argsort(lanes, kind="stable")
        first, last = (np.searchsorted(lanes[order], windows.lane, side=side) for side in ("left", "right"))
    counts = last - first
    chosen = np.repeat(np.arange(len(windows)), counts)
    places = order[np.arange(len(chosen)) + np.repeat(first - np.cumsum(counts) + counts, counts)]
    within = np.abs(along[places] - windows.centre[chosen]) < windows.half[chosen]
    chosen, places = chosen[within], places[within]
    return ((windows.lane[chosen], places) if lanes is None else (places,)), chosen


def numbers_of(kinematics: Kinematics, group: int, at: Positions) -> list[Number]:
    """Everything a group gives, number by number."""
    which = kinematics.structure.groups[group]
    numbers = [x for point in points_of(which) for x in at.points[point]]
    for link in links_of(which):
        numbers += [x for vector in at.poses[link] for x in vector]
    return numbers + [at.angles[link] for link in links_of(which) if link in at.angles]


def set_numbers(kinematics: Kinematics, group: int, at: Positions, numbers: list[Number]) -> None:
    """Put numbers in the order of `numbers_of` back into positions."""
    which = kinematics.structure.groups[group]
    rest = iter(numbers)
    for point in points_of(which):
        at.points[point] = tuple(next(rest) for _old in at.points[point])
    for link in links_of(which):
        at.poses[link] = mapped_pose(at.poses[link], lambda _old: next(rest))
    for link in links_of(which):
        if link in at.angles:
            at.angles[link] = next(rest)


def coefficients(number: Number, windows: int) -> Array:
    """All coefficients (windows, NODES) of a number given on the half circles of the windows, one after the other.

    The first TERMS are those of the power series, the others those of what a series leaves over.
    """
    on_circle = np.broadcast_to(number, (windows * len(HALF_CIRCLE),)).reshape(windows, -1)
    return np.asarray(np.fft.hfft(on_circle, NODES) / NODES)


def mended(
    old: Number,
    series: Array,
    bound: Array,
    windows: Windows,
    shape: tuple[int, ...],
    index: Index,
    chosen: Lanes,
    along: Array,
) -> Number:
    """A number with the entries at `index`, at parameters `along`, given by the series of the chosen windows.

    Where a window has no series the value stays, without derivatives.
    """
    order = old.order if isinstance(old, Jet) else 0
    bare = windows.radius[chosen] == 0.0
    if bare.any():
        bare_at = tuple(part[bare] for part in index)
        if isinstance(old, Jet):
            there = np.full(len(bare_at[0]), np.nan)
            old = Jet([old.value, *(_put(c, shape, bare_at, there) for c in old.coefficients[1:])])
        index, chosen, along = tuple(part[~bare] for part in index), chosen[~bare], along[~bare]
    known = _summed(series[chosen], (along - windows.centre[chosen]) / windows.radius[chosen], order)
    scale = 1.0 / windows.radius[chosen]
    if isinstance(old, Jet):
        return Jet(
            [
                _put(c, shape, index, x * scale**k)
                for k, (c, x) in enumerate(zip(old.coefficients, known, strict=True))
            ]
        )
    if isinstance(old, Rounded):
        value = known[0]
        error = bound[chosen] + UNIT_ROUNDOFF * np.abs(value)
        return Rounded(_put(old.value, shape, index, value), _put(old.bound, shape, index, error))
    return _put(old, shape, index, known[0])


def _summed(series: Array, x: Array, order: int) -> list[Array]:
    """Taylor coefficients up to an order of power series (n, TERMS) at places (n,), by Horner's rule.

    The terms are added one by one: a matrix product rounds differently for different numbers of samples.
    """
    found = [np.zeros(x.shape, dtype=x.dtype) for _ in range(order + 1)]
    for k in range(series.shape[1] - 1, -1, -1):
        for j in range(order, 0, -1):
            found[j] = found[j] * x + found[j - 1]
        found[0] = found[0] * x + series[:, k]
    return found


def _put(old: Number, shape: tuple[int, ...], index: Index, values: Array) -> Array:
    whole = np.array(
        np.broadcast_to(old, shape), dtype=np.result_type(np.asarray(old).dtype, values.dtype, np.float64)
    )
    whole[index] = values
    return whole
