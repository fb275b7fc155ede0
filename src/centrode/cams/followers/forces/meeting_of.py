"""How the follower of a cam's body meets it."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from centrode.cams.followers.bodies import FollowerCam
from centrode.cams.followers.forces import meeting
from centrode.cams.followers.forces.meeting import Meeting
from centrode.cams.followers.guidance import Oscillating

Array = NDArray[np.float64]


def meeting_of(body: FollowerCam, rows: Array) -> Meeting:
    """Where the cam touches the follower and which way they push, for a lift with its slope (2 or more, n)."""
    guide, roller, sense = body.guide, body.touch.roller, body.sense
    flat, rolling = math.isinf(roller), roller > 0.0
    if isinstance(guide, Oscillating):
        if flat:
            return meeting.on_turning_face(rows, guide.distance, guide.start, guide.face_offset, sense)
        return meeting.on_arm(rows, guide.arm, guide.distance, guide.start, sense, rolling)
    if flat:
        return meeting.on_face(rows, guide.start, sense)
    return meeting.on_centre(rows, guide.offset, guide.start, sense, rolling)
