"""How many ways of assembling a mechanism there are that do not pass into each other: its circuits and branches.

Every combination of signs of the dyads is followed over the drive at once. Where one of them closes between two
limits it is a branch; two branches that differ in the sign of one group are joined where that group is at a limit
(or at a change point), and what hangs together is a circuit (Chase and Mirth, Circuits and branches of single-
degree-of-freedom planar linkages, Journal of Mechanical Design 115, 1993).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import Enum, StrEnum
from itertools import combinations, permutations, product
from math import pi, remainder, tau
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.analysis.rotatability.tours import DriveSweep
from centrode.geometry.plane import cross, subtract
from centrode.kinematics.assembly_mode import side_names, side_words
from centrode.kinematics.change_points import BranchedPlan
from centrode.kinematics.events import EventScan
from centrode.kinematics.path import OFF_GRID
from centrode.kinematics.plan_evaluation import Branches, RadicandZero
from centrode.kinematics.preparation import Ready
from centrode.locale import mark
from centrode.model.mechanism import FRAME, Guide, Mechanism
from centrode.numerics.arrays import ARRAYS
from centrode.structure.constraints import Positions
from centrode.structure.dimensions import Dimensions
from centrode.structure.groups import Newton

# Every combination of signs of the dyads, followed over the drive at once: where each closes, and its events.

Array: TypeAlias = npt.NDArray[np.float64]
Mask: TypeAlias = npt.NDArray[np.bool_]

NODES = 720


class Combinations:
    """All combinations of signs on the nodes of the drive.

    Attributes
    ----------
    signed : numbers of the groups with two sides
    signs : (lane, signed), of +1 and -1
    nodes, length : values of the drive [rad or m], evenly spaced and one in the mechanism's own branch, and how far
        they reach
    closed : (lane, node), where a combination closes
    events : limits and change points of all of them
    runs : for each lane (node) the number of the stretch between limits, -1 where it does not close
    limits : (lane, cell) -> values of the drive at the limits in it
    """

    def __init__(self, tour: DriveSweep, signed: list[int]) -> None:
        self.tour, self.signed = tour, signed
        # the last sign changes fastest, so the number of a lane has one bit for each group: 0 of +1, 1 of -1
        self.signs = np.array(list(product((1.0, -1.0), repeat=len(signed)))).reshape(
            2 ** len(signed), len(signed)
        )
        # an angle is the same a turn later, so one turn holds all; a displacement is followed to both sides
        first = tour.initial if tour.angular else tour.initial - tour.extent
        length = tau if tour.angular else 2.0 * tour.extent
        self.nodes = _with_own(np.asarray(first + (np.arange(NODES) + OFF_GRID) * (length / NODES)), tour)
        self.length = length
        self.closed, self.events = self._follow_combinations()
        self.limits: dict[tuple[int, int], list[float]] = {}
        for event in self.events:
            if event.kind == "limit":
                self.limits.setdefault((event.lane, self.cells(event)[0]), []).append(event.at)
        self.runs = [
            _number_runs(row, cut, tour.angular)
            for row, cut in zip(self.closed, self._limit_cells(), strict=True)
        ]

    def _follow_combinations(self) -> tuple[Mask, list[RadicandZero]]:
        """Where every combination closes at the nodes, and all events."""
        tour = self.tour
        lanes = len(self.signs)
        # copies: the scan sets signs where it passes change points
        signs = {group: self.signs[:, k].copy() for k, group in enumerate(self.signed)}
        start = tour.continuation.branches
        branches = Branches(start.initial, start.forward, start.unit, lanes, signs, False, start.angles)
        continuation = BranchedPlan(
            tour.continuation.kinematics, branches, tour.continuation.start, tour.continuation.nominal
        )
        count = len(self.nodes)
        # the first node again closes the last cell of the turn, so that events in it are found
        ends = [self.nodes[0] + self.length] if tour.angular else []
        at = EventScan(continuation, np.concatenate([self.nodes, ends])).run()
        closed = np.ones((lanes, count), dtype=bool)
        # a position is there where every coordinate is a number
        for x in _numbers(at):
            closed &= np.isfinite(np.broadcast_to(x, (lanes, count + len(ends)))[:, :count])
        return closed, branches.events

    def cells(self, event: RadicandZero) -> tuple[int, int]:
        """Nodes before and behind an event."""
        before = int(np.searchsorted(self.nodes, event.at, side="right")) - 1
        behind = before + 1
        if self.tour.angular:
            return before % len(self.nodes), behind % len(self.nodes)
        return max(before, 0), min(behind, len(self.nodes) - 1)

    def _limit_cells(self) -> Mask:
        """Cells, by the node before them, that hold a limit."""
        cut = np.zeros((len(self.signs), len(self.nodes)), dtype=bool)
        for event in self.events:
            if event.kind == "limit":
                cut[event.lane, self.cells(event)[0]] = True
        return cut


def _with_own(nodes: Array, tour: DriveSweep) -> Array:
    """The nodes, and the middle of the stretch between the limits where no node lies in it."""
    # the limits lie about the initial value, the nodes from it on: they may hold nodes a turn later
    low, high = tour.low, tour.high
    turns = (0.0, tau) if tour.angular else (0.0,)
    if not np.isfinite(high - low) or any(
        ((low + turn < nodes) & (nodes < high + turn)).any() for turn in turns
    ):
        return nodes
    middle = 0.5 * (low + high)
    if tour.angular:
        middle = nodes[0] + (middle - nodes[0]) % tau
    return np.sort(np.append(nodes, middle))


def _numbers(at: Positions) -> list[Array]:
    """Every coordinate of points."""
    return [np.atleast_2d(np.asarray(x, dtype=np.float64)) for place in at.points.values() for x in place]


def _number_runs(closed: Mask, cut: Mask, round_: bool) -> npt.NDArray[np.intp]:
    """Number of the run of closed nodes that each node belongs to, -1 where it does not close."""
    numbers = np.full(len(closed), -1, dtype=np.intp)
    run = -1
    for k in range(len(closed)):
        if not closed[k]:
            continue
        if k == 0 or not closed[k - 1] or cut[k - 1]:
            # two limits may lie in one cell between closed nodes: the stretch is cut although every node
            # closes
            run += 1
        numbers[k] = run
    # over the end of the turn the last run and the first are one
    if round_ and run > 0 and closed[0] and closed[-1] and not cut[-1]:
        numbers[numbers == run] = 0
    return numbers


MOST_DYADS = 10
"""More signs would be more than a thousand combinations."""


@dataclass(frozen=True)
class CircuitBranch:
    """A stretch of the drive between limits on which the mechanism closes with the same sides.

    Attributes
    ----------
    sides : point (or guide) -> "left", "right", "ahead", "behind", as [assembly] sides names them
    low, high : values of the drive [rad or m]; None where it goes on over all of the turn
    """

    sides: dict[str, str]
    low: float | None
    high: float | None


@dataclass(frozen=True)
class Circuits:
    """All circuits, and the one of the initial position.

    Attributes
    ----------
    circuits : each with its branches
    own : number of the one in which the mechanism is assembled, from 0
    joined : whether circuits hang together at change points only
    """

    circuits: tuple[tuple[CircuitBranch, ...], ...]
    own: int
    joined: bool

    @property
    def branches(self) -> int:
        """Number of branches of the mechanism's own circuit."""
        return len(self.circuits[self.own])


