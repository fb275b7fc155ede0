"""Pictures as a file: GIF by a palette of all frames, MP4 by ffmpeg; it appears whole or not at all."""

from __future__ import annotations

import functools
import importlib
import math
import re
import subprocess
import tempfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import IO

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from centrode.animation.stage import Palette, Pixels, Stage
from centrode.errors import InputError
from centrode.files.drafts import draft_file
from centrode.locale import _, ngettext
from centrode.optional_packages import how_to_install

Said = Callable[[int, int], None]

_ffmpeg = functools.partial(importlib.import_module, "imageio_ffmpeg")
INPUT = ["-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgba"]
OUTPUT = [
    *("-an", "-c:v", "libx264", "-pix_fmt", "yuv420p", "-crf", "18", "-preset", "medium", "-threads", "1"),
    *("-movflags", "+faststart", "-fflags", "+bitexact", "-flags:v", "+bitexact", "-f", "mp4"),
]
"""What every player shows; one thread and no version, so that the same pictures give the same bytes."""


def no_progress(_done: int, _of: int) -> None:
    """Say nothing."""


def need_video() -> None:
    """Raise InputError where what writes MP4 is not installed."""
    try:
        _ffmpeg()
    except ModuleNotFoundError as missing:
        raise InputError(
            "",
            _("MP4 needs imageio-ffmpeg, which is not installed"),
            _("{repair}, or name a .gif").format(repair=how_to_install("video")),
        ) from missing


def write_gif(
    path: Path, pictures: Iterator[Pixels], frames: int, delays: Sequence[int], said: Said = no_progress
) -> None:
    """Write frames as a GIF that starts over at its end; the same pictures give the same bytes.

    Parameters
    ----------
    path : Path
    pictures : iterator
        The ground, then the frames: of each only what differs from the ground is kept.
    frames : int
    delays : sequence of int
        How long each frame is shown [ms], in whole hundredths of a second.
    said : callable
        Told after each frame how many are drawn, and of how many.
    """
    ground = next(pictures)
    changed: list[tuple[NDArray[np.intp], NDArray[np.uint32]]] = []
    palette = Palette()
    palette.count(ground.reshape(-1))
    for number, picture in enumerate(pictures, start=1):
        where = np.flatnonzero(picture != ground)
        colours = picture.reshape(-1)[where]
        palette.count(colours)
        changed.append((where, colours))
        said(number, frames)
    palette.choose()
    table = palette.table
    base = palette.numbers(ground.reshape(-1))

    def shown() -> Iterator[Image.Image]:
        for where, colours in changed:
            numbers = base.copy()
            numbers[where] = palette.numbers(colours)
            image = Image.fromarray(numbers.reshape(ground.shape))
            image.putpalette(table)
            yield image

    images = shown()
    first = next(images)
    with draft_file(path) as draft:
        first.save(
            draft,
            format="GIF",
            save_all=True,
            append_images=images,
            duration=list(delays),
            loop=0,
            optimize=False,
        )


def write_mp4(
    path: Path, pictures: Iterator[Pixels], frames: int, fps: float, said: Said = no_progress
) -> None:
    """Write frames as an MP4 (H.264); its sides have to be even numbers of pixels."""
    need_video()
    high, wide = next(pictures).shape
    with draft_file(path) as draft:
        size = ["-s", f"{wide}x{high}", "-r", f"{fps:.9g}", "-i", "-"]
        command = [_ffmpeg().get_ffmpeg_exe(), *INPUT, *size, *OUTPUT, str(draft)]
        with tempfile.TemporaryFile() as told, _running(command, told) as sink:
            for number, picture in enumerate(pictures, start=1):
                sink.write(picture.tobytes())
                said(number, frames)


@contextmanager
def _running(command: Sequence[str], told: IO[bytes]) -> Iterator[IO[bytes]]:
    """What a program reads; it is waited for, or ended where the block raises."""
    process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=told)
    assert process.stdin is not None
    try:
        with suppress(BrokenPipeError), process.stdin:
            yield process.stdin
        code = process.wait()
    except BaseException:
        process.kill()
        process.wait()
        raise
    if code:
        told.seek(0)
        reason = told.read(300).decode("utf-8", "replace").strip()
        raise InputError("", _("ffmpeg failed: {reason}").format(reason=reason), _("write a .gif instead"))


# How many frames, how fast and how large: what is asked for, checked and completed.

FRAMES = 60
PER_SECOND = 20.0
SIZE = (800, 600)
LEAST_SIDE, MOST_SIDE = 64, 4096
MOST_FRAMES = 3000
MOST_PIXELS = 1_000_000_000
"""Of all frames together: some minutes of work."""
LEAST_RATE = 0.1
FASTEST = {".gif": 50.0, ".mp4": 120.0}
"""Frames a second that players keep to: of a GIF they slow down what is shorter than two hundredths of a second."""


@dataclass(frozen=True)
class Timing:
    """Frames and how many of them are shown in a second."""

    frames: int
    per_second: float

    @property
    def seconds(self) -> float:
        """How long a round takes."""
        return self.frames / self.per_second

    @property
    def delays(self) -> list[int]:
        """How long each frame of a GIF is shown [ms]: whole hundredths of a second that do not drift."""
        ends = [round(100.0 * number / self.per_second) for number in range(self.frames + 1)]
        return [10 * (after - before) for before, after in pairwise(ends)]


