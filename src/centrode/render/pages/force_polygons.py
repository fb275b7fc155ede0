"""Force polygons as pages of a document: a group with its forces, beside it its polygon to scale."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from centrode.locale import _
from centrode.model.settings import shown_as
from centrode.numerics.round_scales import FORCE_SCALES, round_scale
from centrode.quantities import spelled_unit
from centrode.render.drawing.style import INK, MUTED, Pen, pens
from centrode.render.figures.linkages import caption
from centrode.render.pages.force_column import FOOT, GUTTER, LEFT, TOP, write_column, write_title
from centrode.render.pages.force_groups import draw_group
from centrode.render.pages.force_signs import force_name
from centrode.render.pages.levers import lever_column
from centrode.render.pages.page import INCH, Array, Page, PageView, arrow, flat, new_page
from centrode.render.pages.screens import scale_on_screen, screen_millimetres, write_scale_bars
from centrode.render.spelling import DrawingSpelling
from centrode.scenes.linkage import scene_of
from centrode.sheets.force_pages import GroupPage

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from centrode.sheets.force_pages import DrawnPolygon, ForceStroke, LeverPage

SHORT = 0.5
"""Vectors shorter than this [mm] are told, not drawn."""
AROUND = 38.0
"""Room around a group for the arrows of its forces [mm]."""
TALLEST = 130.0
"""The most height of a group or of its polygon, one above the other [mm]."""
DRAWN, ROOM = 0.30, 0.38
"""Shares of the sheet's width for the group and for its polygon."""
LOOKS: Mapping[str, tuple[Any, float]] = {
    "force": ("-", 1.3),
    "part": ((0, (4.0, 1.6)), 0.8),
    "sum": ("-", 1.6),
    "chord": ((0, (6.0, 1.5, 1.2, 1.5)), 1.2),
}
"""Dashes and width of the arrows of a polygon."""


def group_page(sheet: GroupPage) -> Figure:
    """A group with its forces, its polygon, and what was done; a millimetre is what the page says.

    On a screen that is narrower than both, the polygon stands below the group, and nothing beside them.
    """
    if is_stacked(sheet):
        return stacked_drawings(sheet)
    mechanism = sheet.mechanism
    spelling = DrawingSpelling(mechanism.display)
    page = new_page(sheet.paper)
    wide, high = page.size
    drawn, room = DRAWN * wide, ROOM * wide
    height = high - TOP - FOOT - GUTTER
    factor, unit = shown_as("m", mechanism.display)
    places = flat([factor * place for place in sheet.corners])
    length = group_scale(sheet)
    view = PageView.about(np.array([LEFT, FOOT]), np.array([drawn, height]), places, length)
    draw_group(page, view, sheet, scene_of(mechanism, sheet.instant))
    corner, size = np.array([LEFT + drawn + GUTTER, FOOT]), np.array([room, height])
    scale = draw_polygons(page, sheet, corner, size)
    column = column_of(sheet)
    heads = [
        caption(mechanism, sheet.instant, 0),
        f"$\\mu_l$ = {length:g} {spelled_unit(unit)} " + _("per mm"),
    ]
    heads.append(f"$\\mu_F$ = {scale:g} {spelled_unit('N')} " + _("per mm"))
    sizes = (
        f"{name} = {force:.6g} {spelled_unit('N')}, {force / scale:.1f} {spelled_unit('mm')}"
        for name, force in sheet.sizes
    )
    lines = [*(spelling.text(line) for line in sheet.lines), "", *sizes]
    write_column(page, column, spelling.text(sheet.heading), heads, lines)
    write_title(page, column, spelling.text(sheet.title), mechanism)
    page.place_names(np.array([[1.0, 1.0], [column - 1.0, high - TOP + 2.0]]))
    write_scale_bars(page, LEFT, [(length, unit), (scale, "N")])
    return page.figure


def is_stacked(sheet: GroupPage) -> bool:
    """Whether a group and its polygon stand one above the other."""
    return column_of(sheet) > screen_millimetres()


def stacked_drawings(sheet: GroupPage) -> Figure:
    """A group above its polygon, each in the whole width of a screen, at the scales that go into it."""
    wide, mechanism = screen_millimetres(), sheet.mechanism
    factor, unit = shown_as("m", mechanism.display)
    room = np.array([wide - 2.0 * LEFT, TALLEST])
    extents, places = _extents(sheet), flat([factor * place for place in sheet.corners])
    length = round_scale(float(np.max(extents / (room - AROUND))))
    several = sheet.together and len(sheet.bodies) > 1
    polygons = (
        sheet.polygons if several else tuple(_fitting(one, room - 2.0 * GUTTER) for one in sheet.polygons)
    )
    sheet = replace(sheet, polygons=polygons)
    up = float(np.ptp(places, axis=0)[1]) / length + AROUND
    low = TALLEST if several else max(_height(one) for one in polygons) + 3.0 * GUTTER
    page = new_page((wide, FOOT + low + up + TOP))
    view = PageView.about(np.array([LEFT, FOOT + low]), np.array([room[0], up]), places, length)
    draw_group(page, view, sheet, scene_of(mechanism, sheet.instant))
    scale = draw_polygons(page, sheet, np.array([LEFT, FOOT]), np.array([room[0], low]))
    page.place_names(np.array([[1.0, 1.0], [wide - 1.0, FOOT + low + up]]))
    write_scale_bars(page, LEFT, [(length, unit), (scale, "N")])
    return page.figure