class Uncounted(Enum):
    """Why the circuits of a mechanism are not counted."""

    HIGHER_CLASS = mark(
        "not counted: the assembly modes of a group of higher class cannot be distinguished by signs"
    )
    WHEELS = mark("not counted: wheels may mesh in any position")
    TOO_MANY = mark("not counted: more than {most} groups with two sides")
    STANDING = mark("not counted: the range of motion is too small")

    @property
    def word(self) -> str:
        """The reason in English; {most} is `MOST_DYADS`."""
        return self.value


def circuits_of(tour: DriveSweep) -> tuple[Circuits | None, Uncounted | None]:
    """Circuits of a mechanism for a drive, or why they are not counted."""
    structure, mechanism = tour.prepared.structure, tour.prepared.mechanism
    signed = [index for index, group in enumerate(structure.groups) if group.is_signed]
    if any(isinstance(group, Newton) for group in structure.groups):
        return None, Uncounted.HIGHER_CLASS
    if mechanism.gears or mechanism.rolling:
        return None, Uncounted.WHEELS
    if len(signed) > MOST_DYADS:
        return None, Uncounted.TOO_MANY
    circuits = _CircuitSearch(tour, signed).run()
    return circuits, None if circuits else Uncounted.STANDING


class _CircuitSearch:
    """Which stretches of the combinations of signs hang together."""

    def __init__(self, tour: DriveSweep, signed: list[int]) -> None:
        self.tour, self.signed = tour, signed
        self.combinations = Combinations(tour, signed)
        self.parent: dict[tuple[int, int], tuple[int, int]] = {}

    def run(self) -> Circuits | None:
        """Join what hangs together; None where no node lies in the mechanism's own branch."""
        own_signs = [self.tour.prepared.assembled.signs[group] for group in self.signed]
        lane = next(k for k, row in enumerate(self.combinations.signs) if list(row) == own_signs)
        own = self._run(lane, self._start(lane))
        if own is None:
            return None
        joined = False
        for event in self._nearest():
            # a group without two sides has no other branch to pass into
            if event.group not in self.signed:
                continue
            partner = self._partner(event)
            for node in self.combinations.cells(event):
                if self._hidden(event, node):
                    continue
                one, other = self._run(event.lane, node), self._run(partner, node)
                if one is not None and other is not None:
                    # looked at before the join: afterwards both have one root
                    joined |= event.kind == "change point" and self._root(one) != self._root(other)
                    self._join(one, other)
        return self._circuits(own, joined)

    def _hidden(self, event: RadicandZero, node: int) -> bool:
        """Whether another limit lies between a node and an event in its cell."""
        cells = self.combinations.cells(event)
        way = 1.0 if node == cells[0] else -1.0
        others = self.combinations.limits.get((event.lane, cells[0]), ())
        # by the shortest way round: an event in the last cell may be given a turn off
        return any(way * remainder(event.at - at, self.combinations.length) > 0.0 for at in others)

    def _nearest(self) -> list[RadicandZero]:
        """Limits first, so that change points join only what limits do not."""
        return sorted(self.combinations.events, key=lambda event: event.kind != "limit")

    def _partner(self, event: RadicandZero) -> int:
        """The combination that differs in the sign of one group."""
        # product() has the last group in the lowest bit
        place = len(self.signed) - 1 - self.signed.index(event.group)
        return event.lane ^ (1 << place)

    def _run(self, lane: int, node: int) -> tuple[int, int] | None:
        run = int(self.combinations.runs[lane][node])
        return None if run < 0 else (lane, run)

    def _root(self, run: tuple[int, int]) -> tuple[int, int]:
        while run in self.parent:
            run = self.parent[run]
        return run

    def _join(self, one: tuple[int, int], other: tuple[int, int]) -> None:
        one, other = self._root(one), self._root(other)
        if one != other:
            # the smaller one stays the root, so circuits keep the order of their first branch
            self.parent[max(one, other)] = min(one, other)

    def _circuits(self, own: tuple[int, int], joined: bool) -> Circuits:
        branches: dict[tuple[int, int], list[CircuitBranch]] = {}
        for k, runs in enumerate(self.combinations.runs):
            for run in range(int(runs.max(initial=-1)) + 1):
                # every run is given its root here: runs that nothing joined are circuits of their own
                branches.setdefault(self._root((k, run)), []).append(self._branch(k, run))
        order = list(branches)
        return Circuits(tuple(tuple(branches[root]) for root in order), order.index(self._root(own)), joined)

    def _start(self, lane: int) -> int:
        """The node of the mechanism's own branch that is nearest to the initial position."""
        way = np.abs(self.combinations.nodes - self.tour.initial)
        if self.tour.angular:
            # the shorter way round
            way = np.minimum(way, tau - way)
        inside = self.combinations.closed[lane] & self._reachable_nodes()
        return int(np.argmin(np.where(inside, way, np.inf)))

    def _reachable_nodes(self) -> Mask:
        low, high = self.tour.low, self.tour.high
        turns = (0.0, -tau) if self.tour.angular else (0.0,)
        reached: Mask = np.any(
            [
                (low <= self.combinations.nodes + turn) & (self.combinations.nodes + turn <= high)
                for turn in turns
            ],
            axis=0,
        )
        return reached

    def _branch(self, lane: int, run: int) -> CircuitBranch:
        groups = self.tour.prepared.structure.groups
        space = self.tour.continuation.kinematics.numbers.space
        sides = {
            side_names(groups[g])[0]: side_words(space, groups[g])[
                0 if self.combinations.signs[lane, k] > 0 else 1
            ]
            for k, g in enumerate(self.signed)
        }
        inside = np.nonzero(self.combinations.runs[lane] == run)[0]
        limits = [e for e in self.combinations.events if e.lane == lane and e.kind == "limit"]
        if not limits and len(inside) == len(self.combinations.nodes):
            return CircuitBranch(sides, None, None)
        first, last = self._edges(inside)
        low, high = self._edge(limits, first, -1), self._edge(limits, last, 0)
        if low is not None and high is not None and low > high:
            low -= tau  # it runs through the end of the turn
        if low is not None and high is not None and self.tour.angular and self.tour.initial <= high - tau:
            low, high = low - tau, high - tau  # the turn of the initial position, where it is on the branch
        return CircuitBranch(sides, low, high)

    def _edges(self, inside: npt.NDArray[np.intp]) -> tuple[int, int]:
        """First and last node of a run that may go on over the end of the nodes."""
        # first and last node belong to it, and a gap lies between: the run goes over the end of the turn
        gaps = np.nonzero(np.diff(inside) > 1)[0]
        if len(gaps) and inside[0] == 0 and inside[-1] == len(self.combinations.nodes) - 1:
            return int(inside[gaps[-1] + 1]), int(inside[gaps[0]])
        return int(inside[0]), int(inside[-1])

    def _edge(self, limits: list[RadicandZero], node: int, which: int) -> float | None:
        """The limit in the cell before a node (which = -1) or behind it (0), the nearest to the node."""
        before = node - 1 if which == -1 else node
        cell = before % len(self.combinations.nodes) if self.tour.angular else before
        first, last = float(self.combinations.nodes[0]), float(self.combinations.nodes[-1])
        ends = [e for e in limits if self.combinations.cells(e)[0] == cell]
        if self.tour.angular:
            # events are given in any turn: they are brought into the turn of the nodes
            turns = [tau * np.floor((e.at - first) / tau) for e in ends]
            places = sorted(e.at - float(turn) for e, turn in zip(ends, turns, strict=True))
        else:
            places = sorted(e.at for e in ends if first <= e.at <= last)
        return places[which] if places else None


