"""One drive moved as far as it goes while the others stand still: the basis of all questions about turning."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations, product
from math import isfinite, pi, tau
from typing import Any, Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.kinematics.change_points import BranchedPlan, Smooth
from centrode.kinematics.events import EventScan
from centrode.kinematics.mesh import mesh_of
from centrode.kinematics.path import JETS, OFF_GRID
from centrode.kinematics.plan_evaluation import RadicandZero, rotor_of_angle, slide_of
from centrode.kinematics.preparation import Ready
from centrode.kinematics.samples import start_of
from centrode.kinematics.several_inputs.limits import check_closed, held_path, starting_at
from centrode.kinematics.solve import SEARCH, TURNS
from centrode.model.mechanism import Drive, Mechanism
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.jets import Jet
from centrode.numerics.search import newton_roots, sign_changes
from centrode.structure.constraints import Positions
from centrode.structure.groups import Meet

Array: TypeAlias = npt.NDArray[np.float64]
Number: TypeAlias = Any
Namespace: TypeAlias = Any

NODES_PER_TURN = 720
BACK = 1e-6
"""A mechanism is back in its position if no point is further from it than this part of the greatest length."""

ULPS = 4.0
"""A value this many units of the last place from an event is at it."""


@dataclass(frozen=True)
class DriveSweep:
    """The motion of one drive on both sides of the initial position, its events found.

    Attributes
    ----------
    held : values of the other drives [rad or m]
    low, high : nearest limits [rad or m], infinite where there is none within `extent`
    extent : how far they were looked for on both sides
    """

    prepared: Ready
    drive: Drive
    held: Mapping[str, float]
    continuation: BranchedPlan
    low: float
    high: float
    extent: float

    @property
    def initial(self) -> float:
        """The drive's value in the initial position."""
        return self.continuation.kinematics.path.initial

    @property
    def unit(self) -> str:
        """SI unit of the drive's value."""
        return self.prepared.parameter.drive(self.drive.id).unit

    @property
    def angular(self) -> bool:
        """Whether the drive is an angle, so that it could turn."""
        return self.drive.kind == "angle"

    @property
    def is_unlimited(self) -> bool:
        """Whether no limit was found on either side."""
        return not isfinite(self.low) and not isfinite(self.high)

    @cached_property
    def turns_fully(self) -> bool:
        """Whether the drive is an angle without limits, and every point has its place all over the stretch."""
        return self.angular and self.is_unlimited and bool(np.isfinite(self.places(self.nodes())).all())

    @cached_property
    def turns(self) -> int | None:
        """Turns of the drive after which every point is back; None where it is limited or not back after two."""
        if not (self.angular and self.is_unlimited):
            return None
        at = self.places(np.array([self.initial + tau * k for k in range(int(TURNS) + 1)]))
        scale = float(self.continuation.kinematics.numbers.scale)
        for k in range(1, int(TURNS) + 1):
            # a place that is not reached is no number, and not back
            if np.max(np.abs(at[:, k] - at[:, 0]), initial=0.0) <= BACK * scale:
                return k
        return None

    @property
    def span(self) -> tuple[float, float]:
        """The stretch that is looked at: whole turns in the drive's sense until it is back, or between the limits."""
        if self.angular and self.is_unlimited:
            way = tau * (self.turns or int(TURNS))
            # the range of a drive that runs backwards lies below its initial value
            backwards = self.continuation.kinematics.path.forward < 0.0
            return (self.initial - way, self.initial) if backwards else (self.initial, self.initial + way)
        return max(self.low, self.initial - self.extent), min(self.high, self.initial + self.extent)

    @property
    def comes_round(self) -> bool:
        """Whether the stretch ends where it begins."""
        return self.turns is not None and self.turns_fully

    def nodes(self) -> Array:
        """Values at which functions of the drive are looked at: even over turns, denser towards limits."""
        first, last = self.span
        if self.angular and self.is_unlimited:
            count = NODES_PER_TURN * round((last - first) / tau)
            # off the initial position by a share of a step: events like to lie at round values
            return np.asarray(first + (np.arange(count + 1) + OFF_GRID) * ((last - first) / count))
        # half a node off the ends: at limits derivatives are infinite
        share = 0.5 - 0.5 * np.cos(pi * (np.arange(NODES_PER_TURN) + 0.5) / NODES_PER_TURN)
        return np.asarray(first + (last - first) * share)

    def at(self, values: Array, order: int) -> Positions:
        """Positions (1, n) at values (n,) of the drive, as jets of an order."""
        along = values[None, :]
        with np.errstate(all="ignore"):
            return self.continuation.kinematics.positions(
                JETS, Jet.variable(along, order), self.continuation.hooks(JETS, along, None)
            )

    def positions_at(self, value: float, m: Namespace) -> Positions:
        """Positions (1, 1) at any value; of groups that have an event there, the root is zero and not its rounding."""
        along = np.array([[value]])
        margin = ULPS * float(np.spacing(abs(value) + self.continuation.branches.unit))
        zero = frozenset(e.group for e in self.continuation.branches.events if abs(e.at - value) <= margin)
        hooks = _ClampedSigns(self.continuation, m, along, None)
        # its position is that of two roots in one: a root of rounding would leave half the digits
        hooks.zero = zero
        with np.errstate(all="ignore"):
            return self.continuation.kinematics.positions(m, along, hooks)

    def places(self, values: Array) -> Array:
        """Coordinates of all moving points (points * axes, n) at values of the drive."""
        at = self.at(values, 0)
        moving = self.prepared.mechanism.moving_points
        coordinates = [x.value if isinstance(x, Jet) else x for name in moving for x in at.points[name]]
        return np.array([np.broadcast_to(x, (1, len(values)))[0] for x in coordinates])

    def events(self, kind: str) -> list[RadicandZero]:
        """Events of a kind within the stretch, each once, in the drive's order."""
        first, last = self.span
        events = [e for e in self.continuation.branches.events if e.kind == kind]
        margin = 1e-9 * self.continuation.branches.unit
        # of a tour that comes round the event at its end is the one at its beginning
        ends = last - margin if self.comes_round else last + margin
        return sorted((e for e in events if first - margin <= e.at <= ends), key=lambda e: (e.at, e.group))


