"""Figures of reports: drawn once, as SVG whose letters are outlines, the same bytes from the same figure."""

from __future__ import annotations

import io
from typing import Any

from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure

from centrode.present.saving import METADATA
from centrode.present.style import house_style
from centrode.report.blocks import Picture


def picture(figure: Figure, caption: str) -> Picture:
    """A figure as a block, with its caption."""
    with house_style():
        stream = io.BytesIO()
        canvas: Any = FigureCanvasSVG(figure)
        canvas.print_svg(stream, metadata=METADATA["svg"])
    return Picture(stream.getvalue(), caption, float(figure.get_figwidth()))
