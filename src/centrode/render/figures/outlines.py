"""Bodies between their outlines, to one scale, as figures of matplotlib."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, assert_never

import numpy as np
from matplotlib.artist import Artist
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle

from centrode.model.settings import shown_as
from centrode.render.drawing.figure_room import figure_width
from centrode.render.drawing.signs import cross, fixed_hinge, ground, turning_arrow
from centrode.render.drawing.style import (
    CENTRE_LINE,
    GROUND,
    INK,
    MUTED,
    PALETTE,
    SMALL,
    Decimals,
)
from centrode.render.drawing.texts import formula, label_with_unit
from centrode.render.figures.curves import legend_height, legend_width, write_legend, write_title
from centrode.render.outlines import GREY, STROKES, group_by_layer
from centrode.render.spelling import DrawingSpelling
from centrode.sheets.outlines import (
    DrawnBaseCircle,
    DrawnFollower,
    DrawnLines,
    DrawnRollers,
    DrawnTurning,
    LineUse,
    MarkedPlaces,
)
from centrode.sheets.texts import NOTHING

if TYPE_CHECKING:
    from collections.abc import Mapping

    from matplotlib.axes import Axes

    from centrode.model.settings import Display
    from centrode.sheets.outlines import OutlineDrawing, PathDrawing

HEIGHT = 4.6
"""Inches of a figure, less its legend."""
LEGEND = 4.0
"""Inches that a legend may take."""
ROOM = 0.06
"""Room around the body, over its size."""
CROSS = 0.012
"""Half the size of the centre's sign, over that of the outlines."""
FOLLOWER = PALETTE[2]
BASE_CIRCLE: Mapping[str, Any] = {"color": GREY, "linewidth": 0.9, "linestyle": (0, (1.2, 2.0))}
PENS: Mapping[LineUse, Mapping[str, Any]] = {
    LineUse.AXIS: {"color": MUTED, "linewidth": 0.8, "linestyle": CENTRE_LINE, "zorder": 1},
    LineUse.FOLLOWER: {"color": FOLLOWER, "linewidth": 2.0, "zorder": 4, "solid_capstyle": "round"},
    LineUse.NORMAL: {"color": MUTED, "linewidth": 0.6, "zorder": 2},
    LineUse.UNDERCUT: {"color": "#B00020", "linewidth": 2.4, "zorder": 5},
    LineUse.WORKING: {"color": PALETTE[1], "linewidth": 3.0, "zorder": 5, "solid_capstyle": "round"},
    LineUse.CIRCLE: BASE_CIRCLE,
}


def outline_figure(drawing: OutlineDrawing, display: Display) -> Figure:
    """A body between its outlines, lengths in the unit of the display."""
    spelling = DrawingSpelling(display)
    factor, unit = shown_as("m", display)
    figure = Figure(figsize=(figure_width(), HEIGHT), layout="constrained")
    axes = figure.subplots()
    key: list[tuple[Artist, str]] = []
    for layer, pieces in group_by_layer(drawing.pieces).items():
        for piece in pieces:
            (line,) = axes.plot(*(factor * piece.places.T), **STROKES[layer].drawn, zorder=3)
        key.append((line, spelling.text(drawing.layers[layer])))
    for shape in drawing.shapes:
        match shape:
            case DrawnLines(use, name, lines):
                for places in lines:
                    point: dict[str, Any] = {"marker": "s", "markersize": 5} if len(places) == 1 else {}
                    (line,) = axes.plot(*(factor * places.T), **PENS[use], **point)
                if lines and name != NOTHING:
                    key.append((Line2D([], [], **PENS[use]), spelling.text(name)))
            case DrawnRollers(name):
                key.append((_rollers(axes, shape, factor, spelling), spelling.text(name)))
            case DrawnBaseCircle(name, radius):
                axes.add_patch(Circle((0.0, 0.0), factor * radius, fill=False, **_patch_pen(BASE_CIRCLE)))
                key.append((Line2D([], [], **BASE_CIRCLE), spelling.text(name)))
            case MarkedPlaces(name):
                key.append((_marks(axes, shape, factor, spelling), spelling.text(name)))
            case DrawnTurning(radius, sense):
                turn = np.linspace(0.25 * np.pi, 0.75 * np.pi, 25)[:: 1 if sense > 0 else -1]
                arc = factor * radius * np.stack([np.cos(turn), np.sin(turn)], axis=-1)
                turning_arrow(axes, np.asarray(arc), INK)
            case DrawnFollower():
                _follower(axes, shape, factor)
            case _:
                assert_never(shape)
    places = np.concatenate([piece.places for piece in drawing.pieces])
    extent = factor * max(float(np.ptp(places, axis=0).max()), 1e-9)
    if drawing.centre != NOTHING:
        cross(axes, np.zeros(2), CROSS * extent, INK)
        centre = Line2D([], [], color=INK, marker="x", linestyle="none")
        key.append((centre, spelling.text(drawing.centre)))
    axes.set_aspect("equal", adjustable="datalim")
    axes.margins(ROOM)
    axes.set_xlabel(label_with_unit("x", unit))
    axes.set_ylabel(label_with_unit("y", unit))
    figure.set_figheight(HEIGHT + legend_height([name for _line, name in key], inches=LEGEND))
    write_legend(axes, key, inches=LEGEND)
    write_title(figure, spelling.text(drawing.title), spelling.text(drawing.mechanism))
    return figure


def _patch_pen(pen: Mapping[str, Any]) -> dict[str, Any]:
    """The pen of a line for the edge of a patch."""
    return {"edgecolor" if name == "color" else name: value for name, value in pen.items()}


