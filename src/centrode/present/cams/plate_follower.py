"""The follower of a plate cam as it stands at the beginning of a turn: roller, edge or face, guide or pivot."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Circle

from centrode.cams.followers.geometry import Oscillating, Translating
from centrode.locale import _
from centrode.present import signs
from centrode.present.style import GROUND, INK, MUTED, PALETTE

if TYPE_CHECKING:
    from centrode.cams.followers.geometry import FollowerCam
    from centrode.present.scene import Array

GUIDE = 11.0
"""Length of the guide of a translating follower, over the size of a hinge."""
OVER = 0.12
"""How far a face goes on beyond the contact, over the base radius."""
SIZE = 0.016
"""Radius of a hinge's circle over the size of the cam."""
PEN: dict[str, Any] = {"color": PALETTE[2], "linewidth": 2.0, "zorder": 4, "solid_capstyle": "round"}


def draw_follower(axes: Axes, body: FollowerCam, factor: float) -> list[tuple[Artist, str]]:
    """Draw the follower at phi = 0; returns entries of a legend."""
    start = body.contact(np.zeros(1))
    reach = body.contact(np.linspace(0.0, body.edges[-1], 73)).place
    size = SIZE * factor * float(np.ptp(reach, axis=0).max())
    flat = math.isinf(body.touch.roller)
    touching = factor * start.centre[0]
    if isinstance(body.guide, Translating):
        if flat:
            touching = factor * np.array([body.guide.offset, body.guide.start])
        _stem(axes, body, factor, touching, size)
        if flat:
            ends = body.face.least - OVER * body.base_radius, body.face.greatest + OVER * body.base_radius
            axes.plot(*(touching + factor * np.array([[one, 0.0] for one in ends])).T, **PEN)
    else:
        pivot = factor * np.array([body.guide.distance, 0.0])
        if flat:
            _swinging_face(axes, body, body.guide, factor)
        else:
            axes.plot(*np.stack([pivot, touching]).T, **PEN)
        signs.fixed_hinge(axes, pivot, size)
    _tip(axes, body, factor, touching)
    return [(Line2D([], [], color=PALETTE[2], linewidth=2.0), _("follower"))]


def _stem(axes: Axes, body: FollowerCam, factor: float, foot: Array, size: float) -> None:
    """The axis, the stem and the walls of its guide."""
    # the guide stands above the highest place
    lift = factor * float(np.max(body.motion.lift(np.linspace(0.0, body.edges[-1], 721))[0]))
    roller = 0.0 if math.isinf(body.touch.roller) else factor * body.touch.roller
    low = foot + np.array([0.0, lift + roller + 2.0 * size])
    top = low + np.array([0.0, GUIDE * size])
    axes.plot(*np.stack([foot, top + np.array([0.0, 4.0 * size])]).T, **PEN)
    axes.plot(
        [foot[0]] * 2, [0.0, foot[1]], color=MUTED, linewidth=0.8, linestyle=(0, (6, 2, 1.5, 2)), zorder=1
    )
    for side in (-1.0, 1.0):
        beside = np.array([1.4 * side * size, 0.0])
        signs.ground(axes, low + beside, top + beside, np.array([side, 0.0]), size, GROUND)
    axes.update_datalim([tuple(top + np.array([0.0, 5.0 * size]))])


def _swinging_face(axes: Axes, body: FollowerCam, guide: Oscillating, factor: float) -> None:
    psi = guide.start
    normal, along = np.array([math.sin(psi), math.cos(psi)]), np.array([-math.cos(psi), math.sin(psi)])
    pivot = np.array([guide.distance, 0.0])
    foot = pivot - guide.face_offset * normal
    far = foot + (body.face.greatest + OVER * body.base_radius) * along
    axes.plot(*(factor * np.stack([pivot, foot, far])).T, **PEN)


def _tip(axes: Axes, body: FollowerCam, factor: float, place: Array) -> None:
    """The roller, or the point of a knife edge."""
    roller = body.touch.roller
    if math.isinf(roller):
        return
    if roller == 0.0:
        axes.plot(*place, marker="v", color=PALETTE[2], markersize=6, zorder=5)
        return
    centre = (float(place[0]), float(place[1]))
    axes.add_patch(
        Circle(centre, factor * roller, facecolor="none", edgecolor=PALETTE[2], linewidth=1.6, zorder=4)
    )
    axes.plot(*place, marker="+", color=INK, markersize=6, markeredgewidth=0.9, zorder=5)
