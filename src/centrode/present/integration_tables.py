"""Table of an integrated motion: what `motion.csv` has of it, with drift and differences behind."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from centrode.errors import Status
from centrode.present.shown import shown_as
from centrode.present.tables import field
from centrode.views.columns import columns_of, numeric_columns

if TYPE_CHECKING:
    import xarray

    from centrode.model.mechanism import Display

BEHIND = ("drift", "angle_difference", "position_difference")


def write_integration_csv(
    dataset: xarray.Dataset, path: Path, display: Display | None = None, points: Sequence[str] | None = None
) -> None:
    """Write an integrated motion as CSV, one row a step; units are those of `display`, SI if left out.

    `points` are those to show, all if left out. A number that does not exist is an empty field.
    """
    chosen = dataset if points is None else dataset.sel(point=list(points))
    headers: list[str] = []
    columns: list[list[float] | list[str]] = []
    found = [*numeric_columns(chosen)]
    for variable in BEHIND:
        found += columns_of(chosen[variable], variable)
    for header, unit, values in found:
        factor, shown = shown_as(unit, display)
        headers.append(f"{header} [{shown}]" if shown else header)
        columns.append((values if factor == 1.0 else values * factor).values.tolist())
    headers.append("status")
    columns.append([Status(code).word for code in dataset["status"].values.tolist()])
    with Path(path).open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(headers)
        writer.writerows(map(field, row) for row in zip(*columns, strict=True))
