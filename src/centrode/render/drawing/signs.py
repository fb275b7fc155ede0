"""The conventional signs of kinematic diagrams, each drawn on given axes at given places.

`size` is the radius of a hinge's circle everywhere, in the drawing's units.
"""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.patches import Circle, FancyArrowPatch, Polygon
from matplotlib.path import Path as Outline
from matplotlib.transforms import Affine2D
from numpy.typing import NDArray

from centrode.render.drawing.style import GROUND, INK

Array = NDArray[np.float64]
CHAIN = (0.0, (9.0, 2.5, 1.5, 2.5))
"""Dashes of pitch circles."""


def hinge(axes: Axes, place: Array, size: float, colour: str = INK, alpha: float = 1.0) -> None:
    """An open circle."""
    circle = Circle((place[0], place[1]), size, facecolor="white", edgecolor=colour, linewidth=1.1, zorder=6)
    circle.set_alpha(alpha)
    axes.add_artist(circle)


def traced_point(axes: Axes, place: Array, size: float, colour: str, alpha: float = 1.0) -> None:
    """A small dot: a point of one link where nothing is hinged."""
    axes.add_artist(
        Circle((place[0], place[1]), 0.5 * size, facecolor=colour, edgecolor="none", alpha=alpha, zorder=6)
    )


def cross(axes: Axes, place: Array, size: float, colour: str) -> None:
    """A slanting cross: an instant centre."""
    for slope in (1.0, -1.0):
        stroke = np.array([[-1.0, -slope], [1.0, slope]]) * size + place
        axes.plot(stroke[:, 0], stroke[:, 1], color=colour, linewidth=1.2, zorder=7)


def ground(axes: Axes, start: Array, end: Array, away: Array, size: float, colour: str = GROUND) -> None:
    """A line of the frame, hatched on the side that the unit vector `away` points to."""
    along = (end - start) / max(float(np.hypot(*(end - start))), np.finfo(float).tiny)
    strokes = max(2, round(float(np.hypot(*(end - start))) / (0.9 * size)))
    feet = start + np.linspace(0.0, 1.0, strokes, endpoint=False)[:, None] * (end - start)
    feet = feet + 0.9 * size * along
    tips = feet + 0.9 * size * (away - along)
    axes.add_collection(
        LineCollection([[start, end]], colors=colour, linewidths=1.2, zorder=1.5), autolim=False
    )
    axes.add_collection(
        LineCollection(list(np.stack([feet, tips], axis=1)), colors=colour, linewidths=0.6, zorder=1.4),
        autolim=False,
    )


def fixed_hinge(axes: Axes, place: Array, size: float, colour: str = GROUND) -> None:
    """A hinge on the frame: a triangle on hatched ground."""
    base = place + size * np.array([[-2.0, -3.2], [2.0, -3.2]])
    axes.add_artist(
        Polygon(
            np.array([place, *base]),
            closed=True,
            facecolor="white",
            edgecolor=colour,
            linewidth=1.0,
            zorder=1.6,
        )
    )
    overhang = size * np.array([0.8, 0.0])
    ground(axes, base[0] - overhang, base[1] + overhang, np.array([0.0, -1.0]), size, colour)
    hinge(axes, place, size, colour)


def slider(axes: Axes, place: Array, angle: float, size: float, colour: str, alpha: float = 1.0) -> None:
    """A rectangle along its guide; a faded one is only an outline."""
    body = Polygon(slider_outline(place, angle, size), closed=True, edgecolor=colour, linewidth=1.4)
    lay(axes, body, alpha, 5.0)


def slider_outline(place: Array, angle: float, size: float) -> Array:
    """Corners of a slider's rectangle."""
    outline = np.array([[-2.6, -1.7], [2.6, -1.7], [2.6, 1.7], [-2.6, 1.7]]) * size
    return np.asarray(Affine2D().rotate(angle).translate(place[0], place[1]).transform(outline))


def slot(axes: Axes, start: Array, end: Array, size: float, colour: str, alpha: float = 1.0) -> None:
    """A slot with round ends, as long as the pin travels; a faded one is only an outline."""
    body = Polygon(slot_outline(start, end, size), closed=True, edgecolor=colour, linewidth=1.4)
    lay(axes, body, alpha, 2.9)


def slot_outline(start: Array, end: Array, size: float) -> Array:
    """Corners of a slot, its round ends in small steps."""
    half = np.linspace(-np.pi / 2, np.pi / 2, 13)
    cap = 1.5 * size * np.stack([np.cos(half), np.sin(half)], axis=1)
    cap = Affine2D().rotate(float(np.arctan2(*(end - start)[::-1]))).transform(cap)
    return np.concatenate([end + cap, start - cap])


