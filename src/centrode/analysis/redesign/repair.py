"""The smallest change after which a mechanism turns fully, verified by its geometry."""

from __future__ import annotations

import functools
import importlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import asin, pi, radians, sin, sqrt, tau
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.analysis.redesign.candidates import (
    Batch,
    Bounds,
    Candidates,
    Impossibility,
    Value,
    Varying,
    check_greatest_change,
    impossible,
    read_least_angle,
    varyings,
)
from centrode.analysis.rotatability.rotatability import Rotatability, rotatability
from centrode.errors import CentrodeError, InputError, NotComputedYet
from centrode.geometry.plane import PlaneCircle, dot, subtract
from centrode.kinematics.dyads import loci_of, solve_group
from centrode.kinematics.plan_evaluation import FixedSigns, Kinematics, SideChoices
from centrode.kinematics.preparation import Ready, ready
from centrode.locale import _
from centrode.model.examples.catalogue import MechanismSource, mechanism_of
from centrode.model.mechanism import Mechanism
from centrode.numerics.arrays import ARRAYS
from centrode.printed_results import PrintsSummary
from centrode.structure.constraints import Positions
from centrode.structure.groups import Aim, Group, Meet, Newton

# How well the dyads of many mechanisms close over one turn: squared sines of their transmission angles.
#
# The squared sine is a group's radicand over its own greatest value. It falls through zero where the group
# begins to be open, so it tells as well by how much a mechanism fails to turn.

Array: TypeAlias = npt.NDArray[np.float64]
Number: TypeAlias = Any

ABSENT = -1.0
"""Stands for a group where one before it is open."""


def squared_sines(batch: Batch, along: Array) -> Array:
    """Squared sines (lanes, groups, nodes) of transmission angles at values of the drive; NaN behind an open group."""
    kinematics, nodes = batch.kinematics, len(along)
    at = kinematics.frame(ARRAYS, along[None, :])
    hooks = _Keeping(batch.signs)
    ratios = []
    with np.errstate(all="ignore"):
        for index, group in enumerate(kinematics.structure.groups):
            choices = SideChoices(hooks, index)
            size = _greatest(kinematics, group, at, choices)
            solve_group(group, ARRAYS, kinematics.numbers, at, choices)
            # the root's argument was kept on the way: nothing is computed twice
            if size is not None:
                ratio = hooks.kept[index] / size
                ratios.append(np.broadcast_to(ratio, (batch.size, nodes)))
    if not ratios:
        # without a dyad nothing can lock
        return np.ones((batch.size, 1, nodes))
    return np.stack(ratios, axis=1)


def over_turn(batch: Batch, nodes: int) -> Array:
    """Values of the drive over one turn, between the round ones at which events like to lie."""
    return np.asarray(batch.kinematics.path.initial + (np.arange(nodes) + 0.5) * (tau / nodes))


class _Keeping(FixedSigns):
    """Fixed signs; radicands, and squares of divisors, are kept by their groups."""

    def __init__(self, signs: Mapping[int, Number]) -> None:
        super().__init__(ARRAYS, signs)
        self.kept: dict[int, Number] = {}

    def root(self, group: int, radicand: Number) -> Number:
        self.kept[group] = radicand
        return super().root(group, radicand)

    def divisor(self, group: int, divisor: Number) -> Number:
        self.kept[group] = divisor * divisor
        return divisor


def _greatest(kinematics: Kinematics, group: Group, at: Positions, choices: SideChoices) -> Number | None:
    """The radicand of a group at a transmission angle of 90 degrees; None for a group without one."""
    numbers = kinematics.numbers
    if isinstance(group, Aim):
        arm = subtract(at.points[group.target], at.points[group.pivot])
        return dot(arm, arm)
    if not isinstance(group, Meet):
        return None
    one, other = loci_of(group, ARRAYS, numbers, at, choices)
    if hasattr(one, "half"):
        return _sine(one) ** 2 * _sine(other) ** 2
    if not isinstance(one, PlaneCircle):
        return 1.0
    if not isinstance(other, PlaneCircle):
        return one.radius**2
    return (2.0 * one.radius * other.radius) ** 2


def _sine(circle: Any) -> Number:
    """Sine of a circle's arc on the sphere."""
    sine, cosine = circle.half
    return 2.0 * sine * cosine


