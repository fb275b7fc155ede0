"""Grids of panels as figures of matplotlib: hodographs of vectors, and shares around a circle as rings."""

from __future__ import annotations

from itertools import pairwise
from textwrap import fill
from typing import TYPE_CHECKING, TypeAlias, assert_never

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from centrode.locale import _
from centrode.render.drawing.figure_room import PAGE_HEIGHT, count_across, figure_width
from centrode.render.drawing.style import HAIR, INK, MUTED, PALETTE, SMALL, Decimals
from centrode.render.drawing.tags import WIDE, label_places
from centrode.render.figures.curves import say_nothing_known, write_title
from centrode.render.spelling import DrawingSpelling, FigureSpelling, PrintSpelling
from centrode.sheets.plots import HodographPanel, PanelGrid, SectorRings

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from centrode.model.settings import Display

Array: TypeAlias = NDArray[np.float64]
COLUMNS = 3
LETTERS = 78
"""So many letters of titles stand beside each other."""
PANEL = 1.3
"""Sides of a panel [inch], of three beside each other."""
ROOM = 1.5
"""A panel is so many times as wide as its hodograph: values stand outside it."""
FLATTEST = 0.6
"""The least side of a panel over the greater one."""
MOST_SEGMENTS = 90
"""Of so many parts of a hodograph its texts keep clear."""
INSIDE, OUTSIDE = PALETTE[0], PALETTE[1]
DEPTH = 0.42
"""The deepest ring, over the radius of the circle."""


