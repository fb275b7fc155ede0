"""Descriptions from rough places: lengths of rods and local coordinates of plates, rounded, so that they read well."""

from __future__ import annotations

import cmath
import math
from collections.abc import Mapping, Sequence
from typing import Any

Places = Mapping[str, Sequence[float]]
Parts = dict[str, Any]


def rods(at: Places, names: str) -> Parts:
    """Links by two points, named after them."""
    return {name: {"length": round(math.dist(*(at[point] for point in name)), 2)} for name in names.split()}


def plate(at: Places, names: str, turn: float = 0.0) -> Parts:
    """A link by coordinates: its first point is the origin, its axes are turned [rad] relative to the frame's."""
    origin = complex(*at[names[0]])
    local = {name: (complex(*at[name]) - origin) * cmath.exp(-1j * turn) for name in names}
    return {"points": {name: [round(v.real, 3), round(v.imag, 3)] for name, v in local.items()}}


def frame(at: Places, names: str) -> Parts:
    """The fixed link."""
    return {"points": {name: [float(v) for v in at[name]] for name in names}}


def heading(at: Places, names: str) -> float:
    """Angle [rad] of the line from one place to another, to two decimals."""
    (x, y), (u, v) = (at[name] for name in names)
    return round(math.atan2(v - y, u - x), 2)


def driven(at: Places, link: str) -> list[Parts]:
    """The drive of a rod's angle, at one radian a second."""
    return [{"link": link, "start": heading(at, link), "speed": 1.0}]
