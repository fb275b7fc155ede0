"""A plan with its signs, run smoothly through change points.

Next to a change point the closed forms of its group lose digits, while the motion itself is smooth. There the
group's points and links are interpolated from nodes on both sides, value and derivatives each (barycentric
formula; Berrut and Trefethen, SIAM Review 46, 2004), before the groups behind it are solved, so that these
and their radicands stand on good ground. The nodes belong to the change point: the result depends on the
drive's value alone.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.jets import Jet
from centrode.algebra.rounding import ROUNDED, Rounded
from centrode.kinematics.branches import Branches
from centrode.kinematics.evaluate import Hooks, Kinematics
from centrode.kinematics.higher_class.places import Judged, close, starts
from centrode.kinematics.higher_class.surroundings import Surroundings
from centrode.kinematics.higher_class.tracing import trace
from centrode.kinematics.higher_class.tracks import Tracks
from centrode.kinematics.mending import (
    NODES,
    WEIGHTS,
    Index,
    Windows,
    finite,
    inside,
    mended,
    numbers_of,
    set_numbers,
)
from centrode.kinematics.paths import JETS
from centrode.structure.dimensions import Dimensions
from centrode.structure.groups import Newton
from centrode.structure.positions import Positions

Array: TypeAlias = npt.NDArray[np.float64]
Lanes: TypeAlias = npt.NDArray[np.intp]
Number: TypeAlias = Any
Namespace: TypeAlias = Any

WINDOW = 0.04
"""Half width of the mended stretch, in the path's units (rad for an angle)."""
CLEAR = 6.0
"""The stretch keeps this many half widths away from what is not smooth: limits, other events of its group."""
CLEAR_OF_HIGHER = 10.0
"""The same for a group of higher class, which loses fewer digits: as much as one of its distance, not of its square."""
REACH = 2.0 * WINDOW + CLEAR * WINDOW
"""How far beyond a sample events matter to it."""


