"""What is said of a reduction: what was reduced, at which speed, and the extremes of each part."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.masses import massless_links
from centrode.errors import Status
from centrode.locale import _
from centrode.model.labels import load_name
from centrode.model.mechanism import Mechanism
from centrode.quantities import status_word
from centrode.study.wording import value_text

if TYPE_CHECKING:
    import xarray

Rows: TypeAlias = list[tuple[str, str]]
Array: TypeAlias = npt.NDArray[np.float64]
JUMPS_SHOWN = 12
ROUNDING = 1e-12
"""Means and extremes below this share of the greatest value are shown as zero."""


def reduction_rows(mechanism: Mechanism, reduction: xarray.Dataset) -> Rows:
    """Masses, loads, speed of the drive, jumps and statuses, in the language and the units of the reader."""
    links = ", ".join(reduction["link"].to_numpy())
    loads = ", ".join(load_name(mechanism, str(label)) for label in reduction["load"].to_numpy())
    massless = ", ".join(massless_links(mechanism))
    status = reduction["status"].to_numpy()
    counts = [(Status(code), int(np.sum(status == code))) for code in np.unique(status)]
    said = ", ".join(f"{status_word(which)} {number}" for which, number in counts)
    return [
        (_("drives"), ", ".join(reduction["drive"].to_numpy())),
        (_("links with mass"), links or _("none")),
        (_("massless links"), massless or _("none")),
        (_("loads"), loads or _("none")),
        *(_of_one_drive(mechanism, reduction) if "drive_rate" in reduction else []),
        (_("samples"), f"{len(status)}: {said}"),
    ]


def _of_one_drive(mechanism: Mechanism, reduction: xarray.Dataset) -> Rows:
    coordinate = mechanism.motion_parameter.drives[0]
    rates = reduction["drive_rate"].to_numpy()
    low, high = (f"{rate:.6g} {coordinate.speed_unit}" for rate in (np.min(rates), np.max(rates)))
    speed = low if low == high else _("{first} to {last}").format(first=low, last=high)
    if reduction.attrs["rate_from"] == "machine":
        speed = _("{speed}, the mean speed of the machine").format(speed=speed)
    jumps = reduction["jumps"].to_numpy()
    texts = [value_text(float(at), coordinate.unit, mechanism.display) for at in jumps[:JUMPS_SHOWN]]
    if len(jumps) > JUMPS_SHOWN:
        texts.append(_("and {n} more").format(n=len(jumps) - JUMPS_SHOWN))
    return [
        (_("speed of the drive"), speed),
        (_("loads jump or bend at"), "; ".join(texts) or _("none")),
    ]


def reduction_parts(
    reduction: xarray.Dataset, mechanism: Mechanism | None = None
) -> tuple[list[str], list[list[str]]]:
    """Header and rows of a table: least, greatest and mean value of each part and of the whole, over the samples.

    The mean is over the drive's value where one drive runs one way, else over time, by the trapezoidal rule. Given
    their mechanism, loads are named in the language of the reader.
    """
    along = _along(reduction)
    header = ["", _("unit"), _("least"), _("greatest"), _("mean")]
    found = []
    for name, part, dimension, text in (
        ("reduced_inertia", "reduced_inertia_part", "link", _("reduced inertia")),
        ("reduced_moment", "reduced_moment_part", "load", _("reduced moment")),
    ):
        if name in reduction:
            unit = str(reduction[name].attrs["units"])
            found.append([text, unit, *_extremes(reduction[name].to_numpy(), along)])
            for label in map(str, reduction[dimension].to_numpy()):
                values = reduction[part].sel({dimension: label}).to_numpy()
                name = load_name(mechanism, label) if mechanism and dimension == "load" else label
                found.append([f"  {name}", unit, *_extremes(values, along)])
    for name, text in (
        ("inertia_matrix", _("inertia {drives}")),
        ("generalised_force", _("force by {drives}")),
    ):
        if name in reduction:
            found += _by_drives(reduction, name, text, along)
    return header, found


def _by_drives(reduction: xarray.Dataset, name: str, text: str, along: Array) -> list[list[str]]:
    """Rows of the elements of a matrix, each pair once, or of a vector."""
    drives = reduction["drive"].to_numpy().tolist()
    values = reduction[name].to_numpy().reshape(reduction.sizes["sample"], -1)
    twice = "drive_2" in reduction[name].dims
    pairs = [(i, j) for i in range(len(drives)) for j in range(len(drives) if twice else 1)]
    units = str(reduction[name].attrs["units"]).split(", ")
    rows = []
    for number, (i, j) in enumerate(pairs):
        if not twice or i <= j:
            names = f"{drives[i]}, {drives[j]}" if twice else drives[i]
            unit = units[number % len(units)]
            rows.append([text.format(drives=names), unit, *_extremes(values[:, number], along)])
    return rows


def _along(reduction: xarray.Dataset) -> Array:
    """What means are taken over: the value of the only drive where it runs one way, else time."""
    values, time = (np.asarray(reduction[name].to_numpy()) for name in ("drive_value", "time"))
    steps = np.diff(values[:, 0])
    one_way = "reduced_inertia" in reduction and bool((steps > 0.0).all() or (steps < 0.0).all())
    return values[:, 0] if one_way else time


def _extremes(values: Array, along: Array) -> list[str]:
    known = np.isfinite(values)
    if not known.any():
        return ["", "", ""]
    some, where = values[known], along[known]
    width = float(where[-1] - where[0])
    mean = float(np.trapezoid(some, where)) / width if width else float(np.mean(some))
    low, high = float(np.min(some)), float(np.max(some))
    noise = ROUNDING * max(abs(low), abs(high))
    return [f"{0.0 if abs(value) <= noise else value:.6g}" for value in (low, high, mean)]