# Four-bar and slider-crank loops of a mechanism, and which of their links turn fully: Grashof's rule.
#
# On the sphere two arcs whose sum exceeds pi are replaced by their supplements (a hinge is exchanged for the
# opposite one on its axis), until no two arcs together exceed pi; then the rule of the plane holds as it is
# (Chiang, Kinematics of Spherical Mechanisms, 1988).

ROUNDING = 16 * 2.0**-52
"""Sums of lengths that differ by less than this part of them are equal."""


class LoopType(StrEnum):
    """The type of a loop by the rule of Grashof."""

    CRANK_ROCKER = mark("crank-rocker")
    DOUBLE_CRANK = mark("double crank")
    DOUBLE_ROCKER = mark("double rocker, the coupler turns fully")
    ROCKER_CRANK = mark("rocker-crank")
    TRIPLE_ROCKER = mark("triple rocker")
    CHANGE_POINT = mark("change-point linkage")
    TURNS = mark("the shortest link turns fully")
    NONE_TURNS = mark("no link turns fully against another")
    SLIDER_CRANK = mark("slider-crank, the crank turns fully")
    SLIDER_COUPLER = mark("slider-crank, the coupler turns fully, the crank swings")
    SLIDER_ROCKER = mark("slider-crank, no link turns fully")
    TURNING_GUIDE = mark("crank and slotted lever, the lever turns fully")
    SWINGING_GUIDE = mark("crank and slotted lever")
    SWINGING_ALL = mark("slotted lever, no link turns fully")

    @property
    def word(self) -> str:
        """The type in English."""
        return self.value


