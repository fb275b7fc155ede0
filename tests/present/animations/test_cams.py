"""Cams in motion: a walking wheel's step runs on; a cam turns below its roller, which stays on its ray."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle
from PIL import Image

import centrode as ct
from centrode.cams.profiles import cam_body
from centrode.present.animations.animate import Shown, animate_walking
from centrode.present.animations.cams import TurningCamLayer, WalkingLayer
from centrode.present.animations.layers import View
from centrode.present.animations.stage import Stage
from centrode.present.animations.video_files import Pace

EPS = float(np.finfo(float).eps)
WHEELS = ["walking-wheel-four-legs", "walking-wheel-three-legs"]
CAM = """
kind = "cam"
title = "Closed by a return arc"
display = { length = "mm", angle = "deg" }
curvature = { law = "exponential", k0 = "0.01 1/mm", k1 = 0.75 }
start = { radius = "50 mm", pressure_angle = 0 }
range = { to = "60 deg" }
roller = { radius = "8 mm" }
"""


@pytest.mark.parametrize("name", WHEELS)
def test_a_step_leads_to_the_next(name: str) -> None:
    """All legs, the ground and the footprints stand as they stood a step before, but for rounding at edges."""
    wheel = ct.walking_wheel(ct.example(name))
    turned = 0.3 * wheel.half + np.array([0.0, 1.0, 0.5]) * math.tau / wheel.legs
    pictures = list(Stage([WalkingLayer(wheel, turned, 1e3)], 3, (480, 400)).pictures())[1:]
    before, after, between = (
        one.view(np.uint8).reshape(*one.shape, 4)[..., :3].astype(int) for one in pictures
    )
    apart = np.abs(before - after).max(axis=2)
    assert (apart > 40).mean() < 1e-4
    assert (np.abs(before - between).max(axis=2) > 40).mean() > 0.02


def test_a_walking_wheel_is_written(tmp_path: Path) -> None:
    cam = ct.example(WHEELS[1])
    said: list[tuple[int, int]] = []
    for dark in (False, True):
        path = tmp_path / f"{dark}.gif"
        animate_walking(
            ct.walking_wheel(cam),
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


def axes_in(layer: TurningCamLayer) -> Axes:
    places = layer.reach()
    layer.stand(View(places.min(axis=0), places.max(axis=0), float(np.ptp(places)) / 5.0))
    return Figure().add_axes((0.0, 0.0, 1.0, 1.0))


def test_the_roller_stays_on_its_ray_and_touches_the_cam() -> None:
    """Its centre is above the hub at the polar radius; no point of the profile is nearer than the roller's radius."""
    body = cam_body(ct.parse_cam(CAM + "return = {}"))
    angles = body.closed.start + math.tau * np.arange(9) / 9
    layer = TurningCamLayer(body, angles, 1e3)
    radius = 1e3 * body.closed.radius(angles)[0]
    for frame in range(9):
        axes = axes_in(layer)
        layer.draw(axes, frame)
        roller = next(one for one in axes.patches if isinstance(one, Circle))
        x, y = roller.center
        room = 16 * EPS * radius[frame]
        assert abs(x) <= room
        assert abs(y - radius[frame]) <= room
        profile = layer.at(layer.profile, frame)
        gap = np.hypot(*(profile - [x, y]).T).min() - roller.radius
        # the profile is sampled each half degree: between samples the nearest point is missed by half their distance
        step = np.hypot(*np.diff(profile, axis=0).T).max()
        assert -1e-9 <= gap <= (step / 2) ** 2 / roller.radius


@pytest.mark.parametrize(("more", "loop"), [("return = {}", "round"), ("", "back")])
def test_an_open_cam_runs_there_and_back(tmp_path: Path, more: str, loop: str) -> None:
    made = ct.animate(ct.parse_cam(CAM + more), tmp_path / "cam.gif", pace=Pace(frames=6), size=(160, 120))
    assert (made.loop, made.frames) == (loop, 6)
    with Image.open(tmp_path / "cam.gif") as picture:
        assert picture.n_frames == 6


def test_what_a_cam_does_not_show_is_refused(tmp_path: Path) -> None:
    cam, path = ct.example("walking-wheel-four-legs"), tmp_path / "cam.gif"
    for refused in ({"shown": Shown()}, {"start": 0.0}, {"stop": 1.0}):
        with pytest.raises(ct.InputError, match="a cam is shown as a whole"):
            ct.animate(cam, path, **refused)
    with pytest.raises(ct.InputError, match="a cam has no speed of its own"):
        ct.animate(cam, path, pace=Pace(speed=1.0))
    with pytest.raises(ct.InputError, match="a profile needs a roller"):
        ct.animate(ct.example("cam-from-curvature"), path)
    assert list(tmp_path.iterdir()) == []
