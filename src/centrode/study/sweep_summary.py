"""What a sweep says of itself: rows of a label and a text, in the chosen language."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, TypeAlias

from centrode.locale import _

if TYPE_CHECKING:
    import xarray as xr

Rows: TypeAlias = list[tuple[str, str]]

SHOWN = 20
"""Extremes of this many numbers are told."""


def sweep_rows(data: xr.Dataset) -> Rows:
    """How many mechanisms, how far they move, how well they close, extremes of what is reduced."""
    told = data.attrs
    extents = list(data["samples_ok"].sizes.values())
    count = math.prod(extents)
    grid = f" ({' x '.join(map(str, extents))})" if len(extents) > 1 else ""
    whole, none = told["mechanisms_whole"], told["mechanisms_none"]
    some = told["mechanisms"] - whole - none
    worst = told["worst_residual"]
    rows = [
        (_("mechanisms"), f"{count}{grid}"),
        (_("samples"), str(told["samples"])),
        (
            _("ok"),
            _("at every sample {whole}, at some {some}, at none {none}").format(
                whole=whole, some=some, none=none
            ),
        ),
        (_("worst residual"), _worst(worst)),
        (_("executor"), _executor(told["executor"])),
    ]
    extremes = list(_extremes(data))
    rows += extremes[:SHOWN]
    if len(extremes) > SHOWN:
        rows.append(("", _("and {count} more").format(count=len(extremes) - SHOWN)))
    return rows


def _worst(residual: float) -> str:
    # nothing is ok, so nothing has a residual
    if math.isnan(residual):
        return _("none")
    return _("{value:.1e} of the greatest length").format(value=residual)


def _executor(told: str) -> str:
    """The executor as it is called, with the reason why it is this one in the language of messages."""
    name, _bracket, reason = told.partition(" (")
    return f"{name} ({_(reason[:-1])})" if reason else name


def _extremes(data: xr.Dataset) -> Iterator[tuple[str, str]]:
    front = len(data["samples_ok"].dims)
    for name, variable in data.data_vars.items():
        if "least" not in variable.attrs:
            continue
        rooms = [data[dimension].values.tolist() for dimension in variable.dims[front:]]
        least, greatest = variable.attrs["least"], variable.attrs["greatest"]
        ends = [(least, greatest)] if not rooms else zip(least, greatest, strict=True)
        unit = variable.attrs.get("units", "1")
        for labels, (low, high) in zip(itertools.product(*rooms), ends, strict=True):
            text = _("{low:.9g} to {high:.9g}").format(low=low, high=high)
            label = ".".join((str(name), *map(str, labels)))
            yield label, _("no number") if math.isnan(low) else text if unit == "1" else f"{text} {unit}"