def grid_figure(grid: PanelGrid, display: Display) -> Figure:
    """A figure of panels in at most three columns."""
    count, spelling = len(grid.panels), FigureSpelling(display)
    columns = min(2 if count == 4 else count, count_across(COLUMNS))
    rows = -(-count // columns)
    high = figure_width() / max(columns, 2) + 0.25
    figure = Figure(figsize=(figure_width(), min(PAGE_HEIGHT, rows * high + 0.5)), layout="constrained")
    places = figure.subplots(rows, columns, squeeze=False).ravel()
    for axes, panel in zip(places, grid.panels, strict=False):
        match panel:
            case HodographPanel():
                _hodograph(axes, panel, display)
            case SectorRings():
                _rings(axes, panel, display)
            case _:
                assert_never(panel)
        lines = spelling.text(panel.name).splitlines()
        axes.set_title("\n".join(fill(line, count_across(LETTERS) // columns) for line in lines))
    for axes in places[count:]:
        axes.set_axis_off()
    for row in range(rows):  # one label serves a row and a column of panels
        for axes in places[row * columns + 1 : (row + 1) * columns]:
            axes.set_ylabel("")
    for axes in places[: count - columns]:
        axes.set_xlabel("")
    write_title(figure, spelling.text(grid.title), PrintSpelling(display).text(grid.mechanism))
    return figure


def _hodograph(axes: Axes, hodograph: HodographPanel, display: Display) -> None:
    """The curve with its origin and the values along it."""
    spelling, ends = FigureSpelling(display), hodograph.ends
    across, x_label, _unit = spelling.label(hodograph.x)
    up, y_label, _unit = spelling.label(hodograph.y)
    axes.set_xlabel(x_label)
    axes.set_ylabel(y_label)
    ordered = np.insert(ends[hodograph.order] * (across, up), hodograph.breaks, np.nan, axis=0)
    if not np.isfinite(ends).all(axis=1).any():
        say_nothing_known(axes)
        return
    _frame_about(axes, ordered)
    axes.plot(ordered[:, 0], ordered[:, 1], color=INSIDE, zorder=3)
    axes.plot([0.0], [0.0], "+", color=INK, markersize=9, zorder=4)
    words = DrawingSpelling(display)
    marks = {words.text(value): np.array(place) * (across, up) for value, place in hodograph.marks}
    _mark(axes, ordered, marks)


def _frame_about(axes: Axes, curve: Array) -> None:
    """Limits around a curve and its origin, with room for what stands beside it."""
    known = np.vstack([curve[np.isfinite(curve).all(axis=1)], np.zeros((1, 2))])
    low, high = known.min(axis=0), known.max(axis=0)
    most = 0.5 * ROOM * float(np.max(high - low)) or 1.0
    half = np.maximum(0.5 * ROOM * (high - low), FLATTEST * most)
    middle = (low + high) / 2
    axes.set_aspect("equal", adjustable="box")
    axes.set_xlim(middle[0] - half[0], middle[0] + half[0])
    axes.set_ylim(middle[1] - half[1], middle[1] + half[1])
    axes.xaxis.labelpad = 11.0  # below the common factor of the ticks
    for axis, side in zip((axes.xaxis, axes.yaxis), half, strict=True):
        axis.set_major_formatter(Decimals())
        most = 4 if side > 0.7 * np.max(half) else 1
        axis.set_major_locator(MaxNLocator(most, steps=[1, 2, 2.5, 5, 10], min_n_ticks=min(most, 2)))


def _mark(axes: Axes, curve: Array, places: dict[str, Array]) -> None:
    """Dots with the values beside them, where there is room."""
    corners = np.array([axes.get_xlim(), axes.get_ylim()]).T
    height = SMALL * float(np.max(corners[1] - corners[0])) / (72.0 * PANEL)
    apart: dict[str, Array] = {}
    dots = np.array(list(places.values())).reshape(-1, 2)
    axes.plot(dots[:, 0], dots[:, 1], "o", color=INSIDE, markersize=3.2, zorder=4)
    for text, place in places.items():
        if all(np.hypot(*(place - other)) > 2.6 * height for other in apart.values()):
            apart[text] = place
    coarse = curve[:: max(1, len(curve) // MOST_SEGMENTS)]
    segments = [(a, b) for a, b in pairwise(coarse) if np.isfinite([a, b]).all()]
    for text, centre in label_places(apart, segments, 1.1 * height, height).items():
        half = height * np.array([0.5 * WIDE * len(text), 0.6])
        centre = np.clip(centre, corners[0] + half, corners[1] - half)
        axes.text(centre[0], centre[1], text, fontsize=SMALL, color=INK, ha="center", va="center", zorder=5)


def _rings(axes: Axes, rings: SectorRings, display: Display) -> None:
    """A circle with the shares of one surface inside it and those of the other outside."""
    axes.set_aspect("equal", adjustable="box")
    axes.set_axis_off()
    reach = 1.0 + DEPTH + 0.28
    axes.set_xlim(-reach, reach)
    axes.set_ylim(-reach, reach)
    around = np.linspace(0.0, 2.0 * np.pi, 361)
    axes.plot(np.cos(around), np.sin(around), color=INK, linewidth=1.0, zorder=3)
    ways = np.radians(np.arange(0, 360, 30))[:, None]
    spokes = np.array([0.3, 1.0 + DEPTH, np.nan])
    axes.plot(
        (np.cos(ways) * spokes).ravel(),
        (np.sin(ways) * spokes).ravel(),
        color=MUTED,
        linewidth=HAIR,
        zorder=1,
    )
    for turn, (x, y) in {0: (1, 0), 90: (0, 1), 180: (-1, 0), 270: (0, -1)}.items():
        far = 1.0 + DEPTH + 0.14
        axes.text(far * x, far * y, f"{turn}°", fontsize=SMALL, color=MUTED, ha="center", va="center")
    shares = np.stack([rings.inside, rings.outside])
    if not np.isfinite(shares).all():
        axes.text(0.0, 0.0, _("no turning\nunder load"), color=MUTED, ha="center", va="center")
        return
    deepest = float(shares.max())
    for share, colour, sign in zip(shares, (INSIDE, OUTSIDE), (-1.0, 1.0), strict=True):
        radius = 1.0 + sign * DEPTH * share / deepest
        axes.fill(*_ring(rings.middles, radius), color=colour, alpha=0.35, linewidth=0.0, zorder=2)
        outline = np.append(rings.middles, rings.middles[0] + 2.0 * np.pi)
        radius = np.append(radius, radius[0])
        axes.plot(radius * np.cos(outline), radius * np.sin(outline), color=colour, linewidth=1.3, zorder=4)
    text = DrawingSpelling(display).text(rings.text)
    axes.text(0.0, 0.0, text, fontsize=SMALL, color=INK, ha="center", va="center", zorder=5)


def _ring(middles: Array, radius: Array) -> tuple[Array, Array]:
    """The outline of what lies between the unit circle and a curve around it."""
    turns = np.append(middles, middles[0] + 2.0 * np.pi)
    fine = np.linspace(turns[0], turns[-1], 721)
    far = np.append(radius, radius[0])
    x = np.concatenate([far * np.cos(turns), np.cos(fine[::-1])])
    y = np.concatenate([far * np.sin(turns), np.sin(fine[::-1])])
    return x, y
