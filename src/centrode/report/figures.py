"""Figures of reports: drawn once, as SVG whose letters are outlines, the same bytes from the same figure."""

from __future__ import annotations

import io
import re
import textwrap
from collections.abc import Sequence
from typing import Any

from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure
from matplotlib.text import Text
from matplotlib.ticker import Formatter

from centrode.locale import decimal_mark
from centrode.present.saving import METADATA
from centrode.present.style import house_style
from centrode.report.blocks import Picture

FLAT = 0.68
"""Height of curves by their width of which two, with their captions, find room on a page."""
PANELS = 3
"""Panels above each other that can still be read at that height."""
LETTER, EDGES, GAP = 0.078, 1.3, 0.12
"""Inches: a letter of a label, what titles and ticks take of a figure's height, and what is between panels."""
_DECIMALS = re.compile(r"(?<![\w.])(\d+)\.(\d+)(?![\w.])")


def picture(figure: Figure, caption: str, *, to_scale: bool = False) -> Picture:
    """A figure as a block, with its caption; one `to_scale` (at most as wide as A4) keeps its size on paper.

    Curves are drawn no higher than half a page; numbers have the decimal mark of the language.
    """
    if not to_scale:
        _flatten(figure)
    spell_decimals(figure)
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
    if not 0 < rows <= PANELS or figure.get_layout_engine() is None:
        return
    if any(one.get_aspect() != "auto" or one.name != "rectilinear" for one in axes):
        return
    figure.set_figheight(min(FLAT * figure.get_figwidth(), figure.get_figheight()))
    room = int(((figure.get_figheight() - EDGES) / rows - GAP) / LETTER)
    for one in axes:
        label = one.get_ylabel()
        if len(label) > room and "$" not in label:
            one.set_ylabel(textwrap.fill(label, max(room, 1), break_long_words=False))


def spell_decimals(figure: Figure) -> None:
    """Give the numbers of a figure the decimal mark of the language; its title is what a user wrote."""
    if decimal_mark() == ".":
        return
    for axes in figure.axes:
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_formatter(_Spelled(axis.get_major_formatter()))
    title = figure.get_suptitle()
    for text in figure.findobj(Text):
        assert isinstance(text, Text)
        if text.get_text() and text.get_text() != title:
            text.set_text(_respelled(text.get_text()))


def _respelled(text: str) -> str:
    """Decimals outside of mathematics with the decimal mark of the language."""
    parts = text.split("$")
    parts[::2] = [_DECIMALS.sub(rf"\1{decimal_mark()}\2", part) for part in parts[::2]]
    return "$".join(parts)


class _Spelled(Formatter):
    """Labels of ticks as another formatter writes them, with the decimal mark of the language."""

    def __init__(self, inner: Formatter) -> None:
        self.inner: Any = inner

    def set_axis(self, axis: Any) -> None:
        super().set_axis(axis)
        self.inner.set_axis(axis)

    def set_locs(self, locs: Any) -> None:
        self.inner.set_locs(locs)

    def __call__(self, x: float, pos: int | None = None) -> str:
        return self._said(self.inner(x, pos))

    def format_ticks(self, values: Sequence[float]) -> list[str]:
        return [self._said(text) for text in self.inner.format_ticks(values)]

    def get_offset(self) -> str:
        return self._said(self.inner.get_offset())

    @staticmethod
    def _said(text: str) -> str:
        return text.replace(".", decimal_mark())
