"""Values in a description: numbers with units, coordinates, lists and tables, as a file may give them."""

from __future__ import annotations

import math
import unicodedata
from collections.abc import Callable, Mapping
from contextvars import ContextVar
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from pydantic import AfterValidator, PlainValidator

from centrode.errors import InputError
from centrode.locale import _
from centrode.model import limits
from centrode.model.entries import table
from centrode.model.frozen import FrozenMap
from centrode.model.motion_parameter import UNDRIVEN, MotionParameter
from centrode.model.names import PLACED, read_link_name, read_name
from centrode.model.problems import KEY, Problem, likely, shown
from centrode.model.units import to_si

Vector = tuple[float, float]


@dataclass(frozen=True)
class Reading:
    """What a value means depends on the whole: space, parameter of the motion, folder of the file."""

    space: str = "plane"
    parameter: MotionParameter = UNDRIVEN
    folder: Path = Path()

    @property
    def length(self) -> str:
        """Kind of a length: an arc on the unit sphere."""
        return "arc" if self.space == "sphere" else "length"


READING: ContextVar[Reading] = ContextVar("READING", default=Reading())  # noqa: B039 (frozen)


@dataclass(frozen=True)
class Placed:
    """A position where the chain puts it in the initial position; `at` is None until it is resolved."""

    at: Vector | None = None


def si(value: object, kind: str) -> float:
    """`to_si`, with its complaint as a Problem."""
    try:
        number = to_si(value, kind)
    except InputError as error:
        raise Problem(error.what, error.repair) from None
    most = limits.GREATEST_ANGLE if kind in ("angle", "arc") else limits.GREATEST
    if abs(number) > most:
        what = _("{value} is beyond what can be computed with").format(value=shown(value))
        raise Problem(what, _("stay below {most:g}").format(most=most))
    return number


def positive(value: object, kind: str) -> float:
    """`si`, greater than zero."""
    number = si(value, kind)
    if number <= 0:
        raise Problem(_("{key} must be positive, got {value}").format(key=KEY, value=shown(value)))
    if number < limits.LEAST:
        what = _("{value} is beyond what can be computed with").format(value=shown(value))
        raise Problem(what, _("stay above {least:g}").format(least=limits.LEAST))
    if kind == "arc" and number >= math.pi:
        what = _("{key} must be shorter than half a great circle, got {value}")
        raise Problem(what.format(key=KEY, value=shown(value)), _("stay below 180 deg"))
    return number


def not_negative(value: object, kind: str) -> float:
    """`si`, zero or more."""
    number = si(value, kind)
    if number < 0:
        raise Problem(_("{key} must not be negative, got {value}").format(key=KEY, value=shown(value)))
    return number


def numbers(value: object, kinds: tuple[str, ...], form: str) -> tuple[float, ...]:
    """A list of numbers of these kinds; `form` shows how it is written."""
    if not isinstance(value, list | tuple) or len(value) != len(kinds):
        raise Problem(_("expected {form}, got {value}").format(form=form, value=shown(value)))
    return tuple(si(item, kind) for item, kind in zip(value, kinds, strict=True))


def read_coordinates(value: object) -> Vector:
    """[x, y]; on the sphere [longitude, latitude], or a unit vector, which is turned into these."""
    if READING.get().space != "sphere":
        x, y = numbers(value, ("length", "length"), "[x, y]")
        return x, y
    if not isinstance(value, list | tuple) or len(value) != 3:
        longitude, latitude = numbers(
            value, ("arc", "arc"), _("[longitude, latitude] or a unit vector [x, y, z]")
        )
        if abs(latitude) > math.pi / 2 + 1e-9:
            what = _("a latitude lies between -90 and 90 deg, got {value:.9g} deg")
            raise Problem(what.format(value=math.degrees(latitude)), _("write [longitude, latitude]"))
        return longitude, latitude
    x, y, z = numbers(value, ("ratio",) * 3, "[x, y, z]")
    if abs(math.hypot(x, y, z) - 1) > 1e-9:
        what = _("expected a unit vector, got one of length {length:.9g}").format(length=math.hypot(x, y, z))
        raise Problem(what, _("divide it by its length, or give [longitude, latitude]"))
    return math.atan2(y, x), math.atan2(z, math.hypot(x, y))


