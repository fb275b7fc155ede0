"""The motion of a cam's follower in words."""

from __future__ import annotations

from centrode.cams.followers.labelled import dataset_of_motion
from centrode.cams.followers.motion import follower_motion
from centrode.cams.sampled import angles_of
from centrode.locale import _
from centrode.model.cams.plate import PlateCam
from centrode.study.cams.said import Asked, CamPart


def motion_part(cam: PlateCam, asked: Asked) -> CamPart:
    """The follower's lift over a turn."""
    motion = follower_motion(cam)
    dataset = dataset_of_motion(cam, motion, angles_of(cam, asked.samples))
    return CamPart(_("Motion of the follower"), [], {}, {"cam-motion": dataset}, objects={"motion": motion})
