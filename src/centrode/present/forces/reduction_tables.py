"""Tables of masses and loads reduced to the drives."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING

from centrode.present.tables import write_columns
from centrode.views.columns import drive_units, unit_of

if TYPE_CHECKING:
    import xarray

    from centrode.model.mechanism import Display

VARIABLES = (
    "drive_rate",
    "reduced_inertia",
    "reduced_inertia_part",
    "reduced_inertia_slope",
    "reduced_inertia_slope_part",
    "reduced_moment",
    "reduced_moment_part",
    "inertia_matrix",
    "inertia_matrix_part",
    "christoffel",
    "generalised_force",
    "generalised_force_part",
)


def write_reduction_csv(dataset: xarray.Dataset, path: Path, display: Display | None = None) -> None:
    """Write a reduction as CSV, one row a sample; what does not exist is an empty field.

    Parameters
    ----------
    dataset : Dataset
        Of `reduce`.
    display : Display, optional
        Unit of the drive's angles or lengths; radians and metres if left out. Inertias and moments are SI.
    """
    write_columns(path, force_columns(dataset, VARIABLES), dataset["status"], display)


def force_columns(
    dataset: xarray.Dataset, variables: Sequence[str]
) -> Iterator[tuple[str, str, xarray.DataArray]]:
    """Header without unit, SI unit and values of every column: "reduced_inertia_part_AB"."""
    yield "time", unit_of(dataset["time"]), dataset["time"]
    for number, name in enumerate(dataset["drive"].values):
        yield f"drive_{name}", drive_units(dataset)[number], dataset["drive_value"].isel(drive=number)
    for variable in variables:
        if variable in dataset:
            yield from _columns_of(dataset[variable], variable)


def _columns_of(values: xarray.DataArray, variable: str) -> Iterator[tuple[str, str, xarray.DataArray]]:
    """One column for each combination of labels; of units there is one for all, or one for each of the drives."""
    dims = [str(dim) for dim in values.dims if dim != "sample"]
    units = unit_of(values).split(", ")
    for number, labels in enumerate(product(*(values[dim].values.tolist() for dim in dims))):
        header = "_".join([variable, *map(str, labels)])
        # drives stand behind links and loads, so their units come round and round
        yield header, units[number % len(units)], values.sel(dict(zip(dims, labels, strict=True)))
