"""Tables of masses and loads reduced to the drives."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from centrode.present.tables import write_columns
from centrode.views.columns import force_columns

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
