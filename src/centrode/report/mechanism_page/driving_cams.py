"""A cam that drives a linkage, on a page: rigid outlines that follow the numbers a reader changes."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from centrode.cams.followers.geometry import Oscillating
from centrode.errors import CentrodeError
from centrode.locale import _
from centrode.model.checks import pivot_of
from centrode.model.mechanism import Drive, Mechanism
from centrode.scenes.driving_cams import DrivingCam, driving_cams

if TYPE_CHECKING:
    import xarray

Array = NDArray[np.float64]
DIGITS = 5
"""Of an outline in its own size: a hundredth of a pixel."""
OTHER = 1e-9
"""How far a follower's arm and its cam's may differ, in units of the arm."""


def cams_of(
    mechanism: Mechanism, motion: xarray.Dataset, points: list[str], links: list[str]
) -> tuple[list[dict[str, Any]], list[str]]:
    """Cams of a linkage in its plane, as plain data, and sentences that say why others are not drawn.

    Lengths are in m. A cam has its `outline` about its axis as it stands untouched, and in `turned` the angle at time
    zero and the speed. `axis` is the way to its axis from the pivot of the link that it turns, or from the place of the
    guide. The follower's `lines` and `roller` are in the axes of that link about its pivot, or beside the guided point.
    """
    driving = [drive for drive in mechanism.drives if drive.cam is not None]
    if not driving:
        return [], []
    try:
        found = driving_cams(mechanism, motion, 1.0)
    except CentrodeError as error:
        return [], [_("The cam is not drawn: {reason}.").format(reason=error.what)]
    if len(found) < len(driving):
        return [], [
            _("The cam is not drawn: it has no size, or its follower does not move against the frame.")
        ]
    cams = [
        _cam(mechanism, motion, drive, cam, points, links) for drive, cam in zip(driving, found, strict=True)
    ]
    return cams, []


def _cam(
    mechanism: Mechanism,
    motion: xarray.Dataset,
    drive: Drive,
    cam: DrivingCam,
    points: list[str],
    links: list[str],
) -> dict[str, Any]:
    still = replace(cam, angles=np.zeros(1))
    way = 1.0 if cam.forward else -1.0
    turning = float(drive.turning or 0.0)
    sample = int(np.argmax(np.isfinite(motion["position"].values).all(axis=(1, 2))))
    hung, foot, angle = _axis_and_follower(mechanism, motion.isel(sample=sample), drive, points, links)
    if isinstance(cam.body.guide, Oscillating) and math.isfinite(cam.body.touch.roller) and hung["arm"]:
        # a flat face touches where it likes: its cam fits any arm
        hung["arm"]["length"] = cam.body.guide.arm
    size = float(np.abs(still.outline(0) - cam.hub).max())
    roller = cam.roller(sample)
    lines = [np.array(line) for line in cam.lines(sample)]
    return {
        "outline": _round_to_size(still.outline(0) - cam.hub, size),
        "mark": _round_to_size(still.mark(0) - cam.hub, size),
        "turned": [way * drive.cam_angle, way * turning],
        "axis": (cam.hub - hung.pop("base")).tolist(),
        "start": {"path": f"drives.{drive.id}.start", "at": drive.start or 0.0},
        "lines": [_round_to_size(_rotate(line - foot, -angle), size) for line in lines],
        "roller": None
        if roller is None
        else _round_to_size(_rotate(roller[0][None] - foot, -angle), size)[0],
        "radius": 0.0 if roller is None else roller[1],
        **hung,
    }


def _axis_and_follower(
    mechanism: Mechanism,
    motion: xarray.Dataset,
    drive: Drive,
    points: list[str],
    links: list[str],
) -> tuple[dict[str, Any], Array, float]:
    """On what the axis of a cam hangs, and place and angle of its follower at the one sample of the motion."""
    own: dict[str, Any]
    if drive.guide:
        guide = mechanism.guide(drive.guide)
        through: Any = guide.through
        own = {
            "base": np.asarray(mechanism.through(guide), dtype=float),
            "link": None,
            "point": points.index(guide.point),
            "direction": {"path": f"guides.{guide.id}.direction", "at": guide.direction_angle},
        }
        if isinstance(through, str):
            own["through"] = {"point": points.index(through)}
        else:
            own["through"] = {
                "paths": [f"guides.{guide.id}.through.{axis}" for axis in "xy"],
                "at": own["base"].tolist(),
            }
        foot = motion["position"].sel(point=guide.point).values
        return own, np.asarray(foot, dtype=float), 0.0
    name = drive.link or ""
    pivot = pivot_of(mechanism, name) or ""
    coordinates = mechanism.links[name].coordinates
    arm = None
    if drive.cam_point is not None:
        ends = []
        for end in (pivot, drive.cam_point):
            x, y = coordinates[end]
            ends.append({"at": [x, y], **_paths(mechanism, name, end)})
        arm = {"ends": ends, "length": None, "most": OTHER}
    place = np.asarray(mechanism.frame.coordinates[pivot], dtype=float)
    own = {"base": place, "link": links.index(name), "point": points.index(pivot), "arm": arm}
    return own, place, float(motion["angle"].sel(link=name).values)


def _paths(mechanism: Mechanism, name: str, point: str) -> dict[str, str]:
    """Paths of the numbers that place a point in its link."""
    link = mechanism.links[name]
    if link.length is not None:
        return {"length": f"links.{name}.length"} if link.coordinates[point][0] else {}
    return {axis: f"links.{name}.points.{point}.{axis}" for axis in "xy"}


def _rotate(places: Array, angle: float) -> Array:
    cosine, sine = math.cos(angle), math.sin(angle)
    return np.asarray(places @ np.array([[cosine, sine], [-sine, cosine]]))


def _round_to_size(places: Array, size: float) -> list[list[float]]:
    decimals = DIGITS - math.floor(math.log10(size))
    return [[float(x) for x in row] for row in np.round(places, decimals)]