class _ClampedSigns(Smooth):
    """Radicands of groups that stand at an event are zero, and others that rounding makes negative as well."""

    zero: frozenset[int] = frozenset()

    def root(self, group: int, radicand: Number) -> Number:
        return super().root(group, 0.0 * radicand if group in self.zero else np.maximum(radicand, 0.0))


def tour_of(prepared: Ready, drive: str, held: Mapping[str, float]) -> DriveSweep:
    """The tour of one drive about its initial value, the others at the values given.

    Limits are those of a motion to the last bit: they are the events of the same search.
    """
    only = len(prepared.mechanism.drives) == 1
    # with one drive there is nothing to hold: the motion's own start gives the motion's own bits
    if only:
        continuation = start_of(prepared, prepared.kinematics)
    else:
        initial = float(prepared.assembled.positions.drives[drive])
        continuation = starting_at(prepared, held_path(prepared, drive, initial, held))
    path = continuation.kinematics.path
    chosen = next(driven.drive for driven in path.driven if driven.drive.id == drive)
    extent = tau * TURNS if chosen.kind == "angle" else SEARCH * path.unit
    ends = np.array([path.initial - extent, path.initial + extent])
    EventScan(continuation, mesh_of(path, ends)).run()
    # with others held at given values the mechanism need not close at the start at all
    if not only:
        check_closed(continuation)
    low, high = continuation.branches.reach(0)
    low, high = path.possible(low, high)
    return DriveSweep(prepared, chosen, dict(held), continuation, low, high, extent)


# Numbers watched along the drive (angles of links, displacements, transmission angles), and where they turn
# back.
#
# A number is watched as an angle's cosine and sine (of any common length), or plainly. Where its rate changes
# its sign between nodes, the root of the rate is found with the second derivative of the motion itself.

Pair: TypeAlias = tuple[Number, Number]
Watching: TypeAlias = Callable[[Positions], "Pair | Number"]
"""From positions of jets to (cosine, sine), or to a number."""

