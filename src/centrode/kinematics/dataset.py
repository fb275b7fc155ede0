"""Results with names: dimensions, units and attributes around the arrays of a motion."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import pandas as pd
import xarray as xr

from centrode import __version__
from centrode.algebra.arrays import ARRAYS
from centrode.errors import Status
from centrode.kinematics.solve import Solved
from centrode.locale import speaking
from centrode.model.files import mechanism_text
from centrode.quantities import QUANTITIES
from centrode.structure.steps import name_of

Array: TypeAlias = npt.NDArray[np.float64]
Variable: TypeAlias = tuple[tuple[str, ...], Any, dict[str, Any]]

BATCH = "mechanism"
EVENT_KINDS = ("limit", "change point")


def dataset_of(solved: Solved, vary: Mapping[str, Any] | None = None) -> xr.Dataset:
    """The labelled result of a motion; a batch has the dimension `mechanism` in front.

    What it says in words is English, whatever language messages are in, so that the same motion gives the same file.
    """
    batch = bool(vary)
    front = (BATCH,) if batch else ()
    variables = _in_time(solved, front)
    if not solved.ready.kinematics.path.by_time:
        variables |= _coefficients(solved, front)
    variables |= _judgements(solved, front)
    if not batch:
        variables |= _events(solved)
    data = xr.Dataset(variables, coords=_coordinates(solved), attrs=_attributes(solved))
    for path, values in (vary or {}).items():
        data = data.assign_coords({path: (BATCH, np.asarray(values, dtype=np.float64))})
    return data


def _named(name: str, dimensions: tuple[str, ...], values: Any, drive_unit: str = "rad") -> Variable:
    return dimensions, values, dict(_words(name, drive_unit))


@functools.cache
def _words(name: str, drive_unit: str) -> Mapping[str, Any]:
    quantity = QUANTITIES[name].for_drive(drive_unit)
    return {"units": quantity.unit, "symbol": quantity.symbol, "long_name": quantity.long_name}


def _lanes(array: npt.NDArray[Any], batch: tuple[str, ...]) -> npt.NDArray[Any]:
    return array if batch else array[0]


def _in_time(solved: Solved, front: tuple[str, ...]) -> dict[str, Variable]:
    """Values and derivatives by time, by the chain rule from those by the path's parameter."""
    span = solved.span
    kinds = (
        (("position", "velocity", "acceleration"), solved.all_points, ("sample", "point", "axis")),
        (("angle", "angular_velocity", "angular_acceleration"), solved.angles, ("sample", "link")),
        (("slide", "slide_velocity", "slide_acceleration"), solved.slides, ("sample", "guide")),
    )
    found: dict[str, Variable] = {}
    for names, by_parameter, dimensions in kinds:
        along = (slice(None), *[None] * (by_parameter.ndim - 3))  # samples, then what stands behind them
        factors = (None, span.rate, span.rate**2)
        for order, (name, factor) in enumerate(zip(names, factors, strict=True)):
            values = by_parameter[order] if factor is None else by_parameter[order] * factor[along]
            if order == 2 and span.second_rate.any():
                values += by_parameter[1] * span.second_rate[along]
            found[name] = _named(name, front + dimensions, _lanes(values, front))
    return found


def _coefficients(solved: Solved, front: tuple[str, ...]) -> dict[str, Variable]:
    """Kinematic coefficients: derivatives by the drive's value."""
    unit = "rad" if solved.ready.kinematics.path.driven[0].drive.kind == "angle" else "m"
    found = {}
    for order, word in ((1, "velocity"), (2, "acceleration")):
        for name, values, dimensions in (
            (f"{word}_coefficient", solved.all_points[order], ("sample", "point", "axis")),
            (f"angular_{word}_coefficient", solved.angles[order], ("sample", "link")),
            (f"slide_{word}_coefficient", solved.slides[order], ("sample", "guide")),
        ):
            found[name] = _named(name, front + dimensions, _lanes(values, front), unit)
    return found


def _judgements(solved: Solved, front: tuple[str, ...]) -> dict[str, Variable]:
    dimensions, status, attributes = _named("status", (*front, "sample"), _lanes(solved.status, front))
    attributes["flag_values"] = np.array([s.value for s in Status], dtype=np.int8)
    attributes["flag_meanings"] = " ".join(s.name.lower() for s in Status)
    return {
        "status": (dimensions, status, attributes),
        "residual": _named("residual", (*front, "sample"), _lanes(solved.residual, front)),
    }


def _events(solved: Solved) -> dict[str, Variable]:
    events = solved.events()
    by_time = solved.ready.kinematics.path.by_time
    kind = "rad" if by_time or solved.ready.kinematics.path.driven[0].drive.kind == "angle" else "m"
    with speaking("en"):
        groups = [name_of(solved.ready.structure.groups[event.group]) for event in events]
    kinds = np.array([EVENT_KINDS.index(event.kind) for event in events], dtype=np.int8)
    dimensions, values, attributes = _named("event_kind", ("event",), kinds)
    attributes["flag_values"] = np.arange(len(EVENT_KINDS), dtype=np.int8)
    attributes["flag_meanings"] = " ".join(word.replace(" ", "_") for word in EVENT_KINDS)
    places = _named("event_value", ("event",), np.array([event.at for event in events]), kind)
    if by_time:
        places[2]["units"] = "s"
    return {
        "event_value": places,
        "event_kind": (dimensions, values, attributes),
        "event_group": _named("event_group", ("event",), np.array(groups, dtype=str)),
    }


def _coordinates(solved: Solved) -> dict[str, Any]:
    path = solved.ready.kinematics.path
    values = path.drive_values(ARRAYS, solved.span.parameter)
    count = len(solved.span.time)
    drives = np.stack([np.broadcast_to(value, (count,)) for value in values.values()], axis=-1)
    units = ["rad" if one.drive.kind == "angle" else "m" for one in path.driven]
    drive_value = _named("drive_value", ("sample", "drive"), drives, units[0])
    if len(set(units)) > 1:
        drive_value[2]["units"] = " ".join(units)
    frame = tuple(solved.ready.structure.dimensions.frame)
    return {
        "time": _named("time", ("sample",), solved.span.time),
        "drive_value": drive_value,
        "point": _labels(frame + solved.layout.points),
        "link": _labels(solved.layout.links),
        "guide": _labels(solved.layout.guides),
        "drive": _labels(tuple(values)),
        "axis": _labels(("x", "y")),
    }


def _labels(names: tuple[str, ...]) -> Any:
    # an index as it is: from an array xarray makes one by way of every array library it finds, pint included
    return pd.Index(names, dtype=object)


def _attributes(solved: Solved) -> dict[str, Any]:
    mechanism = solved.ready.mechanism
    with speaking("en"):
        worst = solved.worst_constraint.label
    return {
        "title": mechanism.title,
        "mechanism": mechanism_text(mechanism),
        "version": __version__,
        "mobility": solved.ready.mobility,
        "worst_residual": float(np.nanmax(solved.residual, initial=0.0)),
        "worst_residual_constraint": worst,
    }
