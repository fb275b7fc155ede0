"""The animation of a cam: a walking wheel's step, or a turn below the roller."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

from centrode.cams.profiles.bodies import cam_body
from centrode.cams.profiles.tables import walking_wheel
from centrode.errors import InputError
from centrode.locale import _
from centrode.model.cams.description import Cam
from centrode.present.animations.cams import TurningCamLayer, WalkingLayer
from centrode.present.animations.captions import turned_caption
from centrode.present.animations.encoding import Said
from centrode.present.animations.layers import Layer
from centrode.present.animations.paces import Animation, Pace, write_stage
from centrode.present.animations.stage import Stage
from centrode.present.animations.timing import size_of
from centrode.present.shown import shown_as
from centrode.study.moving.films import frame_ways


def animate_cam(
    cam: Cam, path: Path, pace: Pace, size: Sequence[int] | str, dark: bool, said: Said
) -> Animation:
    """A step of the walking wheel, or a turn of the cam; an open cam runs there and back."""
    if pace.speed is not None:
        raise InputError("speed", _("a cam has no speed of its own"), _("ask for a duration instead"))
    timing = pace.timing(path.suffix.lower(), 1.0)
    pixels = size_of(size, path.suffix.lower(), timing.frames)
    factor = shown_as("m", cam.display)[0]
    loop = "round"
    layer: Layer
    if cam.mover is not None:
        wheel = walking_wheel(cam)
        angles = -wheel.half + math.tau / wheel.legs * frame_ways("round", timing.frames)
        layer = WalkingLayer(wheel, angles, factor)
    else:
        body = cam_body(cam)
        first, last = body.closed.start, body.closed.stop
        loop = "round" if last - first >= math.tau * (1.0 - 1e-9) else "back"
        angles = first + (last - first) * frame_ways("round" if loop == "round" else "back", timing.frames)
        layer = TurningCamLayer(body, angles, factor)
    captions = [turned_caption(float(angle), cam.display) for angle in angles]
    stage = Stage([layer], timing.frames, pixels, _(cam.title), lambda frame: captions[frame], dark=dark)
    write_stage(stage, path, timing, said)
    return Animation(path, timing.frames, timing.per_second, pixels, loop)