STILL = 1e-9
"""A number that changes by less, in rad or in the greatest length, does not move."""


@dataclass(frozen=True)
class Watched:
    """A number by its name, its SI unit, and how it follows from positions."""

    name: str
    unit: str
    of: Watching

    def rate(self, at: Positions, count: int) -> tuple[Array, Array]:
        """Number with the sign of the watched number's rate by the drive (n,), and its derivative (n,)."""
        number = self.of(at)
        if isinstance(number, tuple):
            cosine, sine = (_derivatives(x, count) for x in number)
            # r^2 times the angle's rate, so its sign; the product of both first derivatives cancels in the
            # second
            return cosine[0] * sine[1] - sine[0] * cosine[1], cosine[0] * sine[2] - sine[0] * cosine[2]
        value = _derivatives(number, count)
        return value[1], value[2]

    def value(self, at: Positions, count: int) -> Array:
        """The number itself (n,); an angle in (-pi, pi]."""
        number = self.of(at)
        if isinstance(number, tuple):
            cosine, sine = (_derivatives(x, count)[0] for x in number)
            return np.asarray(np.arctan2(sine, cosine))
        return _derivatives(number, count)[0]


def _derivatives(number: Number, count: int) -> list[Array]:
    """Value and derivatives of a jet (or of a constant) as plain arrays (n,)."""
    derivatives = (
        [number.derivative(k) for k in range(number.order + 1)] if isinstance(number, Jet) else [number]
    )
    # constants have fewer derivatives: the rest is zero
    derivatives += [0.0] * (3 - len(derivatives))
    return [np.broadcast_to(np.asarray(x, dtype=np.float64), (1, count))[0] for x in derivatives]


@dataclass(frozen=True)
class MonitoredFunction:
    """Numbers watched on the nodes of a tour, and where each of them turns back.

    Attributes
    ----------
    values : (watched, nodes); angles run on
    turned : for each watched, the drive's values (k,) where its rate is zero, in order, and its values there
    """

    tour: DriveSweep
    watched: tuple[Watched, ...]
    nodes: Array
    values: Array
    turned: tuple[tuple[Array, Array], ...]


def monitored_function(tour: DriveSweep, watched: Sequence[Watched]) -> MonitoredFunction:
    """Watch numbers along a tour."""
    nodes = tour.nodes()
    # one derivative for the signs of the rates; the second is needed only at the few cells with a root
    at = tour.at(nodes, 1)
    values = np.array([_unwrap(member, member.value(at, len(nodes))) for member in watched])
    rates = np.array([member.rate(at, len(nodes))[0] for member in watched])
    if not len(watched):
        return MonitoredFunction(tour, (), nodes, np.zeros((0, len(nodes))), ())
    scale = [
        1.0 if member.unit == "rad" else float(tour.continuation.kinematics.numbers.scale)
        for member in watched
    ]
    moving = np.ptp(values, axis=1) > STILL * np.array(scale)
    # of what stands still the rate is rounding, and changes its sign everywhere
    which, cells = sign_changes(np.where(moving[:, None], rates, np.nan))
    places = _roots(tour, watched, which, nodes[cells], nodes[cells + 1])
    reached = _values_at(tour, watched, which, places)
    turned = []
    for k, member in enumerate(watched):
        mine = which == k
        extremes = _near(member, reached[mine], values[k][cells[mine]])
        turned.append(_in_order(tour, places[mine], extremes))
    return MonitoredFunction(tour, tuple(watched), nodes, values, tuple(turned))


def _unwrap(one: Watched, values: Array) -> Array:
    return np.unwrap(values) if one.unit == "rad" and np.isfinite(values).all() else values


def _near(one: Watched, values: Array, nodes: Array) -> Array:
    """Angles in the turn of their nodes."""
    if one.unit != "rad":
        return values
    # an angle is known up to turns: nodes run on, so the turn of the node beside is the right one
    return values + 2.0 * np.pi * np.round((nodes - values) / (2.0 * np.pi))


