"""Figures of reports: drawn once, as SVG whose letters are outlines, the same bytes from the same figure."""

from __future__ import annotations

import io
from typing import Any

from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure

from centrode.present.saving import METADATA
from centrode.present.style import house_style
from centrode.report.blocks import Picture


def picture(figure: Figure, caption: str, *, to_scale: bool = False) -> Picture:
    """A figure as a block, with its caption; one `to_scale` (at most as wide as A4) keeps its size on paper."""
    with house_style():
        stream = io.BytesIO()
        canvas: Any = FigureCanvasSVG(figure)
        canvas.print_svg(stream, metadata=METADATA["svg"])
    return Picture(stream.getvalue(), caption, float(figure.get_figwidth()), to_scale)
