"""Numbers and texts with a unit, read into SI: "28.6 deg", "0.5 mm", "65 rpm", "pi/2 rad"."""

from __future__ import annotations

import functools
import math
import re
from dataclasses import dataclass
from typing import Any

from centrode.errors import InputError
from centrode.locale import _, mark
from centrode.model import reading
from centrode.model.reading import value_text
from centrode.numerics.operations import SCALARS
from centrode.numerics.text_formula import compile_formula
from centrode.optional_packages import admitted_module
from centrode.quantities import UNIT_SYMBOLS

# Costs three times the import of NumPy: asked for by the first unit that is not in COMMON.
_pint = functools.partial(admitted_module, "pint", "pint")


@dataclass(frozen=True)
class UnitKind:
    """A kind of quantity: its name in a sentence, SI unit, an example, other SI units that also fit."""

    name: str
    unit: str
    example: str
    also: tuple[str, ...] = ()


KINDS = {
    "length": UnitKind(mark("a length"), "m", "5 mm"),
    "angle": UnitKind(mark("an angle"), "rad", "28.6 deg"),
    "arc": UnitKind(mark("an arc"), "rad", "30 deg"),
    "time": UnitKind(mark("a time"), "s", "20 ms"),
    "speed": UnitKind(mark("a speed"), "m/s", "20 mm/s"),
    "angular speed": UnitKind(mark("an angular speed"), "rad/s", "65 rpm"),
    "acceleration": UnitKind(mark("an acceleration"), "m/s^2", "9.81 m/s^2"),
    "mass": UnitKind(mark("a mass"), "kg", "90 g"),
    "inertia": UnitKind(mark("a moment of inertia"), "kg*m^2", "450 kg*mm^2"),
    "density": UnitKind(mark("a density"), "kg/m^3", "7.8 g/cm^3"),
    "force": UnitKind(mark("a force"), "N", "9 kN"),
    "torque": UnitKind(mark("a torque"), "N*m", "3 N*mm"),
    "stiffness": UnitKind(mark("a stiffness"), "N/m", "2 N/mm"),
    "damping": UnitKind(mark("a damping"), "N*s/m", "2 N*s/mm"),
    "angular stiffness": UnitKind(mark("an angular stiffness"), "N*m/rad", "2 N*m/deg", ("N*m",)),
    "angular damping": UnitKind(mark("an angular damping"), "N*m*s/rad", "2 N*mm*s/rad", ("N*m*s",)),
    "quadratic damping": UnitKind(mark("a friction by the square of the speed"), "N*s^2/m^2", "2 N*s^2/m^2"),
    "angular quadratic damping": UnitKind(
        mark("a friction by the square of the angular speed"),
        "N*m*s^2/rad^2",
        "2 N*mm*s^2/rad^2",
        ("N*m*s^2",),
    ),
    "curvature": UnitKind(mark("a curvature"), "1/m", "0.01 1/mm"),
    "curvature slope": UnitKind(mark("a curvature by angle"), "1/m/rad", "0.01 1/mm/rad", ("1/m",)),
    "per angle": UnitKind(mark("a number by angle"), "1/rad", "0.013 1/deg"),
    "pressure": UnitKind(mark("a stress"), "Pa", "210 GPa"),
    "ratio": UnitKind(mark("a number"), "", "-40/20"),
}

COMMON: dict[str, dict[str, float]] = {
    "m": {"m": 1.0, "mm": 1e-3, "cm": 1e-2, "km": 1e3},
    "rad": {"rad": 1.0, "deg": math.pi / 180, "°": math.pi / 180, "turn": 2 * math.pi},
    "s": {"s": 1.0, "ms": 1e-3, "min": 60.0},
    "m/s": {"m/s": 1.0, "mm/s": 1e-3},
    "rad/s": {"rad/s": 1.0, "deg/s": math.pi / 180, "rpm": math.pi / 30},
    "1/s": {"Hz": 1.0},
    "kg": {"kg": 1.0, "g": 1e-3},
    "N": {"N": 1.0, "kN": 1e3},
    "N*m": {"N*m": 1.0},
    "1/m": {"1/m": 1.0, "1/mm": 1e3},
    "1/m/rad": {"1/m/rad": 1.0, "1/mm/rad": 1e3},
    "1/rad": {"1/rad": 1.0, "1/deg": 180 / math.pi},
    "Pa": {"Pa": 1.0, "MPa": 1e6, "GPa": 1e9, "N/mm^2": 1e6},
}
"""SI unit -> unit -> factor, of the units nearly every file uses; a test compares them with pint's."""

