"""Cams that drive a linkage, drawn with it: the profile, its axis, the roller, the arm or the face."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle, Polygon

from centrode.cams.followers.base_circle import follower_cam, has_bounds
from centrode.cams.followers.geometry import FollowerCam, Oscillating
from centrode.errors import CentrodeError
from centrode.model.checks import pivot_of
from centrode.numerics.arrays import ARRAYS
from centrode.present import signs
from centrode.present.cams.driving_cam import Array, DrivingCam
from centrode.present.style import INK, MUTED

if TYPE_CHECKING:
    import xarray

    from centrode.model.mechanism import Drive, Mechanism
    from centrode.present.scene import LinkageScene


def draw_cams(axes: Axes, scene: LinkageScene, sample: int) -> None:
    """The driving cams of a scene as they stand at a sample, on their axes."""
    draw_axes_of_cams(axes, scene)
    draw_turned_cams(axes, scene, sample)


def draw_axes_of_cams(axes: Axes, scene: LinkageScene) -> None:
    """The hinges on the frame that the driving cams turn about."""
    for cam in scene.cams:
        signs.fixed_hinge(axes, cam.hub, scene.sign)


def draw_turned_cams(axes: Axes, scene: LinkageScene, sample: int) -> None:
    """The driving cams with roller, arm or face of their followers, without their axes."""
    for cam in scene.cams:
        if np.isfinite(cam.angles[sample]):
            draw_profile(axes, cam, sample)
            draw_touching(axes, cam, sample)


def draw_profile(axes: Axes, cam: DrivingCam, sample: int, line: str = INK, tint: str = MUTED) -> None:
    """A cam without its axis, as it has turned."""
    outline = cam.outline(sample)
    axes.add_patch(Polygon(outline, closed=True, facecolor=tint, edgecolor="none", alpha=0.25, zorder=1.8))
    axes.add_patch(Polygon(outline, closed=True, fill=False, edgecolor=line, linewidth=1.4, zorder=2.1))
    axes.plot(*cam.mark(sample).T, color=line, linewidth=1.0, zorder=2.1)


def draw_touching(axes: Axes, cam: DrivingCam, sample: int, line: str = INK) -> None:
    """What belongs to the follower alone: arm or face, and roller."""
    for ends in cam.lines(sample):
        axes.plot(*np.array(ends).T, color=line, linewidth=1.6, solid_capstyle="round", zorder=2.3)
    roller = cam.roller(sample)
    if roller is not None:
        (x, y), radius = roller
        rim = Circle(
            (float(x), float(y)), radius, facecolor="white", edgecolor=line, linewidth=1.4, zorder=2.35
        )
        axes.add_patch(rim)


# The cams that drive a linkage, in its own picture: where their axes are and how far they have turned.

APART = 1e-9
"""Of drive's values and the cam's lift, over the greatest of them: more, and the cam does not move the drive."""


def driving_cams(mechanism: Mechanism, dataset: xarray.Dataset, factor: float) -> tuple[DrivingCam, ...]:
    """The cams of a linkage's drives that can be drawn: those whose follower moves against the frame.

    Parameters
    ----------
    mechanism : Mechanism
    dataset : Dataset
        Its motion, without batch dimensions.
    factor : float
        Units of the display in a metre.

    Raises
    ------
    InputError, MotionError
        A cam that cannot lead its follower, or whose profile it undercuts.
    """
    return tuple(_cams(mechanism, dataset, factor))


def _cams(mechanism: Mechanism, dataset: xarray.Dataset, factor: float) -> Iterator[DrivingCam]:
    for drive in mechanism.drives:
        if drive.cam is None or drive.turning is None:
            continue
        if drive.cam.body.base_radius is None and not has_bounds(drive.cam):
            continue
        time = np.asarray(dataset["time"], dtype=float)
        values = np.asarray(dataset["drive_value"].sel(drive=drive.id), dtype=float)
        apart = values - np.asarray(drive.motion_law.jet(ARRAYS, time), dtype=float)
        zero = float(np.nanmedian(apart)) if np.isfinite(apart).any() else math.nan
        # Where a simulation moves the linkage, the cam does not.
        if not np.nanmax(np.abs(apart - zero), initial=0.0) <= APART * max(
            1.0, float(np.nanmax(abs(values)))
        ):
            continue
        try:
            body = follower_cam(drive.cam)
        except CentrodeError as error:
            where = ", ".join(part for part in (f"[[drives]] {drive.id}, cam", error.where) if part)
            raise type(error)(where, error.what, error.repair) from None
        placed = (
            _translating(mechanism, drive, body, zero)
            if drive.guide
            else _turning(mechanism, drive, body, zero)
        )
        if placed is not None:
            centre, axes, pivot = placed
            angles = drive.cam_angle + drive.turning * time
            yield DrivingCam(body, centre, axes, angles, pivot, factor)


Placed = tuple[Array, Array, Array | None]


def _translating(mechanism: Mechanism, drive: Drive, body: FollowerCam, zero: float) -> Placed | None:
    """Below the guided point at lift zero, along the guide."""
    guide = mechanism.guide(drive.guide or "")
    if guide.on != "frame" or isinstance(body.guide, Oscillating):
        return None
    unit = np.asarray(guide.unit, dtype=float)
    lowest = np.asarray(mechanism.through(guide), dtype=float) + zero * unit
    up = -unit if drive.lowers else unit
    axes = np.array([[up[1], -up[0]], up])
    return lowest - np.array([body.guide.offset, body.guide.start]) @ axes, axes, None


def _turning(mechanism: Mechanism, drive: Drive, body: FollowerCam, zero: float) -> Placed | None:
    """Beside the pivot of the driven link, its arm as it stands at lift zero."""
    pivot = pivot_of(mechanism, drive.link or "")
    if pivot is None or drive.relative_to != "frame" or not isinstance(body.guide, Oscillating):
        return None
    arm = zero + _heading(mechanism, drive, pivot)
    # In the follower's own axes the arm points to pi - start and lifts clockwise.
    if drive.lowers:
        axes = _rotation(arm - (math.pi - body.guide.start))
    else:
        axes = np.diag([1.0, -1.0]) @ _rotation(arm + (math.pi - body.guide.start))
    place = np.asarray(mechanism.frame.coordinates[pivot], dtype=float)
    return place - np.array([body.guide.distance, 0.0]) @ axes, axes, place


def _heading(mechanism: Mechanism, drive: Drive, pivot: str) -> float:
    """Angle of the arm in the link's own axes."""
    if drive.cam_point is None:
        return 0.0
    points = mechanism.links[drive.link or ""].coordinates
    x, y = np.subtract(points[drive.cam_point], points[pivot])
    return math.atan2(y, x)


def _rotation(angle: float) -> Array:
    """Rows are the axes turned by an angle."""
    return np.array([[math.cos(angle), math.sin(angle)], [-math.sin(angle), math.cos(angle)]])