def least(sines: Array) -> Array:
    """The least squared sine of every mechanism (lanes,)."""
    # behind an open group nothing is known: the least is that group's own, negative one
    return np.asarray(least_by_sector(np.where(np.isnan(sines), np.inf, sines), 1).min(axis=1))


def least_by_sector(sines: Array, sectors: int) -> Array:
    """The least squared sine of every group in every sector of the turn: (lanes, groups * sectors).

    Between nodes it is that of the parabola through three of them, so that it changes smoothly with the mechanism.
    """
    lanes, groups, nodes = sines.shape
    known = np.where(np.isnan(sines), ABSENT, sines)
    width = nodes // sectors
    first = width * np.arange(sectors)
    lowest = known.reshape(lanes, groups, sectors, width).argmin(axis=3) + first
    before, here, behind = (np.take_along_axis(known, (lowest + step) % nodes, axis=2) for step in (-1, 0, 1))
    with np.errstate(all="ignore"):
        # the parabola through three nodes, its lowest point within half a cell of the lowest node
        slope, bend = 0.5 * (behind - before), behind - 2.0 * here + before
        shift = np.clip(-slope / bend, -0.5, 0.5)
        below = np.where(bend > 0.0, shift * (slope + 0.5 * shift * bend), 0.0)
    # beside an absent value the parabola would measure a jump
    smooth = np.isfinite(below) & (before != ABSENT) & (behind != ABSENT)
    return np.asarray((here + np.where(smooth, below, 0.0)).reshape(lanes, groups * sectors))


# The search for the smallest change: candidates spread over the bounds, then the best of them drawn towards
# no change.
#
# Nothing is random: candidates are those of an additive sequence (Roberts, The unreasonable effectiveness of
# quasirandom sequences, 2018), so the same question has the same answer.

Progress: TypeAlias = Callable[[int, int], None]

CHUNK, COARSE = 256, 180
"""Candidates evaluated together, and nodes of the turn on which they are looked at first."""
FINE, SECTORS = 720, 12
"""Nodes on which a candidate is improved, and sectors of the turn of which each has a condition of its own."""
SHELLS = (1.0, 0.6, 0.35, 0.2, 0.1, 0.05)
"""Candidates lie in the whole box and in smaller ones about no change, in turn."""
STARTS = 6
"""Candidates that are improved."""
APART = 0.1
"""Starts closer than this, scaled by the box, lead to the same place."""
STEP = 1e-6
"""Of differences, in scaled changes: half the digits of a squared sine."""
SLACK = 1e-5
"""By which part of it the quadratic programming aims above the target, so that its rounding does not fall short."""
CORRECTIONS, ACTIVE = 4, 0.02
"""Small steps back to where all conditions hold, and how near to the target a condition counts for them."""
RAISED = 3
"""Candidates from which the greatest transmission angle is sought."""
ITERATIONS = 60
CONTRACTIONS = 40
# Tuned on the thirty variants of the course assignment. Of five of them, repaired to 10 degrees, the sizes are the
# same to 1e-6 with half and double of CANDIDATES (38 % fewer, 81 % more evaluations in all) and with half of STARTS
# (12 % fewer). Sectors are for turns with several low places: each has a condition of its own. Shells are for small
# changes, which are wanted: an even spread of the box has few of them. The coarse nodes are every fourth fine one, so
# a candidate that fails on them fails on all.

SAID = 100
"""Progress is said every so many candidates."""

# what is needed for a repair alone is not loaded before
_optimize = functools.partial(importlib.import_module, "scipy.optimize")


