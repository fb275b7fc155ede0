"""The animation of a cam: a walking wheel's step, or a turn below the roller or the follower."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

from centrode.cams.followers.described import follower_cam
from centrode.cams.profiles.bodies import cam_body
from centrode.cams.profiles.tables import walking_wheel
from centrode.errors import InputError
from centrode.locale import _
from centrode.model.cams.description import Cam
from centrode.model.cams.files import AnyCam, curved
from centrode.model.cams.plate import PlateCam
from centrode.present.animations.cams import TurningCamLayer, WalkingLayer
from centrode.present.animations.captions import turned_caption
from centrode.present.animations.encoding import Said
from centrode.present.animations.followers import follower_stage
from centrode.present.animations.layers import Array, Layer
from centrode.present.animations.paces import Animation, Pace, write_stage
from centrode.present.animations.stage import Stage
from centrode.present.animations.timing import size_of
from centrode.present.shown import shown_as
from centrode.study.moving.courses import Loop
from centrode.study.moving.films import frame_ways


def animate_cam(
    cam: AnyCam, path: Path, pace: Pace, size: Sequence[int] | str, dark: bool, said: Said
) -> Animation:
    """A step of the walking wheel, or a turn of the cam; an open cam runs there and back."""
    body = follower_cam(cam) if isinstance(cam, PlateCam) else None
    timing = pace.timing(path.suffix.lower(), _period(cam, pace))
    pixels = size_of(size, path.suffix.lower(), timing.frames)
    loop = "round"
    if body is not None:
        stage = follower_stage(body, timing.frames, pixels, _(cam.title), cam.display, dark=dark)
    else:
        layer, angles, loop = _of_curvature(curved(cam), timing.frames)
        captions = [turned_caption(float(angle), cam.display) for angle in angles]
        stage = Stage([layer], timing.frames, pixels, _(cam.title), lambda frame: captions[frame], dark=dark)
    write_stage(stage, path, timing, said)
    return Animation(path, timing.frames, timing.per_second, pixels, loop)


def _period(cam: AnyCam, pace: Pace) -> float:
    """How long a turn of the cam takes [s], where that is asked for."""
    speed = cam.body.speed if isinstance(cam, PlateCam) else None
    if speed is not None:
        return math.tau / speed
    if pace.speed is not None:
        raise InputError("speed", _("a cam has no speed of its own"), _("ask for a duration instead"))
    return 1.0


def _of_curvature(cam: Cam, frames: int) -> tuple[Layer, Array, str]:
    """The layer of a cam by its curvature, the angles of its frames, and how they run on."""
    factor = shown_as("m", cam.display)[0]
    if cam.mover is not None:
        wheel = walking_wheel(cam)
        angles = -wheel.half + math.tau / wheel.legs * frame_ways("round", frames)
        return WalkingLayer(wheel, angles, factor), angles, "round"
    body = cam_body(cam)
    first, last = body.closed.start, body.closed.stop
    loop: Loop = "round" if last - first >= math.tau * (1.0 - 1e-9) else "back"
    angles = first + (last - first) * frame_ways(loop, frames)
    return TurningCamLayer(body, angles, factor), angles, loop
