"""Following groups of higher class along the path, from the initial position outwards.

Steps choose themselves: the polynomial of the last piece foretells the next place, Newton's method finds it on a
plane square to the curve. Where the determinant bordered by the curve's direction changes its sign, two curves
meet or nearly meet (`crossings` tells which): a change point is passed straight on, a near miss in smaller steps.
Where the parameter turns back is a limit. A curve that closes after whole turns of the drive ends there.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from math import tau
from typing import Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.kinematics.higher_class.curves import (
    CurvePlaces,
    ReachedPlace,
    curve_crossing,
    limits,
    quintic,
    reach,
)
from centrode.kinematics.higher_class.loop_closure import LoopClosure
from centrode.kinematics.higher_class.newton import SMALL, newton
from centrode.kinematics.higher_class.parameter_continuation import WalkerCourse, walk_by_parameter
from centrode.kinematics.higher_class.system import Surroundings, needed_positions, total
from centrode.kinematics.plan_evaluation import RadicandZero
from centrode.structure.constraints import Positions

# The track of a group of higher class: its curve over the path in pieces, and where Newton's method starts.
#
# Pieces belong to the mechanism and its path, not to the samples: a place starts from the piece on which it
# lies. So what is found does not depend on what else is requested. A curve that closes after whole turns is
# followed once: behind that every place starts from the one as many turns before.

Array: TypeAlias = npt.NDArray[np.float64]
Lanes: TypeAlias = npt.NDArray[np.intp]
Mask: TypeAlias = npt.NDArray[np.bool_]
End: TypeAlias = Literal["on", "limit", "lost"]

HALVINGS, CLOSE = 60, 1e-13
"""Steps of Newton's method between halvings, more than halving alone takes (53), and the change of the share of a piece
at which a place ends: there it is only where Newton's method on the group's own equations starts."""


@dataclass(frozen=True)
class CurvePiece:
    """A stretch of the curve by its share u, 0 to 1: coefficients (6, width + 1), that of u^0 first.

    The last column is the path's parameter beyond `origin`. `first` and `last` are the parameters at the ends,
    `sense` is the sign of the group's determinant.
    """

    coefficients: Array
    origin: float
    first: float
    last: float
    sense: float


@dataclass(frozen=True)
class Period:
    """After so much of the path a closed curve repeats itself; the numbers of the state have grown by (width,)."""

    length: float
    grown: Array


@dataclass
class Trail:
    """The pieces in one sense of the path, outward from the initial position, and how they end.

    A place closer than `margin` to a limit is the limit itself.
    """

    pieces: list[CurvePiece] = field(default_factory=list)
    end: End = "on"
    limit: float = np.nan
    margin: float = -1.0
    state: Array | None = None
    """There, if the limit is the group's own."""
    period: Period | None = None
    """Of a closed curve."""


@dataclass(frozen=True)
class Foretold:
    """Where Newton's method starts at every place, and what is known of the place beforehand."""

    state: Array
    sense: Array
    beyond: Mask
    limit: Mask


