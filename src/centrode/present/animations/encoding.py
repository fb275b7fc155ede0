"""Pictures as a file: GIF by a palette of all frames, MP4 by ffmpeg; it appears whole or not at all."""

from __future__ import annotations

import functools
import importlib
import subprocess
import tempfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from centrode.errors import InputError
from centrode.files.drafts import draft_file
from centrode.locale import _
from centrode.present.animations.palette import Palette
from centrode.present.animations.stage import Pixels

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
            _('install it with pip install "centrode[video]", or name a .gif'),
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
        raise InputError("", _("ffmpeg refused: {reason}").format(reason=reason), _("write a .gif instead"))
