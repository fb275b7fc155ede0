"""Drawings of a sheet in their fields, each at a standard scale that is written below it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import xarray

from centrode.errors import InputError
from centrode.locale import _, decimal_mark
from centrode.quantities import spelled_unit
from centrode.render.drafting.drawing_page import HEADING, SIGNS, USUAL, DrawingPage, SheetField
from centrode.render.drafting.scales import DrawingScale, diagram_scale, largest_standard_scale
from centrode.render.drawing.style import Pen, pens
from centrode.render.drawing.texts import plain
from centrode.render.figures.linkages import caption
from centrode.render.pages.force_groups import draw_group
from centrode.render.pages.force_polygons import draw_polygon
from centrode.render.pages.levers import draw_forces as draw_lever_forces
from centrode.render.pages.levers import draw_outlines, name_images
from centrode.render.pages.page import Array, PageView, flat
from centrode.render.pages.positions import draw_paths, draw_positions, number_path
from centrode.render.pages.vector_diagrams import draw_images, draw_strokes, name_strokes
from centrode.render.spelling import FigureSpelling
from centrode.scenes.linkage import scene_of
from centrode.scenes.places import SIGN_INCHES

if TYPE_CHECKING:
    from centrode.sheets.force_pages import DrawnPolygon, GroupPage, LeverPage
    from centrode.sheets.pages import PositionsPage, VectorDiagramPage

METRE = 1000.0
"""Millimetres."""
SIGN = 1.1 * SIGNS
"""Radius of a hinge's circle [mm]."""
AROUND = 17.0
"""Room around a mechanism for its signs and names [mm]."""
OF_PLANS, OF_POLYGONS = 14.0, 11.0
"""The same around a plan of vectors and a polygon of forces, for names."""
OF_GROUPS = 26.0
"""The same around a group, for its forces."""
CAPTION = 17.0
"""Room for the title and the scales below a drawing [mm]."""
LINE = 6.5
"""From line to line [mm]."""


def scale_text(symbol: str, value: float, unit: str) -> str:
    """What a millimetre stands for: "μ_v = 0.02 (m/s)/mm", its letter as mathematics."""
    shown = spelled_unit(unit) or "1"
    shown = f"({shown})" if "/" in shown or "·" in shown or "⋅" in shown else shown
    return f"$\\mu_{{{symbol}}}$ = {number_text(value)} {shown}/{spelled_unit('mm')}"


def number_text(value: float) -> str:
    """A round number, with the decimal mark of the language and a minus as in print."""
    return f"{value:.12g}".replace(".", decimal_mark()).replace("-", "−")


def ratio_text(scale: DrawingScale) -> str:
    """A scale as it stands in title blocks, with the decimal mark of the language."""
    return scale.text.replace(".", decimal_mark())


def length_captions(scale: DrawingScale) -> list[str]:
    """What a millimetre of a drawing of lengths stands for, and its ratio."""
    ratio = _("scale {ratio}").format(ratio=ratio_text(scale))
    return [scale_text("l", 1.0 / METRE / scale.ratio, "m"), ratio]


def fitting_scale(ratios: Array, wanted: DrawingScale | None) -> DrawingScale:
    """The largest standard scale not greater than any of some ratios of paper to reality, or the wanted one.

    Raises
    ------
    InputError
        The scale that is wanted is larger than that.
    """
    largest = largest_standard_scale(float(np.min(ratios)))
    if wanted is not None and wanted.ratio > largest.ratio:
        raise InputError(
            "--scale",
            _("{scale} is too large for the sheet").format(scale=wanted.text),
            _("the largest standard scale is {scale}").format(scale=largest.text),
        )
    return wanted or largest


def write_caption(page: DrawingPage, field: SheetField, title: str, scales: Sequence[str]) -> None:
    """Title and scales in the middle below a drawing."""
    middle = float(field.corner[0] + field.size[0] / 2)
    up = float(field.corner[1])
    page.write_in(HEADING, middle, up + 1.5 + LINE, title, ha="center", va="bottom")
    page.write_in(USUAL, middle, up + 1.5, ";   ".join(scales), ha="center", va="bottom")


def begin(page: DrawingPage, field: SheetField) -> SheetField:
    """Forget lines and names of other drawings; the part of a field above its caption."""
    page.segments.clear()
    page.forget_texts()
    return field.part(bottom=CAPTION)


# A mechanism in its positions


def draw_positions_plate(
    page: DrawingPage, field: SheetField, sheet: PositionsPage, wanted: DrawingScale | None
) -> DrawingScale:
    """Numbered positions with the paths of the points; returns the scale.

    Raises
    ------
    InputError
        The scale that is wanted is too large for the field.
    """
    mechanism = sheet.mechanism
    together = [data.drop_dims("event", errors="ignore") for data in (sheet.positions, sheet.path)]
    scene = scene_of(mechanism, xarray.concat(together, dim="sample", data_vars="minimal"))
    inner = begin(page, field)
    size = METRE / scene.factor * (scene.high - scene.low)
    scale = fitting_scale((inner.size - 2.0 * AROUND) / size, wanted)
    unit = scene.factor / METRE / scale.ratio
    view = PageView.about(inner.corner, inner.size, np.array([scene.low, scene.high]), unit)
    scene = replace(scene, inches=SIGN_INCHES * scene.extent / (SIGN * unit))
    count = sheet.positions.sizes["sample"]
    draw_positions(page, view, scene, count)
    draw_paths(page, view, scene, count)
    for name, place in scene.at(0).items():
        page.name(view.mm(place), plain(name), clear=1.7, size=9.0)
    for name in sheet.numbered:
        number_path(page, view, scene, name, count)
    page.place_names(inner.box)
    title = FigureSpelling(mechanism.display).text(sheet.title)
    first = _("position {number}").format(number=0) + ": " + caption(mechanism, sheet.positions, 0)
    write_caption(page, field, title, [*length_captions(scale), first])
    return scale


