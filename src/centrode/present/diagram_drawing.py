"""Velocity and acceleration diagrams as pages of a document."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import FancyArrowPatch

from centrode.locale import _
from centrode.present.page import Array, Page, View, new_page
from centrode.present.shown import plain, shown_as
from centrode.present.spelled_figures import AS_WRITTEN
from centrode.present.style import GROUND, INK, Pen, pens
from centrode.quantities import typeset_unit
from centrode.study.graphic import sine_lines, trial_lines

if TYPE_CHECKING:
    from centrode.analysis.graphic.diagrams import Diagram, Diagrams
    from centrode.analysis.graphic.stage import Edge
    from centrode.model.mechanism import Mechanism

CORNER, SIZE = np.array([6.0, 6.0]), np.array([128.0, 128.0])
COLUMN, TOP = 138.0, 140.0
LINE = 3.8
"""From line to line of the column at the right [mm]."""
COLUMNS = 52
"""Letters in a line of it."""
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
MARKS = {"normal": "ⁿ", "tangential": "ᵗ", "coriolis": "ᵏ", "driven": "ʳ", "sliding": "ʳ"}
LETTERS = {"ⁿ": "n", "ᵗ": "t", "ᵏ": "k", "ʳ": "r"}
GREEK = {"ω": r"\omega", "ε": r"\varepsilon", "μ": r"\mu"}
TERM = re.compile(r"(?<!\w)([vapωεμP])([ⁿᵗᵏʳ]?)_([A-Za-z0-9′]+)")


def diagram_page(found: Diagrams, diagram: Diagram, caption: str) -> Figure:
    """A diagram at its scale, with the vector equations it was drawn by."""
    page = new_page()
    factor, unit = shown_as(diagram.unit, found.mechanism.display)
    scale = factor * diagram.scale
    ends = [0j, *diagram.images.values(), *diagram.hidden.values()]
    ends += [end for edge in diagram.edges for end in (edge.start, edge.end)]
    view = View.about(CORNER, SIZE, flat([factor * end for end in ends]), scale)
    colours = pens(found.mechanism.link_names)
    drawn = draw_edges(page, view, diagram, factor, colours)
    draw_images(page, view, diagram, factor, found.mechanism)
    name_edges(page, view, drawn, diagram.order, factor, colours)
    title = _("Velocity diagram") if diagram.order == 1 else _("Acceleration diagram")
    symbol = "μ_v" if diagram.order == 1 else "μ_a"
    head = [caption, f"{symbol} = {scale:g} {typeset_unit(unit)} " + _("per mm")]
    write_head(page, title, found.mechanism, head, lines_of(diagram))
    page.place_names(np.array([[1.0, 1.0], [COLUMN - 1.0, TOP - 3.0]]))
    return page.figure


def lines_of(diagram: Diagram) -> list[str]:
    """What was done: vector equations, trials, and triangles with their sines."""
    found = [line for step in diagram.steps for line in (*step.equations, *trial_lines(step, diagram.order))]
    triangles = [line for step in diagram.steps for line in sine_lines(step)[:1]]
    return [*found, "", *triangles] if triangles else found


def flat(places: Sequence[complex]) -> Array:
    """Complex numbers as rows of x and y."""
    return np.array([[place.real, place.imag] for place in places])


def arrow(page: Page, start: Array, end: Array, colour: str, dashes: Any = "-", width: float = 1.0) -> None:
    """An arrow on the page [mm], with names kept off it; a short one has a small head."""
    head = min(7.0, 2.5 * float(np.hypot(*(end - start))) + 1.0)
    page.overlay.add_patch(
        FancyArrowPatch(
            (float(start[0]), float(start[1])),
            (float(end[0]), float(end[1])),
            arrowstyle="-|>",
            mutation_scale=head,
            shrinkA=0.0,
            shrinkB=0.0,
            color=colour,
            linewidth=width,
            linestyle=dashes,
            zorder=5,
        )
    )
    page.avoid([(start, end)])


def draw_edges(
    page: Page, view: View, diagram: Diagram, factor: float, colours: Mapping[str, Pen]
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


def draw_images(page: Page, view: View, diagram: Diagram, factor: float, mechanism: Mechanism) -> None:
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
    page: Page, view: View, edges: Sequence[Edge], order: int, factor: float, colours: Mapping[str, Pen]
) -> None:
    """Names of relative vectors and of the parts of accelerations, at their middles."""
    letter = "v" if order == 1 else "a"
    for edge in edges:
        if edge.kind in ("image", "carried"):
            continue
        middle = view.mm(flat([factor * (edge.start + edge.end) / 2])[0])
        colour = colours[edge.link].colour if edge.link in colours else GROUND
        page.name(middle, symbol(letter, edge.name, edge.kind), clear=0.6, size=7.0, colour=colour)


def symbol(letter: str, name: str, kind: str = "relative") -> str:
    """v_BA, a^n_BA as text of a figure."""
    return typeset(f"{letter}{MARKS.get(kind, '')}_{name}")


def typeset(text: str) -> str:
    """The symbols of an equation as mathematical text; names with letters that this does not know stay as they are."""
    return TERM.sub(_typeset, plain(text))


def _typeset(found: re.Match[str]) -> str:
    letter, mark, name = found.groups()
    below = name.replace("′", r"{}^{\prime}")
    above = f"^{{{LETTERS[mark]}}}" if mark else ""
    return rf"${GREEK.get(letter, letter)}{above}_{{{below}}}$"


def write_head(
    page: Page, title: str, mechanism: Mechanism, head: Sequence[str], lines: Sequence[str]
) -> None:
    """Title and mechanism above, at the right what the page is about and how it was drawn."""
    page.write(6.0, TOP, title, size=11.0, va="bottom")
    name = textwrap.shorten(plain(_(mechanism.title)), 60, placeholder=" …")
    page.write(COLUMN, TOP, textwrap.fill(name, 40), size=7.5, va="bottom", label=AS_WRITTEN)
    y = TOP - 6.0
    for text in head:
        page.write(COLUMN, y, text if "$" in text else typeset(text), size=8.0, va="top")
        y -= 1.4 * LINE
    y -= 0.5 * LINE
    wrapped = [
        part for line in lines for part in textwrap.wrap(line, COLUMNS, subsequent_indent="    ") or [""]
    ]
    room = int((y - 4.0) / LINE)
    if len(wrapped) > room:
        wrapped = [*wrapped[: room - 1], "…"]
    for text in wrapped:
        if text:
            page.write(COLUMN, y, typeset(text), size=6.5, va="top")
        y -= LINE
