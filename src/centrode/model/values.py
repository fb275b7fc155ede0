"""Values in a description: numbers with units, coordinates, lists and tables, as a file may give them."""

from __future__ import annotations

import csv
import math
import re
import unicodedata
from collections.abc import Callable, Mapping
from contextvars import ContextVar
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import Annotated, Literal

from pydantic import AfterValidator, PlainValidator

from centrode.errors import InputError
from centrode.locale import _, ngettext
from centrode.model import reading
from centrode.model.motion_parameter import UNDRIVEN, MotionParameter
from centrode.model.reading import (
    KEY,
    PLACED,
    FrozenMap,
    Problem,
    csv_separator,
    likely,
    read_file,
    read_flag,
    read_link_name,
    read_name,
    table,
    value_text,
)
from centrode.model.units import ANGULAR, bare_angle, is_bare, to_si, unit_factor

Vector = tuple[float, float]


BareAngles = Literal["radians", "refused", "marked"]
RAD, RPM = "rad", "rpm"


class Radians(float):
    """An angle of a description that is written with its unit."""


class TurnsPerMinute(float):
    """A speed [rad/s] that a description gives in turns per minute: sentences name it so."""

    @property
    def rpm(self) -> float:
        """Turns per minute."""
        return self * 30 / math.pi


@dataclass(frozen=True)
class Reading:
    """What a value means depends on the whole.

    Attributes
    ----------
    space : "plane" or "sphere"
    parameter : of the motion
    folder : of the file
    bare_angles : what an angle without a unit is
        "radians", as every number of Python is; "refused" in a file that displays other angles, whose author may have
        meant degrees; "marked": radians, and every angle is read as `Radians`.
    """

    space: str = "plane"
    parameter: MotionParameter = UNDRIVEN
    folder: Path = Path()
    bare_angles: BareAngles = "radians"

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
    """`to_si`, with its complaint as a Problem; an angle without a unit is treated as the description wishes."""
    if kind not in ANGULAR:
        return _bounded_number(value, kind)
    bare_angles = READING.get().bare_angles
    if bare_angles == "refused" and _is_bare(value, kind):
        error = bare_angle(value)
        raise Problem(error.what, error.repair)
    number = _bounded_number(value, kind)
    return Radians(number) if bare_angles == "marked" else number


def angular_speed(value: object, read: Callable[[object, str], float] = si) -> float:
    """A speed [rad/s] by `read`, `TurnsPerMinute` where it is given in them."""
    number = read(value, "angular speed")
    in_turns = isinstance(value, str) and value.rstrip().endswith(RPM)
    return TurnsPerMinute(number) if in_turns or isinstance(value, TurnsPerMinute) else number


def _is_bare(value: object, kind: str) -> bool:
    try:
        return is_bare(value, kind)
    except InputError as error:
        raise Problem(error.what, error.repair) from None


def _bounded_number(value: object, kind: str) -> float:
    """`to_si` within what can be computed with."""
    try:
        number = to_si(value, kind)
    except InputError as error:
        raise Problem(error.what, error.repair) from None
    most = reading.GREATEST_ANGLE if kind in ("angle", "arc") else reading.GREATEST
    if abs(number) > most:
        what = _("{value} is outside the range that can be computed").format(value=value_text(value))
        raise Problem(what, _("stay below {most:g}").format(most=most))
    return number


def positive(value: object, kind: str) -> float:
    """`si`, greater than zero."""
    number = si(value, kind)
    if number <= 0:
        raise Problem(_("{key} must be positive, got {value}").format(key=KEY, value=value_text(value)))
    if number < reading.LEAST:
        what = _("{value} is outside the range that can be computed").format(value=value_text(value))
        raise Problem(what, _("stay above {least:g}").format(least=reading.LEAST))
    if kind == "arc" and number >= math.pi:
        what = _("{key} must be shorter than half a great circle, got {value}")
        raise Problem(what.format(key=KEY, value=value_text(value)), _("stay below 180 deg"))
    return number