def _in_order(tour: DriveSweep, places: Array, values: Array) -> tuple[Array, Array]:
    """In the drive's order; of a tour that comes round, within its first turns."""
    if tour.comes_round:
        first, last = tour.span
        # the nodes lie a share of a step off, so the last cell reaches over the end of the stretch
        places = np.where(places >= last, places - (last - first), places)
    order = np.argsort(places)
    return places[order], values[order]


def _roots(
    tour: DriveSweep, watched: Sequence[Watched], which: npt.NDArray[np.intp], low: Array, high: Array
) -> Array:
    def rate(values: Array) -> tuple[Array, Array]:
        return _evaluate_each(tour, watched, which, values, lambda one, at: one.rate(at, len(values)))

    return newton_roots(rate, low, high)


def _values_at(
    tour: DriveSweep, watched: Sequence[Watched], which: npt.NDArray[np.intp], places: Array
) -> Array:
    if not len(which):
        return np.zeros(0)
    values = _evaluate_each(
        tour, watched, which, places, lambda one, at: (one.value(at, len(places)), np.zeros(len(places)))
    )
    return values[0]


def _evaluate_each(
    tour: DriveSweep,
    watched: Sequence[Watched],
    which: npt.NDArray[np.intp],
    values: Array,
    ask: Callable[[Watched, Positions], tuple[Array, Array]],
) -> tuple[Array, Array]:
    """Two numbers (n,) of each entry's own watched number, from one evaluation of the motion."""
    at = tour.at(values, 2)
    first, second = np.zeros(len(values)), np.zeros(len(values))
    for k in np.unique(which):
        one, other = ask(watched[k], at)
        first[which == k], second[which == k] = one[which == k], other[which == k]
    return first, second


# Dwells of links and sliders: where they stay within a band of their stroke for long.

DWELL_BAND = 0.01
"""Part of a stroke within which a member stays in a dwell."""
LEAST_DWELL = tau / 8
"""Least length of a dwell, in the units of the drive: an eighth of a turn, which no harmonic motion reaches."""


@dataclass(frozen=True)
class Dwell:
    """A stretch of the drive over which a member keeps its value within a band, as finely as the nodes lie."""

    first: float
    last: float
    value: float
    band: float


def dwells_of(course: MonitoredFunction, k: int, shift: float, stroke: float) -> list[Dwell]:
    """Longest stretches of nodes within the band that do not overlap, each at least as long as a dwell is."""
    nodes, values = course.nodes, course.values[k]
    if not np.isfinite(values).all():
        return []
    band = DWELL_BAND * stroke
    tour = course.tour
    least = LEAST_DWELL * (1.0 if tour.angular else tour.continuation.branches.unit)
    count = len(nodes)
    if tour.comes_round:
        # twice round, so that a dwell over the end of the turn is whole; the last node is the first of the
        # next turn
        nodes = np.concatenate([nodes[:-1], nodes[:-1] + (tour.span[1] - tour.span[0])])
        values = np.concatenate([values[:-1], values[:-1]])
        count -= 1
    # the longest first: shorter ones that overlap with it are passed over
    windows = sorted(_windows(values, band), key=lambda w: nodes[w[0]] - nodes[w[1]])
    kept: list[tuple[int, int]] = []
    for first, last in windows:
        if nodes[last] - nodes[first] < least or first >= count:
            continue
        # a stretch and its copies in the turns before and behind are one
        taken = [(a + turn, b + turn) for a, b in kept for turn in (-count, 0, count)]
        if all(last < a or first > b for a, b in taken):
            kept.append((first, last))
    return [
        Dwell(
            float(nodes[a]),
            float(nodes[b]),
            float(values[a : b + 1].mean()) + shift,
            float(np.ptp(values[a : b + 1])),
        )
        for a, b in sorted(kept)
    ]


