"""Statistical tolerances: the root of the sum of squares, contributions, and mechanisms that are drawn.

To first order the variance of an output is g' C g, with C the covariance of the numbers; without correlation that is
the sum of the squares of g times the standard deviation of each number.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt
from scipy.optimize import brentq
from scipy.special import betaincinv, ndtr

from centrode.errors import InputError
from centrode.locale import _
from centrode.tolerances.deviated_mechanisms import DeviatedMechanisms, Evaluated
from centrode.tolerances.dimension_limits import DimensionLimits

Array: TypeAlias = npt.NDArray[np.float64]

SIGMAS_SHOWN = 3.0
"""Half of the statistical width, in standard deviations of the output."""
CONFIDENCE = 0.95
QUANTILES = (0.00135, 0.5, 0.99865)
"""Of drawn outputs: those of a normal distribution lie three standard deviations from its mean."""


@dataclass(frozen=True)
class Propagated:
    """Mean and standard deviation of an output to first order.

    Attributes
    ----------
    shift : mean less the nominal value [SI], one number or (samples,)
    deviation : standard deviation [SI]
    contributions : (..., paths) share of each number in the variance, with its part of the products of correlated ones
    """

    shift: Array
    deviation: Array
    contributions: Array

    @property
    def half(self) -> Array:
        """Three standard deviations [SI]."""
        return np.asarray(SIGMAS_SHOWN * self.deviation)


def propagated_output(gradient: Array, limits: DimensionLimits) -> Propagated:
    """Mean and standard deviation of an output by its derivatives (..., paths)."""
    # in units of the standard deviations no derivative by a length meets one by an angle
    scaled = gradient * limits.deviations
    products = scaled * (scaled @ limits.correlation)
    variance = products.sum(axis=-1)
    with np.errstate(invalid="ignore", divide="ignore"):
        shares = np.where(variance[..., None] > 0.0, products / variance[..., None], 0.0)
    return Propagated(
        np.asarray(gradient @ limits.middles), np.sqrt(np.maximum(variance, 0.0)), np.asarray(shares)
    )


def draw_deviations(limits: DimensionLimits, count: int, seed: int) -> Array:
    """Deviations [SI] of drawn mechanisms, (mechanisms, paths); the same for the same seed.

    Correlated numbers come from correlated normal ones (Nataf's transformation), whose coefficients are chosen so that
    the numbers themselves have the coefficients of the description.
    """
    random = np.random.default_rng(seed)
    normal = random.standard_normal((count, len(limits.paths)))
    if limits.correlations:
        values, vectors = np.linalg.eigh(_correlation_of_normals(limits))
        if values[0] < -1e-9:
            raise InputError(
                "[tolerances] correlations",
                _("this distribution cannot have such coefficients together"),
                _("bring the coefficients nearer to zero"),
            )
        normal = normal @ (vectors * np.sqrt(np.maximum(values, 0.0))).T
    if limits.distribution == "normal":
        shares = normal
        shares *= 1.0 / SIGMAS_SHOWN
    else:
        shares = _shares(limits.distribution, ndtr(normal))
    shares *= limits.halves
    shares += limits.middles
    return shares


def _shares(distribution: str, probability: Array) -> Array:
    """Numbers between -1 and 1 from what they exceed with a probability."""
    if distribution == "uniform":
        return np.asarray(2.0 * probability - 1.0)
    tail = np.minimum(probability, 1.0 - probability)
    size = 1.0 - np.sqrt(2.0 * tail)
    return np.asarray(np.where(probability < 0.5, -size, size))


def _correlation_of_normals(limits: DimensionLimits) -> Array:
    """Coefficients of normal numbers from which the numbers follow with their own ones."""
    own = limits.correlation
    if limits.distribution == "normal":
        return own
    if limits.distribution == "uniform":
        # Pearson 1907: rho = 6/pi asin(r/2)
        return np.asarray(np.where(np.eye(len(own)) > 0.0, 1.0, 2.0 * np.sin(math.pi * own / 6.0)))
    known = {value: _normal_coefficient(value) for value in np.unique(own)}
    return np.array([[known[value] for value in row] for row in own])


_NODES, _WEIGHTS = np.polynomial.hermite_e.hermegauss(200)


def _normal_coefficient(wanted: float) -> float:
    """The coefficient of two normal numbers whose triangular ones have the coefficient that is wanted."""
    if abs(wanted) in (0.0, 1.0):
        return float(wanted)
    weights = _WEIGHTS / _WEIGHTS.sum()

    def excess(r: float) -> float:
        other = r * _NODES[:, None] + math.sqrt(1.0 - r * r) * _NODES[None, :]
        one, two = (_shares("triangular", ndtr(x)) for x in (_NODES[:, None], other))
        return float((weights[:, None] * weights[None, :] * one * two).sum() * 6.0 - wanted)

    return float(brentq(excess, -1.0, 1.0, xtol=1e-12))


@dataclass(frozen=True)
class Yield:
    """Share of drawn mechanisms that keep the bounds of an output.

    Attributes
    ----------
    share : of all drawn ones; those that do not move count as spoilt
    low, high : between which the share of all mechanisms lies with 95 % confidence (Clopper and Pearson 1934)
    """

    share: float
    low: float
    high: float


def yield_of(kept: int, drawn: int) -> Yield:
    """Share with its interval of confidence."""
    tail = 0.5 * (1.0 - CONFIDENCE)
    low = float(betaincinv(kept, drawn - kept + 1, tail)) if kept else 0.0
    high = float(betaincinv(kept + 1, drawn - kept, 1.0 - tail)) if kept < drawn else 1.0
    return Yield(kept / drawn, low, high)


@dataclass(frozen=True)
class DrawnOutput:
    """What drawn mechanisms give of an output.

    Attributes
    ----------
    count : mechanisms that move
    mean, deviation : of the output [SI], one number or (samples,)
    quantiles : (3, ...) that of 0.135 %, the median, that of 99.865 %
    least, greatest : of all
    bins, counts : histogram of an output that is one number; empty of others
    kept : yield against the bounds; None without bounds
    """

    count: int
    mean: Array
    deviation: Array
    quantiles: Array
    least: Array
    greatest: Array
    bins: Array
    counts: npt.NDArray[np.int64]
    kept: Yield | None


BINS = 41


def drawn_outputs(
    mechanisms: DeviatedMechanisms,
    computed: Evaluated,
    bounds: Mapping[str, tuple[Array, Array] | None],
) -> dict[str, DrawnOutput]:
    """Statistics of each output of drawn mechanisms."""
    found = {}
    everything = bool(computed.moves.all())
    for name, values in computed.outputs.items():
        moving = values if everything else values[computed.moves]
        if not len(moving):
            continue
        within = bounds.get(name)
        kept = None
        if within is not None:
            inside = np.asarray((moving >= within[0]) & (moving <= within[1]))
            if inside.ndim > 1:
                inside = np.asarray(inside.all(axis=1))
            kept = yield_of(int(np.count_nonzero(inside)), len(values))
        whole = not mechanisms.of_samples[name]
        counts, bins = np.histogram(moving, BINS) if whole else (np.array([], dtype=np.int64), np.array([]))
        found[name] = DrawnOutput(
            len(moving),
            np.asarray(moving.mean(axis=0)),
            np.asarray(moving.std(axis=0, ddof=1)) if len(moving) > 1 else np.zeros(moving.shape[1:]),
            np.asarray(np.quantile(moving, QUANTILES, axis=0)),
            np.asarray(moving.min(axis=0)),
            np.asarray(moving.max(axis=0)),
            bins,
            counts,
            kept,
        )
    return found
