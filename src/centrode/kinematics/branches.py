"""The branch as data: signs of the groups as functions of the drive, with the events that bound and flip them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.kinematics.counted_turns import Turns
from centrode.kinematics.paths import Path

Array: TypeAlias = npt.NDArray[np.float64]

AT_THE_START = 1e-9
"""A change point this close to the initial position (in the path's units) counts as lying just behind it."""


@dataclass(frozen=True)
class Event:
    """A place on the path where a group's radicand is zero.

    At a limit the mechanism locks; at a change point the two assemblies of a group meet and cross.
    """

    kind: Literal["limit", "change point"]
    group: int
    lane: int
    at: float
    closes_above: bool | None = None
    """Of a limit: whether the group closes above it or below; None where it closes on both sides."""


@dataclass
class Branches:
    """Signs of all groups along the path, for a batch of mechanisms.

    Attributes
    ----------
    signs : group -> (lanes,) array of +1 or -1: at the initial position
    events : found so far, in plan order
    crossings : group -> (lanes, k) change points, padded with NaN
    largest : group -> (lanes,) greatest radicand on the mesh
    angles : link, or bearing of a rolling wheel -> its angle [rad] in the initial position
    turns : the same -> how it runs on over turns, once it is found
    smooth : whether signs flip at change points ("smooth") or stay ("keep")
    """

    initial: float
    forward: float
    unit: float
    lanes: int
    signs: dict[int, Array]
    smooth: bool
    angles: Mapping[str, float] = field(default_factory=dict)
    turns: dict[str, Turns] = field(default_factory=dict)
    events: list[Event] = field(default_factory=list)
    crossings: dict[int, Array] = field(default_factory=dict)
    largest: dict[int, Array] = field(default_factory=dict)

    def add(self, group: int, events: Sequence[Event]) -> None:
        """Record the events of a group; its sign is asked for only afterwards."""
        if not events:
            return
        self.events += sorted(events, key=lambda event: (event.lane, event.at))
        per_lane: list[list[float]] = [[] for _ in range(self.lanes)]
        for event in self.events:
            if event.group == group and event.kind == "change point":
                per_lane[event.lane].append(self._behind_start(event.at))
        width = max((len(found) for found in per_lane), default=0)
        if width:
            table = np.full((self.lanes, width), np.nan)
            for lane, found in enumerate(per_lane):
                table[lane, : len(found)] = found
            self.crossings[group] = table

    def _behind_start(self, at: float) -> float:
        # a given side holds from the start onwards: a crossing at the start itself belongs to what lies behind
        margin = AT_THE_START * self.unit
        return self.initial - self.forward * margin if abs(at - self.initial) <= margin else at

    def sign(self, group: int, parameter: Array, lanes: npt.NDArray[np.intp] | None = None) -> Array:
        """Sign of a group at parameters: shape (lanes, n), or (k,) with a lane for each entry."""
        base = self.signs[group]
        base = base[:, None] if lanes is None else base[lanes]
        crossings = self.crossings.get(group)
        if crossings is None or not self.smooth:
            return np.broadcast_to(base, np.broadcast_shapes(base.shape, np.shape(parameter)))
        table = crossings[:, None, :] if lanes is None else crossings[lanes]
        low = np.minimum(parameter, self.initial)[..., None]
        high = np.maximum(parameter, self.initial)[..., None]
        between = ((table > low) & (table < high)).sum(axis=-1)
        return np.asarray(base * (1.0 - 2.0 * (between % 2)))

    def reach(self, lane: int) -> tuple[float, float]:
        """Nearest limits on both sides of the initial position; infinite where there is none."""
        low, high = self.reaches()[lane]
        return float(low), float(high)

    def reaches(self) -> Array:
        """Nearest limits of every mechanism: shape (lanes, 2)."""
        found = np.full((self.lanes, 2), (-np.inf, np.inf))
        for event in self.events:
            if event.kind == "limit":
                side = 0 if self._is_below(event) else 1
                nearer = max if side == 0 else min
                found[event.lane, side] = nearer(float(found[event.lane, side]), event.at)
        return found

    def _is_below(self, limit: Event) -> bool:
        """Whether a limit bounds the reach from below; one at the start itself bounds the side that does not close."""
        if limit.closes_above is not None and abs(limit.at - self.initial) <= AT_THE_START * self.unit:
            return limit.closes_above
        return limit.at <= self.initial


def branches_at_start(
    path: Path, signs: Mapping[int, float], angles: Mapping[str, float], smooth: bool, lanes: int = 1
) -> Branches:
    """Signs and angles in the initial position, before any event is known."""
    first = {group: np.full(lanes, sign) for group, sign in signs.items()}
    unit = path.unit_at(path.initial)
    return Branches(path.initial, path.forward, unit, lanes, first, smooth, angles)
