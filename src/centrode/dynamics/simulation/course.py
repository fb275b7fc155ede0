"""What a simulation has found: the drive's value, rate and works at any time, and what happened on the way."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Literal, TypeAlias

import numpy as np
import numpy.typing as npt

Array: TypeAlias = npt.NDArray[np.float64]

VALUE, RATE, OF_DRIVE, OF_FRICTION, OF_OTHERS = range(5)
STATES = 5
"""The drive's value and rate, and the works of drive, friction and other loads from the start."""

Ending = Literal["duration", "turns", "limit", "standstill", "interrupted", "change point"]
OCCASIONS = ("turns back", "sticks", "breaks loose", "limit", "standstill", "change point")
"""What may happen besides: a change of sense, rest held by friction, its end, and three ways to end."""


@dataclass(frozen=True)
class Occasion:
    """Something that happened at a time [s] and a value of the drive."""

    kind: str
    time: float
    value: float


@dataclass(frozen=True)
class Piece:
    """A piece of the course: `at` gives states (STATES, n) at times between its ends."""

    first: float
    last: float
    at: Callable[[Array], Array]
    sense: float


@dataclass
class Course:
    """Pieces one after another, and how it ended.

    Attributes
    ----------
    pieces : in time
    occasions : in time
    ended : why it ended
    evaluations : how often the accelerations were computed
    """

    pieces: list[Piece] = field(default_factory=list)
    occasions: list[Occasion] = field(default_factory=list)
    ended: Ending = "duration"
    evaluations: int = 0
    scheme: str = ""
    executor: str = "arrays"

    @property
    def first(self) -> float:
        """Time of the beginning [s]."""
        return self.pieces[0].first

    @property
    def last(self) -> float:
        """Time of the end [s]."""
        return self.pieces[-1].last

    def at(self, times: Array) -> tuple[Array, Array]:
        """States (STATES, n) at growing times, and the sense of the motion (n): 0.0 where it rests."""
        found, senses = np.empty((STATES, len(times))), np.empty(len(times))
        ends = [piece.last for piece in self.pieces]
        which = np.array([min(bisect_left(ends, t), len(ends) - 1) for t in times], dtype=np.intp)
        for k in np.unique(which):
            some = which == k
            found[:, some], senses[some] = self.pieces[k].at(times[some]), self.pieces[k].sense
        return found, senses
