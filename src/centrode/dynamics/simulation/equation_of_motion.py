"""What moves a mechanism at a time, a value and a rate of its drive: its acceleration and the powers of what acts."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise
from math import ceil, floor, inf, isfinite, isnan, tau
from typing import Any, Literal, TypeAlias

import numpy as np
import numpy.typing as npt
from numpy.polynomial import legendre

from centrode.dynamics.load_coordinates import Coordinate
from centrode.dynamics.loads import (
    AppliedLoad,
    EnergyClass,
    LoadDiagram,
    LoadTerm,
    Situation,
    StoredLaw,
)
from centrode.dynamics.masses import shares
from centrode.dynamics.reduction import Reducer
from centrode.dynamics.simulation.driving_law import Driving
from centrode.dynamics.state import DriveMotion, State
from centrode.dynamics.steady_motion.cycle import NODES, resolve_panels
from centrode.errors import InputError, MotionError, Status
from centrode.kinematics.plan_evaluation import AT_THE_START
from centrode.locale import _
from centrode.model.simulation import MOST_TURNS
from centrode.numerics.operations import SCALARS
from centrode.numerics.search import maxima_between

# Loads by what becomes of their work: potential energy, friction, or neither; and which follow formulas.

Array: TypeAlias = npt.NDArray[np.float64]
Number: TypeAlias = Any

STORED, FRICTION, OTHER = EnergyClass
SORTS = (STORED, FRICTION, OTHER)
"""Weights and springs; what is described as friction or damper; all else."""


@dataclass(frozen=True)
class Sorted:
    """An effort of a load; `placed` ones depend on the place and the sense of motion alone."""

    label: str
    effort: LoadTerm

    @property
    def sort(self) -> EnergyClass:
        """What becomes of its work."""
        return self.effort.amount.energy_class

    @property
    def is_positional(self) -> bool:
        """Whether it can be represented by the drive's value, once for each sense."""
        return self.effort.amount.by_place

    @property
    def one_sided(self) -> bool:
        """Whether it may be another one for the other sense of motion."""
        effort = self.effort
        return (
            effort.gate is not None
            or effort.works is not None
            or effort.amount.jumps
            or effort.amount.depends_on_sense
        )

    def energy(self, state: State) -> Number:
        """Potential energy [J] that belongs to its coordinate; of stored efforts alone."""
        amount = self.effort.amount
        assert isinstance(amount, StoredLaw)
        return amount.energy(self.effort.coordinate.value(state))


def sort_load_terms(loads: Sequence[AppliedLoad]) -> tuple[Sorted, ...]:
    """The efforts of loads, in their order."""
    return tuple(Sorted(load.label, effort) for load in loads for effort in load.efforts)


def formulas_of(efforts: tuple[Sorted, ...]) -> tuple[Sorted, ...]:
    """Those whose amount is computed anew at every time."""
    return tuple(term for term in efforts if not term.is_positional)


def of_time(efforts: tuple[Sorted, ...]) -> bool:
    """Whether a load depends on time."""
    return any("t" in term.effort.amount.uses for term in efforts)


# What a simulation needs to know at a value of the drive, computed by the reduction itself.

Known: TypeAlias = npt.NDArray[np.bool_]

INERTIA, SLOPE, FORWARDS, BACKWARDS = 0, 1, 2, 2 + len(SORTS)
FORMULAS = BACKWARDS + len(SORTS)
"""Rows: J, J', moments of placed loads by sort for either sense of the value, then three for each formula."""
COORDINATE, SPEED, ALONG, GATE = 0, 1, 2, 3
EACH = 4
"""Rows of a formula: its coordinate and the derivative of that; that of what it works along, where the drive's value
grows, and of the coordinate that lets it act."""
STILL = 1e-9
"""Derivative by the drive, over lengths, of what stands still: near change points it is known no better."""
FLOOR = 1e-3
"""Functions below this share of the greatest of their kind need be no more exact than that share."""


