"""How many ways of assembling a mechanism there are that do not pass into each other: its circuits and branches.

Every combination of signs of the dyads is followed over the drive at once. Where one of them closes between two
limits it is a branch; two branches that differ in the sign of one group are joined where that group is at a limit
(or at a change point), and what hangs together is a circuit (Chase and Mirth, Circuits and branches of single-
degree-of-freedom planar linkages, Journal of Mechanical Design 115, 1993).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import remainder, tau
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.analysis.turning.combinations import Combinations
from centrode.analysis.turning.tours import Tour
from centrode.kinematics.assembly_mode import side_names, side_words
from centrode.kinematics.plan_evaluation import Event
from centrode.locale import _
from centrode.structure.groups import Newton

Array: TypeAlias = npt.NDArray[np.float64]
Mask: TypeAlias = npt.NDArray[np.bool_]

MOST_DYADS = 10
"""More signs would be more than a thousand combinations."""


@dataclass(frozen=True)
class Branch:
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

    circuits: tuple[tuple[Branch, ...], ...]
    own: int
    joined: bool

    @property
    def branches(self) -> int:
        """Number of branches of the mechanism's own circuit."""
        return len(self.circuits[self.own])


def circuits_of(tour: Tour) -> tuple[Circuits | None, str]:
    """Circuits of a mechanism for a drive, or why they are not counted."""
    structure, mechanism = tour.prepared.structure, tour.prepared.mechanism
    signed = [index for index, group in enumerate(structure.groups) if group.signed]
    if any(isinstance(group, Newton) for group in structure.groups):
        return None, _("not counted: a group of higher class has assemblies that no sign tells")
    if mechanism.gears or mechanism.rolling:
        return None, _("not counted: wheels may mesh in any position")
    if len(signed) > MOST_DYADS:
        return None, _("not counted: more than {most} groups with two sides").format(most=MOST_DYADS)
    found = _Search(tour, signed).run()
    return found, "" if found else _("not counted: the mechanism moves too little to be followed")


class _Search:
    """Which stretches of the combinations of signs hang together."""

    def __init__(self, tour: Tour, signed: list[int]) -> None:
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
            if event.group not in self.signed:
                continue
            partner = self._partner(event)
            for node in self.combinations.cells(event):
                if self._hidden(event, node):
                    continue
                one, other = self._run(event.lane, node), self._run(partner, node)
                if one is not None and other is not None:
                    joined |= event.kind == "change point" and self._root(one) != self._root(other)
                    self._join(one, other)
        return self._circuits(own, joined)

    def _hidden(self, event: Event, node: int) -> bool:
        """Whether another limit lies between a node and an event in its cell."""
        cells = self.combinations.cells(event)
        way = 1.0 if node == cells[0] else -1.0
        others = self.combinations.limits.get((event.lane, cells[0]), ())
        return any(way * remainder(event.at - at, self.combinations.length) > 0.0 for at in others)

    def _nearest(self) -> list[Event]:
        """Limits first, so that change points join only what limits do not."""
        return sorted(self.combinations.events, key=lambda event: event.kind != "limit")

    def _partner(self, event: Event) -> int:
        """The combination that differs in the sign of one group."""
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
            self.parent[max(one, other)] = min(one, other)

    def _circuits(self, own: tuple[int, int], joined: bool) -> Circuits:
        found: dict[tuple[int, int], list[Branch]] = {}
        for k, runs in enumerate(self.combinations.runs):
            for run in range(int(runs.max(initial=-1)) + 1):
                found.setdefault(self._root((k, run)), []).append(self._branch(k, run))
        order = list(found)
        return Circuits(tuple(tuple(found[root]) for root in order), order.index(self._root(own)), joined)

    def _start(self, lane: int) -> int:
        """The node of the mechanism's own branch that is nearest to the initial position."""
        way = np.abs(self.combinations.nodes - self.tour.initial)
        if self.tour.angular:
            way = np.minimum(way, tau - way)
        inside = self.combinations.closed[lane] & self._reached()
        return int(np.argmin(np.where(inside, way, np.inf)))

    def _reached(self) -> Mask:
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

    def _branch(self, lane: int, run: int) -> Branch:
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
            return Branch(sides, None, None)
        first, last = self._edges(inside)
        low, high = self._edge(limits, first, -1), self._edge(limits, last, 0)
        if low is not None and high is not None and low > high:
            low -= tau  # it runs through the end of the turn
        if low is not None and high is not None and self.tour.angular and self.tour.initial <= high - tau:
            low, high = low - tau, high - tau  # the turn of the initial position, where it is on the branch
        return Branch(sides, low, high)

    def _edges(self, inside: npt.NDArray[np.intp]) -> tuple[int, int]:
        """First and last node of a run that may go on over the end of the nodes."""
        gaps = np.nonzero(np.diff(inside) > 1)[0]
        if len(gaps) and inside[0] == 0 and inside[-1] == len(self.combinations.nodes) - 1:
            return int(inside[gaps[-1] + 1]), int(inside[gaps[0]])
        return int(inside[0]), int(inside[-1])

    def _edge(self, limits: list[Event], node: int, which: int) -> float | None:
        """The limit in the cell before a node (which = -1) or behind it (0), the nearest to the node."""
        before = node - 1 if which == -1 else node
        cell = before % len(self.combinations.nodes) if self.tour.angular else before
        first, last = float(self.combinations.nodes[0]), float(self.combinations.nodes[-1])
        ends = [e for e in limits if self.combinations.cells(e)[0] == cell]
        if self.tour.angular:
            turns = [tau * np.floor((e.at - first) / tau) for e in ends]
            found = sorted(e.at - float(turn) for e, turn in zip(ends, turns, strict=True))
        else:
            found = sorted(e.at for e in ends if first <= e.at <= last)
        return found[which] if found else None