@dataclass
class RepairSearch:
    """A search among candidates for the least change with squared sines of at least `target`.

    `tried` counts the candidates that were evaluated, `turning` those of the first, even spread that are good enough.
    """

    candidates: Candidates
    target: float
    progress: Progress | None = None
    tried: int = 0
    turning: int = 0
    spread: int = 0
    total: int = 0
    _low: Array = field(init=False)
    _high: Array = field(init=False)

    def __post_init__(self) -> None:
        self._low, self._high = self.candidates.box()

    def margins(self, changes: Array, nodes: int = COARSE) -> Array:
        """Least squared sine over the turn of every candidate (n,)."""
        parts = []
        for first in range(0, len(changes), CHUNK):
            some = changes[first : first + CHUNK]
            batch = self.candidates.batch(some)
            parts.append(least(squared_sines(batch, over_turn(batch, nodes))))
            self._count(len(some))
        return np.concatenate(parts)

    def run(self, spread: int) -> list[Array]:
        """Scaled changes that are good enough on the fine nodes, the smallest first."""
        self.spread = spread
        # an estimate for progress alone: gradients are differences, two candidates for each number
        self.total = spread + STARTS * (CONTRACTIONS + ITERATIONS * (2 * len(self._low) + 1))
        changes = self._spread(spread)
        margins = self.margins(changes)
        good = margins >= self.target
        self.turning = int(good.sum())
        # the good ones by size; where none is good those that lack least
        starts = self._apart(changes[good], np.linalg.norm(changes[good], axis=1))
        if not starts:
            starts = self._apart(changes, -margins)
        improved = [self.improve(start) for start in starts]
        reached = [change for change in improved if change is not None]
        if self.progress is not None:
            self.progress(self.total, self.total)
        return sorted(reached, key=lambda change: float(np.linalg.norm(change)))

    def greatest(self, spread: int) -> float | None:
        """The greatest transmission angle [rad] that a candidate or one near the best keeps; None where none turns."""
        changes = self._spread(spread)
        margins = self.margins(changes)
        starts = self._apart(changes, -margins)
        raised = [self._raise(start) for start in starts[:RAISED]]
        most = float(self.margins(np.array([*starts, *raised]), FINE).max())
        return asin(sqrt(min(most, 1.0))) if most > 0.0 else None

    def _raise(self, start: Array) -> Array:
        """A candidate near a start whose lowest sector is as high as it gets, by sequential quadratic programming."""
        first = np.append(start, float(self.margins(start[None, :], FINE)[0]))
        box = [*zip(self._low, self._high, strict=True), (None, 1.0)]
        result: Any = _optimize().minimize(
            lambda x: -float(x[-1]),
            first,
            jac=lambda x: np.append(np.zeros(len(start)), -1.0),
            bounds=box,
            constraints={
                "type": "ineq",
                "fun": lambda x: self._sectors(x[None, :-1])[0] - x[-1],
                "jac": lambda x: np.column_stack(
                    [(slopes := self._slopes(x[:-1]) * self.target), -np.ones(len(slopes))]
                ),
            },
            method="SLSQP",
            options={"maxiter": ITERATIONS, "ftol": 1e-12},
        )
        raised = np.clip(np.asarray(result.x[:-1], dtype=np.float64), self._low, self._high)
        return raised if np.isfinite(raised).all() else start

    def _count(self, more: int) -> None:
        """Count candidates, and say how far it is now and then."""
        before, self.tried = self.tried, self.tried + more
        if self.progress is not None and before // SAID < self.tried // SAID:
            self.progress(min(self.tried, self.total), self.total)

    def _spread(self, count: int) -> Array:
        """No change, then an even spread over the box and over smaller boxes."""
        size = len(self._low)
        root = 2.0
        # root of x^(n+1) = x + 1 by iteration, the generalised golden ratio: its powers spread evenly in n
        # dimensions
        for _step in range(50):
            root = (1.0 + root) ** (1.0 / (size + 1))
        # each dimension by its own power of the root
        steps = root ** -np.arange(1.0, size + 1)
        share = (0.5 + np.outer(np.arange(1, count), steps)) % 1.0
        shell = np.resize(SHELLS, count - 1)[:, None]
        # no change is zero and lies in the box: scaling shrinks the box about it
        inside = (self._low + share * (self._high - self._low)) * shell
        return np.vstack([np.zeros((1, size)), inside])

    def _apart(self, changes: Array, order: Array) -> list[Array]:
        """The first few changes by an order that do not lie close together."""
        # a bound that leaves no room measures nothing
        width = np.where(self._high > self._low, self._high - self._low, 1.0)
        kept: list[Array] = []
        for k in np.argsort(order, kind="stable"):
            if all(np.linalg.norm((changes[k] - other) / width) > APART for other in kept):
                kept.append(changes[k])
            if len(kept) == STARTS:
                break
        return kept

    def improve(self, start: Array) -> Array | None:
        """The least change near a start that is good enough on the fine nodes; None if there is none."""
        options = []
        drawn = self._shorten(start)
        # from both starts: the search ends in the nearest local minimum
        for first in (start,) if drawn is None else (drawn, start):
            least_change = self._minimise(first)
            if least_change is not None:
                options.append(least_change)
        options += [] if drawn is None else [drawn]
        return min(options, key=lambda change: float(np.linalg.norm(change)), default=None)

    def _shorten(self, start: Array) -> Array | None:
        """The least part of a change that is good enough, if the whole of it is."""
        if self.margins(start[None, :], FINE)[0] < self.target:
            return None
        # from no change outwards: the first share that is good is the smallest
        shares = np.linspace(0.0, 1.0, CONTRACTIONS)[:, None]
        good = self.margins(shares * start, FINE) >= self.target
        return np.asarray(start * shares[int(np.nonzero(good)[0][0])])

    def _minimise(self, start: Array) -> Array | None:
        """Sequential quadratic programming from a start, on the conditions of all sectors."""
        result: Any = _optimize().minimize(
            lambda x: float(x @ x),
            start,
            jac=lambda x: 2.0 * x,
            bounds=list(zip(self._low, self._high, strict=True)),
            constraints={"type": "ineq", "fun": self._conditions, "jac": self._slopes},
            method="SLSQP",
            options={"maxiter": ITERATIONS, "ftol": 1e-12},
        )
        change = np.clip(np.asarray(result.x, dtype=np.float64), self._low, self._high)
        if not np.isfinite(change).all():
            return None
        # the optimiser stops within its tolerance, on either side of the target
        for _correction in range(CORRECTIONS):
            lack = self.target - float(self.margins(change[None, :], FINE)[0])
            if lack <= 0.0:
                return change
            change = self.raise_sines(change, lack)
        return None

    def raise_sines(self, change: Array, lack: float) -> Array:
        """A change moved as little as lifts its least squared sines by what they lack (and a little more)."""
        values, slopes = self._sectors(change[None, :])[0], self._slopes(change) * self.target
        # several sectors near the lowest are lifted at once: of one alone another would fall below
        lowest = values <= float(values.min()) + ACTIVE * self.target
        # the smallest change with that rise to the first order; half more, since the rise is no straight line
        moved = change + np.linalg.pinv(slopes[lowest], rcond=1e-6) @ np.full(int(lowest.sum()), 1.5 * lack)
        return np.asarray(np.clip(moved, self._low, self._high))

    def _conditions(self, change: Array) -> Array:
        # relative to the target, so that all conditions are of the order of one
        return np.asarray(self._sectors(change[None, :])[0] / self.target - (1.0 + SLACK))

    def _sectors(self, changes: Array) -> Array:
        self._count(len(changes))
        batch = self.candidates.batch(changes)
        return least_by_sector(squared_sines(batch, over_turn(batch, FINE)), SECTORS)

    def _slopes(self, change: Array) -> Array:
        size = len(change)
        # central differences: the error is of the second order in the step
        moved = np.vstack([change + STEP * np.eye(size), change - STEP * np.eye(size)])
        sines = self._sectors(moved)
        return np.asarray((sines[:size] - sines[size:]).T / (2.0 * STEP * self.target))


