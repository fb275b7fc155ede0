"""Animations: pictures that a drawing function makes one after the other, as one GIF that runs on and on."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray
from PIL import Image

from centrode.present.dark import darkened
from centrode.present.style import house_style

Array = NDArray[np.float64]

MILLISECONDS = 70
"""A frame is shown so long."""
SCREEN_DPI = 90
COLOURS = 256
EXACT = 48
"""Of these the commonest of all frames are kept as they are: paper stays white."""
SAMPLES = 6
"""Frames that the colours of all frames are taken from."""


def no_progress(_done: int, _of: int) -> None:
    """Say nothing."""


def loop_places(start: float, period: float, frames: int) -> Array:
    """Places of the frames of a loop: evenly over a period, without its end, which is the beginning again."""
    return np.asarray(start + period * np.arange(frames) / frames)


def write_animation(
    path: Path,
    draw: Callable[[Any], Figure],
    places: Sequence[Any] | Array,
    *,
    milliseconds: int = MILLISECONDS,
    dark: bool = False,
    said: Callable[[int, int], None] = no_progress,
) -> None:
    """Write an animation (GIF) that starts over at its end; the same pictures give the same bytes.

    Parameters
    ----------
    path : Path
        The file.
    draw : callable
        A figure of a place; all of them of one size. It is called in the house style.
    places : sequence
        What `draw` is called with, frame by frame. A loop is without a jump where the picture of the place after
        the last one is the first picture.
    milliseconds : int
        How long a frame is shown.
    dark : bool
        Light lines on a dark ground.
    said : callable
        Told after each frame how many are done, and of how many.
    """
    frames = []
    with house_style():
        for number, place in enumerate(places, start=1):
            frames.append(_picture(draw(place), dark))
            said(number, len(places))
    colours = _palette(frames)
    shown = [_in_colours(frame, colours) for frame in frames]
    shown[0].save(path, save_all=True, append_images=shown[1:], duration=milliseconds, loop=0)


def _picture(figure: Figure, dark: bool) -> Image.Image:
    figure.set_dpi(SCREEN_DPI)
    canvas: Any = FigureCanvasAgg(darkened(figure) if dark else figure)
    canvas.draw()
    return Image.fromarray(np.asarray(canvas.buffer_rgba())[..., :3].copy())


def _palette(frames: Sequence[Image.Image]) -> Array:
    """One palette (n, 3) for all frames, so that no colour flickers: the commonest colours as they are, others cut."""
    chosen = np.unique(np.linspace(0, len(frames) - 1, SAMPLES).astype(int))
    width, height = frames[0].size
    sheet = Image.new("RGB", (width, height * len(chosen)))
    for row, number in enumerate(chosen):
        sheet.paste(frames[number], (0, row * height))
    counted: Any = sheet.getcolors(sheet.width * sheet.height)
    common = [colour for _count, colour in sorted(counted, reverse=True)[:EXACT]]
    cut = sheet.quantize(COLOURS - len(common), dither=Image.Dither.NONE).getpalette() or []
    return np.array([*common, *zip(*[iter(cut)] * 3, strict=False)], dtype=float)[:COLOURS]


def _in_colours(frame: Image.Image, colours: Array) -> Image.Image:
    """A frame in the nearest colours of the palette; pillow's own search is by cells of four levels."""
    levels = np.asarray(frame).astype(np.int64)
    packed = (levels[..., 0] << 16) + (levels[..., 1] << 8) + levels[..., 2]
    each, where = np.unique(packed, return_inverse=True)
    places = np.stack([each >> 16, each >> 8 & 255, each & 255], axis=1)
    nearest = np.argmin(((places[:, None] - colours[None]) ** 2).sum(axis=2), axis=1)
    picture = Image.fromarray(nearest[where].reshape(packed.shape).astype(np.uint8))
    picture.putpalette(colours.astype(int).reshape(-1).tolist())
    return picture
