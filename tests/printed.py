"""What is wrong with a figure in print: texts over texts, small ones, ones cut off, data in a corner of their axes."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.text import Text
from numpy.typing import NDArray

from centrode.render.document.figures import TEXT_HEIGHT, TEXT_WIDTH
from centrode.render.drawing.style import house_style

Array = NDArray[np.float64]
SMALLEST = 7.0
"""Of a text in print [pt]."""
SHARE = 1.0 / 3.0
"""The least part of an axis that the data take."""
TOUCH = 0.3
"""Texts that cover each other by less than this touch [mm]: the box of a text is larger than its letters."""
MILLIMETRES = 25.4
CONSTANT = 1e-9
"""Data that vary by no more, over their greatest size, are a constant."""


def faults(figure: Figure, *, to_scale: bool = False) -> list[str]:
    """Everything that is wrong with a figure; one `to_scale` is printed at its size."""
    canvas = FigureCanvasAgg(figure)
    with house_style():
        figure.draw_without_rendering()
    renderer: Any = canvas.get_renderer()
    texts = [(text, _box(text, renderer, figure)) for text in _texts(figure)]
    return [
        *_text_faults(figure, texts, to_scale),
        *(fault for axes in figure.axes for fault in _empty(axes)),
    ]


def _text_faults(figure: Figure, texts: list[tuple[Text, Array]], to_scale: bool) -> Iterator[str]:
    width, height = figure.get_size_inches()
    printed = 1.0 if to_scale else min(1.0, TEXT_WIDTH / width, TEXT_HEIGHT / height)
    size = np.array([width, height]) * MILLIMETRES
    for text, box in texts:
        if text.get_fontsize() * printed < SMALLEST - 1e-9:
            yield f"{text.get_fontsize() * printed:.1f} pt: {text.get_text()!r}"
        if (box[0] < -TOUCH).any() or (box[1] > size + TOUCH).any():
            yield f"outside: {text.get_text()!r}"
    for (one, a), (other, b) in combinations(texts, 2):
        if (a[0] + TOUCH < b[1]).all() and (b[0] + TOUCH < a[1]).all():
            yield f"over each other: {one.get_text()!r}, {other.get_text()!r}"


def _texts(figure: Figure) -> list[Text]:
    """The texts that are seen: ticks beyond the ends of an axis are not, nor those of axes that are switched off."""
    hidden: set[int] = set()
    for axes in figure.axes:
        for axis in (axes.xaxis, axes.yaxis):
            measure = np.log if axis.get_scale() == "log" else np.asarray
            low, high = sorted(measure(axis.get_view_interval()))
            slack = 1e-9 * (high - low)
            off = not (axes.axison and axes.get_visible())
            if off:
                hidden |= {id(axis.label), id(axis.offsetText)}
            for tick in (*axis.get_major_ticks(), *axis.get_minor_ticks()):
                if off or not low - slack <= measure(tick.get_loc()) <= high + slack:
                    hidden |= {id(tick.label1), id(tick.label2)}
    found = {id(one): one for one in figure.findobj(Text) if isinstance(one, Text)}
    return [
        one
        for key, one in found.items()
        if key not in hidden and one.get_visible() and one.get_text().strip()
    ]


def _box(text: Text, renderer: Any, figure: Figure) -> Array:
    """Lower left and upper right corner of a text [mm]."""
    extent = text.get_window_extent(renderer)
    return np.array([extent.min, extent.max]) * MILLIMETRES / figure.dpi


def _empty(axes: Axes) -> Iterator[str]:
    """Axes that the data do not fill; with equal scales both ways the better filled one counts."""
    if not (axes.axison and axes.get_visible()):
        return
    places = _data(axes)
    shares = {}
    for k, (name, axis) in enumerate((("x", axes.xaxis), ("y", axes.yaxis))):
        low, high = sorted(axis.get_view_interval())
        values = places[:, k]
        if low == 0.0 and axis.get_scale() != "log":
            values = np.append(values, 0.0)  # what counts is how far the data are from zero
        if not values.size or np.ptp(values) <= CONSTANT * np.abs(values).max():
            continue
        shown = np.clip(values, low, high)
        if axis.get_scale() == "log":
            shown, low, high = np.log(shown), np.log(low), np.log(high)
        shares[name] = float(np.ptp(shown) / (high - low))
    if axes.get_aspect() != "auto" and shares:
        shares = {"x and y": max(shares.values())}
    for name, share in shares.items():
        if share < SHARE:
            yield f"{share:.0%} of {name}: {axes.get_ylabel()!r}"


def _data(axes: Axes) -> Array:
    """All places that are drawn in the coordinates of the axes."""
    inverted = axes.transData.inverted()
    found = [np.asarray(line.get_xydata()) for line in axes.lines if line.get_transform() == axes.transData]
    found += [
        inverted.transform(patch.get_transform().transform(patch.get_path().vertices))
        for patch in axes.patches
    ]
    found += [np.asarray(path.vertices) for one in axes.collections for path in one.get_paths()]
    places = np.concatenate([np.empty((0, 2)), *found]).astype(float)
    return np.asarray(places[np.isfinite(places).all(axis=1)])
