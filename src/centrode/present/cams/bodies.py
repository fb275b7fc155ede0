"""Figures of a cam's profile and of the walking wheel, of a cam's results."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from matplotlib.figure import Figure

from centrode.locale import _
from centrode.present.cams.plate_drawing import follower_cam_figure
from centrode.present.cams.profile_drawing import profile_figure
from centrode.present.cams.walking_drawing import walking_figure

if TYPE_CHECKING:
    from centrode.model.cam_files import AnyCam

INSTANTS = 6
"""Instants over a step, where the description names none."""


def cam_body_figures(cam: AnyCam, objects: Mapping[str, Any], *, groove: bool = False) -> dict[str, Figure]:
    """Figures of the cam's profile and of the walking wheel, by name, of what there is."""
    found = {}
    if "body" in objects:
        found["cam-body"] = profile_figure(objects["body"], _(cam.title), cam.display, groove=groove)
    if "plate" in objects:
        found["cam-body"] = follower_cam_figure(
            objects["plate"], objects["plate_outlines"], _(cam.title), cam.display
        )
    if "wheel" in objects:
        wheel = objects["wheel"]
        pitch = math.tau / wheel.legs
        even = [pitch * (number / (INSTANTS - 1) - 0.5) for number in range(INSTANTS)]
        found["walking-wheel"] = walking_figure(wheel, cam.study.instants or even, _(cam.title), cam.display)
    return found