@dataclass(frozen=True)
class ReducedFunctions:
    """Functions of the drive's value.

    Attributes
    ----------
    reducer : Reducer
    added : float [kg m^2]
        Inertia of what turns with the drive at a constant ratio.
    ends_at_change_points : bool
        Whether the motion goes no farther than to the change points next to the initial position.
    """

    reducer: Reducer
    added: float
    ends_at_change_points: bool = False

    @cached_property
    def efforts(self) -> tuple[Sorted, ...]:
        """All efforts of loads."""
        return sort_load_terms(self.reducer.burden.loads)

    @cached_property
    def formulas(self) -> tuple[Sorted, ...]:
        """Efforts that are computed anew at every time."""
        return formulas_of(self.efforts)

    @property
    def sense(self) -> float:
        """Sense of the drive: +1.0 or -1.0."""
        return self.reducer.ready.kinematics.path.forward

    @property
    def count(self) -> int:
        """Number of rows."""
        return FORMULAS + EACH * len(self.formulas)

    def at(self, values: Array) -> Array:
        """All rows (rows, n); NaN where the motion or its derivatives do not exist."""
        rows = np.empty((self.count, len(values)))
        # backwards first: the state of the forward sense is used for all that does not depend on it
        for first, sense in ((BACKWARDS, -1.0), (FORWARDS, 1.0)):
            state, known = self.state(values, sense)
            for k, sort in enumerate(SORTS):
                placed = [term for term in self.efforts if term.is_positional and term.sort == sort]
                rows[first + k] = sum((_moment(term, state, known) for term in placed), np.zeros(len(values)))
        inertia, slope = shares(state, self.reducer.burden.masses, (1, len(values)))
        rows[INERTIA], rows[SLOPE] = inertia.sum(axis=0)[0] + self.added, slope.sum(axis=0)[0]
        for j, term in enumerate(self.formulas):
            row, effort = FORMULAS + EACH * j, term.effort
            # some turnings on the sphere have no value, and nothing that asks for it
            rows[row + COORDINATE] = effort.coordinate.value(state) if "x" in effort.amount.uses else 0.0
            rows[row + SPEED] = effort.coordinate.slope(state).value
            rows[row + ALONG] = effort.along(state)
            rows[row + GATE] = 1.0 if effort.gate is None else effort.gate.slope(state).value
        # of both senses the positions are the same, so one mask serves
        rows[:, ~known] = np.nan
        return rows

    def state(self, values: Array, sense: float = 1.0) -> tuple[State, Known]:
        """Positions at values of the drive, and where they exist with their derivatives."""
        ones = np.ones(len(values))
        state, status = self.reducer.state(values, DriveMotion(0.0 * ones, values, sense * ones))
        reached = np.isin(status, (Status.OK, Status.SINGULAR))
        return state, reached & np.broadcast_to(state.exists, (1, len(values)))[0]

    def jumps(self, low: float, high: float, some: Array) -> Array:
        """Values of the drive at which loads jump, between two; `some` values tell what moves at all.

        What does not move but for rounding does not turn round either.
        """
        state, known = self.state(some)
        least = STILL * max(1.0, self.reducer.ready.kinematics.path.scale)

        def moves(coordinate: Coordinate) -> bool:
            slope = np.broadcast_to(coordinate.slope(state).value, (1, len(some)))[0]
            return bool(np.max(np.abs(slope[known]), initial=0.0) > least)

        loads = [
            AppliedLoad(
                load.label, tuple(effort for effort in load.efforts if all(map(moves, effort.switches)))
            )
            for load in self.reducer.burden.loads
        ]
        return self.reducer.jumps(low, high, loads)

    def scales(self, peaks: Array) -> Array:
        """Scale of each row (rows,): its greatest value, raised where that may be rounding beside other rows."""
        scales = peaks.copy()
        # J' may be rounding beside J, whose derivative it is
        scales[SLOPE] = max(peaks[SLOPE], peaks[INERTIA])
        moments = slice(FORWARDS, FORMULAS)
        scales[moments] = np.maximum(peaks[moments], FLOOR * np.max(peaks[moments]))
        along = FLOOR * max(1.0, self.reducer.ready.kinematics.path.scale)
        scales[FORMULAS:] = np.maximum(peaks[FORMULAS:], along)
        return np.where(scales > 0.0, scales, 1.0)

    def energy(self, values: Array) -> Array:
        """Potential energy [J] of weights and springs (n), zero where their coordinates are."""
        state, _known = self.state(values)
        stored = [term for term in self.efforts if term.sort == SORTS[0]]
        return sum(
            (np.broadcast_to(term.energy(state), (1, len(values)))[0] for term in stored),
            np.zeros(len(values)),
        )


