"""Transmission angles as rows and as a table in a file."""

from __future__ import annotations

import csv
import io

import numpy as np
import xarray as xr

from centrode.errors import Status
from centrode.locale import _


def transmission_rows(angles: xr.Dataset) -> list[tuple[str, ...]]:
    """Each group with the extremes of its angles over the samples that are reached, heads first."""
    heads = (
        _("group"),
        _("least transmission angle, deg"),
        _("greatest, deg"),
        _("greatest pressure angle, deg"),
    )
    reached = angles["status"].to_numpy() == Status.OK
    rows: list[tuple[str, ...]] = [heads]
    for name in angles["group"].to_numpy().tolist():
        own = np.degrees(angles["transmission_angle"].sel(group=name).to_numpy()[reached])
        pressure = np.degrees(angles["pressure_angle"].sel(group=name).to_numpy()[reached])
        numbers = (own.min(), own.max(), pressure.max()) if reached.any() else (np.nan,) * 3
        rows.append((name, *(f"{x:.4f}" for x in numbers)))
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
