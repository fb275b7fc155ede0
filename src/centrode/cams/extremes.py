"""Least and greatest values of a path: of its radius, its pressure angle, its curvature."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from centrode.cams.path import RollerPath

Array = NDArray[np.float64]

NODES = 1441
HALVINGS = 60


class Extremes(NamedTuple):
    """Least and greatest value, and the angles [rad] where they are taken."""

    least: float
    least_at: float
    greatest: float
    greatest_at: float


def radius_extremes(path: RollerPath) -> Extremes:
    """Of rho [m]."""
    return _extremes(path, lambda phi: path.radius(phi)[0], lambda phi: path.sine(phi)[0])


def pressure_extremes(path: RollerPath) -> Extremes:
    """Of the pressure angle [rad]."""
    return _extremes(path, path.pressure_angle, lambda phi: path.sine(phi, 1)[1])


def curvature_extremes(path: RollerPath) -> Extremes:
    """Of the curvature [1/m]."""
    return _extremes(path, lambda phi: path.curvature(phi)[0], lambda phi: path.curvature(phi, 1)[1])


def _extremes(path: RollerPath, value: Callable[[Array], Array], slope: Callable[[Array], Array]) -> Extremes:
    """From nodes, the places between them where the sign of the slope changes, and the ends."""
    nodes = np.unique(np.concatenate([np.linspace(path.start, path.stop, NODES), _breaks(path)]))
    with np.errstate(all="ignore"):
        signs = np.sign(slope(nodes))
        turns = np.flatnonzero(signs[:-1] * signs[1:] < 0)
        low, high, first = nodes[turns], nodes[turns + 1], signs[turns]
        for _halving in range(HALVINGS if turns.size else 0):
            middle = 0.5 * (low + high)
            before = np.sign(slope(middle)) == first
            low, high = np.where(before, middle, low), np.where(before, high, middle)
        places = np.concatenate([nodes, high])
        found = value(places)
    least, greatest = int(np.nanargmin(found)), int(np.nanargmax(found))
    return Extremes(
        float(found[least]), float(places[least]), float(found[greatest]), float(places[greatest])
    )


def _breaks(path: RollerPath) -> list[float]:
    return [place for place in path.law.breaks if path.start < place < path.stop]