def _windows(values: Array, band: float) -> list[tuple[int, int]]:
    """For every first node the longest stretch within the band; only those that are not part of another.

    Two queues hold what may still become the greatest and the least value, so each node is looked at once.
    """
    windows: list[tuple[int, int]] = []
    numbers, first = values.tolist(), 0
    high: deque[int] = deque()
    low: deque[int] = deque()
    for last, value in enumerate(numbers):
        # a candidate for the greatest value is dead once a later one is as great: it stays longer in the
        # window
        before = first
        while high and not numbers[high[-1]] > value:
            high.pop()
        while low and not numbers[low[-1]] < value:
            low.pop()
        high.append(last)
        low.append(last)
        while not numbers[high[0]] - numbers[low[0]] <= band:
            first += 1
            for queue in (high, low):
                if queue[0] < first:
                    queue.popleft()
            if first == last:
                break
        # the window that ended cannot be widened on either side: it is one of the longest
        if first > before:
            windows.append((before, last - 1))
    return [*windows, (first, len(numbers) - 1)]


# Links that fall in line: what an extreme position or a dead point looks like.

Pairs: TypeAlias = tuple[tuple[str, str], ...]

FLAT = 1e-7
"""Sine of the angle between two links below which they are said to be in line: half the digits of a root."""


def in_line(tour: DriveSweep, values: Array) -> list[Pairs]:
    """Pairs of moving links, hinged to each other, that are in line at each of some values (n,) of the drive."""
    mechanism = tour.prepared.mechanism
    lined: list[dict[tuple[str, str], None]] = [{} for _value in values]
    if not len(values):
        return []
    places = _places(tour, values)
    for pair, a, pin, b in _hinged_pairs(mechanism):
        flat = _flat(mechanism, places[a], places[pin], places[b])
        for k in np.nonzero(flat)[0]:
            lined[k][pair] = None
    return [tuple(pairs) for pairs in lined]


def _places(tour: DriveSweep, values: Array) -> dict[str, Array]:
    """Places (axes, n) of all points."""

    def plain(x: Number) -> Array:
        number: Array = np.asarray(x.value if isinstance(x, Jet) else x, dtype=np.float64)
        return np.asarray(np.broadcast_to(number, (1, len(values)))[0])

    at = tour.at(values, 0)
    return {name: np.array([plain(x) for x in place]) for name, place in at.points.items()}


def _hinged_pairs(mechanism: Mechanism) -> list[tuple[tuple[str, str], str, str, str]]:
    """Two links with a hinge between them, and another joint of each: (links, joint, hinge, joint)."""
    joints = _joints(mechanism)
    at_point: dict[str, list[str]] = {}
    for link, points in joints.items():
        # a hinge is a point that two links name: the frame has no length to fall in line with
        for point in points:
            at_point.setdefault(point, []).append(link)
    pairs = []
    for pin, links in at_point.items():
        for one, other in combinations(links, 2):
            ends = product((p for p in joints[one] if p != pin), (p for p in joints[other] if p != pin))
            # with both ends shared the two would be one body
            pairs += [((one, other), a, pin, b) for a, b in ends if a != b]
    order = {name: k for k, name in enumerate(mechanism.links)}
    # in the order of the description, whatever the order of the points
    return sorted(pairs, key=lambda one: (order[one[0][0]], order[one[0][1]]))


def _joints(mechanism: Mechanism) -> dict[str, tuple[str, ...]]:
    """Points of every link by which it is joined to others, to the frame or to a guide."""
    guided = {guide.point for guide in mechanism.guides}
    bodies: dict[str, int] = dict.fromkeys(mechanism.frame.points, 1)
    for link in mechanism.links.values():
        for point in link.coordinates:
            bodies[point] = bodies.get(point, 0) + 1
    return {
        name: tuple(p for p in link.coordinates if bodies[p] > 1 or p in guided)
        for name, link in mechanism.links.items()
    }


def _flat(mechanism: Mechanism, a: Array, pin: Array, b: Array) -> npt.NDArray[np.bool_]:
    """Whether three places lie on one line, on the sphere on one great circle."""
    one, other = a - pin, b - pin
    sizes = np.linalg.norm(one, axis=0) * np.linalg.norm(other, axis=0)
    if mechanism.space == "sphere":
        # on the sphere the arcs' lines are their planes: three places lie in one where the triple product is
        # zero
        off = np.abs(np.sum(pin * np.cross(one, other, axis=0), axis=0))
    else:
        off = np.abs(one[0] * other[1] - one[1] * other[0])
    return np.asarray((sizes > 0.0) & (off <= FLAT * sizes))