def not_negative(value: object, kind: str) -> float:
    """`si`, zero or more."""
    number = si(value, kind)
    if number < 0:
        raise Problem(_("{key} must not be negative, got {value}").format(key=KEY, value=value_text(value)))
    return number


def numbers(value: object, kinds: tuple[str, ...], form: str) -> tuple[float, ...]:
    """A list of numbers of these kinds; `form` shows how it is written."""
    if not isinstance(value, list | tuple) or len(value) != len(kinds):
        what = _("expected {form}, got {value}").format(form=form, value=value_text(value))
        # [0,5, 0] is a list of three whole numbers: where too many stand in a list, a comma may be a decimal one.
        listed = value if isinstance(value, list | tuple) else ()
        whole = any(listed) and all(isinstance(item, int) for item in listed)
        comma = whole and len(kinds) < len(listed) <= 2 * len(kinds)
        raise Problem(what, _("decimals have a point, not a comma: 3.5") if comma else "")
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
            what = _("a latitude must lie between -90 and 90 deg, got {value:.9g} deg")
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
        what = _('expected coordinates or "placed", got {value}').format(value=value_text(value))
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
        raise Problem(_("a direction must not be zero, got {value}").format(value=list(found)))
    return found


def read_vector(value: object) -> Vector:
    """Two plain numbers that give a direction."""
    x, y = numbers(value, ("ratio", "ratio"), "[x, y]")
    if not math.hypot(x, y) or not math.isfinite(math.hypot(x, y)):
        raise Problem(_("a direction must not be zero, got {value}").format(value=f"[{x}, {y}]"))
    return x, y


def read_direction(value: object) -> Vector | float:
    """A vector or an angle."""
    return read_vector(value) if isinstance(value, list | tuple) else si(value, "angle")


def read_text(value: object) -> str:
    """One line of text."""
    if not isinstance(value, str):
        raise Problem(_("expected a text, got {value}").format(value=value_text(value)))
    if len(value) > reading.TEXT_LENGTH:
        what = _("a text has at most {most} characters, got {count}")
        raise Problem(what.format(most=reading.TEXT_LENGTH, count=len(value)), _("shorten it"))
    if not all(c.isprintable() or unicodedata.category(c) == "Zs" for c in value):
        raise Problem(
            _("{value} has control characters").format(value=value_text(value)), _("write one line of text")
        )
    return value


def quantity(kind: str, read: Callable[[object, str], float] = si) -> PlainValidator:
    """A number of one kind; "length" is an arc on the sphere."""
    return PlainValidator(lambda value: read(value, READING.get().length if kind == "length" else kind))


Text = Annotated[str, PlainValidator(read_text)]
Name = Annotated[str, PlainValidator(read_name)]
Flag = Annotated[bool, PlainValidator(read_flag)]
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
InstantOfMotion = Annotated[
    float, PlainValidator(lambda value: si(value, READING.get().parameter.instant.kind))
]
NamedPositions = Annotated[
    Mapping[str, Position], table(read_name, reading.POINTS), AfterValidator(FrozenMap[str, Vector | Placed])
]
link_table = table(read_link_name, reading.LINKS)


# Tables of drives and loads: rows of numbers, in the description or in a CSV file beside it.

Rows = tuple[tuple[float, ...], ...]
_UNIT = re.compile(r"\[(.+)\]")
_NUMBER = re.compile(r"[+-]?\.?\d|nan|[+-]?inf", re.IGNORECASE)


@dataclass(frozen=True)
class TableColumns:
    """Kinds of quantity of a table's columns, of which at least `least` are given, and how a row is written."""

    kinds: tuple[str, ...]
    form: str
    least: int

    def fit(self, count: int) -> bool:
        """Whether a row may have so many values."""
        return self.least <= count <= len(self.kinds)


def read_rows(value: object, columns: TableColumns, folder: Path) -> Rows:
    """Rows of SI numbers, all of one length, from a list or from the path of a CSV file relative to `folder`."""
    if isinstance(value, str):
        return _csv_rows(value, columns, folder)
    if not isinstance(value, list | tuple):
        what = _("expected the path of a CSV file or rows [{form}, ...], got {value}")
        raise Problem(what.format(form=columns.form, value=value_text(value)))
    _count(len(value))
    first = len(value[0]) if value and isinstance(value[0], list | tuple) else 0
    kinds = columns.kinds[: max(first, columns.least)]
    return tuple(numbers(row, kinds, columns.form) for row in value)


