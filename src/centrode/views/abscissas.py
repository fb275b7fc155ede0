"""What curves of a motion are drawn over: the drive's value or time, the gaps in it, and the events along it."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from centrode.errors import Status
from centrode.quantities import QUANTITIES
from centrode.sheets.plots import Abscissa, AxisLabel, EventKind
from centrode.sheets.texts import Name, Sentence, Symbol

if TYPE_CHECKING:
    import xarray

    from centrode.model.mechanism import Mechanism
    from centrode.model.motion_parameter import DriveCoordinate

Array: TypeAlias = NDArray[np.float64]
Event: TypeAlias = tuple[float, EventKind]

EVENT_KINDS = (EventKind.LIMIT, EventKind.CHANGE_POINT)
"""By the number that datasets have for each."""


def main_abscissa(mechanism: Mechanism, dataset: xarray.Dataset) -> Abscissa:
    """The drive's value if one drive turns or moves uniformly, else time."""
    return over_drive(mechanism, dataset) if mechanism.motion_parameter.is_uniform else over_time(dataset)


def over_drive(mechanism: Mechanism, dataset: xarray.Dataset) -> Abscissa:
    """The value of the only drive [rad or m]."""
    values, order = in_time(dataset, dataset["drive_value"].isel(drive=0).to_numpy())
    return Abscissa(
        drive_label(mechanism.motion_parameter.drives[0]),
        values,
        order,
        limits_between(dataset, values),
        dataset["status"].to_numpy() == Status.CUT_OFF,
        tuple(within(values, events_of(dataset))),
    )


def drive_label(coordinate: DriveCoordinate) -> AxisLabel:
    """What a drive gives, with its symbol."""
    symbol, name = Symbol(coordinate.symbol), Name(coordinate.name)
    text = {
        "angle": Sentence("angle {symbol} of link {name}", symbol=symbol, name=name),
        "displacement": Sentence("displacement {symbol} along guide {name}", symbol=symbol, name=name),
        "distance": Sentence("distance {symbol} of {name}", symbol=symbol, name=name),
    }[coordinate.driven]
    return AxisLabel(text, unit=coordinate.unit)


def over_time(dataset: xarray.Dataset) -> Abscissa:
    """Time [s]; events stand where the only drive passes them, with several drives at their own times."""
    times, order = in_time(dataset, dataset["time"].to_numpy())
    if dataset.sizes["drive"] == 1:
        values, _order = in_time(dataset, dataset["drive_value"].isel(drive=0).to_numpy())
        breaks = limits_between(dataset, values)
        marks = [
            (time, kind) for value, kind in events_of(dataset) for time in passings(times, values, value)
        ]
    else:
        breaks, marks = limits_between(dataset, times), events_of(dataset)
    quantity = QUANTITIES["time"]
    label = AxisLabel(Sentence(quantity.long_name), Symbol(quantity.symbol), quantity.unit)
    cut = dataset["status"].to_numpy() == Status.CUT_OFF
    return Abscissa(label, times, order, breaks, cut, tuple(within(times, marks)))


def in_time(dataset: xarray.Dataset, values: Array) -> tuple[Array, NDArray[np.intp]]:
    """Values in the order of time, and that order."""
    order = np.argsort(dataset["time"].to_numpy(), kind="stable")
    return values[order], order


def events_of(dataset: xarray.Dataset) -> list[Event]:
    """Value of the drive [rad or m] (the time [s], with several drives) and kind of every event."""
    if "event_value" not in dataset:
        return []
    codes = dataset["event_kind"].to_numpy().tolist()
    return [
        (value, EVENT_KINDS[code])
        for value, code in zip(dataset["event_value"].to_numpy().tolist(), codes, strict=True)
    ]


def within(values: Array, marks: Iterable[Event]) -> list[Event]:
    """The marks that lie in the range of the values."""
    if not np.isfinite(values).any():
        return []
    slack = 1e-9 * float(np.nanmax(np.abs(values)))
    low, high = float(np.nanmin(values)) - slack, float(np.nanmax(values)) + slack
    return [(value, kind) for value, kind in marks if low <= value <= high]


def limits_between(dataset: xarray.Dataset, values: Array) -> NDArray[np.intp]:
    """Numbers of the samples before which a limit lies, strictly after the sample before."""
    before, after = values[:-1], values[1:]
    passed = np.zeros_like(before, dtype=bool)
    for value, kind in events_of(dataset):
        if kind is EventKind.LIMIT:
            passed |= (np.minimum(before, after) < value) & (value < np.maximum(before, after))
    return np.flatnonzero(passed) + 1


def passings(times: Array, values: Array, wanted: float) -> list[float]:
    """Times at which the polygon through (time, value) passes a value."""
    before, after = values[:-1] - wanted, values[1:] - wanted
    steps = np.flatnonzero((before * after < 0) | (after == 0))
    share = before[steps] / (before[steps] - after[steps])
    found = times[steps] + share * (times[steps + 1] - times[steps])
    return [float(times[0])] * bool(values[0] == wanted) + [float(time) for time in found]