def _moment(one: Sorted, state: State, known: Known) -> Array:
    """The reduced moment of a placed effort (n); InputError where it has none."""
    strength = np.broadcast_to(one.effort.strength(state), (1, len(known)))[0]
    lacking = known & ~np.isfinite(strength)
    if lacking.any():
        at = int(np.flatnonzero(lacking)[0])
        if isinstance(one.effort.amount, LoadDiagram):
            x = np.broadcast_to(one.effort.coordinate.value(state), (1, len(known)))[0]
            raise one.effort.amount.refusal(float(x[at]))
        what = _("it has no finite value at {value:.6g}").format(value=float(state.parameter[at]))
        raise InputError(f"[[loads]] {one.label}", what, _("correct it"))
    return np.asarray(strength * one.effort.along(state)).reshape(-1)[: len(known)] + np.zeros(len(known))


# A mechanism by its drive's value, fast and with a known error: series on panels, stretch by stretch.
#
# Panels are those of `quadrature`: Legendre series through Gauss nodes, halved until their last terms have
# died away; they end at the jumps of loads. Of a drive that turns all the way round the stretches of one
# period serve all others.

TOLERANCE = 1e-13
"""What a panel's series may leave out of an integral over a stretch, over the greatest value."""
PANELS = 72
"""Panels of a stretch at first."""
NEAR_LIMIT = 1e-6
"""Distance from a limit, in units of the drive, where a simulation ends: beyond it inertia grows without bounds."""
TOWARDS_LIMIT = (1e-2, 1e-4)
"""Distances from there at which functions are represented anew, each section to its own greatest values."""
PROBES = tau * np.array([0.0133, 0.137, 0.291, 0.454, 0.618, 0.773, 0.911])
MOST_PERIOD = 4
SAME = 1e-9
LEAST_INERTIA = 1e-9
"""Inertia, over the greatest one, below which the motion is not carried."""
LOW = 0.05
"""Share of the greatest inertia below which its minima are looked at."""
CHECKED = (-0.97, -0.31, 0.53)
"""Places within each panel, from -1 to 1, at which the series are compared with the reduction itself."""
_POWERS = np.stack(
    [np.pad(legendre.leg2poly(row), (0, NODES - 1 - k)) for k, row in enumerate(np.eye(NODES))]
)
_ROOTS, _WEIGHTS = legendre.leggauss(NODES)
_TO_SERIES = legendre.legvander(_ROOTS, NODES - 1) * _WEIGHTS[:, None] * (np.arange(NODES) + 0.5)
_TO_POWERS = _TO_SERIES @ _POWERS
"""From values at the nodes to coefficients of powers of the place within a panel."""


@dataclass(frozen=True)
class TrackStretch:
    """Functions on a range.

    Attributes
    ----------
    edges : (panels + 1), growing
    powers : (panels, rows, NODES)
        Coefficients of powers of the place within a panel, from -1 to 1.
    jumps : (any), growing
        Where loads jump.
    """

    edges: Array
    powers: Array
    jumps: Array


