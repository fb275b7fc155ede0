"""Four-bars on the sphere for tests, and where a motion has their points."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

import centrode as ct
from mechanisms import Parts

Array = npt.NDArray[np.float64]


def four_bar(a: float, b: float, c: float, d: float, side: str = "left", **more: Any) -> ct.Mechanism:
    """Spherical four-bar A-B-C-D with A on the x axis and D on the equator, driven at AB."""
    parts: Parts = {
        "space": "sphere",
        "frame": {"points": {"A": [0.0, 0.0], "D": [d, 0.0]}},
        "links": {
            "AB": {"length": a, "reference": ["A", "D"]},
            "BC": {"length": b, "reference": ["B", "A"]},
            "DC": {"length": c, "reference": ["D", "A"]},
        },
        "drives": [{"link": "AB", "start": 1.0, "speed": 1.0}],
        "assembly": {"sides": {"C": side}},
    }
    return ct.Mechanism(**{**parts, **more})


def place(data: xr.Dataset, name: str, variable: str = "position") -> Array:
    return np.asarray(data[variable].sel(point=name).to_numpy())
