"""Extremes of the motion of links and sliders, with their places: sought between the samples too."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.dynamics.steady_motion.steady import solution_of, steady_dataset, turned_at
from centrode.kinematics.motion import motion
from centrode.numerics.search import Extremes

if TYPE_CHECKING:
    from centrode.dynamics.motion_results import MotionResults

Array: TypeAlias = npt.NDArray[np.float64]

KINDS = {
    "guide": ("slide", "slide_velocity", "slide_acceleration"),
    "link": ("angle", "angular_velocity", "angular_acceleration"),
    "joint": ("joint_angle", "joint_velocity", "joint_acceleration"),
    "hinge": ("hinge_angle", "hinge_velocity", "hinge_acceleration"),
}
"""What has a number at every sample, and its value with two derivatives by time."""
ROUNDS, PARTS = 4, 8
"""How often the surroundings of an extreme are looked at again, and in how many parts each time.

Each round leaves a quarter of them: four make one degree a 256th, and a parabola's top is missed by its square.
"""


def extremes_of_motion(results: MotionResults, data: xr.Dataset) -> Mapping[tuple[str, str], Extremes]:
    """Least and greatest of every displacement and angle with two derivatives by time, by variable and name.

    `data` is the motion of the results, or the real one of their machine. Places are instants as `at` takes them. Of a
    motion that does not get everywhere the extremes are those of the samples that it reaches.
    """
    columns = [
        (name, str(label))
        for kind, names in KINDS.items()
        for name in names
        if name in data and data[name].dims == ("sample", kind)
        for label in data[kind].values
    ]

    def pick(some: xr.Dataset) -> Array:
        found = [some[name].sel({str(some[name].dims[1]): label}).values for name, label in columns]
        return np.array(found).reshape(len(columns), -1)

    places = np.asarray(results.mechanism.motion_parameter.instants(data), dtype=np.float64)
    values = pick(data)
    refined = not results.unreached_samples and len(places) > 2 and bool(np.isfinite(values).all())
    at = _motion_at(results, data) if refined and columns else None
    ends = [_greatest(sign * values, places, at, lambda x, s=sign: s * pick(x)) for sign in (-1.0, 1.0)]  # type: ignore[misc]
    return {
        column: Extremes(
            -float(ends[0][0][k]), float(ends[0][1][k]), float(ends[1][0][k]), float(ends[1][1][k])
        )
        for k, column in enumerate(columns)
    }


def _motion_at(results: MotionResults, data: xr.Dataset) -> Callable[[Array], xr.Dataset]:
    """The same motion at any places."""
    mechanism = results.mechanism
    if "speed_by" not in data.attrs:
        return lambda places: motion(mechanism, at=places)
    solution = solution_of(mechanism, data.attrs["mean"])
    return lambda places: steady_dataset(solution, turned_at(solution, at=places), data.attrs["speed_by"])


def _greatest(
    values: Array,
    places: Array,
    at: Callable[[Array], xr.Dataset] | None,
    pick: Callable[[xr.Dataset], Array],
) -> tuple[Array, Array]:
    """Greatest value of each row (columns, n) and its place, from all rounds."""
    if not len(values):
        return np.zeros(0), np.zeros(0)
    known = np.where(np.isfinite(values), values, -np.inf)
    nearest = np.argmax(known, axis=1)
    best, where = known[np.arange(len(values)), nearest], places[nearest]
    low, high = places[np.maximum(nearest - 1, 0)], places[np.minimum(nearest + 1, len(places) - 1)]
    for _round in range(ROUNDS if at is not None else 0):
        assert at is not None
        tried = np.linspace(low, high, PARTS + 1, axis=1)
        asked, back = np.unique(tried, return_inverse=True)
        found = pick(at(asked))[np.arange(len(values))[:, None], back.reshape(tried.shape)]
        k = np.argmax(found, axis=1)
        rows = np.arange(len(values))
        better = found[rows, k] > best
        best, where = np.where(better, found[rows, k], best), np.where(better, tried[rows, k], where)
        low, high = tried[rows, np.maximum(k - 1, 0)], tried[rows, np.minimum(k + 1, PARTS)]
    return best, where
