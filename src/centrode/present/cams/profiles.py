"""A cam on paper: roller's path, profile, groove, normals, rollers at the joints, centre."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle

from centrode.cams.followers.geometry import Oscillating, Translating
from centrode.locale import _, mark
from centrode.present import signs
from centrode.present.cams.outlines import GREY, STROKES, group_by_layer
from centrode.present.curves import write_legend, write_title
from centrode.present.displayed_units import label_with_unit, shown_as
from centrode.present.signs import cross, turning_arrow
from centrode.present.style import GROUND, INK, MUTED, PALETTE, house_style

if TYPE_CHECKING:
    from centrode.cams.followers.geometry import FollowerCam
    from centrode.cams.profiles import CamOutline
    from centrode.model.cam_files import AnyCam
    from centrode.model.mechanism import Display
    from centrode.present.scene import Array

ROOM = 0.06
LAYERS = {
    "path": mark("path of the roller's centre"),
    "profile": mark("profile of the cam"),
    "cutter": mark("path of the cutter's centre"),
    "profile-working": mark("profile, working arc"),
    "profile-return": mark("profile, return arc"),
    "groove-working": mark("outer wall, working arc"),
    "groove-return": mark("outer wall, return arc"),
}
UNDERCUT = "#B00020"


def draw_outlines(axes: Axes, outlines: Sequence[CamOutline], factor: float) -> list[tuple[Line2D, str]]:
    """Draw pieces of outlines in the strokes of their layers; returns entries of a legend."""
    keys = []
    for layer, pieces in group_by_layer(outlines).items():
        for one in pieces:
            (line,) = axes.plot(*(factor * one.places.T), **STROKES[layer].drawn, zorder=3)
        keys.append((line, _(LAYERS.get(layer, layer))))
    return keys


def finish(axes: Axes, across: str, up: str) -> None:
    """Equal scales and some room around."""
    axes.set_aspect("equal", adjustable="datalim")
    axes.margins(ROOM)
    axes.set_xlabel(across)
    axes.set_ylabel(up)


# The follower of a plate cam as it stands at the beginning of a turn: roller, edge or face, guide or pivot.

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


# A plate cam with its follower on paper: profile, path, cutter, normals, where segments meet, undercut.

Keys: TypeAlias = list[tuple[Artist, str]]
PLATE_NORMALS = 36
"""Normals over the turn."""
MOST_MARKS = 16
"""Joints that are named at most."""
LENGTH = 0.18
"""Of a normal where there is no roller, over the base radius."""
NAME = 0.08
"""How far the name of a joint stands from it, over the size of the cam."""
ARROW = 0.3
"""Radius of the arrow that tells how the cam turns, over the base radius."""


def follower_cam_figure(
    body: FollowerCam, outlines: Sequence[CamOutline], title: str = "", display: Display | None = None
) -> Figure:
    """The cam in its axes with the follower at the beginning of the turn.

    Parameters
    ----------
    body : FollowerCam
        Of `follower_cam`.
    outlines : sequence of CamOutline
        Of `follower_outlines`.
    title : str
        Stands below what the figure shows.
    display : Display, optional
        Its unit of length; metres if left out.
    """
    factor, unit = shown_as("m", display)
    with house_style():
        figure = Figure(figsize=(8.6, 6.2), layout="constrained")
        axes = figure.subplots()
        keys: Keys = [*draw_outlines(axes, outlines, factor)]
        keys.append((_base_circle(axes, body, factor), _("base circle")))
        keys.append((_plate_normals(axes, body, factor), _("normals")))
        keys.append((_joints(axes, body, factor), _("segments meet: angle of the cam")))
        keys += draw_follower(axes, body, factor)
        keys += _plate_undercut(axes, body, factor)
        size = 0.012 * factor * float(np.ptp(np.concatenate([one.places for one in outlines]), axis=0).max())
        cross(axes, np.zeros(2), size, INK)
        keys.append((Line2D([], [], color=INK, marker="x", linestyle="none"), _("centre of the cam")))
        _arrow(axes, body, factor)
        finish(axes, label_with_unit("x", unit), label_with_unit("y", unit))
        write_legend(axes, keys, inches=5.2)
        write_title(figure, _("Profile of the cam, and its follower at 0°"), title)
    return figure


def _base_circle(axes: Axes, body: FollowerCam, factor: float) -> Line2D:
    dashes = (0, (1.2, 2.0))
    axes.add_patch(
        Circle(
            (0.0, 0.0), factor * body.base_radius, fill=False, edgecolor=GREY, linewidth=0.9, linestyle=dashes
        )
    )
    return Line2D([], [], color=GREY, linewidth=0.9, linestyle=dashes)


def _plate_normals(axes: Axes, body: FollowerCam, factor: float) -> Line2D:
    """From the profile to the roller's centre, else a piece of the same length all round."""
    roller = body.touch.roller
    length = roller if 0.0 < roller < math.inf else LENGTH * body.base_radius
    found = body.contact(body.edges[-1] * np.arange(PLATE_NORMALS) / PLATE_NORMALS)
    for foot, normal in zip(found.place, found.normal, strict=True):
        ends = factor * np.stack([foot, foot + length * normal])
        axes.plot(*ends.T, color=MUTED, linewidth=0.6, zorder=2)
    return Line2D([], [], color=MUTED, linewidth=0.6)


