"""Turns of links about change points where these turn fast.

The nearer the crank of an antiparallelogram comes to the length of its frame, the faster its rocker turns at a change
point: nearly a full turn may lie between two nodes of the mesh. About such change points turns are counted from place
to place, and the places stand the closer the nearer they are to the change point: the turn of a link between two of
them stays below a quarter, as the motion is analytic within some widths of the stretch on which a series gives it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.kinematics.change_points import BranchedPlan, Smooth
from centrode.kinematics.plan_evaluation import ReachedRadicand
from centrode.kinematics.stretches import ParameterStretch, TurnedStretch
from centrode.numerics.arrays import ARRAYS
from centrode.structure.constraints import Positions
from centrode.structure.dimensions import Dimensions

Array: TypeAlias = npt.NDArray[np.float64]
Lanes: TypeAlias = npt.NDArray[np.intp]
Number: TypeAlias = Any
Namespace: TypeAlias = Any

NARROW = 2.0
"""Circles of series below this many steps of the mesh: beyond, no link makes a quarter of a turn within a step."""
AROUND = 2.0
"""Steps of the mesh about a change point in which turns are counted from place to place."""


@dataclass(frozen=True)
class QuickTurns:
    """The stretches of a plan on which links turn fast.

    They lie about change points of the groups before `end`, and of others whose events are known already.
    """

    continuation: BranchedPlan
    mesh: Array
    end: int

    @cached_property
    def stretches(self) -> list[ParameterStretch]:
        """Stretches of the path, one for each change point, or for several that are next to each other."""
        places: dict[int, list[tuple[float, float]]] = {}
        for group in range(len(self.continuation.kinematics.structure.groups)):
            # groups at or behind `end` are still being searched
            known = group < self.end or self.continuation.has_windows(group)
            windows = self.continuation.windows_of(group) if known else None
            if windows is None:
                continue
            node = np.clip(np.searchsorted(self.mesh, windows.centre) - 1, 0, len(self.mesh) - 2)
            # a wide circle means that nothing turns fast
            narrow = (windows.radius > 0.0) & (windows.radius < NARROW * np.diff(self.mesh)[node])
            narrow &= (windows.centre > self.mesh[0]) & (windows.centre < self.mesh[-1])
            for lane, centre, half in zip(
                windows.lane[narrow], windows.centre[narrow], windows.half[narrow], strict=True
            ):
                places.setdefault(int(lane), []).append((float(centre), float(half)))
        return [stretch for lane in sorted(places) for stretch in _stretches(lane, places[lane], self.mesh)]

    @property
    def _lanes(self) -> Lanes:
        return np.concatenate([np.full(len(s.places), s.lane, dtype=np.intp) for s in self.stretches])

    @property
    def _parameter(self) -> Array:
        return np.concatenate([s.places for s in self.stretches])

    @cached_property
    def _positions(self) -> tuple[Positions, Dimensions]:
        kinematics = self.continuation.kinematics.take(self._lanes)
        with np.errstate(all="ignore"):
            hooks = self.continuation.hooks(ARRAYS, self._parameter, self._lanes)
            return kinematics.positions(ARRAYS, self._parameter, hooks), kinematics.numbers

    def measure(self, angle: Callable[[Dimensions, Positions], Number]) -> list[TurnedStretch]:
        """Turns of an angle on the stretches, from a function that gives it in (-pi, pi]."""
        if not self.stretches:
            return []
        at, numbers = self._positions
        return self._divide_stretches(angle(numbers, at))

    def in_plan(self, group: int, key: str) -> list[TurnedStretch]:
        """Turns on the stretches of an angle that a group of the plan itself counts."""
        if not self.stretches:
            return []
        kinematics = self.continuation.kinematics.take(self._lanes)
        hooks = _Counted(self.continuation, ARRAYS, self._parameter, self._lanes, group, key)
        try:
            with np.errstate(all="ignore"):
                kinematics.positions(ARRAYS, self._parameter, hooks)
        except ReachedRadicand as reached:
            return self._divide_stretches(reached.value)
        return []

    def _divide_stretches(self, angle: Number) -> list[TurnedStretch]:
        ends = np.cumsum([len(s.places) for s in self.stretches])
        angles = np.split(np.broadcast_to(angle, (ends[-1],)), ends[:-1])
        return [TurnedStretch.of(s, part) for s, part in zip(self.stretches, angles, strict=True)]


class _Counted(Smooth):
    """Carries an angle that a group counts out of the evaluation of a plan."""

    def __init__(
        self,
        continuation: BranchedPlan,
        m: Namespace,
        parameter: Array,
        lanes: Lanes,
        group: int,
        key: str,
    ) -> None:
        super().__init__(continuation, m, parameter, lanes)
        self.group, self.key = group, key

    def continue_angle(self, group: int, key: str, angle: Number) -> Number:
        if (group, key) == (self.group, self.key):
            raise ReachedRadicand(angle)
        return super().continue_angle(group, key, angle)


def _stretches(lane: int, windows: list[tuple[float, float]], mesh: Array) -> list[ParameterStretch]:
    """The stretches about windows (centre, half width) of one mechanism; those that meet are one."""
    pieces: list[tuple[int, int, list[float]]] = []
    for centre, half in sorted(windows):
        node = min(max(int(np.searchsorted(mesh, centre)) - 1, 0), len(mesh) - 2)
        wide = AROUND * float(mesh[node + 1] - mesh[node])
        first = max(int(np.searchsorted(mesh, centre - wide)) - 1, 0)
        last = min(int(np.searchsorted(mesh, centre + wide)), len(mesh) - 1)
        # halved from the width of two steps down to half the window: places in a geometric series
        graded = half * 2.0 ** np.arange(-1.0, np.ceil(np.log2(wide / half)) + 1.0)
        inner = [centre, *(centre - graded), *(centre + graded)]
        # stretches that overlap have to be one, or turns would be put in twice
        if pieces and first <= pieces[-1][1]:
            before = pieces.pop()
            first, last, inner = before[0], max(last, before[1]), before[2] + inner
        pieces.append((first, last, inner))
    stretches = []
    # nodes of the mesh are kept, as turns are put in between them
    for first, last, inner in pieces:
        nodes = mesh[first : last + 1]
        between = [x for x in inner if nodes[0] < x < nodes[-1]]
        places = np.unique(np.concatenate([nodes, between]))
        stretches.append(ParameterStretch(lane, places, first, np.searchsorted(places, nodes)))
    return stretches
