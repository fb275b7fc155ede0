"""Instants of a motion as texts: "OA = 90°", "t = 2 s, OA = 90°", "OA 1.57 rad (90 deg)"; names of bodies."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from centrode.errors import Status
from centrode.model.reading import FRAME
from centrode.sheets.texts import Joined, Name, Number, Sentence, Text

if TYPE_CHECKING:
    import xarray as xr

    from centrode.model.mechanism import Mechanism


def instant_title(mechanism: Mechanism, motion: xr.Dataset, sample: int) -> Text:
    """The values of the drives at a sample, behind the time where they do not follow from a constant speed."""
    values = motion["drive_value"].values[sample].tolist()
    return place_title(mechanism, values, float(motion["time"][sample]))


def place_title(mechanism: Mechanism, values: Sequence[float], time: float) -> Text:
    """The same of values of the drives [rad or m] and a time [s]."""
    parameter = mechanism.motion_parameter
    parts: list[Text] = [
        _equal(drive.label, Number(value, drive.unit, digits="", degrees_too=True))
        for drive, value in zip(parameter.drives, values, strict=True)
    ]
    if not parameter.is_uniform:
        parts.insert(0, _equal(parameter.instant.symbol, Number(time, "s", digits="")))
    return Joined(parts)


def place_number(value: float, unit: str) -> Number:
    """A place on a path [SI]: with the digits to ask for it again, and degrees beside radians."""
    return Number(value, unit, ".9g", degrees_too=True)


def instant_place(mechanism: Mechanism, motion: xr.Dataset, sample: int) -> Text:
    """Where a sample is: the values of the drives, and its status where it is not ok."""
    values = motion["drive_value"].values[sample]
    parts = [
        Joined((Name(drive.label), Number(float(value), drive.unit, ".9g", degrees_too=True)), " ")
        for drive, value in zip(mechanism.motion_parameter.drives, values, strict=True)
    ]
    status = Status(int(motion["status"][sample]))
    if status == Status.OK:
        return Joined(parts)
    return Sentence("{value} ({remark})", value=Joined(parts), remark=Sentence(status.word))


def body_text(mechanism: Mechanism, name: str) -> Text:
    """A link by its own name; the frame, and a slider that no link is named for, by a word."""
    if name == FRAME:
        return Sentence("frame")
    if name in mechanism.links:
        return Name(name)
    return Sentence("slider {point}", point=Name(name.removeprefix("slider ")))


def pair_text(mechanism: Mechanism, first: str, second: str) -> Text:
    """One body against another; the frame in the case that its word takes there."""
    if second == FRAME:
        return Sentence("{name} relative to the frame", name=body_text(mechanism, first))
    return Sentence(
        "{first} relative to {second}", first=body_text(mechanism, first), second=body_text(mechanism, second)
    )


def _equal(name: str, number: Number) -> Text:
    return Joined((Name(name), number), " = ")
