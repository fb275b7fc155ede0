"""Roots and extremes of functions of an angle, found between the nodes of a mesh."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

Array = NDArray[np.float64]
Function = Callable[[Array], Array]

WIDTH = 0.01
"""Greatest width of a cell of the mesh [rad]: two roots within one are missed."""
LEAST_CELLS = 24
MOST_ROOTS = 1000


@dataclass(frozen=True)
class Extremes:
    """Least and greatest value, and where they lie [rad]."""

    least: float
    at_least: float
    greatest: float
    at_greatest: float


def mesh(start: float, stop: float) -> Array:
    """Evenly spaced nodes of a stretch, both ends included."""
    return np.linspace(start, stop, 1 + max(LEAST_CELLS, int(np.ceil((stop - start) / WIDTH))))


def roots(function: Function, edges: Sequence[float]) -> list[float]:
    """Where a function changes its sign, to rounding; it is smooth between the edges (growing, 2 or more)."""
    found: list[float] = []
    for start, stop in pairwise(edges):
        nodes = mesh(start, stop)
        values = function(nodes)
        changes = np.flatnonzero(np.sign(values[:-1]) * np.sign(values[1:]) < 0)
        found += [_root(function, nodes[k], nodes[k + 1]) for k in changes[:MOST_ROOTS]]
        found += nodes[1:-1][values[1:-1] == 0.0].tolist()[:MOST_ROOTS]
    return sorted(found)


def extremes(function: Function, slope: Function, edges: Sequence[float]) -> Extremes:
    """Extremes of a function over its stretches: at nodes, at edges, or where its slope changes sign between nodes.

    The function is continuous across the edges, its slope need not be. Values are exact to rounding; two extremes
    within one cell of the mesh are missed.
    """
    places: list[float] = []
    for start, stop in pairwise(edges):
        nodes = mesh(start, stop)
        places += nodes.tolist() + roots(slope, [nodes[0], nodes[-1]])
    at = np.array(places)
    values = function(at)
    low, high = int(np.argmin(values)), int(np.argmax(values))
    return Extremes(float(values[low]), float(at[low]), float(values[high]), float(at[high]))


def _root(function: Function, low: float, high: float) -> float:
    def at(place: float) -> float:
        return float(function(np.array([place]))[0])

    return float(brentq(at, low, high, xtol=4 * np.finfo(float).eps, rtol=4 * np.finfo(float).eps))
