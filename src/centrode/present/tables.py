"""Tables of a motion: CSV for spreadsheets and people, netCDF for programs."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Iterator, Sequence
from itertools import combinations_with_replacement, product
from pathlib import Path
from typing import TYPE_CHECKING

from centrode.errors import Status
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
