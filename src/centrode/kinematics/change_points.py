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

from centrode.kinematics.higher_class.curve_continuation import CurveTracks, trace
from centrode.kinematics.higher_class.evaluation import ConvergedPlaces, close, follow, starts
from centrode.kinematics.higher_class.system import Surroundings
from centrode.kinematics.plan_evaluation import Branches, EvaluationPolicy, Kinematics
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.jets import Jet
from centrode.numerics.rounding_bounds import ROUNDED, UNIT_ROUNDOFF, Rounded
from centrode.structure.constraints import Positions, mapped_pose
from centrode.structure.dimensions import Dimensions

# What a group gives next to its change points: power series about the change point.
#
# Beside a change point the closed form of a group loses digits, while its motion is analytic there. So its
# positions are taken on a circle of complex values of the path's parameter around the change point, where
# nothing is lost, and Cauchy's integral gives the coefficients of their power series (Lyness and Moler, SIAM
# Journal on Numerical Analysis 4, 1967; Fornberg, ACM Transactions on Mathematical Software 7, 1981). The
# coefficients tell by themselves whether the circle holds a singularity: those that a power series does not
# have, of negative powers, are not zero then.

Array: TypeAlias = npt.NDArray[np.float64]
Lanes: TypeAlias = npt.NDArray[np.intp]
Mask: TypeAlias = npt.NDArray[np.bool_]
Number: TypeAlias = Any
Index: TypeAlias = tuple[Any, ...]

NODES = 128
"""Values on a circle; positions at conjugate values are conjugate, so half of them are computed."""
TERMS = NODES // 2
"""Powers that a series keeps; the other coefficients have to vanish."""
NOISE = 1.0 / 64
"""Part of the rounding error of the values on a circle below which a coefficient says nothing."""
HALF_CIRCLE = np.exp(1j * np.pi * np.arange(TERMS + 1) / TERMS)
"""From the real node above the change point to the one below it."""
HALF_CIRCLE[[0, -1]] = 1.0, -1.0


@dataclass(frozen=True)
class Windows:
    """The stretches about the change points of a group, of all mechanisms of a batch: arrays (windows,).

    `radius` is that of the circle on which a series rests, 0 where there is none.
    """

    lane: Lanes
    centre: Array
    half: Array
    radius: Array

    def __len__(self) -> int:
        return len(self.lane)

    def of(self, which: Lanes | Mask) -> Windows:
        """Stretches with these numbers, or where a mask is true."""
        return Windows(self.lane[which], self.centre[which], self.half[which], self.radius[which])


@dataclass(frozen=True)
class ChangePointSeries:
    """Power series of a group's numbers about its change points.

    Attributes
    ----------
    numbers : for each number of the group (windows, TERMS): coefficients of powers of (parameter - centre) / radius
    bounds : for each number of the group (windows,): rounding error of its values on the circle
    """

    numbers: list[Array]
    bounds: list[Array]

    def put(
        self, into: ChangePointSeries | None, places: Lanes, chosen: Mask, windows: int
    ) -> ChangePointSeries:
        """Other series, of so many windows, with the chosen ones of these at their places."""
        if into is None:
            into = ChangePointSeries(
                [np.zeros((windows, TERMS)) for _ in self.numbers], [np.zeros(windows) for _ in self.bounds]
            )
        for whole, part in zip((*into.numbers, *into.bounds), (*self.numbers, *self.bounds), strict=True):
            whole[places] = part[chosen]
        return into

    def without_rounding(self) -> ChangePointSeries:
        """The series without the last terms of each, as far as these are rounding errors."""
        numbers = []
        for number, bound in zip(self.numbers, self.bounds, strict=True):
            # a coefficient counts if it is above the noise or one of a higher power is: only the tail is cut
            # off
            counts = np.abs(number) > NOISE * bound[:, None]
            counts = np.logical_or.accumulate(counts[:, ::-1], axis=1)[:, ::-1]
            length = int(np.max(np.sum(counts, axis=1), initial=1))
            numbers.append(np.where(counts, number, 0.0)[:, :length])
        # all windows of the batch keep as many terms as the longest needs: one array
        return ChangePointSeries(numbers, self.bounds)


