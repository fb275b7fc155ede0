"""Whether every mechanism within the limits assembles and moves, and what first stops one."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.tolerances.deviated_mechanisms import DeviatedMechanisms

Array: TypeAlias = npt.NDArray[np.float64]

FEW = 32
"""Corners whose way is looked at."""
PARTS, ROUNDS = 16, 5
"""The share is narrowed to (1/16)^5, a millionth."""


@dataclass(frozen=True)
class LimitStop:
    """The mechanism that first stops as tolerances grow.

    Attributes
    ----------
    share : of the tolerances at which it stops
    deviations : (paths,) of its numbers [SI]
    at : value of the drive [rad or m; with several drives or a law s] at which it locks, NaN where it assembles nowhere
    group : that locks; empty where none is known
    """

    share: float
    deviations: Array
    at: float
    group: str


@dataclass(frozen=True)
class AssemblyInLimits:
    """Mechanisms within the limits that were looked at.

    Attributes
    ----------
    corners, stopped_corners : corners of the limits, and those that do not move
    all_corners : whether these are all that there are
    drawn, stopped_drawn : mechanisms drawn, and those that do not move
    first : None where all corners move
    """

    corners: int
    stopped_corners: int
    all_corners: bool
    drawn: int
    stopped_drawn: int
    first: LimitStop | None

    @property
    def moves(self) -> bool:
        """Whether all that were looked at move."""
        return not self.stopped_corners and not self.stopped_drawn


def first_stop(mechanisms: DeviatedMechanisms, stopped: Array) -> LimitStop | None:
    """The least share of the tolerances at which one of these mechanisms (n, paths) stops, and where."""
    if not len(stopped):
        return None
    # on the way from the description to a mechanism all of its numbers grow together
    few = stopped[np.linspace(0, len(stopped) - 1, min(FEW, len(stopped))).astype(int)]
    low, high = np.zeros(len(few)), np.ones(len(few))
    for _round in range(ROUNDS):
        shares = low[:, None] + (high - low)[:, None] * np.linspace(0.0, 1.0, PARTS + 1)
        ways = (shares[:, :, None] * few[:, None, :]).reshape(-1, few.shape[1])
        moves = mechanisms.outputs_of_many(ways).moves.reshape(len(few), -1)
        moves[:, -1] = False
        first = np.argmin(moves, axis=1)
        rows = np.arange(len(few))
        low, high = shares[rows, np.maximum(first - 1, 0)], shares[rows, first]
    row = int(np.argmin(high))
    deviations = few[row] * high[row]
    prepared = mechanisms.prepared
    limits = [e for e in mechanisms.events_of(mechanisms.limits.values + deviations) if e.kind == "limit"]
    if not limits:
        return LimitStop(float(high[row]), few[row], float("nan"), "")
    start = float(prepared.kinematics.path.initial)
    event = min(limits, key=lambda e: abs(e.at - start))
    group = prepared.structure.groups[event.group]
    return LimitStop(float(high[row]), few[row], event.at, "-".join(group.links or group.points))