LEAST_ANGLES = tuple(map(radians, (20.0, 10.0, 5.0, 2.0, 1.0)))
"""Least transmission angles [rad] that are requested one after the other where none is given, of one dimension and of
several: the first one within reach. Less than 20 degrees jams by the friction of ordinary hinges, a good transmission
of forces needs some 30 to 40; 0 would be a mechanism at the brink of locking."""
CANDIDATES = 3072
"""Candidates of the first spread."""
TIGHTENINGS = 4
"""How often a change is corrected by what its exact least angle lacks."""
ENOUGH = 1e-9
"""By how much [rad] the verified least transmission angle may fall short of the one requested."""


@dataclass(frozen=True)
class Change:
    """Number of a description before and after.

    Attributes
    ----------
    unit : "rad", "m" or "1"
    size : its part of the change: radians of an angle, of a length the change over the length
    """

    path: str
    before: float
    after: float
    unit: str
    size: float


@dataclass(frozen=True, repr=False)
class Repair(PrintsSummary):
    """Result of a repair: the mechanism found, its changes, and what was tried.

    Attributes
    ----------
    mechanism : the one given
    repaired : the one found; the one given if that turns already; None if none was found
    found : whether a mechanism was found that turns fully with the transmission angle requested
    size : root of the sum of the squares of the changes' sizes
    least_transmission_angle, reached : as required, and that of the mechanism found (exact) [rad]
    wanted : as requested; greater than the one required where it is out of reach and none was named [rad]
    greatest : the greatest that any candidate keeps, where the one requested is out of reach; else None [rad]
    tried : candidates evaluated
    spread, turning : candidates of the first spread over the bounds, and how many of these turn
    impossible : the inequality that excludes the angle requested; None where nothing says so
    changes : of every number that may vary
    varying : what could change, with its bounds
    before, after : Rotatability of the mechanism given and of the one found
    """

    mechanism: Mechanism
    repaired: Mechanism | None
    found: bool
    size: float
    least_transmission_angle: float
    reached: float | None
    tried: int
    spread: int
    turning: int
    impossible: Impossibility | None
    changes: tuple[Change, ...]
    varying: tuple[Varying, ...]
    before: Rotatability
    after: Rotatability | None
    wanted: float = 0.0
    greatest: float | None = None


