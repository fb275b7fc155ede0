"""Tables of reactions and of joints."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from centrode.present.tables import write_columns
from centrode.views.columns import force_columns

if TYPE_CHECKING:
    import xarray

    from centrode.model.mechanism import Display

VARIABLES = (
    "drive_rate",
    "balancing",
    "joint_force",
    "joint_moment",
    "centre_force",
    "guide_force",
    "guide_normal",
    "guide_moment",
    "gear_moment",
    "tooth_force",
    "rolling_force",
    "rolling_normal",
    "rolling_tangential",
    "friction_moment",
    "friction_force",
    "friction_power",
    "efficiency",
    "inertia_force",
    "inertia_moment",
    "frame_force",
    "frame_moment",
    "shaking_force",
    "shaking_moment",
    "reaction_loss",
)


def write_reactions_csv(dataset: xarray.Dataset, path: Path, display: Display | None = None) -> None:
    """Write reactions as CSV, one row a sample; what does not exist or is not determined is an empty field.

    Parameters
    ----------
    dataset : Dataset
        Of `reactions`.
    display : Display, optional
        Unit of the drive's angles or lengths; radians and metres if left out. Forces and moments are SI.
    """
    write_columns(path, force_columns(dataset, VARIABLES), dataset["reaction_status"], display)


def write_joint_table_csv(table: tuple[Sequence[str], Sequence[Sequence[str]]], path: Path) -> None:
    """Write the table of joints, as `joint_table` gives it, as CSV."""
    header, rows = table
    with Path(path).open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header)
        writer.writerows(rows)