@dataclass(frozen=True)
class LengthRule:
    """The sums of lengths that the rule of Grashof compares [m, on the sphere rad].

    Attributes
    ----------
    short : of the shortest and the longest link; in a loop with a slider of the shorter link and the offset
    long : of the others
    unit : "m" or "rad"
    longest : name of the longest link; empty in a loop with a slider
    """

    short: float
    long: float
    unit: str
    longest: str = ""


@dataclass(frozen=True)
class FourBar:
    """A loop of four links, or of three links and a slider, with the rule that decides how it turns.

    Attributes
    ----------
    bodies : names around the loop, the fixed link first where it belongs to the loop; a slider by its guide
    lengths : [m, rad on the sphere] of the bodies in the same order; of a slider's guide the offset
    reduced : on the sphere the arcs by which the rule decides, otherwise the lengths
    grashof : whether the shortest link turns fully against all others; None at a change point
    shortest : its name; in a change-point loop the first of the shortest
    kind : the type, as seen from the fixed link (and the drive, if it belongs to the loop)
    inequality : the rule with the numbers in it
    """

    bodies: tuple[str, ...]
    lengths: tuple[float, ...]
    reduced: tuple[float, ...]
    grashof: bool | None
    shortest: str
    kind: LoopType
    inequality: LengthRule


