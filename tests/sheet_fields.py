"""Fields of an A1 sheet, and what stands in them: for tests of sheets."""

from __future__ import annotations

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.text import Text

from centrode.render.drawing.style import house_style

EXACT = 1e-9
"""Places are in millimetres of a sheet of one metre; this is some million roundings."""
FRAME = (20.0, 5.0, 836.0, 589.0)
GROWN = (20.0 - EXACT, 5.0 - EXACT, 836.0 + EXACT, 589.0 + EXACT)
BLOCK = (651.0, 5.0, 836.0, 60.0)
TURNED = (20.0, 575.0, 90.0, 589.0)
"""GOST 2.104: frame of an A1 sheet, main inscription of form 1, the repeated designation."""


def boxes_of_texts(figure: Figure) -> list[tuple[str, str, np.ndarray]]:
    """Layer, text and box [mm] of every text of a sheet."""
    canvas = FigureCanvasAgg(figure)
    found = []
    with house_style():
        renderer = canvas.get_renderer()
        for text in figure.findobj(Text):
            assert isinstance(text, Text)
            if text.get_text() and text.get_visible() and text.axes is figure.axes[0]:
                box = text.get_window_extent(renderer).get_points() / figure.dpi * 25.4
                found.append((text.get_gid() or "", text.get_text(), box))
    return found


def inside(box: np.ndarray, field: tuple[float, float, float, float]) -> bool:
    return bool((box[0] >= field[:2]).all() and (box[1] <= field[2:]).all())


def apart(box: np.ndarray, field: tuple[float, float, float, float]) -> bool:
    return bool((box[0] >= field[2:]).any() or (box[1] <= field[:2]).any())


def check_fields(figure: Figure, lines: list[tuple[str, np.ndarray]]) -> None:
    """Everything lies inside the frame; only what belongs to it lies over the main inscription and the upper corner."""
    for layer, text, box in boxes_of_texts(figure):
        if layer:
            assert inside(box, BLOCK) or inside(box, TURNED), text
        else:
            assert inside(box, FRAME), text
            assert apart(box, BLOCK) and apart(box, TURNED), text
    for layer, places in lines:
        box = np.array([places.min(axis=0), places.max(axis=0)])
        assert inside(box, GROWN)
        if not layer.startswith(("title-block", "frame")):
            assert apart(box, BLOCK) and apart(box, TURNED), (layer, box)
