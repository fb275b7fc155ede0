"""Tables of a motion: CSV for spreadsheets and people, netCDF for programs."""

from __future__ import annotations

import csv
import io
import itertools
from collections.abc import Iterable, Iterator, Sequence
from itertools import combinations_with_replacement, product
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.errors import InputError, Status
from centrode.locale import _
from centrode.present.displayed_units import shown_as
from centrode.views.columns import drive_units, numeric_columns, unit_of

if TYPE_CHECKING:
    import xarray

    from centrode.model.mechanism import Display

BLOCK = 10_000
"""Rows of a table that are turned into text at once."""


def motion_table(
    dataset: xarray.Dataset, display: Display | None = None, points: Sequence[str] | None = None
) -> tuple[list[str], list[list[float] | list[str]]]:
    """Headers and columns of a motion's table, one row a sample.

    Parameters
    ----------
    dataset : Dataset
        Result of a motion without batch dimensions.
    display : Display, optional
        Units of lengths and angles; SI and radians if left out, and then the numbers are the dataset's own.
    points : sequence of names, optional
        The points to show, usually the moving ones; all if left out.

    Returns
    -------
    headers : list of str
        Name and unit: "angle_AC [rad]", "position_C_x [m]".
    columns : list of lists
        Floats; words for the status.
    """
    if extra := set(dataset["status"].dims) - {"sample"}:
        raise ValueError(f"a table shows one motion: select along {sorted(map(str, extra))} first")
    chosen = dataset if points is None else dataset.sel(point=list(points))
    headers: list[str] = []
    columns: list[list[float] | list[str]] = []
    for header, unit, values in numeric_columns(chosen):
        factor, shown = shown_as(unit, display)
        headers.append(f"{header} [{shown}]" if shown else header)
        columns.append((values if factor == 1.0 else values * factor).values.tolist())
    headers += ["status", "residual"]
    columns.append([Status(code).word for code in dataset["status"].values.tolist()])
    columns.append(dataset["residual"].values.tolist())
    return headers, columns


def write_motion_csv(
    dataset: xarray.Dataset, path: Path, display: Display | None = None, points: Sequence[str] | None = None
) -> None:
    """Write a motion's table as CSV: UTF-8, one line end everywhere, numbers that read back bit for bit.

    Parameters are those of `motion_table`. A number that does not exist is an empty field.
    """
    with Path(path).open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        # as Python's own numbers a table takes many times the memory of the dataset
        for first in range(0, max(dataset.sizes["sample"], 1), BLOCK):
            block = dataset.isel(sample=slice(first, first + BLOCK))
            headers, columns = motion_table(block, display, points)
            if first == 0:
                writer.writerow(headers)
            writer.writerows(map(field, row) for row in zip(*columns, strict=True))


def field(value: float | str) -> str:
    """A value as a field: the shortest digits that read back as the same number, nothing for NaN."""
    if isinstance(value, str):
        return value
    return "" if value != value else repr(value)


def write_columns(
    path: str | Path,
    columns: Iterable[tuple[str, str, xarray.DataArray]],
    status: xarray.DataArray,
    display: Display | None,
) -> None:
    """Write columns (header, SI unit, values) and the status as CSV, one row a sample; NaN is an empty field."""
    headers, lists = [], []
    for header, unit, values in columns:
        factor, shown = shown_as(unit, display)
        headers.append(f"{header} [{shown}]" if shown else header)
        lists.append((values if factor == 1.0 else values * factor).values.tolist())
    lists.append([Status(code).word for code in status.values.tolist()])
    with Path(path).open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow([*headers, "status"])
        writer.writerows(map(field, row) for row in zip(*lists, strict=True))


# Tables of kinematic coefficients by each drive.