def four_bars_of(prepared: Ready) -> tuple[FourBar, ...]:
    """Every loop of four hinged links, and of three with a slider on a guide, in the order of the description."""
    mechanism, numbers = prepared.mechanism, prepared.kinematics.numbers
    loops = [_hinged_four_bar(mechanism, numbers, bodies, pins) for bodies, pins in _loops(mechanism)]
    if mechanism.space == "plane":
        loops += [loop for guide in mechanism.guides for loop in _slider_loops(mechanism, numbers, guide)]
    return tuple(loops)


def _points(mechanism: Mechanism) -> dict[str, tuple[str, ...]]:
    """Points of the frame and of every link."""
    links = {name: tuple(link.coordinates) for name, link in mechanism.links.items()}
    return {FRAME: tuple(mechanism.frame.points), **links}


def _loops(mechanism: Mechanism) -> Iterator[tuple[tuple[str, ...], tuple[str, ...]]]:
    """Loops of four bodies and the pins between them: pins[k] joins body k and the next one."""
    points = _points(mechanism)
    at_point: dict[str, list[str]] = {}
    for body, names in points.items():
        for name in names:
            at_point.setdefault(name, []).append(body)
    shared: dict[str, dict[str, list[str]]] = {body: {} for body in points}
    for name, bodies in at_point.items():
        for one, other in permutations(bodies, 2):
            shared[one].setdefault(other, []).append(name)
    rank = {body: k for k, body in enumerate(points)}
    for first in points:
        # every loop once: from its first body in the description, in one of its two senses
        behind = [body for body in shared[first] if rank[body] > rank[first]]
        for second, last in combinations(sorted(behind, key=rank.__getitem__), 2):
            # hinged to each other and to the first they are a triangle, which is rigid
            if last in shared[second]:
                continue
            for third in shared[second]:
                if rank[third] > rank[first] and third in shared[last] and third not in shared[first]:
                    loop = (first, second, third, last)
                    # two bodies with two hinges are one body, and a pin that three share makes no loop of
                    # four
                    pins = [shared[loop[k]][loop[(k + 1) % 4]] for k in range(4)]
                    if all(len(pin) == 1 for pin in pins) and len({pin[0] for pin in pins}) == 4:
                        yield loop, tuple(pin[0] for pin in pins)


def _hinged_four_bar(
    mechanism: Mechanism, numbers: Dimensions, bodies: tuple[str, ...], pins: tuple[str, ...]
) -> FourBar:
    lengths = tuple(_distance(numbers, body, pins[k - 1], pins[k]) for k, body in enumerate(bodies))
    reduced = reduced_arcs(lengths) if mechanism.space == "sphere" else lengths
    order = sorted(range(4), key=lambda k: reduced[k])
    shortest, longest = order[0], order[3]
    short, long = reduced[shortest] + reduced[longest], reduced[order[1]] + reduced[order[2]]
    verdict = _is_smaller_sum(short, long)
    rule = LengthRule(short, long, numbers.space.unit, bodies[longest])
    kind = _kind(mechanism, bodies, shortest, verdict)
    return FourBar(bodies, lengths, reduced, verdict, bodies[shortest], kind, rule)


def reduced_arcs(arcs: Sequence[float]) -> tuple[float, ...]:
    """Arcs of an equivalent spherical four-bar no two of which together exceed half a great circle."""
    reduced = list(arcs)
    # each exchange lowers the sum of the arcs, from a + b > pi to 2 pi - a - b < pi: it comes to an end
    while True:
        first, second = sorted(range(4), key=lambda k: -reduced[k])[:2]
        if reduced[first] + reduced[second] <= pi:
            return tuple(reduced)
        reduced[first], reduced[second] = pi - reduced[first], pi - reduced[second]


def _is_smaller_sum(short: float, long: float) -> bool | None:
    """Whether a sum is the smaller one; None where both are equal but for rounding."""
    # the sum of two lengths is rounded in each of them, relative to their size
    if abs(short - long) <= ROUNDING * (abs(short) + abs(long)):
        return None
    return short < long