def inside(windows: Windows, along: Array, lanes: Lanes | None) -> tuple[Index, Lanes]:
    """Index of the parameters inside a window, and which window that is; of two the later one counts.

    `along` are parameters (n,) of all mechanisms, or with `lanes` one mechanism's each; then they may be complex.
    """
    if lanes is None:
        order = np.argsort(along, kind="stable")
        ends = windows.centre - windows.half, windows.centre + windows.half
        # one more on both sides: the last bit is left to the comparison below
        first = np.maximum(np.searchsorted(along[order], ends[0]) - 1, 0)
        last = np.minimum(np.searchsorted(along[order], ends[1], side="right") + 1, len(along))
    else:
        order = np.argsort(lanes, kind="stable")
        first, last = (np.searchsorted(lanes[order], windows.lane, side=side) for side in ("left", "right"))
    counts = last - first
    chosen = np.repeat(np.arange(len(windows)), counts)
    # for each window the places first ... last - 1 of the order: a ramp for all windows at once
    places = order[np.arange(len(chosen)) + np.repeat(first - np.cumsum(counts) + counts, counts)]
    within = np.abs(along[places] - windows.centre[chosen]) < windows.half[chosen]
    chosen, places = chosen[within], places[within]
    return ((windows.lane[chosen], places) if lanes is None else (places,)), chosen


def numbers_of(kinematics: Kinematics, group: int, at: Positions) -> list[Number]:
    """Coordinates and angles that a group gives, number by number."""
    which = kinematics.structure.groups[group]
    numbers = [x for point in which.points for x in at.points[point]]
    for link in which.links:
        numbers += [x for vector in at.poses[link] for x in vector]
    return numbers + [at.angles[link] for link in which.links if link in at.angles]


def set_numbers(kinematics: Kinematics, group: int, at: Positions, numbers: list[Number]) -> None:
    """Put numbers in the order of `numbers_of` back into positions."""
    which = kinematics.structure.groups[group]
    rest = iter(numbers)
    for point in which.points:
        at.points[point] = tuple(next(rest) for _old in at.points[point])
    for link in which.links:
        at.poses[link] = mapped_pose(at.poses[link], lambda _old: next(rest))
    for link in which.links:
        if link in at.angles:
            at.angles[link] = next(rest)


def coefficients(number: Number, windows: int) -> Array:
    """All coefficients (windows, NODES) of a number given on the half circles of the windows, one after the other.

    The first TERMS are those of the power series, the others those of what a series leaves over.
    """
    on_circle = np.broadcast_to(number, (windows * len(HALF_CIRCLE),)).reshape(windows, -1)
    # hfft takes half a circle of values whose other half is conjugate: coefficients of real motions are real
    return np.asarray(np.fft.hfft(on_circle, NODES) / NODES)


def apply_series(
    old: Number,
    series: Array,
    bound: Array,
    windows: Windows,
    shape: tuple[int, ...],
    index: Index,
    chosen: Lanes,
    along: Array,
) -> Number:
    """A number with the entries at `index`, at parameters `along`, given by the series of the chosen windows.

    Where a window has no series the value stays, without derivatives.
    """
    order = old.order if isinstance(old, Jet) else 0
    bare = windows.radius[chosen] == 0.0
    if bare.any():
        bare_at = tuple(part[bare] for part in index)
        if isinstance(old, Jet):
            # without a series the value of the closed form is the best there is, but its derivatives are
            # rounding
            there = np.full(len(bare_at[0]), np.nan)
            old = Jet([old.value, *(_put_entries(c, shape, bare_at, there) for c in old.coefficients[1:])])
        index, chosen, along = tuple(part[~bare] for part in index), chosen[~bare], along[~bare]
    known = _sum_series(series[chosen], (along - windows.centre[chosen]) / windows.radius[chosen], order)
    scale = 1.0 / windows.radius[chosen]
    if isinstance(old, Jet):
        return Jet(
            [
                _put_entries(c, shape, index, x * scale**k)
                # derivatives by the parameter: one factor 1 / radius for each order
                for k, (c, x) in enumerate(zip(old.coefficients, known, strict=True))
            ]
        )
    if isinstance(old, Rounded):
        value = known[0]
        # what the circle is known to, and the rounding of the sum itself
        error = bound[chosen] + UNIT_ROUNDOFF * np.abs(value)
        return Rounded(
            _put_entries(old.value, shape, index, value), _put_entries(old.bound, shape, index, error)
        )
    return _put_entries(old, shape, index, known[0])


