"""Sensitivity of a mechanism or a cam: its derivatives as tables, of outputs of samples as curves."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from centrode.sheets.sheet import Column, Deferred, Sheet, Table
from centrode.sheets.texts import Name, Sentence, Text, Unit

if TYPE_CHECKING:
    import xarray

    from centrode.tolerances.sensitivity import CamSensitivityResults, SensitivityResults

Array: TypeAlias = NDArray[np.float64]
GRADIENT = "gradient."


def sheet(results: SensitivityResults) -> Sheet:
    """Derivatives of each output by each number; of an output of samples the greatest, and a table of all of them."""
    data = results.data
    return Sheet(
        printed=(derivatives_table(data),),
        tables=Deferred(
            {
                "sensitivity": lambda: derivatives_table(data),
                **({"derivatives": lambda: _over_samples(data)} if any(_sampled_flags(data)) else {}),
            }
        ),
    )


def cam_sheet(results: CamSensitivityResults) -> Sheet:
    """The same of a cam."""
    data = results.data
    return Sheet(
        printed=(derivatives_table(data),),
        tables={"sensitivity": derivatives_table(data), "derivatives": _over_samples(data)},
    )


def _gradients(data: xarray.Dataset) -> list[tuple[str, Array]]:
    """Name and derivatives of each single number of the outputs, (..., path)."""
    found: list[tuple[str, Array]] = []
    for output in str(data.attrs["outputs"]).split("\n"):
        values = data[f"{GRADIENT}{output}"]
        dims = [dim for dim in values.dims if dim not in ("sample", "path")]
        if not dims:
            found.append((output, values.to_numpy()))
            continue
        leading = 1 if "sample" in values.dims else 0
        array = values.to_numpy()
        for place in np.ndindex(*array.shape[leading:-1]):
            labels = [data[dim].to_numpy()[k] for dim, k in zip(dims, place, strict=True)]
            name = ".".join([output, *map(str, labels)])
            found.append((name, array[(slice(None),) * leading + place]))
    return found


def _sampled_flags(data: xarray.Dataset) -> Iterator[bool]:
    return (slopes.ndim > 1 for _name, slopes in _gradients(data))


def derivatives_table(data: xarray.Dataset) -> Table:
    """A row for each number; a column for each output, in SI."""
    paths = data["path"].to_numpy().tolist()
    columns = [Column("path", tuple(map(Name, paths)), head=Sentence("dimension or mass"))]
    for name, slopes in _gradients(data):
        head: Text = Sentence("derivative of {output}, SI", output=Name(name))
        shown = slopes
        if slopes.ndim > 1:
            head = Sentence("greatest derivative of {output}, SI", output=Name(name))
            shown = _greatest(slopes)
        columns.append(Column(f"derivative of {name}", np.asarray(shown), head=head, unit_fixed=True))
    if "unit" in data:
        units = tuple(Unit(str(unit)) for unit in data["unit"].to_numpy())
        columns.append(Column("unit", units, head=Sentence("unit of the number")))
    return Table(tuple(columns))


def _greatest(slopes: Array) -> Array:
    """Of each column the number with the greatest size, NaN where there is none."""
    sizes = np.where(np.isnan(slopes), -1.0, np.abs(slopes))
    rows = np.argmax(sizes, axis=0)
    return np.asarray(slopes[rows, np.arange(slopes.shape[1])])


def _over_samples(data: xarray.Dataset) -> Table:
    """A row for each sample."""
    first = "cam_angle" if "cam_angle" in data.coords else "parameter"
    columns = [Column(first, data[first].to_numpy(), str(data[first].attrs.get("units", "1")))]
    paths = data["path"].to_numpy().tolist()
    for name, slopes in _gradients(data):
        if slopes.ndim > 1:
            columns += [
                Column(f"{name} by {path}", slopes[:, number], unit_fixed=True)
                for number, path in enumerate(paths)
            ]
    return Table(tuple(columns))
