"""Where cam and follower touch, which way they push each other, and the torque that this takes.

Everything stands in the follower's frame, the cam's axis at the origin. A translating follower moves along y at
x = offset; an oscillating one has its pivot at (distance, 0) and its arm above, so that it lifts clockwise. The cam
turns counter-clockwise (sense +1) or clockwise (-1). Directions follow from the instant centre, which lies on the
normal: nothing is taken from the profile.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Meeting:
    """Cam and follower at angles of the cam.

    Attributes
    ----------
    place : (n, 2) [m]
        Where the force acts: the contact, of a roller its centre.
    normal : (n, 2)
        From the cam to the follower.
    slip : (n, 2)
        Direction in which the cam's surface slides on the follower; zero under a roller.
    lever : (n, 2)
        What a force of one along x or y does along the follower's motion [1, or m].
    sense : +1.0 or -1.0
        Of the cam's turning, counter-clockwise positive.
    """

    place: Array
    normal: Array
    slip: Array
    lever: Array
    sense: float

    def directions(self, flank: Array, friction: float = 0.0) -> Array:
        """The force on the follower by a normal force of one (n, 2), with friction by a coefficient.

        `flank` (n) has the sign of the normal force. On the other flank of a groove it is negative, but the cam's
        surface drags the follower the same way: friction turns round in relation to it.
        """
        return self.normal + friction * np.where(flank < 0, -1.0, 1.0)[:, None] * self.slip

    def share(self, flank: Array, friction: float = 0.0) -> Array:
        """What a normal force of one does along the motion [1, or m]; zero or less where friction holds it fast."""
        return np.asarray(np.sum(self.lever * self.directions(flank, friction), axis=1))

    def normal_force(self, push: Array, friction: float = 0.0) -> Array:
        """Normal force [N] that gives a push [N, or N m] along the motion.

        Infinite with the push's sign where friction lets no force along the normal move the follower.
        """
        with np.errstate(divide="ignore", invalid="ignore"):
            share = self.share(push, friction)
            return np.asarray(np.where(share > 0, push / share, np.copysign(np.inf, push)))

    def torque(self, force: Array, friction: float = 0.0) -> Array:
        """Torque [N m] that drives the cam against a normal force [N], positive along its turning."""
        along = self.directions(force, friction)
        moment = self.place[:, 0] * along[:, 1] - self.place[:, 1] * along[:, 0]
        return np.asarray(self.sense * force * moment)


def on_centre(rows: Array, offset: float, rise: float, sense: float, rolling: bool) -> Meeting:
    """A translating follower whose roller's centre, or edge, is led through (offset, rise) at lift zero [m]."""
    height = rise + rows[0]
    place = np.stack([np.full_like(height, offset), height], axis=1)
    normal = _unit(np.stack([offset - sense * rows[1], height], axis=1))
    slip = np.zeros_like(normal) if rolling else sense * _left(normal)
    return Meeting(place, normal, slip, _along_y(height), sense)


def on_face(rows: Array, base: float, sense: float) -> Meeting:
    """A translating follower with a flat face square to its motion, over a base circle [m]."""
    height = base + rows[0]
    place = np.stack([sense * rows[1], height], axis=1)
    normal = _along_y(height)
    return Meeting(place, normal, sense * _left(normal), normal, sense)


def on_arm(rows: Array, arm: float, distance: float, start: float, sense: float, rolling: bool) -> Meeting:
    """An oscillating follower with a roller's centre, or an edge, at the end of its arm.

    Parameters
    ----------
    rows : (2 or more, n) [rad]
    arm, distance : float [m]
        Length of the arm, distance of the pivot from the cam's axis.
    start : float [rad]
        Angle between the arm and the line to the cam's axis at lift zero.
    sense : +1.0 or -1.0
    rolling : bool
        Whether a roller touches the cam.
    """
    angle = math.pi - (start + rows[0])
    reach = arm * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    place = reach + np.array([distance, 0.0])
    ray = _unit(_from_pole(place, rows, distance, sense))
    slip = np.zeros_like(ray) if rolling else sense * _left(ray)
    return Meeting(place, _turned_out(ray, reach), slip, _turning(reach), sense)


def on_turning_face(rows: Array, distance: float, start: float, shift: float, sense: float) -> Meeting:
    """An oscillating follower with a flat face.

    Parameters
    ----------
    rows : (2 or more, n) [rad]
    distance : float [m]
        Of the pivot from the cam's axis.
    start : float [rad]
        Angle between the face and the line to the cam's axis at lift zero.
    shift : float [m]
        Of the face from the pivot, positive towards the cam.
    sense : +1.0 or -1.0
    """
    angle = math.pi - (start + rows[0])
    along = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    normal = -_left(along)
    foot = np.array([distance, 0.0]) - shift * normal
    turn = sense * rows[1]
    pole = np.stack([distance * turn / (1 + turn), np.zeros_like(turn)], axis=1)
    place = foot + along * np.sum((pole - foot) * along, axis=1, keepdims=True)
    above = np.sign(np.sum(normal * _from_pole(place, rows, distance, sense), axis=1, keepdims=True))
    reach = place - np.array([distance, 0.0])
    return Meeting(place, normal, sense * above * _left(normal), _turning(reach), sense)


def _from_pole(place: Array, rows: Array, distance: float, sense: float) -> Array:
    """From the instant centre to a place, by a factor that keeps it finite where the centre is far away.

    The centre lies on the line of the axes, where cam and follower have one velocity.
    """
    turn = sense * rows[1]
    return np.stack([place[:, 0] * (1 + turn) - distance * turn, place[:, 1] * (1 + turn)], axis=1)


def _turned_out(normal: Array, reach: Array) -> Array:
    """The normal in the sense that lifts the follower."""
    lifts = np.sum(normal * _turning(reach), axis=1, keepdims=True)
    return np.where(lifts < 0, -normal, normal)


def _turning(reach: Array) -> Array:
    """What forces of one along x and y do clockwise about the pivot, at a reach from it."""
    return np.stack([reach[:, 1], -reach[:, 0]], axis=1)


def _along_y(height: Array) -> Array:
    return np.stack([np.zeros_like(height), np.ones_like(height)], axis=1)


def _left(vectors: Array) -> Array:
    """Vectors turned by a quarter counter-clockwise: the way the surface of a cam that turns so slides."""
    return np.stack([-vectors[:, 1], vectors[:, 0]], axis=1)


def _unit(vectors: Array) -> Array:
    return np.asarray(vectors / np.linalg.norm(vectors, axis=1, keepdims=True))
