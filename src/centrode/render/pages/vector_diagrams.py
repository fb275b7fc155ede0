"""Diagrams of velocities and accelerations on pages, at their scales."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure

from centrode.locale import _
from centrode.model.settings import shown_as
from centrode.quantities import typeset_unit
from centrode.render.drawing.style import GROUND, INK, Pen, pens
from centrode.render.figures.linkages import caption
from centrode.render.pages.page import (
    COLUMN,
    CORNER,
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
from centrode.render.spelling import PlainSpelling

if TYPE_CHECKING:
    from centrode.analysis.graphic.diagrams import Diagram
    from centrode.analysis.graphic.stage import Edge
    from centrode.model.mechanism import Mechanism
    from centrode.model.settings import Display
    from centrode.sheets.pages import VectorDiagramPage

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
    found, diagram = sheet.diagrams, sheet.diagram
    page = new_page()
    factor, unit = shown_as(diagram.unit, display)
    scale = factor * diagram.scale
    ends = [0j, *diagram.images.values(), *diagram.hidden.values()]
    ends += [end for edge in diagram.edges for end in (edge.start, edge.end)]
    view = PageView.about(CORNER, SIZE, flat([factor * end for end in ends]), scale)
    colours = pens(found.mechanism.link_names)
    drawn = draw_edges(page, view, diagram, factor, colours)
    draw_images(page, view, diagram, factor, found.mechanism)
    name_edges(page, view, drawn, diagram.order, factor, colours)
    spelling = PlainSpelling(display)
    symbol = "μ_v" if diagram.order == 1 else "μ_a"
    head = [
        caption(found.mechanism, found.exact, 0),
        f"{symbol} = {scale:g} {typeset_unit(unit)} " + _("per mm"),
    ]
    write_head(
        page, spelling.text(sheet.title), found.mechanism, head, [spelling.text(one) for one in sheet.lines]
    )
    page.place_names(np.array([[1.0, 1.0], [COLUMN - 1.0, TOP - 3.0]]))
    return page.figure


def draw_edges(
    page: Page, view: PageView, diagram: Diagram, factor: float, colours: Mapping[str, Pen]
) -> list[Edge]:
    """Parts of vector equations and images of links; those too short or drawn already are left out."""
    drawn: list[Edge] = []
    seen: list[Array] = []
    for edge in diagram.edges:
        ends = np.array([view.mm(place) for place in flat([factor * edge.start, factor * edge.end])])
        from_pole = edge.start == 0 and edge.kind in ("relative", "sliding", "image")
        if np.hypot(*(ends[1] - ends[0])) < SHORT or from_pole:
            continue
        if any(min(abs(ends - other).max(), abs(ends[::-1] - other).max()) < SHORT for other in seen):
            continue
        seen.append(ends)
        drawn.append(edge)
        colour = colours[edge.link].colour if edge.link in colours else GROUND
        if edge.kind == "image":
            page.overlay.plot(*ends.T, color=colour, linewidth=0.8, linestyle=DASHES["image"], zorder=4)
            page.avoid([(ends[0], ends[1])])
        else:
            arrow(page, ends[0], ends[1], colour, DASHES.get(edge.kind, "-"))
    return drawn


def draw_images(page: Page, view: PageView, diagram: Diagram, factor: float, mechanism: Mechanism) -> None:
    """The pole, and an arrow from it to the image of every point; images that coincide share a name.

    The pole is p_v or p_a, so that it is not taken for the image of a point P.
    """
    pole = view.mm(np.zeros(2))
    ends: list[tuple[Array, list[str]]] = [(pole, ["p_v" if diagram.order == 1 else "p_a"])]
    moving = {name: diagram.images[name] for name in mechanism.moving_points}
    still = {name: diagram.images[name] for name in mechanism.frame.points if name in diagram.images}
    for name, image in {**still, **moving, **diagram.hidden}.items():
        end = view.mm(flat([factor * image])[0])
        near = next((names for at, names in ends if np.hypot(*(at - end)) < TOGETHER), None)
        if near is not None:
            near.append(name.lower())
            continue
        ends.append((end, [name.lower()]))
        arrow(page, pole, end, INK, width=1.3)
    page.overlay.plot([pole[0]], [pole[1]], marker="o", markersize=3.0, color=INK, zorder=6)
    for end, names in ends:
        text = ", ".join(names[:8]) + (", …" if len(names) > 8 else "")
        page.name(end, typeset(text), clear=1.0, size=9.0)


def name_edges(
    page: Page, view: PageView, edges: Sequence[Edge], order: int, factor: float, colours: Mapping[str, Pen]
) -> None:
    """Names of relative vectors and of the parts of accelerations, at their middles."""
    letter = "v" if order == 1 else "a"
    for edge in edges:
        if edge.kind in ("image", "carried"):
            continue
        middle = view.mm(flat([factor * (edge.start + edge.end) / 2])[0])
        colour = colours[edge.link].colour if edge.link in colours else GROUND
        page.name(middle, symbol(letter, edge.name, edge.kind), clear=0.6, size=7.0, colour=colour)
