"""An atlas of coupler curves: shapes by which a target curve finds linkages that draw something like it.

A closed curve, run through at constant speed, is a sum of rotating vectors c_k exp(i k t). Where it starts only turns
the phases of c_k, a turn of the curve turns all of them, its size scales them and its place is c_0. So the magnitudes
|c_k| of k other than 0, divided by their root sum of squares, describe the shape alone; a mirrored curve and one that
is run through backwards have them in the opposite order of k (C. T. Zahn, R. Z. Roskies, IEEE Trans. Computers C-21,
1972, 269-281; J. R. McGarva, G. Mullineux, Mech. Mach. Theory 28, 1993).
"""

from __future__ import annotations

import functools
from dataclasses import dataclass

import numpy as np

from centrode.synthesis.four_bars import Array, Complex, coupler_motion

PLACES = 64
"""Places of a curve at equal distances along it."""
HARMONICS = 8
DENSE = 144
"""Crank angles of a curve before it is run through at constant speed."""
SEED = 31
_ORDERS = [k for k in range(-HARMONICS, HARMONICS + 1) if k]


@dataclass(frozen=True, eq=False)
class Atlas:
    """Curves of many linkages with the crank 1, O in the origin and D on the x axis.

    Attributes
    ----------
    linkages : (n, 9), B to the left of the line AD
    curves : (n, PLACES) at equal distances along them, float complex
    crank : (n, PLACES) angles of the crank there [rad]
    descriptors : (n, 2 HARMONICS)
    dense : (n, DENSE) the same curves at equal steps of the crank
    """

    linkages: Array
    curves: Complex
    crank: Array
    descriptors: Array
    dense: Complex


def at_equal_distances(curves: Complex, count: int, closed: bool) -> tuple[Complex, Array]:
    """Places at equal distances along polygons, and where they lie in units of the polygons' points.

    Parameters
    ----------
    curves : (lanes, n)

    Returns
    -------
    places : (lanes, count), of a closed curve without its end
    where : (lanes, count), from 0 to n (closed) or n - 1
    """
    if closed:
        curves = np.concatenate([curves, curves[:, :1]], axis=1)
    lanes, points = curves.shape
    way = np.concatenate([np.zeros((lanes, 1)), np.cumsum(np.abs(np.diff(curves, axis=1)), axis=1)], axis=1)
    shares: Array = way / np.maximum(way[:, -1:], 1e-300)
    share = np.linspace(0.0, 1.0, count, endpoint=not closed)
    # One interpolation for all lanes: each has an interval of length two of its own.
    offset = 2.0 * np.arange(lanes)[:, None]
    where = np.interp((share + offset).ravel(), (shares + offset).ravel(), np.tile(np.arange(points), lanes))
    where = np.reshape(where, (lanes, count))
    low = np.minimum(where.astype(np.int64), points - 2)
    row = np.arange(lanes)[:, None]
    part = where - low
    return curves[row, low] * (1 - part) + curves[row, low + 1] * part, where


def descriptors(curves: Complex) -> Array:
    """Magnitudes of the Fourier coefficients of closed curves, of unit sum of squares (lanes, 2 HARMONICS)."""
    magnitudes = np.abs(np.fft.fft(curves, axis=-1)[..., _ORDERS])
    total: Array = np.sqrt((magnitudes**2).sum(axis=-1, keepdims=True))
    return magnitudes / np.maximum(total, 1e-300)


@functools.lru_cache(maxsize=2)
def atlas(count: int = 24_000) -> Atlas:
    """The atlas of that many linkages whose crank turns fully; the same one every time."""
    random = np.random.default_rng(SEED)
    linkages = np.concatenate([_crank_rockers(random, count * 4 // 5), _drag_links(random, count // 5)])
    crank = np.linspace(0.0, 2 * np.pi, DENSE, endpoint=False)
    dense = np.empty((len(linkages), DENSE), dtype=np.complex128)
    for begin in range(0, len(linkages), 2000):
        part = slice(begin, begin + 2000)
        dense[part] = coupler_motion(linkages[part], crank, np.ones(len(linkages[part]))).point
    curves, where = at_equal_distances(dense, PLACES, closed=True)
    return Atlas(linkages, curves, where * (2 * np.pi / DENSE), descriptors(curves), dense)


def _crank_rockers(random: np.random.Generator, count: int) -> Array:
    """Random linkages whose shortest link is the crank of length 1.

    With g + b - c - 1, g + c - b - 1 and b + c - g - 1 any positive numbers, Grashof's rule holds.
    """
    excess: Array = np.exp(random.uniform(np.log(0.02), np.log(5.0), (count, 3)))
    ground, coupler, rocker = (1.0 + excess.sum(axis=1) - excess[:, k] for k in range(3))
    return _with_points(random, ground, np.ones(count), coupler, rocker, 6.0)


def _drag_links(random: np.random.Generator, count: int) -> Array:
    """Random linkages whose shortest link is the frame."""
    excess: Array = np.exp(random.uniform(np.log(0.02), np.log(5.0), (count, 3)))
    crank, coupler, rocker = (1.0 + excess.sum(axis=1) - excess[:, k] for k in range(3))
    return _with_points(random, 1 / crank, np.ones(count), coupler / crank, rocker / crank, 4.0)


def _with_points(
    random: np.random.Generator, ground: Array, crank: Array, coupler: Array, rocker: Array, reach: float
) -> Array:
    count = len(ground)
    radius = reach * np.sqrt(random.uniform(0.0, 1.0, count))
    angle = random.uniform(0.0, 2 * np.pi, count)
    zero = np.zeros(count)
    return np.column_stack(
        [zero, zero, ground, zero, crank, coupler, rocker, radius * np.cos(angle), radius * np.sin(angle)]
    )
