"""The table of worst cases."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from centrode.present.shown import shown_as

if TYPE_CHECKING:
    from centrode.model.mechanism import Mechanism
    from centrode.study.forces.bearing_loads import BearingLoad


def write_bearing_loads_csv(mechanism: Mechanism, loads: Sequence[BearingLoad], path: Path) -> None:
    """Write worst cases as CSV, a row for each reaction.

    Parameters
    ----------
    loads : sequence of BearingLoad
        Of `bearing_loads`. Forces and moments are SI, places and directions in the units of the display.
    """
    parameter = mechanism.motion_parameter
    factor, unit = shown_as(parameter.instant.unit, mechanism.display)
    turn, angle = shown_as("rad", mechanism.display)
    where = ("drive_value" if parameter.is_uniform else "time") + f" [{unit}]"
    header = ["reaction", "unit", "greatest", f"greatest at {where}", f"direction [{angle}]"]
    header += ["least", f"least at {where}", "mean", "rms"]
    with Path(path).open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header)
        for one in loads:
            direction = "" if one.direction is None else repr(turn * one.direction)
            places = [repr(factor * at) for at in (one.at_greatest, one.at_least)]
            means = [repr(one.mean), repr(one.rms)]
            greatest, least = [repr(one.greatest), places[0], direction], [repr(one.least), places[1]]
            writer.writerow([one.key, one.unit, *greatest, *least, *means])