def _csv_rows(name: str, columns: TableColumns, folder: Path) -> Rows:
    path = PurePosixPath(name.replace("\\", "/"))
    if not name.isprintable() or path.is_absolute() or ".." in path.parts or ":" in name:
        what = _("{name} is not in the folder of the description").format(name=value_text(name))
        raise Problem(what, _("put the CSV file into the folder of the description"))
    try:
        text = read_file(folder / path)
        separator = csv_separator(text)
        rows = csv.reader(text.splitlines(), delimiter=separator)
        lines = [row for row in rows if any(cell.strip() for cell in row)]
    except InputError as error:
        raise Problem(f"{value_text(name)}: {error.what}", error.repair) from None
    except csv.Error as error:
        raise Problem(
            _("{name} is not a CSV file: {reason}").format(name=value_text(name), reason=error)
        ) from None
    factors = _header(lines[0], columns) if lines else None
    body = lines[1:] if factors else lines
    if separator != ",":
        body = [[cell.replace(",", ".") for cell in row] for row in body]
    _count(len(body))
    width = len(lines[0]) if lines and columns.fit(len(lines[0])) else columns.least
    units = factors or (None,) * width
    kinds = columns.kinds[:width]
    return tuple(_table_row(row, number, units, kinds, name) for number, row in enumerate(body, 1))


def _header(row: list[str], columns: TableColumns) -> tuple[float | None, ...] | None:
    """Factors to SI of the units in brackets ("angle [deg]"), None for no unit; None if the first row is numbers."""
    if not columns.fit(len(row)) or any(_NUMBER.match(cell.strip()) for cell in row):
        return None
    try:
        return tuple(_heading_factor(cell, kind) for cell, kind in zip(row, columns.kinds, strict=False))
    except InputError as error:
        raise Problem(error.what, error.repair) from None


def _heading_factor(cell: str, kind: str) -> float | None:
    unit = _UNIT.search(cell)
    return unit_factor(unit.group(1), kind) if unit else None


def _table_row(
    row: list[str], number: int, factors: tuple[float | None, ...], kinds: tuple[str, ...], name: str
) -> tuple[float, ...]:
    if len(row) != len(kinds):
        if kinds[0] == "time":
            what = ngettext(
                "row {number} of {name} has {n} value, expected a time and a value",
                "row {number} of {name} has {n} values, expected a time and a value",
                len(row),
            )
        else:
            what = ngettext(
                "row {number} of {name} has {n} value, expected {expected}",
                "row {number} of {name} has {n} values, expected {expected}",
                len(row),
            )
        text = what.format(number=number, name=value_text(name), n=len(row), expected=len(kinds))
        raise Problem(text)
    try:
        return tuple(_cell(*given) for given in zip(row, kinds, factors, strict=True))
    except Problem as problem:
        place = _("row {number} of {name}: {what}").format(
            number=number, name=value_text(name), what=problem.what
        )
        raise Problem(place, problem.repair) from None


def _cell(text: str, kind: str, factor: float | None) -> float:
    """Number [SI] of a cell, whose unit stands in the heading, or else in the cell."""
    if factor is None:
        return si(text.strip(), kind)
    number = _bounded_number(text.strip(), kind) * factor
    return Radians(number) if kind in ANGULAR and READING.get().bare_angles == "marked" else number


def _count(count: int) -> None:
    if count > reading.TABLE_ROWS:
        what = _("a table has at most {most} rows, got {count}").format(most=reading.TABLE_ROWS, count=count)
        raise Problem(what, _("thin it out"))


# Tensors of inertia: as a description gives them, and their principal moments and axes.

Row = tuple[float, ...]
Tensor = tuple[Row, ...]
Inertia = float | Row | Tensor
"""A moment; on the sphere also three principal ones, or a tensor."""