@dataclass(frozen=True)
class CurveTracks:
    """The tracks of all mechanisms of a batch: one trail behind and one ahead of each initial position.

    `powers` (6, width + 1, pieces) are the coefficients of all pieces. Curves that are closed repeat themselves after a
    `period` (lanes, 2) of the path, and have `grown` (lanes, 2, width) then.
    """

    lanes: int
    initial: float
    powers: Array
    origin: Array
    sense: Array
    edges: list[Array]
    first: Lanes
    limits: Array
    margins: Array
    at_limit: Array
    followed: Array
    period: Array
    grown: Array

    @classmethod
    def of(cls, initial: float, behind: Sequence[Trail], ahead: Sequence[Trail], width: int) -> CurveTracks:
        """Tracks from trails; a mechanism without pieces has no track."""
        pieces: list[CurvePiece] = []
        edges, first = [], []
        limits, margins = np.full((len(ahead), 2), np.nan), np.zeros((len(ahead), 2))
        at_limit = np.full((len(ahead), 2, width), np.nan)
        followed = np.full((len(ahead), 2), np.nan)
        period, grown = np.full((len(ahead), 2), np.inf), np.zeros((len(ahead), 2, width))
        for lane, trails in enumerate(zip(behind, ahead, strict=True)):
            own = [*reversed(trails[0].pieces), *trails[1].pieces]
            first.append(len(pieces))
            pieces += own
            # every inner edge is the end of one piece and the beginning of the next: one of each pair is kept
            edges.append(np.sort([edge for piece in own for edge in (piece.first, piece.last)])[1:-1:2])
            for side, trail in enumerate(trails):
                if trail.pieces:
                    followed[lane, side] = trail.pieces[-1].last
                if trail.end == "limit":
                    limits[lane, side], margins[lane, side] = trail.limit, trail.margin
                if trail.state is not None:
                    at_limit[lane, side] = trail.state
                if trail.period is not None:
                    period[lane, side], grown[lane, side] = trail.period.length, trail.period.grown
        coefficients = np.array([piece.coefficients for piece in pieces]).reshape(-1, 6, width + 1)
        return cls(
            len(ahead),
            initial,
            np.ascontiguousarray(np.moveaxis(coefficients, 0, 2)),
            np.array([piece.origin for piece in pieces]),
            np.array([piece.sense for piece in pieces]),
            edges,
            np.array(first, dtype=np.intp),
            limits,
            margins,
            at_limit,
            followed,
            period,
            grown,
        )

    def foretell(self, parameter: Array, lanes: Lanes, columns: Lanes | None = None) -> Foretold:
        """Starting states at parameters, one lane for each; all of their numbers, or some of them with zeros beside."""
        parameter, grown = self._fold_to_first_round(parameter, lanes)
        which, known = self._pieces(parameter, lanes)
        state = np.full((self.at_limit.shape[2], len(parameter)), np.nan).T
        sense = np.zeros(len(parameter))
        chosen = which[known]
        if len(chosen):
            share = share_at(self.powers[:, -1], chosen, parameter[known] - self.origin[chosen])
            state[known] = 0.0
            for column in range(state.shape[1]) if columns is None else columns:
                state[known, column] = _value(self.powers[:, column], chosen, share)
            sense[known] = self.sense[chosen]
            state += grown
        limit = self._at_limits(parameter, lanes, state)
        past = (parameter < self.limits[lanes, 0]) | (parameter > self.limits[lanes, 1])
        return Foretold(state, sense, past & ~limit, limit)

    def _fold_to_first_round(self, parameter: Array, lanes: Lanes) -> tuple[Array, Array]:
        """The places on the first round of closed curves that come before places, and how states grow between them."""
        side = (parameter > self.initial).astype(np.intp)
        period = self.period[lanes, side]
        # the end of a round belongs to it
        rounds = np.maximum(np.ceil(np.abs(parameter - self.initial) / period) - 1.0, 0.0)
        # back towards the initial position: down ahead of it, up behind it
        back = rounds * np.where(np.isfinite(period), period, 0.0) * (1.0 - 2.0 * side)
        return parameter + back, rounds[:, None] * self.grown[lanes, side]

    def _pieces(self, parameter: Array, lanes: Lanes) -> tuple[Lanes, Mask]:
        """The piece of each place, and whether the curve was followed as far as that."""
        which = np.zeros(len(parameter), dtype=np.intp)
        order = np.argsort(lanes, kind="stable")
        bounds = np.searchsorted(lanes[order], np.arange(self.lanes + 1))
        for lane in np.nonzero(np.diff(bounds))[0]:
            # pieces of a lane lie in the order of the parameter, so edges tell which one a place is on
            here = order[bounds[lane] : bounds[lane + 1]]
            which[here] = self.first[lane] + np.searchsorted(self.edges[lane], parameter[here])
        reach = self.followed[lanes]
        # a trail without pieces has NaN for its end and counts as not followed on that side
        low, high = np.fmin(reach[:, 0], reach[:, 1]), np.fmax(reach[:, 0], reach[:, 1])
        return which, (parameter >= low) & (parameter <= high)

    def _at_limits(self, parameter: Array, lanes: Lanes, state: Array) -> Mask:
        """Where places are limits themselves; puts the state of the limit there."""
        limit = np.zeros(len(parameter), dtype=bool)
        for side in (0, 1):
            place = self.limits[lanes, side]
            with np.errstate(invalid="ignore"):
                here = np.abs(parameter - place) <= self.margins[lanes, side]
            state[here] = self.at_limit[lanes[here], side]
            limit |= here
        return limit


