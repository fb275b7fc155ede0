"""What is said of a reachable region: rows of a label and a text, in the chosen language."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from centrode.errors import Status
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.quantities import status_word
from centrode.study.wording import value_text

if TYPE_CHECKING:
    import xarray

Rows: TypeAlias = list[tuple[str, str]]


def region_rows(mechanism: Mechanism, region: xarray.Dataset) -> Rows:
    """Ranges of both drives, how much of the grid is reached, and how many limits bound it."""

    def text(value: float, unit: str) -> str:
        return value_text(value, unit, mechanism.display)

    rows = []
    for number, name in enumerate(("first", "second")):
        values, unit = region[name].to_numpy(), str(region[name].attrs["units"])
        ends = _("{first} to {last}").format(first=text(values[0], unit), last=text(values[-1], unit))
        rows.append((_("drive {name}").format(name=region["drive"].to_numpy()[number]), ends))
    status = region["status"].to_numpy()
    counts = [(Status(code), int(np.sum(status == code))) for code in np.unique(status)]
    said = ", ".join(f"{status_word(which)} {number}" for which, number in counts)
    bounds = int(region["border_reached"].to_numpy().sum())
    return [
        *rows,
        (_("grid nodes"), f"{status.size}: {said}"),
        (
            _("limits on grid lines"),
            _("{n}, {bounds} of them around the region").format(n=region.sizes["border"], bounds=bounds),
        ),
    ]
