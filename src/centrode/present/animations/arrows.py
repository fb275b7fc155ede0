"""Arrows as outlines, so that all vectors of a frame are one thing to draw."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
SHAFT = 0.16
"""Half width of a shaft, in lengths of the head."""
BARB = 0.42
"""Half width of a head, in its lengths."""
MOST_HEAD = 0.5
"""Most of a short arrow that is head."""


def arrow_outlines(starts: Array, along: Array, head: float) -> Array:
    """Corners (n, 7, 2) of arrows from `starts` (n, 2) along `along` (n, 2); their tips are exactly where those end.

    A short arrow has a smaller head and a thinner shaft.
    """
    length = np.hypot(*along.T)
    unit = along / np.maximum(length, np.finfo(float).tiny)[:, None]
    across = np.stack([-unit[:, 1], unit[:, 0]], axis=1)
    size = np.minimum(head, MOST_HEAD * length)
    neck = length - size
    sides = ((0.0, -SHAFT), (1.0, -SHAFT), (1.0, -BARB), (None, 0.0), (1.0, BARB), (1.0, SHAFT), (0.0, SHAFT))
    corners = [
        starts + (length if share is None else share * neck)[:, None] * unit + (side * size)[:, None] * across
        for share, side in sides
    ]
    return np.stack(corners, axis=1)
