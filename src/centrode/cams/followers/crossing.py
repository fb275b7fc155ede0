"""Where functions of the cam's angle change their signs, all places at once."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from centrode.cams.searching import Array, Function, mesh

HALVINGS = 52
"""A cell of a hundredth of a radian halved so often is narrower than rounding."""
FLAT_HALVINGS = 26
"""For places of extremes: 1e-10 rad away from one its value differs by less than rounding."""


def inside(start: float, stop: float) -> tuple[float, float]:
    """The ends of a stretch between edges, the second just before it: at an edge holds what begins there."""
    return start, float(np.nextafter(stop, start))


def nodes_of(edges: Sequence[float]) -> Array:
    """Nodes of a mesh over each stretch between edges, both ends included, growing."""
    return np.concatenate([mesh(*inside(start, stop)) for start, stop in pairwise(edges)])


def crossings(function: Function, edges: Sequence[float], halvings: int = HALVINGS) -> Array:
    """Where a function changes its sign between edges, growing, to rounding.

    Two changes within a hundredth of a radian are missed. Zeros in a row, as on a dwell, are none.
    """
    found = [_cells(one) for one in _stretches(function, edges)]
    low, high = (np.concatenate([one[k] for one in found]) for k in (0, 1))
    if not low.size:
        return low
    first = np.sign(function(low))
    for _halving in range(halvings):
        middle = 0.5 * (low + high)
        before = np.sign(function(middle)) == first
        low, high = np.where(before, middle, low), np.where(before, high, middle)
    return np.asarray(high)


def _stretches(function: Function, edges: Sequence[float]) -> list[tuple[Array, Array]]:
    """Nodes of each stretch and the signs of the function there, computed together."""
    nodes = [mesh(*inside(start, stop)) for start, stop in pairwise(edges)]
    signs = np.sign(function(np.concatenate(nodes)))
    cuts = np.cumsum([len(one) for one in nodes])[:-1]
    return list(zip(nodes, np.split(signs, cuts), strict=True))


def _cells(stretch: tuple[Array, Array]) -> tuple[Array, Array]:
    """Ends of the cells in which the sign changes, nodes that are zero left out."""
    nodes, signs = stretch
    known = np.flatnonzero(signs)
    nodes, signs = nodes[known], signs[known]
    # more than one zero between them is a dwell
    changes = (signs[:-1] * signs[1:] < 0) & (np.diff(known) <= 2)
    return nodes[:-1][changes], nodes[1:][changes]
