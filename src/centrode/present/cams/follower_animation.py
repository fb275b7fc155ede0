"""A cam that turns under its follower, as an animation of one turn."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from centrode.present import signs
from centrode.present.animation import loop_places, no_progress, write_animation
from centrode.present.cams.driving import DrivingCam
from centrode.present.cams.driving_drawing import draw_cam
from centrode.present.curves import write_title
from centrode.present.sheet import SIGN_INCHES
from centrode.present.shown import shown_as
from centrode.present.signs import turning_arc
from centrode.present.style import GROUND, INK

if TYPE_CHECKING:
    from centrode.cams.followers.bodies import FollowerCam
    from centrode.model.asked import Display
    from centrode.present.scene import Array

FRAMES = 60
INCHES = 5.0
HEADROOM = 0.45
MARGIN = 0.06
STEM = 13.0
"""Length of a translating follower's stem above its highest place, over the size of a hinge."""


def animate_follower(
    body: FollowerCam,
    path: Path,
    title: str = "",
    display: Display | None = None,
    *,
    frames: int | None = None,
    dark: bool = False,
    said: Callable[[int, int], None] = no_progress,
) -> None:
    """Write an animation (GIF) of one turn of a cam under its follower.

    Parameters
    ----------
    body : FollowerCam
        Of `follower_cam`.
    path : Path
        The file.
    title : str
    display : Display, optional
        Its unit of length; metres if left out.
    frames : int
        Of a turn; 60 if left out.
    dark : bool
        Light lines on a dark ground.
    said : callable
        Told after each frame how many are done, and of how many.
    """
    factor, _unit = shown_as("m", display)
    angles = loop_places(0.0, math.tau, frames or FRAMES)
    cam = DrivingCam.alone(body, angles, factor)
    places = list(range(len(angles)))
    write_animation(path, lambda sample: _drawn(cam, sample, title), places, dark=dark, said=said)


def _drawn(cam: DrivingCam, sample: int, title: str) -> Figure:
    """The cam and its follower at a sample, without scales."""
    low, high, _size = window_of(cam)
    wide, tall = INCHES * (high - low) / float(np.max(high - low))
    figure = Figure(figsize=(wide, tall + HEADROOM))
    draw_turning(figure.add_axes((0.0, 0.0, 1.0, tall / (tall + HEADROOM))), cam, sample)
    write_title(figure, title, "")
    return figure


def draw_turning(axes: Axes, cam: DrivingCam, sample: int) -> None:
    """Draw the cam and its follower at a sample, in their window."""
    low, high, size = window_of(cam)
    axes.set_aspect("equal")
    axes.set_xlim(low[0], high[0])
    axes.set_ylim(low[1], high[1])
    draw_cam(axes, cam, sample, size)
    signs.turning_arrow(axes, turning_arc(cam.hub, 0.0, cam.forward, size), GROUND)
    if cam.pivot is None:
        _draw_stem(axes, cam, sample, size)
    else:
        signs.fixed_hinge(axes, cam.factor * cam.pivot, size)
    axes.set_axis_off()


def window_of(cam: DrivingCam) -> tuple[Array, Array, float]:
    """Corners of the picture, and the radius of a hinge in it."""
    reach = cam.reach()
    low, high = reach.min(axis=0), reach.max(axis=0)
    size = SIGN_INCHES / INCHES * float(np.max(high - low))
    # Room for the feet of hinges, and for a stem with its guide.
    low, high = low - 5.0 * size, high + 2.0 * size
    if cam.pivot is None:
        high[1] = max(high[1], top_of(cam) + (STEM + 4.0) * size)
    room = MARGIN * float(np.max(high - low)) / 2
    return low - room, high + room, size


def top_of(cam: DrivingCam) -> float:
    """The highest place of a translating follower's roller, edge or face."""
    lifts = cam.body.motion.lift(np.linspace(0.0, cam.body.edges[-1], 361))[0]
    roller = cam.body.touch.roller if math.isfinite(cam.body.touch.roller) else 0.0
    return cam.factor * (cam.body.guide.start + float(np.max(lifts)) + roller)


def _draw_stem(axes: Axes, cam: DrivingCam, sample: int, size: float) -> None:
    """The stem of a translating follower, between the walls of its guide."""
    foot, top = cam.foot(sample), top_of(cam)
    end = np.array([0.0, STEM * size + top - cam.factor * cam.body.guide.start])
    axes.plot(*np.array([foot, foot + end]).T, color=INK, linewidth=1.6, zorder=2.3)
    for side in (-1.0, 1.0):
        x = foot[0] + 1.2 * side * size
        ends = (np.array([x, top + 2.0 * size]), np.array([x, top + 9.0 * size]))
        signs.ground(axes, *ends, np.array([side, 0.0]), size)
