"""Numbers as a file holds them: in the unit in which their author writes, with as many digits as a drawing has."""

from __future__ import annotations

import math
import re
from typing import Any

from centrode.app.sketch import SketchParts, display_units
from centrode.app.text_changes import spelled_value
from centrode.errors import InputError
from centrode.locale import _, decimal_mark
from centrode.model.units import number_and_unit, scale_value, to_si, unit_factor

FIELD_DIGITS = 6
"""Digits of a number in a field."""
DIGITS = 5
"""Decimal digits behind the leading one of the mechanism's extent: a hundred-thousandth of it."""
ANGLE_DECIMALS = {"deg": 4, "°": 4, "turn": 7}
"""Decimals of an angle in a unit; radians have six."""

_UNIT = re.compile(r"(?:[^\W\d_]|[°%]).*\Z", re.DOTALL)
_NUMBER = re.compile(r"\s*[+-]?(?:[0-9]+[.,]?[0-9]*|[.,][0-9]+)(?:[eE][+-]?[0-9]+)?")


def written_quantity(sketch: SketchParts, old: Any, value: float, kind: str, *, exactly: bool = False) -> Any:
    """A number or a text for a quantity in SI, spelled as the old value is, or as the description's other ones are."""
    if not math.isfinite(value):
        raise InputError("", _("the number is too great"), _("give another place"))
    unit = _unit_of(old) if isinstance(old, str) else None
    bare = isinstance(old, int | float) and not isinstance(old, bool)
    # an angle without a unit may be 0 where others need theirs
    if unit is None and (not bare or (kind == "angle" and _displays_other_angles(sketch))):
        unit = _usual_unit(sketch, kind)
    if unit is None:
        return value if exactly else with_decimals(value, _decimals(sketch, kind, "", 1.0))
    try:
        factor = unit_factor(unit, kind)
    except InputError:
        unit, factor = ("rad", 1.0) if kind == "angle" else ("m", 1.0)
    number = value / factor
    if not exactly:
        number = with_decimals(number, _decimals(sketch, kind, unit, factor))
    return f"{spelled_value(number)} {unit}"


def field_text(value: float) -> str:
    """A number as a field shows it: to be typed over, so without powers of print or spaces."""
    return f"{value:.{FIELD_DIGITS}g}".replace(".", decimal_mark())


def with_decimals(value: float, decimals: int) -> float:
    """A number with so many decimals; no negative zero."""
    return round(value, decimals) + 0.0


def _unit_of(text: str) -> str | None:
    found = number_and_unit(text)
    if found is not None:
        return found[1].strip() or None
    named = _UNIT.search(text)  # of a formula such as "pi/12 rad"
    return named.group().strip() if named else None


def _usual_unit(sketch: SketchParts, kind: str) -> str | None:
    units = display_units(sketch.tables)
    if kind == "angle":
        unit = str(units["angle"]["unit"])
        return unit if unit != "rad" else "deg"
    length = str(units["length"]["unit"])
    return length if kind == "length" and length != "m" else None


def _displays_other_angles(sketch: SketchParts) -> bool:
    return bool(display_units(sketch.tables)["angle"]["unit"] != "rad")


def _decimals(sketch: SketchParts, kind: str, unit: str, factor: float) -> int:
    if kind == "angle":
        return ANGLE_DECIMALS.get(unit, 6)
    size = sketch.size / factor
    return max(0, min(12, DIGITS - math.floor(math.log10(size)))) if size > 0 else DIGITS


def read_field(sketch: SketchParts, text: object, kind: str) -> float:
    """The number [SI] that somebody writes into a field; without a unit it is in that of the display."""
    if isinstance(text, int | float) and not isinstance(text, bool):
        return to_si(text, kind)
    if not isinstance(text, str):
        raise InputError("", _("a number is needed"), "")
    typed = with_decimal_point(text.strip())
    if not is_number(typed):
        return to_si(typed, kind)
    factor = display_units(sketch.tables).get(kind, {}).get("factor", 1.0)
    return scale_value(to_si(float(typed), kind), 1.0 / factor)


def with_decimal_point(text: str) -> str:
    """A text whose number has a point where somebody has typed a comma."""
    found = _NUMBER.match(text)
    return found.group().replace(",", ".") + text[found.end() :] if found else text


def is_number(text: str) -> bool:
    """Whether a text is a number without a unit; a comma may stand before its decimals."""
    return _NUMBER.fullmatch(text.strip()) is not None


def typed_quantity(sketch: SketchParts, old: Any, typed: object, value: float, kind: str) -> Any:
    """What somebody has typed into a field as a file holds it: with the unit that was typed, or that of the display.

    `value` is what it means [SI].
    """
    if isinstance(typed, str) and not is_number(typed):
        return typed.strip()
    unit = display_units(sketch.tables).get(kind, {}).get("unit")
    number = float(typed.replace(",", ".")) if isinstance(typed, str) else None
    known = _unit_of(old) if isinstance(old, str) else None
    if number is not None and unit not in (None, "m", "rad") and (old is None or known == unit):
        return f"{spelled_value(number)} {unit}"
    if known is None and unit in (None, "m", "rad"):
        return value
    return written_quantity(sketch, old, value, kind, exactly=True)
