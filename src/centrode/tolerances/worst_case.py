"""Worst cases: between which values an output lies if every number stays within its limits.

To first order an output deviates by the sum of g dp: at most where every number lies at the limit that its derivative g
points to. Truly it does so at a corner of the limits, if it grows or falls with each number all along; the corners are
computed, all of them or those that the derivatives point to, and the worst one is improved as long as its own
derivatives point inwards.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt
from scipy.optimize import minimize

from centrode.tolerances.deviated_mechanisms import DeviatedMechanisms, Evaluated

Array: TypeAlias = npt.NDArray[np.float64]

ALL_CORNERS = 12
"""Numbers up to which all corners are computed: 4096 of them."""
DRAWN_CORNERS = 1024
"""Corners that are drawn besides those of the derivatives where there are more."""


@dataclass(frozen=True)
class Extent:
    """How far an output deviates from its nominal value.

    Attributes
    ----------
    lower, upper : deviations [SI], one number or (samples,)
    """

    lower: Array
    upper: Array


def linear_extent(gradient: Array, lower: Array, upper: Array) -> Extent:
    """Greatest deviations to first order.

    Parameters
    ----------
    gradient : (..., paths)
    lower, upper : (paths,) deviations of the numbers
    """
    low, high = gradient * lower, gradient * upper
    return Extent(np.minimum(low, high).sum(axis=-1), np.maximum(low, high).sum(axis=-1))


@dataclass(frozen=True)
class Corner:
    """A mechanism at an extreme of an output.

    Attributes
    ----------
    value : of the output [SI]
    deviations : of its numbers [SI]
    """

    value: float
    deviations: Array


@dataclass(frozen=True)
class TrueExtent:
    """Extremes of an output among the mechanisms of the limits.

    Attributes
    ----------
    lower, upper : deviations from the nominal value [SI], one number or (samples,)
    least, greatest : the mechanisms there; of an output of samples those at the sample with the greatest deviation
    """

    lower: Array
    upper: Array
    least: Corner
    greatest: Corner


def corners_of(mechanisms: DeviatedMechanisms, seed: int = 0) -> Array:
    """Deviations at corners of the limits, (corners, paths): all, or those of the derivatives and some drawn."""
    limits = mechanisms.limits
    count = len(limits.paths)
    if count <= ALL_CORNERS:
        signs = np.array(list(itertools.product((False, True), repeat=count)))
    else:
        rows = [gradient.reshape(-1, count) > 0.0 for gradient in mechanisms.gradients.values()]
        drawn = np.random.default_rng(seed).random((DRAWN_CORNERS, count)) < 0.5
        both = np.concatenate([*rows, *(~row for row in rows), drawn])
        signs = np.unique(both, axis=0)
    return np.where(signs, limits.upper, limits.lower)


def true_extents(
    mechanisms: DeviatedMechanisms, corners: Array, computed: Evaluated
) -> dict[str, TrueExtent]:
    """Extremes of each output at corners, improved; NaN where no mechanism of the corners has a value."""
    found = {}
    for name, values in computed.outputs.items():
        nominal = mechanisms.nominal[name]
        usable = np.where(computed.moves.reshape(-1, *[1] * (values.ndim - 1)), values, np.nan)
        if mechanisms.of_samples[name]:
            found[name] = _of_samples(usable, nominal, corners)
            continue
        least, greatest = (
            _improved_corner(mechanisms, name, corners, sense * usable, sense) for sense in (-1, 1)
        )
        found[name] = TrueExtent(
            np.asarray(least.value - nominal), np.asarray(greatest.value - nominal), least, greatest
        )
    return found


def _of_samples(values: Array, nominal: Array, corners: Array) -> TrueExtent:
    with np.errstate(invalid="ignore"):
        low = np.where(np.isnan(values), np.inf, values)
        high = np.where(np.isnan(values), -np.inf, values)
        lower, upper = low.min(axis=0) - nominal, high.max(axis=0) - nominal
    lower, upper = (np.where(np.isfinite(x), x, np.nan) for x in (lower, upper))
    ends = []
    for deviation, rows, sense in ((lower, low, 1), (upper, high, -1)):
        if not np.isfinite(deviation).any():
            ends.append(Corner(float("nan"), np.full(corners.shape[1], np.nan)))
            continue
        sample = int(np.nanargmax(np.abs(deviation)))
        corner = int(np.argmin(sense * rows[:, sample]))
        ends.append(Corner(float(rows[corner, sample]), corners[corner]))
    return TrueExtent(lower, upper, *ends)


def _improved_corner(
    mechanisms: DeviatedMechanisms, name: str, corners: Array, value: Array, sense: int
) -> Corner:
    """The corner with the greatest sense * output, moved on where derivatives there point inwards."""
    if not np.isfinite(value).any():
        return Corner(float("nan"), np.full(corners.shape[1], np.nan))
    limits = mechanisms.limits
    place = int(np.nanargmax(value))
    deviations, best = corners[place], float(value[place])
    gradient = sense * mechanisms.gradients_of(limits.values + deviations)[name]
    outwards = np.where(gradient > 0.0, limits.upper, limits.lower)
    if not np.isfinite(gradient).all() or np.array_equal(
        outwards[gradient != 0.0], deviations[gradient != 0.0]
    ):
        return Corner(sense * best, deviations)
    # numbers in shares of their limits: lengths and angles have the same size then
    middles, halves = limits.middles, limits.halves

    def loss(shares: Array) -> tuple[float, Array]:
        values = limits.values + middles + halves * shares
        output = sense * float(mechanisms.outputs_of(values)[name])
        slope = sense * mechanisms.gradients_of(values)[name] * halves
        if not np.isfinite(output) or not np.isfinite(slope).all():
            return np.inf, np.zeros_like(shares)
        return -output / unit, -slope / unit

    unit = float(np.abs(gradient * halves).sum()) or 1.0
    start = (deviations - middles) / halves
    found = minimize(loss, start, jac=True, method="L-BFGS-B", bounds=[(-1.0, 1.0)] * len(start))
    if -float(found.fun) * unit > best:
        return Corner(-sense * float(found.fun) * unit, middles + halves * found.x)
    return Corner(sense * best, deviations)
