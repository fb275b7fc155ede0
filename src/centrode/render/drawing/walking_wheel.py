"""The walking wheel at chosen instants: cam, carrier, legs, rollers, shoes, ground and footprints."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, Polygon

from centrode.locale import _
from centrode.model.settings import shown_as
from centrode.render.drawing.colours import CARRIER
from centrode.render.drawing.figure_room import PAGE_HEIGHT, count_across, figure_width
from centrode.render.drawing.signs import ground, slider
from centrode.render.drawing.style import CENTRE_LINE, GROUND, INK, MUTED, PALETTE
from centrode.render.drawing.texts import label_with_unit
from centrode.render.figures.curves import write_title
from centrode.render.spelling import DrawingSpelling
from centrode.sheets.texts import Number

if TYPE_CHECKING:
    from centrode.cams.walking_wheel import WheelMover, WheelPose
    from centrode.model.settings import Display
    from centrode.scenes.places import Array
    from centrode.sheets.outlines import WheelPositions

POINTS = 361
CAM, STANDING, FREE, PRINT = PALETTE[0], PALETTE[1], PALETTE[2], PALETTE[4]


def draw_wheel(axes: Axes, wheel: WheelMover, pose: WheelPose, factor: float) -> list[Artist]:
    """Draw a wheel at one instant, lengths times `factor`; returns what was drawn."""
    before = set(axes.get_children())
    _ground(axes, wheel, pose, factor)
    _carrier(axes, wheel, pose, factor)
    _cam(axes, wheel, pose, factor)
    for leg in range(wheel.legs):
        _leg(axes, wheel, pose, leg, factor)
    axes.plot(*(factor * pose.hub), marker="o", color=INK, markersize=4, zorder=8)
    axes.plot(*(factor * pose.contact), marker="o", color=PRINT, markersize=5, markeredgecolor=INK, zorder=9)
    return [one for one in axes.get_children() if one not in before]


def reach(wheel: WheelMover) -> float:
    """How far the wheel reaches from its hub [m], whatever the instant."""
    phi = np.linspace(wheel.closed.start, wheel.closed.stop, POINTS)
    ends = wheel.shoe.place(np.array([0.0, wheel.half]))
    return float(wheel.closed.radius(phi)[0].max() + np.hypot(ends[:, 0], ends[:, 1]).max())


def window(axes: Axes, wheel: WheelMover, pose: WheelPose, factor: float) -> None:
    """Equal scales and limits that hold the wheel about its hub at any instant."""
    far = 1.04 * reach(wheel)
    axes.set_aspect("equal", adjustable="box")
    axes.set_xlim(factor * (pose.hub[0] - far), factor * (pose.hub[0] + far))
    axes.set_ylim(-0.09 * factor * far, factor * (wheel.height + far))


def wheel_keys() -> list[tuple[Line2D, str]]:
    """Entries of a legend."""
    dot: dict[str, Any] = {"marker": "o", "linestyle": "none"}
    return [
        (Line2D([], [], color=CAM), _("cam")),
        (
            Line2D([], [], color=MUTED, linestyle=CENTRE_LINE, linewidth=0.8),
            _("path of the rollers"),
        ),
        (Line2D([], [], color=CARRIER), _("carrier")),
        (Line2D([], [], color=STANDING), _("standing leg")),
        (Line2D([], [], color=FREE), _("returning leg")),
        (Line2D([], [], color=PRINT, linewidth=4), _("footprint")),
        (Line2D([], [], color=PRINT, markeredgecolor=INK, **dot), _("contact")),
        (Line2D([], [], color=INK, markersize=4, **dot), _("hub")),
    ]


def _ground(axes: Axes, wheel: WheelMover, pose: WheelPose, factor: float) -> None:
    """The hatched ground, and the footprints of the steps before and behind."""
    far = 1.04 * factor * reach(wheel)
    hub = factor * float(pose.hub[0])
    # strokes stand on the ground, so many to a step: where the hub moves they pass by
    apart = factor * wheel.step / round(factor * wheel.step / (0.027 * far))
    low, high = (apart * math.floor(side / apart) for side in (hub - far, hub + far + apart))
    ground(axes, np.array([low, 0.0]), np.array([high, 0.0]), np.array([0.0, -1.0]), apart / 0.9, GROUND)
    steps = math.floor((pose.turned + wheel.half) * wheel.legs / math.tau)
    ends = np.array([-wheel.half, wheel.half])
    own = wheel.travel(ends) + wheel.touch(ends)
    around = math.ceil(reach(wheel) / wheel.step)
    for step in range(steps - around, steps + around + 1):
        places = factor * (own + step * wheel.step)
        shown = np.clip(places, hub - far, hub + far)
        if shown[0] < shown[1]:
            axes.plot(shown, np.zeros(2), color=PRINT, linewidth=4, solid_capstyle="butt", zorder=2)


def _cam(axes: Axes, wheel: WheelMover, pose: WheelPose, factor: float) -> None:
    phi = np.linspace(wheel.closed.start, wheel.closed.stop, POINTS)
    frame = wheel.roller_frames(phi)
    profile = factor * pose.of_cam(frame.place - wheel.roller * frame.normal)
    path = factor * pose.of_cam(frame.place)
    axes.add_artist(Polygon(profile, facecolor=CAM, edgecolor="none", alpha=0.15, zorder=3))
    axes.plot(*profile.T, color=CAM, linewidth=1.6, zorder=4)
    axes.plot(*path.T, color=MUTED, linewidth=0.8, linestyle=CENTRE_LINE, zorder=3)


def _carrier(axes: Axes, wheel: WheelMover, pose: WheelPose, factor: float) -> None:
    """A ring about the cam with a guide for each leg."""
    radius = factor * carrier_radius(wheel)
    hub = factor * pose.hub
    axes.add_artist(
        Circle((hub[0], hub[1]), radius, fill=False, edgecolor=CARRIER, linewidth=2.2, zorder=4.5)
    )
    for along in pose.along:
        slider(axes, hub + radius * along, math.atan2(along[1], along[0]), 0.05 * radius, CARRIER)


def _leg(axes: Axes, wheel: WheelMover, pose: WheelPose, leg: int, factor: float) -> None:
    """Roller, rod and shoe of a leg."""
    colour = STANDING if leg == pose.supporting else FREE
    phi = np.linspace(-wheel.half, wheel.half, POINTS)
    outline = wheel.shoe.place(phi)
    top = np.array([[0.0, 0.8 * outline[[0, -1], 1].min()]])
    rod = factor * pose.of_leg(leg, np.array([[0.0, 0.0], [0.0, outline[:, 1].max()]]))
    shoe = factor * pose.of_leg(leg, np.concatenate([outline, top]))
    roller = factor * pose.rollers[leg]
    axes.add_artist(Polygon(shoe, facecolor=colour, edgecolor=colour, alpha=0.25, linewidth=1.0, zorder=5.5))
    axes.plot(*shoe[:-1].T, color=colour, linewidth=2.0, zorder=6)
    axes.plot(*rod.T, color=colour, linewidth=2.4, zorder=6)
    axes.add_artist(
        Circle(
            (roller[0], roller[1]),
            factor * wheel.roller,
            facecolor="white",
            edgecolor=colour,
            linewidth=1.6,
            zorder=7,
        )
    )
    axes.plot(*roller, marker="+", color=colour, markersize=5, zorder=7.5)


def carrier_radius(wheel: WheelMover) -> float:
    """Radius of the carrier's ring [m]: outside the rollers, within the shoes of legs drawn in."""
    phi = np.linspace(wheel.closed.start, wheel.closed.stop, POINTS)
    radius: Array = wheel.closed.radius(phi)[0]
    shoe = 0.8 * float(wheel.shoe.place(np.array([wheel.half]))[0, 1])
    return float(min(radius.max() + 1.4 * wheel.roller, radius.min() + max(shoe, 2.0 * wheel.roller)))


