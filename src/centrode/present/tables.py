"""Tables of cams and sweeps as CSV, datasets as netCDF."""

from __future__ import annotations

import csv
import io
import itertools
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.errors import InputError, Status
from centrode.locale import _
from centrode.present.displayed_units import shown_as

if TYPE_CHECKING:
    import xarray

    from centrode.model.mechanism import Display


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
