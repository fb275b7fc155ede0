"""Diagrams of velocities and accelerations on pages, at their scales."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure

from centrode.locale import _
from centrode.model.settings import shown_as
from centrode.quantities import spelled_unit
from centrode.render.drawing.style import GROUND, INK, Pen, pens
from centrode.render.figures.linkages import caption
from centrode.render.pages.instants import drawing_end
from centrode.render.pages.page import (
    BESIDE,
    CORNER,
    NAMES,
    SIZE,
    TOP,
    Array,
    Page,
    PageView,
    arrow,
    flat,
    new_page,
    symbol,
    typeset,
    write_head,
)
from centrode.render.pages.screens import scale_on_screen, size_on_screen, write_scale_bars
from centrode.render.spelling import PrintSpelling

if TYPE_CHECKING:
    from centrode.model.settings import Display
    from centrode.sheets.pages import DiagramStroke, VectorDiagramPage

SHORT = 0.35
"""Vectors shorter than this [mm] are left out."""
TOGETHER = 0.7
"""Ends of vectors nearer than this [mm] get one name."""
DASHES: Mapping[str, Any] = {
    "normal": (0, (4, 1.5)),
    "coriolis": (0, (1.2, 1.0)),
    "carried": (0, (6, 1.5, 1.2, 1.5)),
    "image": (0, (2.0, 1.2)),
}


def vector_diagram_figure(sheet: VectorDiagramPage, display: Display) -> Figure:
    """A page A5 across: a diagram at its scale, which is true on paper, with the vector equations it was drawn by."""
    page = new_page()
    factor, unit = shown_as(sheet.unit, display)
    corners, size = flat([factor * corner for corner in sheet.corners]), size_on_screen(SIZE, BESIDE)
    scale = scale_on_screen(
        factor * sheet.scale, lambda one: bool((np.ptp(corners, axis=0) / one <= size - NAMES).all())
    )
    view = PageView.about(CORNER, size, corners, scale)
    colours = pens(sheet.mechanism.link_names)
    drawn = draw_strokes(page, view, sheet.strokes, factor, colours)
    draw_images(page, view, sheet, factor)
    name_strokes(page, view, drawn, sheet.order, factor, colours)
    spelling = PrintSpelling(display)
    symbol = "μ_v" if sheet.order == 1 else "μ_a"
    head = [
        caption(sheet.mechanism, sheet.instant, 0),
        f"{symbol} = {scale:g} {spelled_unit(unit)} " + _("per mm"),
    ]
    write_head(
        page, spelling.text(sheet.title), sheet.mechanism, head, [spelling.text(one) for one in sheet.lines]
    )
    page.place_names(np.array([[1.0, 1.0], [drawing_end()[0] - 1.0, TOP - 3.0]]))
    write_scale_bars(page, CORNER[0], [(scale, unit)])
    return page.figure


def draw_strokes(
    page: Page, view: PageView, strokes: Sequence[DiagramStroke], factor: float, colours: Mapping[str, Pen]
) -> list[DiagramStroke]:
    """Parts of vector equations and images of links; those too short or drawn already are left out."""
    drawn: list[DiagramStroke] = []
    seen: list[Array] = []
    for stroke in strokes:
        ends = np.array([view.mm(place) for place in flat([factor * stroke.start, factor * stroke.end])])
        if np.hypot(*(ends[1] - ends[0])) < SHORT:
            continue
        if any(min(abs(ends - other).max(), abs(ends[::-1] - other).max()) < SHORT for other in seen):
            continue
        seen.append(ends)
        drawn.append(stroke)
        colour = colours[stroke.link].colour if stroke.link in colours else GROUND
        if stroke.kind == "image":
            page.overlay.plot(*ends.T, color=colour, linewidth=0.8, linestyle=DASHES["image"], zorder=4)
            page.avoid([(ends[0], ends[1])])
        else:
            arrow(page, ends[0], ends[1], colour, DASHES.get(stroke.kind, "-"))
    return drawn


def draw_images(page: Page, view: PageView, sheet: VectorDiagramPage, factor: float) -> None:
    """The pole, and an arrow from it to the image of every point; images that coincide share a name.

    The pole is p_v or p_a, so that it is not taken for the image of a point P.
    """
    pole = view.mm(np.zeros(2))
    ends: list[tuple[Array, list[str]]] = [(pole, ["p_v" if sheet.order == 1 else "p_a"])]
    for name, image in sheet.images:
        end = view.mm(flat([factor * image])[0])
        near = next((names for at, names in ends if np.hypot(*(at - end)) < TOGETHER), None)
        if near is not None:
            near.append(name)
            continue
        ends.append((end, [name]))
        arrow(page, pole, end, INK, width=1.3)
    page.overlay.plot([pole[0]], [pole[1]], marker="o", markersize=3.0, color=INK, zorder=6)
    for end, names in ends:
        text = ", ".join(names[:8]) + (", …" if len(names) > 8 else "")
        page.name(end, typeset(text), clear=1.0, size=9.0)


def name_strokes(
    page: Page,
    view: PageView,
    strokes: Sequence[DiagramStroke],
    order: int,
    factor: float,
    colours: Mapping[str, Pen],
) -> None:
    """Names of relative vectors and of the parts of accelerations, at their middles."""
    letter = "v" if order == 1 else "a"
    for stroke in strokes:
        if stroke.kind in ("image", "carried"):
            continue
        middle = view.mm(flat([factor * (stroke.start + stroke.end) / 2])[0])
        colour = colours[stroke.link].colour if stroke.link in colours else GROUND
        page.name(middle, symbol(letter, stroke.name, stroke.kind), clear=0.6, size=7.0, colour=colour)
