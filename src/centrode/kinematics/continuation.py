"""A plan with its signs, run smoothly through change points.

Next to a change point the closed forms of its group lose digits, while the motion itself is analytic. There the
group's points and links are given by their power series about the change point (see `mending`), before the groups
behind it are solved, so that these and their radicands stand on good ground. A series rests on positions at complex
values around the change point, and its circle shrinks until it holds no singularity: where the group turns fast the
circle is small. The circle belongs to the change point: the result depends on the drive's value alone.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.arrays import ARRAYS
from centrode.algebra.rounding import ROUNDED, Rounded
from centrode.kinematics.branches import Branches
from centrode.kinematics.evaluate import Hooks, Kinematics
from centrode.kinematics.higher_class.places import Judged, close, follow, starts
from centrode.kinematics.higher_class.surroundings import Surroundings
from centrode.kinematics.higher_class.tracing import trace
from centrode.kinematics.higher_class.tracks import Tracks
from centrode.kinematics.mending import (
    HALF_CIRCLE,
    TERMS,
    Index,
    Series,
    Windows,
    coefficients,
    inside,
    mended,
    numbers_of,
    set_numbers,
)
from centrode.structure.dimensions import Dimensions
from centrode.structure.positions import Positions

Array: TypeAlias = npt.NDArray[np.float64]
Lanes: TypeAlias = npt.NDArray[np.intp]
Mask: TypeAlias = npt.NDArray[np.bool_]
Number: TypeAlias = Any
Namespace: TypeAlias = Any

TURN = 2.0 * np.pi
WINDOW = 0.04
"""Greatest half width of a stretch with a series, in the path's units (rad for an angle)."""
CIRCLE = 2.0 * WINDOW
"""Greatest radius of the circle that a series rests on."""
SHARE = 0.75
"""Greatest half width in units of the radius: towards the circle itself the derivatives of a series lose digits."""
LEAST_CIRCLE = 1e-10
"""Radius below which a series is given up, in the path's units: rounding leaves nothing of such a circle."""
SHRINKING, GROWING = 0.25, 2.0**0.5
"""A circle shrinks by great steps until it holds no singularity, then it grows by small ones."""
REACH = 0.32
"""How far beyond a sample events matter to it, in the path's units."""


@dataclass
class Continuation:
    """Kinematics with branches: evaluates what the signs and the change points found so far allow."""

    kinematics: Kinematics
    branches: Branches
    start: Positions
    nominal: Dimensions
    _tracks: dict[int, Tracks] = field(default_factory=dict)
    _windows: dict[int, Windows | None] = field(default_factory=dict)
    _series: dict[int, Series] = field(default_factory=dict)

    def hooks(self, m: Namespace, parameter: Array, lanes: Lanes | None) -> Smooth:
        """What runs the plan over any algebra at parameters: (n,) for all lanes, or one lane for each."""
        return Smooth(self, m, parameter, lanes)

    def trace(self, group: int, extent: tuple[float, float]) -> None:
        """Follow a group of higher class from the initial position over an extent of the path."""
        around, branches = self._surroundings(group), self.branches
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
        return close(self._surroundings(group), self._tracks[group], m, at, parameter, lanes, rough)

    def _surroundings(self, group: int) -> Surroundings:
        return Surroundings(self.kinematics, group, self.hooks)

    def follow(self, group: int, at: Positions, parameter: Array, lanes: Lanes, steps: int) -> None:
        """Add what a group of higher class gives along ways of complex parameters that begin with a real one."""
        follow(self._surroundings(group), self._tracks[group], at, parameter, lanes, steps)

    def mend(self, group: int, at: Positions, parameter: Array, lanes: Lanes | None) -> list[Index]:
        """Give what a group gives by its series wherever a change point of it is near; returns where that was.

        Parameters may be complex where there is one lane for each.
        """
        windows = self.windows_of(group)
        if windows is None:
            return []
        shape = (self.branches.lanes, parameter.shape[-1]) if lanes is None else parameter.shape
        index, chosen = inside(windows, parameter.reshape(-1), lanes)
        if not len(chosen):
            return []
        along, series = parameter.reshape(-1)[index[-1]], self._series[group]
        smooth = [
            mended(old, known, bound, windows, shape, index, chosen, along)
            for old, known, bound in zip(
                numbers_of(self.kinematics, group, at), series.numbers, series.bounds, strict=True
            )
        ]
        set_numbers(self.kinematics, group, at, smooth)
        return [index]

    def windows_of(self, group: int) -> Windows | None:
        """The stretches on which a group is given by series, once its events are known; None if there are none."""
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
        limits: dict[int, list[float]] = {event.lane: [] for event in centres}
        for event in events:
            if event.lane in limits and event.group <= group and event.kind == "limit":
                limits[event.lane].append(event.at)
        units = np.array([self.kinematics.path.unit_at(event.at) for event in centres])
        nearest = [
            min((abs(at - event.at) for at in limits[event.lane]), default=np.inf) for event in centres
        ]
        at = np.array([event.at for event in centres])
        lanes = np.array([event.lane for event in centres], dtype=np.intp)
        widest = np.minimum(CIRCLE * units, nearest)  # at a limit the motion is not analytic
        windows, self._series[group] = self._with_circles(group, Windows(lanes, at, WINDOW * units, widest))
        return windows

    def _with_circles(self, group: int, windows: Windows) -> tuple[Windows, Series]:
        """The windows with the greatest circles that hold no singularity, and the series that rest on these."""
        least = LEAST_CIRCLE / CIRCLE * windows.half
        radius, best = windows.radius.copy(), np.zeros(len(windows))
        series: Series | None = None
        trying, growing = np.arange(len(windows)), np.zeros(len(windows), dtype=bool)
        while len(trying):
            tried = replace(windows.of(trying), radius=radius[trying])
            found, whole = self._around(group, tried)
            series = found.put(series, trying[whole], whole, len(windows))
            best[trying[whole]] = radius[trying[whole]]
            going = np.where(
                whole,
                radius[trying] < windows.radius[trying],
                ~growing[trying] & (radius[trying] > least[trying]),
            )
            growing[trying] |= whole
            radius[trying] *= np.where(whole, GROWING, SHRINKING)
            trying = trying[going]
            radius = np.minimum(radius, windows.radius)
        assert series is not None
        return replace(
            windows, half=np.minimum(windows.half, SHARE * best), radius=best
        ), series.without_rounding()

    def _around(self, group: int, windows: Windows) -> tuple[Series, Mask]:
        """What a group gives on circles, as series, and which circles hold no singularity."""
        count, nodes = len(windows), len(HALF_CIRCLE)
        lanes = np.repeat(windows.lane, nodes)
        along = (windows.centre[:, None] + windows.radius[:, None] * HALF_CIRCLE).reshape(-1)
        used = self.kinematics.taken(lanes)
        hooks = Circling(self, along, lanes, group)
        ends = (windows.centre[:, None] + windows.radius[:, None] * np.array([1.0, -1.0])).reshape(-1)
        at_ends = self.kinematics.taken(both := np.repeat(windows.lane, 2))
        with np.errstate(all="ignore"):
            at = used.frame(ARRAYS, along)
            used.advance(at, range(group + 1), ARRAYS, hooks)
            bounded = at_ends.frame(ROUNDED, Rounded.of(ends))
            at_ends.advance(bounded, range(group + 1), ROUNDED, Unmended(self, ROUNDED, ends, both, group))
            numbers = [coefficients(x, count) for x in numbers_of(self.kinematics, group, at)]
            bounds = [
                np.max(np.broadcast_to(Rounded.of(x).bound, ends.shape).reshape(count, 2), axis=1)
                for x in numbers_of(self.kinematics, group, bounded)
            ]
        whole = hooks.whole
        for number, bound in zip(numbers, bounds, strict=True):
            whole = whole & (np.max(np.abs(number[:, TERMS:]), axis=1) <= bound)
        return Series([number[:, :TERMS] for number in numbers], bounds), whole


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


