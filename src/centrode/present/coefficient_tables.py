"""Tables of kinematic coefficients by each drive."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations_with_replacement, product
from pathlib import Path
from typing import TYPE_CHECKING

from centrode.present.tables import write_columns
from centrode.views.columns import drive_units, unit_of

if TYPE_CHECKING:
    import xarray

    from centrode.model.mechanism import Display


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
