"""The walking wheel's animation: a step that runs on, as its picture after a step is its picture before it."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from PIL import Image

import centrode as ct
from centrode.cams.profiles.tables import walking_wheel
from centrode.present.cams.walking_animation import _drawn, animate_walking
from centrode.present.style import house_style

WHEELS = ["walking-wheel-four-legs", "walking-wheel-three-legs"]


def pixels(wheel: object, turned: float) -> np.ndarray:
    with house_style():
        figure = _drawn(wheel, turned, 1e3, "")
        canvas = FigureCanvasAgg(figure)
        canvas.draw()
        return np.asarray(canvas.buffer_rgba()).astype(int)[..., :3]


@pytest.mark.parametrize("name", WHEELS)
def test_a_step_leads_to_the_next(name: str) -> None:
    """All legs, the ground and the footprints stand as they stood a step before, but for rounding at edges."""
    wheel = walking_wheel(ct.example(name))
    begin = 0.3 * wheel.half
    before, after, between = (
        pixels(wheel, begin + share * math.tau / wheel.legs) for share in (0.0, 1.0, 0.5)
    )
    apart = np.abs(before - after).max(axis=2)
    assert (apart > 40).mean() < 1e-4
    assert (np.abs(before - between).max(axis=2) > 40).mean() > 0.02


def test_the_animation_is_written(tmp_path: Path) -> None:
    cam = ct.example(WHEELS[1])
    said: list[tuple[int, int]] = []
    for dark in (False, True):
        path = tmp_path / f"{dark}.gif"
        animate_walking(
            walking_wheel(cam),
            path,
            cam.title,
            cam.display,
            frames=4,
            dark=dark,
            said=lambda *at: said.append(at),
        )
        with Image.open(path) as picture:
            assert picture.n_frames == 4
            corner = picture.convert("RGB").getpixel((2, 2))
        assert (max(corner) < 64) == dark
    assert said == [(k, 4) for k in range(1, 5)] * 2