class PanelTracks:
    """Rows of a mechanism by the value of its drive.

    Attributes
    ----------
    rows : ReducedFunctions
    low, high : where the motion ends, as far as it is known; else infinite
    period : change of the value after which everything repeats; 0.0 where it does not
    error : greatest difference from the reduction itself found so far, over the greatest values
    """

    def __init__(self, rows: ReducedFunctions) -> None:
        self.rows = rows
        path = rows.reducer.ready.kinematics.path
        self.first, self.unit = path.initial, path.unit
        self.length = tau * path.unit
        self.low, self.high = -inf, inf
        self.error = 0.0
        self._stretches: dict[int, TrackStretch] = {}
        self._grown = np.zeros(rows.count)
        self._change_points: set[float] = set()
        self.period = self._repeats() if path.driven[0].drive.kind == "angle" else 0.0

    def stretch(self, number: int) -> TrackStretch:
        """The stretch that begins that many lengths from the initial value."""
        stretch = self._stretches.get(number)
        if stretch is None:
            stretch = self._stretches[number] = self._new(number)
        return stretch

    def place(self, value: float, upwards: bool) -> tuple[int, int]:
        # a value on an edge belongs to the stretch that the motion enters
        """Number of the stretch on which a value lies, and of periods before; an edge belongs to what lies ahead."""
        share = (value - self.first) / self.length
        number = floor(share) if upwards else ceil(share) - 1
        if not self.period:
            return number, 0
        periods, inside = divmod(number, round(self.period / self.length))
        return inside, periods

    def is_change_point(self, value: float) -> bool:
        """Whether the motion ends at a change point there."""
        return any(abs(value - at) <= AT_THE_START * self.unit for at in self._change_points)

    def ending(self, value: float) -> Literal["limit", "change point"]:
        """Kind of event at that end of the range which is nearer to a value."""
        return "change point" if self.is_change_point(self.end(value)) else "limit"

    def end(self, value: float) -> float:
        """The end of the motion that is nearer to a value."""
        return self.low if abs(value - self.low) <= abs(value - self.high) else self.high

    def grown(self, periods: int) -> Array:
        """Growth of the rows over so many periods, of coordinates that run on with the drive."""
        return periods * self._grown

    def _repeats(self) -> float:
        """After which change of the value everything repeats, but for coordinates that run on; 0.0 if it does not."""
        turns = np.arange(MOST_PERIOD + 1)
        values = (self.first + PROBES + tau * turns[:, None]).reshape(-1)
        low, high = self.rows.reducer.reach(self.first, float(values[-1]))
        # a limit or an end within the probed turns means that nothing repeats
        if isfinite(low) or isfinite(high) or self._ends(self.first, float(values[-1])) != (-inf, inf):
            return 0.0
        rows = self.rows.at(values).reshape(self.rows.count, len(turns), -1)
        if not np.isfinite(rows).all():
            return 0.0
        scale = self.rows.scales(np.max(np.abs(rows), axis=(1, 2)))
        for count in range(1, MOST_PERIOD + 1):
            apart = rows[:, count:] - rows[:, :-count]
            grown = np.zeros(self.rows.count)
            # coordinates that run on with the drive grow by the same in each period: that is taken off before
            # comparing
            grown[FORMULAS + COORDINATE :: EACH] = apart[FORMULAS + COORDINATE :: EACH, 0, 0]
            if np.all(np.abs(apart - grown[:, None, None]) <= SAME * scale[:, None, None]):
                self._grown = np.where(np.abs(grown) > SAME * scale, grown, 0.0)
                return tau * count
        return 0.0

    def _new(self, number: int) -> TrackStretch:
        """Represent the rows on a stretch, or on what of it is reached."""
        low, high = (self.first + self.length * (number + k) for k in (0, 1))
        self._look_for_limits(low, high)
        low, high = max(low, self.low), min(high, self.high)
        if not low < high:
            # empty: what holds at the end of the motion, from which forces may still lead back
            end = min(max(low, self.low), self.high)
            powers = np.zeros((1, self.rows.count, NODES))
            powers[0, :, 0] = self.rows.at(np.array([end]))[:, 0]
            return TrackStretch(np.array([end, end]), powers, np.empty(0))
        even = np.linspace(low, high, PANELS + 1)
        jumps = self.rows.jumps(low, high, even)
        near = np.min(np.abs(even[1:-1, None] - jumps), axis=1, initial=inf) if len(jumps) else inf
        # even edges next to a jump would leave slivers of panels
        inner = even[1:-1][np.broadcast_to(near > 1e-9 * self.length, PANELS - 1)]
        edges = np.unique(np.concatenate([even[[0, -1]], inner, jumps[(jumps > low) & (jumps < high)]]))
        parts = [self._represent(part) for part in self._sections(edges)]
        ends = np.concatenate([parts[0][0][:1], *(part[0][1:] for part in parts)])
        return TrackStretch(ends, np.concatenate([part[1] for part in parts]), jumps)

    def _sections(self, edges: Array) -> list[Array]:
        """Edges in sections: towards a limit functions grow, and are represented to what they are there."""
        # each section is represented to its own greatest values: the last one grows without bound
        cuts = [
            limit + side * near * self.unit
            for limit, side in ((self.low, 1.0), (self.high, -1.0))
            for near in TOWARDS_LIMIT
            if edges[0] < limit + side * near * self.unit < edges[-1]
        ]
        merged = np.unique(np.concatenate([edges, cuts]))
        places = [0, *sorted(set(np.searchsorted(merged, cuts).tolist())), len(merged) - 1]
        return [merged[i : j + 1] for i, j in pairwise(places)]

    def _represent(self, edges: Array) -> tuple[Array, Array]:
        """Edges of panels on a section, and the powers there."""
        panels, values = resolve_panels(self.rows.at, edges, [TOLERANCE] * self.rows.count, self.rows.scales)
        powers = np.moveaxis(values.reshape(self.rows.count, -1, NODES) @ _TO_POWERS, 0, 1)
        self._check_inertia(panels.nodes, values[INERTIA])
        self._check(panels.edges, powers)
        return panels.edges, np.ascontiguousarray(powers)

    def _check_inertia(self, places: Array, inertia: Array) -> None:
        """Refuse a place at which nothing carries the motion (InputError), or at which there is none (MotionError)."""
        lacking = np.flatnonzero(~np.isfinite(inertia))
        if len(lacking):
            raise MotionError(
                "[simulation]",
                _("the motion has no derivatives where the drive is at {value:.6g}").format(
                    value=float(places[lacking[0]])
                ),
                _("start elsewhere, or change the dimensions"),
            )
        greatest = float(np.max(inertia))
        inner = inertia[1:-1]
        # minima that are low beside the greatest inertia; others carry the motion in any case
        dips = 1 + np.flatnonzero((inner <= inertia[:-2]) & (inner <= inertia[2:]) & (inner < LOW * greatest))
        lows, inertias = self._least_inertias(places[dips - 1], places[dips + 1])
        at, least = min(
            zip(lows, inertias, strict=True), key=lambda one: one[1], default=(self.first, greatest)
        )
        if not least > LEAST_INERTIA * greatest:
            what = _(
                "the reduced moment of inertia is zero where the drive is at {value:.6g}: the motion cannot continue"
            )
            raise InputError(
                "[links]",
                what.format(value=at),
                _("give the driven link an inertia, or [[machine.shafts]]"),
            )

    def _least_inertias(self, low: Array, high: Array) -> tuple[Array, Array]:
        """Places and values of the least inertia between places."""

        def lightness(places: Array) -> Array:
            return np.asarray(-self.rows.at(places.reshape(-1))[INERTIA].reshape(places.shape))

        at, greatest = maxima_between(lightness, low, high)
        return at, -greatest

    def _look_for_limits(self, low: float, high: float) -> None:
        """Learn where the motion ends: at limits, and where it has no derivatives for another reason."""
        reach = self.rows.reducer.reach(low, high)
        margin = NEAR_LIMIT * self.unit
        # a margin is kept: at the limit itself inertia is infinite
        self.low, self.high = max(self.low, reach[0] + margin), min(self.high, reach[1] - margin)
        below, above = self._ends(low, high)
        if below > self.low:
            self.low = below
            self._change_points.add(below)
        if above < self.high:
            self.high = above
            self._change_points.add(above)
        some = np.linspace(max(low, self.low), min(high, self.high), 2 * PANELS + 1)
        # what has no derivatives for any other reason ends the motion as well
        missing = some[~self.rows.state(some)[1]]
        self.low = max([self.low, *missing[missing < self.first]])
        self.high = min([self.high, *missing[missing >= self.first]])

    def _ends(self, low: float, high: float) -> tuple[float, float]:
        """Nearest change points below and above the initial value, where they end the motion; infinite without any."""
        below, above = -inf, inf
        if not self.rows.ends_at_change_points:
            return below, above
        # one at the initial value itself lies behind it
        first = self.first + self.rows.sense * AT_THE_START * self.unit
        for event in self.rows.reducer.events(min(low, self.first), max(high, self.first)):
            if event.kind == "change point":
                below = max(below, event.at) if event.at <= first else below
                above = min(above, event.at) if event.at > first else above
        return below, above

    def _check(self, edges: Array, powers: Array) -> None:
        """Measure by how much the series miss the reduction between their nodes."""
        middle, half = 0.5 * (edges[:-1] + edges[1:]), 0.5 * np.diff(edges)
        for share in CHECKED:
            # between the nodes, at places that are no roots of a polynomial of the series
            exact = self.rows.at(middle + share * half)
            apart = np.abs(powers @ share ** np.arange(NODES) - exact.T)
            scale = self.rows.scales(np.max(np.abs(exact), axis=1))
            # J' is left out: across change points it comes from power series with some digits less (9e-12 of J in a
            # parallelogram whose J misses 2e-13), and that is no error of the panels; what it costs is in the residual
            # of the energy
            counted = [INERTIA, *range(SLOPE + 1, self.rows.count)]
            self.error = max(self.error, float(np.nanmax((apart / scale)[:, counted])))


