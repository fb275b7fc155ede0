"""Columns of datasets: which variables a table of a motion has, in which order, under which names and how rounded."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations_with_replacement, product
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from centrode.errors import STATUSES_NOT_REACHED, Status
from centrode.quantities import STATUS_WORDS
from centrode.sheets.sheet import Column, Table
from centrode.sheets.texts import Joined, Name, Number, Sentence, Text

if TYPE_CHECKING:
    import xarray

Array: TypeAlias = NDArray[np.float64]

ROUNDING = 1e-12
"""Share of the greatest number beside it below which a number that is shown is rounding."""
VARIABLES = (
    "turned",
    "moment_of_loads",
    "driving_moment",
    "work_of_loads",
    "work_of_drive",
    "work",
    "inertia_of_links",
    "inertia_slope_of_links",
    "energy_of_links",
    "energy_change",
    "drive_speed",
    "drive_acceleration",
    "drive_speed_first_order",
    "drive_acceleration_first_order",
    "inertia",
    "moment_of_friction",
    "power_of_drive",
    "power_of_loads",
    "work_of_friction",
    "work_of_other_loads",
    "kinetic_energy",
    "potential_energy",
    "energy_residual",
    "angle",
    "angular_velocity",
    "angular_acceleration",
    "joint_angle",
    "joint_velocity",
    "joint_acceleration",
    "position",
    "velocity",
    "acceleration",
    "slide",
    "slide_velocity",
    "slide_acceleration",
    "contact",
    "angular_velocity_coefficient",
    "angular_acceleration_coefficient",
    "joint_velocity_coefficient",
    "joint_acceleration_coefficient",
    "velocity_coefficient",
    "acceleration_coefficient",
    "slide_velocity_coefficient",
    "slide_acceleration_coefficient",
    "hinge_angle",
    "hinge_velocity",
    "hinge_acceleration",
    "polar_angle",
    "azimuth",
)


def numeric_columns(dataset: xarray.Dataset) -> Iterator[tuple[str, str, xarray.DataArray]]:
    """Header without unit, SI unit and values of every column of numbers, in the order of the table."""
    yield "time", unit_of(dataset["time"]), dataset["time"]
    drives = [str(name) for name in dataset["drive"].values]
    for number, name in enumerate(drives):
        yield f"drive_{name}", drive_units(dataset)[number], dataset["drive_value"].isel(drive=number)
    for variable in VARIABLES:
        if variable in dataset:
            yield from columns_of(dataset[variable], variable)


def columns_of(values: xarray.DataArray, variable: str) -> Iterator[tuple[str, str, xarray.DataArray]]:
    """One column for each link, guide, or axis of a point."""
    dims = [str(dim) for dim in values.dims if dim != "sample"]
    # by their places: looking names up takes longer than all else
    for at in product(*(enumerate(values[dim].values.tolist()) for dim in dims)):
        places, labels = zip(*at, strict=True) if at else ((), ())
        header = "_".join([variable, *map(str, labels)])
        yield header, unit_of(values), values.isel(dict(zip(dims, places, strict=True)))


def force_columns(
    dataset: xarray.Dataset, variables: Sequence[str]
) -> Iterator[tuple[str, str, xarray.DataArray]]:
    """Time, values of the drives, and a column for each combination of labels: "reduced_inertia_part_AB".

    Each is a name without unit, an SI unit and the values.
    """
    yield "time", unit_of(dataset["time"]), dataset["time"]
    for number, name in enumerate(dataset["drive"].values):
        yield f"drive_{name}", drive_units(dataset)[number], dataset["drive_value"].isel(drive=number)
    for variable in variables:
        if variable in dataset:
            values = dataset[variable]
            # there is one unit for all, or one for each drive; drives stand behind links and loads, so units come round
            units = unit_of(values).split(", ")
            for number, (header, _unit, chosen) in enumerate(columns_of(values, variable)):
                yield header, units[number % len(units)], chosen


def unit_of(values: xarray.DataArray) -> str:
    """SI unit of a variable; none for a plain number."""
    unit = str(values.attrs.get("units", ""))
    return "" if unit == "1" else unit


def drive_units(dataset: xarray.Dataset) -> list[str]:
    """SI unit of each drive's value: `units` names one for all, or one for each drive."""
    units = unit_of(dataset["drive_value"]).split() or [""]
    return units * dataset.sizes["drive"] if len(units) == 1 else units


SHOWN_ROWS = 25
"""Rows of a table over a motion that a document shows."""


def motion_table(dataset: xarray.Dataset, points: Sequence[str] | None = None) -> Table:
    """The table of a motion, one row a sample; of the points named, of all if None.

    Raises ValueError for more than one motion.
    """
    if extra := set(dataset["status"].dims) - {"sample"}:
        raise ValueError(f"a table shows one motion: select along {sorted(map(str, extra))} first")
    selected = dataset if points is None else dataset.sel(point=list(points))
    columns = [Column(name, values.values, unit) for name, unit, values in numeric_columns(selected)]
    residual = Column("residual", dataset["residual"].values)
    return Table((*columns, status_column(dataset["status"]), residual))


