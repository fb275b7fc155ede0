"""From the description of a cam with a follower to its geometry."""

from __future__ import annotations

import math

from centrode.cams.followers.bodies import FollowerCam
from centrode.cams.followers.contact import Face, Point
from centrode.cams.followers.guidance import (
    Guidance,
    Translating,
    oscillating,
    oscillating_face,
    translating,
)
from centrode.cams.followers.motion import follower_motion
from centrode.errors import InputError
from centrode.locale import _
from centrode.model.cams.files import AnyCam, with_follower
from centrode.model.cams.plate import PlateCam


def follower_cam(cam: AnyCam) -> FollowerCam:
    """The cam and the follower of a description.

    Parameters
    ----------
    cam : PlateCam

    Raises
    ------
    InputError
        A cam by a curvature law, no base radius, a follower that does not reach the base circle.
    """
    plate = with_follower(cam)
    base = plate.body.base_radius
    if base is None:
        what = _("the profile needs the base radius")
        raise InputError("[cam] base_radius", what, _("give it"))
    touch = Face() if plate.follower.contact == "flat" else Point(plate.follower.roller_radius or 0.0)
    sense = 1.0 if plate.body.turn == "counter-clockwise" else -1.0
    return FollowerCam(follower_motion(plate), _guidance(plate, base), touch, base, sense)


def _guidance(plate: PlateCam, base: float) -> Guidance:
    """How the follower is led, so that it starts on the base circle."""
    follower = plate.follower
    flat = follower.contact == "flat"
    path = base + (follower.roller_radius or 0.0)
    if not plate.swings:
        return Translating(base, follower.offset) if flat else translating(path, follower.offset)
    distance = follower.pivot_distance or math.nan
    if flat:
        return oscillating_face(base, distance, follower.face_offset)
    return oscillating(path, follower.arm or math.nan, distance)