def _fitting(polygon: DrawnPolygon, room: Array) -> DrawnPolygon:
    """A polygon at a scale at which it goes into its room."""
    extents = np.ptp(_corners(polygon), axis=0)
    scale = scale_on_screen(polygon.scale, lambda one: bool((extents / one <= room).all()), FORCE_SCALES)
    return replace(polygon, scale=scale)


def _height(polygon: DrawnPolygon) -> float:
    return float(np.ptp(_corners(polygon)[:, 1])) / polygon.scale


def _corners(polygon: DrawnPolygon) -> Array:
    """Where the arrows of a polygon begin and end [N]."""
    return flat([0j, *(end for stroke in polygon.strokes for end in (stroke.start, stroke.end))])


def column_of(sheet: GroupPage) -> float:
    """Where the column of text begins on the page of a group [mm]."""
    return LEFT + (DRAWN + ROOM) * sheet.paper[0] + 2 * GUTTER


def group_scale(sheet: GroupPage) -> float:
    """What a millimetre of the drawn group stands for, in the display's unit of lengths."""
    wide, high = sheet.paper
    room = np.array([DRAWN * wide, high - TOP - FOOT - GUTTER]) - AROUND
    return round_scale(float(np.max(_extents(sheet) / room)))


def _extents(sheet: GroupPage) -> Array:
    """Sides of a group, in the display's unit of lengths; those of the mechanism where its sliders are in one place."""
    factor, _unit = shown_as("m", sheet.mechanism.display)
    extents = np.ptp(flat([factor * place for place in sheet.corners]), axis=0)
    if not extents.any():
        extents = np.ptp(flat([factor * place for place in sheet.all_corners]), axis=0)
    return np.asarray(extents)


def drawing_end(sheet: GroupPage | LeverPage, figure: Figure) -> tuple[float, float]:
    """Where the drawing of a page ends at its column of text, and at its head [mm]."""
    if isinstance(sheet, GroupPage) and is_stacked(sheet):
        return screen_millimetres(), float(figure.get_figheight()) * INCH - TOP
    column = column_of(sheet) if isinstance(sheet, GroupPage) else lever_column(sheet)
    return column, sheet.paper[1] - TOP


def group_scales(sheet: GroupPage) -> Iterator[tuple[str, float, str]]:
    """Letter, value and unit of the scales of a group: what a millimetre of each drawing stands for."""
    yield "l", group_scale(sheet), shown_as("m", sheet.mechanism.display)[1]
    if not sheet.together:  # the polygons of its links share a scale that the page alone names
        yield "F", sheet.polygons[0].scale, "N"


def draw_polygons(page: Page, sheet: GroupPage, corner: Array, size: Array) -> float:
    """The polygon of a group; of one solved together those of its links side by side. Returns the scale."""
    colours = pens(sheet.mechanism.link_names)
    if not sheet.together or len(sheet.bodies) == 1:
        (polygon,) = sheet.polygons
        draw_polygon(page, polygon, corner, size, polygon.scale, colours)
        return polygon.scale
    across = math.ceil(math.sqrt(len(sheet.polygons)))
    cell = size / np.array([across, max(1, math.ceil(len(sheet.polygons) / across))])
    least = max((polygon.scale * float(max(size / cell)) for polygon in sheet.polygons), default=1.0)
    scale = round_scale(least, series=FORCE_SCALES)
    for number, polygon in enumerate(sheet.polygons):
        place = np.array([number % across, number // across])
        at = corner + place * cell
        draw_polygon(page, polygon, at, cell, scale, colours)
        text = _("link {link}").format(link=polygon.number)
        page.write(at[0] + 2.0, at[1] + cell[1] - 4.0, text, size=8.0, color=MUTED)
    return scale


def draw_polygon(
    page: Page, polygon: DrawnPolygon, corner: Array, size: Array, scale: float, colours: Mapping[str, Pen]
) -> None:
    """The forces one behind the other, the sums of reactions found in parts, and the inner reactions."""
    closed = [stroke.end for stroke in polygon.strokes if stroke.kind in ("force", "part")]
    view = PageView.about(corner, size, flat([0j, *closed]), scale)
    short = {one.name for one in polygon.strokes if one.kind == "sum" and not has_long_parts(polygon, one)}
    for stroke in polygon.strokes:
        if abs(stroke.end - stroke.start) < SHORT * scale or stroke.whole in short:
            continue
        dashes, width = LOOKS[stroke.kind]
        colour = colours[stroke.link].colour if stroke.link else INK
        places = [view.mm(place) for place in flat([stroke.start, stroke.end])]
        arrow(page, places[0], places[1], colour, dashes, width)
        share = 0.42 if stroke.kind == "chord" else 0.5
        middle = places[0] + share * (places[1] - places[0])
        page.name(middle, force_name(stroke.name), clear=0.8, size=8.5, colour=colour)
    start = view.mm(np.zeros(2))
    page.overlay.plot([start[0]], [start[1]], marker="o", markersize=2.5, color=INK, zorder=6)


def has_long_parts(polygon: DrawnPolygon, whole: ForceStroke) -> bool:
    """Whether both parts of a reaction are long enough to be seen."""
    parts = (stroke for stroke in polygon.strokes if stroke.whole == whole.name)
    return all(abs(part.force) / polygon.scale > SHORT for part in parts)
