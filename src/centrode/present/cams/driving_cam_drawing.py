"""Cams that drive a linkage, drawn with it: the profile, its axis, the roller, the arm or the face."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle, Polygon

from centrode.present import signs
from centrode.present.style import INK, MUTED

if TYPE_CHECKING:
    from centrode.present.cams.driving_cam import DrivingCam
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
