"""Animations of modes: a file for each, in which the mechanism swings about its equilibrium."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from centrode.animation.animate import FRAMES, PER_SECOND, Shown, stage_of
from centrode.animation.frames import Course, Film
from centrode.animation.video_files import SIZE, Timing, no_progress, write_stage

if TYPE_CHECKING:
    import xarray

    from centrode.dynamics.equilibria.modes import ModesResults
    from centrode.model.mechanism import Mechanism


def animate_modes(results: ModesResults, path: Path, dark: bool = False) -> None:
    """Write an animation of the first mode to a file, and of each other one beside it: mode-1.gif, mode-2.gif, ..."""
    for number, motion in enumerate(results.motions):
        beside = path.with_name(path.name.replace("1", str(number + 1)))
        animate_period(results.mechanism, motion, beside if number else path, dark)


def animate_period(mechanism: Mechanism, motion: xarray.Dataset, path: Path, dark: bool = False) -> None:
    """Write an animation of a motion that ends where it begins."""
    times = motion["time"].values
    course = Course(mechanism, motion, times, "once", asked=len(times))
    # the last position is the first of the next round
    chosen = np.unique(np.linspace(0, len(times) - 1, FRAMES + 1).round().astype(int))[:-1]
    film = Film(course, motion.isel(sample=chosen), np.arange(len(chosen)), times[chosen])
    stage, _notes = stage_of(film, Shown(), SIZE, dark=dark)
    write_stage(stage, Path(path), Timing(stage.frames, PER_SECOND), no_progress)
