"""What curves are drawn over: the drive's value or time, the gaps in it, the events along it, and its ticks."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axis import Axis
from matplotlib.ticker import FuncFormatter, MultipleLocator
from numpy.typing import NDArray

from centrode.equations.instants import CHANGE_POINT as CHANGE_POINT
from centrode.errors import Status
from centrode.locale import _
from centrode.present.shown import formula, labelled, plain, shown_as
from centrode.quantities import QUANTITIES
from centrode.views.abscissa import (
    LIMIT as LIMIT,
)
from centrode.views.abscissa import (
    events,
    in_time,
    limits_between,
    passings,
    within,
)

if TYPE_CHECKING:
    import xarray

    from centrode.model.mechanism import Mechanism
    from centrode.model.motion_parameter import DriveCoordinate

Array = NDArray[np.float64]
STEPS = {
    "deg": (1, 2, 5, 10, 15, 30, 45, 90, 180, 360, 720, 1440, 3600),
    "rad": tuple(np.pi * part for part in (1 / 12, 1 / 6, 1 / 4, 1 / 2, 1, 2, 4, 8, 20)),
}


@dataclass(frozen=True)
class Abscissa:
    """The horizontal axis of curves.

    Attributes
    ----------
    values : (sample) [unit]
        In the order of time.
    order, breaks : (sample), (any)
        The samples in the order of time, and the places in it where a limit parts two samples.
    cut : (sample)
        True where the sample is cut off from the initial position.
    marks : tuple of (value, kind)
        Limits and change points within the range.
    label, unit : str
        Text of the axis, and its unit.
    """

    values: Array
    order: NDArray[np.intp]
    breaks: NDArray[np.intp]
    cut: NDArray[np.bool_]
    marks: tuple[tuple[float, int], ...]
    label: str
    unit: str

    def parts(self, curve: Array) -> tuple[Array, Array]:
        """A curve in drawing order, as its regular and its cut-off part; a gap parts what must not be joined."""
        ordered, cut = curve[self.order], self.cut[self.order]
        regular, beyond = np.where(cut, np.nan, ordered), np.where(cut, ordered, np.nan)
        return np.insert(regular, self.breaks, np.nan), np.insert(beyond, self.breaks, np.nan)

    @property
    def drawn(self) -> Array:
        """The values with the gaps of `parts` put in."""
        return np.insert(self.values, self.breaks, np.nan)


def main_abscissa(mechanism: Mechanism, dataset: xarray.Dataset) -> Abscissa:
    """The drive's value if one drive turns or moves uniformly, else time."""
    return over_drive(mechanism, dataset) if mechanism.motion_parameter.is_uniform else over_time(dataset)


def over_drive(mechanism: Mechanism, dataset: xarray.Dataset) -> Abscissa:
    """The value of the only drive, in the unit of the display."""
    coordinate = mechanism.motion_parameter.drives[0]
    factor, unit = shown_as(coordinate.unit, mechanism.display)
    text = text_of_drive(coordinate)
    values, order = in_time(dataset, dataset["drive_value"].isel(drive=0).to_numpy())
    marks = within(values, events(dataset))
    return Abscissa(
        factor * values,
        order,
        limits_between(dataset, values),
        dataset["status"].to_numpy() == Status.CUT_OFF,
        tuple((factor * value, kind) for value, kind in marks),
        labelled(text, unit),
        unit,
    )


def text_of_drive(coordinate: DriveCoordinate) -> str:
    """What a drive gives, with its symbol."""
    text = {
        "angle": _("angle {symbol} of link {name}"),
        "displacement": _("displacement {symbol} along guide {name}"),
        "distance": _("distance {symbol} of {name}"),
    }[coordinate.driven]
    return text.format(symbol=formula(coordinate.symbol), name=plain(coordinate.name))


def over_time(dataset: xarray.Dataset) -> Abscissa:
    """Time; events stand where the only drive passes them, with several drives at their own times."""
    times, order = in_time(dataset, dataset["time"].to_numpy())
    if dataset.sizes["drive"] == 1:
        values, _order = in_time(dataset, dataset["drive_value"].isel(drive=0).to_numpy())
        breaks = limits_between(dataset, values)
        marks = [(time, kind) for value, kind in events(dataset) for time in passings(times, values, value)]
    else:
        breaks, marks = limits_between(dataset, times), events(dataset)
    cut = dataset["status"].to_numpy() == Status.CUT_OFF
    quantity = QUANTITIES["time"]
    label = labelled(f"{quantity.title} {formula(quantity.symbol)}", quantity.unit)
    return Abscissa(times, order, breaks, cut, tuple(within(times, marks)), label, quantity.unit)


def angle_ticks(axis: Axis, low: float, high: float, unit: str, most: int) -> None:
    """Ticks at round angles: multiples of 15, 30, 45, 90 degrees, or of parts of pi; others stay as they are."""
    if unit not in STEPS or not high > low or high - low > most * STEPS[unit][-1]:
        return
    step = next(step for step in STEPS[unit] if (high - low) / step <= most)
    if high - low < 2 * step:
        return
    axis.set_major_locator(MultipleLocator(float(step)))
    if unit == "rad":
        axis.set_major_formatter(FuncFormatter(lambda value, _position: part_of_pi(value)))


def part_of_pi(value: float) -> str:
    """An angle in radians as a part of pi: "3π/2" for 4.712..."""
    part = Fraction(value / np.pi).limit_denominator(12)
    if part == 0:
        return "0"
    above = "" if abs(part.numerator) == 1 else str(abs(part.numerator))
    below = "" if part.denominator == 1 else f"/{part.denominator}"
    sign = "−" if part < 0 else ""
    return f"{sign}{above}π{below}"
