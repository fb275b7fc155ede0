"""Groups of higher class that stand after whole turns of the drive as they began.

Where the drive is an angle, how the mechanism goes on depends on where everything stands, and not on the turns
made: two drives' values whole turns apart, with everything before a group and the group itself in the same places,
are followed by the same curve. So a curve that has come back to a place near its beginning is closed: it repeats
itself, and only angles grow, by whole turns.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import tau
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.kinematics.branches import Event
from centrode.kinematics.higher_class.newton import SMALL, newton
from centrode.kinematics.higher_class.surroundings import Surroundings, needed
from centrode.kinematics.higher_class.system import total
from centrode.kinematics.higher_class.tracks import Period, Tracks, share_at
from centrode.structure.constraints import Positions

Array: TypeAlias = npt.NDArray[np.float64]
Lanes: TypeAlias = npt.NDArray[np.intp]
Mask: TypeAlias = npt.NDArray[np.bool_]

BEHIND = 0.1
"""How far [rad] behind the beginning of a turn a group is compared with itself: at the very start both assemblies of
a dyad may meet. The mesh reaches further beyond what is asked for, so it does not decide whether a curve is closed."""


@dataclass
class Rounds:
    """Walkers along curves, and the places, one a turn, at which they may have come round.

    Attributes
    ----------
    passed : such places that each walker has passed
    begun : states (k, width) at the first of these
    """

    around: Surroundings
    lane: Lanes
    forward: Array
    initial: float
    begun: Array
    passed: Lanes

    @classmethod
    def of(cls, around: Surroundings, lane: Lanes, forward: Array, initial: float, width: int) -> Rounds:
        """Walkers that set out."""
        begun = np.full((len(lane), width), np.nan)
        return cls(around, lane, forward, initial, begun, np.zeros(len(lane), dtype=np.intp))

    def closed(
        self, who: Lanes, origin: Array, pieces: Array, reached: Array
    ) -> list[tuple[np.intp, Period]]:
        """Walkers that have come round, of those whose last pieces brought them from an origin to what is reached."""
        if not self.around.kinematics.path.turns:
            return []
        places = self._place(who, self.passed[who])
        passing = self.forward[who] * (reached - places) >= 0.0
        if not passing.any():
            return []
        who, places, last = who[passing], places[passing], pieces[passing]
        ways = np.ascontiguousarray(last[:, :, -1].T)
        share = share_at(ways, np.arange(len(who)), places - origin[passing])
        return self._met(who, places, total(last * (share[:, None] ** np.arange(6))[:, :, None])[:, :-1])

    def _met(self, who: Lanes, places: Array, foretold: Array) -> list[tuple[np.intp, Period]]:
        """Walkers that stand at their next places as they stood at their first; the next places move on."""
        lane, turns = self.lane[who], self.passed[who]
        self.passed[who] += 1
        before = self.around.before(places, lane)
        system = self.around.system(needed(self.around.equations, before), lane)
        found = newton(system, system.righted(foretold))
        state = np.where(found.found[:, None], found.state, np.nan)
        first = turns == 0
        self.begun[who[first]] = state[first]
        grown = state - self.begun[who]
        whole = np.zeros(grown.shape)
        angles = slice(grown.shape[1] - system.turning, None)
        whole[:, angles] = tau * np.round(grown[:, angles] / tau)
        with np.errstate(invalid="ignore"):
            met = np.max(np.abs(grown - whole) * system.weights(), axis=1) <= SMALL
        met &= ~first & self._alike(before, self.around.before(self._place(who, 0 * turns), lane), lane)
        return [(who[k], Period(tau * float(turns[k]), whole[k])) for k in np.nonzero(met)[0]]

    def _place(self, who: Lanes, turns: Lanes) -> Array:
        return np.asarray(self.initial + self.forward[who] * (BEHIND + tau * turns), dtype=np.float64)

    def _alike(self, one: Positions, other: Positions, lane: Lanes) -> Mask:
        """Where everything before the group stands alike, but for what Newton's method does not tell apart."""
        over = 1.0 / self.around.kinematics.taken(lane).numbers.scale
        gap = np.zeros(len(lane))
        for name, place in one.points.items():
            for x, y in zip(place, other.points[name], strict=True):
                gap = np.maximum(gap, np.abs(x - y) * over)
        for name, pose in one.poses.items():
            for part, vector in pose._asdict().items():
                unit = over if part == "origin" else 1.0
                for x, y in zip(vector, getattr(other.poses[name], part), strict=True):
                    gap = np.maximum(gap, np.abs(x - y) * unit)
        return np.asarray(gap <= SMALL)


def repeated(event: Event, tracks: Tracks, extent: tuple[float, float]) -> list[Event]:
    """An event of the first round of a closed curve on all rounds of an extent; any other alone."""
    side = int(event.at > tracks.initial)
    period, away = float(tracks.period[event.lane, side]), abs(event.at - tracks.initial)
    if not np.isfinite(period):
        return [event]
    if away > period:
        return []  # found behind the end of the round, it is one of its beginning
    rounds = int(max(0.0, abs(extent[side] - tracks.initial) - away) // period)
    step = period if side else -period
    return [replace(event, at=event.at + k * step) for k in range(rounds + 1)]
