"""The motion of a mechanism as a labelled result."""

from __future__ import annotations

import functools
import importlib
from collections.abc import Mapping
from typing import TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.algebra.arrays import ARRAYS
from centrode.errors import InputError
from centrode.kinematics.dataset import dataset_of
from centrode.kinematics.ready import Ready, ready
from centrode.kinematics.solve import Progress, Solved, asked_span, solve
from centrode.kinematics.spans import Span, span_at
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.structure.dimensions import Dimensions, dimensions_of

Values: TypeAlias = Mapping[str, npt.ArrayLike]

# what machine code needs is not loaded for one motion
_many = functools.partial(importlib.import_module, "centrode.kinematics.compiled.many")


def motion(
    mechanism: Mechanism,
    samples: int | None = None,
    start: float | None = None,
    stop: float | None = None,
    at: npt.ArrayLike | None = None,
    vary: Values | None = None,
    progress: Progress | None = None,
) -> xr.Dataset:
    """Positions, velocities and accelerations of a mechanism, at evenly spaced samples or at given places.

    Parameters
    ----------
    samples : int
        The description's own number, else 361 (with both ends).
    start, stop : float [rad or m, or s]
        Values of the drive; times where the drive is a law of time or there are several drives. One turn of
        an angle drive if left out.
    at : (n,) values of the drive [rad or m], or times [s]
        Exactly these places instead of evenly spaced ones; the three arguments before it are then not used.
    vary : path -> (batch,) values [m or rad]
        Dimensions that vary from mechanism to mechanism ("links.AC.length"); the signs of the initial
        position stay.
    progress : called with (mechanisms done, mechanisms in all)

    Returns
    -------
    Dataset
        Dimensions sample, point, link, guide, drive, axis (docs: results); with `vary` a dimension
        mechanism in front. Absent values are NaN and have a status.

    Raises
    ------
    InputError
        The description does not define a motion: drives against mobility, initial position, range.
    NotComputedYet
        It names what this version does not compute.
    """
    prepared = ready(mechanism)
    numbers, lanes = _batch(mechanism, vary)
    if at is None:
        span = asked_span(prepared, samples, start, stop)
    else:
        span = span_at(prepared.kinematics.path, np.asarray(at, dtype=np.float64))
    return dataset_of(_solved(prepared, span, numbers, lanes, progress), vary)


def initial_place(mechanism: Mechanism) -> float:
    """Value of the drive in the initial position, with a law or several drives the time there [rad, m or s]."""
    prepared = ready(mechanism)
    return float(prepared.kinematics.path.initial) if prepared.parameter.is_uniform else 0.0


def _solved(
    ready: Ready, span: Span, numbers: Dimensions | None, lanes: int, progress: Progress | None
) -> Solved:
    if numbers is None:
        return solve(ready, span, progress=progress)
    found: Solved = _many().solve_many(ready, span, numbers, lanes, progress)
    return found


def _batch(mechanism: Mechanism, vary: Values | None) -> tuple[Dimensions | None, int]:
    if not vary:
        return None, 1
    arrays = {path: np.asarray(values, dtype=np.float64) for path, values in vary.items()}
    sizes = {array.size for array in arrays.values()}
    if any(array.ndim != 1 for array in arrays.values()) or len(sizes) != 1 or 0 in sizes:
        raise InputError("vary", _("every path needs the same number of values, in one dimension"))
    for path, array in arrays.items():
        if not np.isfinite(array).all():
            raise InputError(path, _("values must be finite"))
    return dimensions_of(mechanism, arrays, ARRAYS), sizes.pop()