def _joints(axes: Axes, body: FollowerCam, factor: float) -> Line2D:
    """Contacts where segments meet, with the cam's angle, inside the profile."""
    joints = np.array(getattr(body.motion, "joints", body.edges)[:-1][:MOST_MARKS])
    found = body.contact(joints)
    away = NAME * float(np.ptp(found.place, axis=0).max() + body.base_radius)
    for at, place, normal in zip(joints, found.place, found.normal, strict=True):
        axes.plot(*(factor * place), marker="o", color=INK, markersize=3.5, zorder=6)
        x, y = factor * (place - away * normal)
        name = f"{math.degrees(at):.4g}°"
        axes.text(x, y, name, fontsize=8, color=INK, ha="center", va="center", zorder=6)
    return Line2D([], [], color=INK, marker="o", linestyle="none", markersize=3.5)


def _plate_undercut(axes: Axes, body: FollowerCam, factor: float) -> Keys:
    """Stretches that run back, and corners that are cut away, over everything."""
    edges = body.edges
    keys: Keys = []
    for one in body.undercuts:
        if one.stop == one.start:
            place = factor * body.contact(np.array([one.start])).place[0]
            axes.plot(*place, marker="s", markersize=5, color=UNDERCUT, zorder=6)
        for turn in (0.0, math.tau):
            cuts = [one.start - turn, *(edge for edge in edges if one.start - turn < edge < one.stop - turn)]
            for low, high in pairwise([*cuts, one.stop - turn]):
                first, last = max(low, edges[0]), min(high, edges[-1])
                if first < last:
                    phi = np.linspace(first, np.nextafter(last, first), 200)
                    axes.plot(*(factor * body.contact(phi).place.T), color=UNDERCUT, linewidth=2.4, zorder=5)
    if body.undercuts:
        keys.append((Line2D([], [], color=UNDERCUT, linewidth=2.4), _("undercut")))
    return keys


def _arrow(axes: Axes, body: FollowerCam, factor: float) -> None:
    """How the cam turns."""
    turn = np.linspace(0.25 * math.pi, 0.75 * math.pi, 25)[:: int(body.sense)]
    arc = ARROW * factor * body.base_radius * np.stack([np.cos(turn), np.sin(turn)], axis=-1)
    turning_arrow(axes, np.asarray(arc), INK)


# Figures of a cam's profile and of the walking wheel, of a cam's results.


def cam_body_figures(cam: AnyCam, objects: Mapping[str, Any]) -> dict[str, Figure]:
    """Figures of the cam's profile and of the walking wheel, by name, of what there is."""
    found = {}
    if "plate" in objects:
        found["cam-body"] = follower_cam_figure(
            objects["plate"], objects["plate_outlines"], _(cam.title), cam.display
        )
    return found
