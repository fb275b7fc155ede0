"""Varied values as they are given: numbers in SI, texts with a unit, ranges."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.errors import InputError
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.model.paths import value_at
from centrode.model.problems import shown
from centrode.model.units import to_si
from centrode.sweeps import limits

Array: TypeAlias = npt.NDArray[np.float64]

_ALONG = frozenset({"x", "y", "length", "radius"})
_METRES = frozenset({"radius", "centre_radius"})
"""Of links: lengths on the sphere too."""
_MASSES = frozenset({"mass", "inertia"})
_ANGLES = frozenset({"direction", "angle", "longitude", "latitude"})


def kind_of(mechanism: Mechanism, path: str) -> str:
    """Kind of the number at a path, which tells its units; InputError where there is no such path."""
    try:
        value_at(mechanism, path)
    except InputError as error:
        raise InputError("vary", error.what, error.repair) from None
    room, word = path.partition(".")[0], path.rpartition(".")[2]
    if word in _METRES and room == "links":
        return "length"
    if word in _ALONG:
        return "length" if mechanism.space == "plane" else "arc"
    if word in _MASSES:
        return word
    return "angle" if word in _ANGLES else "ratio"


def unit_of(mechanism: Mechanism, path: str) -> str:
    """SI unit of the number at a path; "1" where it has none."""
    return {"length": "m", "ratio": "1", "mass": "kg", "inertia": "kg m^2"}.get(
        kind_of(mechanism, path), "rad"
    )


def numbers(mechanism: Mechanism, path: str, given: Any) -> Array:
    """Values [SI] given one by one: an array of numbers, or a list of numbers and texts with a unit.

    Raises InputError at the path: none, not in one dimension, not finite, a text that is no number, a range.
    """
    kind = kind_of(mechanism, path)
    if (
        isinstance(given, tuple)
        and len(given) == 3
        and isinstance(given[0], str)
        and isinstance(given[2], int)
    ):
        raise InputError(path, _("a range stands where values are expected"), _("say ct.grid or ct.sample"))
    if isinstance(given, Sequence) and not isinstance(given, str) and any(isinstance(x, str) for x in given):
        given = [_number(kind, path, value) for value in given]
    try:
        array = np.asarray(given, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        raise InputError(
            path, _("its values are no numbers"), _("give numbers, or texts with a unit")
        ) from None
    if array.ndim != 1 or not array.size:
        raise InputError(path, _("it needs one value or more, in one dimension"))
    if array.size > limits.LISTED:
        what = _("{count} values were given").format(count=array.size)
        raise InputError(path, what, _("give at most {most}, or a ct.grid").format(most=limits.LISTED))
    if not np.isfinite(array).all():
        raise InputError(path, _("values must be finite"))
    _refuse_negative(kind, path, float(array.min()))
    return array


def ends(mechanism: Mechanism, path: str, first: Any, last: Any) -> tuple[float, float]:
    """Both ends [SI] of a range; InputError at the path where it is reversed or has no extent."""
    kind = kind_of(mechanism, path)
    low, high = (_number(kind, path, end) for end in (first, last))
    if not low < high:
        what = _("the range from {first} to {last} does not rise").format(
            first=shown(first), last=shown(last)
        )
        raise InputError(path, what, _("give the lesser end first, and a greater one after it"))
    _refuse_negative(kind, path, low)
    return low, high


def _refuse_negative(kind: str, path: str, least: float) -> None:
    if kind in _MASSES and least < 0.0:
        raise InputError(path, _("{value:g} is negative").format(value=least), _("give 0 or more"))


def _number(kind: str, path: str, given: Any) -> float:
    value = given.item() if isinstance(given, np.generic) else given
    try:
        return to_si(value, kind)
    except InputError as error:
        raise InputError(path, error.what, error.repair) from None


def count_of(path: str, given: Any, most: int) -> int:
    """A number of values; InputError at the path where it is no whole number from 1 to `most`."""
    if isinstance(given, np.integer):
        given = int(given)
    if isinstance(given, bool) or not isinstance(given, int) or not 1 <= given <= most:
        what = _("{count} is no number of values").format(count=shown(given))
        raise InputError(path, what, _("give a whole number from 1 to {most}").format(most=most))
    return given
