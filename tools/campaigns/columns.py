"""Columns of a motion by name, as plain arrays."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

Array: TypeAlias = npt.NDArray[np.float64]
Complex: TypeAlias = npt.NDArray[np.complex128]

EPS = 2.0**-52


def point(data: xr.Dataset, name: str, variable: str = "position") -> Array:
    """Places (or velocities, ...) of a point as complex numbers x + i y."""
    xy = data[variable].sel(point=name).to_numpy()
    return np.asarray(xy[..., 0] + 1j * xy[..., 1])


def link(data: xr.Dataset, name: str, variable: str = "angle") -> Array:
    """Angles (or angular velocities, ...) of a link."""
    return np.asarray(data[variable].sel(link=name).to_numpy())


def slide(data: xr.Dataset, name: str, variable: str = "slide") -> Array:
    """Displacements (or their rates) along a guide."""
    return np.asarray(data[variable].sel(guide=name).to_numpy())
