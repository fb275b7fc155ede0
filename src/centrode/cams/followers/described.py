"""From the description of a cam with a follower to its geometry."""

from __future__ import annotations

from centrode.cams.followers.bodies import FollowerCam
from centrode.cams.followers.layouts import layout_of
from centrode.cams.followers.motion import follower_motion
from centrode.errors import InputError
from centrode.locale import _
from centrode.model.cams.files import AnyCam, with_follower


def follower_cam(cam: AnyCam) -> FollowerCam:
    """The cam and the follower of a description.

    Parameters
    ----------
    cam : PlateCam

    Raises
    ------
    InputError
        A cam by a curvature law, no base radius, a follower that its cam cannot lead.
    """
    plate = with_follower(cam)
    base = plate.body.base_radius
    if base is None:
        raise InputError("[cam] base_radius", _("the profile needs the base radius"), _("give it"))
    return layout_of(plate).cam(follower_motion(plate), base)
