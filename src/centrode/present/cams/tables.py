"""Tables of a cam."""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterator, Mapping
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING

from centrode.model.cam_files import cam_text
from centrode.present.cams.choice import measure_shown, parameter_unit
from centrode.present.displayed_units import shown_as
from centrode.present.tables import field, write_columns
from centrode.views.columns import columns_of, unit_of

if TYPE_CHECKING:
    import xarray

    from centrode.cams.parameter_choice.search import CamChoice, CamDesign
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


Column = tuple[str, str, "xarray.DataArray"]


def _columns(dataset: xarray.Dataset, variables: tuple[str, ...]) -> Iterator[Column]:
    angle = dataset["carrier_angle"]
    yield "carrier_angle", unit_of(angle), angle
    for variable in variables:
        yield from columns_of(dataset[variable], variable)


CONTACT = (
    "contact_stress",
    "contact_stress_by_source",
    "contact_shear",
    "contact_depth",
    "contact_half_width",
    "cam_curvature_radius",
)


def write_cam_contact_csv(cam: AnyCam, dataset: xarray.Dataset, path: str | Path) -> None:
    """Write the contact of roller and cam (`ct.cam_contact`) as CSV, stresses in Pa, one row a sample."""
    write_columns(path, _columns(dataset, CONTACT), dataset["status"], cam.display)


CAM_TABLES: Mapping[str, Callable[[AnyCam, xarray.Dataset, Path], None]] = {
    "cam-contact": write_cam_contact_csv,
    "cam-profile": lambda cam, dataset, path: write_profile_csv(dataset, path, cam.display),
    "shoe-profile": lambda cam, dataset, path: write_profile_csv(dataset, path, cam.display),
}
"""How each dataset of a cam's results is written, by the name of its file."""


def write_cam_tables(cam: AnyCam, datasets: Mapping[str, xarray.Dataset], folder: Path) -> None:
    """Write a CSV of each of a cam's datasets (`CamPart.datasets`) into a folder."""
    for name, data in datasets.items():
        if name in CAM_TABLES:
            CAM_TABLES[name](cam, data, folder / f"{name}.csv")


# Tables of a choice: the start, the chosen design and the front; the description with the chosen parameters.


def write_choice(found: CamChoice, folder: Path) -> None:
    """Write "cam-choice.csv" and, where the choice keeps its bounds, "chosen.toml" into a folder.

    Parameters
    ----------
    found : CamChoice
        Of `choose_cam`. The table has a row for the start, the chosen design and each design of the front, in the
        units of the display and megapascals; the description is in SI and can be computed like any other.
    """
    cam = found.cam
    names = list(found.choice.chosen.parameters)
    shown = [shown_as(parameter_unit(cam, name), cam.display) for name in names]
    measures = found.measures
    units = [measure_shown(name, cam.display) for name in measures]
    headers = [
        "design",
        *(f"{name} [{unit}]" for name, (_factor, unit) in zip(names, shown, strict=True)),
        *(f"{name} [{unit}]" for name, (_factor, unit) in zip(measures, units, strict=True)),
        "admissible",
    ]
    with (folder / "cam-choice.csv").open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(headers)
        for word, design in _designs(found):
            values = [
                design.parameters[name] * factor for name, (factor, _) in zip(names, shown, strict=True)
            ]
            values += [
                design.measures[name].value * factor
                for name, (factor, _) in zip(measures, units, strict=True)
            ]
            writer.writerow([word, *values, "no" if design.misses else "yes"])
    if found.choice.admissible:
        (folder / "chosen.toml").write_text(cam_text(cam), encoding="utf-8")


def _designs(found: CamChoice) -> Iterator[tuple[str, CamDesign]]:
    yield "start", found.choice.start
    yield "chosen", found.choice.chosen
    for design in found.front.designs if found.front is not None else ():
        yield "front", design