def share_at(powers: Array, which: Lanes, wanted: Array) -> Array:
    """Where polynomials (6, pieces) that run one way from 0 to 1 take values: Newton's method between bounds."""
    own = powers[:, which]
    slopes = own[1:] * np.arange(1.0, len(own))[:, None]
    low, high = np.zeros(len(wanted)), np.ones(len(wanted))
    # polynomials begin with zero, so the value at 1 is the sum of the other coefficients
    whole = _horner(own[1:], np.ones(len(wanted)))
    with np.errstate(all="ignore"):
        share = np.clip(wanted / whole, 0.0, 1.0)
        going = np.ones(len(wanted), dtype=bool)
        for _step in range(HALVINGS):
            beyond = _horner(own, share) - wanted
            # the end with the sign of what is missing moves: the polynomial may grow or fall
            short = (beyond < 0.0) == (whole > 0.0)
            low, high = np.where(short, share, low), np.where(short, high, share)
            better = share - beyond / _horner(slopes, share)
            better = np.where((better >= low) & (better <= high), better, 0.5 * (low + high))
            change, share = np.abs(better - share), np.where(going, better, share)
            going &= change > CLOSE  # each place stops by itself
            if not going.any():
                break
    return np.asarray(share, dtype=np.float64)


def _value(powers: Array, which: Lanes, share: Array) -> Array:
    """Values of polynomials (6, pieces), a piece and a share for each place."""
    return _horner(powers[:, which], share)


def _horner(coefficients: Array, share: Array) -> Array:
    value = coefficients[-1]
    for c in coefficients[-2::-1]:
        value = value * share + c
    return np.asarray(value, dtype=np.float64)


# Groups of higher class that stand after whole turns of the drive as they began.
#
# Where the drive is an angle, how the mechanism goes on depends on where everything stands, and not on the
# turns made: two drives' values whole turns apart, with everything before a group and the group itself in the
# same places, are followed by the same curve. So a curve that has come back to a place near its beginning is
# closed: it repeats itself, and only angles grow, by whole turns.