# How links turn and sliders run over a tour: extreme positions, strokes, time ratios, dwells.


@dataclass(frozen=True)
class StrokeExtreme:
    """A value [rad or m] at which a link or a slider turns back, or stops with the drive at a limit.

    Attributes
    ----------
    at : value of the drive [rad or m]
    in_line : pairs of links that fall in line there
    at_limit : whether it is the end of the drive's range
    """

    value: float
    at: float
    in_line: tuple[tuple[str, str], ...] = ()
    at_limit: bool = False


@dataclass(frozen=True)
class LinkStroke:
    """Stroke of one link, or of one slider along its guide, over a tour.

    Attributes
    ----------
    name : of the link or the guide
    kind : "turns" (a slider: runs on), "swings" (runs to and fro), "still" (keeps its angle or place)
    unit : "rad" or "m"
    turns : net turns over the tour; None where the drive is limited
    least, greatest : StrokeExtreme or None
    stroke : greatest less least value; None where it turns, or where a limit leaves the value undetermined
    forward, back : what the drive turns [rad] while the member goes from its least to its greatest value, and back;
        None unless it has two extreme positions in one turn of the drive
    extremes : all of them, in the drive's order
    """

    name: str
    member: Literal["link", "guide"]
    kind: Literal["turns", "swings", "still"]
    unit: str
    turns: int | None
    least: StrokeExtreme | None
    greatest: StrokeExtreme | None
    stroke: float | None
    forward: float | None
    back: float | None
    extremes: tuple[StrokeExtreme, ...]
    dwells: tuple[Dwell, ...]

    @property
    def time_ratio(self) -> float | None:
        """Time of the longer way over that of the shorter one at constant speed of the drive."""
        if self.forward is None or self.back is None:
            return None
        return max(self.forward, self.back) / min(self.forward, self.back)


def watched_members(tour: DriveSweep) -> list[tuple[Watched, Literal["link", "guide"]]]:
    """Angles of links that are measured, and displacements along guides; what is driven left out."""
    kinematics = tour.continuation.kinematics
    numbers, drives = kinematics.numbers, kinematics.structure.mechanism.drives
    driven = {drive.link if drive.relative_to == "frame" else None for drive in drives}
    sliding = {drive.guide for drive in drives}

    def angle(link: str) -> Watched:
        return Watched(link, "rad", lambda at: rotor_of_angle(JETS, numbers, at, link))

    def slide(guide: str, point: str) -> Watched:
        return Watched(guide, numbers.space.unit, lambda at: slide_of(JETS, numbers, at, guide, point))

    # an angle that a drive gives from the frame is no result: it is the question
    links = [angle(link) for link in numbers.ends if link not in driven]
    guides = [slide(g.id, g.point) for g in kinematics.structure.mechanism.guides if g.id not in sliding]
    return [*((member, "link") for member in links), *((member, "guide") for member in guides)]


def strokes_of(
    course: MonitoredFunction, members: Sequence[Literal["link", "guide"]], first: int = 0
) -> list[LinkStroke]:
    """The swings of the watched numbers from number `first` on, one for each kind of member."""
    chosen = range(first, first + len(members))
    places = [course.turned[k][0] for k in chosen]
    lined = iter(in_line(course.tour, np.concatenate([np.zeros(0), *places])))
    pairs = [[next(lined) for _place in some] for some in places]
    return [
        _stroke_of(course, k, member, mine) for k, member, mine in zip(chosen, members, pairs, strict=True)
    ]