def _kind(mechanism: Mechanism, bodies: tuple[str, ...], shortest: int, verdict: bool | None) -> LoopType:
    if verdict is None:
        return LoopType.CHANGE_POINT
    if bodies[0] != FRAME:
        return LoopType.TURNS if verdict else LoopType.NONE_TURNS
    if not verdict:
        return LoopType.TRIPLE_ROCKER
    if shortest == 0:
        return LoopType.DOUBLE_CRANK
    if shortest == 2:
        return LoopType.DOUBLE_ROCKER
    driven = {drive.link for drive in mechanism.drives if drive.relative_to == FRAME}
    # the links hinged to the frame are the second and the fourth, 1 and 3
    other = bodies[4 - shortest]
    return (
        LoopType.ROCKER_CRANK if other in driven and bodies[shortest] not in driven else LoopType.CRANK_ROCKER
    )


def _distance(numbers: Dimensions, body: str, first: str, second: str) -> float:
    """Distance of two points of a body [m], on the sphere their arc [rad]."""
    local: Mapping[str, tuple[float, float]] = numbers.frame if body == FRAME else numbers.local[body]
    space = numbers.space
    one, other = (space.place(ARRAYS, space.at_rest, local[point]) for point in (first, second))
    return float(space.distance(ARRAYS, one, other))


def _slider_loops(mechanism: Mechanism, numbers: Dimensions, guide: Guide) -> Iterator[FourBar]:
    """Loops of the body with the guide, two links hinged together, and a slider that turns on the last one."""
    points = _points(mechanism)
    carrier = guide.on
    sliding = [name for name in mechanism.links if guide.point in points[name] and name != guide.link]
    for coupler in [name for name in sliding if name != carrier] + _frame_end(points, guide, carrier):
        for crank in points:
            if crank in (carrier, coupler, guide.link):
                continue
            pivots = [p for p in points[crank] if p in points[carrier]]
            pins = [p for p in points[crank] if p in points[coupler] and p != guide.point]
            if len(pivots) == 1 and len(pins) == 1 and pivots[0] != pins[0]:
                loop = (carrier, crank, coupler)
                yield _sliding_four_bar(mechanism, numbers, guide, loop, (pivots[0], pins[0]))


def _frame_end(points: Mapping[str, tuple[str, ...]], guide: Guide, carrier: str) -> list[str]:
    """The frame, where it holds the guided point itself."""
    return [FRAME] if guide.point in points[FRAME] and carrier != FRAME else []


def _sliding_four_bar(
    mechanism: Mechanism,
    numbers: Dimensions,
    guide: Guide,
    loop: tuple[str, str, str],
    pins: tuple[str, str],
) -> FourBar:
    carrier, crank, coupler = loop
    pivot, pin = pins
    local = numbers.frame if carrier == FRAME else numbers.local[carrier]
    # |d x (pivot - through)|, d a unit vector: the pivot's distance from the line of the guide
    offset = abs(float(cross(numbers.direction[guide.id], subtract(local[pivot], numbers.through[guide.id]))))
    one, other = _distance(numbers, crank, pivot, pin), _distance(numbers, coupler, pin, guide.point)
    # the rule is that of four links whose two longest are infinite and differ by the offset
    short, long = min(one, other) + offset, max(one, other)
    verdict = _is_smaller_sum(short, long)
    shortest = crank if one <= other else coupler
    bodies, lengths = (carrier, crank, coupler, f"{guide.id}"), (offset, one, other)
    kind = _slider_kind(loop, shortest, verdict)
    rule = LengthRule(short, long, numbers.space.unit)
    return FourBar(bodies, lengths, lengths, verdict, shortest, kind, rule)


def _slider_kind(loop: tuple[str, str, str], shortest: str, verdict: bool | None) -> LoopType:
    carrier, crank, _coupler = loop
    if verdict is None:
        return LoopType.CHANGE_POINT
    if FRAME not in loop:
        return LoopType.TURNS if verdict else LoopType.NONE_TURNS
    if carrier == FRAME:
        if not verdict:
            return LoopType.SLIDER_ROCKER
        return LoopType.SLIDER_CRANK if shortest == crank else LoopType.SLIDER_COUPLER
    if not verdict:
        return LoopType.SWINGING_ALL
    return LoopType.TURNING_GUIDE if shortest == FRAME else LoopType.SWINGING_GUIDE
