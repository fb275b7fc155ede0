"""Pictures as a file: GIF by a palette of all frames, MP4 by ffmpeg; it appears whole or not at all."""

from __future__ import annotations

import functools
import importlib
import os
import tempfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from centrode.errors import InputError
from centrode.locale import _
from centrode.present.animations.palette import Palette
from centrode.present.animations.stage import Pixels

Said = Callable[[int, int], None]

_ffmpeg = functools.partial(importlib.import_module, "imageio_ffmpeg")
X264 = [
    "-crf",
    "18",
    "-preset",
    "medium",
    "-movflags",
    "+faststart",
    "-fflags",
    "+bitexact",
    "-flags:v",
    "+bitexact",
]


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
    with appearing(path) as draft:
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
    ground = next(pictures)
    high, wide = ground.shape
    with appearing(path) as draft:
        writer: Any = _ffmpeg().write_frames(
            str(draft), (wide, high), pix_fmt_in="rgba", pix_fmt_out="yuv420p", fps=fps, codec="libx264",
            quality=None, macro_block_size=2, ffmpeg_log_level="error", output_params=X264,
        )  # fmt: skip
        writer.send(None)
        try:
            for number, picture in enumerate(pictures, start=1):
                writer.send(picture.tobytes())
                said(number, frames)
        finally:
            writer.close()


@contextmanager
def appearing(path: Path) -> Iterator[Path]:
    """A file to write that takes the place of `path` when the block ends, and is gone where it raises."""
    handle, name = tempfile.mkstemp(prefix=".centrode-", suffix=path.suffix, dir=path.parent)
    os.close(handle)
    try:
        yield Path(name)
        mask = os.umask(0)
        os.umask(mask)
        os.chmod(name, 0o666 & ~mask)
        os.replace(name, path)
    except BaseException:
        with suppress(OSError):
            os.unlink(name)
        raise
