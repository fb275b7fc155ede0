"""From a description with a follower to its cam."""

from __future__ import annotations

import functools
import math

from centrode.cams.followers.bodies import FollowerCam
from centrode.cams.followers.layouts import layout_of
from centrode.cams.followers.margins import Admissible
from centrode.cams.followers.motion import follower_motion
from centrode.cams.followers.sizing import Least, best_offset, least_base_radius
from centrode.cams.profiles.equidistants import Undercut
from centrode.errors import InputError, MotionError
from centrode.locale import _
from centrode.model.cams.files import AnyCam, with_follower
from centrode.model.cams.plate import PlateCam


def follower_cam(cam: AnyCam) -> FollowerCam:
    """The cam of a description with a follower.

    Where `[cam] base_radius` is left out it is the least that `[bounds]` admits.

    Raises
    ------
    InputError
        A cam that is given by a curvature law; neither a base radius nor bounds that decide one; a follower that
        cannot be led; a profile that is undercut, unless `[study] show_undercut` is set: the least radius that is not
        is told.
    MotionError
        No base radius keeps the bounds.
    """
    plate = with_follower(cam)
    body = _body(plate)
    if body.undercuts and not plate.study.show_undercut:
        raise _undercut(plate, body)
    return body


@functools.lru_cache(maxsize=16)
def _body(cam: PlateCam) -> FollowerCam:
    layout, motion, base = layout_of(cam), follower_motion(cam), cam.body.base_radius
    if base is None:
        if not bounded(cam):
            what = _("a profile needs the cam's base radius")
            raise InputError("[cam] base_radius", what, _("give it, or write [bounds] that it is to keep"))
        least = least_base_radius(layout, motion, admissible_of(cam))
        if least.by == "nothing":
            what = _("no bound decides the base radius: a cam as small as one likes keeps them all")
            raise InputError("[cam] base_radius", what, _("give it, or bound the radius of curvature"))
        base = least.base_radius
    return layout.cam(motion, base)


def least_cam(cam: AnyCam, *, offset: bool = False) -> Least:
    """The least cam that keeps `[bounds]`: its base radius, what decides it and where.

    Parameters
    ----------
    offset : bool
        Choose the offset of a translating follower too, so that the base radius is least; of a flat face so that it is
        touched as far on both sides. Without bounds the profile is only kept from being undercut.

    Raises
    ------
    InputError
        A cam that is given by a curvature law; an oscillating follower has no offset.
    MotionError
        No base radius keeps the bounds.
    """
    plate = with_follower(cam)
    find = best_offset if offset else least_base_radius
    return find(layout_of(plate), follower_motion(plate), admissible_of(plate))


def bounded(cam: PlateCam) -> bool:
    """Whether the description says what is admissible of the profile."""
    given = (cam.bounds.pressure_angle, cam.bounds.return_pressure_angle, cam.bounds.curvature_radius)
    return any(one is not None for one in given)


def admissible_of(cam: PlateCam) -> Admissible:
    """What a description admits; what it leaves out is not bound, except that the profile is not undercut."""
    steep = cam.bounds.pressure_angle or math.pi / 2
    return Admissible(steep, cam.bounds.return_pressure_angle or steep, cam.bounds.curvature_radius or 0.0)


def stretches_text(undercuts: list[Undercut]) -> str:
    """Stretches and corners in degrees, in words."""
    texts = []
    for one in undercuts:
        start, stop = math.degrees(one.start), math.degrees(one.stop)
        text = _("{first:.6g} to {last:.6g}").format(first=start, last=stop)
        texts.append(f"{start:.6g}" if start == stop else text)
    return ", ".join(texts)


def _undercut(cam: PlateCam, body: FollowerCam) -> InputError:
    """What is said of a profile that its follower cuts away: where, and what would not."""
    what = _("the follower undercuts the profile at {stretches} deg").format(
        stretches=stretches_text(body.undercuts)
    )
    show = _("[study] show_undercut = true shows it")
    if any(corner.undercuts(body.touch.roller) for corner in body.corners):
        join = _("join the segments with equal slopes there")
        return InputError("[[segments]]", what, f"{join}; {show}")
    ways: list[str] = []
    try:
        least = least_base_radius(layout_of(cam), body.motion, Admissible()).base_radius
        ways.append(_("take a base radius above {least:.6g} mm").format(least=1e3 * least))
    except MotionError:
        ways.append(_("take a smaller lift or longer segments"))
    most, _at = body.greatest_roller
    if 0.0 < most < body.touch.roller < math.inf:
        roller = _("a roller below {most:.6g} mm on the same path of its centre")
        ways.append(roller.format(most=1e3 * most))
    return InputError("[cam] base_radius", what, "; ".join([_(" or ").join(ways), show]))
