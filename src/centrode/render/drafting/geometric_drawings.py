"""Drawings of lengths at a standard scale: lines, circles, angles and names in their fields."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.patches import Circle

from centrode.render.drafting.drawing_page import USUAL, DrawingPage, SheetField, letters_width, wrapped_lines
from centrode.render.drafting.plates import (
    METRE,
    SIGN,
    begin,
    fitting_scale,
    length_captions,
    write_caption,
)
from centrode.render.drafting.recorder import MAIN, POINT, THIN
from centrode.render.drafting.scaled_diagrams import page_head
from centrode.render.drawing import signs
from centrode.render.drawing.style import INK
from centrode.render.pages.page import Array, PageView
from centrode.render.spelling import FigureSpelling
from centrode.sheets.drawing_sheets import LineLook

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from centrode.render.drafting.scales import DrawingScale
    from centrode.sheets.drawing_sheets import (
        GeometricDrawing,
        GeometryAngle,
        GeometryFrame,
        GeometryLine,
    )

AROUND = 14.0
"""Room around a drawing for signs and names [mm]."""
DASHES: dict[LineLook, Any] = {
    LineLook.MAIN: "-",
    LineLook.THIN: "-",
    LineLook.DASHED: (0, (8.0, 3.0)),
    LineLook.CHAIN: (0, (24.0, 4.0, 2.0, 4.0)),
}
"""In widths of the line."""
AVOIDED = 160
"""Parts of a line that names keep clear of, at most."""
STEP = np.deg2rad(2.0)
LEAST_ARC = 12.0
"""Length of an arc from which on it ends in heads [mm]."""
HINGE = SIGN * np.array([[-2.8, -4.2], [2.8, 1.0]])
"""Corners of the sign of a hinge on the frame about its centre [mm]."""
TURNING = SIGN * np.array([[-3.8, 1.0], [3.8, 5.0]])
"""The same of the arrow that says how a body turns [mm]."""
WALL = 1.3
"""Half the width of a guide, in radii of a hinge."""


def draw_geometric_plate(
    page: DrawingPage,
    field: SheetField,
    drawing: GeometricDrawing,
    spelling: FigureSpelling,
    wanted: DrawingScale | None = None,
) -> DrawingScale:
    """A drawing with its title and scale; returns the scale, the largest standard one that fits if None is wanted.

    Raises
    ------
    InputError
        The scale that is wanted is too large for the field.
    """
    inner = begin(page, field)
    box = _box(drawing)
    scale = fitting_scale((inner.size - 2.0 * AROUND) / (METRE * (box[1] - box[0])), wanted)
    per = 1.0 / METRE / scale.ratio
    view = PageView.about(inner.corner, inner.size, box, per)
    axes = view.axes(page)
    for line in drawing.lines:
        _draw_line(page, axes, view, line)
    for circle in drawing.circles:
        width = MAIN if circle.look is LineLook.MAIN else THIN
        rim = Circle(circle.centre, circle.radius, fill=False, edgecolor=INK, linewidth=width / POINT)
        axes.add_patch(rim)
        page.avoid(pairwise(view.mm(_arc(np.array(circle.centre), circle.radius, 0.0, 2.0 * np.pi))))
    if drawing.frame is not None:
        _draw_frame(axes, drawing.frame, SIGN * per)
        page.boxes += [view.mm(np.array(place)) + HINGE for place in drawing.frame.hinges]
        if drawing.frame.sense:
            page.boxes.append(view.mm(np.array(drawing.frame.hinges[0])) + TURNING)
    for angle in drawing.angles:
        _draw_angle(page, axes, view, angle, spelling)
    for name in drawing.names:
        at = view.mm(np.array(name.place))
        if name.dotted:
            page.overlay.plot([at[0]], [at[1]], marker="o", markersize=2.2, color=INK, zorder=6.5)
        page.name(at, spelling.text(name.text), clear=0.9 if name.dotted else 1.6)
    page.place_names(inner.box)
    write_caption(page, field, spelling.text(drawing.title), length_captions(scale))
    return scale


def _box(drawing: GeometricDrawing) -> Array:
    """Corners of what is drawn [m]."""
    return np.array([np.min(list(_corners(drawing)), axis=0), np.max(list(_corners(drawing)), axis=0)])


def _corners(drawing: GeometricDrawing) -> Iterator[Array]:
    for line in drawing.lines:
        yield line.places.min(axis=0)
        yield line.places.max(axis=0)
    for circle in drawing.circles:
        yield np.array(circle.centre) - circle.radius
        yield np.array(circle.centre) + circle.radius
    for name in drawing.names:
        yield np.array(name.place)
    for angle in drawing.angles:
        yield from _arc(np.array(angle.apex), angle.radius, angle.first, angle.last)
    if drawing.frame is not None:
        yield from np.array([*drawing.frame.hinges, *(drawing.frame.guide or ())])


def _arc(centre: Array, radius: float, first: float, last: float) -> Array:
    turn = np.linspace(first, last, 2 + int(abs(last - first) / STEP))
    return np.asarray(centre + radius * np.stack([np.cos(turn), np.sin(turn)], axis=1))


def _draw_line(page: DrawingPage, axes: Axes, view: PageView, line: GeometryLine) -> None:
    """A line with its head; names keep clear of it."""
    width = (MAIN if line.look is LineLook.MAIN else THIN) / POINT
    axes.plot(
        *line.places.T, color=INK, linewidth=width, linestyle=DASHES[line.look], zorder=2.0 + width / 10.0
    )
    places = view.mm(line.places)
    page.avoid(pairwise(places[:: max(1, len(places) // AVOIDED)]))
    if line.head:
        way = places[-1] - places[-2]
        page.overlay.add_patch(page_head(places[-1], way / float(np.hypot(*way))))


def _draw_frame(axes: Axes, frame: GeometryFrame, size: float) -> None:
    """Hinges, how the body on the first of them turns, and a guide; `size` is the radius of a hinge [m]."""
    for place in frame.hinges:
        signs.fixed_hinge(axes, np.array(place), size, INK)
    if frame.sense:
        arc = signs.turning_arc(np.array(frame.hinges[0]), 0.0, frame.sense > 0.0, size)
        signs.turning_arrow(axes, arc, INK)
    if frame.guide is None:
        return
    low, high = np.array(frame.guide)
    along = (high - low) / float(np.hypot(*(high - low)))
    across = np.array([along[1], -along[0]])
    for side in (-1.0, 1.0):
        aside = side * WALL * size * across
        signs.ground(axes, low + aside, high + aside, side * across, size, INK)


def _draw_angle(
    page: DrawingPage, axes: Axes, view: PageView, angle: GeometryAngle, spelling: FigureSpelling
) -> None:
    """An arc between two directions, with heads where there is room for them, and its name."""
    arc = _arc(np.array(angle.apex), angle.radius, angle.first, angle.last)
    axes.plot(*arc.T, color=INK, linewidth=THIN / POINT, zorder=2.0)
    places = view.mm(arc)
    page.avoid(pairwise(places))
    if float(np.hypot(*np.diff(places, axis=0).T).sum()) >= LEAST_ARC:
        for tip, before in ((places[-1], places[-2]), (places[0], places[1])):
            way = tip - before
            page.overlay.add_patch(page_head(tip, way / float(np.hypot(*way))))
    page.name(places[len(places) // 2], spelling.text(angle.text), clear=1.0)


def write_facts(page: DrawingPage, field: SheetField, lines: list[tuple[str, str]]) -> None:
    """What is given and found, one below the other from the top of a field, the values in a column of their own."""
    rows = [
        ("" if number else label, part)
        for label, value in lines
        for number, part in enumerate(_value_lines(label, value, float(field.size[0])))
    ]
    step = min(2.2 * USUAL, float(field.size[1]) / max(1, len(rows)))
    left, top = float(field.corner[0]), float(field.end[1])
    for number, (label, value) in enumerate(rows):
        up = top - (number + 1) * step
        page.write_in(USUAL, left, up, label, ha="left", va="bottom")
        page.write_in(USUAL, float(field.end[0]), up, value, ha="right", va="bottom")


def _value_lines(label: str, value: str, width: float) -> list[str]:
    """A value beside its label; where it does not fit there, below it, or else in as many lines as it needs."""
    beside = wrapped_lines(value, width - letters_width(label, USUAL), USUAL)
    whole = wrapped_lines(value, width, USUAL)
    return ["", *whole] if len(beside) > 1 and len(whole) == 1 else beside
