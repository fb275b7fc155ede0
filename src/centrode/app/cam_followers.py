"""The follower of a plate cam for its picture: where it stands at each angle of the cam, in the axes of the frame."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from centrode.cams.followers.base_circle import follower_cam
from centrode.cams.followers.geometry import Oscillating
from centrode.errors import CentrodeError
from centrode.model.follower_cam import PlateCam
from centrode.scenes.driving_cams import DrivingCam

DIGITS = 6
"""Significant digits of a place in the picture."""


def follower_scene(cam: PlateCam, angles: npt.NDArray[np.float64]) -> dict[str, Any] | None:
    """The follower at angles (n) [rad] of the cam; None where this cannot lead it.

    `places` are centres of the roller, the edge, or the foot of a stem on its face, (n, 2) [m]; `faces` the ends of
    the straight parts of a flat-faced follower, (n, 4) or (n, 8) [m]; `sense` is 1 where the cam turns
    counter-clockwise, else -1; `pivot` that of an oscillating follower [m].
    """
    try:
        body = follower_cam(cam)
        drawing = DrivingCam.alone(body, angles, 1.0)
        lift = body.motion.lift(np.mod(angles, math.tau))[0]
    except CentrodeError:
        return None
    oscillating = isinstance(body.guide, Oscillating)
    flat = math.isinf(body.touch.roller)
    places = None
    if not (flat and oscillating):
        places = np.stack(np.broadcast_arrays(*body.guide.centre(np, lift)), axis=-1)
    faces = None
    if flat:
        lines = [np.ravel(drawing.lines(sample)) for sample in range(len(angles))]
        faces = [_rounded_numbers(line) for line in lines]
    return {
        "sense": 1 if body.sense > 0.0 else -1,
        "contact": cam.follower.contact,
        "places": None if places is None else [_rounded_numbers(place) for place in places],
        "faces": faces,
        "pivot": None if drawing.pivot is None else _rounded_numbers(drawing.pivot),
    }


def _rounded_numbers(numbers: npt.NDArray[np.float64]) -> list[float | None]:
    return [float(f"{x:.{DIGITS}g}") if math.isfinite(x) else None for x in numbers]
