"""Zhukovsky's lever as a page: the turned velocity diagram with all forces at the images of their places."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from centrode.locale import _
from centrode.model.settings import shown_as
from centrode.numerics.round_scales import round_scale
from centrode.quantities import spelled_unit
from centrode.render.drawing import signs
from centrode.render.drawing.style import CURVE, INK, marker_options, pens
from centrode.render.figures.linkages import caption
from centrode.render.pages.force_column import FOOT, GUTTER, LEFT, TOP, write_column, write_title
from centrode.render.pages.force_signs import force_arrows, moment_arc
from centrode.render.pages.page import Array, Page, PageView, flat, new_page, typeset
from centrode.render.pages.screens import size_on_screen, write_scale_bars
from centrode.render.spelling import DrawingSpelling
from centrode.scenes.places import corners

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from centrode.sheets.force_pages import LeverPage

WIDE = 0.68
"""Share of the sheet that the lever has."""
TOGETHER = 0.7
"""Images nearer than this [mm] get one name."""


def lever_page(sheet: LeverPage) -> Figure:
    """The lever with its forces, and the moments about its pole."""
    mechanism = sheet.mechanism
    spelling = DrawingSpelling(mechanism.display)
    page = new_page(sheet.paper)
    _wide, high = page.size
    factor, unit = shown_as("m", mechanism.display)
    if sheet.unit == "N":
        factor, unit = 1.0, "1"
    corner, size = np.array([LEFT, FOOT]), drawing_size(sheet)
    scale = lever_scale(sheet)
    view = PageView.about(corner, size, factor * flat(sheet.corners), scale)
    draw_outlines(page, view, sheet, factor)
    name_images(page, view, sheet, factor)
    draw_forces(page, view, sheet, factor)
    column = lever_column(sheet)
    per = "/rad" if sheet.unit == "N m" else ""
    size_of = f"{scale:g} {spelled_unit(unit + per)}" if unit != "1" else f"{scale:g}"
    heads = [caption(mechanism, sheet.instant, 0), f"$\\mu_v$ = {size_of} " + _("per mm")]
    write_title(page, column, spelling.text(sheet.title), mechanism)
    write_column(page, column, spelling.text(sheet.heading), heads, list(map(spelling.text, sheet.lines)))
    page.place_names(np.array([[1.0, 1.0], [column - 1.0, high - TOP + 2.0]]))
    write_scale_bars(page, LEFT, [(scale, unit + per)] if unit != "1" else [])
    return page.figure


def lever_column(sheet: LeverPage) -> float:
    """Where the column of text begins on the page of a lever [mm]."""
    return LEFT + float(drawing_size(sheet)[0]) + GUTTER


def drawing_size(sheet: LeverPage) -> Array:
    """Sides of the room of a lever [mm]."""
    wide, high = sheet.paper
    return size_on_screen(np.array([WIDE * wide, high - TOP - FOOT - GUTTER]), LEFT + GUTTER)


def lever_scale(sheet: LeverPage) -> float:
    """What a millimetre of the lever stands for, in the display's unit of lengths by radian."""
    factor = 1.0 if sheet.unit == "N" else shown_as("m", sheet.mechanism.display)[0]
    # names and arrows need room around the lever
    room = drawing_size(sheet) - 46.0
    return round_scale(float(np.max(factor * np.ptp(flat(sheet.corners), axis=0) / room)))


def draw_outlines(page: Page, view: PageView, sheet: LeverPage, factor: float) -> None:
    """Images of the links, and thin lines from the pole."""
    colours = pens(sheet.mechanism.link_names)
    for name, link in sheet.mechanism.links.items():
        places = [view.mm(flat([factor * sheet.images[point]])[0]) for point in corners(link)]
        if len(places) < 2:
            continue
        path = np.array([*places, places[0]])
        pen = colours[name]
        page.overlay.plot(*path.T, color=pen.colour, linewidth=CURVE, zorder=4)
        page.overlay.plot(*path[:2].mean(axis=0), color=pen.colour, zorder=4, **marker_options(pen, None))
        page.avoid(pairwise(path))


def name_images(page: Page, view: PageView, sheet: LeverPage, factor: float) -> None:
    """The pole and the images of the points; those that coincide share a name."""
    named = [(view.mm(np.zeros(2)), ["p_v"])]
    for name, image in sheet.images.items():
        at = view.mm(flat([factor * image])[0])
        near = next((names for place, names in named if np.hypot(*(place - at)) < TOGETHER), None)
        if near is not None:
            near.append(name.lower())
        else:
            named.append((at, [name.lower()]))
    for at, names in named:
        signs.hinge(page.overlay, at, 0.9 * page.signs)
        text = ", ".join(names[:6]) + (", …" if len(names) > 6 else "")
        page.name(at, typeset(text), clear=1.6, size=9.0)


def draw_forces(page: Page, view: PageView, sheet: LeverPage, factor: float) -> None:
    """Forces and moments at their images."""

    def at(place: complex) -> Array:
        return view.mm(flat([factor * place])[0])

    force_arrows(page, [(one.name, one.force, at(one.place), INK) for one in sheet.forces])
    for one in sheet.moments:
        moment_arc(page, at(one.place), one.moment, one.name)