def _sum_series(series: Array, x: Array, order: int) -> list[Array]:
    """Taylor coefficients up to an order of power series (n, TERMS) at places (n,), by Horner's rule.

    The terms are added one by one: a matrix product rounds differently for different numbers of samples.
    """
    sums = [np.zeros(x.shape, dtype=x.dtype) for _ in range(order + 1)]
    # one more power: the Taylor coefficients of p x + c follow from those of p
    for k in range(series.shape[1] - 1, -1, -1):
        for j in range(order, 0, -1):
            sums[j] = sums[j] * x + sums[j - 1]
        sums[0] = sums[0] * x + series[:, k]
    return sums


def _put_entries(old: Number, shape: tuple[int, ...], index: Index, values: Array) -> Array:
    whole = np.array(
        np.broadcast_to(old, shape), dtype=np.result_type(np.asarray(old).dtype, values.dtype, np.float64)
    )
    whole[index] = values
    return whole


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
class BranchedPlan:
    """Kinematics with branches: evaluates what the signs and the change points found so far allow."""

    kinematics: Kinematics
    branches: Branches
    start: Positions
    nominal: Dimensions
    _tracks: dict[int, CurveTracks] = field(default_factory=dict)
    _beside: dict[int, Surroundings] = field(default_factory=dict)
    _windows: dict[int, Windows | None] = field(default_factory=dict)
    _series: dict[int, ChangePointSeries] = field(default_factory=dict)

    def hooks(self, m: Namespace, parameter: Array, lanes: Lanes | None) -> Smooth:
        """Policy that runs the plan over any algebra at parameters: (n,) for all lanes, or one lane for each."""
        return Smooth(self, m, parameter, lanes)

    def trace(self, group: int, extent: tuple[float, float]) -> None:
        """Follow a group of higher class from the initial position over an extent of the path."""
        around, branches = self._surroundings(group), self.branches
        first = starts(around, self.nominal, self.start, branches.initial, branches.lanes)
        with np.errstate(all="ignore"):
            # limits of the groups before end the track: nothing is known behind them
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
    ) -> ConvergedPlaces:
        """Add what a group of higher class gives at parameters."""
        return close(self._surroundings(group), self._tracks[group], m, at, parameter, lanes, rough)

    def _surroundings(self, group: int) -> Surroundings:
        if group not in self._beside:
            self._beside[group] = Surroundings(self.kinematics, group, self.hooks)
        return self._beside[group]

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
            apply_series(old, known, bound, windows, shape, index, chosen, along)
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

    def series_of(self, group: int) -> ChangePointSeries:
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
        # of this group and those before: at a limit of any of them the motion is like a square root
        nearest = [
            min((abs(at - event.at) for at in limits[event.lane]), default=np.inf) for event in centres
        ]
        at = np.array([event.at for event in centres])
        lanes = np.array([event.lane for event in centres], dtype=np.intp)
        widest = np.minimum(CIRCLE * units, nearest)  # at a limit the motion is not analytic
        windows, self._series[group] = self._with_circles(group, Windows(lanes, at, WINDOW * units, widest))
        return windows

    def _with_circles(self, group: int, windows: Windows) -> tuple[Windows, ChangePointSeries]:
        """The windows with the greatest circles that hold no singularity, and the series that rest on these.

        As given, windows have their greatest half width, which is `WINDOW` units of the path, and greatest radius.
        """
        count, radius = len(windows), windows.radius.copy()
        best, growing = np.zeros(count), np.zeros(count, dtype=bool)
        series: ChangePointSeries | None = None
        trying = np.arange(count)
        while len(trying):
            around, whole = self._around(group, replace(windows.of(trying), radius=radius[trying]))
            series = around.put(series, trying[whole], whole, count)
            best[trying[whole]] = radius[trying[whole]]
            growing[trying[whole]] = True
            # a circle that holds a singularity ends the growing of one that held none before
            # the circle grows as long as it holds none, up to its greatest radius
            larger = whole & (radius[trying] < windows.radius[trying])
            # it shrinks until it holds none for the first time; below the least circle the series is given up
            smaller = (
                ~whole & ~growing[trying] & (radius[trying] > LEAST_CIRCLE / WINDOW * windows.half[trying])
            )
            radius[trying] = np.minimum(
                radius[trying] * np.where(whole, GROWING, SHRINKING), windows.radius[trying]
            )
            trying = trying[larger | smaller]
        assert series is not None
        # without a circle the stretch still has no derivatives: the closed form's are rounding there
        half = np.where(best > 0.0, np.minimum(windows.half, SHARE * best), BARE / WINDOW * windows.half)
        return replace(windows, half=half, radius=best), series.without_rounding()

    def _around(self, group: int, windows: Windows) -> tuple[ChangePointSeries, Mask]:
        """Power series of a group's numbers on circles, and a mask of the circles that hold no singularity."""
        numbers, followed = self._on_circles(group, windows)
        bounds = self._bounds_on_circles(group, windows)
        whole, lost = followed, np.full(len(windows), np.inf)
        for number, bound in zip(numbers, bounds, strict=True):
            # an analytic function has no negative powers: what is left of them is rounding
            whole = whole & (np.max(np.abs(number[:, TERMS:]), axis=1) <= bound)
            with np.errstate(all="ignore"):
                # the part of the motion that rounding takes; of all numbers the one that moves most counts
                lost = np.fmin(lost, bound / np.sum(np.abs(number[:, 1:TERMS]), axis=1))
        # on a circle as small as rounding errors everything looks analytic
        shrunk = windows.radius < windows.half
        # only circles that had to shrink are suspected
        whole &= ~shrunk | (lost <= LOST)
        return ChangePointSeries([number[:, :TERMS] for number in numbers], bounds), whole

    def _on_circles(self, group: int, windows: Windows) -> tuple[list[Array], Mask]:
        """Coefficients of what a group gives on circles, and on which of these it could be followed."""
        lanes = np.repeat(windows.lane, len(HALF_CIRCLE))
        parameter = (windows.centre[:, None] + windows.radius[:, None] * HALF_CIRCLE).reshape(-1)
        kinematics, hooks = self.kinematics.take(lanes), Circling(self, parameter, lanes, group)
        with np.errstate(all="ignore"):
            at = kinematics.frame(ARRAYS, parameter)
            kinematics.advance(at, range(group + 1), ARRAYS, hooks)
            numbers = [coefficients(x, len(windows)) for x in numbers_of(kinematics, group, at)]
        return numbers, hooks.followed

    def _bounds_on_circles(self, group: int, windows: Windows) -> list[Array]:
        """Rounding errors of what a group gives on circles: those at the two real values of each (windows,)."""
        lanes = np.repeat(windows.lane, 2)
        ends = (windows.centre[:, None] + windows.radius[:, None] * np.array([1.0, -1.0])).reshape(-1)
        kinematics = self.kinematics.take(lanes)
        with np.errstate(all="ignore"):
            at = kinematics.frame(ROUNDED, Rounded.of(ends))
            # the closed form itself: a series would be bounded by itself
            kinematics.advance(at, range(group + 1), ROUNDED, Unmended(self, ROUNDED, ends, lanes, group))
        bounds = [Rounded.of(x).bound for x in numbers_of(kinematics, group, at)]
        return [np.max(np.broadcast_to(x, ends.shape).reshape(-1, 2), axis=1) for x in bounds]