def read_axes(value: object, kind: str) -> tuple[float, ...]:
    """Components along the axes of the space, in the plane [x, y], on the sphere [x, y, z]."""
    if READING.get().space == "sphere":
        return numbers(value, (kind,) * 3, "[x, y, z]")
    return numbers(value, (kind,) * 2, "[x, y]")


def read_position(value: object) -> Vector | Placed:
    """Coordinates, "placed", or { placed = [x, y] } as a resolved one is written back."""
    if isinstance(value, Placed):
        return value if value.at is None else Placed(read_coordinates(value.at))
    if value == PLACED:
        return Placed()
    if isinstance(value, Mapping) and set(value) == {PLACED}:
        return Placed(read_coordinates(value[PLACED]))
    if isinstance(value, str | Mapping):
        what = _('expected coordinates or "placed", got {value}').format(value=shown(value))
        raise Problem(what, likely(value, [PLACED]) if isinstance(value, str) else "")
    return read_coordinates(value)


def read_through(value: object) -> Vector | str | Placed:
    """A position, or the name of a point of the link the guide is on."""
    return read_name(value) if isinstance(value, str) and value != PLACED else read_position(value)


def read_spot(value: object) -> Vector | str:
    """Coordinates, or the name of a point."""
    return read_name(value) if isinstance(value, str) else read_coordinates(value)


def read_heading(value: object) -> tuple[float, ...]:
    """Plain numbers along the axes of the space that give a direction."""
    found = read_axes(value, "ratio")
    if not math.hypot(*found) or not math.isfinite(math.hypot(*found)):
        raise Problem(_("a direction is not zero, got {value}").format(value=list(found)))
    return found


def read_vector(value: object) -> Vector:
    """Two plain numbers that give a direction."""
    x, y = numbers(value, ("ratio", "ratio"), "[x, y]")
    if not math.hypot(x, y) or not math.isfinite(math.hypot(x, y)):
        raise Problem(_("a direction is not zero, got {value}").format(value=f"[{x}, {y}]"))
    return x, y


def read_direction(value: object) -> Vector | float:
    """A vector or an angle."""
    return read_vector(value) if isinstance(value, list | tuple) else si(value, "angle")


def read_text(value: object) -> str:
    """One line of text."""
    if not isinstance(value, str):
        raise Problem(_("expected a text, got {value}").format(value=shown(value)))
    if len(value) > limits.TEXT_LENGTH:
        what = _("a text has at most {most} characters, got {count}")
        raise Problem(what.format(most=limits.TEXT_LENGTH, count=len(value)), _("shorten it"))
    if not all(c.isprintable() or unicodedata.category(c) == "Zs" for c in value):
        raise Problem(
            _("{value} has control characters").format(value=shown(value)), _("write one line of text")
        )
    return value


def quantity(kind: str, read: Callable[[object, str], float] = si) -> PlainValidator:
    """A number of one kind; "length" is an arc on the sphere."""
    return PlainValidator(lambda value: read(value, READING.get().length if kind == "length" else kind))


Text = Annotated[str, PlainValidator(read_text)]
Name = Annotated[str, PlainValidator(read_name)]
Coordinates = Annotated[Vector, PlainValidator(read_coordinates)]
Position = Annotated[Vector | Placed, PlainValidator(read_position)]
Through = Annotated[Vector | str | Placed, PlainValidator(read_through)]
Spot = Annotated[Vector | str, PlainValidator(read_spot)]
Direction = Annotated[Vector | float, PlainValidator(read_direction)]
Heading = Annotated[tuple[float, ...], PlainValidator(read_heading)]
PositiveMetres = Annotated[float, PlainValidator(lambda value: positive(value, "length"))]
"""A length in metres on the sphere too."""
PositiveLength = Annotated[float, quantity("length", positive)]
Angle = Annotated[float, quantity("angle")]
PlaceOfMotion = Annotated[
    float, PlainValidator(lambda value: si(value, READING.get().parameter.variable.kind))
]
EndOfMotion = Annotated[float, PlainValidator(lambda value: si(value, READING.get().parameter.instant.kind))]
NamedPositions = Annotated[
    Mapping[str, Position], table(read_name, limits.POINTS), AfterValidator(FrozenMap[str, Vector | Placed])
]
link_table = table(read_link_name, limits.LINKS)
