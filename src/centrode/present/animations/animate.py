"""Animations of mechanisms and cams: what is asked for, from the motion to the file."""

from __future__ import annotations

import functools
import importlib
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from centrode.errors import InputError
from centrode.locale import _, ngettext
from centrode.model.cam import Cam
from centrode.model.follower_cam import PlateCam
from centrode.present.animations.captions import instant_captions
from centrode.present.animations.encoding import Said, need_video, no_progress
from centrode.present.animations.layers import Layer
from centrode.present.animations.motions import scene_of_film, statuses_of
from centrode.present.animations.paces import Animation, Pace, write_stage
from centrode.present.animations.shown import Shown, check_shown, layers_of
from centrode.present.animations.stage import Stage
from centrode.present.animations.timing import SIZE, check_timing, kind_of, size_of
from centrode.study.moving.courses import Course, course_of
from centrode.study.moving.films import Film, film_of
from centrode.study.wording import place_words

if TYPE_CHECKING:
    from centrode.model.mechanism import Mechanism

# what computes cams is not loaded for a linkage
_of_cams = functools.partial(importlib.import_module, "centrode.present.animations.of_cams")


def animate(
    described: Mechanism | Cam | PlateCam,
    path: str | Path,
    shown: Shown | None = None,
    pace: Pace | None = None,
    *,
    start: float | None = None,
    stop: float | None = None,
    size: Sequence[int] | str = SIZE,
    dark: bool = False,
    said: Said = no_progress,
) -> Animation:
    """Write an animation, GIF or MP4 by the ending of its name, that runs on without a jump.

    A drive that turns fully runs round; where the mechanism is limited, or a range is asked for that does not close,
    the motion runs there and back. View and scales of vectors stay the same over the whole animation.

    Parameters
    ----------
    described : Mechanism, Cam or PlateCam
        Of a cam with a mover the walking wheel is shown, of another the cam that turns below its roller or follower.
    path : str or Path
        The file; it appears whole or not at all, and replaces one that is there.
    shown : Shown
        What is shown beside the links; the paths of the points if left out. A cam takes none.
    pace : Pace
        Frames, frames a second, duration or speed.
    start, stop : float [rad or m, or s]
        Values of the drive, as for `motion`.
    size : (width, height) or "800x600"
        In pixels; MP4 takes even ones, odd ones are made greater by one.
    dark : bool
        Light lines on a dark ground.
    said : callable
        Told after each frame how many are drawn, and of how many.

    Raises
    ------
    InputError
        Names, numbers or sizes out of bounds; nothing that moves; MP4 without imageio-ffmpeg.
    """
    path, pace = Path(path), pace or Pace()
    kind = kind_of(path)
    if kind == ".mp4":
        need_video()
    if isinstance(described, Cam | PlateCam):
        if shown is not None or start is not None or stop is not None:
            raise InputError("show", _("a cam is shown as a whole"), _("take it out"))
        found: Animation = _of_cams().animate_cam(described, path, pace, size, dark, said)
        return found
    shown = shown or Shown()
    check_shown(described, shown)
    check_timing(kind, pace.frames, pace.fps, pace.duration, pace.speed)
    course = course_of(described, None, start, stop)
    timing = pace.timing(kind, course.seconds)
    pixels = size_of(size, kind, timing.frames)
    film = film_of(course, timing.frames)
    stage, notes = stage_of(film, shown, pixels, dark=dark)
    write_stage(stage, path, timing, said)
    notes = [*_about(course), *notes]
    return Animation(
        path, timing.frames, timing.per_second, pixels, course.loop, tuple(notes), course.left_out
    )


def stage_of(
    film: Film, shown: Shown, size: tuple[int, int] = SIZE, *, dark: bool = False, more: Sequence[Layer] = ()
) -> tuple[Stage, list[str]]:
    """The stage of a film, and what has to be said of it; `more` layers are drawn over the others."""
    layers = [*layers_of(film, scene_of_film(film), shown), *more]
    captions = instant_captions(film)
    stage = Stage(
        layers, len(film.order), size, _(film.mechanism.title), lambda frame: captions[frame], dark=dark
    )
    notes = [note for layer in layers for note in layer.notes()]
    for word, count in statuses_of(film).items():
        text = ngettext("{n} position is {status}", "{n} positions are {status}", count)
        notes.append(text.format(n=count, status=word))
    return stage, notes


def _about(course: Course) -> list[str]:
    """How it runs, and which samples are not shown."""
    found = []
    if course.left_out:
        first, last = (place_words(course.mechanism, course.motion, sample) for sample in (0, -1))
        text = _("it moves from {first} to {last}; {n} of {all} samples are not reached and not shown")
        found.append(text.format(first=first, last=last, n=course.left_out, all=course.asked))
    if course.turns > 1:
        found.append(
            ngettext(
                "{n} turn of the drive in a round", "{n} turns of the drive in a round", course.turns
            ).format(n=course.turns)
        )
    return found
