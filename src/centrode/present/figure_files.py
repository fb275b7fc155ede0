"""Figures as files."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure

from centrode.present.spelled_figures import spell_decimals
from centrode.present.style import house_style

# Nothing that differs from one run or machine to the next: no date, no version.
METADATA: dict[str, dict[str, Any]] = {
    "png": {"Software": "centrode"},
    "svg": {"Date": None, "Creator": "centrode"},
}
DPI = 150


def save_figures(figures: Mapping[str, Figure], folder: Path) -> list[Path]:
    """Write each figure as PNG (150 dpi) and SVG; the same figures give the same bytes.

    Numbers get the decimal mark of the language that is spoken.

    Parameters
    ----------
    figures : mapping of name -> Figure
        The names become the files' names.
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
            raster: Any = FigureCanvasAgg(figure)
            engine, dpi = figure.get_layout_engine(), figure.dpi
            figure.dpi = DPI
            figure.draw_without_rendering()
            figure.set_layout_engine("none")  # it is laid out: both files show the same
            paths = [Path(folder) / f"{name}.{kind}" for kind in METADATA]
            raster.print_png(str(paths[0]), metadata=METADATA["png"])
            vectors: Any = FigureCanvasSVG(figure)
            vectors.print_svg(str(paths[1]), metadata=METADATA["svg"])
            figure.set_layout_engine(engine)
            figure.dpi = dpi
            written += paths
    return written
