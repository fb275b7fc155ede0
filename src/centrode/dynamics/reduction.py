"""Masses and loads reduced to the drive, as a labelled result."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.dynamics.burden import Burden
from centrode.dynamics.reducer import Reduced, Reducer, reduced
from centrode.dynamics.several import reduced_to_several
from centrode.dynamics.states import Moving, State
from centrode.kinematics.dataset import (
    Variable,
    attributes_of,
    coordinates_of,
    judgements_of,
    labels_of,
    named,
)
from centrode.kinematics.ready import ready
from centrode.kinematics.solve import Solved, asked_span, solve
from centrode.kinematics.spans import span_at
from centrode.model.mechanism import Mechanism

__all__ = ["Reduced", "Reducer", "reduce", "reduction_of"]


def reduce(
    mechanism: Mechanism,
    samples: int | None = None,
    start: float | None = None,
    stop: float | None = None,
    at: npt.ArrayLike | None = None,
) -> xr.Dataset:
    """Masses and loads reduced to the drive, or to several drives, at the samples of a motion.

    Parameters
    ----------
    samples, start, stop, at
        As for `motion`.

    Returns
    -------
    Dataset
        One drive: `reduced_inertia`, its derivative `reduced_inertia_slope` and `reduced_moment` (sample), by link
        and by load in `..._part`; `jumps`, values of the drive at which loads jump. Several drives:
        `inertia_matrix`, `christoffel`, `generalised_force` (docs: dynamics).

    Raises
    ------
    InputError
        As `motion` does; masses or loads that are not complete, or none; a formula without a value.
    NotComputedYet
        Friction by a coefficient.
    """
    prepared = ready(mechanism)
    burden = Burden.of(mechanism)
    if at is None:
        span = asked_span(prepared, samples, start, stop)
    else:
        span = span_at(prepared.kinematics.path, np.asarray(at, dtype=np.float64))
    return reduction_of(solve(prepared, span), burden)


def reduction_of(solved: Solved, burden: Burden | None = None) -> xr.Dataset:
    """The same for a motion solved before, of one mechanism."""
    burden = Burden.of(solved.ready.mechanism) if burden is None else burden
    if solved.ready.kinematics.path.by_time:
        return reduced_to_several(solved, burden)
    reducer = Reducer(solved.ready, burden)
    moving = _moving(solved, reducer)
    found = reduced(burden, State.of(solved, moving), solved.status[0])
    first, last = np.min(solved.span.parameter), np.max(solved.span.parameter)
    variables = _variables(found, solved.ready.parameter.units[0])
    unit = solved.ready.parameter.units[0]
    variables["drive_rate"] = named("drive_rate", ("sample",), moving.rate.copy(), unit)
    variables["jumps"] = named("jumps", ("jump",), reducer.jumps(float(first), float(last)), unit)
    variables["status"] = judgements_of(solved, ())["status"]
    coordinates = {
        name: values for name, values in coordinates_of(solved).items() if name in ("time", "drive")
    }
    coordinates["drive_value"] = coordinates_of(solved)["drive_value"]
    coordinates |= {"link": labels_of(burden.links), "load": labels_of(burden.labels)}
    attributes = attributes_of(solved) | {"rate_from": "drive" if _by_drive(solved) else "machine"}
    return xr.Dataset(variables, coords=coordinates, attrs=attributes)


def _by_drive(solved: Solved) -> bool:
    """Whether loads are taken at the speed of the drive, and not at the machine's mean speed."""
    ready = solved.ready
    return ready.mechanism.machine is None or not ready.parameter.is_uniform


def _moving(solved: Solved, reducer: Reducer) -> Moving:
    """The speed that loads see: of a drive of constant speed the machine's, if there is one; else the drive's own."""
    span = solved.span
    if _by_drive(solved):
        return Moving(span.time, span.parameter, span.rate)
    return reducer.moving(span.parameter)


def _variables(found: Reduced, unit: str) -> dict[str, Variable]:
    by_link, by_load = ("sample", "link"), ("sample", "load")
    return {
        "reduced_inertia": named("reduced_inertia", ("sample",), found.inertia, unit),
        "reduced_inertia_slope": named("reduced_inertia_slope", ("sample",), found.inertia_slope, unit),
        "reduced_moment": named("reduced_moment", ("sample",), found.moment, unit),
        "reduced_inertia_part": named("reduced_inertia_part", by_link, found.inertia_parts.T, unit),
        "reduced_inertia_slope_part": named(
            "reduced_inertia_slope_part", by_link, found.inertia_slope_parts.T, unit
        ),
        "reduced_moment_part": named("reduced_moment_part", by_load, found.moment_parts.T, unit),
    }
