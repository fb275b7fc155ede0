"""Following groups of higher class along the path, from the initial position outwards.

Steps choose themselves: the polynomial of the last piece foretells the next place, Newton's method finds it on a
plane square to the curve. Where the determinant bordered by the curve's direction changes its sign, two curves
meet or nearly meet (`crossings` tells which): a change point is passed straight on, a near miss in smaller steps.
Where the parameter turns back is a limit. A curve that closes after whole turns of the drive ends there.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.kinematics.branches import Event
from centrode.kinematics.higher_class.crossings import crossing
from centrode.kinematics.higher_class.curves import Places, Reached, quintic, reach
from centrode.kinematics.higher_class.limits import limits
from centrode.kinematics.higher_class.periods import Rounds, repeated
from centrode.kinematics.higher_class.surroundings import Surroundings
from centrode.kinematics.higher_class.system import total
from centrode.kinematics.higher_class.tracks import Piece, Tracks, Trail

Array: TypeAlias = npt.NDArray[np.float64]
Lanes: TypeAlias = npt.NDArray[np.intp]
Mask: TypeAlias = npt.NDArray[np.bool_]

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


@dataclass
class Walkers:
    """All mechanisms of a batch, each in one sense of its path: where they are, and how they go on."""

    lane: Lanes
    forward: Array
    end: Array
    here: Places
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
) -> tuple[Tracks, list[Event]]:
    """Tracks of a group from the states (lanes, width) in the initial position, and the events on the way.

    `reaches` (lanes, 2) are the nearest limits of the groups before it, where what it stands on ends.
    """
    walkers = _setting_out(around, start, initial, extent)
    events: list[Event] = []
    most = MOST * (1.0 + float(np.max(np.abs(walkers.end - initial))) / around.unit)
    while walkers.active.any() and most > 0:
        most -= 1
        events += _stride(around, walkers, np.nonzero(walkers.active)[0], smooth)
    for walker in np.nonzero(walkers.active)[0]:
        walkers.stop(walker, lost=True)
    lanes = len(start)
    for trail, stop in zip(walkers.trails, reaches.T.reshape(-1), strict=True):
        if (
            trail.end == "lost"
            and trail.pieces
            and abs(trail.pieces[-1].last - stop) <= AT_A_STOP * around.unit
        ):
            trail.end, trail.limit = "limit", float(stop)
    tracks = Tracks.of(initial, walkers.trails[:lanes], walkers.trails[lanes:], start.shape[1])
    return tracks, [other for event in events for other in repeated(event, tracks, extent)]


def _setting_out(around: Surroundings, start: Array, initial: float, extent: tuple[float, float]) -> Walkers:
    lanes = len(start)
    both = np.tile(np.arange(lanes), 2)
    forward = np.repeat([-1.0, 1.0], lanes)
    state, parameter = np.tile(start, (2, 1)), np.full(2 * lanes, initial)
    free = around.blank(both).free
    along = np.zeros((2 * lanes, free + 1))
    along[:, -1] = forward
    numbers = np.concatenate([state, parameter[:, None]], axis=1)
    direction = np.zeros(numbers.shape)
    direction[:, -1] = forward
    weight = np.full(numbers.shape, 1.0 / around.unit)
    weight[:, :-1] = around.blank(both).weights()
    base = Places(numbers, direction, direction, along, forward, weight)
    found = reach(around, both, base, along, parameter, state)
    here = found.places
    width = start.shape[1] + 1
    walkers = Walkers(
        both, forward, np.where(forward < 0.0, *extent), here, np.full(2 * lanes, FIRST),
        np.sign(here.size), np.full((2 * lanes, 6, width), np.nan), np.zeros((2 * lanes, 2)),
        [Trail() for _ in both], Rounds.of(around, both, forward, initial, start.shape[1]), found.found.copy(),
    )  # fmt: skip
    for walker in np.nonzero(~found.found)[0]:
        walkers.stop(walker, lost=True)
    return walkers


def _stride(around: Surroundings, walkers: Walkers, who: Lanes, smooth: bool) -> list[Event]:
    """One step of some walkers; returns the events on the way."""
    here = walkers.here.of(who)
    parameter, state = _foretold(around, walkers, who, here)
    step = walkers.step[who]
    there = reach(around, walkers.lane[who], here, here.along, parameter, state, step)
    with np.errstate(all="ignore"):
        cosine = total(there.places.along * here.along)
        left = np.abs(there.places.size / here.size)
        good = there.found & (there.wrong <= TRUST * step) & (cosine >= STRAIGHT) & (there.arc > 0.0)
        good &= (step <= CAUTIOUS) | (left >= SHRINKING)
        crossed = good & (np.sign(there.places.size) != np.sign(here.size))
        good &= ~crossed | (step <= CAUTIOUS)
    events: list[Event] = []
    passed = np.full(len(who), np.nan)
    for k in np.nonzero(crossed & good)[0]:
        one = np.array([k])
        at = crossing(around, walkers.lane[who[one]], here.of(one), there.of(one))
        if at is None:
            good[k] = False  # the curves only come near each other
        else:
            passed[k] = at
            events.append(Event("change point", around.group, int(walkers.lane[who[k]]), at))
    _shorten(walkers, who[~good])
    ends = good & (there.places.along[:, -1] * walkers.forward[who] <= 0.0)
    on = good & ~ends
    if ends.any():
        events += _turn_back(around, walkers, who[ends], here.of(ends), there.of(ends))
    if on.any():
        _go_on(walkers, who[on], here.of(on), there.of(on), passed[on], smooth)
    return events


def _foretold(around: Surroundings, walkers: Walkers, who: Lanes, here: Places) -> tuple[Array, Array]:
    """Parameters and states a step ahead, by the last pieces, or by Taylor's polynomial at the start."""
    step = walkers.step[who][:, None]
    taylor = step * (here.first + step * here.second)
    passed, rate = walkers.passed[who].T[:, :, None]
    with np.errstate(all="ignore"):
        share = 1.0 + step * rate / passed
        value = np.zeros(taylor.shape)
        for k in range(5, -1, -1):
            value = value * share + walkers.last[who, k]
        end = total(walkers.last[who])
    ahead = np.where(np.isfinite(value), value - end, taylor)
    parameter = here.parameter + ahead[:, -1]
    return parameter, around.blank(walkers.lane[who]).righted(here.state + ahead[:, :-1])


