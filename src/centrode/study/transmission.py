"""Transmission angles as rows and as a table in a file."""

from __future__ import annotations

import csv
import io

import numpy as np
import xarray as xr

from centrode.errors import Status
from centrode.locale import _


def transmission_rows(angles: xr.Dataset) -> list[tuple[str, ...]]:
    """Each group with the exact extremes of its acute angles over what is reached, heads first."""
    heads = (
        _("group"),
        _("least transmission angle, deg"),
        _("greatest, deg"),
        _("greatest pressure angle, deg"),
    )
    rows: list[tuple[str, ...]] = [heads]
    for name in angles["group"].to_numpy().tolist():
        least, greatest = (
            float(np.degrees(angles[variable].sel(group=name)))
            for variable in ("least_transmission_angle", "greatest_transmission_angle")
        )
        # what is zero but for rounding is said without a sign
        rows.append((name, *(f"{x + 0.0:.4f}" for x in (least, greatest, 90.0 - least))))
    return rows


def transmission_csv(angles: xr.Dataset) -> str:
    """The angles in SI, one row a sample; what is absent is empty."""
    names = angles["group"].to_numpy().tolist()
    drives = angles["drive"].to_numpy().tolist()
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    heads = ["time [s]", *(f"drive_{name}" for name in drives)]
    for variable in ("transmission_angle", "pressure_angle"):
        heads += [f"{variable}_{name} [rad]" for name in names]
    writer.writerow([*heads, "status"])
    for k in range(angles.sizes["sample"]):
        numbers = [
            float(angles["time"][k]),
            *angles["drive_value"].to_numpy()[k].tolist(),
            *angles["transmission_angle"].to_numpy()[k].tolist(),
            *angles["pressure_angle"].to_numpy()[k].tolist(),
        ]
        cells = [repr(x) if np.isfinite(x) else "" for x in numbers]
        writer.writerow([*cells, Status(int(angles["status"][k])).word])
    return stream.getvalue()