def write_coefficients_csv(
    dataset: xarray.Dataset, path: Path, display: Display | None = None, points: Sequence[str] | None = None
) -> None:
    """Write kinematic coefficients as CSV, one row a sample; of a pair of mixed derivatives, which are equal, one.

    Parameters
    ----------
    dataset : Dataset
        Of `kinematic_coefficients`.
    display : Display, optional
        Units of lengths and angles; SI and radians if left out.
    points : sequence of names, optional
        The points to show, usually the moving ones; all if left out.
    """
    chosen = dataset if points is None else dataset.sel(point=list(points))
    write_columns(path, _columns(chosen), dataset["status"], display)


def _columns(dataset: xarray.Dataset) -> Iterator[tuple[str, str, xarray.DataArray]]:
    """Header without unit, SI unit and values of every column: "velocity_coefficient_C_x_by_OA"."""
    yield "time", unit_of(dataset["time"]), dataset["time"]
    names = [str(name) for name in dataset["drive"].values]
    for number, name in enumerate(names):
        yield f"drive_{name}", drive_units(dataset)[number], dataset["drive_value"].isel(drive=number)
    for variable, values in dataset.data_vars.items():
        if "drive" not in values.dims:
            continue
        twice = "drive_2" in values.dims
        units = _units(values, len(names) ** (2 if twice else 1))
        dims = [str(dim) for dim in values.dims if dim not in ("sample", "drive", "drive_2")]
        for labels in product(*(values[dim].values.tolist() for dim in dims)):
            one = values.sel(dict(zip(dims, labels, strict=True)))
            header = "_".join([str(variable), *map(str, labels)])
            for pair in combinations_with_replacement(range(len(names)), 2 if twice else 1):
                by = "_".join(names[k] for k in pair)
                unit = units[pair[0] * len(names) + pair[1] if twice else pair[0]]
                place = dict(zip(("drive", "drive_2"), pair, strict=False))
                yield f"{header}_by_{by}", unit, one.isel(place)


def _units(values: xarray.DataArray, count: int) -> list[str]:
    """SI unit of each drive, or pair of drives: `units` names one for all, or all of them."""
    units = ["" if unit == "1" else unit for unit in str(values.attrs.get("units", "")).split(", ")]
    return units * count if len(units) == 1 else units


# Results of sweeps as tables.

ROWS = 100_000
"""Mechanisms of one table."""


def sweep_csv(data: xr.Dataset) -> str:
    """A reduced sweep as a table: a row for each mechanism, the varied values first, in SI.

    Raises InputError for a sweep that is not reduced, and for more than `ROWS` mechanisms.
    """
    front = data["samples_ok"].dims
    if "sample" in data.dims:
        raise InputError("", _("a table holds reduced results only"), _("reduce them, or write zarr"))
    count = data["samples_ok"].size
    if count > ROWS:
        what = _("a table holds at most {most} mechanisms, here are {count}").format(most=ROWS, count=count)
        raise InputError("", what, _("write zarr"))
    columns = [*_varied_columns(data, front, count), *_numbers(data, len(front), count)]
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(name for name, _column in columns)
    writer.writerows(zip(*(column.tolist() for _name, column in columns), strict=True))
    return stream.getvalue()


Column = tuple[str, npt.NDArray[np.generic]]


def _varied_columns(data: xr.Dataset, front: tuple[object, ...], count: int) -> Iterator[Column]:
    places = np.unravel_index(np.arange(count), data["samples_ok"].shape)
    for name, coordinate in data.coords.items():
        if len(coordinate.dims) == 1 and coordinate.dims[0] in front:
            along = front.index(coordinate.dims[0])
            yield _head(str(name), coordinate), coordinate.values[places[along]]


def _numbers(data: xr.Dataset, front: int, count: int) -> Iterator[Column]:
    for name, variable in data.data_vars.items():
        rooms = [data[dimension].values.tolist() for dimension in variable.dims[front:]]
        flat = variable.values.reshape(count, -1)
        for k, labels in enumerate(itertools.product(*rooms)):
            yield _head("_".join((str(name).replace(".", "_"), *map(str, labels))), variable), flat[:, k]


def _head(name: str, variable: xr.DataArray) -> str:
    unit = variable.attrs.get("units", "1")
    return name if unit == "1" else f"{name} [{unit}]"
