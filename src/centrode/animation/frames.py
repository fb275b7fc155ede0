"""A motion as the frames of an animation, each computed where it stands, with what is shown beside the links."""

from __future__ import annotations

import functools
import importlib
import math
from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.errors import InputError, Status
from centrode.kinematics.motion import motion
from centrode.kinematics.path import INSIDE, grid_at
from centrode.kinematics.preparation import Ready, ready
from centrode.kinematics.solve import solve
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.model.motion_parameter import MotionParameter

# What an animation runs over: the part of a motion that is reached, and whether it runs round or there and
# back.

Array: TypeAlias = npt.NDArray[np.float64]
Loop: TypeAlias = Literal["round", "back", "once"]

MOST_TURNS = 12
"""Turns of a drive after which gears are still looked for in their first position."""
SAMPLES_OF_TURNS = 2881
"""Most samples of a course of several turns."""
CLOSED = 1e-6
"""Share of the mechanism's extent by which the last position may miss the first."""
USABLE = (Status.OK, Status.SINGULAR)


@dataclass(frozen=True)
class Course:
    """A motion to animate.

    Attributes
    ----------
    mechanism : Mechanism
    motion : Dataset
        Every sample of it is reached; from the first to the last it runs one way.
    places : (sample)
        What `ct.motion` takes as `at` for its samples.
    loop : "round", "back" or "once"
        The last position is the first again, or the motion runs there and back, or it ends and begins anew.
    turns : int
        Turns of the drive in a round; 1 where that says nothing.
    left_out : int
        Samples of the range asked for that are not reached, or lie beyond what is not.
    asked : int
        All samples of that range.
    """

    mechanism: Mechanism
    motion: xr.Dataset
    places: Array
    loop: Loop
    turns: int = 1
    left_out: int = 0
    asked: int = 0

    @property
    def seconds(self) -> float:
        """How long the motion takes until it begins again [s]."""
        time = self.motion["time"].values
        return float(abs(time[-1] - time[0])) * (2.0 if self.loop == "back" else 1.0)

    @property
    def parameter(self) -> MotionParameter:
        """What the places are values of: that of the mechanism, or time for a motion that goes by once."""
        parameter = self.mechanism.motion_parameter
        return parameter.in_time() if self.loop == "once" else parameter


def course_of(
    mechanism: Mechanism,
    samples: int | None = None,
    start: float | str | None = None,
    stop: float | str | None = None,
) -> Course:
    """The motion over a range, or over what the drive reaches if none is asked for.

    A drive that turns as far as it likes runs round, with gears as many turns (at most 12) as bring them back. What is
    limited runs between its limits, there and back.

    Raises
    ------
    InputError
        As `motion` does; no sample is reached.
    """
    prepared = ready(mechanism)
    found = motion(mechanism, samples, start, stop)
    asked_for = (start, stop, mechanism.study.start, mechanism.study.stop, mechanism.study.range)
    free = set(asked_for) == {None} and prepared.parameter.is_uniform
    asked, whole = found.sizes["sample"], usable(found)
    turns = 1
    if free and not whole.all():
        found = _swing(prepared, found)
    elif free and not closes(found) and prepared.parameter.turns:
        found, turns = _several_turns(mechanism, found)
    return course_from(mechanism, found, turns=turns, asked=asked, reached=int(whole.sum()))


def course_from(
    mechanism: Mechanism, found: xr.Dataset, *, turns: int = 1, asked: int = 0, reached: int | None = None
) -> Course:
    """The reached part of a motion about the initial position; of one that does not hold it, the longest part."""
    whole = usable(found)
    if not whole.any():
        raise InputError("", _("no sample has every point in place"), _("choose another range"))
    first, last = _part(whole, np.abs(found["time"].values))
    part = found.isel(sample=slice(first, last + 1))
    places = mechanism.motion_parameter.instants(part)
    if places[0] == places[-1]:
        raise InputError("", _("only one position is reached: nothing moves"), _("choose another range"))
    loop: Loop = "round" if whole.all() and closes(part) and _cams_close(mechanism, part) else "back"
    asked = asked or len(whole)
    reached = len(part["sample"]) if reached is None else reached
    return Course(mechanism, part, places, loop, turns, asked - reached, asked)


def usable(found: xr.Dataset) -> npt.NDArray[np.bool_]:
    """Samples with a position that the drive reaches."""
    placed = np.isfinite(found["position"].transpose("sample", "point", "axis").values).all(axis=(1, 2))
    return np.asarray(np.isin(found["status"].values, USABLE) & placed)


