"""Where panels of a figure stand: each edge as far from the next as what is written beside it needs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
from matplotlib.layout_engine import LayoutEngine
from matplotlib.spines import Spine
from matplotlib.transforms import Bbox

Array = npt.NDArray[np.float64]
PAD = 1 / 24
"""Inches about each panel with its ticks and labels."""
FIRST = (0.6, 0.42, 0.6, 0.04)
"""Inches on the left, below, on the right and above of the grid where panels are measured first: what most need."""
GAPS = (0.6, 0.1)
"""Inches between columns and between rows of panels then."""
LEAST = 0.02
"""Of the figure, a side of a panel then."""
MOST_TICKS = 9
"""No axis has more ticks, however long it is."""


class GridLayout(LayoutEngine):
    """Puts the panels of one even grid where matplotlib's constrained layout puts them.

    That measures what stands beside the panels twice. Here they are measured again only where an axis has room for
    other ticks than it had.
    """

    _adjust_compatible = False
    _colorbar_gridspec = False

    def __init__(self) -> None:
        super().__init__()
        self._has_run = False

    def execute(self, fig: Any) -> None:
        """Put the panels that are in the layout."""
        panels = [one for one in fig.axes if one.get_subplotspec() is not None and one.get_in_layout()]
        if not panels:
            return
        renderer = fig._get_renderer()
        above = _title_height(fig, renderer)
        if not self._has_run:
            for axes in panels:
                _put(axes, _first_place(axes, fig.get_size_inches(), above))
            self._has_run = True
        for _pass in range(2):
            room = [_tick_room(one) for one in panels]
            _place(fig, panels, renderer, above)
            if room == [_tick_room(one) for one in panels]:
                return


def _place(fig: Any, panels: Sequence[Any], renderer: Any, above: float) -> None:
    """Measure what stands beside the panels, and put them; where that leaves nothing of them they stay."""
    to_figure = fig.transFigure.inverted()
    width, height = fig.get_size_inches()
    columns, rows = _grid_of(panels)
    across, up = np.full((2, columns), PAD / width), np.full((2, rows), PAD / height)
    beside_columns, beside_rows = np.zeros((2, columns)), np.zeros((2, rows))
    for axes in panels:
        row, column = _cell(axes)
        inner = axes.get_position(original=True)
        outer = _outer_box(axes, renderer, _is_last_with_legend(axes, panels)).transformed(to_figure)
        for side, beside in enumerate((inner.x0 - outer.x0, outer.x1 - inner.x1)):
            beside_columns[side, column] = max(beside_columns[side, column], beside)
        for side, beside in enumerate((outer.y1 - inner.y1, inner.y0 - outer.y0)):
            beside_rows[side, row] = max(beside_rows[side, row], beside)
    across, up = across + beside_columns, up + beside_rows
    wide, high = (1.0 - across.sum()) / columns, (1.0 - above - up.sum()) / rows
    if wide <= 0.0 or high <= 0.0:
        return
    lefts = np.cumsum(across.sum(axis=0) + wide) - across[1] - wide
    lowers = 1.0 - above - np.cumsum(up.sum(axis=0) + high) + up[1]
    for axes in panels:
        row, column = _cell(axes)
        _put(axes, (lefts[column], lowers[row], wide, high))


def _first_place(axes: Any, size: Array, above: float) -> tuple[float, float, float, float]:
    """Lower left corner and sides of a panel that is not measured yet, in a figure of a size [inch]."""
    left, lower, right, upper = np.array(FIRST) / np.tile(size, 2)
    across, up = np.array(GAPS) / size
    (columns, rows), (row, column) = _grid_of([axes]), _cell(axes)
    wide = max((1.0 - left - right - (columns - 1) * across) / columns, LEAST)
    high = max((1.0 - above - lower - upper - (rows - 1) * up) / rows, LEAST)
    top = 1.0 - above - upper - row * (high + up)
    return left + column * (wide + across), top - high, wide, high


def _put(axes: Any, place: tuple[float, float, float, float]) -> None:
    axes.set_position(Bbox.from_bounds(*place))
    axes.set_in_layout(True)  # who gives axes a place of their own takes them out of it


def _outer_box(axes: Any, renderer: Any, may_hang: bool) -> Any:
    """A panel with its ticks, labels, legend and what else is not cut at its edges; the frame is the panel's own.

    A legend beside a panel that `may_hang` stands beside the panels below it too, as far as the figure goes.
    """
    others = [one for one in axes.get_default_bbox_extra_artists() if not isinstance(one, Spine)]
    legend = axes.get_legend()
    if legend not in others or not may_hang:
        return axes.get_tightbbox(renderer, bbox_extra_artists=others, for_layout_only=True)
    others.remove(legend)
    own = axes.get_tightbbox(renderer, bbox_extra_artists=others, for_layout_only=True)
    box = legend.get_tightbbox(renderer)
    if box is None or box.x0 < axes.bbox.x1 or box.y0 < 0.0:
        return own if box is None else Bbox.union([own, box])
    return Bbox.from_extents(own.x0, own.y0, max(own.x1, box.x1), own.y1)


def _is_last_with_legend(axes: Any, panels: Sequence[Any]) -> bool:
    """Whether there are panels below one, and none of them has a legend."""
    row, column = _cell(axes)
    below = [one for one in panels if _cell(one)[1] == column and _cell(one)[0] > row]
    return bool(below) and all(one.get_legend() is None for one in below)


def _title_height(fig: Any, renderer: Any) -> float:
    """What the figure's title takes of its height; it is put at the upper edge."""
    title = fig._suptitle
    if title is None or not title.get_in_layout():
        return 0.0
    pad = PAD / float(fig.get_figheight())
    title.set_y(1.0 - pad)
    box: Any = title.get_tightbbox(renderer).transformed(fig.transFigure.inverted())
    return float(box.height) + 2.0 * pad


def _tick_room(axes: Any) -> tuple[int, ...]:
    """How many ticks have room along each axis."""
    return tuple(min(axis.get_tick_space(), MOST_TICKS) for axis in (axes.xaxis, axes.yaxis))


def _grid_of(panels: Sequence[Any]) -> tuple[int, int]:
    """Columns and rows of the grid that panels belong to."""
    grid = panels[0].get_gridspec()
    return grid.ncols, grid.nrows


def _cell(axes: Any) -> tuple[int, int]:
    """Row and column of a panel."""
    place = axes.get_subplotspec()
    return place.rowspan.start, place.colspan.start