def repair(
    mechanism: MechanismSource,
    vary: Sequence[str] | None = None,
    bounds: Bounds | None = None,
    least_transmission_angle: Value | None = None,
    progress: Progress | None = None,
    greatest_change: float | None = None,
) -> Repair:
    """The smallest change that was found after which a mechanism turns fully.

    Parameters
    ----------
    vary : paths of numbers that may change
        Initial angles (where they place something), lengths, coordinates, directions. Left out: the initial
        angles of all links that are not driven, where these place something, otherwise all lengths.
    bounds : path -> (least, greatest) value [rad, m, or texts with units]
        Left out: half a turn to both sides, half to double of a length, half the greatest length to both sides of
        a coordinate.
    least_transmission_angle : float [rad] or text
        What every dyad keeps all over the turn. Left out: 20 degrees, or where these are out of reach the first of
        10, 5, 2 and 1 degrees that is not.
    progress : called with (candidates evaluated, candidates in all at most)
    greatest_change : float, optional
        Greatest change of a number without bounds of its own: of a length over itself, of a coordinate over the
        greatest length, below 1. Initial angles stay free. It only narrows the bounds that hold without it.

    Returns
    -------
    Repair
        A change is as large as the root of the sum of squares of radians (angles) and of changes over lengths.
        What is returned is verified by `rotatability`: it turns, with the exact least transmission angle. It is
        the smallest change found, a local minimum; smaller ones elsewhere are not excluded.

    Raises
    ------
    InputError
        A path, a bound or the greatest change is wrong, the drive is not an angle or not the only one.
    NotComputedYet
        Groups of higher class, gears and rolling wheels.

    Examples
    --------
    >>> import centrode as ct
    >>> found = ct.repair(ct.four_bar(2, 3, 2.5, 2.5), ["links.crank.length"])
    >>> found.found, round(found.reached, 3)
    (True, 0.349)
    """
    mechanism = mechanism_of(mechanism)
    prepared = ready(mechanism)
    check_repairable(prepared)
    named = read_least_angle(least_transmission_angle, mechanism.display)
    check_greatest_change(greatest_change)
    wanted = LEAST_ANGLES[0] if named is None else named
    varying = varyings(prepared, vary, bounds, greatest_change)
    before = rotatability(mechanism)
    asked = Repair(
        mechanism, None, False, 0.0, wanted, None, 0, 0, 0, None, (), varying, before, None, wanted
    )
    if turns_well(before, wanted):
        return replace(asked, found=True, repaired=mechanism, reached=least_angle_of(before), after=before)
    candidates = Candidates(prepared, varying)
    # a proof that nothing helps is cheaper than a search that finds nothing, and says why
    reason = impossible(candidates, wanted)
    found = asked if reason is not None else _search_repair(candidates, asked, progress)
    if found.found:
        return found
    found = replace(found, impossible=reason)
    greatest = RepairSearch(candidates, 1.0).greatest(CANDIDATES)
    if greatest is None:
        return found
    found = replace(found, greatest=greatest)
    for angle in LEAST_ANGLES if named is None else ():
        if angle > min(greatest, wanted - ENOUGH):
            continue
        lower = replace(found, least_transmission_angle=angle)
        if turns_well(before, angle):
            least_before = least_angle_of(before)
            return replace(lower, found=True, repaired=mechanism, reached=least_before, after=before)
        lower = _search_repair(candidates, lower, progress)
        if lower.found:
            return lower
    return found