def _shorten(walkers: Walkers, who: Lanes) -> None:
    walkers.step[who] *= 0.4
    for walker in who[walkers.step[who] < LEAST]:
        walkers.stop(walker, lost=True)


def _go_on(walkers: Walkers, who: Lanes, here: Places, there: Reached, passed: Array, smooth: bool) -> None:
    """Leave pieces to the places reached, and stand there."""
    pieces = quintic(here, there)
    for k, walker in enumerate(who):
        trail, parts = walkers.trails[walker], [float(here.parameter[k]), float(there.places.parameter[k])]
        if np.isfinite(passed[k]):
            parts.insert(1, float(passed[k]))
        for number, (first, last) in enumerate(pairwise(parts)):
            sense = float(walkers.sense[walker] * walkers.forward[walker]) * (-1.0) ** number
            trail.pieces.append(Piece(pieces[k], float(here.parameter[k]), first, last, sense))
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
        longer = np.clip((TARGET * walkers.step[who] / there.wrong) ** (1.0 / 5.0), 0.3, 2.0)
    walkers.step[who] = np.minimum(walkers.step[who] * longer, GREATEST)
    for walker, period in walkers.rounds.closed(who, here.parameter, pieces, there.places.parameter):
        if walkers.trails[walker].end == "on":
            walkers.trails[walker].period = period
            walkers.stop(walker)


def _turn_back(
    around: Surroundings, walkers: Walkers, who: Lanes, here: Places, there: Reached
) -> list[Event]:
    """Limits between places and those found beyond them; the walkers stop there."""
    limit = limits(around, walkers.lane[who], here, there)
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
        trail.pieces.append(Piece(pieces[k], start, start, at, sense))
        trail.end, trail.limit, trail.margin = "limit", at, float(limit.margin[k])
        trail.state = limit.reached.places.state[k]
        backwards = bool(walkers.forward[walker] < 0.0)
        events.append(Event("limit", around.group, int(walkers.lane[walker]), at, backwards))
    return events
