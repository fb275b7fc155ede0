"""Tables of the reachable region of two drives and of limits, as CSV."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from centrode.errors import Status
from centrode.present.shown import shown_as
from centrode.present.tables import field

if TYPE_CHECKING:
    import xarray

    from centrode.model.mechanism import Display


def write_region_csv(region: xarray.Dataset, folder: Path, display: Display | None = None) -> None:
    """Write `region.csv`, one row a grid node, and `border.csv`, one row a limit on a grid line, into a folder.

    Units are those of `display`, SI and radians if left out.
    """
    units = [str(region[name].attrs["units"]) for name in ("first", "second")]
    shown = [shown_as(unit, display) for unit in units]
    drives = [
        f"drive_{name} [{unit}]" for name, (_f, unit) in zip(region["drive"].values, shown, strict=True)
    ]
    first, second = (
        region[name].values * factor for name, (factor, _unit) in zip(("first", "second"), shown, strict=True)
    )
    status, margin = region["status"].values, region["margin"].values
    _write(
        folder / "region.csv",
        [*drives, "status", "margin"],
        (
            (float(x), float(y), Status(int(status[i, j])).word, float(margin[i, j]))
            for i, x in enumerate(first)
            for j, y in enumerate(second)
        ),
    )
    factors = [factor for factor, _unit in shown]
    _write(
        folder / "border.csv",
        [*drives, "group", "bounds the region"],
        (
            (
                *(float(v) * f for v, f in zip(place, factors, strict=True)),
                str(group),
                "yes" if bounds else "no",
            )
            for place, group, bounds in zip(
                region["border_value"].values,
                region["border_group"].values,
                region["border_reached"].values,
                strict=True,
            )
        ),
    )


def _write(path: Path, header: Sequence[str], rows: Iterable[Sequence[float | str]]) -> None:
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header)
        writer.writerows(map(field, row) for row in rows)
