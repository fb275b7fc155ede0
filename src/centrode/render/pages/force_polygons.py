"""Force polygons as pages of a document: a group with its forces, beside it its polygon to scale."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

import numpy as np

from centrode.locale import _
from centrode.model.settings import shown_as
from centrode.numerics.round_scales import FORCE_SCALES, round_scale
from centrode.render.drawing.style import INK, MUTED, Pen, pens
from centrode.render.figures.linkages import caption
from centrode.render.pages.force_column import FOOT, GUTTER, LEFT, TOP, write_column, write_title
from centrode.render.pages.force_groups import draw_group
from centrode.render.pages.force_signs import force_name
from centrode.render.pages.levers import lever_column
from centrode.render.pages.page import Array, Page, PageView, arrow, flat, new_page
from centrode.render.spelling import DrawingSpelling
from centrode.scenes.linkage import scene_of
from centrode.sheets.force_pages import GroupPage

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from centrode.dynamics.force_polygons.polygons import ForcePolygons, GroupForces, Polygon, PolygonVector
    from centrode.sheets.force_pages import LeverPage

SHORT = 0.5
"""Vectors shorter than this [mm] are told, not drawn."""
AROUND = 38.0
"""Room around a group for the arrows of its forces [mm]."""
DRAWN, ROOM = 0.30, 0.38
"""Shares of the sheet's width for the group and for its polygon."""
DASHED = (0, (4.0, 1.6))
CHORD = (0, (6.0, 1.5, 1.2, 1.5))


def group_page(sheet: GroupPage) -> Figure:
    """A group with its forces, its polygon, and what was done; a millimetre is what the page says."""
    found, group = sheet.forces, sheet.forces.groups[sheet.group]
    spelling = DrawingSpelling(found.mechanism.display)
    page = new_page(found.paper_size)
    wide, high = page.size
    drawn, room = DRAWN * wide, ROOM * wide
    height = high - TOP - FOOT - GUTTER
    factor, unit = shown_as("m", found.mechanism.display)
    scene = scene_of(found.mechanism, found.exact)
    places = flat([factor * place for place in shown_places(found, group)])
    length = group_scale(found, group)
    view = PageView.about(np.array([LEFT, FOOT]), np.array([drawn, height]), places, length)
    draw_group(page, view, found, group, scene)
    corner, size = np.array([LEFT + drawn + GUTTER, FOOT]), np.array([room, height])
    scale = draw_polygons(page, found, group, corner, size)
    column = column_of(found)
    heads = [caption(found.mechanism, found.exact, 0), f"$\\mu_l$ = {length:g} {unit} " + _("per mm")]
    heads.append(f"$\\mu_F$ = {scale:g} N " + _("per mm"))
    lines = [*(spelling.text(line) for line in sheet.lines), "", *lengths(group, scale)]
    write_column(page, column, spelling.text(sheet.heading), heads, lines)
    write_title(page, column, spelling.text(sheet.title), found.mechanism)
    page.place_names(np.array([[1.0, 1.0], [column - 1.0, high - TOP + 2.0]]))
    return page.figure


def column_of(found: ForcePolygons) -> float:
    """Where the column of text begins on the page of a group [mm]."""
    return LEFT + (DRAWN + ROOM) * found.paper_size[0] + 2 * GUTTER


def group_scale(found: ForcePolygons, group: GroupForces) -> float:
    """What a millimetre of the drawn group stands for, in the display's unit of lengths."""
    wide, high = found.paper_size
    factor, _unit = shown_as("m", found.mechanism.display)
    room = np.array([DRAWN * wide, high - TOP - FOOT - GUTTER]) - AROUND
    extents = np.ptp(flat([factor * place for place in shown_places(found, group)]), axis=0)
    if not extents.any():  # sliders in one place
        extents = np.ptp(flat([factor * place for place in found.places.values()]), axis=0)
    return round_scale(float(np.max(extents / room)))


def drawing_end(sheet: GroupPage | LeverPage) -> tuple[float, float]:
    """Where the drawing of a page ends at its column of text, and at its head [mm]."""
    found = sheet.forces
    column = column_of(found) if isinstance(sheet, GroupPage) else lever_column(found)
    return column, found.paper_size[1] - TOP


def group_scales(sheet: GroupPage) -> Iterator[tuple[str, float, str]]:
    """Letter, value and unit of the scales of a group: what a millimetre of each drawing stands for."""
    found, group = sheet.forces, sheet.forces.groups[sheet.group]
    yield "l", group_scale(found, group), shown_as("m", found.mechanism.display)[1]
    if group.kind != "together":  # the polygons of its links share a scale that the page alone names
        yield "F", group.polygon.scale, "N"