BEHIND = 0.1
"""How far [rad] behind the beginning of a turn a group is compared with itself: at the very start both assemblies of
a dyad may meet. The mesh reaches further beyond what is requested, so it does not decide whether a curve is closed."""


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

    def closings(
        self, who: Lanes, origin: Array, pieces: Array, reached: Array
    ) -> list[tuple[np.intp, Period]]:
        """Walkers that have come round, of those whose last pieces brought them from an origin to what is reached."""
        passing = self.passing(who, reached)
        if not passing.any():
            return []
        who, last = who[passing], pieces[passing]
        places = self._place(who, self.passed[who])
        # the last piece leads past the place: where on it the parameter takes the value, the state is
        # foretold
        ways = np.ascontiguousarray(last[:, :, -1].T)
        share = share_at(ways, np.arange(len(who)), places - origin[passing])
        return self._walkers_at_start(
            who, places, total(last * (share[:, None] ** np.arange(6))[:, :, None])[:, :-1]
        )

    def set_out(self, walker: int) -> None:
        """Let a walker set out once more."""
        self.begun[walker], self.passed[walker] = np.nan, 0

    def passing(self, who: Lanes, reached: Array) -> Mask:
        """Which walkers have passed a place at which they may have come round."""
        # only where angles drive does the mechanism come back to where it was
        if not self.around.kinematics.path.turns:
            return np.zeros(len(who), dtype=bool)
        return np.asarray(self.forward[who] * (reached - self._place(who, self.passed[who])) >= 0.0)

    def _walkers_at_start(self, who: Lanes, places: Array, foretold: Array) -> list[tuple[np.intp, Period]]:
        """Walkers that stand at their next places as they stood at their first; the next places move on."""
        lane, turns = self.lane[who], self.passed[who]
        self.passed[who] += 1
        before = self.around.before(places, lane)
        system = self.around.system(needed_positions(self.around.equations, before), lane)
        converged = newton(system, self.around.normalise(foretold, lane))
        # a place that is not found compares with nothing, and closes nothing
        state = np.where(converged.found[:, None], converged.state, np.nan)
        first = turns == 0
        self.begun[who[first]] = state[first]
        grown = state - self.begun[who]
        whole = np.zeros(grown.shape)
        angles = slice(grown.shape[1] - system.turning, None)
        # only angles may have grown, and by whole turns alone: all else has to be where it was
        whole[:, angles] = tau * np.round(grown[:, angles] / tau)
        with np.errstate(invalid="ignore"):
            met = np.max(np.abs(grown - whole) * system.weights(), axis=1) <= SMALL
        # the group alone is not enough: what it stands on has to be where it was as well
        met &= ~first & self._alike(before, self.around.before(self._place(who, 0 * turns), lane), lane)
        return [(who[k], Period(tau * float(turns[k]), whole[k])) for k in np.nonzero(met)[0]]

    def _place(self, who: Lanes, turns: Lanes) -> Array:
        return np.asarray(self.initial + self.forward[who] * (BEHIND + tau * turns), dtype=np.float64)

    def _alike(self, one: Positions, other: Positions, lane: Lanes) -> Mask:
        """Where everything before the group stands alike, but for what Newton's method does not tell apart."""
        over = 1.0 / self.around.kinematics.take(lane).numbers.scale
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


def repeat_event(event: RadicandZero, tracks: CurveTracks, extent: tuple[float, float]) -> list[RadicandZero]:
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


FIRST, GREATEST, CAUTIOUS, LEAST = 0.02, 0.4, 0.005, 1e-9
"""Steps of the arc, in rad and in the greatest length: the first, the greatest, the one from which on a group may
come near to being singular, and the one at which it is given up."""
TARGET, TRUST = 3e-4, 3e-2
"""By how much of its step a foretold place should be wrong, and the most that it may."""
STRAIGHT = 0.9
"""Cosine of the angle by which the curve may turn in a step."""
SHRINKING = 0.3
"""Part of a bordered determinant that must be left after a step, but for small ones."""
AT_A_STOP = 1e-6
"""A group that cannot be followed any further this close to a limit of one before it ends with that."""
MOST = 400
"""Places a unit of the path, and in all at least, after which a group is given up."""
# They are tuned for few places, not for exactness: every place is solved from its own equations. Of 22 random groups
# (27 places each, in both senses) half and double of TARGET cost 5 % more and 2 % fewer places, half of TRUST 1 %
# more, twice TRUST, half and double of CAUTIOUS and half of SHRINKING nothing. Positions differed by 3e-14 at most,
# statuses and events not at all. Of the others: FIRST only has to be short, as steps grow twofold; STRAIGHT is 26
# degrees, so the next plane is met at a steep angle; GREATEST keeps several pieces in a turn where a polynomial
# foretells well by chance, and half of it costs 26 % more places (19 pairs of groups, positions the same to 2e-14);
# LEAST is far above the rounding of a place; MOST, some 2900 strides for a turn, bounds curves that wind for ever.


@dataclass
class Walkers:
    """All mechanisms of a batch, each in one sense of its path: where they are, and how they go on."""

    lane: Lanes
    forward: Array
    end: Array
    here: CurvePlaces
    step: Array
    sense: Array
    last: Array
    """Polynomials of the last pieces."""
    passed: Array
    """Their arcs, and the rate of these by the present ones: (k, 2)."""
    trails: list[Trail]
    rounds: Rounds
    active: Mask

    def stop(self, walker: np.intp, lost: bool = False) -> None:
        """The walker has arrived, or cannot follow any further."""
        self.active[walker] = False
        if lost:
            self.trails[walker].end = "lost"