# A walking wheel at some instants, as a figure of matplotlib.

COLUMNS = 3
MOST_INSTANTS = 12


def wheel_figure(positions: WheelPositions, display: Display) -> Figure:
    """The wheel in a panel for each instant, at most the first twelve, lengths in the unit of the display."""
    spelling = DrawingSpelling(display)
    factor, unit = shown_as("m", display)
    turned = positions.turned[:MOST_INSTANTS]
    columns = min(count_across(COLUMNS), len(turned))
    rows = -(-len(turned) // columns)
    high = min(3.0, figure_width() / columns)
    figure = Figure(
        figsize=(figure_width(), min(PAGE_HEIGHT, (high + 0.2) * rows + 1.1)), layout="constrained"
    )
    grid = figure.subplots(rows, columns, squeeze=False).reshape(-1)
    for axes in grid[len(turned) :]:
        axes.set_visible(False)
    for axes, angle in zip(grid, turned, strict=False):
        pose = positions.wheel.pose(angle)
        draw_wheel(axes, positions.wheel, pose, factor)
        window(axes, positions.wheel, pose, factor)
        axes.set_title(spelling.text(Number(math.degrees(angle), "deg", ".4g", unit_fixed=True)))
        axes.set_xlabel(label_with_unit("x", unit))
    grid[0].set_ylabel(label_with_unit("y", unit))
    keys = wheel_keys()
    figure.legend(
        [key for key, _name in keys],
        [name for _key, name in keys],
        loc="outside lower center",
        ncols=count_across(4),
    )
    write_title(figure, spelling.text(positions.title), spelling.text(positions.mechanism))
    return figure
