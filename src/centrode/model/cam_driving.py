"""Checks of a cam's follower against the link that it is."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from centrode.locale import _
from centrode.model.known import known
from centrode.model.problems import Place, Problem, shown

if TYPE_CHECKING:
    from centrode.model.cams.plate import PlateCam
    from centrode.model.description import Description
    from centrode.model.driving import Drive

NEAR = 1e-9
"""Share of an arm by which its length may miss that of the cam's description."""


def pivot_of(mechanism: Description, link: str) -> str | None:
    """The point of the frame about which a link turns; None where it has none or several."""
    found = [name for name in mechanism.links[link].coordinates if name in mechanism.frame.points]
    return found[0] if len(found) == 1 else None


def follower_problems(mechanism: Description, drive: Drive, at: Place) -> Iterator[Problem]:
    """What is wrong with the point of a link that is said to touch the cam."""
    link = drive.link or ""
    if drive.cam is None or drive.cam_point is None or link not in mechanism.links:
        return
    points = mechanism.links[link].coordinates
    unknown = list(known(drive.cam_point, points, "point", (*at, "cam_point"), link))
    pivot = pivot_of(mechanism, link)
    yield from unknown
    if unknown or pivot is None:
        return
    if pivot == drive.cam_point:
        what = _("{point} is the pivot of the follower").format(point=shown(pivot))
        yield Problem(what, _("name the roller's centre, or the edge"), (*at, "cam_point"))
    elif not _fits(drive.cam, length := math.dist(points[pivot], points[drive.cam_point])):
        what = _("the cam's follower has an arm of {arm:.9g} m, but {point} is {length:.9g} m from its pivot")
        told = what.format(arm=drive.cam.follower.arm, point=shown(drive.cam_point), length=length)
        yield Problem(told, _("correct one of them"), (*at, "cam_point"))


def _fits(cam: PlateCam, length: float) -> bool:
    arm = cam.follower.arm
    return arm is None or cam.follower.contact == "flat" or abs(length - arm) <= NEAR * arm