def trace(
    around: Surroundings,
    start: Array,
    initial: float,
    extent: tuple[float, float],
    reaches: Array,
    smooth: bool,
) -> tuple[CurveTracks, list[RadicandZero]]:
    """Tracks of a group from the states (lanes, width) in the initial position, and the events on the way.

    `reaches` (lanes, 2) are the nearest limits of the groups before it, where what it stands on ends.
    """
    walkers = _setting_out(around, start, initial, extent)
    events: list[RadicandZero] = []
    # strides are bounded, so that a curve which winds for ever inside the range is given up
    most = MOST * (1.0 + float(np.max(np.abs(walkers.end - initial))) / around.unit)
    while walkers.active.any() and most > 0:
        most -= 1
        events += _stride(around, walkers, np.nonzero(walkers.active)[0], smooth)
    for walker in np.nonzero(walkers.active)[0]:
        walkers.stop(walker, lost=True)
    lanes = len(start)
    # what it stands on ends there: behind that limit nothing of the group can be computed, and its own end is
    # the same
    for trail, stop in zip(walkers.trails, reaches.T.reshape(-1), strict=True):
        if (
            trail.end == "lost"
            and trail.pieces
            and abs(trail.pieces[-1].last - stop) <= AT_A_STOP * around.unit
        ):
            trail.end, trail.limit = "limit", float(stop)
    tracks = CurveTracks.of(initial, walkers.trails[:lanes], walkers.trails[lanes:], start.shape[1])
    return tracks, [other for event in events for other in repeat_event(event, tracks, extent)]


def _setting_out(around: Surroundings, start: Array, initial: float, extent: tuple[float, float]) -> Walkers:
    lanes = len(start)
    both = np.tile(np.arange(lanes), 2)
    forward = np.repeat([-1.0, 1.0], lanes)
    ends = np.where(forward < 0.0, *extent)
    state, parameter = np.tile(start, (2, 1)), np.full(2 * lanes, initial)
    trails, rounds = [Trail() for _ in both], Rounds.of(around, both, forward, initial, start.shape[1])
    ended = np.zeros(2 * lanes, dtype=bool)
    loops = around.loops_at(parameter, both)
    if loops is not None:
        ended = _by_parameter(around, loops, state, parameter, ends, trails, rounds)
    width = start.shape[1] + 1
    if ended.all():
        nowhere = CurvePlaces(*np.full((6, 2 * lanes, 1), np.nan))
        none = np.zeros(2 * lanes)
        return Walkers(
            both, forward, ends, nowhere, none, none, none[:, None, None], none[:, None], trails, rounds, ~ended
        )  # fmt: skip
    free = around.blank(both).free
    # the first plane is square to the parameter's axis: the beginning has its parameter exactly
    along = np.zeros((2 * lanes, free + 1))
    along[:, -1] = forward
    numbers = np.concatenate([state, parameter[:, None]], axis=1)
    direction = np.zeros(numbers.shape)
    direction[:, -1] = forward
    weight = np.full(numbers.shape, 1.0 / around.unit)
    weight[:, :-1] = around.blank(both).weights()
    base = CurvePlaces(numbers, direction, direction, along, forward, weight)
    first_places = reach(around, both, base, along, parameter, state)
    here, found = first_places.places, first_places.found
    walkers = Walkers(
        both, forward, ends, here, np.full(2 * lanes, FIRST),
        np.sign(here.size), np.full((2 * lanes, 6, width), np.nan), np.zeros((2 * lanes, 2)),
        trails, rounds, found & ~ended,
    )  # fmt: skip
    for walker in np.nonzero(~found)[0]:
        walkers.stop(walker, lost=True)
    return walkers