def _stroke_of(
    course: MonitoredFunction, k: int, member: Literal["link", "guide"], lined: Sequence[Pairs]
) -> LinkStroke:
    tour, watched = course.tour, course.watched[k]
    values = course.values[k]
    shift = _shift(course, k, member)
    finite = np.isfinite(values)
    moved = float(np.ptp(values[finite])) if finite.any() else 0.0
    scale = 1.0 if watched.unit == "rad" else float(tour.continuation.kinematics.numbers.scale)
    # only a tour that ends where it began has whole turns
    turns = round((values[-1] - values[0]) / tau) if tour.comes_round and watched.unit == "rad" else None
    if tour.comes_round and watched.unit != "rad":
        turns = 0
    if moved <= STILL * scale:
        return LinkStroke(
            watched.name, member, "still", watched.unit, turns, None, None, 0.0, None, None, (), ()
        )
    extremes = [
        StrokeExtreme(float(value) + shift, float(place), pairs)
        for place, value, pairs in zip(*course.turned[k], lined, strict=True)
    ]
    ends = [] if tour.comes_round else _ends(course, k, shift)
    extremes = sorted([*extremes, *(end for end in ends if end is not None)], key=lambda extreme: extreme.at)
    # through whole turns there is no least value; an end at infinity leaves to and fro, but no stroke
    if turns or None in ends or not extremes:
        kind: Literal["turns", "swings"] = "swings" if None in ends else "turns"
        return LinkStroke(
            watched.name,
            member,
            kind,
            watched.unit,
            turns,
            None,
            None,
            None,
            None,
            None,
            tuple(extremes),
            (),
        )
    least, greatest = (pick(extremes, key=lambda e: e.value) for pick in (min, max))
    stroke = greatest.value - least.value
    return LinkStroke(
        watched.name,
        member,
        "swings",
        watched.unit,
        turns,
        least,
        greatest,
        stroke,
        *_ways(tour, least, greatest, len(extremes)),
        tuple(extremes),
        tuple(dwells_of(course, k, shift, stroke)),
    )


def _shift(course: MonitoredFunction, k: int, member: str) -> float:
    """Whole turns [rad] that bring an angle into the turn of the initial position."""
    if member == "guide":
        return 0.0
    tour = course.tour
    given = tour.prepared.assembled.angles[course.watched[k].name]
    node = int(np.argmin(np.abs(course.nodes - tour.initial)))
    # angles run on from the first node: at the node beside the initial position they are to be those that are
    # given
    return tau * float(np.round((given - course.values[k][node]) / tau))


def _ends(course: MonitoredFunction, k: int, shift: float) -> list[StrokeExtreme | None]:
    """The values at the ends of the drive's range, where the member stops with it; None where they are undetermined."""
    tour, watched = course.tour, course.watched[k]
    ends: list[StrokeExtreme | None] = []
    for limit, node in ((tour.low, 0), (tour.high, -1)):
        if not np.isfinite(limit):
            continue
        # at the limit itself the radicand is rounding and may be negative: it is taken as zero
        value = float(watched.value(tour.positions_at(limit, ARRAYS), 1)[0])
        near = float(course.values[k][node])
        if _goes_to_infinity(tour, limit) or not (np.isfinite(value) and np.isfinite(near)):
            ends.append(None)
            continue
        # the angle at the limit in the turn of the node beside it
        value += tau * round((near - value) / tau) if watched.unit == "rad" else 0.0
        ends.append(StrokeExtreme(value + shift, limit, (), True))
    return ends


def _goes_to_infinity(tour: DriveSweep, limit: float) -> bool:
    """Whether two lines are parallel at a limit."""
    groups = tour.prepared.structure.groups
    events = tour.continuation.branches.events
    at_limit = [groups[event.group] for event in events if event.kind == "limit" and event.at == limit]
    # a dyad of two lines has no sign: its limit is a divisor that vanishes
    return any(isinstance(group, Meet) and not group.is_signed for group in at_limit)


def _ways(
    tour: DriveSweep, least: StrokeExtreme, greatest: StrokeExtreme, count: int
) -> tuple[float | None, float | None]:
    """What the drive turns while a member goes forward and back [rad], in the sense in which the drive runs."""
    # with other than two extremes in one turn there are no two ways to compare
    if tour.turns != 1 or count != 2:
        return None, None
    way = abs(greatest.at - least.at)
    rises = (greatest.at > least.at) == (tour.continuation.kinematics.path.forward > 0.0)
    return (way, tau - way) if rises else (tau - way, way)
