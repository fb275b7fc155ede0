"""Numbers as a file holds them: in the unit in which their author writes, with as many digits as a drawing has."""

from __future__ import annotations

import math
import re
from typing import Any

from centrode.app.sketch import Sketch
from centrode.errors import InputError
from centrode.locale import _
from centrode.model.units import scaled, to_si, unit_factor
from centrode.quantities import ANGLES, LENGTHS

DIGITS = 5
"""Decimal digits behind the leading one of the mechanism's extent: a hundred-thousandth of it."""
ANGLE_DECIMALS = {"deg": 4, "°": 4, "turn": 7}
"""Decimals of an angle in a unit; radians have six."""

_UNIT = re.compile(r"(?:[^\W\d_]|[°%]).*\Z", re.DOTALL)
_NUMBER = re.compile(r"\s*[+-]?(?:[0-9]+[.,]?[0-9]*|[.,][0-9]+)(?:[eE][+-]?[0-9]+)?")


def written_quantity(sketch: Sketch, old: Any, value: float, kind: str, *, exactly: bool = False) -> Any:
    """A number or a text for a quantity in SI, spelled as the old value is, or as the description's other ones are."""
    if not math.isfinite(value):
        raise InputError("", _("the number is too great"), _("give another place"))
    unit = _unit_of(old) if isinstance(old, str) else None
    bare = isinstance(old, int | float) and not isinstance(old, bool)
    # an angle without a unit may be 0 where others need theirs
    if unit is None and (not bare or (kind == "angle" and _displays_other_angles(sketch))):
        unit = _usual_unit(sketch, kind)
    if unit is None:
        return value if exactly else rounded(value, _decimals(sketch, kind, "", 1.0))
    try:
        factor = unit_factor(unit, kind)
    except InputError:
        unit, factor = ("rad", 1.0) if kind == "angle" else ("m", 1.0)
    number = value / factor
    if not exactly:
        number = rounded(number, _decimals(sketch, kind, unit, factor))
    return f"{plain(number)} {unit}"


def plain(number: float) -> str:
    """A number without a superfluous point."""
    return str(int(number)) if number.is_integer() and abs(number) < 1e15 else repr(number)


def rounded(value: float, decimals: int) -> float:
    """A number with so many decimals; no negative zero."""
    return round(value, decimals) + 0.0


def _unit_of(text: str) -> str | None:
    number = _NUMBER.match(text)
    unit = text[number.end() :].strip() if number else ""
    if not unit:
        found = _UNIT.search(text)
        unit = found.group().strip() if found and not number else ""
    return unit or None


def _usual_unit(sketch: Sketch, kind: str) -> str | None:
    display = sketch.tables.get("display")
    display = display if isinstance(display, dict) else {}
    if kind == "angle":
        unit = display.get("angle", "rad")
        return unit if unit in ANGLES and unit != "rad" else "deg"
    length = display.get("length", "m")
    return length if kind == "length" and length in LENGTHS and length != "m" else None


def _displays_other_angles(sketch: Sketch) -> bool:
    display = sketch.tables.get("display")
    return isinstance(display, dict) and display.get("angle", "rad") != "rad"


def _decimals(sketch: Sketch, kind: str, unit: str, factor: float) -> int:
    if kind == "angle":
        return ANGLE_DECIMALS.get(unit, 6)
    size = sketch.size / factor
    return max(0, min(12, DIGITS - math.floor(math.log10(size)))) if size > 0 else DIGITS


def read_field(sketch: Sketch, text: object, kind: str) -> float:
    """The number [SI] that somebody writes into a field; without a unit it is in that of the display."""
    if isinstance(text, int | float) and not isinstance(text, bool):
        return to_si(text, kind)
    if not isinstance(text, str):
        raise InputError("", _("a number is needed"), "")
    typed = text.strip().replace(",", ".") if _NUMBER.match(text) else text.strip()
    bare = _NUMBER.fullmatch(typed)
    if not bare:
        return to_si(typed, kind)
    display = sketch.tables.get("display")
    display = display if isinstance(display, dict) else {}
    unit = {"length": display.get("length", "m"), "angle": display.get("angle", "rad")}.get(kind)
    if unit in LENGTHS or unit in ANGLES:
        factor = {**LENGTHS, **ANGLES}[str(unit)]
        return scaled(to_si(float(typed), kind), 1.0 / factor)
    return to_si(float(typed), kind)


def is_number(text: str) -> bool:
    """Whether a text is a number without a unit; a comma may stand before its decimals."""
    return _NUMBER.fullmatch(text.strip()) is not None


def typed_quantity(sketch: Sketch, old: Any, typed: object, value: float, kind: str) -> Any:
    """What somebody has typed into a field as a file holds it: with the unit that was typed, or that of the display.

    `value` is what it means [SI].
    """
    if isinstance(typed, str) and not is_number(typed):
        return typed.strip()
    display = sketch.tables.get("display")
    display = display if isinstance(display, dict) else {}
    unit = {"length": display.get("length", "m"), "angle": display.get("angle", "rad")}.get(kind)
    number = float(typed.replace(",", ".")) if isinstance(typed, str) else None
    known = _unit_of(old) if isinstance(old, str) else None
    if number is not None and unit not in (None, "m", "rad") and (old is None or known == unit):
        return f"{plain(number)} {unit}"
    if known is None and unit in (None, "m", "rad"):
        return value
    return written_quantity(sketch, old, value, kind, exactly=True)
