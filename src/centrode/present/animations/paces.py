"""What is asked of an animation besides its layers, what was written, and the writing itself."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from centrode.present.animations.encoding import Said, no_progress, write_gif, write_mp4
from centrode.present.animations.stage import Stage
from centrode.present.animations.timing import Timing, timing_of


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


def write_stage(stage: Stage, path: Path, timing: Timing, said: Said = no_progress) -> None:
    """Write what a stage shows; the ending of the name decides how."""
    if path.suffix.lower() == ".mp4":
        write_mp4(path, stage.pictures(), stage.frames, timing.per_second, said)
    else:
        write_gif(path, stage.pictures(), stage.frames, timing.delays, said)
