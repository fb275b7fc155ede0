"""Cams that drive a linkage, drawn with it: the profile, its axis, the roller, the arm or the face."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle, Polygon

from centrode.present import signs
from centrode.present.style import GROUND, INK, MUTED

if TYPE_CHECKING:
    from centrode.present.cams.driving import DrivingCam
    from centrode.present.scene import Scene

MARK = 0.62
"""Length of the mark that shows how the cam has turned, as a part of its base radius."""


def draw_cams(axes: Axes, scene: Scene, sample: int) -> None:
    """The driving cams of a scene as they stand at a sample."""
    for cam in scene.cams:
        if np.isfinite(cam.angles[sample]):
            draw_cam(axes, cam, sample, scene.sign)


def draw_cam(axes: Axes, cam: DrivingCam, sample: int, size: float) -> None:
    """A cam with its roller, arm or face as they stand at a sample; `size` is the radius of a hinge."""
    axes.add_patch(
        Polygon(cam.outline(sample), closed=True, facecolor=MUTED, edgecolor="none", alpha=0.25, zorder=1.8)
    )
    axes.add_patch(
        Polygon(cam.outline(sample), closed=True, fill=False, edgecolor=INK, linewidth=1.4, zorder=2.1)
    )
    turned = cam.body.in_frame(np.array([[0.0, MARK * cam.body.base_radius]]), cam.angles[[sample]])
    axes.plot(*np.array([cam.hub, cam.drawn(turned)[0]]).T, color=INK, linewidth=1.0, zorder=2.1)
    signs.fixed_hinge(axes, cam.hub, size, GROUND)
    for line in (cam.arm(sample), cam.face(sample)):
        if line is not None:
            axes.plot(*np.array(line).T, color=INK, linewidth=1.6, solid_capstyle="round", zorder=2.3)
    roller = cam.roller(sample)
    if roller is not None:
        centre, radius = roller
        axes.add_patch(
            Circle(
                (float(centre[0]), float(centre[1])),
                radius,
                facecolor="white",
                edgecolor=INK,
                linewidth=1.4,
                zorder=2.35,
            )
        )