def coefficients_table(dataset: xarray.Dataset, points: Sequence[str]) -> Table:
    """The table of kinematic coefficients by each drive, one row a sample; of the points named."""
    chosen = dataset.sel(point=list(points))
    columns = [Column(name, values.values, unit) for name, unit, values in _coefficient_columns(chosen)]
    return Table((*columns, status_column(dataset["status"])))


def _coefficient_columns(dataset: xarray.Dataset) -> Iterator[tuple[str, str, xarray.DataArray]]:
    """Header without unit, SI unit and values of every column: "velocity_coefficient_C_x_by_OA".

    Of a pair of mixed derivatives, which are equal, there is one column.
    """
    yield "time", unit_of(dataset["time"]), dataset["time"]
    names = [str(name) for name in dataset["drive"].values]
    for number, name in enumerate(names):
        yield f"drive_{name}", drive_units(dataset)[number], dataset["drive_value"].isel(drive=number)
    for variable, values in dataset.data_vars.items():
        if "drive" not in values.dims:
            continue
        twice = "drive_2" in values.dims
        units = _units_by_drive(values, len(names) ** (2 if twice else 1))
        dims = [str(dim) for dim in values.dims if dim not in ("sample", "drive", "drive_2")]
        for labels in product(*(values[dim].values.tolist() for dim in dims)):
            one = values.sel(dict(zip(dims, labels, strict=True)))
            header = "_".join([str(variable), *map(str, labels)])
            for pair in combinations_with_replacement(range(len(names)), 2 if twice else 1):
                by = "_".join(names[k] for k in pair)
                unit = units[pair[0] * len(names) + pair[1] if twice else pair[0]]
                place = dict(zip(("drive", "drive_2"), pair, strict=False))
                yield f"{header}_by_{by}", unit, one.isel(place)


def _units_by_drive(values: xarray.DataArray, count: int) -> list[str]:
    """SI unit of each drive, or pair of drives: `units` names one for all, or all of them."""
    units = ["" if unit == "1" else unit for unit in str(values.attrs.get("units", "")).split(", ")]
    return units * count if len(units) == 1 else units


def status_column(status: xarray.DataArray) -> Column:
    """What each sample is worth, in the words of files."""
    return Column("status", tuple(Name(Status(code).word) for code in status.values.tolist()))


def rows_shown(count: int, most: int = SHOWN_ROWS) -> tuple[int, ...]:
    """Numbers of a few of many rows, both ends among them; every k-th where that gives not much fewer than `most`."""
    if count <= most:
        return tuple(range(count))
    least = -(-(count - 1) // (most - 1))
    step = next((k for k in range(least, 2 * least + 1) if (count - 1) % k == 0), None)
    if step is not None:
        return tuple(range(0, count, step))
    return tuple(round(float(k)) for k in np.linspace(0, count - 1, most))


def rows_reached(status: xarray.DataArray, most: int = SHOWN_ROWS) -> tuple[int, ...]:
    """Numbers of a few of the samples that a mechanism reaches, as `rows_shown` has them; of all if it reaches none."""
    reached = np.flatnonzero(~np.isin(status.values, STATUSES_NOT_REACHED))
    if not reached.size:
        return rows_shown(status.size, most)
    return tuple(int(reached[row]) for row in rows_shown(reached.size, most))


def counted_statuses(status: NDArray[np.int8]) -> Text:
    """How many there are of each status: "ok 12, open 3"."""
    codes, counts = np.unique(status, return_counts=True)
    return Joined(
        [
            Joined((Sentence(STATUS_WORDS[Status(code)]), Number(count, digits="d")), " ")
            for code, count in zip(codes.tolist(), counts.tolist(), strict=True)
        ]
    )


def instant_columns(dataset: xarray.Dataset, samples: NDArray[np.intp]) -> Iterator[Column]:
    """Time and values of the drives of some samples, which may come more than once."""
    yield Column("time", dataset["time"].values[samples], "s")
    values = dataset["drive_value"].values[samples]
    for number, (name, unit) in enumerate(zip(dataset["drive"].values, drive_units(dataset), strict=True)):
        yield Column(f"drive_{name}", values[:, number], unit)


def without_rounding(values: ArrayLike) -> Array:
    """Numbers (..., n) with zero in place of what rounding leaves of it beside the greatest of each n."""
    numbers = np.asarray(values, dtype=np.float64)
    size = np.max(np.abs(numbers), axis=-1, keepdims=True, initial=0.0)
    return np.where(np.abs(numbers) < ROUNDING * size, 0.0, numbers)
