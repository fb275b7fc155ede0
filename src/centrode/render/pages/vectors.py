"""Pages of a mechanism at an instant with vectors that act on it, both to true scale."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from centrode.locale import _
from centrode.model.settings import shown_as
from centrode.numerics.round_scales import round_scale
from centrode.quantities import spelled_unit
from centrode.render.drawing.linkage import draw_bodies
from centrode.render.drawing.style import GROUND, INK, pens
from centrode.render.drawing.tags import lines
from centrode.render.drawing.texts import plain
from centrode.render.figures.linkages import caption
from centrode.render.pages.force_signs import moment_arc
from centrode.render.pages.instants import drawing_end
from centrode.render.pages.page import (
    BESIDE,
    CORNER,
    SIZE,
    TOP,
    Array,
    Page,
    PageView,
    arrow,
    new_page,
    write_head,
)
from centrode.render.pages.screens import size_on_screen, write_scale_bars
from centrode.render.spelling import DrawingSpelling
from centrode.scenes.linkage import scene_of
from centrode.scenes.places import SIGN_INCHES, LinkageScene

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from centrode.sheets.plots import VectorOnBody, VectorPage

SIGN = 1.1
"""Radius of a hinge's circle [mm]."""
LONGEST = 26.0
"""Most that a vector is long [mm]."""
SHORTEST = 0.8
"""Vectors shorter than this [mm] are left out."""


def vector_page(sheet: VectorPage) -> Figure:
    """The mechanism with arrows and arcs of moments, the scales and the lines of the column at the right."""
    mechanism, motion, sample = sheet.pose
    spelling = DrawingSpelling(mechanism.display)
    scene = scene_of(mechanism, motion)
    places = scene.at(sample)
    # vectors without a body's colour follow the scale of the others
    greatest = max(float(np.nan_to_num(np.hypot(*one.components))) for one in sheet.vectors if one.link)
    page, per_mm = new_page(), round_scale(greatest, LONGEST)
    scene, view = _place(scene, sample)
    axes, links = view.axes(page), pens(mechanism.link_names)
    draw_bodies(axes, scene, sample, links)
    page.avoid((view.mm(a), view.mm(b)) for a, b in lines(scene, sample))
    for name, place in places.items():
        page.name(view.mm(place), plain(name), clear=SIGN + 0.6, size=9.0)
    colours = {name: pen.colour for name, pen in links.items()} | {"frame": GROUND, "": INK}
    for vector in sheet.vectors:
        if vector.point in places:
            name, colour = plain(spelling.text(vector.name)), colours[vector.link]
            _draw(page, view.mm(places[vector.point]), vector, per_mm, name, colour)
    for moment in sheet.moments:
        if moment.point in places:
            moment_arc(page, view.mm(places[moment.point]), moment.value, moment.symbol)
    head = [
        caption(mechanism, motion, sample),
        f"μ_l = {view.scale:g} {spelled_unit(shown_as('m', mechanism.display)[1])} " + _("per mm"),
        f"{sheet.symbol} = {per_mm:g} {spelled_unit(sheet.unit)} " + _("per mm"),
    ]
    write_head(page, spelling.text(sheet.title), mechanism, head, [spelling.text(one) for one in sheet.lines])
    page.place_names(np.array([[1.0, 1.0], [drawing_end()[0] - 1.0, TOP - 3.0]]))
    write_scale_bars(
        page,
        CORNER[0],
        [(view.scale, shown_as("m", mechanism.display)[1]), (per_mm, sheet.unit)],
        caption(mechanism, motion, sample),
    )
    return page.figure


def _place(scene: LinkageScene, sample: int) -> tuple[LinkageScene, PageView]:
    """The scene with signs as large as on the page, and a view of the sample with room for arrows around it."""
    spots = [np.array(list(scene.at(sample).values()))]
    for guide in scene.mechanism.guides:
        ends = scene.guide_line(guide, sample) if guide.on == "frame" else None
        spots += [] if ends is None else [np.array(ends)]
    around = np.vstack(spots)
    extent = float(np.max(np.ptp(around, axis=0))) or 1.0
    size = size_on_screen(SIZE, BESIDE)
    scale = round_scale(extent, float(size[0]) - 2.0 * LONGEST)  # between the arrows
    inches = SIGN_INCHES * scene.extent / (SIGN * scale)
    return replace(scene, inches=inches), PageView.about(CORNER, size, around, scale)


def _draw(page: Page, start: Array, vector: VectorOnBody, per_mm: float, name: str, colour: str) -> None:
    """A vector to scale from where it acts, with its name; nothing where it is unknown or too short to be seen."""
    along = np.array(vector.components) / per_mm
    if np.isfinite(along).all() and np.hypot(*along) >= SHORTEST:
        arrow(page, start, start + along, colour, width=1.3)
        page.name(start + along, name, clear=0.8, size=7.5, colour=colour)
