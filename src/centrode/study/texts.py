"""Places on a path in words: drive values in the units the description wants, limits with the group that locks."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from centrode.errors import Status
from centrode.quantities import display_unit, status_word

if TYPE_CHECKING:
    import xarray as xr

    from centrode.model.mechanism import Display, Mechanism


def value_text(at: float, unit: str, display: Display) -> str:
    """A value in SI as it is shown, with its unit; angles in radians also in degrees."""
    factor, shown = display_unit(unit, display.length, display.angle)
    text = f"{at * factor:.9g} {shown}"
    return f"{text} ({math.degrees(at):.6g} deg)" if shown == "rad" else text


def place_words(mechanism: Mechanism, motion: xr.Dataset, sample: int) -> str:
    """Where a sample is: values of the drives with their units, and its status where it is not ok."""
    values = motion["drive_value"].to_numpy()[sample].tolist()
    texts = []
    for drive, value in zip(mechanism.drives, values, strict=True):
        unit = mechanism.motion_parameter.drive(drive.id).unit
        texts.append(f"{drive.id} {value_text(value, unit, mechanism.display)}")
    status = int(motion["status"][sample])
    return ", ".join(texts) + ("" if status == Status.OK else f" ({status_word(status)})")