NAN = float("nan")


CREEP = 1e-200
"""Rate that stands for rest about to be left: formulas see its sign and nothing else."""
NUDGE = 1e-11
"""Distance from an end of a leg, over the value, that is rounding."""
_ORDERS = np.arange(NODES)


@dataclass(frozen=True)
class DriveForces:
    """At one instant or at many: inertia, its slope, moments by sort, that of the drive; all by the drive's value."""

    inertia: Number
    slope: Number
    stored: Number
    friction: Number
    other: Number
    driving: Number

    @property
    def row(self) -> tuple[Number, ...]:
        """All of them, in this order."""
        return self.inertia, self.slope, self.stored, self.friction, self.other, self.driving

    def acceleration(self, rate: Number) -> Number:
        """Second derivative of the drive's value by time."""
        moment = self.stored + self.friction + self.other + self.driving
        # J q'' + J' q'^2 / 2 = M
        return (moment - 0.5 * self.slope * rate * rate) / self.inertia


@dataclass(frozen=True)
class FieldLeg:
    """A range of the drive's value without jumps, passed in one sense or, where that does not matter, in both.

    Attributes
    ----------
    low, high : ends of the range
    sense : +1.0 or -1.0
    edges : of the panels there; values there are those of the drive plus `shift`
    powers : (panels, rows, NODES)
    grown : (rows)
        What coordinates have grown by in the periods before.
    gates : for each formula whether it acts
    senses : for each formula whether its coordinate grows (+1.0) or falls (-1.0)
    """

    low: float
    high: float
    sense: float
    edges: Sequence[float]
    powers: Array
    shift: float
    grown: Array | None
    gates: tuple[bool, ...] = ()
    senses: tuple[float, ...] = ()

    def rows(self, value: float) -> Array:
        """All rows at a value; beyond the ends those at the end."""
        # beyond the leg, within a step that overshoots, functions go on as they are at its end
        inside = min(max(value, self.low), self.high) + self.shift
        edges = self.edges
        panel = min(max(bisect_right(edges, inside) - 1, 0), len(edges) - 2)
        low, high = edges[panel], edges[panel + 1]
        # a stretch that begins where the motion ends is empty
        share = (2.0 * inside - low - high) / (high - low) if high > low else 0.0
        rows: Array = self.powers[panel] @ share**_ORDERS
        return rows if self.grown is None else rows + self.grown