PLAUSIBLE = 1e-9
"""A tensor may miss the rules of inertia by this share of its trace: it is given in decimals."""
SWEEPS = 30
LEAST = 1e-300


def read_inertia(value: object) -> Inertia:
    """A moment of inertia, not negative; on the sphere also [a, b, c] or a tensor that some body has."""
    if READING.get().space != "sphere" or not isinstance(value, list | tuple):
        return not_negative(value, "inertia")
    if len(value) != 3:
        form = _("a number, principal moments [a, b, c], or a tensor of three rows")
        raise Problem(_("expected {form}, got {value}").format(form=form, value=value_text(value)))
    found: Row | Tensor
    if not any(isinstance(row, list | tuple) for row in value):
        found = tuple(si(entry, "inertia") for entry in value)
    else:
        found = tuple(_tensor_row(row) for row in value)
        _check_symmetric(found)
    _check_of_a_body(found)
    return found


def _tensor_row(value: object) -> Row:
    if not isinstance(value, list | tuple) or len(value) != 3:
        form = _("a number, principal moments [a, b, c], or a tensor of three rows")
        raise Problem(_("expected {form}, got {value}").format(form=form, value=value_text(value)))
    return tuple(si(entry, "inertia") for entry in value)


def tensor_of(inertia: Inertia) -> Tensor:
    """The tensor in the link's own axes: a number is the same about all axes, three are principal moments."""
    if not isinstance(inertia, tuple):
        inertia = (inertia,) * 3
    if isinstance(inertia[0], tuple):
        return inertia
    return tuple(tuple(float(inertia[i]) if i == j else 0.0 for j in range(3)) for i in range(3))


def _check_symmetric(tensor: Tensor) -> None:
    slack = PLAUSIBLE * sum(abs(x) for row in tensor for x in row)
    for i, j in ((0, 1), (1, 2), (2, 0)):
        if abs(tensor[i][j] - tensor[j][i]) > slack:
            what = _(
                "a tensor of inertia is symmetric, but the symmetric elements {one:.6g} and {other:.6g} differ"
            )
            text = what.format(one=tensor[i][j], other=tensor[j][i])
            raise Problem(
                text, _("give the products of inertia, which are negative sums of x y, on both sides")
            )


def _check_of_a_body(inertia: Inertia) -> None:
    low, middle, high = moments = sorted(principal(tensor_of(inertia))[0])
    slack = PLAUSIBLE * sum(abs(x) for x in moments)
    listed = ", ".join(f"{x:.6g}" for x in moments)
    if low < -slack:
        what = _("it is not positive definite: its principal moments are {moments}").format(moments=listed)
        raise Problem(what, _("correct it: no moment of inertia is negative"))
    if high > low + middle + slack:
        what = _("no body has the principal moments {moments}").format(moments=listed)
        repair = _(
            "correct it: the greatest one never exceeds the sum of the two others, here by {excess:.6g}"
        )
        raise Problem(what, repair.format(excess=high - low - middle))


def principal(tensor: Tensor) -> tuple[Row, Tensor]:
    """Principal moments of a symmetric tensor, and their axes as rows: Jacobi's rotations, to rounding.

    Source: Golub and Van Loan, Matrix Computations, section 8.5.
    """
    a = [[0.5 * (tensor[i][j] + tensor[j][i]) for j in range(3)] for i in range(3)]
    axes = [[float(i == j) for j in range(3)] for i in range(3)]
    for _sweep in range(SWEEPS):
        if a[0][1] == a[0][2] == a[1][2] == 0.0:
            break
        for p, q in ((0, 1), (0, 2), (1, 2)):
            _rotate(a, axes, p, q)
    return tuple(a[i][i] for i in range(3)), tuple(tuple(axis) for axis in axes)