def _marks(axes: Axes, marks: MarkedPlaces, factor: float, spelling: DrawingSpelling) -> Line2D:
    """Draw places with their texts; returns the sign of the legend."""
    for place, text, beside in zip(
        factor * marks.places, marks.texts, factor * marks.text_places, strict=True
    ):
        axes.plot(*place, marker="o", color=INK, markersize=3.5, zorder=6)
        look: dict[str, Any] = {"fontsize": SMALL, "color": INK, "ha": "center", "va": "center", "zorder": 6}
        axes.text(beside[0], beside[1], spelling.text(text), **look)
    return Line2D([], [], color=INK, marker="o", linestyle="none", markersize=3.5)


def _follower(axes: Axes, follower: DrawnFollower, factor: float) -> None:
    """The pivot or the walls of the guide, and the roller or the edge."""
    size = factor * follower.hinge
    if follower.pivot is not None:
        fixed_hinge(axes, factor * follower.pivot, size)
    if follower.walls is not None:
        for side in (-1.0, 1.0):
            low, high = factor * follower.walls + np.array([1.4 * side * size, 0.0])
            ground(axes, low, high, np.array([side, 0.0]), size, GROUND)
        axes.update_datalim([tuple(factor * follower.walls[1] + np.array([0.0, 5.0 * size]))])
    if follower.tip is None:
        return
    x, y = (factor * follower.tip).tolist()
    if not follower.roller:
        axes.plot(x, y, marker="v", color=FOLLOWER, markersize=6, zorder=5)
        return
    look: dict[str, Any] = {"facecolor": "none", "edgecolor": FOLLOWER, "linewidth": 1.6, "zorder": 4}
    axes.add_patch(Circle((x, y), factor * follower.roller, **look))
    axes.plot(x, y, marker="+", color=INK, markersize=6, markeredgewidth=0.9, zorder=5)


def _rollers(axes: Axes, rollers: DrawnRollers, factor: float, spelling: DrawingSpelling) -> Line2D:
    """Draw rollers with their texts outside of them, seen from the centre; returns the sign of the legend."""
    radius = factor * rollers.radius
    for place, text in zip(factor * rollers.places, rollers.texts, strict=True):
        axes.add_patch(
            Circle((place[0], place[1]), radius, fill=False, edgecolor=INK, linewidth=0.9, zorder=4)
        )
        axes.plot(*place, marker="+", color=INK, markersize=5, markeredgewidth=0.8, zorder=5)
        away = place * (1.0 + 1.25 * radius / float(np.hypot(*place)))
        axes.update_datalim([tuple(away * 1.1)])
        side = "left" if away[0] >= 0 else "right"
        look: dict[str, Any] = {"fontsize": SMALL, "color": INK, "ha": side, "va": "center", "zorder": 6}
        axes.text(away[0], away[1], spelling.text(text), **look)
    return Line2D([], [], color=INK, marker="o", markerfacecolor="none", linestyle="none", markersize=8)


PATH_INCHES = 4.4
"""The most that a path is high on paper."""
BESIDE = 0.075
"""How far the text of a ray stands beyond its end, over the greatest distance of the path from the origin."""


def path_figure(drawing: PathDrawing, display: Display) -> Figure:
    """A curve about the origin with rays and normals, lengths in the unit of the display."""
    spelling = DrawingSpelling(display)
    factor, unit = shown_as("m", display)
    places = factor * drawing.places
    with_origin = np.concatenate([places[np.isfinite(places).all(axis=1)], np.zeros((1, 2))])
    width, height = np.ptp(with_origin, axis=0).tolist()
    names = [spelling.text(one) for one in (drawing.path, drawing.ray, drawing.normal)]
    room = 0.78 * (figure_width() - legend_width(names)) - 0.7
    scale = min(room / (width or 1.0), PATH_INCHES / (height or 1.0))
    size = (figure_width(), max(1.3 * scale * height + 1.0, 2.4) + legend_height(names))
    figure = Figure(figsize=size, layout="constrained")
    axes = figure.subplots()
    far = BESIDE * float(np.hypot(*with_origin.T).max())
    for ray in drawing.rays:
        end, inwards = factor * ray.place, factor * ray.inwards
        beyond = end * (1.0 + far / float(np.hypot(*end)))
        axes.plot(*np.stack([np.zeros(2), end]).T, color=MUTED, linewidth=0.7)
        axes.plot(*np.stack([inwards, end]).T, color=PALETTE[1], linewidth=1.1)
        look: dict[str, Any] = {"color": GROUND, "ha": "center", "va": "center", "fontsize": SMALL}
        axes.text(beyond[0], beyond[1], spelling.text(ray.text), **look)
    (line,) = axes.plot(*places.T, color=PALETTE[0], linewidth=2.0)
    key: list[tuple[Artist, str]] = [
        (line, spelling.text(drawing.path)),
        (Line2D([], [], color=MUTED, linewidth=0.7), spelling.text(drawing.ray)),
        (Line2D([], [], color=PALETTE[1], linewidth=1.1), spelling.text(drawing.normal)),
    ]
    axes.plot([0.0], [0.0], marker="+", markersize=11, color=INK, markeredgewidth=1.4)
    axes.set_aspect("equal")
    axes.margins(0.14)
    for axis, name in ((axes.xaxis, "x"), (axes.yaxis, "y")):
        axis.set_major_formatter(Decimals())
        axis.set_label_text(label_with_unit(formula(name), unit))
    write_legend(axes, key)
    write_title(figure, spelling.text(drawing.title), spelling.text(drawing.mechanism))
    return figure