class Field:
    """A mechanism with its drive, left to itself."""

    def __init__(self, tracks: PanelTracks, driving: Driving) -> None:
        self.tracks = tracks
        self.driving = driving
        self._last: FieldLeg | None = None

    @cached_property
    def turns_count(self) -> bool:
        """Whether it matters in which sense the drive moves, so that a standstill is an event."""
        rows = self.tracks.rows
        return self.driving.of_speed or any(term.one_sided for term in rows.efforts)

    @cached_property
    def of_time(self) -> bool:
        """Whether anything depends on time."""
        return self.driving.of_time or of_time(self.tracks.rows.efforts)

    def is_too_far(self, value: float, start: float) -> bool:
        """Whether a value lies more turns from the start than one simulation makes."""
        return not abs(value - start) <= MOST_TURNS * self.tracks.length * (1.0 + 1e-12)

    def leg(self, value: float, sense: float) -> FieldLeg:
        """The leg on which a value lies for a motion in one sense; at a jump the one that lies ahead."""
        tracks, upwards = self.tracks, sense > 0.0
        # a value at an end, but for rounding, lies on what is ahead
        ahead = value + sense * NUDGE * max(tracks.unit, abs(value))
        number, periods = tracks.place(ahead, upwards)
        stretch = tracks.stretch(number)
        shift = -periods * tracks.period
        low, high = float(stretch.edges[0]), float(stretch.edges[-1])
        ends = [low, *(float(x) for x in stretch.jumps if low < x < high), high]
        inside = ahead + shift
        # the leg ahead of a jump, as the value lies on the jump but for rounding
        k = bisect_right(ends, inside) - 1 if upwards else int(np.searchsorted(ends, inside)) - 1
        k = min(max(k, 0), len(ends) - 2)
        grown = tracks.grown(periods) if periods else None
        edges = [float(x) for x in stretch.edges]
        leg = FieldLeg(ends[k] - shift, ends[k + 1] - shift, sense, edges, stretch.powers, shift, grown)
        middle = leg.rows(0.5 * (leg.low + leg.high))
        formulas = tracks.rows.formulas
        # in the middle of the leg, where nothing turns round: signs there hold for the whole leg
        grows = [middle[FORMULAS + EACH * j :] * sense >= 0.0 for j in range(len(formulas))]
        gates = tuple(
            bool(up[GATE]) or term.effort.gate is None for up, term in zip(grows, formulas, strict=True)
        )
        return replace(leg, gates=gates, senses=tuple(1.0 if up[SPEED] else -1.0 for up in grows))

    def leg_at(self, value: float, sense: float) -> FieldLeg:
        """The leg on which a value lies for a motion in one sense, remembered as long as values stay on it."""
        last = self._last
        if last is None or last.sense != sense or not last.low <= value < last.high:
            last = self._last = self.leg(value, sense)
        return last

    def forces(self, leg: FieldLeg, t: float, value: float, rate: float) -> DriveForces:
        """Inertia and moments at an instant; NaN where a formula has no value."""
        t, value, rate = (
            float(t),
            float(value),
            float(rate),
        )  # a plain number divided by zero is an error, no infinity
        rows = leg.rows(value)
        first = FORWARDS if leg.sense > 0.0 else BACKWARDS
        moments = dict(zip(SORTS, rows[first : first + len(SORTS)].tolist(), strict=True))
        for j, term in enumerate(self.tracks.rows.formulas):
            if not leg.gates[j]:
                continue
            x, slope, along = rows[FORMULAS + EACH * j : FORMULAS + EACH * j + GATE].tolist()
            if term.effort.works is not None:
                along *= leg.sense  # it resists the drive, whichever way
            now = Situation(t, value, x, slope * rate, leg.senses[j], SCALARS)
            try:
                moments[term.sort] += float(term.effort.amount(now)) * along
            except (ArithmeticError, ValueError):
                moments[term.sort] = NAN
        return DriveForces(
            float(rows[INERTIA]),
            float(rows[SLOPE]),
            moments[STORED],
            moments[FRICTION],
            moments[OTHER],
            self.driving.at(t, value, rate),
        )

    def leaving(self, t: float, value: float) -> float:
        """In which sense the drive leaves a standstill: +1.0, -1.0, or 0.0 where it sticks."""
        # forces just after the start in either sense: friction takes the sign of the motion that would begin
        ahead = self.forces(self.leg(value, 1.0), t, value, CREEP).acceleration(0.0)
        behind = self.forces(self.leg(value, -1.0), t, value, -CREEP).acceleration(0.0)
        # where both senses are possible, the drive's own is taken
        if ahead > 0.0 and not (behind < 0.0 and self.driving.sense < 0.0):
            return 1.0
        if behind < 0.0:
            return -1.0
        if isnan(ahead) or isnan(behind):
            raise without_value(t, value)
        return 0.0