def needs_repair(mechanism: Mechanism) -> bool:
    """Whether its one drive does not turn fully, and a repair can be sought."""
    try:
        check_repairable(ready(mechanism))
    except CentrodeError:
        return False
    return rotatability(mechanism).turns_fully is False


def turns_well(found: Rotatability, least_angle: float) -> bool:
    """Whether a mechanism turns fully with at least a transmission angle in every dyad."""
    return found.turns_fully is True and least_angle_of(found) >= least_angle - ENOUGH


def least_angle_of(found: Rotatability) -> float:
    """The least transmission angle [rad] of all dyads over the turn."""
    return min((transmission.least for transmission in found.one.transmissions), default=pi / 2)


def check_repairable(prepared: Ready, *, turning: bool = True) -> None:
    """Raise InputError or NotComputedYet where no repair can be sought; `turning` drives have to turn fully."""
    mechanism = prepared.mechanism
    if len(mechanism.drives) != 1:
        raise InputError(
            "[[drives]]",
            _("a repair is computed for one drive; {n} are given").format(n=len(mechanism.drives)),
            _("give one drive"),
        )
    if turning and mechanism.drives[0].kind != "angle":
        raise InputError("[[drives]]", _("a displacement cannot turn fully"), _("drive the angle of a link"))
    groups = prepared.structure.groups
    on_sphere = mechanism.space == "sphere"
    lacking = [
        (any(isinstance(group, Newton) for group in groups), _("groups of higher class")),
        (bool(mechanism.gears or mechanism.rolling), _("gears and rolling wheels")),
        (
            on_sphere and any(isinstance(group, Aim) for group in groups),
            _("guides on moving links of a sphere"),
        ),
    ]
    for present, what in lacking:
        if present:
            raise NotComputedYet(
                "--repair", _("no repair is computed for {what}").format(what=what), _("change it by hand")
            )


def _search_repair(candidates: Candidates, asked: Repair, progress: Progress | None) -> Repair:
    """The smallest change that the geometry confirms."""
    least_angle = asked.least_transmission_angle
    # aimed above by as much as the verification lets pass below
    search = RepairSearch(candidates, sin(least_angle + ENOUGH) ** 2, progress)
    options = search.run(CANDIDATES)
    effort = replace(asked, spread=search.spread, turning=search.turning)
    for change in options:
        # by size: the first that the geometry confirms is the smallest
        confirmed = _confirm_change(search, change, least_angle)
        if confirmed is not None:
            change, mechanism, after = confirmed
            return replace(
                effort,
                found=True,
                repaired=mechanism,
                changes=_changes(candidates.varying, change),
                size=float(np.linalg.norm(change)),
                reached=least_angle_of(after),
                tried=search.tried,
                after=after,
            )
    return replace(effort, tried=search.tried)


def _confirm_change(
    search: RepairSearch, change: Any, least_angle: float
) -> tuple[Any, Mechanism, Rotatability] | None:
    """A change whose mechanism turns as asked by its geometry, corrected by what the exact least angle lacks."""
    for _attempt in range(TIGHTENINGS):
        try:
            mechanism = search.candidates.mechanism(change)
            after = rotatability(mechanism)
        except CentrodeError:
            return None
        if turns_well(after, least_angle):
            return change, mechanism, after
        # not turning by the exact test but by the nodes: the lack is between nodes, and unknown
        lack = search.target - sin(least_angle_of(after)) ** 2 if after.turns_fully else 0.1 * search.target
        change = search.raise_sines(change, max(lack, 0.0) + 1e-9 * search.target)
    return None


def _changes(varying: Sequence[Varying], change: Any) -> tuple[Change, ...]:
    return tuple(
        Change(number.path, number.before, number.before + float(x) * number.scale, number.unit, float(x))
        for number, x in zip(varying, change, strict=True)
    )
