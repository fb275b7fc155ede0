"""Places and instants of a motion as texts: "OA = 90°", "t = 2 s, OA = 90°"."""

from __future__ import annotations

from typing import TYPE_CHECKING

from centrode.sheets.texts import Joined, Name, Number, Text

if TYPE_CHECKING:
    import xarray as xr

    from centrode.model.mechanism import Mechanism


def instant_title(mechanism: Mechanism, motion: xr.Dataset, sample: int) -> Text:
    """The values of the drives at a sample, behind the time where they do not follow from a constant speed."""
    parameter, values = mechanism.motion_parameter, motion["drive_value"].to_numpy()[sample]
    parts: list[Text] = [
        _equal(drive.name, Number(float(value), drive.unit, digits="", degrees_too=True))
        for drive, value in zip(parameter.drives, values, strict=True)
    ]
    if not parameter.is_uniform:
        parts.insert(
            0, _equal(parameter.instant.symbol, Number(float(motion["time"][sample]), "s", digits=""))
        )
    return Joined(parts)


def place_number(value: float, unit: str) -> Number:
    """A place on a path [SI]: with the digits to ask for it again, and degrees beside radians."""
    return Number(value, unit, ".9g", degrees_too=True)


def _equal(name: str, number: Number) -> Text:
    return Joined((Name(name), number), " = ")
