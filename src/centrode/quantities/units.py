"""How units are shown: lengths and angles as the description asks, powers as books write them."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping

from centrode.errors import InputError
from centrode.locale import _

LENGTHS: Mapping[str, float] = {
    "m": 1.0,
    "mm": 1e3,
    "cm": 1e2,
    "dm": 1e1,
    "km": 1e-3,
    "um": 1e6,
    "in": 1 / 0.0254,
    "ft": 1 / 0.3048,
}
"""How many of each length unit make one metre."""

ANGLES: Mapping[str, float] = {"rad": 1.0, "deg": 180 / math.pi, "turn": 1 / (2 * math.pi)}
"""How many of each angle unit make one radian."""


def display_unit(unit: str, length: str = "m", angle: str = "rad") -> tuple[float, str]:
    """Factor and label that turn numbers in an SI unit into the units they are shown in.

    Parameters
    ----------
    unit : str
        SI unit made of m, rad and s; any other unit is shown as it is.
    length, angle : str
        A key of LENGTHS and a key of ANGLES; InputError for another.

    Returns
    -------
    factor : float
        Shown number = factor * SI number; relative error below 4 eps.
    label : str
        `display_unit("m/s^2", length="mm")` is `(1000.0, "mm/s^2")`.
    """
    if length not in LENGTHS:
        raise _unknown_unit("display.length", _("{unit!r} is not a unit of length"), length, LENGTHS)
    if angle not in ANGLES:
        raise _unknown_unit("display.angle", _("{unit!r} is not a unit of angle"), angle, ANGLES)
    powers = powers_of(unit)
    if not powers.keys() <= {"m", "rad", "s"}:
        return 1.0, unit
    factor = LENGTHS[length] ** powers.get("m", 0) * ANGLES[angle] ** powers.get("rad", 0)
    renamed = {"m": length, "rad": angle}
    return factor, unit_text({renamed.get(base, base): power for base, power in powers.items()})


def typeset_unit(unit: str) -> str:
    """The unit as plots and reports write it: "mm/s²" for "mm/s^2"."""
    return re.sub(
        r"\^(\d+)", lambda found: found.group(1).translate(str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹")), unit
    )


def _unknown_unit(where: str, what: str, unit: str, table: Mapping[str, float]) -> InputError:
    return InputError(where, what.format(unit=unit), _("use one of {known}").format(known=", ".join(table)))


def powers_of(unit: str) -> dict[str, int]:
    """{"m": 1, "s": -2} of "m/s^2"; factors are parted by spaces, each division has one factor."""
    powers: dict[str, int] = {}
    for sign, base, power in re.findall(r"(/?)\s*([^\s/^]+)(?:\^(\d+))?", unit):
        if base != "1":
            powers[base] = powers.get(base, 0) + (-1 if sign else 1) * int(power or 1)
    return powers


def unit_text(powers: Mapping[str, int]) -> str:
    """ "m/s^2" of {"m": 1, "s": -2}."""

    def written(base: str, power: int) -> str:
        return base if power == 1 else f"{base}^{power}"

    above = [written(base, power) for base, power in powers.items() if power > 0]
    below = ["/" + written(base, -power) for base, power in powers.items() if power < 0]
    return (" ".join(above) or "1") + "".join(below)