class Smooth(EvaluationPolicy):
    """Signs as the branches have them, and every group mended near its change points."""

    def __init__(
        self, continuation: BranchedPlan, m: Namespace, parameter: Array, lanes: Lanes | None
    ) -> None:
        self.continuation = continuation
        self.m = m
        self.parameter = parameter
        self.lanes = lanes

    def root(self, group: int, radicand: Number) -> Number:
        # the sign is that of the branch: +1 or -1 along the parameter
        return self.m.sqrt(radicand) * self.continuation.branches.sign(group, self.parameter, self.lanes)

    def higher(self, group: int, m: Namespace, at: Positions) -> None:
        self.judge(group, self.continuation.close(group, m, at, self.parameter, self.lanes))

    def judge(self, group: int, judged: ConvergedPlaces) -> None:
        """Look at where a group of higher class is not what it should be."""

    def continue_angle(self, group: int, key: str, angle: Number) -> Number:
        # not counted yet: the group itself is still being searched, and nothing behind it is requested
        turns = self.continuation.branches.turns.get(key)
        return angle if turns is None else turns.continue_angle(angle, self.parameter, self.lanes)

    def after(self, group: int, at: Positions) -> None:
        self.continuation.mend(group, at, self.parameter, self.lanes)


class Unmended(Smooth):
    """Signs as the branches have them; one group is given by its closed form also beside its change points."""

    def __init__(
        self, continuation: BranchedPlan, m: Namespace, parameter: Array, lanes: Lanes | None, group: int
    ) -> None:
        super().__init__(continuation, m, parameter, lanes)
        self.group = group

    def after(self, group: int, at: Positions) -> None:
        # groups before are mended as usual: the group's own formula stands on good ground
        if group != self.group:
            super().after(group, at)