def lay(axes: Axes, body: Polygon, alpha: float, level: float) -> None:
    """Put a white body on what is below it, or a faded outline under all that is not faded."""
    body.set_facecolor("white" if alpha == 1.0 else "none")
    body.set_alpha(alpha)
    body.set_zorder(level if alpha == 1.0 else 2.3)
    axes.add_artist(body)


def turning_arrow(axes: Axes, arc: Array, colour: str) -> None:
    """An arc with a head at its end."""
    axes.add_artist(
        FancyArrowPatch(
            path=Outline(arc), arrowstyle="-|>", mutation_scale=9, color=colour, linewidth=1.0, fill=True
        )
    )


def turning_arc(place: Array, angle: float, forward: bool, size: float) -> Array:
    """An arc around a driven hinge, beside its link at `angle` [rad] and above the ground rather than in it."""
    middle = max(angle + 1.75, angle - 1.75, key=np.sin)
    turn = np.linspace(middle - 0.75, middle + 0.75, 15)
    arc = place + 4.2 * size * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    return np.asarray(arc if forward else arc[::-1])


def wheel(axes: Axes, centre: Array, radius: float, angle: float, colour: str, alpha: float = 1.0) -> None:
    """A circle with a spoke at its angle, lightly filled."""
    axes.add_artist(
        Circle(
            (centre[0], centre[1]), radius, facecolor=colour, edgecolor="none", alpha=0.12 * alpha, zorder=1.9
        )
    )
    rim = Circle(
        (centre[0], centre[1]), radius, facecolor="none", edgecolor=colour, linewidth=1.4, zorder=2.5
    )
    rim.set_alpha(alpha)
    axes.add_artist(rim)
    spoke = [centre, centre + radius * np.array([np.cos(angle), np.sin(angle)])]
    axes.add_collection(
        LineCollection([spoke], colors=colour, linewidths=1.0, alpha=alpha, zorder=2.5), autolim=False
    )


def round_ground(axes: Axes, centre: Array, radius: float, inward: bool, size: float) -> None:
    """A circle of the frame, hatched on its inner or outer side."""
    rim = Circle(
        (centre[0], centre[1]), radius, facecolor="none", edgecolor=GROUND, linewidth=1.2, zorder=1.5
    )
    axes.add_artist(rim)
    strokes = max(12, round(2.0 * np.pi * radius / (0.9 * size)))
    turn = np.linspace(0.0, 2.0 * np.pi, strokes, endpoint=False)
    out = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    along = np.stack([-out[:, 1], out[:, 0]], axis=1)
    feet = centre + radius * out
    tips = feet + 0.9 * size * ((-out if inward else out) - along)
    axes.add_collection(
        LineCollection(list(np.stack([feet, tips], axis=1)), colors=GROUND, linewidths=0.6, zorder=1.4),
        autolim=False,
    )


def circle(axes: Axes, centre: Array, radius: float, colour: str, alpha: float = 1.0) -> None:
    """A circle that a link carries."""
    rim = Circle(
        (centre[0], centre[1]), radius, facecolor="none", edgecolor=colour, linewidth=1.4, zorder=2.4
    )
    rim.set_alpha(alpha)
    axes.add_artist(rim)


def pitch_circle(
    axes: Axes, centre: Array, radius: float, angle: float, colour: str, alpha: float = 1.0
) -> None:
    """A chain-dotted circle with a short mark that turns with the wheel."""
    rim = Circle(
        (centre[0], centre[1]),
        radius,
        facecolor="none",
        edgecolor=colour,
        linewidth=1.0,
        linestyle=CHAIN,
        zorder=2.4,
    )
    rim.set_alpha(alpha)
    axes.add_artist(rim)
    way = radius * np.array([np.cos(angle), np.sin(angle)])
    axes.add_collection(
        LineCollection(
            [[centre + 0.88 * way, centre + way]], colors=colour, linewidths=1.6, alpha=alpha, zorder=2.4
        ),
        autolim=False,
    )


def cylinder(axes: Axes, foot: Array, mouth: Array, end: Array, size: float, alpha: float = 1.0) -> None:
    """A barrel from its foot to its mouth, and the rod that comes out of it."""
    rod = LineCollection(
        [[mouth, end]], colors=INK, linewidths=2.0 if alpha == 1.0 else 1.2, alpha=alpha, zorder=2.6
    )
    axes.add_collection(rod, autolim=False)
    body = Polygon(barrel_outline(foot, mouth, size), closed=True, edgecolor=INK, linewidth=1.2)
    lay(axes, body, alpha, 2.7)


def barrel_outline(foot: Array, mouth: Array, size: float) -> Array:
    """Corners of a barrel."""
    along = mouth - foot
    across = 1.3 * size * np.array([-along[1], along[0]]) / max(float(np.hypot(*along)), np.finfo(float).tiny)
    return np.array([foot + across, mouth + across, mouth - across, foot - across])
