"""Where texts stand on a figure, in millimetres."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
from matplotlib.figure import Figure
from matplotlib.text import Text

INCH = 25.4
Box: TypeAlias = tuple[str, Any]


def boxes(figure: Figure | list[Box]) -> list[Box]:
    """Every visible text with its lower left and upper right corner; those of a figure that was measured already."""
    if isinstance(figure, list):
        return figure
    canvas: Any = figure.canvas
    renderer = canvas.get_renderer()
    found = []
    for text in figure.findobj(Text):
        if isinstance(text, Text) and text.get_visible() and text.get_text().strip() and shown(text):
            extent = text.get_window_extent(renderer)
            found.append((text.get_text(), np.array([extent.min, extent.max]) * INCH / figure.dpi))
    return found


def shown(text: Text) -> bool:
    """Whether the axes of a text are drawn with their ticks, or it is no tick."""
    return text.axes is None or text in text.axes.texts or text.axes.axison


def overlapping(figure: Figure | list[Box]) -> list[tuple[str, str]]:
    """Pairs of texts that cover each other."""
    all_boxes = boxes(figure)
    return [
        (one, other)
        for k, (one, a) in enumerate(all_boxes)
        for other, b in all_boxes[k + 1 :]
        if (a[0] < b[1]).all() and (b[0] < a[1]).all()
    ]


def outside(figure: Figure, measured: list[Box] | None = None) -> list[str]:
    """Texts that the edge of the figure cuts."""
    size = np.array(figure.get_size_inches()) * INCH
    return [text for text, box in measured or boxes(figure) if (box[0] < 0).any() or (box[1] > size).any()]
