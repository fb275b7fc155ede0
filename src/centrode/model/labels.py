"""Names of bodies and places in words: sliders without a link, frame and sliders to a reader, values of the drives."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

from centrode.errors import Status
from centrode.locale import _
from centrode.model.reading import body_word
from centrode.quantities import display_unit, status_word, terminal_unit, with_unit

if TYPE_CHECKING:
    import xarray as xr

    from centrode.model.links import Guide
    from centrode.model.mechanism import Display, Mechanism

SLIDER, GUIDE, GEAR, ROLLING = "slider ", "guide ", "gear ", "rolling "


def body_name(mechanism: Mechanism, name: str) -> str:
    """A link by its own name; the frame, and a slider that no link is named for, by a word."""
    if name in mechanism.links or not name.startswith(SLIDER):
        return body_word(name)
    return _("slider {point}").format(point=name.removeprefix(SLIDER))


def sliders_of(mechanism: Mechanism) -> dict[str, Guide]:
    """Name -> guide of the sliders that a description does not name as links."""
    sliders: dict[str, Guide] = {}
    for guide in mechanism.guides:
        if guide.link is None:
            name = f"slider {guide.id}"
            # a link may have the name already
            while name in mechanism.links or name in sliders:
                name += "'"
            sliders[name] = guide
    return sliders


# Places on a path in words: drive values in the units the description wants, limits with the group that
# locks.


def value_with_unit(
    at: float, unit: str, display: Display, unit_name: Callable[[str], str] = terminal_unit
) -> str:
    """A value in SI as it is shown, with its unit, which `unit_name` spells; angles in radians also in degrees."""
    factor, shown = display_unit(unit, display.length, display.angle)
    text = with_unit(f"{at * factor:.9g}", unit_name(shown))
    return f"{text} ({with_unit(f'{math.degrees(at):.6g}', unit_name('deg'))})" if shown == "rad" else text


def place_words(
    mechanism: Mechanism, motion: xr.Dataset, sample: int, unit_name: Callable[[str], str] = terminal_unit
) -> str:
    """Where a sample is: values of the drives with their units, and its status where it is not ok."""
    values = motion["drive_value"].values[sample].tolist()
    texts = []
    for drive, value in zip(mechanism.drives, values, strict=True):
        coordinate = mechanism.motion_parameter.drive(drive.id)
        shown = value_with_unit(value, coordinate.unit, mechanism.display, unit_name)
        texts.append(f"{coordinate.label} {shown}")
    status = int(motion["status"][sample])
    return ", ".join(texts) + ("" if status == Status.OK else f" ({status_word(status)})")