SPELLED_OTHERWISE = {
    symbol: unit
    for unit, symbols in UNIT_SYMBOLS.items()
    for symbol in symbols
    if not symbol.isascii() and symbol.isalpha()
} | {
    "об/мин": "rpm",
    "об/хв": "rpm",
    "об": "turn",
    "град": "deg",
    "мин": "min",
    "хв": "min",
    "мс": "ms",
    "г": "g",
    "т": "t",
    "кН": "kN",
    "кПа": "kPa",
    "Гц": "Hz",
}
"""Cyrillic symbol of a unit -> the name that descriptions use: for the repair of a text such as "140 мм"."""

ANGULAR = ("angle", "arc")
"""Kinds of quantity that are angles."""

_NUMBER = re.compile(r"([+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?)\s*(.*)", re.DOTALL)
_FACTOR = r"[^\W\d]+(?:(?:\^|\*\*)-?\d)?"
_UNIT = re.compile(rf"°|%|(?:1\s*/\s*)?{_FACTOR}(?:\s*[*/·]\s*{_FACTOR}|\s+{_FACTOR})*")
_LETTERS = re.compile(r"[^\W\d_²³]+")
_DECIMAL_COMMA = re.compile(r"([+-]?[0-9]+),([0-9][^,]*)")


def to_si(value: object, kind: str) -> float:
    """Value in SI of a number (already SI) or of a text with a unit.

    Raises
    ------
    InputError
        Not a number, not finite, or a unit of another kind; without a place, which the caller knows.
    """
    if isinstance(value, str):
        return _text_to_si(value, kind)
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise _wrong(value, kind)
    try:
        return _finite(float(value), value)
    except OverflowError:
        raise _wrong(value, kind) from None


def read_quantity(value: object, kind: str, where: str, *, refuses_bare: bool = False) -> float:
    """Value in SI of a number (already SI) or of a text with a unit; raises InputError that names `where`.

    With `refuses_bare` a text of an angle needs its unit: where degrees are displayed, degrees may be meant.
    """
    try:
        if refuses_bare and kind in ANGULAR and isinstance(value, str) and is_bare(value, kind):
            raise bare_angle(value)
        return to_si(value, kind)
    except InputError as error:
        raise InputError(where, error.what, error.repair) from None


def is_bare(value: object, kind: str) -> bool:
    """Whether a number other than 0, or a text of one, has no unit; raises InputError for a text that is no number."""
    if isinstance(value, str):
        if len(value) > reading.QUANTITY_LENGTH:
            return False  # its length is the fault that is reported
        number, unit = _split_unit(value, kind)
        return not unit and number != 0
    return isinstance(value, int | float) and not isinstance(value, bool) and value != 0


def bare_angle(value: object) -> InputError:
    """What is wrong with an angle without a unit where degrees are displayed; without a place."""
    number = str(value).strip()
    what = _("{value} is an angle without a unit, and this description displays degrees")
    if len(number) > reading.UNIT_LENGTH:
        return InputError("", what.format(value=value_text(value)), _("write it with its unit, deg or rad"))
    repair = _('write "{number} deg" or "{number} rad"').format(number=number)
    return InputError("", what.format(value=value_text(value)), repair)


def unit_factor(unit: str, kind: str) -> float:
    """SI value of one `unit` of a kind; raises InputError for an unknown unit or one of another kind."""
    unit = unit.strip()
    if len(unit) > reading.UNIT_LENGTH or not _UNIT.fullmatch(unit):
        raise InputError("", _("{unit} is not a unit").format(unit=value_text(unit)), _example(kind))
    accepted = (KINDS[kind].unit, *KINDS[kind].also)
    for si, units in COMMON.items():
        if unit in units:
            if si in accepted:
                return units[unit]
            raise _other_kind(unit, kind, frequency=si == "1/s")
    return _pint_factor(unit, kind, accepted)


def _text_to_si(text: str, kind: str) -> float:
    if len(text) > reading.QUANTITY_LENGTH:
        what = _(
            "a text of {count} characters is too long for a number with its unit, at most {most} are allowed"
        )
        raise InputError("", what.format(count=len(text), most=reading.QUANTITY_LENGTH), _("shorten it"))
    number, unit = _split_unit(text, kind)
    if not unit:
        return _finite(number, text)
    try:
        factor = unit_factor(unit, kind)
    except InputError as error:
        repair = _international_repair(text.strip(), unit, kind) or error.repair
        raise InputError("", _wrong(text, kind).what, repair) from None
    return _finite(scale_value(number, factor), text)


