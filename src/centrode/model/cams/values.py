"""Values of a cam's description: points and formulas of curvatures, bounds, parameters to be chosen."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from typing import Annotated

from pydantic import PlainValidator

from centrode.algebra.text import compile_formula
from centrode.errors import InputError
from centrode.locale import _
from centrode.model.entries import named_entries
from centrode.model.frozen import FrozenMap
from centrode.model.problems import KEY, Problem, likely, shown
from centrode.model.tables import Columns, read_rows
from centrode.model.values import READING, positive, quantity, read_text, si

_POINTS = Columns(("angle", "curvature"), "[angle, curvature]", 2)
MOST_PARAMETERS = 8
MOST_CONSTANTS = 20
LETTER = re.compile(r"[A-Za-z][A-Za-z0-9_]*")


def read_points(value: object) -> tuple[tuple[float, float], ...]:
    """Points of a spline, (phi [rad], K [1/m]), from rows or a CSV file."""
    rows = read_rows(value, _POINTS, READING.get().folder)
    if len(rows) < 2:
        raise Problem(_("a spline needs at least two points of an angle and a curvature"), _("add points"))
    return tuple((row[0], row[1]) for row in rows)


def read_formula(value: object, constants: Iterable[str] = ()) -> str:
    """The text of a formula of phi and of further letters."""
    text = read_text(value)
    try:
        compile_formula(text, ("phi", *constants), "")
    except InputError as error:
        raise Problem(error.what, error.repair) from None
    return text


def read_constants(value: object) -> FrozenMap[str, float]:
    """Letters of a formula with their values in SI."""
    named = named_entries(value, _read_letter, MOST_CONSTANTS)
    return FrozenMap({name: si(number, "ratio") for name, number in named.items()})


def _read_letter(key: object) -> str:
    name = str(key)
    if LETTER.fullmatch(name) and name not in ("phi", "pi", "e"):
        return name
    what = _("{name} cannot be a letter of a formula").format(name=shown(name))
    raise Problem(what, _("use letters, digits and underscores, a letter in front; phi, pi and e are taken"))


def read_flag(value: object) -> bool:
    """True or false."""
    if not isinstance(value, bool):
        raise Problem(_("expected true or false, got {value}").format(value=shown(value)))
    return value


def read_steepness(value: object, kind: str) -> float:
    """A greatest pressure angle [rad], below a right angle."""
    number = positive(value, kind)
    if number >= math.pi / 2:
        what = _("{key} must be smaller than 90 deg, got {value}").format(key=KEY, value=shown(value))
        raise Problem(what, _("at 90 deg the follower stalls"))
    return number


def read_poisson(value: object, kind: str) -> float:
    """A Poisson's ratio."""
    number = si(value, kind)
    if not 0 <= number <= 0.5:
        what = _("{key} must lie between 0 and 0.5, got {value}").format(key=KEY, value=shown(value))
        raise Problem(what, _("it is 0.3 for steel"))
    return number


def whole(least: int, most: int) -> PlainValidator:
    """A whole number between bounds."""

    def read(value: object) -> int:
        if isinstance(value, bool) or not isinstance(value, int) or not least <= value <= most:
            what = _("{key} must be a whole number from {least} to {most}, got {value}")
            raise Problem(what.format(key=KEY, least=least, most=most, value=shown(value)))
        return value

    return PlainValidator(read)


PARAMETERS = {
    "curvature.k0": ("curvature",),
    "curvature.k1": ("per angle", "curvature slope"),
    "start.radius": ("length",),
    "start.pressure_angle": ("angle",),
    "roller.radius": ("length",),
}
"""What may be chosen, and the kinds of quantity it may be."""

POINT = re.compile(r"curvature\.points\.[1-9][0-9]{0,4}")
"""The curvature at one of a spline's points, counted from 1, may be chosen too."""

CONSTANT = re.compile(r"curvature\.constants\.[A-Za-z][A-Za-z0-9_]*")
"""And a letter of a formula, in SI."""


def read_parameters(value: object) -> FrozenMap[str, tuple[float, float]]:
    """Names of `PARAMETERS`, each with its least and greatest value in SI."""
    named = named_entries(value, _read_parameter, MOST_PARAMETERS)
    if not named:
        raise Problem(
            _("at least one parameter is to be chosen"),
            _("known are: {names}").format(names=", ".join(PARAMETERS)),
        )
    return FrozenMap({name: _read_bounds(name, pair) for name, pair in named.items()})


def _read_parameter(key: object) -> str:
    if isinstance(key, str) and (key in PARAMETERS or POINT.fullmatch(key) or CONSTANT.fullmatch(key)):
        return key
    what = _("{name} cannot be chosen").format(name=shown(key))
    names = ", ".join([*PARAMETERS, "curvature.points.1", "curvature.constants.a"])
    known = _("known are: {names}").format(names=names)
    raise Problem(what, (likely(key, PARAMETERS) if isinstance(key, str) else "") or known)


def _read_bounds(name: str, pair: object) -> tuple[float, float]:
    if not isinstance(pair, list | tuple) or len(pair) != 2:
        what = _("expected {form}, got {value}").format(form=_("[least, greatest]"), value=shown(pair))
        raise Problem(what, at=(name,))
    try:
        low, high = (_of_kinds(end, _kinds_of(name)) for end in pair)
    except Problem as problem:
        raise Problem(problem.what, problem.repair, (name,)) from None
    if not low < high:
        what = _("the least value has to be below the greatest: {low:g}, {high:g}").format(low=low, high=high)
        raise Problem(what, at=(name,))
    return low, high


def _kinds_of(name: str) -> tuple[str, ...]:
    return PARAMETERS.get(name, ("ratio",) if CONSTANT.fullmatch(name) else ("curvature",))


def _of_kinds(value: object, kinds: tuple[str, ...]) -> float:
    """A quantity of the first kind that fits."""
    for kind in kinds[:-1]:
        try:
            return si(value, kind)
        except Problem:
            continue
    return si(value, kinds[-1])


Curved = Annotated[float, quantity("curvature", positive)]
Stress = Annotated[float, quantity("pressure", positive)]
Size = Annotated[float, quantity("length", positive)]
Steepness = Annotated[float, quantity("angle", read_steepness)]
Flag = Annotated[bool, PlainValidator(read_flag)]