def closes(found: xr.Dataset) -> bool:
    """Whether the last position is the first: every point in its place, every link turned as it was."""
    places = found["position"].transpose("sample", "point", "axis").values
    known = places[np.isfinite(places).all(axis=(1, 2))]
    extent = float(np.ptp(known, axis=(0, 1)).max()) if len(known) else 0.0
    if not np.abs(places[-1] - places[0]).max() <= CLOSED * extent:
        return False
    if "angle" not in found:
        return True
    turned = found["angle"].isel(sample=-1).values - found["angle"].isel(sample=0).values
    turned = turned[np.isfinite(turned)]
    return bool((np.abs(np.remainder(turned + math.pi, math.tau) - math.pi) <= math.tau * CLOSED).all())


def _cams_close(mechanism: Mechanism, found: xr.Dataset) -> bool:
    """Whether every cam that drives has turned fully: in a rest of its follower nothing else tells."""
    time = found["time"].values
    turned = [(drive.turning or 0.0) * float(time[-1] - time[0]) for drive in mechanism.drives]
    return all(abs(math.remainder(angle, math.tau)) <= math.tau * CLOSED for angle in turned)


def _part(whole: npt.NDArray[np.bool_], distance: Array) -> tuple[int, int]:
    """First and last of the reached samples in a row about the one nearest to the start, else of the longest row."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], whole, [False]]).astype(int)))
    rows = [(int(first), int(last) - 1) for first, last in edges.reshape(-1, 2)]
    start = int(np.argmin(distance))
    return next(
        (row for row in rows if row[0] <= start <= row[1]), max(rows, key=lambda row: row[1] - row[0])
    )


def _swing(prepared: Ready, found: xr.Dataset) -> xr.Dataset:
    """The same between the nearest limits on both sides of the initial position, if all of that is reached."""
    path = prepared.kinematics.path
    way = np.linspace(-math.tau, math.tau, 3) if path.parameter.turns else np.zeros(1)
    reach = solve(prepared, grid_at(path, path.initial + way)).branches.reach(0)
    low, high = (float(end) for end in reach)
    if not (math.isfinite(low) and math.isfinite(high) and high - low < math.tau):
        return found
    inside = INSIDE * (high - low)
    ends = (low + inside, high - inside)
    if found["time"][-1] < found["time"][0] or found["drive_value"][-1, 0] < found["drive_value"][0, 0]:
        ends = ends[::-1]
    swung = motion(prepared.mechanism, found.sizes["sample"], *ends)
    return swung if usable(swung).all() else found


def _several_turns(mechanism: Mechanism, found: xr.Dataset) -> tuple[xr.Dataset, int]:
    """The same over as many turns as bring everything back; over one if no such number is found."""
    values = found["drive_value"].values[:, 0]
    first, turn = float(values[0]), float(values[-1] - values[0])
    trial = motion(mechanism, at=first + turn * np.arange(MOST_TURNS + 1))
    if not usable(trial).all():
        return found, 1
    for turns in range(2, MOST_TURNS + 1):
        if closes(trial.isel(sample=slice(0, turns + 1))):
            samples = min(turns * (found.sizes["sample"] - 1) + 1, SAMPLES_OF_TURNS)
            return motion(mechanism, samples, first, first + turns * turn), turns
    return found, 1


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
        both = [
            one.drop_dims(("event", "occasion"), errors="ignore") for one in (self.motion, self.course.motion)
        ]
        return xr.concat(both, dim="sample", data_vars="minimal", join="override")

    @property
    def passed_samples(self) -> npt.NDArray[np.intp]:
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


COURSE = 721
"""Samples of a simulation, from which paths are drawn."""


# what computes simulations is not loaded where drives give the motion
_simulation = functools.partial(importlib.import_module, "centrode.dynamics.simulation.simulate")


def course_of_simulation(mechanism: Mechanism) -> Course:
    """The motion that the simulation of a description computes: it goes by once, and then begins anew.

    Raises
    ------
    InputError, MotionError
        As `simulate` does; only one position is reached.
    """
    settings = mechanism.simulation
    if settings is None:
        repair = _('give driving = "20 - 2*v" and duration')
        raise InputError("[simulation]", _("it is missing"), repair)
    even = settings.model_copy(update={"samples": COURSE, "at": ()})
    found = _simulation().simulate(mechanism, even, motion=True)
    whole = usable(found)
    if whole.sum() < 2:
        raise InputError("", _("only one position is reached: nothing moves"), _("give a longer time"))
    found = found.isel(sample=np.flatnonzero(whole))
    return Course(mechanism, found, found["time"].values, "once", asked=found.sizes["sample"])


def film_of_simulation(course: Course, frames: int) -> Film:
    """Frames evenly spaced in time over a simulation, each computed where it stands."""
    places = np.linspace(course.places[0], course.places[-1], frames)
    assert course.mechanism.simulation is not None
    settings = course.mechanism.simulation.model_copy(update={"at": ()})
    found = _simulation().simulate(course.mechanism, settings, at=places, motion=True)
    numbers = np.arange(found.sizes["sample"])
    return Film(course, found, numbers, found["time"].values)


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
