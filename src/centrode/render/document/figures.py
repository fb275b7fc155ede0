"""Figures of reports: drawn once, as SVG whose letters are outlines, the same bytes from the same figure."""

from __future__ import annotations

import io
import textwrap
from typing import Any

from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure

from centrode.render.document.blocks import Picture
from centrode.render.drawing.style import house_style
from centrode.render.figures.files import METADATA, spell_decimals

FLAT = {1: 0.36, 2: 0.44, 3: 0.52}
"""Height of curves by their width, by the number of panels above each other: of one panel three figures with their
captions find room on a page, of three panels two and some text. More panels could not be read at such a height."""
LETTER, EDGES, GAP = 0.078, 1.3, 0.12
"""Inches: a letter of a label, what titles and ticks take of a figure's height, and what is between panels."""


def picture(figure: Figure, caption: str, *, to_scale: bool = False) -> Picture:
    """A figure as a block, with its caption in place of its own title.

    One `to_scale` (at most as wide as A4) keeps its size on paper.

    Curves are drawn no higher than half a page; numbers have the decimal mark of the language.
    """
    if caption:
        figure.suptitle("").set_in_layout(False)
    spell_decimals(figure)
    if not to_scale:
        _flatten(figure)
    with house_style():
        stream = io.BytesIO()
        canvas: Any = FigureCanvasSVG(figure)
        canvas.print_svg(stream, metadata=METADATA["svg"])
    return Picture(stream.getvalue(), caption, float(figure.get_figwidth()), to_scale)


def _flatten(figure: Figure) -> None:
    """Make curves lower, so that two figures share a page, and wrap labels that are longer than their panels.

    Drawings keep their proportions.
    """
    axes: list[Any] = figure.axes
    rows = max((one.get_gridspec().nrows for one in axes if one.get_subplotspec() is not None), default=0)
    if rows not in FLAT or figure.get_layout_engine() is None:
        return
    if any(one.get_aspect() != "auto" or one.name != "rectilinear" for one in axes):
        return
    figure.set_figheight(min(FLAT[rows] * figure.get_figwidth(), figure.get_figheight()))
    room = int(((figure.get_figheight() - EDGES) / rows - GAP) / LETTER)
    for one in axes:
        label = one.get_ylabel().replace(" = ", "\N{NO-BREAK SPACE}=\N{NO-BREAK SPACE}")
        if len(label) > room and "$" not in label:
            one.set_ylabel(textwrap.fill(label, max(room, 1), break_long_words=False))
