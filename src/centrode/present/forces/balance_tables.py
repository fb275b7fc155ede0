"""Tables of a balance: effects of the inertia before and after, sample by sample and by harmonics."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from centrode.present.tables import write_columns
from centrode.views.columns import columns_of, drive_units, unit_of

if TYPE_CHECKING:
    import xarray

    from centrode.dynamics.balancing.balance import Balance

CURVES = ("shaking_force", "shaking_force_size", "shaking_moment", "inertia_on_drive")
HARMONICS = (
    "force_harmonic_cosine",
    "force_harmonic_sine",
    "force_harmonic_amplitude",
    "force_harmonic_phase",
    "force_harmonic_greatest",
    "moment_harmonic_cosine",
    "moment_harmonic_sine",
    "moment_harmonic_amplitude",
    "moment_harmonic_phase",
)


def write_balance_csv(balance: Balance, path: Path) -> None:
    """Write the effects before and after as CSV, one row a sample; angles as the description shows them."""
    write_columns(path, _columns(balance), balance.before["status"], balance.mechanism.display)


def _columns(balance: Balance) -> Iterator[tuple[str, str, xarray.DataArray]]:
    before = balance.before
    yield "time", unit_of(before["time"]), before["time"]
    for number, name in enumerate(before["drive"].values):
        yield f"drive_{name}", drive_units(before)[number], before["drive_value"].isel(drive=number)
    for word, data in (("before", before), ("after", balance.after)):
        for variable in CURVES:
            for header, unit, values in columns_of(data[variable], variable):
                yield f"{word}_{header}", unit, values


def write_harmonics_csv(balance: Balance, path: Path) -> None:
    """Write the harmonics before and after as CSV in SI, one row an order."""
    columns = [
        (f"{word}_{header} [{unit}]", values.values.tolist())
        for word, data in (("before", balance.before), ("after", balance.after))
        for variable in HARMONICS
        for header, unit, values in _by_order(data[variable], variable)
    ]
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["order", *(header for header, _values in columns)])
        orders = balance.before["order"].values.tolist()
        writer.writerows(zip(orders, *(values for _header, values in columns), strict=True))


def _by_order(values: xarray.DataArray, variable: str) -> Iterator[tuple[str, str, xarray.DataArray]]:
    """One column, or one for each axis."""
    if "axis" not in values.dims:
        yield variable, unit_of(values), values
        return
    for axis in values["axis"].values.tolist():
        yield f"{variable}_{axis}", unit_of(values), values.sel(axis=axis)
