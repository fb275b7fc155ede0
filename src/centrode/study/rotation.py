"""Whether a drive turns fully, and what stops it first: what a summary in one row says of it."""

from __future__ import annotations

from dataclasses import dataclass

from centrode.analysis.rotatability.rotatability import LimitFound, rotatability
from centrode.kinematics.preparation import Ready


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
    """

    turns_fully: bool | None
    limit: float | None = None
    unit: str = ""
    group: str = ""
    cause: str = ""
    condition: str = ""


def rotation_of(prepared: Ready) -> Rotation:
    """What a drive meets on its way."""
    found = rotatability(prepared.mechanism)
    if len(found.drives) != 1:
        return Rotation(found.turns_fully)
    forward = "high" if prepared.kinematics.path.forward > 0 else "low"
    limits = sorted(found.limits, key=lambda limit: limit.end != forward)
    if not limits:
        return Rotation(found.turns_fully)
    first = limits[0].value
    met = [limit for limit in limits if limit.value == first]
    return Rotation(
        found.turns_fully,
        first,
        found.one.unit,
        _joined(met, "group"),
        _joined(met, "cause"),
        _joined(met, "condition"),
    )


def _joined(limits: list[LimitFound], attribute: str) -> str:
    return "; ".join(dict.fromkeys(getattr(limit, attribute) for limit in limits))