def _by_parameter(
    around: Surroundings,
    loops: LoopClosure,
    state: Array,
    parameter: Array,
    ends: Array,
    trails: Sequence[Trail],
    rounds: Rounds,
) -> Mask:
    """Follow walkers by the parameter as far as it goes; puts there where they have come to, says which have ended."""

    def closed_courses(who: Lanes, courses: Sequence[WalkerCourse]) -> list[np.intp]:
        reached = np.array([courses[walker].parameter[-1] for walker in who])
        passing = rounds.passing(who, reached)
        if not passing.any():
            return []
        who, reached = who[passing], reached[passing]
        origin = np.array([courses[walker].parameter[-2] for walker in who])
        pieces = np.concatenate([courses[walker].pieces(loops, -2) for walker in who])
        round_again = rounds.closings(who, origin, pieces, reached)
        for walker, period in round_again:
            trails[int(walker)].period = period
        return [walker for walker, _period in round_again]

    courses = walk_by_parameter(around, loops, rounds.lane, state, float(parameter[0]), ends, closed_courses)
    for walker, course in enumerate(courses):
        if not course.regular:
            # what lies between two places has to be looked at from near by: all the way is gone along the curve
            course.ended, trails[walker].period = False, None
            rounds.set_out(walker)
            continue
        edges = pairwise(course.parameter)
        for powers, (first, last) in zip(course.pieces(loops), edges, strict=True):
            trails[walker].pieces.append(CurvePiece(powers, first, first, last, course.sense))
            state[walker], parameter[walker] = loops.state(course.series[-1][:1])[0], last
    return np.array([course.ended for course in courses])


def _stride(around: Surroundings, walkers: Walkers, who: Lanes, smooth: bool) -> list[RadicandZero]:
    """Go on with some walkers by one step; returns the events on the way."""
    here = walkers.here.of(who)
    parameter, state = _foretold(around, walkers, who, here)
    step = walkers.step[who]
    there = reach(around, walkers.lane[who], here, here.along, parameter, state, step)
    with np.errstate(all="ignore"):
        # a step counts if the place was foretold nearly right, the curve has not turned away, and it went
        # forwards
        cosine = total(there.places.along * here.along)
        left = np.abs(there.places.size / here.size)
        good = there.found & (there.wrong <= TRUST * step) & (cosine >= STRAIGHT) & (there.arc > 0.0)
        # a bordered determinant that falls fast may have passed zero twice: only short steps are trusted with
        # it
        good &= (step <= CAUTIOUS) | (left >= SHRINKING)
        crossed = good & (np.sign(there.places.size) != np.sign(here.size))
        # a change of sign is looked into from near by, where a crossing and a near miss are told apart
        good &= ~crossed | (step <= CAUTIOUS)
    events: list[RadicandZero] = []
    passed = np.full(len(who), np.nan)
    for k in np.nonzero(crossed & good)[0]:
        walker = np.array([k])
        at = curve_crossing(around, walkers.lane[who[walker]], here.of(walker), there.of(walker))
        if at is None:
            good[k] = False  # the curves only come near each other
        else:
            passed[k] = at
            events.append(RadicandZero("change point", around.group, int(walkers.lane[who[k]]), at))
    _shorten(walkers, who[~good])
    # the parameter runs against the sense of the way: it has turned back, so a limit was passed
    ends = good & (there.places.along[:, -1] * walkers.forward[who] <= 0.0)
    on = good & ~ends
    if ends.any():
        events += _turn_back(around, walkers, who[ends], here.of(ends), there.of(ends))
    if on.any():
        _go_on(walkers, who[on], here.of(on), there.of(on), passed[on], smooth)
    return events