class Circling(Unmended):
    """Positions on half circles about change points of a group, one circle after the other.

    Roots, angles and groups of higher class go on along a half circle from its real beginning, value by value: so they
    stay on one branch, whatever the cuts of complex functions are. At the real end they have to be where the motion is.
    """

    def __init__(self, continuation: BranchedPlan, parameter: Array, lanes: Lanes, group: int) -> None:
        super().__init__(continuation, ARRAYS, parameter, lanes, group)
        self.which = lanes
        self.followed: Mask = np.ones(len(lanes) // len(HALF_CIRCLE), dtype=bool)
        """Circles on which everything ends where the motion is."""

    def root(self, group: int, radicand: Number) -> Number:
        root = self._by_circles(np.sqrt(radicand + 0j))
        # at the real beginning the sign is that of the motion
        real = self._by_circles(self.continuation.branches.sign(group, self.parameter.real, self.which))
        # the square root of complex numbers jumps at its cut: turned back where it would jump to the opposite
        turned = np.where((root[:, 1:] * root[:, :-1].conj()).real < 0.0, -1.0, 1.0)
        signs = np.cumprod(np.concatenate([real[:, :1], turned], axis=1), axis=1)
        # at the real end it must have the motion's sign, or the circle went round a branch point
        self.followed &= signs[:, -1] == real[:, -1]
        return (root * signs).reshape(-1)

    def higher(self, group: int, m: Namespace, at: Positions) -> None:
        self.continuation.follow(group, at, self.parameter, self.which, len(HALF_CIRCLE))

    def continue_angle(self, group: int, key: str, angle: Number) -> Number:
        along, parameter = self._by_circles(angle), self._by_circles(self.parameter).real
        turns = self.continuation.branches.turns[key]
        first, last = (
            turns.continue_angle(along[:, k].real, parameter[:, k], self.which[:: len(HALF_CIRCLE)])
            for k in (0, -1)
        )
        # along the half circle the angle is continued from value to value, past the cut of the arc tangent
        steps = np.round(-np.diff(along.real, axis=1) / TURN)
        whole = np.round((first - along[:, 0].real) / TURN)[:, None] + np.zeros(along.shape)
        whole[:, 1:] += np.cumsum(steps, axis=1)
        unwrapped = along + TURN * whole
        # at the real end it must be the motion's own angle with its turns
        self.followed &= np.abs(unwrapped[:, -1].real - last) < 0.5 * TURN
        return unwrapped.reshape(-1)

    def _by_circles(self, number: Number) -> Any:
        return np.broadcast_to(number, self.parameter.shape).reshape(-1, len(HALF_CIRCLE))


class Rough(Smooth):
    """`Smooth` for the mesh: groups of higher class stand where their tracks foretell them, as signs need no more."""

    def higher(self, group: int, m: Namespace, at: Positions) -> None:
        self.judge(group, self.continuation.close(group, m, at, self.parameter, self.lanes, rough=True))
