"""How the drive moves while reactions are asked for."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.reducer import Burden, Reducer
from centrode.dynamics.several import refuse_drive_in_formulas
from centrode.dynamics.states import Moving
from centrode.kinematics.solve import Solved
from centrode.kinematics.spans import is_uniform

Array: TypeAlias = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Pace:
    """Speed and acceleration of the path's parameter at samples, and whose they are.

    Attributes
    ----------
    acceleration : (n)
    source : "drive", "machine" or "steady"
    """

    moving: Moving
    acceleration: Array
    source: str


def pace_of(solved: Solved, burden: Burden) -> Pace:
    """As `reduce` takes it: of a drive of constant speed the machine's mean speed, if there is one; else the drive's own."""
    span, prepared = solved.span, solved.ready
    path = prepared.kinematics.path
    if path.by_time:
        refuse_drive_in_formulas(burden)
    if path.by_time or prepared.mechanism.machine is None or not is_uniform(path):
        return Pace(Moving(span.time, span.parameter, span.rate), span.second_rate, "drive")
    moving = Reducer(prepared, burden).moving(span.parameter)
    return Pace(moving, np.zeros(len(span.parameter)), "machine")