# Plans of velocities and accelerations


def draw_plan_plate(page: DrawingPage, field: SheetField, sheet: VectorDiagramPage) -> float:
    """A plan of velocities or accelerations; returns what a millimetre of it stands for, in SI."""
    inner = begin(page, field)
    places = flat(sheet.corners)
    room = inner.size - 2.0 * OF_PLANS
    scale = diagram_scale(float(np.max(np.ptp(places, axis=0) / room)), 1.0)
    view = PageView.about(inner.corner, inner.size, places, scale)
    drawn = draw_strokes(page, view, sheet.strokes, 1.0, pens(sheet.mechanism.link_names))
    draw_images(page, view, sheet, 1.0)
    name_strokes(page, view, drawn, sheet.order, 1.0, pens(sheet.mechanism.link_names))
    page.place_names(inner.box)
    title = FigureSpelling(sheet.mechanism.display).text(sheet.title)
    symbol = "v" if sheet.order == 1 else "a"
    instant = caption(sheet.mechanism, sheet.instant, 0)
    write_caption(page, field, title, [scale_text(symbol, scale, sheet.unit), instant])
    return scale


# Groups with their polygons of forces


def polygon_extents(polygon: DrawnPolygon) -> Array:
    """Sides of a polygon [N]."""
    ends = [one.end for one in polygon.strokes if one.kind in ("force", "part")]
    return np.asarray(np.ptp(flat([0j, *ends]), axis=0))


def draw_group_plate(page: DrawingPage, field: SheetField, sheet: GroupPage) -> tuple[float, float]:
    """A group with the forces on it, beside it its polygon; returns the scales of lengths and forces, in SI."""
    inner = begin(page, field)
    mechanism = sheet.mechanism
    left, right = inner.share(2, 0), inner.share(2, 1)
    extents = np.ptp(flat(sheet.corners), axis=0)
    if not extents.any():
        extents = np.ptp(flat(sheet.all_corners), axis=0)
    with np.errstate(divide="ignore"):
        fits = float(np.min((left.size - 2.0 * OF_GROUPS) / (METRE * extents)))
    length = largest_standard_scale(fits)
    scene = scene_of(mechanism, sheet.instant)
    places = scene.factor * flat(sheet.corners)
    view = PageView.about(left.corner, left.size, places, scene.factor / METRE / length.ratio)
    draw_group(page, view, sheet, scene)
    force = _draw_polygons(page, right, sheet.polygons, pens(mechanism.link_names))
    page.place_names(inner.box)
    per = 1.0 / METRE / length.ratio
    scales = [scale_text("l", per, "m"), scale_text("F", force, "N"), caption(mechanism, sheet.instant, 0)]
    write_caption(page, field, FigureSpelling(mechanism.display).text(sheet.heading), scales)
    return per, force


def draw_lever_plate(page: DrawingPage, field: SheetField, sheet: LeverPage) -> float:
    """Zhukovsky's lever with all forces; returns what a millimetre stands for [m/rad, or a plain number]."""
    inner = begin(page, field)
    places = flat(sheet.corners)
    scale = diagram_scale(float(np.max(np.ptp(places, axis=0) / (inner.size - 2.0 * OF_GROUPS))), 1.0)
    view = PageView.about(inner.corner, inner.size, places, scale)
    draw_outlines(page, view, sheet, 1.0)
    name_images(page, view, sheet, 1.0)
    draw_lever_forces(page, view, sheet, 1.0)
    page.place_names(inner.box)
    spelling = FigureSpelling(sheet.mechanism.display)
    unit = "m/rad" if sheet.unit == "N m" else "1"
    scales = [scale_text("v", scale, unit), caption(sheet.mechanism, sheet.instant, 0)]
    write_caption(page, field, spelling.text(sheet.title), scales)
    return scale


def _draw_polygons(
    page: DrawingPage, field: SheetField, polygons: Sequence[DrawnPolygon], colours: Mapping[str, Pen]
) -> float:
    """Polygons side by side, to one scale [N/mm]."""
    across = int(np.ceil(np.sqrt(len(polygons))))
    up = -(-len(polygons) // across)
    cells = [field.share(across, k % across, up, k // across) for k in range(len(polygons))]
    room = cells[0].size - 2.0 * OF_POLYGONS
    least = max(float(np.max(polygon_extents(polygon) / room)) for polygon in polygons)
    scale = diagram_scale(least, 1.0)
    for polygon, cell in zip(polygons, cells, strict=True):
        draw_polygon(page, polygon, cell.corner, cell.size, scale, colours)
        if polygon.number:
            text = _("link {link}").format(link=polygon.number)
            page.write_in(USUAL, float(cell.corner[0]) + 3.0, float(cell.end[1]) - 6.0, text)
    return scale
