"""The walking wheel as an animation of one step, which runs on without a jump."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from matplotlib.figure import Figure

from centrode.present.animation import loop_places, no_progress, write_animation
from centrode.present.cams.walking_drawing import draw_wheel, wheel_keys, window
from centrode.present.curves import write_title
from centrode.present.shown import shown_as

if TYPE_CHECKING:
    from centrode.cams.wheel.walking import Mover
    from centrode.model.asked import Display

FRAMES = 36
SIZE = (5.6, 5.9)
PLACE = (0.02, 0.115, 0.96, 0.79)


def animate_walking(
    wheel: Mover,
    path: Path,
    title: str = "",
    display: Display | None = None,
    *,
    frames: int | None = None,
    dark: bool = False,
    said: Callable[[int, int], None] = no_progress,
) -> None:
    """Write an animation (GIF) of one step of a walking wheel, seen from its hub.

    The carrier turns evenly; after a step the next leg stands where the last one stood and the ground has moved on by
    the distance of two footprints, so that the last picture leads to the first.

    Parameters
    ----------
    wheel : Mover
        Of `walking_wheel`.
    path : Path
        The file.
    title : str
    display : Display, optional
        Its unit of length; metres if left out.
    frames : int
        Of a step; 36 if left out.
    dark : bool
        Light lines on a dark ground.
    said : callable
        Told after each frame how many are done, and of how many.
    """
    factor, _unit = shown_as("m", display)
    places = loop_places(-wheel.half, math.tau / wheel.legs, frames or FRAMES)
    write_animation(path, lambda turned: _drawn(wheel, turned, factor, title), places, dark=dark, said=said)


def _drawn(wheel: Mover, turned: float, factor: float, title: str) -> Figure:
    """The wheel where its carrier has turned by an angle, without scales: the ground passes by."""
    figure = Figure(figsize=SIZE)
    axes = figure.add_axes(PLACE)
    pose = wheel.pose(float(turned))
    draw_wheel(axes, wheel, pose, factor)
    window(axes, wheel, pose, factor)
    axes.set_axis_off()
    keys = wheel_keys()
    figure.legend(
        [key for key, _name in keys],
        [name for _key, name in keys],
        loc="lower center",
        ncols=4,
        columnspacing=1.2,
        handlelength=1.8,
    )
    write_title(figure, title, "")
    return figure
