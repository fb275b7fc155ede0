"""Figures as files."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure
from matplotlib.text import Text
from matplotlib.ticker import Formatter

from centrode.locale import decimal_mark
from centrode.render.drawing.style import house_style
from centrode.render.figures.document_canvas import DocumentCanvas, MeasuringCanvas

# Decimals of a figure with the mark of the language: ticks, labels, titles; what a user wrote stays.

AS_WRITTEN = "as written"
"""Label of texts that a user wrote."""
_DECIMALS = re.compile(r"(?<![\w.])(\d+)\.(\d+)(?![\w.])")


def spell_decimals(figure: Figure) -> None:
    """Give the numbers of a figure the decimal mark of the language.

    Names in formulas and in other words ("B2.1") stay.
    """
    if decimal_mark() == ".":
        return
    for axes in figure.axes:  # their labels have no numbers but those in names
        for axis in (axes.xaxis, axes.yaxis):
            axis.label.set_label(AS_WRITTEN)
    respell(figure, with_decimal_mark)
    for axes in figure.axes:
        for axis in (axes.xaxis, axes.yaxis):
            if not isinstance(axis.get_major_formatter(), _Spelled):
                axis.set_major_formatter(_Spelled(axis.get_major_formatter()))


def respell(figure: Figure, spelling: Callable[[str], str]) -> None:
    """Spell every text of a figure anew, ticks and what a user wrote left out.

    Below the first line of its title stands the mechanism's own, which is what a user wrote; so are texts with the
    label `AS_WRITTEN`.
    """
    title = figure.get_suptitle()
    for text in figure.findobj(Text):
        assert isinstance(text, Text)
        told = text.get_text()
        if not told or text.get_label() == AS_WRITTEN:
            continue
        first, line, own = told.partition("\n") if told == title else (told, "", "")
        if line or told != title:
            text.set_text(spelling(first) + line + own)


def with_decimal_mark(text: str) -> str:
    """Decimals outside of mathematics with the decimal mark of the language; other dots stay ("B2.1")."""
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
        return with_decimal_mark(self.inner(x, pos))

    def format_ticks(self, values: Sequence[float]) -> list[str]:
        return [with_decimal_mark(text) for text in self.inner.format_ticks(values)]

    def get_offset(self) -> str:
        return with_decimal_mark(self.inner.get_offset())


# Nothing that differs from one run or machine to the next: no date, no version.
METADATA: dict[str, dict[str, Any]] = {
    "png": {"Software": "centrode"},
    "svg": {"Date": None, "Creator": "centrode"},
}
DPI = 150


def lay_out(figure: Figure) -> None:
    """Put the panels of a figure, nothing being drawn."""
    engine = figure.get_layout_engine()
    if engine is not None:
        engine.execute(figure)


def save_figures(figures: Mapping[str, Figure], folder: Path) -> list[Path]:
    """Write each figure as PNG (150 dpi) and SVG; the same figures give the same bytes.

    Numbers get the decimal mark of the language that is spoken.

    Parameters
    ----------
    figures : mapping of name -> Figure
        The names become the files' names; they may begin with a folder.
    folder : Path
        An existing folder.

    Returns
    -------
    list of Path
        The files written, in order.
    """
    written: list[Path] = []
    with house_style():
        for name, figure in figures.items():
            spell_decimals(figure)
            # The canvases' own printing: `savefig` would draw every figure twice as often.
            raster: Any = MeasuringCanvas(figure)
            engine, dpi = figure.get_layout_engine(), figure.dpi
            figure.dpi = DPI
            lay_out(figure)
            figure.set_layout_engine("none")  # both files show the same
            paths = [Path(folder) / f"{name}.{kind}" for kind in METADATA]
            paths[0].parent.mkdir(exist_ok=True)
            raster.print_png(str(paths[0]), metadata=METADATA["png"])
            with paths[1].open("wb") as stream:
                DocumentCanvas(figure).print_svg(stream, metadata=METADATA["svg"])
            figure.set_layout_engine(engine)
            figure.dpi = dpi
            written += paths
    return written
