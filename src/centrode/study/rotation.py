"""Whether a drive turns fully, and what stops it first: what a summary in one row says of it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from centrode.analysis.operation import first_limits
from centrode.analysis.rotatability.rotatability import rotatability
from centrode.locale import _
from centrode.quantities import display_unit
from centrode.sheets.texts import Joined, Name, Number, Sentence
from centrode.views.rotatability import cause_text

if TYPE_CHECKING:
    from centrode.analysis.rotatability.causes import Cause
    from centrode.kinematics.preparation import Ready
    from centrode.model.settings import Display
    from centrode.sheets.texts import Text


@dataclass(frozen=True)
class Rotation:
    """What bounds the motion from the initial position.

    Attributes
    ----------
    turns_fully : None where there are several drives, or the drive is no angle
    limit : float or None
        Value of the drive at which it stops first, in the sense in which it moves; where it is free in that sense,
        the limit in the other one [rad or m].
    unit : of the limit
    group, cause, condition : which group stops it, why in words, and in symbols; empty where nothing does
    causes : the causes as data
    """

    turns_fully: bool | None
    limit: float | None = None
    unit: str = ""
    group: str = ""
    cause: str = ""
    condition: str = ""
    causes: tuple[Cause, ...] = ()


def rotation_of(prepared: Ready) -> Rotation:
    """What a drive meets on its way."""
    found = rotatability(prepared.mechanism)
    if len(found.drives) != 1:
        return Rotation(found.turns_fully)
    met = first_limits(found, forward=prepared.kinematics.path.forward > 0)
    if not met:
        return Rotation(found.turns_fully)
    display = prepared.mechanism.display
    return Rotation(
        found.turns_fully,
        met[0].value,
        found.one.unit,
        _join(limit.group for limit in met),
        _join(_spoken(cause_text(limit.cause), display) for limit in met),
        _join(str(limit.condition) for limit in met),
        tuple(dict.fromkeys(limit.cause for limit in met)),
    )


def _join(texts: Iterable[str]) -> str:
    return "; ".join(dict.fromkeys(texts))


def _spoken(text: Text, display: Display) -> str:
    """The sentence of a cause in the language that is spoken."""
    match text:
        case Name(name):
            return name
        case Number(value, unit, digits):
            factor, shown = display_unit(unit, display.length, display.angle)
            return f"{value * factor:{digits}} {shown}"
        case Joined(parts, between):
            return between.join(_spoken(part, display) for part in parts)
        case Sentence(message, values):
            return _(message).format(**{hole: _spoken(value, display) for hole, value in values.items()})
    raise TypeError(type(text).__name__)
