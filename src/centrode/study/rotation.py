"""Whether a drive turns fully, and what stops it."""

from __future__ import annotations

import math
from dataclasses import dataclass

from centrode.kinematics.ready import Ready
from centrode.kinematics.solve import asked_span, solve
from centrode.study.wording import Words


@dataclass(frozen=True)
class Rotation:
    """What bounds the motion from the initial position.

    Attributes
    ----------
    turns_fully : None where the drive is no angle of constant speed
    limit : float or None
        Value of the drive at which it locks first, in the sense in which it moves [rad or m].
    group, cause : which group locks there, and how, in words; empty where nothing locks
    """

    turns_fully: bool | None
    limit: float | None
    group: str
    cause: str


def rotation_of(prepared: Ready) -> Rotation:
    """What a full turn of the drive meets, by the events of the motion."""
    path = prepared.kinematics.path
    turning = (
        not path.by_time and path.driven[0].drive.kind == "angle" and path.driven[0].drive.speed is not None
    )
    full = path.initial + path.forward * math.tau if turning else None
    solved = solve(prepared, asked_span(prepared, None, path.initial if turning else None, full))
    words = Words(solved)
    low, high = solved.branches.reach(0)
    ahead, behind = (high, low) if path.forward > 0 else (low, high)
    met = [at for at in (ahead, behind) if math.isfinite(at)]
    if not met:
        return Rotation(True if turning else None, None, "", "")
    limit = met[0]
    return Rotation(False if turning else None, limit, words.group(limit), words.limit(limit))
