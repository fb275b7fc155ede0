"""A plate cam with its follower on paper: profile, path, cutter, normals, where segments meet, undercut."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle

from centrode.locale import _
from centrode.present.cams.outline_strokes import GREY
from centrode.present.cams.plate_follower import draw_follower
from centrode.present.cams.profile_drawing import UNDERCUT, draw_outlines, finish
from centrode.present.curves import write_legend, write_title
from centrode.present.shown import labelled, shown_as
from centrode.present.signs import cross, turning_arrow
from centrode.present.style import INK, MUTED, house_style

if TYPE_CHECKING:
    from centrode.cams.followers.geometry import FollowerCam
    from centrode.cams.profiles import CamOutline
    from centrode.model.mechanism import Display

Keys: TypeAlias = list[tuple[Artist, str]]
NORMALS = 36
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
        keys.append((_normals(axes, body, factor), _("normals")))
        keys.append((_joints(axes, body, factor), _("segments meet: angle of the cam")))
        keys += draw_follower(axes, body, factor)
        keys += _undercut(axes, body, factor)
        size = 0.012 * factor * float(np.ptp(np.concatenate([one.places for one in outlines]), axis=0).max())
        cross(axes, np.zeros(2), size, INK)
        keys.append((Line2D([], [], color=INK, marker="x", linestyle="none"), _("centre of the cam")))
        _arrow(axes, body, factor)
        finish(axes, labelled("x", unit), labelled("y", unit))
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


def _normals(axes: Axes, body: FollowerCam, factor: float) -> Line2D:
    """From the profile to the roller's centre, else a piece of the same length all round."""
    roller = body.touch.roller
    length = roller if 0.0 < roller < math.inf else LENGTH * body.base_radius
    found = body.contact(body.edges[-1] * np.arange(NORMALS) / NORMALS)
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


def _undercut(axes: Axes, body: FollowerCam, factor: float) -> Keys:
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
