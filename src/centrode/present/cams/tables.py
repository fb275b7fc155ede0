"""Tables of a cam: its path, and the three routes to it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from centrode.present.cams.profile_tables import write_profile_csv
from centrode.present.tables import write_columns
from centrode.views.columns import columns_of, unit_of

if TYPE_CHECKING:
    import xarray

    from centrode.model.cam_files import AnyCam

Column = tuple[str, str, "xarray.DataArray"]

PATH = (
    "path_radius",
    "path_radius_slope",
    "path_radius_second",
    "cam_pressure_angle",
    "pressure_sine",
    "pressure_sine_slope",
    "pressure_sine_second",
    "pressure_cosine",
    "law_curvature",
    "law_curvature_slope",
    "drawn_curvature",
    "roller_centre",
)
ROUTES = (
    "path_radius",
    "pressure_sine",
    "pressure_sine_slope",
    "radius_by_slope",
    "parting",
    "foretold_error",
    "series_error",
    "routes_difference",
)


def write_cam_csv(cam: AnyCam, dataset: xarray.Dataset, path: str | Path) -> None:
    """Write a cam's path (`ct.cam`) as CSV in the units of its display, one row a sample."""
    write_columns(path, _columns(dataset, PATH), dataset["status"], cam.display)


def write_cam_routes_csv(cam: AnyCam, dataset: xarray.Dataset, path: str | Path) -> None:
    """Write the three routes to a cam's path (`ct.cam_routes`) as CSV in the units of its display."""
    write_columns(path, _columns(dataset, ROUTES), dataset["status"], cam.display)


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


def write_cam_forces_csv(cam: AnyCam, dataset: xarray.Dataset, path: str | Path) -> None:
    """Write the forces on cam and follower (`ct.cam_forces`) as CSV, forces and stresses in SI, one row a sample."""
    names = [name for name, one in dataset.data_vars.items() if one.dims == ("sample",) and name != "status"]
    columns = [(str(name), unit_of(dataset[name]), dataset[name]) for name in ("cam_angle", *names)]
    write_columns(path, columns, dataset["status"], cam.display)


CAM_TABLES: Mapping[str, Callable[[AnyCam, xarray.Dataset, Path], None]] = {
    "cam-path": write_cam_csv,
    "cam-routes": write_cam_routes_csv,
    "cam-contact": write_cam_contact_csv,
    "cam-forces": write_cam_forces_csv,
    "cam-profile": lambda cam, dataset, path: write_profile_csv(dataset, path, cam.display),
    "cam-points": lambda cam, dataset, path: write_profile_csv(dataset, path, cam.display),
    "shoe-profile": lambda cam, dataset, path: write_profile_csv(dataset, path, cam.display),
}
"""How each dataset of a cam's results is written, by the name of its file."""


def write_cam_tables(cam: AnyCam, datasets: Mapping[str, xarray.Dataset], folder: Path) -> None:
    """Write a CSV of each of a cam's datasets (`CamPart.datasets`) into a folder."""
    for name, data in datasets.items():
        if name in CAM_TABLES:
            CAM_TABLES[name](cam, data, folder / f"{name}.csv")
