"""Instantaneous axes of bodies that turn about the centre of a sphere, and how they are located.

Where the axis of a relative rotation meets the sphere, two opposite places stand still: they are the instant centres
of the sphere. The one about which the body turns counter-clockwise, seen from outside, is given.
"""

from __future__ import annotations

import numpy as np

from centrode.analysis.instant_centres.bodies import ROUNDED, Array, Pair
from centrode.analysis.instant_centres.cases import Case, Kinds, Mask
from centrode.analysis.instant_centres.primary import joints_of, ordered, rolling_pairs
from centrode.analysis.instant_centres.turning_bodies import TurningBodies


def axis_of(bodies: TurningBodies, pair: Pair) -> Array:
    """End of the axis of a pair (..., samples, 3), a unit vector; NaN where nothing turns."""
    spin = bodies.relative(pair)
    size = np.linalg.norm(spin, axis=-1)
    return np.asarray(spin / np.where(at_rest(bodies, pair), np.nan, size)[..., None])


def axis_speed(bodies: TurningBodies, pair: Pair, axis: Array) -> Array:
    """Relative angular velocity [rad/s] about the end of the axis that is given; zero where nothing turns."""
    speed = bodies.speed[..., pair[0], :] - bodies.speed[..., pair[1], :]
    found = np.sum(speed * axis, axis=-1)
    return np.asarray(np.where(at_rest(bodies, pair), np.linalg.norm(speed, axis=-1), found))


def at_rest(bodies: TurningBodies, pair: Pair) -> Mask:
    """Whether two bodies do not move against each other, but for rounding."""
    size = np.linalg.norm(bodies.relative(pair), axis=-1)
    return np.asarray(size <= ROUNDED * bodies.rate)


def axis_cases(bodies: TurningBodies, pair: Pair) -> Kinds:
    """Case of a pair at every sample: the velocities of two places of the first body, seen from the second."""
    spin = bodies.relative(pair)
    slow = ROUNDED * bodies.rate
    one, other = (np.cross(spin, place) for place in bodies.two_places(pair[0]))
    sizes = [np.linalg.norm(velocity, axis=-1) for velocity in (one, other)]
    product = np.sum(one * other, axis=-1)
    # both square to one great circle: the axis lies on it, beyond or between the places
    parallel = np.linalg.norm(np.cross(one, other), axis=-1) <= ROUNDED * sizes[0] * sizes[1]
    found = np.full(slow.shape, Case.DIRECTIONS, dtype=np.int8)
    found[parallel & (product > 0.0)] = Case.SAME_SENSE
    found[parallel & (product <= 0.0)] = Case.OPPOSITE_SENSE
    found[(sizes[0] <= slow) | (sizes[1] <= slow)] = Case.STANDSTILL
    mechanism = bodies.mechanism
    if ordered(pair) in set(rolling_pairs(mechanism, bodies)):
        found[:] = Case.ROLLING
    if ordered(pair) in {
        joint.pair for joint in joints_of(mechanism, bodies)
    }:  # a guide's pole is a hinge too
        found[:] = Case.HINGE
    found[at_rest(bodies, pair)] = Case.REST
    found[~np.isfinite(spin).all(axis=-1)] = Case.ABSENT
    return found