@dataclass
class Continuation:
    """Kinematics with branches: evaluates what the signs and the change points found so far allow."""

    kinematics: Kinematics
    branches: Branches
    start: Positions
    nominal: Dimensions
    order: int = 2
    """Derivatives that interpolated stretches carry."""
    _tracks: dict[int, Tracks] = field(default_factory=dict)
    _windows: dict[int, Windows | None] = field(default_factory=dict)
    _known: dict[tuple[int, bool], list[Number]] = field(default_factory=dict)

    def hooks(self, m: Namespace, parameter: Array, lanes: Lanes | None) -> Smooth:
        """What runs the plan over any algebra at parameters: (n,) for all lanes, or one lane for each."""
        return Smooth(self, m, parameter, lanes)

    def trace(self, group: int, extent: tuple[float, float]) -> None:
        """Follow a group of higher class from the initial position over an extent of the path."""
        around, branches = self._around(group), self.branches
        first = starts(around, self.nominal, self.start, branches.initial, branches.lanes)
        with np.errstate(all="ignore"):
            self._tracks[group], events = trace(
                around, first, branches.initial, extent, branches.reaches(), branches.smooth
            )
        branches.add(group, events)

    def close(
        self,
        group: int,
        m: Namespace,
        at: Positions,
        parameter: Array,
        lanes: Lanes | None,
        rough: bool = False,
    ) -> Judged:
        """Add what a group of higher class gives at parameters."""
        return close(self._around(group), self._tracks[group], m, at, parameter, lanes, rough)

    def _around(self, group: int) -> Surroundings:
        return Surroundings(self.kinematics, group, self.hooks)

    def mend(self, group: int, at: Positions, parameter: Array, lanes: Lanes | None) -> list[Index]:
        """Interpolate what a group gives wherever a change point of it is near; returns where that was."""
        windows = self.windows_of(group)
        if windows is None:
            return []
        shape = (self.branches.lanes, parameter.shape[-1]) if lanes is None else parameter.shape
        index, chosen = inside(windows, parameter.reshape(-1), lanes)
        if not len(chosen):
            return []
        bounded = any(isinstance(number, Rounded) for number in numbers_of(self.kinematics, group, at))
        known = self._at_nodes(group, bounded)
        whole = finite(known, len(windows))[chosen]
        if not whole.all():  # another event lies inside some: the closed form has to do there
            index, chosen = tuple(part[whole] for part in index), chosen[whole]
        along = parameter.reshape(-1)[index[-1]]
        basis = WEIGHTS / (((along - windows.centre[chosen]) / windows.half[chosen])[:, None] - NODES)
        basis /= basis.sum(axis=1, keepdims=True)
        numbers = numbers_of(self.kinematics, group, at)
        smooth = [
            mended(old, node, shape, index, chosen, basis) for old, node in zip(numbers, known, strict=True)
        ]
        set_numbers(self.kinematics, group, at, smooth)
        return [index]

    def windows_of(self, group: int) -> Windows | None:
        """The stretches on which a group is interpolated, once its events are known; None if there are none."""
        if not self.branches.smooth:
            return None
        if group not in self._windows:
            self._windows[group] = self._found_windows(group)
        return self._windows[group]

    def _found_windows(self, group: int) -> Windows | None:
        events = self.branches.events
        centres = [event for event in events if event.group == group and event.kind == "change point"]
        if not centres:
            return None
        bounds: dict[int, list[float]] = {event.lane: [] for event in centres}
        for event in events:
            if event.lane in bounds and (
                event.group == group or (event.group < group and event.kind == "limit")
            ):
                bounds[event.lane].append(event.at)
        return Windows(
            np.array([event.lane for event in centres], dtype=np.intp),
            np.array([event.at for event in centres]),
            np.array([self._half_width(group, event.at, bounds[event.lane]) for event in centres]),
        )

    def _half_width(self, group: int, at: float, bounds: list[float]) -> float:
        """Limits of the groups before it and all events of its own bound the stretch on which a group is smooth."""
        unit = self.kinematics.path.unit_at(at)
        others = [abs(bound - at) for bound in bounds if abs(bound - at) > 1e-9 * unit]
        higher = isinstance(self.kinematics.structure.groups[group], Newton)
        return min(WINDOW * unit, min(others, default=np.inf) / (CLEAR_OF_HIGHER if higher else CLEAR))

    def _at_nodes(self, group: int, bounded: bool) -> list[Number]:
        """What a group gives at the nodes of all its windows, as jets or with bounds: arrays (windows * nodes,)."""
        key = (group, bounded)
        if key not in self._known:
            windows = self.windows_of(group)
            assert windows is not None
            lanes = np.repeat(windows.lane, len(NODES))
            nodes = (windows.centre[:, None] + windows.half[:, None] * NODES).reshape(-1)
            m: Namespace = ROUNDED if bounded else JETS
            lifted: Number = Rounded.of(nodes) if bounded else Jet.variable(nodes, self.order)
            used = self.kinematics.taken(lanes)
            at = used.frame(m, lifted)
            with np.errstate(all="ignore"):
                used.advance(at, range(group + 1), m, self.hooks(m, nodes, lanes))
            self._known[key] = numbers_of(self.kinematics, group, at)
        return self._known[key]


class Smooth(Hooks):
    """Signs as the branches have them, and every group mended near its change points."""

    def __init__(
        self, continuation: Continuation, m: Namespace, parameter: Array, lanes: Lanes | None
    ) -> None:
        self.continuation = continuation
        self.m = m
        self.parameter = parameter
        self.lanes = lanes

    def root(self, group: int, radicand: Number) -> Number:
        return self.m.sqrt(radicand) * self.continuation.branches.sign(group, self.parameter, self.lanes)

    def higher(self, group: int, m: Namespace, at: Positions) -> None:
        self.judge(group, self.continuation.close(group, m, at, self.parameter, self.lanes))

    def judge(self, group: int, judged: Judged) -> None:
        """Look at where a group of higher class is not what it should be."""

    def continued(self, group: int, key: str, angle: Number) -> Number:
        # not counted yet: the group itself is still being searched, and nothing behind it is asked for
        turns = self.continuation.branches.turns.get(key)
        return angle if turns is None else turns.continued(angle, self.parameter, self.lanes)

    def after(self, group: int, at: Positions) -> None:
        self.continuation.mend(group, at, self.parameter, self.lanes)


class Rough(Smooth):
    """The same for the mesh, on which places are looked at and not kept."""

    def higher(self, group: int, m: Namespace, at: Positions) -> None:
        self.judge(group, self.continuation.close(group, m, at, self.parameter, self.lanes, rough=True))