def too_far(t: float) -> MotionError:
    """More turns than one simulation makes."""
    return MotionError(
        "[simulation]",
        _("it has made more than {most} turns at t = {time:.6g} s").format(most=MOST_TURNS, time=t),
        _("give a shorter duration, or a drive whose speed stays bounded; with fixed steps use more of them"),
    )


def without_value(t: float, value: float) -> MotionError:
    """Drive or loads have no finite value somewhere."""
    return MotionError(
        "[simulation]",
        _("drive or loads have no finite value at t = {time:.6g} s, drive at {value:.6g}").format(
            time=t, value=value
        ),
        _("correct their formulas"),
    )


# What a simulation has found: the drive's value, rate and works at any time, and what happened on the way.

VALUE, RATE, OF_DRIVE, OF_FRICTION, OF_OTHERS = range(5)
STATES = 5
"""The drive's value and rate, and the works of drive, friction and other loads from the start."""

Ending = Literal["duration", "turns", "limit", "standstill", "interrupted", "change point"]
OCCASIONS = ("turns back", "sticks", "breaks loose", "limit", "standstill", "change point")
"""What may happen besides: a change of sense, rest held by friction, its end, and three ways to end."""


@dataclass(frozen=True)
class Occasion:
    """Event of a simulation at a time [s] and a value of the drive."""

    kind: str
    time: float
    value: float


@dataclass(frozen=True)
class TrajectoryPiece:
    """A piece of the course: `at` gives states (STATES, n) at times between its ends."""

    first: float
    last: float
    at: Callable[[Array], Array]
    sense: float


@dataclass
class ReducedTrajectory:
    """Pieces one after another, and how it ended.

    Attributes
    ----------
    pieces : in time
    occasions : in time
    ended : why it ended
    evaluations : how often the accelerations were computed
    """

    pieces: list[TrajectoryPiece] = field(default_factory=list)
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
        states, senses = np.empty((STATES, len(times))), np.empty(len(times))
        ends = [piece.last for piece in self.pieces]
        which = np.array([min(bisect_left(ends, t), len(ends) - 1) for t in times], dtype=np.intp)
        for k in np.unique(which):
            some = which == k
            states[:, some], senses[some] = self.pieces[k].at(times[some]), self.pieces[k].sense
        return states, senses
