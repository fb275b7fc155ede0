"""What curves of a motion are drawn over: the value of the drive or time, the gaps in it, the events along it.

A mechanism that locks is drawn over the part of its motion that it reaches, up to its dead positions.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from centrode.errors import STATUSES_NOT_REACHED, Status
from centrode.quantities import QUANTITIES
from centrode.sheets.plots import Abscissa, AxisLabel, EventKind
from centrode.sheets.texts import Name, Sentence, Symbol, Text

if TYPE_CHECKING:
    import xarray

    from centrode.model.mechanism import Mechanism
    from centrode.model.motion_parameter import DriveCoordinate

Array: TypeAlias = NDArray[np.float64]
LIMIT, CHANGE_POINT = 0, 1
"""Kinds of events in a dataset."""
EVENTS = {LIMIT: EventKind.LIMIT, CHANGE_POINT: EventKind.CHANGE_POINT}


def motion_abscissa(mechanism: Mechanism, dataset: xarray.Dataset) -> Abscissa:
    """The value of the drive if one drive turns or moves uniformly, else time."""
    return over_drive(mechanism, dataset) if mechanism.motion_parameter.is_uniform else over_time(dataset)


def over_drive(mechanism: Mechanism, dataset: xarray.Dataset) -> Abscissa:
    """The value of the only drive."""
    coordinate = mechanism.motion_parameter.drives[0]
    values, order = in_time(dataset, dataset["drive_value"].isel(drive=0).values)
    return _over_reached(
        drive_label(coordinate), dataset, values, order, limits_between(dataset, values), events(dataset)
    )


def drive_label(coordinate: DriveCoordinate) -> AxisLabel:
    """What a drive moves, with its symbol."""
    return AxisLabel(text_of_drive(coordinate), unit=coordinate.unit)


def text_of_drive(coordinate: DriveCoordinate) -> Text:
    """What a drive moves, with its symbol."""
    name, symbol = Name(coordinate.name), Symbol(coordinate.symbol)
    if coordinate.is_chosen:
        return Sentence("generalised coordinate {symbol}", symbol=symbol)
    match coordinate.driven:
        case "angle":
            return Sentence("angle {symbol} of link {name}", symbol=symbol, name=name)
        case "displacement":
            return Sentence("displacement {symbol} along guide {name}", symbol=symbol, name=name)
        case _:
            return Sentence("distance {symbol} of {name}", symbol=symbol, name=name)


def over_time(dataset: xarray.Dataset) -> Abscissa:
    """Time; events stand where the only drive passes them, with several drives at their own times."""
    times, order = in_time(dataset, dataset["time"].values)
    quantity = QUANTITIES["time"]
    label = AxisLabel(Sentence(quantity.long_name), Symbol(quantity.symbol), quantity.unit)
    if dataset.sizes["drive"] > 1:
        return _over_reached(label, dataset, times, order, limits_between(dataset, times), events(dataset))
    values, _order = in_time(dataset, dataset["drive_value"].isel(drive=0).values)
    marks = [(time, kind) for value, kind in events(dataset) for time in passings(times, values, value)]
    return _over_reached(label, dataset, times, order, limits_between(dataset, values), marks)


def _over_reached(
    label: AxisLabel,
    dataset: xarray.Dataset,
    values: Array,
    order: NDArray[np.intp],
    breaks: NDArray[np.intp],
    marks: list[tuple[float, int]],
) -> Abscissa:
    """Values in the order of time as far as they are reached, and up to the limits that bound what is reached."""
    first, last = _span_reached(dataset["status"].values[order])
    limits = [value for value, kind in marks if kind == LIMIT]
    ends = (
        _bound(limits, float(values[first]), None if first == 0 else float(values[first - 1])),
        _bound(limits, float(values[last]), None if last == len(values) - 1 else float(values[last + 1])),
    )
    return Abscissa(
        label,
        values[first : last + 1],
        order[first : last + 1],
        breaks[(breaks > first) & (breaks <= last)] - first,
        dataset["status"].values == Status.CUT_OFF,
        _events(within(np.array([*values[first : last + 1], *ends]), marks)),
        ends,
    )


def _bound(limits: list[float], reached: float, beyond: float | None) -> float:
    """The limit between the last value that is reached and the first one beyond; that value where there is none."""
    if beyond is None:
        return reached
    between = [value for value in limits if min(reached, beyond) <= value <= max(reached, beyond)]
    return min(between, key=lambda value: abs(value - reached), default=reached)


def _span_reached(status: NDArray[np.int8]) -> tuple[int, int]:
    """The first and the last sample that is reached; those of the whole motion where none is."""
    reached = np.flatnonzero(~np.isin(status, STATUSES_NOT_REACHED))
    return (int(reached[0]), int(reached[-1])) if reached.size else (0, len(status) - 1)


def reached_part(dataset: xarray.Dataset) -> xarray.Dataset:
    """The part of a motion between the first and the last sample in time that is reached; all of it if none is."""
    _times, order = in_time(dataset, dataset["time"].values)
    first, last = _span_reached(dataset["status"].values[order])
    if (first, last) == (0, len(order) - 1):
        return dataset
    return dataset.isel(sample=np.sort(order[first : last + 1]))


def _events(marks: list[tuple[float, int]]) -> tuple[tuple[float, EventKind], ...]:
    return tuple((value, EVENTS[kind]) for value, kind in marks)


def in_time(dataset: xarray.Dataset, values: Array) -> tuple[Array, NDArray[np.intp]]:
    """Values in the order of time, and that order."""
    order = np.argsort(dataset["time"].values, kind="stable")
    return values[order], order


def events(dataset: xarray.Dataset) -> list[tuple[float, int]]:
    """Value of the drive (the time, with several drives) and kind of every event."""
    if "event_value" not in dataset:
        return []
    return list(
        zip(dataset["event_value"].values.tolist(), dataset["event_kind"].values.tolist(), strict=True)
    )


def events_of(dataset: xarray.Dataset) -> list[tuple[float, EventKind]]:
    """Value of the drive [rad or m] (the time [s], with several drives) and kind of every event."""
    return list(_events(events(dataset)))


def within(values: Array, marks: list[tuple[float, int]]) -> list[tuple[float, int]]:
    """The marks that lie in the range of the values."""
    if not np.isfinite(values).any():
        return []
    slack = 1e-9 * float(np.nanmax(np.abs(values)))
    low, high = float(np.nanmin(values)) - slack, float(np.nanmax(values)) + slack
    return [(value, kind) for value, kind in marks if low <= value <= high]


def limits_between(dataset: xarray.Dataset, values: Array) -> NDArray[np.intp]:
    """Numbers of the samples before which a limit lies, strictly after the sample before."""
    found: set[int] = set()
    before, after = values[:-1], values[1:]
    for value, kind in events(dataset):
        if kind == LIMIT:
            passed = (np.minimum(before, after) < value) & (value < np.maximum(before, after))
            found |= set((np.flatnonzero(passed) + 1).tolist())
    return np.array(sorted(found), dtype=np.intp)


def passings(times: Array, values: Array, wanted: float) -> list[float]:
    """Times at which the polygon through (time, value) passes a value."""
    before, after = values[:-1] - wanted, values[1:] - wanted
    steps = np.flatnonzero((before * after < 0) | (after == 0))
    share = before[steps] / (before[steps] - after[steps])
    found = times[steps] + share * (times[steps + 1] - times[steps])
    return [float(times[0])] * bool(values[0] == wanted) + [float(time) for time in found]
