"""A motion as the frames of an animation, each computed where it stands, with what is shown beside the links."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.kinematics.motion import motion
from centrode.model.mechanism import Mechanism
from centrode.study.moving.courses import Course, Loop

Array: TypeAlias = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Film:
    """Frames of a motion.

    Attributes
    ----------
    course : Course
        The motion, densely: what paths are drawn from.
    motion : Dataset
        Positions of the frames, each once.
    order : (frame)
        The sample of `motion` that each frame shows.
    places : (sample)
        What `ct.motion` and `ct.reactions` take as `at` for those samples.
    """

    course: Course
    motion: xr.Dataset
    order: npt.NDArray[np.intp]
    places: Array

    @property
    def mechanism(self) -> Mechanism:
        """The description."""
        return self.course.mechanism

    @property
    def together(self) -> xr.Dataset:
        """Positions of the frames, and behind them those of the course: everything that a picture has room for."""
        both = [one.drop_dims("event", errors="ignore") for one in (self.motion, self.course.motion)]
        return xr.concat(both, dim="sample", data_vars="minimal", join="override")

    @property
    def passed(self) -> npt.NDArray[np.intp]:
        """How many samples of the course lie behind each sample of the frames."""
        along = self.course.places * np.sign(self.course.places[-1] - self.course.places[0])
        own = self.places * np.sign(self.course.places[-1] - self.course.places[0])
        return np.asarray(np.searchsorted(along, own, side="right"))


def film_of(course: Course, frames: int) -> Film:
    """Frames evenly spaced over a course; the picture after the last one is the first.

    Round they leave the end out, which is the beginning again. There and back each place but the ends is passed twice;
    with an odd number of frames none stands on the far end.
    """
    ways = frame_ways(course.loop, frames)
    each, order = np.unique(ways, return_inverse=True)
    first, last = course.places[0], course.places[-1]
    places = first + (last - first) * each
    return Film(course, motion(course.mechanism, at=places), order, places)


def film_from(course: Course, frames: int) -> Film:
    """Frames of a course's own samples: as many as can be had of `frames` round, or one way where it runs back."""
    count = len(course.places)
    chosen = np.unique(np.linspace(0, count - 1, frames + 1).round().astype(int))
    numbers = np.arange(len(chosen))
    order = numbers[:-1] if course.loop == "round" else np.concatenate([numbers, numbers[-2:0:-1]])
    return Film(course, course.motion.isel(sample=chosen), order, course.places[chosen])


def frame_ways(loop: Loop, frames: int) -> Array:
    """Where frames stand on their course, from 0 to 1."""
    numbers = np.arange(frames)
    if loop == "round":
        return numbers / frames
    return np.minimum(2 * numbers, 2 * (frames - numbers)) / frames
