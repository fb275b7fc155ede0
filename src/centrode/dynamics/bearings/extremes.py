"""Loads of bearings over a motion: extremes of each reaction, found between its samples, means and directions."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.dynamics.bearings.reaction_series import ReactionKind, ReactionSeries, reaction_series
from centrode.dynamics.kinetostatics.reactions import motion_of_reactions
from centrode.dynamics.kinetostatics.reactions import reactions as reactions_of
from centrode.model.mechanism import Mechanism

Array: TypeAlias = npt.NDArray[np.float64]
PARTS = 12
ROUNDS = 5
"""A stretch about an extreme is cut into so many parts, so often."""
# A round leaves two of twelve parts: of the two steps about a sample the fifth leaves 2 (1/6)^5, 2.6e-4 of a step, and
# the place is within half of that. All extremes of a round are computed at once, so few rounds of many parts cost less
# than many rounds of two.
BEND = 2.0
"""How many times its second difference an extreme between samples may be above its sample."""
# A parabola rises an eighth of its second difference above its best sample, a corner of two straight lines at most once
# that difference; the rest is for curves that bend on both sides of a corner.
TOPS = 6
"""Most extremes of one curve that are looked at."""


@dataclass(frozen=True)
class BearingLoad:
    """One reaction over a motion: of forces the magnitude, of other reactions the signed value.

    Attributes
    ----------
    kind, names : what the reaction is, and which one of its kind
    key, unit : variable and side, guide or drive; N or N m
    greatest, at_greatest : its greatest value, and the value of the drive there [rad or m], or the time [s]
    direction : direction of a planar force where it is greatest [rad], in the frame's axes; else None
    least, at_least : its least value, and where
    mean, rms : mean, and root of the mean square, over time
    """

    kind: ReactionKind
    names: tuple[str, ...]
    key: str
    unit: str
    greatest: float
    at_greatest: float
    direction: float | None
    least: float
    at_least: float
    mean: float
    rms: float


@dataclass
class _Top:
    """An extreme that is being narrowed down: of which curve, greatest or least, and between what places."""

    curve: int
    sign: float
    low: float
    high: float
    place: float
    value: float
    vector: Array


def bearing_loads(mechanism: Mechanism, reactions: xr.Dataset) -> tuple[BearingLoad, ...]:
    """Greatest, least, mean and direction of each reaction over a motion.

    Parameters
    ----------
    reactions : Dataset
        Of `reactions`, over a range. What nothing determines is left out.

    Notes
    -----
    Extremes of the samples are narrowed down by computing reactions again in between: places to 1e-4 of the step
    of samples, values of smooth curves to its square times their curvature, beside a jump to it times their slope. An
    extreme that no sample is near is missed. Means are by the trapezoid rule over time, of what is reached.
    """
    places, time = mechanism.motion_parameter.instants(reactions), reactions["time"].values
    curves = [one for one in reaction_series(mechanism, reactions) if np.isfinite(one.values).any()]
    tops = [
        top
        for k, curve in enumerate(curves)
        for sign in (1.0, -1.0)
        for top in _tops(k, sign, places, curve.values)
    ]
    for _round in range(ROUNDS if tops and len(places) > 1 else 0):
        _narrow(mechanism, reactions, curves, tops)
    loads = []
    for k, curve in enumerate(curves):
        high, low = (
            _best([top for top in tops if (top.curve, top.sign) == (k, sign)]) for sign in (1.0, -1.0)
        )
        planar = curve.values.ndim == 2 and curve.values.shape[1] == 2 and high.value > 0.0
        direction = float(np.arctan2(high.vector[1], high.vector[0])) if planar else None
        mean, rms = mean_over_time(time, _size(curve.values))
        loads.append(
            BearingLoad(
                curve.kind,
                curve.names,
                curve.key,
                curve.unit,
                high.value,
                high.place,
                direction,
                low.value,
                low.place,
                mean,
                rms,
            )
        )
    return tuple(loads)


def _size(values: Array) -> Array:
    """Magnitudes of vectors (n, axes), the numbers themselves of numbers (n)."""
    return np.asarray(np.sqrt((values**2).sum(axis=-1))) if values.ndim == 2 else values


def _tops(curve: int, sign: float, places: Array, values: Array) -> list[_Top]:
    """Samples that no neighbour exceeds, where the extreme of all may be, with their neighbours' places."""
    size = sign * _size(values)
    known = np.where(np.isfinite(size), size, -np.inf)
    before, after = np.append(-np.inf, known[:-1]), np.append(known[1:], -np.inf)
    # how far it falls on both sides; nothing where it or its neighbour is not known
    falls = sum(np.nan_to_num(size - sign * _size(np.roll(values, k, axis=0))).clip(min=0.0) for k in (1, -1))
    hoped = known + BEND * falls
    near = np.flatnonzero((known >= before) & (known >= after) & (hoped >= known.max()))
    # by what they may rise to, not by what they are: a steep top may be hidden between samples
    near = near[np.argsort(-hoped[near], kind="stable")][:TOPS]
    last = len(places) - 1
    return [
        _Top(
            curve,
            sign,
            float(places[k - 1] if k > 0 and np.isfinite(known[k - 1]) else places[k]),
            float(places[k + 1] if k < last and np.isfinite(known[k + 1]) else places[k]),
            float(places[k]),
            sign * float(known[k]),
            values[k],
        )
        for k in near.tolist()
    ]


def _narrow(
    mechanism: Mechanism, reactions: xr.Dataset, curves: list[ReactionSeries], tops: list[_Top]
) -> None:
    """Compute reactions between the ends of every stretch, and go on with the part about the best of them."""
    cuts = [np.linspace(top.low, top.high, PARTS + 1) for top in tops]
    # ends of stretches are shared: every place is computed once
    asked, back = np.unique(np.concatenate(cuts), return_inverse=True)
    rubs = any(str(name).startswith("friction_") for name in reactions)
    there = reactions_of(mechanism, at=asked, motion=motion_of_reactions(reactions), friction=rubs)
    values_of = {one.key: one.values for one in reaction_series(mechanism, there, reactions)}
    for top, cut, where in zip(tops, cuts, back.reshape(len(tops), -1), strict=True):
        values = values_of[curves[top.curve].key][where]
        size = top.sign * _size(values)
        size = np.where(np.isfinite(size), size, -np.inf)
        k = int(np.argmax(size))
        # the sample itself is among the cuts, but for rounding: what is known does not get worse
        if size[k] >= top.sign * top.value:
            top.place, top.value, top.vector = float(cut[k]), top.sign * float(size[k]), values[k]
        top.low, top.high = float(cut[max(k - 1, 0)]), float(cut[min(k + 1, PARTS)])


def _best(tops: list[_Top]) -> _Top:
    return max(tops, key=lambda top: top.sign * top.value)


def mean_over_time(time: Array, size: Array) -> tuple[float, float]:
    """Mean and root mean square of values (n) over the stretches between samples that are known."""
    # a drive that runs backwards through its values has falling times
    order = np.argsort(time, kind="stable")
    time, size = time[order], size[order]
    step = np.diff(time)
    known = np.isfinite(size[:-1]) & np.isfinite(size[1:]) & (step > 0.0)
    if not known.any():
        value = float(size[np.isfinite(size)][0])
        return value, abs(value)
    whole = float(step[known].sum())
    first, second = size[:-1][known], size[1:][known]
    mean = float((step[known] * (first + second)).sum()) / (2.0 * whole)
    square = float((step[known] * (first**2 + second**2)).sum()) / (2.0 * whole)
    return mean, float(np.sqrt(square))
