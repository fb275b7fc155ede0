"""The steps of a free motion: what its integration reached after each, where it ended and why."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import nan
from typing import NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.forward_dynamics.change_points import Detour

Array: TypeAlias = npt.NDArray[np.float64]

CROSSING, NEAR_MISS = "crossing", "near miss"
"""Kinds of events: a change point was passed, or the closures only came near to losing rank."""
IMPACT, RESTS, CLOSES, OPENS = "impact", "comes to rest", "closes", "opens"
TOUCHES, LEAVES, LETS_GO = "touches", "leaves", "lets go"
STICKS, SLIPS, CONDITION_MET = "sticks", "slips", "condition"
"""Kinds of events of stops, clamps, frictions and of a user's conditions."""
KINDS = (
    *(CROSSING, NEAR_MISS, IMPACT, RESTS, CLOSES, OPENS, TOUCHES, LEAVES, LETS_GO),
    *(STICKS, SLIPS, CONDITION_MET),
)
DURATION, BLOW_UP, STEP_SIZE, CHANGE_POINT = "duration", "blow-up", "step size", "change point"
CONDITION_ENDS, AMBIGUOUS = "event", "ambiguous friction"
"""Ends of a motion."""


class Event(NamedTuple):
    """Something that happened on the way.

    Attributes
    ----------
    time : [s]
    kind : one of `KINDS`
    detail : change of the energy [J] at a crossing, independence of the closures (0 to 1) at a near miss
    part : the stop, clamp, friction or user's event; empty of what belongs to the closures
    impulse, lost : of an impact [N s or N m s], [J]
    """

    time: float
    kind: str
    detail: float = nan
    part: str = ""
    impulse: float = nan
    lost: float = nan


class ImpactRecord(NamedTuple):
    """Of what impulses of stops and clamps at one instant were made, by c contacts that touched.

    Attributes
    ----------
    numbers : of the contacts
    signs : (c), the sense along their coordinates in which they push
    before, after : (c), speeds away from the bounds
    impulses : (c) [N s or N m s], without those that bring what rests to rest
    resting : places among the c of those that came to rest at once
    settled : times [s] after which their last small impacts have come to an end
    """

    numbers: tuple[int, ...]
    signs: Array
    before: Array
    after: Array
    impulses: Array
    resting: tuple[int, ...]
    settled: tuple[float, ...]


class Transition(NamedTuple):
    """An instant at which modes may change: the start, an event, or a clamp that lets go.

    Attributes
    ----------
    before, behind : (1 + carried), the time first
    due : numbers of the guards that have passed zero; none at the start, and where a clamp lets go by the clock
    impact : of what impulses were made; None without any
    events : what was noted then
    """

    before: Array
    behind: Array
    due: frozenset[int]
    impact: ImpactRecord | None
    events: tuple[Event, ...]

    @property
    def time(self) -> float:
        """When [s]."""
        return float(self.behind[0])


@dataclass(frozen=True)
class MotionSteps:
    """The steps of an integration: what was reached after each, the start first.

    Attributes
    ----------
    rows : (1 + carried, steps + 1), the times first
    ended : one of the ends of a motion
    cause : sentence that says why it ended before its duration; None where it did not
    attempts : steps tried
    events, detours : near misses and crossings; pieces of motion around the change points that were passed
    transitions : of a motion with contacts or conditions, that at the start first
    between : times -> what is carried, of an implicit scheme; None where a step of the scheme itself gives it
    """

    rows: Array
    ended: str
    cause: str | None
    attempts: int
    events: tuple[Event, ...] = ()
    detours: tuple[Detour, ...] = ()
    transitions: tuple[Transition, ...] = ()
    between: Callable[[Array], Array] | None = None
