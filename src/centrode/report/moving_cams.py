"""Cams with their followers as shapes that move: profile, mark, roller, arm or face, stem."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure

from centrode.locale import _
from centrode.model.settings import Display
from centrode.present.animations.cams import GAP, WALLS, FollowerLayer
from centrode.present.animations.layers import View
from centrode.present.drawing import MARGIN
from centrode.present.style import GROUND, INK, MUTED, house_style
from centrode.render.document.blocks import Moving, Outline, shown
from centrode.render.document.figures import picture
from centrode.render.document.numbers import Numbers
from centrode.report.circles import AT_REST, LIFT, Array, Samples, circle, hatched

if TYPE_CHECKING:
    from centrode.cams.followers.geometry import FollowerCam
    from centrode.present.cams.driving_cam import DrivingCam

TURN = 180
"""Pictures of a turn."""
INCHES = 5.2
DIGITS = 4


def cam_shapes(cam: DrivingCam, samples: Samples, size: float) -> Iterator[Outline]:
    """A cam with what its follower touches it with, in units of the cam's picture; `size` is the radius of a hinge."""
    turned = (1.0 if cam.forward else -1.0) * cam.angles[samples]
    poses = np.column_stack([np.tile(cam.hub, (len(samples), 1)), turned])
    still = replace(cam, angles=np.zeros(1))
    profile = still.outline(0) - cam.hub
    yield Outline(profile, poses, MUTED, filled=True)
    closed = np.concatenate([profile, profile[:1], LIFT, still.mark(0) - cam.hub])
    yield Outline(closed, poses, INK)
    lines = np.array([cam.lines(int(sample)) for sample in samples])
    for k in range(lines.shape[1]):
        yield _rod(lines[:, k])
    rollers = [cam.roller(int(sample)) for sample in samples]
    if rollers[0] is not None:
        centres = np.array([one[0] for one in rollers if one is not None])
        yield Outline(
            circle(rollers[0][1]), np.column_stack([centres, np.zeros(len(centres))]), INK, white=True
        )
    yield Outline(circle(size) + cam.hub, AT_REST, GROUND, white=True, behind=False)


def _rod(ends: Array) -> Outline:
    """A straight body from its two ends (samples, 2, 2)."""
    way = ends[:, 1] - ends[:, 0]
    length = float(np.hypot(*way[0]))
    poses = np.column_stack([ends[:, 0], np.arctan2(way[:, 1], way[:, 0])])
    return Outline(np.array([[0.0, 0.0], [length, 0.0]]), poses, INK)


def moving_follower(body: FollowerCam, title: str = "") -> Moving:
    """A cam that turns under its follower, to be played; its mark can be dragged around.

    Parameters
    ----------
    body : FollowerCam
        Of `follower_cam`.
    title : str
        Of the cam, as its user wrote it.
    """
    angles = math.tau * np.arange(TURN + 1) / TURN
    layer = FollowerLayer(body, angles, 1.0)
    cam, samples = layer.cam, np.arange(TURN + 1)
    reach = layer.reach()
    low, high = reach.min(axis=0), reach.max(axis=0)
    view = View(low, high, float(np.max(high - low)) / INCHES)
    layer.stand(view)
    size = view.sign
    tips = np.array([cam.foot(int(sample)) for sample in samples])
    marks = np.array([cam.mark(int(sample))[1] for sample in samples])
    places = {"O": np.zeros((1, 2)), "K": marks, "A": tips}
    bodies = {"cam": ("O", "K")}
    loose = ["K", *(["A"] if not 0.0 < body.touch.roller < math.inf else [])]
    if cam.pivot is not None:
        places["C"] = cam.pivot[None]
        if math.isfinite(body.touch.roller):
            bodies["arm"] = ("C", "A")
    shapes = list(cam_shapes(cam, samples, size))
    if cam.pivot is None:
        shapes += _stem(layer, tips)
    numbers = Numbers(Display(), DIGITS)
    degrees = numbers.column(np.degrees(angles).tolist(), least=1e-9)
    return Moving(
        places=places,
        bodies=bodies,
        fixed=("O", "C") if cam.pivot is not None else ("O",),
        guides={},
        sliders={},
        drive=angles,
        drive_texts=tuple(f"φ = {one}°" for one in degrees),
        tracks=(),
        still=picture(_still(layer, view), ""),
        caption=_("Motion of {title}").format(title=shown(title) or _("the cam and its follower")),
        shapes=tuple(shapes),
        driven=("K",),
        dots=tuple(loose),
        box=np.array([low, high]),
    )


def _stem(layer: FollowerLayer, tips: Array) -> Iterator[Outline]:
    """The stem of a translating follower, and the walls of its guide."""
    poses = np.column_stack([tips, np.zeros(len(tips))])
    yield Outline(np.array([[0.0, 0.0], [0.0, layer.stem]]), poses, INK)
    low = layer.top + GAP * layer.far
    for side in (-1.0, 1.0):
        x = tips[0, 0] + 1.2 * side * layer.size
        ends = np.array([x, low]), np.array([x, low + WALLS * layer.far])
        yield Outline(hatched(*ends, np.array([side, 0.0]), layer.size), AT_REST, GROUND)


def _still(layer: FollowerLayer, view: View) -> Figure:
    """The cam and its follower at the beginning of a turn."""
    room = MARGIN * float(np.max(view.high - view.low))
    low, high = view.low - room, view.high + room
    with house_style():
        wide, tall = INCHES * (high - low) / float(np.max(high - low))
        figure = Figure(figsize=(wide, tall))
        axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
        axes.set_aspect("equal")
        axes.set_xlim(low[0], high[0])
        axes.set_ylim(low[1], high[1])
        layer.ground(axes)
        layer.draw(axes, 0)
        axes.set_axis_off()
    return figure
