"""Tables of a cam."""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterator, Mapping
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING

from centrode.present.displayed_units import shown_as
from centrode.present.tables import field
from centrode.views.columns import unit_of

if TYPE_CHECKING:
    import xarray

    from centrode.model.cam_files import AnyCam
    from centrode.model.mechanism import Display

# Profiles of cams and shoes as CSV.


def write_profile_csv(dataset: xarray.Dataset, path: Path, display: Display | None = None) -> None:
    """Write a profile as CSV: UTF-8, one line end everywhere, numbers that read back bit for bit.

    Parameters
    ----------
    dataset : Dataset
        Of `cam_profile` or `shoe_profile`.
    display : Display, optional
        Units of lengths and angles; SI and radians if left out.
    """
    headers, columns = [], []
    for header, values in _profile_columns(dataset):
        factor, shown = shown_as(unit_of(values), display)
        headers.append(f"{header} [{shown}]" if shown else header)
        columns.append((values if factor == 1.0 else values * factor).values.tolist())
    with Path(path).open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(headers)
        writer.writerows(map(field, row) for row in zip(*columns, strict=True))


def _profile_columns(dataset: xarray.Dataset) -> Iterator[tuple[str, xarray.DataArray]]:
    """One column for each variable, or each axis of places, in the order of the dataset."""
    for name, values in dataset.data_vars.items():
        dims = [str(dim) for dim in values.dims if dim != "sample"]
        for labels in product(*(values[dim].values.tolist() for dim in dims)):
            yield "_".join([str(name), *map(str, labels)]), values.sel(dict(zip(dims, labels, strict=True)))


CAM_TABLES: Mapping[str, Callable[[AnyCam, xarray.Dataset, Path], None]] = {
    "cam-profile": lambda cam, dataset, path: write_profile_csv(dataset, path, cam.display),
    "cam-points": lambda cam, dataset, path: write_profile_csv(dataset, path, cam.display),
}
"""How each dataset of a cam's results is written, by the name of its file."""


def write_cam_tables(cam: AnyCam, datasets: Mapping[str, xarray.Dataset], folder: Path) -> None:
    """Write a CSV of each of a cam's datasets (`CamPart.datasets`) into a folder."""
    for name, data in datasets.items():
        if name in CAM_TABLES:
            CAM_TABLES[name](cam, data, folder / f"{name}.csv")