def timing_of(
    kind: str,
    period: float,
    frames: int | None = None,
    fps: float | None = None,
    duration: float | None = None,
    speed: float | None = None,
) -> Timing:
    """Complete what is asked for: 60 frames, 20 a second, where nothing says otherwise.

    Parameters
    ----------
    kind : ".gif" or ".mp4"
    period : float [s]
        The mechanism's own time of a round.
    frames, fps : int, float
    duration : float [s]
        How long a round shall take.
    speed : float
        Instead: how many times as fast as the mechanism moves.

    Raises
    ------
    InputError
        Something out of bounds, or given twice.
    """
    check_timing(kind, frames, fps, duration, speed)
    length = duration
    if speed is not None:
        length = period / speed
        if not 0.0 < length < math.inf:
            raise InputError(
                "speed", _("the motion has no duration of its own"), _("give a duration instead")
            )
    if length is None:
        return Timing(frames or FRAMES, fps or PER_SECOND)
    if frames is not None:
        rate = frames / length
        if not LEAST_RATE <= rate <= FASTEST[kind]:
            what = _("{frames} frames in {length:.4g} s are {rate:.4g} per second").format(
                frames=frames, length=length, rate=rate
            )
            raise InputError("frames", what, _rates(kind))
        return Timing(frames, rate)
    rate = fps or PER_SECOND
    count = round(length * rate)
    if not 2 <= count <= MOST_FRAMES:
        what = ngettext(
            "{length:.4g} s at a rate of {rate:g} per second are {n} frame",
            "{length:.4g} s at a rate of {rate:g} per second are {n} frames",
            count,
        ).format(length=length, rate=rate, n=count)
        raise InputError("fps", what, _("give 2 to {most} frames").format(most=MOST_FRAMES))
    return Timing(count, rate)


def check_timing(
    kind: str, frames: int | None, fps: float | None, duration: float | None, speed: float | None
) -> None:
    """Refuse what is out of bounds or given twice, whatever the mechanism's own time is."""
    if duration is not None and speed is not None:
        raise InputError(
            "speed", _("duration and speed define the same quantity"), _("remove one of the two")
        )
    if frames is not None and fps is not None and (duration is not None or speed is not None):
        what = _("the number of frames, the frames per second and the duration are given together")
        raise InputError("fps", what, _("remove one of the three"))
    if frames is not None and (isinstance(frames, bool) or not 2 <= frames <= MOST_FRAMES):
        what = ngettext("{n} frame is given", "{n} frames are given", frames).format(n=frames)
        raise InputError("frames", what, _("give 2 to {most} frames").format(most=MOST_FRAMES))
    if fps is not None and not LEAST_RATE <= fps <= FASTEST[kind]:
        what = _("{rate:g} frames per second are given").format(rate=fps)
        raise InputError("fps", what, _rates(kind))
    units = {
        "duration": _("give seconds, as 3"),
        "speed": _("give a multiple of the mechanism's own speed, as 0.5"),
    }
    for name, value in (("duration", duration), ("speed", speed)):
        if value is not None and not (math.isfinite(value) and value > 0.0):
            what = _("it must be a finite number greater than zero, and {value:g} is given")
            raise InputError(name, what.format(value=value), units[name])


def _rates(kind: str) -> str:
    return _("give {least:g} to {most:g} frames per second").format(least=LEAST_RATE, most=FASTEST[kind])


def kind_of(path: Path) -> str:
    """What is written, ".gif" or ".mp4", by the ending of a name; raises InputError for another."""
    kind = path.suffix.lower()
    if kind not in FASTEST:
        raise InputError(str(path), _("an animation is a .gif or a .mp4"), _("name such a file"))
    return kind


def size_of(size: Sequence[int] | str, kind: str, frames: int) -> tuple[int, int]:
    """Width and height in pixels, made even for MP4; raises InputError for another form, or for too much."""
    if isinstance(size, str):
        found = re.fullmatch(r"(\d{1,6})[xX×](\d{1,6})", size.strip())
        if found is None:
            what = _("expected WIDTHxHEIGHT, got {text}").format(text=f'"{size}"')
            raise InputError("size", what, _('write "800x600"'))
        size = (int(found[1]), int(found[2]))
    wide, high = size
    if not (LEAST_SIDE <= wide <= MOST_SIDE and LEAST_SIDE <= high <= MOST_SIDE):
        raise InputError(
            "size",
            _("a size of {wide} by {high} pixels is given").format(wide=wide, high=high),
            _("give {least} to {most} pixels in each direction").format(least=LEAST_SIDE, most=MOST_SIDE),
        )
    if wide * high * frames > MOST_PIXELS:
        raise InputError(
            "size",
            _("{frames} frames of {wide} by {high} pixels are too many").format(
                frames=frames, wide=wide, high=high
            ),
            _("give at most {most} frames of this size, or a smaller size").format(
                most=MOST_PIXELS // (wide * high)
            ),
        )
    return (wide + wide % 2, high + high % 2) if kind == ".mp4" else (wide, high)


# What is asked of an animation besides its layers, what was written, and the writing itself.


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
    loop : "round", "back" or "once"
        The last picture leads to the first in the same sense, or the motion runs there and back, or begins anew.
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


def write_stage(stage: Stage, path: Path, timing: Timing, said: Said = no_progress) -> None:
    """Write what a stage shows; the ending of the name decides how."""
    if path.suffix.lower() == ".mp4":
        write_mp4(path, stage.pictures(), stage.frames, timing.per_second, said)
    else:
        write_gif(path, stage.pictures(), stage.frames, timing.delays, said)
