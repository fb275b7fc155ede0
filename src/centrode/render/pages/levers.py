"""Zhukovsky's lever as a page: the turned velocity diagram with all forces at the images of their places."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from centrode.locale import _
from centrode.model.settings import shown_as
from centrode.numerics.round_scales import round_scale
from centrode.render.drawing import signs
from centrode.render.drawing.style import INK, pens
from centrode.render.figures.linkages import caption
from centrode.render.pages.force_column import FOOT, GUTTER, LEFT, TOP, write_column, write_title
from centrode.render.pages.force_signs import force_arrows, moment_arc
from centrode.render.pages.page import Page, PageView, flat, new_page, typeset
from centrode.render.spelling import DrawingSpelling
from centrode.scenes.places import corners

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from centrode.dynamics.force_polygons.polygons import ForcePolygons, Lever
    from centrode.sheets.force_pages import LeverPage

WIDE = 0.68
"""Share of the sheet that the lever has."""
TOGETHER = 0.7
"""Images nearer than this [mm] get one name."""
TINY = 1e-12


def lever_page(sheet: LeverPage) -> Figure:
    """The lever with its forces, and the moments about its pole."""
    found, lever = sheet.forces, sheet.forces.levers[sheet.lever]
    spelling = DrawingSpelling(found.mechanism.display)
    page = new_page(found.paper_size)
    wide, high = page.size
    factor, unit = shown_as("m", found.mechanism.display)
    if lever.unit == "N":
        factor, unit = 1.0, "1"
    corner, size = np.array([LEFT, FOOT]), np.array([WIDE * wide, high - TOP - FOOT - GUTTER])
    ends = flat([0j, *lever.images.values(), *(one.image for one in lever.forces)])
    scale = lever_scale(found, lever)
    view = PageView.about(corner, size, factor * ends, scale)
    draw_outlines(page, view, found, lever, factor)
    name_images(page, view, lever, factor)
    draw_forces(page, view, found, lever, factor)
    column = lever_column(found)
    per = "/rad" if lever.unit == "N m" else ""
    size_of = f"{scale:g} {unit}{per}" if unit != "1" else f"{scale:g}"
    heads = [caption(found.mechanism, found.exact, 0), f"$\\mu_v$ = {size_of} " + _("per mm")]
    write_title(page, column, spelling.text(sheet.title), found.mechanism)
    write_column(page, column, spelling.text(sheet.heading), heads, list(map(spelling.text, sheet.lines)))
    page.place_names(np.array([[1.0, 1.0], [column - 1.0, high - TOP + 2.0]]))
    return page.figure


def lever_column(found: ForcePolygons) -> float:
    """Where the column of text begins on the page of a lever [mm]."""
    return LEFT + WIDE * found.paper_size[0] + GUTTER


def lever_scale(found: ForcePolygons, lever: Lever) -> float:
    """What a millimetre of the lever stands for, in the display's unit of lengths by radian."""
    wide, high = found.paper_size
    factor = 1.0 if lever.unit == "N" else shown_as("m", found.mechanism.display)[0]
    ends = flat([0j, *lever.images.values(), *(one.image for one in lever.forces)])
    # names and arrows need room around the lever
    room = np.array([WIDE * wide, high - TOP - FOOT - GUTTER]) - 46.0
    return round_scale(float(np.max(factor * np.ptp(ends, axis=0) / room)))


def draw_outlines(page: Page, view: PageView, found: ForcePolygons, lever: Lever, factor: float) -> None:
    """Images of the links, and thin lines from the pole."""
    colours = pens(found.mechanism.link_names)
    for name, link in found.mechanism.links.items():
        places = [view.mm(flat([factor * lever.images[point]])[0]) for point in corners(link)]
        if len(places) < 2:
            continue
        path = np.array([*places, places[0]])
        page.overlay.plot(
            *path.T, color=colours[name].colour, linestyle=colours[name].dashes, linewidth=1.6, zorder=4
        )
        page.avoid(pairwise(path))


def name_images(page: Page, view: PageView, lever: Lever, factor: float) -> None:
    """The pole and the images of the points; those that coincide share a name."""
    named = [(view.mm(np.zeros(2)), ["p_v"])]
    for name, image in lever.images.items():
        at = view.mm(flat([factor * image])[0])
        near = next((names for place, names in named if np.hypot(*(place - at)) < TOGETHER), None)
        if near is not None:
            near.append(name.lower())
        else:
            named.append((at, [name.lower()]))
    for at, names in named:
        signs.hinge(page.overlay, at, 0.9)
        text = ", ".join(names[:6]) + (", …" if len(names) > 6 else "")
        page.name(at, typeset(text), clear=1.6, size=9.0)


def draw_forces(page: Page, view: PageView, found: ForcePolygons, lever: Lever, factor: float) -> None:
    """Forces at their images, couples in the middle of the images of their links; at the pole none turns the lever."""
    acting = [one for one in lever.forces if one.force != 0 and one.image != 0]
    force_arrows(page, [(o.name, o.force, view.mm(flat([factor * o.image])[0]), INK) for o in acting])
    greatest = max((abs(one.moment) for one in lever.forces), default=0.0)
    for one in lever.forces:
        if abs(one.couple) <= TINY * greatest:
            continue
        points = lever.links.get(one.body, ())
        middle = sum((lever.images[point] for point in points), 0j) / max(1, len(points))
        moment_arc(page, view.mm(flat([factor * middle])[0]), one.couple, one.name)
    if lever.unit == "N m" and abs(lever.balancing) > TINY * greatest:
        moment_arc(page, view.mm(np.zeros(2)), lever.balancing, "Mb")
