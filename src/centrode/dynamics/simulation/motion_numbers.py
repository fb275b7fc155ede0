"""The single numbers of a simulated motion: values at its end, extremes and when they are reached."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

import numpy as np
import numpy.typing as npt
from scipy.interpolate import BPoly, CubicHermiteSpline

if TYPE_CHECKING:
    import xarray as xr

Array: TypeAlias = npt.NDArray[np.float64]


def motion_numbers(run: xr.Dataset) -> dict[str, tuple[float, str]]:
    """Name -> number and SI unit, of a motion by the equations of all links.

    Of every drive, without drives of every coordinate: `last_...`, `last_speed_...`, `least_...`, `greatest_...` with
    their times `..._at`; of the kinetic energy the last and the greatest; `last_time`; how many `occasions` (events)
    there were, and when the first and the last of them. Extremes lie between samples as well: of the polynomial of
    fifth degree through values, speeds and accelerations.
    """
    times = run["time"].values
    drives = bool(run.sizes["drive"])
    kinds = ("drive_value", "drive_speed", "drive_acceleration")
    if not drives:
        kinds = ("generalised_coordinate", "generalised_velocity", "generalised_acceleration")
    values, speeds, accelerations = (run[name].values for name in kinds)
    names = [str(name) for name in run["drive" if drives else "coordinate"].values]
    units = str(run[kinds[0]].attrs["units"]).replace(", ", " ").split()
    units = units * len(names) if len(units) == 1 else units
    found: dict[str, tuple[float, str]] = {"last_time": (float(times[-1]), "s")}
    for k, (name, unit) in enumerate(zip(names, units, strict=True)):
        course = values[:, k], speeds[:, k], accelerations[:, k]
        (least, least_at), (greatest, greatest_at) = _extremes(times, *course)
        found |= {
            f"last_{name}": (float(values[-1, k]), unit),
            f"last_speed_{name}": (float(speeds[-1, k]), f"{unit}/s"),
            f"least_{name}": (least, unit),
            f"least_{name}_at": (least_at, "s"),
            f"greatest_{name}": (greatest, unit),
            f"greatest_{name}_at": (greatest_at, "s"),
        }
    energy = run["kinetic_energy"].values
    return found | {
        "last_kinetic_energy": (float(energy[-1]), "J"),
        "greatest_kinetic_energy": (float(np.max(energy)), "J"),
        "occasions": (float(run.sizes["occasion"]), "1"),
        "first_occasion_at": (float(min(run["occasion_time"].values, default=np.nan)), "s"),
        "last_occasion_at": (float(max(run["occasion_time"].values, default=np.nan)), "s"),
    }


def _extremes(times: Array, values: Array, speeds: Array, bends: Array) -> tuple[tuple[float, float], ...]:
    """The least and the greatest value, each with its time."""
    places, reached = times, values
    if len(times) > 1:
        turning = CubicHermiteSpline(times, speeds, bends).roots(extrapolate=False)
        turning = turning[np.isfinite(turning)]
        between = BPoly.from_derivatives(times, np.column_stack([values, speeds, bends]))
        places, reached = np.append(times, turning), np.append(values, between(turning))
    low, high = int(np.argmin(reached)), int(np.argmax(reached))
    return tuple((float(reached[k]), float(places[k])) for k in (low, high))