def _foretold(around: Surroundings, walkers: Walkers, who: Lanes, here: CurvePlaces) -> tuple[Array, Array]:
    """Parameters and states a step ahead, by the last pieces, or by Taylor's polynomial at the start."""
    step = walkers.step[who][:, None]
    # without a last piece the second Taylor coefficient foretells
    taylor = step * (here.first + step * here.second)
    passed, rate = walkers.passed[who].T[:, :, None]
    with np.errstate(all="ignore"):
        # the last polynomial is continued beyond its end at share 1, by the step in units of its own arc
        share = 1.0 + step * rate / passed
        value = np.zeros(taylor.shape)
        for k in range(5, -1, -1):
            value = value * share + walkers.last[who, k]
        end = total(walkers.last[who])
    # only the change since the end of the piece is taken: rounding of the polynomial does not add up
    ahead = np.where(np.isfinite(value), value - end, taylor)
    parameter = here.parameter + ahead[:, -1]
    return parameter, around.normalise(here.state + ahead[:, :-1], walkers.lane[who])


def _shorten(walkers: Walkers, who: Lanes) -> None:
    # below a half: a step that fails twice in a row is six times shorter, and few steps are tried for nothing
    walkers.step[who] *= 0.4
    for walker in who[walkers.step[who] < LEAST]:
        walkers.stop(walker, lost=True)


def _go_on(
    walkers: Walkers, who: Lanes, here: CurvePlaces, there: ReachedPlace, passed: Array, smooth: bool
) -> None:
    """Leave pieces to the places reached, and stand there."""
    pieces = quintic(here, there)
    for k, walker in enumerate(who):
        # a change point splits the piece, as the sign of the determinant differs before and behind it
        trail, parts = walkers.trails[walker], [float(here.parameter[k]), float(there.places.parameter[k])]
        if np.isfinite(passed[k]):
            parts.insert(1, float(passed[k]))
        for number, (first, last) in enumerate(pairwise(parts)):
            sense = float(walkers.sense[walker] * walkers.forward[walker]) * (-1.0) ** number
            trail.pieces.append(CurvePiece(pieces[k], float(here.parameter[k]), first, last, sense))
            # where the assembly is kept, nothing goes through a change point
            if number == 0 and len(parts) == 3 and not smooth:
                walkers.stop(walker, lost=True)
                break
        if np.isfinite(passed[k]):
            walkers.sense[walker] *= -1.0
        if walkers.forward[walker] * (parts[-1] - walkers.end[walker]) >= 0.0:
            walkers.stop(walker)
    walkers.last[who] = pieces
    walkers.passed[who, 0] = there.arc
    walkers.passed[who, 1] = here.distance(there.places.first)
    walkers.here.put(who, there.places)
    with np.errstate(all="ignore"):
        # a continued quintic is wrong by the sixth power of the step, and TARGET is a share of the step:
        # hence the fifth root
        longer = np.clip((TARGET * walkers.step[who] / there.wrong) ** (1.0 / 5.0), 0.3, 2.0)
    walkers.step[who] = np.minimum(walkers.step[who] * longer, GREATEST)
    for walker, period in walkers.rounds.closings(who, here.parameter, pieces, there.places.parameter):
        if walkers.trails[walker].end == "on":
            walkers.trails[walker].period = period
            walkers.stop(walker)


def _turn_back(
    around: Surroundings, walkers: Walkers, who: Lanes, here: CurvePlaces, there: ReachedPlace
) -> list[RadicandZero]:
    """Limits between places and those found beyond them; the walkers stop there."""
    limit = limits(around, walkers.lane[who], here, there)
    # from nearer by, the polynomial between the places foretells the limit better
    _shorten(walkers, who[~limit.reached.found])
    pieces = quintic(here, limit.reached)
    events = []
    for k, walker in enumerate(who):
        trail, at = walkers.trails[walker], float(limit.reached.places.parameter[k])
        if not limit.reached.found[k]:
            continue
        walkers.stop(walker)
        sense = float(walkers.sense[walker] * walkers.forward[walker])
        start = float(here.parameter[k])
        trail.pieces.append(CurvePiece(pieces[k], start, start, at, sense))
        trail.end, trail.limit, trail.margin = "limit", at, float(limit.margin[k])
        trail.state = limit.reached.places.state[k]
        backwards = bool(walkers.forward[walker] < 0.0)
        events.append(RadicandZero("limit", around.group, int(walkers.lane[walker]), at, backwards))
    return events