class Unmended(Smooth):
    """The same without the series of a group: what its own closed form gives beside a change point."""

    def __init__(
        self, continuation: Continuation, m: Namespace, parameter: Array, lanes: Lanes | None, group: int
    ) -> None:
        super().__init__(continuation, m, parameter, lanes)
        self.group = group

    def after(self, group: int, at: Positions) -> None:
        if group != self.group:
            super().after(group, at)


class Circling(Unmended):
    """Positions on half circles about change points of a group, followed from their real beginnings.

    Roots, angles and groups of higher class go on along a half circle from one value to the next. At its end they have
    to be where the motion is.
    """

    def __init__(self, continuation: Continuation, parameter: Array, lanes: Lanes, group: int) -> None:
        super().__init__(continuation, ARRAYS, parameter, lanes, group)
        self.which = lanes
        self.circles = (-1, len(HALF_CIRCLE))
        self.whole = np.ones(len(lanes) // len(HALF_CIRCLE), dtype=bool)
        """Circles on which everything is where it has to be."""

    def root(self, group: int, radicand: Number) -> Number:
        root = self._on_circles(np.sqrt(radicand + 0j))
        real = self.continuation.branches.sign(group, self.parameter.real, self.lanes).reshape(self.circles)
        turned = np.where((root[:, 1:] * root[:, :-1].conj()).real < 0.0, -1.0, 1.0)
        signs = np.cumprod(np.concatenate([real[:, :1], turned], axis=1), axis=1)
        self.whole &= signs[:, -1] == real[:, -1]
        return (root * signs).reshape(-1)

    def higher(self, group: int, m: Namespace, at: Positions) -> None:
        self.continuation.follow(group, at, self.parameter, self.which, self.circles[1])

    def continued(self, group: int, key: str, angle: Number) -> Number:
        angle = self._on_circles(angle)
        steps = np.round((angle[:, :-1] - angle[:, 1:]).real / TURN)
        whole = np.concatenate([np.zeros((len(angle), 1)), np.cumsum(steps, axis=1)], axis=1)
        turns = self.continuation.branches.turns[key]
        real = [
            turns.continued(
                angle[:, k].real,
                self.parameter.reshape(self.circles)[:, k].real,
                self.which[:: self.circles[1]],
            )
            for k in (0, -1)
        ]
        followed = angle + TURN * whole
        followed += (np.round((real[0] - followed[:, 0].real) / TURN) * TURN)[:, None]
        self.whole &= np.abs(followed[:, -1].real - real[1]) < 0.5 * TURN
        return followed.reshape(-1)

    def _on_circles(self, number: Number) -> Any:
        return np.broadcast_to(number, self.parameter.shape).reshape(self.circles)


class Rough(Smooth):
    """The same for the mesh, on which places are looked at and not kept."""

    def higher(self, group: int, m: Namespace, at: Positions) -> None:
        self.judge(group, self.continuation.close(group, m, at, self.parameter, self.lanes, rough=True))
