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
from centrode.structure.constraints import Positions
from centrode.structure.dimensions import Dimensions

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
LOST = 1e-3
"""Greatest rounding error on a circle that has shrunk, of the number that moves most, in units of its motion."""
BARE = 4e-3
"""Half width, in the path's units, without derivatives where there is no series: rounding is 1e-16 over its cube."""
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

    def series_of(self, group: int) -> Series:
        """The series of a group on its stretches, which `windows_of` has found."""
        return self._series[group]

    def has_windows(self, group: int) -> bool:
        """Whether the stretches of a group are known already; its events are, then."""
        return group in self._windows

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
        """The windows with the greatest circles that hold no singularity, and the series that rest on these.

        As given, windows have their greatest half width, which is `WINDOW` units of the path, and greatest radius.
        """
        count, radius = len(windows), windows.radius.copy()
        best, growing = np.zeros(count), np.zeros(count, dtype=bool)
        series: Series | None = None
        trying = np.arange(count)
        while len(trying):
            found, whole = self._around(group, replace(windows.of(trying), radius=radius[trying]))
            series = found.put(series, trying[whole], whole, count)
            best[trying[whole]] = radius[trying[whole]]
            growing[trying[whole]] = True
            # a circle that holds a singularity ends the growing of one that held none before
            larger = whole & (radius[trying] < windows.radius[trying])
            smaller = (
                ~whole & ~growing[trying] & (radius[trying] > LEAST_CIRCLE / WINDOW * windows.half[trying])
            )
            radius[trying] = np.minimum(
                radius[trying] * np.where(whole, GROWING, SHRINKING), windows.radius[trying]
            )
            trying = trying[larger | smaller]
        assert series is not None
        half = np.where(best > 0.0, np.minimum(windows.half, SHARE * best), BARE / WINDOW * windows.half)
        return replace(windows, half=half, radius=best), series.without_rounding()

    def _around(self, group: int, windows: Windows) -> tuple[Series, Mask]:
        """What a group gives on circles, as series, and which circles hold no singularity."""
        numbers, followed = self._on_circles(group, windows)
        bounds = self._bounds_on_circles(group, windows)
        whole, lost = followed, np.full(len(windows), np.inf)
        for number, bound in zip(numbers, bounds, strict=True):
            # an analytic function has no negative powers: what is left of them is rounding
            whole = whole & (np.max(np.abs(number[:, TERMS:]), axis=1) <= bound)
            with np.errstate(all="ignore"):
                lost = np.fmin(lost, bound / np.sum(np.abs(number[:, 1:TERMS]), axis=1))
        # on a circle as small as rounding errors everything looks analytic
        shrunk = windows.radius < windows.half
        whole &= ~shrunk | (lost <= LOST)
        return Series([number[:, :TERMS] for number in numbers], bounds), whole

    def _on_circles(self, group: int, windows: Windows) -> tuple[list[Array], Mask]:
        """Coefficients of what a group gives on circles, and on which of these it could be followed."""
        lanes = np.repeat(windows.lane, len(HALF_CIRCLE))
        parameter = (windows.centre[:, None] + windows.radius[:, None] * HALF_CIRCLE).reshape(-1)
        kinematics, hooks = self.kinematics.taken(lanes), Circling(self, parameter, lanes, group)
        with np.errstate(all="ignore"):
            at = kinematics.frame(ARRAYS, parameter)
            kinematics.advance(at, range(group + 1), ARRAYS, hooks)
            numbers = [coefficients(x, len(windows)) for x in numbers_of(kinematics, group, at)]
        return numbers, hooks.followed

    def _bounds_on_circles(self, group: int, windows: Windows) -> list[Array]:
        """Rounding errors of what a group gives on circles: those at the two real values of each (windows,)."""
        lanes = np.repeat(windows.lane, 2)
        ends = (windows.centre[:, None] + windows.radius[:, None] * np.array([1.0, -1.0])).reshape(-1)
        kinematics = self.kinematics.taken(lanes)
        with np.errstate(all="ignore"):
            at = kinematics.frame(ROUNDED, Rounded.of(ends))
            kinematics.advance(at, range(group + 1), ROUNDED, Unmended(self, ROUNDED, ends, lanes, group))
        bounds = [Rounded.of(x).bound for x in numbers_of(kinematics, group, at)]
        return [np.max(np.broadcast_to(x, ends.shape).reshape(-1, 2), axis=1) for x in bounds]


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
    """Positions on half circles about change points of a group, one circle after the other.

    Roots, angles and groups of higher class go on along a half circle from its real beginning, value by value: so they
    stay on one branch, whatever the cuts of complex functions are. At the real end they have to be where the motion is.
    """

    def __init__(self, continuation: Continuation, parameter: Array, lanes: Lanes, group: int) -> None:
        super().__init__(continuation, ARRAYS, parameter, lanes, group)
        self.which = lanes
        self.followed: Mask = np.ones(len(lanes) // len(HALF_CIRCLE), dtype=bool)
        """Circles on which everything ends where the motion is."""

    def root(self, group: int, radicand: Number) -> Number:
        root = self._by_circles(np.sqrt(radicand + 0j))
        real = self._by_circles(self.continuation.branches.sign(group, self.parameter.real, self.which))
        turned = np.where((root[:, 1:] * root[:, :-1].conj()).real < 0.0, -1.0, 1.0)
        signs = np.cumprod(np.concatenate([real[:, :1], turned], axis=1), axis=1)
        self.followed &= signs[:, -1] == real[:, -1]
        return (root * signs).reshape(-1)

    def higher(self, group: int, m: Namespace, at: Positions) -> None:
        self.continuation.follow(group, at, self.parameter, self.which, len(HALF_CIRCLE))

    def continued(self, group: int, key: str, angle: Number) -> Number:
        along, parameter = self._by_circles(angle), self._by_circles(self.parameter).real
        turns = self.continuation.branches.turns[key]
        first, last = (
            turns.continued(along[:, k].real, parameter[:, k], self.which[:: len(HALF_CIRCLE)])
            for k in (0, -1)
        )
        steps = np.round(-np.diff(along.real, axis=1) / TURN)
        whole = np.round((first - along[:, 0].real) / TURN)[:, None] + np.zeros(along.shape)
        whole[:, 1:] += np.cumsum(steps, axis=1)
        found = along + TURN * whole
        self.followed &= np.abs(found[:, -1].real - last) < 0.5 * TURN
        return found.reshape(-1)

    def _by_circles(self, number: Number) -> Any:
        return np.broadcast_to(number, self.parameter.shape).reshape(-1, len(HALF_CIRCLE))


class Rough(Smooth):
    """The same for the mesh, on which places are looked at and not kept."""

    def higher(self, group: int, m: Namespace, at: Positions) -> None:
        self.judge(group, self.continuation.close(group, m, at, self.parameter, self.lanes, rough=True))