def shown_places(found: ForcePolygons, group: GroupForces) -> list[complex]:
    """Points of the group, its joints, and where forces act."""
    links = found.mechanism.links
    points = {point for body in group.bodies if body in links for point in links[body].coordinates}
    acting = [one.place for one in (*group.actions, *group.reactions) if one.force != 0]
    acting += [joint.place for joint in group.joints if joint.kind in ("hinge", "guide", "rolling")]
    return [*(found.places[point] for point in points), *acting, *rims(found, group)]


def rims(found: ForcePolygons, group: GroupForces) -> list[complex]:
    """Corners around the rolling wheels of the group."""
    wheels = [wheel for wheel in found.mechanism.rolling if wheel.link in group.bodies]
    return [
        found.places[wheel.centre] + wheel.radius * corner for wheel in wheels for corner in (1 + 1j, -1 - 1j)
    ]


def draw_polygons(page: Page, found: ForcePolygons, group: GroupForces, corner: Array, size: Array) -> float:
    """The polygon of a group; of one solved together those of its links side by side. Returns the scale."""
    colours = pens(found.mechanism.link_names)
    if group.kind != "together" or len(group.bodies) == 1:
        draw_polygon(page, group.polygon, corner, size, group.polygon.scale, colours)
        return group.polygon.scale
    shown = [polygon for polygon in group.link_polygons if polygon.vectors]
    across = math.ceil(math.sqrt(len(shown)))
    cell = size / np.array([across, max(1, math.ceil(len(shown) / across))])
    least = max((polygon.scale * float(max(size / cell)) for polygon in shown), default=1.0)
    scale = round_scale(least, series=FORCE_SCALES)
    for number, polygon in enumerate(shown):
        place = np.array([number % across, number // across])
        at = corner + place * cell
        draw_polygon(page, polygon, at, cell, scale, colours)
        body = found.names.index(polygon.bodies[0])
        page.write(
            at[0] + 2.0, at[1] + cell[1] - 4.0, _("link {link}").format(link=body), size=8.0, color=MUTED
        )
    return scale


def draw_polygon(
    page: Page,
    polygon: Polygon,
    corner: Array,
    size: Array,
    scale: float,
    colours: Mapping[str, Pen],
) -> None:
    """The forces one behind the other, the sums of reactions found in parts, and the inner reactions."""
    ends = [0j, *(vector.end for vector in polygon.vectors)]
    view = PageView.about(corner, size, flat(ends), scale)

    def draw(start: complex, end: complex, name: str, colour: str, dashes: object, width: float) -> None:
        if abs(end - start) < SHORT * scale:
            return
        places = [view.mm(place) for place in flat([start, end])]
        arrow(page, places[0], places[1], colour, dashes, width)
        share = 0.5 if dashes != CHORD else 0.42
        middle = places[0] + share * (places[1] - places[0])
        page.name(middle, force_name(name), clear=0.8, size=8.5, colour=colour)

    whole = {one.name for one in polygon.sums if not drawn_in_parts(polygon, one.name)}
    for vector in polygon.vectors:
        if vector.is_part and vector.whole in whole:
            continue
        colour = colour_of(vector, colours)
        dashes, width = (DASHED, 0.8) if vector.is_part else ("-", 1.3)
        draw(vector.start, vector.end, vector.name, colour, dashes, width)
    for one in polygon.sums:
        draw(one.start, one.end, one.name, colour_of(one, colours), "-", 1.6)
    for chord in polygon.chords:
        draw(chord.start, chord.end, chord.name, colour_of(chord, colours), CHORD, 1.2)
    start = view.mm(np.zeros(2))
    page.overlay.plot([start[0]], [start[1]], marker="o", markersize=2.5, color=INK, zorder=6)


def drawn_in_parts(polygon: Polygon, name: str) -> bool:
    """Whether both parts of a reaction are long enough to be seen."""
    return all(polygon.length(part) > SHORT for part in polygon.parts_of(name))


def colour_of(vector: PolygonVector, colours: Mapping[str, Pen]) -> str:
    """Reactions in the colour of the link they act on, the rest in black."""
    known = vector.source == "reaction" and vector.body in colours
    return colours[vector.body].colour if known else INK


def lengths(group: GroupForces, scale: float) -> Iterator[str]:
    """Every force with its length on paper."""
    shown = [*group.polygon.vectors, *group.polygon.sums, *group.polygon.chords]
    if group.kind == "together":
        shown = [vector for polygon in group.link_polygons for vector in polygon.vectors]
    for vector in {vector.name: vector for vector in shown}.values():
        size = abs(vector.force)
        yield f"{vector.name} = {size:.6g} N, {size / scale:.1f} mm"
