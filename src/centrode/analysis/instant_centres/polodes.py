"""Polodes on the sphere: what the end of the instantaneous axis describes in the axes of either body.

Both bodies see the axis move alike: with W the relative angular velocity, its derivatives in the axes of the one and of
the other differ by (w1 - w2) x W = 0. So the cones that the polodes belong to roll on each other without slip.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from centrode.analysis.instant_centres.axes import axis_of
from centrode.analysis.instant_centres.bodies import Array, Pair
from centrode.analysis.instant_centres.turning_bodies import TurningBodies


@dataclass(frozen=True)
class Polodes:
    """Two curves that roll on each other, in the plane or on the sphere.

    Attributes
    ----------
    fixed, moving : (..., samples, axis) places in the axes of the one and of the other body; NaN where none is
    rates : their derivatives by the drive's value (with several drives by time)
    sense : (..., samples, k) vectors, or signs, that point against each other where the relative rotation turns back
    """

    fixed: Array
    moving: Array
    rates: tuple[Array, Array]
    sense: Array


def polodes_of(bodies: TurningBodies, pair: Pair) -> Polodes:
    """Polodes of the first body of a pair against the second, over a motion."""
    first, second = pair
    axis, spin = axis_of(bodies, pair), bodies.relative(pair)
    growing = bodies.spin_rate[..., first, :] - bodies.spin_rate[..., second, :]
    growing = growing - np.cross(bodies.spin[..., second, :], spin)  # as both bodies see it
    size = np.where(np.isfinite(axis[..., :1]), np.linalg.norm(spin, axis=-1, keepdims=True), np.nan)
    rate = (growing - axis * np.sum(axis * growing, axis=-1, keepdims=True)) / size
    fixed, moving = (_inside(bodies.axes[..., body, :, :], axis) for body in (second, first))
    rates = _inside(bodies.axes[..., second, :, :], rate), _inside(bodies.axes[..., first, :, :], rate)
    return Polodes(fixed, moving, rates, fixed)


def _inside(axes: Array, vector: Array) -> Array:
    """Vectors of the frame in the axes of a body."""
    return np.asarray(np.einsum("...ij,...i->...j", axes, vector))
