"""Least and greatest values of a path: of its radius, its pressure angle, its curvature."""

from __future__ import annotations

import numpy as np

from centrode.cams.path import RollerPath
from centrode.numerics.search import Extremes, Function, extremes

NODES = 1441


def radius_extremes(path: RollerPath) -> Extremes:
    """Of rho [m]."""
    return _extremes(path, lambda phi: path.radius(phi)[0], lambda phi: path.sine(phi)[0])


def pressure_extremes(path: RollerPath) -> Extremes:
    """Of the pressure angle [rad]."""
    return _extremes(path, path.pressure_angle, lambda phi: path.sine(phi, 1)[1])


def curvature_extremes(path: RollerPath) -> Extremes:
    """Of the curvature [1/m]."""
    return _extremes(path, lambda phi: path.curvature(phi)[0], lambda phi: path.curvature(phi, 1)[1])


def _extremes(path: RollerPath, value: Function, slope: Function) -> Extremes:
    """From nodes, the places between them where the sign of the slope changes, and the ends."""
    nodes = np.unique(np.concatenate([np.linspace(path.start, path.stop, NODES), _breaks(path)]))
    with np.errstate(all="ignore"):
        return extremes(value, slope, nodes)


def _breaks(path: RollerPath) -> list[float]:
    return [place for place in path.law.breaks if path.start < place < path.stop]
