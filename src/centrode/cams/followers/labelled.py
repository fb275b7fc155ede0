"""The motion of a follower as a labelled result."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.cams.followers.joints import ORDER, joints_of
from centrode.cams.followers.motion import FollowerMotion
from centrode.cams.followers.stretches import stretches
from centrode.errors import Status
from centrode.kinematics.dataset import Variable, named
from centrode.model.cams.files import cam_text
from centrode.model.cams.plate import PlateCam
from centrode.quantities import QUANTITIES
from centrode.version import __version__

Array = npt.NDArray[np.float64]

BY_ANGLE = ("", "_slope", "_second", "_third", "_fourth")
IN_TIME = ("_velocity", "_acceleration", "_jerk")
WIDTH, LEAST_PLACES = math.radians(1.0), 9
"""A drawn curve has a place at least every degree, and so many in each stretch."""


def motion_names(swings: bool) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Names of the lift with its derivatives by the cam's angle, and of those by time."""
    front = "swing" if swings else "lift"
    return tuple(front + end for end in BY_ANGLE), tuple(front + end for end in IN_TIME)


def dataset_of_motion(cam: PlateCam, motion: FollowerMotion, phi: Array) -> xr.Dataset:
    """The labelled motion of a follower at angles of its cam [rad].

    Along `sample`, over `cam_angle`: the lift with four derivatives by the cam's angle; with a speed of the cam also
    velocity, acceleration and jerk in time. Along `joint`, at `joint_angle`: lift and derivatives before and after it.
    """
    by_angle, in_time = motion_names(motion.swings)
    values = motion.lift(phi, len(by_angle) - 1)
    data: dict[str, Variable] = {
        name: named(name, ("sample",), one) for name, one in zip(by_angle, values, strict=True)
    }
    if motion.speed is not None:
        for order, name in enumerate(in_time, 1):
            data[name] = named(name, ("sample",), values[order] * motion.speed**order)
    data["status"] = _all_right(len(phi))
    coordinates = {"cam_angle": named("cam_angle", ("sample",), phi), "derivative": list(range(ORDER + 1))}
    return xr.Dataset(data | _joints(motion) | _curve(motion), coords=coordinates, attrs=_facts(cam, motion))


def _joints(motion: FollowerMotion) -> dict[str, Variable]:
    """Both sides of every joint, those of 0 deg at the end of the turn; each derivative in its own unit."""
    joints = joints_of(motion)
    units = {"units": ", ".join(QUANTITIES[name].unit for name in motion_names(motion.swings)[0])}
    sides = {"joint_before": [one.before for one in joints], "joint_after": [one.after for one in joints]}
    data = {
        name: (("joint", "derivative"), np.array(values), {**named(name, (), None)[2], **units})
        for name, values in sides.items()
    }
    return {"joint_angle": named("joint_angle", ("joint",), [one.angle for one in joints]), **data}


def _curve(motion: FollowerMotion) -> dict[str, Variable]:
    """The motion as it is drawn whatever the samples: each stretch by its own formula, with both its ends."""
    angles, values = [], []
    for stretch in stretches(motion.law):
        low, high = stretch.ends
        phi = np.linspace(low, high, max(LEAST_PLACES, 1 + math.ceil((high - low) / WIDTH)))
        angles.append(phi)
        values.append(stretch.derivatives(phi, ORDER))
    units = {"units": ", ".join(QUANTITIES[name].unit for name in motion_names(motion.swings)[0])}
    drawn = np.concatenate(values, axis=1).T
    return {
        "drawn_angle": named("drawn_angle", ("place",), np.concatenate(angles)),
        "drawn_motion": (("place", "derivative"), drawn, {**named("drawn_motion", (), None)[2], **units}),
    }


def _all_right(count: int) -> Variable:
    dimensions, values, attributes = named("status", ("sample",), np.full(count, Status.OK, dtype=np.int8))
    attributes["flag_values"] = np.array([s.value for s in Status], dtype=np.int8)
    attributes["flag_meanings"] = " ".join(s.name.lower() for s in Status)
    return dimensions, values, attributes


def _facts(cam: PlateCam, motion: FollowerMotion) -> dict[str, Any]:
    facts = {"title": cam.title, "cam": cam_text(cam), "version": __version__}
    curves = {"curves": ", ".join(segment.curve for segment in cam.segments)}
    return facts | curves | ({} if motion.speed is None else {"speed": motion.speed})
