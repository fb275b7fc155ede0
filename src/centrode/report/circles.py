"""Signs that shapes are made of: circles, hatched lines."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Samples = NDArray[np.intp]
ROUND = 48
"""Corners of a circle."""
LIFT = np.full((1, 2), np.nan)
AT_REST = np.zeros((1, 3))


def circle(radius: float, spoke: bool = False) -> Array:
    """A circle (n, 2) about the origin, with a spoke if asked."""
    turn = np.linspace(0.0, 2.0 * np.pi, ROUND + 1)
    rim = radius * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    return np.concatenate([rim, np.zeros((1, 2))]) if spoke else rim


def hatched(start: Array, end: Array, away: Array, size: float) -> Array:
    """A line (n, 2) with strokes on the side that the unit vector `away` points to."""
    along = (end - start) / max(float(np.hypot(*(end - start))), np.finfo(float).tiny)
    count = max(2, round(float(np.hypot(*(end - start))) / (0.9 * size)))
    feet = start + (np.arange(1, count + 1) / count)[:, None] * (end - start)
    tips = feet + 0.9 * size * (away - along)
    strokes = np.stack([feet, tips, np.full_like(feet, np.nan)], axis=1).reshape(-1, 2)
    return np.concatenate([[start, end], LIFT, strokes])
