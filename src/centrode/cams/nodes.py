"""Nodes over the angle of a cam: at them the roots and extremes of what a cam does are looked for."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

WIDTH = 0.01
"""Greatest distance of neighbouring nodes [rad]: two roots between them are missed."""
LEAST_CELLS = 24


def mesh(start: float, stop: float) -> Array:
    """Evenly spaced nodes of a stretch, both ends included."""
    return np.linspace(start, stop, 1 + max(LEAST_CELLS, int(np.ceil((stop - start) / WIDTH))))


def inside(start: float, stop: float) -> tuple[float, float]:
    """The ends of a stretch between edges, the second just before it: at an edge holds what begins there."""
    return start, float(np.nextafter(stop, start))


def nodes_of(edges: Sequence[float]) -> Array:
    """Nodes of a mesh over each stretch between edges, both ends included, growing."""
    return np.concatenate([mesh(*inside(start, stop)) for start, stop in pairwise(edges)])
