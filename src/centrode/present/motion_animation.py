"""The motion of a mechanism as an animation, in the plane and on the sphere, with the paths of its points."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure

from centrode.errors import InputError
from centrode.locale import _
from centrode.present.animation import no_progress, write_animation
from centrode.present.curves import write_title
from centrode.present.drawing import MARGIN, draw_mechanism
from centrode.present.pictures import complete
from centrode.present.reading import scene_of
from centrode.present.scene import Scene
from centrode.present.sphere.globe import Globe, globe_of
from centrode.present.sphere.globe_drawing import draw_globe, draw_line
from centrode.present.style import MUTED

if TYPE_CHECKING:
    import xarray

    from centrode.model.mechanism import Mechanism

FRAMES = 48
INCHES = 5.2
HEADROOM = 0.45


def animate_motion(
    mechanism: Mechanism,
    dataset: xarray.Dataset,
    path: Path,
    *,
    frames: int | None = None,
    dark: bool = False,
    said: Callable[[int, int], None] = no_progress,
) -> None:
    """Write an animation (GIF) of a motion; where the motion does not close, it runs there and back.

    Parameters
    ----------
    mechanism : Mechanism
    dataset : Dataset
        Its motion, of `motion` or of `simulate` with the motion.
    path : Path
        The file.
    frames : int
        Of the motion one way; 48 if left out.
    dark : bool
        Light lines on a dark ground.
    said : callable
        Told after each frame how many are done, and of how many.

    Raises
    ------
    InputError
        No sample has every point in place.
    """
    scene = globe_of(mechanism, dataset) if mechanism.space == "sphere" else scene_of(mechanism, dataset)
    scene = replace(scene, inches=INCHES)
    places = _samples(scene, frames or FRAMES)
    write_animation(path, lambda sample: _drawn(scene, int(sample)), places, dark=dark, said=said)


def _samples(scene: Scene | Globe, frames: int) -> list[int]:
    """Samples of the frames: round and round where the last picture is the first, else there and back."""
    known = np.flatnonzero(complete(scene))
    if not known.size:
        raise InputError("", _("no sample has every point in place"), _("ask for another range"))
    chosen: list[int] = known[
        np.unique(np.linspace(0, known.size - 1, frames + 1).round().astype(int))
    ].tolist()
    moving = [scene.tracks[name] for name in scene.mechanism.moving_points]
    apart = max(float(np.abs(track[chosen[0]] - track[chosen[-1]]).max()) for track in moving)
    if len(chosen) > 1 and apart <= 1e-6 * scene.extent:
        return chosen[:-1]
    return chosen + chosen[-2:0:-1]


def _drawn(scene: Scene | Globe, sample: int) -> Figure:
    """The mechanism at a sample, over the paths of its points."""
    wide, high = INCHES * ((scene.high - scene.low) / scene.extent + 2 * MARGIN)
    figure = Figure(figsize=(wide, high + HEADROOM))
    axes = figure.add_axes((0.0, 0.0, 1.0, high / (high + HEADROOM)))
    if isinstance(scene, Globe):
        draw_globe(axes, scene, sample)
        for name in scene.mechanism.moving_points:
            draw_line(axes, scene, scene.tracks[name], MUTED, 1.0, zorder=1.5)
    else:
        draw_mechanism(axes, scene, sample)
        for name in scene.mechanism.moving_points:
            axes.plot(*scene.tracks[name].T, color=MUTED, linewidth=1.0, zorder=1.5)
        axes.set_axis_off()
    write_title(figure, _(scene.mechanism.title), "")
    return figure
