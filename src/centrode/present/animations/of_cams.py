"""The animation of a cam: a walking wheel's step, or a turn below the roller or the follower."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

from centrode.cams.followers.base_circle import follower_cam
from centrode.cams.profiles import cam_body
from centrode.cams.results import walking_wheel
from centrode.errors import InputError
from centrode.locale import _
from centrode.model.cam_files import AnyCam, require_curvature_cam
from centrode.model.follower_cam import PlateCam
from centrode.present.animations.cams import loop_of, roller_stage, walking_stage
from centrode.present.animations.encoding import Said
from centrode.present.animations.followers import follower_stage
from centrode.present.animations.paces import Animation, Pace, write_stage
from centrode.present.animations.stage import Stage
from centrode.present.animations.timing import size_of
from centrode.study.moving.courses import Loop


def animate_cam(
    cam: AnyCam, path: Path, pace: Pace, size: Sequence[int] | str, dark: bool, said: Said
) -> Animation:
    """A step of the walking wheel, or a turn of the cam; an open cam runs there and back."""
    timing = pace.timing(path.suffix.lower(), _period(cam, pace))
    pixels = size_of(size, path.suffix.lower(), timing.frames)
    stage, loop = _staged(cam, timing.frames, pixels, dark)
    write_stage(stage, path, timing, said)
    return Animation(path, timing.frames, timing.per_second, pixels, loop)


def _staged(cam: AnyCam, frames: int, size: tuple[int, int], dark: bool) -> tuple[Stage, Loop]:
    """The stage of a cam, and how it runs on."""
    title, display = _(cam.title), cam.display
    if isinstance(cam, PlateCam):
        return follower_stage(follower_cam(cam), frames, size, title, display, dark=dark), "round"
    if require_curvature_cam(cam).mover is not None:
        return walking_stage(walking_wheel(cam), frames, size, title, display, dark=dark), "round"
    body = cam_body(cam)
    return roller_stage(body, frames, size, title, display, dark=dark), loop_of(body)


def _period(cam: AnyCam, pace: Pace) -> float:
    """How long a turn of the cam takes [s], where that is asked for."""
    speed = cam.body.speed if isinstance(cam, PlateCam) else None
    if speed is not None:
        return math.tau / speed
    if pace.speed is not None:
        raise InputError("speed", _("a cam has no speed of its own"), _("ask for a duration instead"))
    return 1.0
