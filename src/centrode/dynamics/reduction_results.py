"""Masses and loads reduced to the drives, with the extremes of each part, and the sums behind them at instants."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.link_motions import LinkMotion, motions_of_links
from centrode.dynamics.load_courses import LoadCourse, driving_moments, load_courses
from centrode.dynamics.reduction import reduce
from centrode.kinematics.motion import motion
from centrode.kinematics.several_inputs.limits import End, limits_met

if TYPE_CHECKING:
    import xarray as xr

    from centrode.model.mechanism import Mechanism

Array: TypeAlias = npt.NDArray[np.float64]
ROUNDING = 1e-12
"""Means and extremes below this share of the greatest value are zero."""


@dataclass(frozen=True)
class PartExtremes:
    """Least, greatest and mean value of a reduced quantity, or of the share of a link or a load in it.

    Attributes
    ----------
    variable : name of the quantity in the dataset
    unit : SI unit
    label : the link or load; empty for the whole
    drives : of an element of the inertia matrix or of a generalised force
    least, greatest, mean : in `unit`, over the samples; NaN where no sample has a value
    """

    variable: str
    unit: str
    label: str
    drives: tuple[str, ...]
    least: float
    greatest: float
    mean: float


@dataclass(frozen=True)
class ReductionResults:
    """Masses and loads of a mechanism reduced to its drives.

    Attributes
    ----------
    mechanism : the mechanism
    reduction : dataset of `reduce`, over the motion
    extremes : of each quantity, then of its parts; means are over the value of the drive where one drive runs one
        way, else over time, by the trapezoidal rule
    instants : dataset of `reduce` at the instants; None without any, and with several drives
    links : in the plane, motion of every link with mass at each of the instants
    limits : what bounds the motion where samples are not reached; none where all are
    courses : how great every load is at the samples, beside the coordinate that it works along
    driving : (n) driving moment of a machine [N m], positive as the drive's value grows; None without
    """

    mechanism: Mechanism
    reduction: xr.Dataset
    extremes: tuple[PartExtremes, ...]
    instants: xr.Dataset | None
    links: tuple[tuple[LinkMotion, ...], ...]
    limits: tuple[End, ...]
    courses: tuple[LoadCourse, ...] = ()
    driving: Array | None = None


def reduction_results(
    mechanism: Mechanism,
    samples: int | None = None,
    start: float | None = None,
    stop: float | None = None,
    *,
    instants: Sequence[float] = (),
) -> ReductionResults:
    """Masses and loads reduced to the drives, and the extremes of each part.

    Parameters
    ----------
    samples, start, stop : as of `motion`
    instants : values of the drive [rad or m], times [s] where it follows a law; the sums are resolved there

    Raises
    ------
    InputError, NotComputedYet
        As `reduce`.

    Examples
    --------
    >>> import centrode as ct
    >>> from centrode.dynamics.reduction_results import reduction_results
    >>> results = reduction_results(ct.example("six-bar-press"), 37)
    >>> print(results.extremes[0].variable, results.extremes[0].unit)
    reduced_inertia kg m^2
    """
    found = results_of_reduction(mechanism, reduce(mechanism, samples, start, stop))
    at_instants = (
        reduce(mechanism, at=instants) if instants and "reduced_inertia" in found.reduction else None
    )
    links: tuple[tuple[LinkMotion, ...], ...] = ()
    if at_instants is not None and mechanism.space == "plane":
        there = motion(mechanism, at=instants)
        links = tuple(tuple(motions_of_links(mechanism, there.isel(sample=k))) for k in range(len(instants)))
    return replace(found, instants=at_instants, links=links)


def results_of_reduction(mechanism: Mechanism, reduction: xr.Dataset) -> ReductionResults:
    """A dataset of `reduce` with the extremes of each part, and with the limits where it has some."""
    bounds = limits_met(mechanism, reduction["status"].values)
    return ReductionResults(
        mechanism,
        reduction,
        tuple(_extremes(reduction)),
        None,
        (),
        bounds,
        load_courses(mechanism, reduction),
        driving_moments(mechanism, reduction),
    )


def _extremes(reduction: xr.Dataset) -> Iterator[PartExtremes]:
    along = _along(reduction)
    for variable, dimension in (("reduced_inertia", "link"), ("reduced_moment", "load")):
        if variable in reduction:
            unit, parts = str(reduction[variable].attrs["units"]), reduction[f"{variable}_part"]
            yield PartExtremes(variable, unit, "", (), *_over(reduction[variable].values, along))
            for label in map(str, reduction[dimension].values):
                values = parts.sel({dimension: label}).values
                yield PartExtremes(variable, unit, label, (), *_over(values, along))
    for variable in ("inertia_matrix", "generalised_force"):
        if variable in reduction:
            yield from _by_drives(reduction, variable, along)


def _by_drives(reduction: xr.Dataset, variable: str, along: Array) -> Iterator[PartExtremes]:
    """Elements of a matrix, each pair once, or of a vector."""
    drives = [str(name) for name in reduction["drive"].values]
    values = reduction[variable].values.reshape(reduction.sizes["sample"], -1)
    is_matrix = "drive_2" in reduction[variable].dims
    pairs = [(i, j) for i in range(len(drives)) for j in range(len(drives) if is_matrix else 1)]
    units = str(reduction[variable].attrs["units"]).split(", ")
    for number, (i, j) in enumerate(pairs):
        if not is_matrix or i <= j:
            names = (drives[i], drives[j]) if is_matrix else (drives[i],)
            unit = units[number % len(units)]
            yield PartExtremes(variable, unit, "", names, *_over(values[:, number], along))


def _along(reduction: xr.Dataset) -> Array:
    """Abscissa of means (n): the value of the only drive where it runs one way, else time [s]."""
    values, time = (np.asarray(reduction[name].values) for name in ("drive_value", "time"))
    steps = np.diff(values[:, 0])
    # over time where the drive comes back: over its value the way forth and back would cancel
    one_way = "reduced_inertia" in reduction and bool((steps > 0.0).all() or (steps < 0.0).all())
    return values[:, 0] if one_way else time


def _over(values: Array, along: Array) -> tuple[float, float, float]:
    """Least, greatest and mean of the values that are known; what rounding has left of zero is zero."""
    known = np.isfinite(values)
    if not known.any():
        return np.nan, np.nan, np.nan
    some, where = values[known], along[known]
    # the trapezoidal rule over samples that may lie unevenly
    width = float(where[-1] - where[0])
    mean = float(np.trapezoid(some, where)) / width if width else float(np.mean(some))
    low, high = float(np.min(some)), float(np.max(some))
    # what differs from zero by the rounding of the greatest value is zero
    noise = ROUNDING * max(abs(low), abs(high))
    return (
        0.0 if abs(low) <= noise else low,
        0.0 if abs(high) <= noise else high,
        0.0 if abs(mean) <= noise else mean,
    )
