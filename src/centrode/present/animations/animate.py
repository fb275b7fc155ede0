"""Animations of mechanisms and cams: what is asked for, from the motion to the file."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from centrode.cams.profiles.bodies import cam_body
from centrode.cams.profiles.tables import walking_wheel
from centrode.errors import InputError
from centrode.locale import _, ngettext
from centrode.model.cams.description import Cam
from centrode.present.animations.cams import TurningCamLayer, WalkingLayer
from centrode.present.animations.captions import instant_captions, turned_caption
from centrode.present.animations.encoding import Said, need_video, no_progress, write_gif, write_mp4
from centrode.present.animations.layers import Layer
from centrode.present.animations.motions import scene_of_film, statuses_of
from centrode.present.animations.shown import Shown, check_shown, layers_of
from centrode.present.animations.stage import Stage
from centrode.present.animations.timing import SIZE, Timing, kind_of, size_of, timing_of
from centrode.present.shown import shown_as
from centrode.study.centres import place_words
from centrode.study.moving.courses import Course, course_of
from centrode.study.moving.films import Film, film_of, frame_ways

if TYPE_CHECKING:
    from centrode.model.mechanism import Mechanism


@dataclass(frozen=True)
class Pace:
    """How many frames an animation has and how fast they follow each other; 60 of them, 20 a second, if left out.

    Attributes
    ----------
    frames : int, optional
    fps : float, optional
        Frames a second.
    duration : float, optional [s]
        How long the animation takes until it begins again.
    speed : float, optional
        Instead: how many times as fast as the mechanism moves.
    """

    frames: int | None = None
    fps: float | None = None
    duration: float | None = None
    speed: float | None = None

    def timing(self, kind: str, period: float) -> Timing:
        """The same completed; raises InputError for what does not go together."""
        return timing_of(kind, period, self.frames, self.fps, self.duration, self.speed)


@dataclass(frozen=True)
class Animation:
    """What was written.

    Attributes
    ----------
    path : Path
    frames : int
    per_second : float
    size : (width, height)
        In pixels.
    loop : "round" or "back"
        The last picture leads to the first in the same sense, or the motion runs there and back.
    notes : tuple of str
        What a reader should know: the loop, samples left out, vectors that are not drawn.
    left_out : int
        Samples of the range that are not reached.
    """

    path: Path
    frames: int
    per_second: float
    size: tuple[int, int]
    loop: str
    notes: tuple[str, ...] = ()
    left_out: int = 0

    @property
    def seconds(self) -> float:
        """How long it takes until it begins again."""
        return self.frames / self.per_second


def animate(
    described: Mechanism | Cam,
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
    described : Mechanism or Cam
        Of a cam with a mover the walking wheel is shown, of another the cam that turns below its roller.
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
    if isinstance(described, Cam):
        if shown is not None or start is not None or stop is not None:
            raise InputError("show", _("a cam is shown as a whole"), _("take it out"))
        return _animate_cam(described, path, pace, size, dark, said)
    shown = shown or Shown()
    check_shown(described, shown)
    pace.timing(kind, 1.0)  # what is out of bounds is refused before anything is solved
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


def write_stage(stage: Stage, path: Path, timing: Timing, said: Said = no_progress) -> None:
    """Write what a stage shows; the ending of the name decides how."""
    if path.suffix.lower() == ".mp4":
        write_mp4(path, stage.pictures(), stage.frames, timing.per_second, said)
    else:
        write_gif(path, stage.pictures(), stage.frames, timing.delays, said)


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


def _animate_cam(
    cam: Cam, path: Path, pace: Pace, size: Sequence[int] | str, dark: bool, said: Said
) -> Animation:
    """A step of the walking wheel, or a turn of the cam; an open cam runs there and back."""
    if pace.speed is not None:
        raise InputError("speed", _("a cam has no speed of its own"), _("ask for a duration instead"))
    timing = pace.timing(path.suffix.lower(), 1.0)
    pixels = size_of(size, path.suffix.lower(), timing.frames)
    factor = shown_as("m", cam.display)[0]
    loop = "round"
    layer: Layer
    if cam.mover is not None:
        wheel = walking_wheel(cam)
        angles = -wheel.half + math.tau / wheel.legs * frame_ways("round", timing.frames)
        layer = WalkingLayer(wheel, angles, factor)
    else:
        body = cam_body(cam)
        first, last = body.closed.start, body.closed.stop
        loop = "round" if last - first >= math.tau * (1.0 - 1e-9) else "back"
        angles = first + (last - first) * frame_ways("round" if loop == "round" else "back", timing.frames)
        layer = TurningCamLayer(body, angles, factor)
    caption: Callable[[int], str] = lambda frame: turned_caption(float(angles[frame]), cam.display)  # noqa: E731
    stage = Stage([layer], timing.frames, pixels, _(cam.title), caption, dark=dark)
    write_stage(stage, path, timing, said)
    return Animation(path, timing.frames, timing.per_second, pixels, loop)