def _rotate(a: list[list[float]], axes: list[list[float]], p: int, q: int) -> None:
    """Turn two axes so that the element between them vanishes; one that rounding cannot tell from zero is dropped."""
    across = a[p][q]
    if all(abs(a[k][k]) + abs(across) == abs(a[k][k]) for k in (p, q)) or abs(across) <= LEAST:
        a[p][q] = a[q][p] = 0.0
        return
    ratio = (a[q][q] - a[p][p]) / (2.0 * across)
    tangent = math.copysign(1.0, ratio) / (abs(ratio) + math.hypot(1.0, ratio))
    cosine = 1.0 / math.hypot(1.0, tangent)
    sine = tangent * cosine
    a[p][p] -= tangent * across
    a[q][q] += tangent * across
    a[p][q] = a[q][p] = 0.0
    r = 3 - p - q
    a[r][p], a[r][q] = cosine * a[r][p] - sine * a[r][q], sine * a[r][p] + cosine * a[r][q]
    a[p][r], a[q][r] = a[r][p], a[r][q]
    for k in range(3):
        axes[p][k], axes[q][k] = (
            cosine * axes[p][k] - sine * axes[q][k],
            sine * axes[p][k] + cosine * axes[q][k],
        )


# Places on the unit sphere: longitude and latitude, unit vectors, and angles between arcs.

Vector3 = tuple[float, float, float]
Axes = tuple[Vector3, Vector3, Vector3]

FLAT = 1e-9
"""Arcs shorter than this, or as near to half a great circle, do not tell a direction [rad]."""


def unit_vector(place: Vector) -> Vector3:
    """Unit vector of (longitude, latitude) [rad]: (cos lat cos lon, cos lat sin lon, sin lat)."""
    longitude, latitude = place
    across = math.cos(latitude)
    return across * math.cos(longitude), across * math.sin(longitude), math.sin(latitude)


def longitude_latitude(vector: Vector3) -> Vector:
    """(longitude, latitude) [rad] of a vector of any length but zero; longitude in (-pi, pi], 0 at the poles."""
    x, y, z = vector
    return math.atan2(y, x), math.atan2(z, math.hypot(x, y))


def dot(a: Vector3, b: Vector3) -> float:
    """Scalar product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector3, b: Vector3) -> Vector3:
    """Vector product."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def arc(a: Vector3, b: Vector3) -> float:
    """Arc [rad] between two unit vectors, 0 to pi, to rounding also where it is short."""
    return math.atan2(math.hypot(*cross(a, b)), dot(a, b))


def makes_arc(a: Vector3, b: Vector3) -> bool:
    """Whether two unit vectors neither coincide nor lie opposite, so that one great circle joins them."""
    return FLAT < arc(a, b) < math.pi - FLAT


def tangent_towards(start: Vector3, towards: Vector3) -> Vector3:
    """Unit tangent in `start` of the arc towards a point that is neither `start` nor opposite to it."""
    normal = cross(start, towards)
    size = math.hypot(*normal)
    x, y, z = cross(normal, start)
    return x / size, y / size, z / size


def turned_about(axis: Vector3, tangent: Vector3, angle: float) -> Vector3:
    """A tangent in `axis` turned by an angle [rad], counter-clockwise seen from outside the sphere."""
    left = cross(axis, tangent)
    cosine, sine = math.cos(angle), math.sin(angle)
    x, y, z = (cosine * t + sine * n for t, n in zip(tangent, left, strict=True))
    return x, y, z


def axes(pivot: Vector3, forward: Vector3) -> Axes:
    """Right-handed axes of a pivot and a unit tangent in it."""
    return pivot, forward, cross(pivot, forward)


def transfer_vector(vector: Vector3, mine: Axes, theirs: Axes) -> Vector3:
    """A vector turned together with its axes into others."""
    sizes = [dot(vector, axis) for axis in mine]
    x, y, z = (sum(size * axis[k] for size, axis in zip(sizes, theirs, strict=True)) for k in range(3))
    return x, y, z


def angle_between(pivot: Vector3, reference: Vector3, point: Vector3) -> float:
    """Angle [rad] in the pivot from the arc to `reference` to the arc to `point`, in (-pi, pi].

    Counter-clockwise seen from outside the sphere; neither point may be the pivot or opposite to it.
    """
    start, end = tangent_towards(pivot, reference), tangent_towards(pivot, point)
    return math.atan2(dot(pivot, cross(start, end)), dot(start, end))
