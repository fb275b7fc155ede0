"""How many frames, how fast and how large: what is asked for, checked and completed."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

from centrode.errors import InputError
from centrode.locale import _

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
                "speed", _("the motion takes no time of its own"), _("ask for a duration instead")
            )
    if length is None:
        return Timing(frames or FRAMES, fps or PER_SECOND)
    if frames is not None:
        rate = frames / length
        if not LEAST_RATE <= rate <= FASTEST[kind]:
            what = _("{frames} frames in {length:.4g} s are {rate:.4g} a second").format(
                frames=frames, length=length, rate=rate
            )
            raise InputError("frames", what, _rates(kind))
        return Timing(frames, rate)
    rate = fps or PER_SECOND
    count = round(length * rate)
    if not 2 <= count <= MOST_FRAMES:
        what = _("{length:.4g} s at {rate:g} frames a second are {count} frames").format(
            length=length, rate=rate, count=count
        )
        raise InputError("fps", what, _("ask for 2 to {most} frames").format(most=MOST_FRAMES))
    return Timing(count, rate)


def check_timing(
    kind: str, frames: int | None, fps: float | None, duration: float | None, speed: float | None
) -> None:
    """Refuse what is out of bounds or given twice, whatever the mechanism's own time is."""
    if duration is not None and speed is not None:
        raise InputError("speed", _("duration and speed say the same thing"), _("take one of the two out"))
    if frames is not None and fps is not None and (duration is not None or speed is not None):
        what = _("frames, frames a second and how long they take are given at once")
        raise InputError("fps", what, _("take one of the three out"))
    if frames is not None and (isinstance(frames, bool) or not 2 <= frames <= MOST_FRAMES):
        what = _("{count} frames were asked for").format(count=frames)
        raise InputError("frames", what, _("ask for 2 to {most} frames").format(most=MOST_FRAMES))
    if fps is not None and not LEAST_RATE <= fps <= FASTEST[kind]:
        what = _("{rate:g} frames a second were asked for").format(rate=fps)
        raise InputError("fps", what, _rates(kind))
    for name, value in (("duration", duration), ("speed", speed)):
        if value is not None and not (math.isfinite(value) and value > 0.0):
            raise InputError(name, _("it must be greater than zero"))


def _rates(kind: str) -> str:
    return _("ask for {least:g} to {most:g} frames a second").format(least=LEAST_RATE, most=FASTEST[kind])


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
            _("{wide} by {high} pixels were asked for").format(wide=wide, high=high),
            _("ask for {least} to {most} pixels each way").format(least=LEAST_SIDE, most=MOST_SIDE),
        )
    if wide * high * frames > MOST_PIXELS:
        raise InputError(
            "size",
            _("{frames} frames of {wide} by {high} pixels are too much").format(
                frames=frames, wide=wide, high=high
            ),
            _("ask for at most {most} frames of this size, or for smaller ones").format(
                most=MOST_PIXELS // (wide * high)
            ),
        )
    return (wide + wide % 2, high + high % 2) if kind == ".mp4" else (wide, high)
