"""A cam on paper: roller's path, profile, groove, normals, rollers at the joints, centre."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle

from centrode.cams.profiles import cam_outlines
from centrode.cams.roller_path import frames
from centrode.locale import _, mark
from centrode.present.cams.outlines import STROKES, group_by_layer
from centrode.present.cams.walking_wheel import walking_figure
from centrode.present.curves import write_legend, write_title
from centrode.present.displayed_units import label_with_unit, shown_as
from centrode.present.signs import cross
from centrode.present.style import INK, MUTED, house_style

if TYPE_CHECKING:
    from centrode.cams.profiles import CamOutline, ProfileBody
    from centrode.model.cam_files import AnyCam
    from centrode.model.mechanism import Display
    from centrode.present.scene import Array

SAMPLES = 720
NORMALS = 24
"""Normals over the turn."""
MOST_ROLLERS = 12
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


def profile_figure(
    body: ProfileBody, title: str = "", display: Display | None = None, *, groove: bool = False
) -> Figure:
    """The cam in its axes: phi = 0 is up, phi grows clockwise.

    Parameters
    ----------
    body : ProfileBody
        Of `cam_body`.
    title : str
        Stands below what the figure shows.
    display : Display, optional
        Its unit of length; metres if left out.
    groove : bool
        Also the outer wall.
    """
    factor, unit = shown_as("m", display)
    with house_style():
        figure = Figure(figsize=(8.4, 6.0), layout="constrained")
        axes = figure.subplots()
        outlines = cam_outlines(body, SAMPLES, groove=groove)
        keys = draw_outlines(axes, outlines, factor)
        keys.append((_normals(axes, body, factor, groove), _("normals")))
        keys.append((_rollers(axes, body, factor), _("roller at the joints")))
        keys += _undercut(axes, body, factor)
        extent = factor * max(
            float(np.ptp(np.concatenate([one.places for one in outlines]), axis=0).max()), 1e-9
        )
        cross(axes, np.zeros(2), 0.012 * extent, INK)
        keys.append((Line2D([], [], color=INK, marker="x", linestyle="none"), _("centre of the cam")))
        finish(axes, label_with_unit("x", unit), label_with_unit("y", unit))
        write_legend(axes, keys, inches=5.0)
        write_title(figure, _("Profile of the cam"), title)
    return figure


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


def _normals(axes: Axes, body: ProfileBody, factor: float, groove: bool) -> Line2D:
    """Normals from the profile through the roller's centre."""
    phi = body.closed.start + math.tau * np.arange(NORMALS) / NORMALS
    frame = frames(body.closed, phi)
    feet = frame.place - body.roller * frame.normal
    tips = frame.place + body.roller * frame.normal if groove else frame.place
    for foot, tip in zip(factor * feet, factor * tips, strict=True):
        (line,) = axes.plot(*np.stack([foot, tip], axis=1), color=MUTED, linewidth=0.6, zorder=2)
    return line


def _rollers(axes: Axes, body: ProfileBody, factor: float) -> Line2D:
    """Rollers at the ends of the working arc and at kinks, with the angle."""
    kinks = {joint.at for joint in body.kinks}
    ends = {body.closed.arcs[0].stop, body.closed.stop} if len(body.closed.arcs) > 1 else {body.closed.stop}
    joints = sorted(kinks | ends)[:MOST_ROLLERS]
    frame = frames(body.closed, np.array(joints))
    for at, place in zip(joints, factor * frame.place, strict=True):
        axes.add_patch(
            Circle(
                (place[0], place[1]), factor * body.roller, fill=False, edgecolor=INK, linewidth=0.9, zorder=4
            )
        )
        axes.plot(*place, marker="+", color=INK, markersize=5, markeredgewidth=0.8, zorder=5)
        _name(axes, at, place, factor * body.roller)
    return Line2D([], [], color=INK, marker="o", markerfacecolor="none", linestyle="none", markersize=8)


def _name(axes: Axes, at: float, place: Array, room: float) -> None:
    """The angle of a joint, outside its roller."""
    away = place * (1.0 + 1.25 * room / float(np.hypot(*place)))
    degrees = math.degrees(math.remainder(at, math.tau))
    axes.update_datalim([tuple(away * 1.1)])
    side = "left" if away[0] >= 0 else "right"
    axes.text(
        away[0],
        away[1],
        f"{degrees:.4g}°".replace("-", "−"),
        fontsize=8.5,
        color=INK,
        ha=side,
        va="center",
        zorder=6,
    )


def _undercut(axes: Axes, body: ProfileBody, factor: float) -> list[tuple[Line2D, str]]:
    """Stretches where the roller cuts the profile away, over everything."""
    line = None
    for stretch in body.undercuts:
        phi = np.linspace(stretch.start, stretch.stop, 200)
        (line,) = axes.plot(*(factor * body.profile(phi).place.T), color=UNDERCUT, linewidth=2.4, zorder=5)
    return [] if line is None else [(line, _("undercut"))]


# Figures of a cam's profile and of the walking wheel, of a cam's results.

INSTANTS = 6
"""Instants over a step, where the description names none."""


def cam_body_figures(cam: AnyCam, objects: Mapping[str, Any], *, groove: bool = False) -> dict[str, Figure]:
    """Figures of the cam's profile and of the walking wheel, by name, of what there is."""
    found = {}
    if "body" in objects:
        found["cam-body"] = profile_figure(objects["body"], _(cam.title), cam.display, groove=groove)
    if "wheel" in objects:
        wheel = objects["wheel"]
        pitch = math.tau / wheel.legs
        even = [pitch * (number / (INSTANTS - 1) - 0.5) for number in range(INSTANTS)]
        found["walking-wheel"] = walking_figure(wheel, cam.study.instants or even, _(cam.title), cam.display)
    return found
