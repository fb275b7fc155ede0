"""The inverted motion of a follower about its cam at rest: numbered positions, directions, velocity coefficients.

The velocity coefficient of the roller's centre, turned by a right angle in the sense of the cam and laid off from
that centre, ends at a place E; from the cam's centre E is seen along the normal of the contact. So the pressure angle
is that between this line and the follower's motion, whatever the radius of the cam.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from centrode.cams.followers.geometry import Array, FollowerCam, Oscillating

if TYPE_CHECKING:
    from centrode.model.follower_cam import PlateCam

MOST_SEGMENTS = 36
"""Segments of a turn from which on positions are evenly spaced over it."""


def numbered_angles(cam: PlateCam, count: int) -> tuple[float, ...]:
    """Angles of the cam [rad] of numbered positions: where segments begin, and equal parts of those that move.

    About `count` parts are dealt to the segments that move by their angles, at least one each; the turn's end is left
    out. Of very many segments the turn has `count` equal parts.
    """
    if len(cam.segments) > MOST_SEGMENTS:
        return tuple((math.tau * np.arange(count) / count).tolist())
    moving = math.fsum(segment.angle for segment in cam.segments if segment.to is not None)
    angles, start = list[float](), 0.0
    for segment in cam.segments:
        parts = 1 if segment.to is None else max(1, round(count * segment.angle / moving))
        angles += [start + segment.angle * part / parts for part in range(parts)]
        start += segment.angle
    return tuple(angles)


def in_cam(body: FollowerCam, vectors: Array, phi: Array) -> Array:
    """Places or directions (n, 2) of the axes of the frame in the cam's axes, the cam turned by phi (n)."""
    return body.in_frame(vectors, -np.asarray(phi))


def centres_in_frame(body: FollowerCam, phi: Array) -> Array:
    """The roller's centre (of an edge itself, of a flat face its foot on the follower's axis) (n, 2) [m]."""
    return _pairs(body.guide.centre(np, body.motion.lift(phi)[0]))


def directions_in_frame(body: FollowerCam, phi: Array) -> Array:
    """Unit vectors (n, 2) in which the roller's centre moves where the lift grows."""
    return _pairs(body.guide.direction(np, body.motion.lift(phi)[0]))


def velocity_ends(body: FollowerCam, phi: Array) -> Array:
    """Ends (n, 2) [m] of the turned velocity coefficients of the roller's centre, in the axes of the frame."""
    arm = body.guide.arm if isinstance(body.guide, Oscillating) else 1.0
    rate = arm * body.motion.lift(phi, 1)[1]
    x, y = (rate[:, None] * directions_in_frame(body, phi)).T
    return np.asarray(centres_in_frame(body, phi) + body.sense * np.stack([-y, x], axis=1))


def _pairs(vector: tuple[Array, Array]) -> Array:
    return np.stack([np.asarray(one, dtype=np.float64) for one in vector], axis=-1)