def _international_repair(text: str, unit: str, kind: str) -> str:
    """Repair of a text whose unit is spelled in Cyrillic letters, as "140 мм"; empty for other texts."""
    named = international(unit)
    if named == unit or not named.isascii():
        return ""
    try:
        unit_factor(named, kind)
    except InputError:
        return ""
    number = value_text(f"{text.removesuffix(unit).strip()} {named}")
    return _("units have their international names: write {number}").format(number=number)


def international(text: str) -> str:
    """A text with the names that descriptions use in place of Cyrillic symbols of units."""
    for turns in ("об/мин", "об/хв"):
        text = text.replace(turns, SPELLED_OTHERWISE[turns])
    text = _LETTERS.sub(lambda found: SPELLED_OTHERWISE.get(found.group(), found.group()), text)
    return text.replace("·", "*").replace("²", "^2").replace("³", "^3")


def number_and_unit(text: str) -> tuple[str, str] | None:
    """A number and its unit as they are written, the unit empty where there is none; None for any other text."""
    found = _NUMBER.fullmatch(text.strip())
    if found is None or not (found.group(2) == "" or _UNIT.fullmatch(found.group(2))):
        return None
    return found.group(1), found.group(2)


def _split_unit(text: str, kind: str) -> tuple[float, str]:
    """Number and unit of a text: the shortest formula from the left with a unit, or nothing, behind."""
    simple = number_and_unit(text)
    if simple:
        return float(simple[0]), simple[1]
    words = text.split()
    for count in range(1, len(words) + 1):
        unit = " ".join(words[count:])
        if unit and not _UNIT.fullmatch(unit):
            continue
        try:
            return float(compile_formula(" ".join(words[:count]), (), "")(SCALARS)), unit
        except (InputError, ArithmeticError, ValueError):
            continue
    raise _wrong(text, kind)


def scale_value(value: float, factor: float) -> float:
    """Value times factor; a whole fraction (mm: 1/1000) divides, so that "850 mm" is 0.85 to the last bit."""
    inverse = round(1 / factor) if 0 < factor < 1 else 0
    return value / inverse if inverse and abs(inverse * factor - 1) < 1e-15 else value * factor


def _finite(value: float, given: object) -> float:
    if not math.isfinite(value):
        raise InputError("", _("expected a finite number, got {value}").format(value=value_text(given)))
    return value


def _example(kind: str) -> str:
    named = KINDS[kind]
    if not named.unit:
        return _("write a number without a unit")
    return _('write a number in {unit}, or a text with a unit such as "{example}"').format(
        unit=named.unit, example=named.example
    )


def _wrong(value: object, kind: str) -> InputError:
    named = KINDS[kind]
    repair = decimal_point_repair(value) if isinstance(value, str) else ""
    if not named.unit:
        what = _("expected a number, got {value}").format(value=value_text(value))
    else:
        what = _("expected {kind} ({unit}), got {value}")
        what = what.format(kind=_(named.name), unit=named.unit, value=value_text(value))
    return InputError("", what, repair or _example(kind))


def decimal_point_repair(text: str) -> str:
    """Repair of a text with a decimal comma, as "3,5 mm"; empty for other texts."""
    comma = _DECIMAL_COMMA.fullmatch(text.strip())
    if comma is None:
        return ""
    number = value_text(f"{comma.group(1)}.{international(comma.group(2))}")
    return _("decimals have a point, not a comma: write {number}").format(number=number)


def _other_kind(unit: str, kind: str, frequency: bool = False) -> InputError:
    if frequency and kind == "angular speed":
        repair = _("{unit} does not distinguish turns from radians: write rpm or rad/s").format(unit=unit)
        return InputError("", _wrong(unit, kind).what, repair)
    return _wrong(unit, kind)


def _pint_factor(unit: str, kind: str, accepted: tuple[str, ...]) -> float:
    registry = _registry()
    try:
        factor, base = registry.get_base_units(registry.parse_units(unit.replace("·", "*")))
        for si in accepted:
            own, own_base = registry.get_base_units(registry.parse_units(si))
            if base == own_base:
                return float(factor / own)
        frequency = base == registry.get_base_units("1/s")[1]
    except (_pint().errors.PintError, AttributeError, ValueError, ArithmeticError, TypeError):
        what = _("{unit} is not a known unit").format(unit=value_text(unit))
        raise InputError("", what, what + ", " + _example(kind)) from None
    raise _other_kind(unit, kind, frequency)


@functools.cache
def _registry() -> Any:
    """The one registry, with pint's cache on disk; without it where the home folder cannot be written."""
    try:
        return _pint().UnitRegistry(cache_folder=":auto:")
    except OSError:
        return _pint().UnitRegistry()
