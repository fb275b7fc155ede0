"""Every combination of signs of the dyads, followed over the drive at once: where each closes, and its events."""

from __future__ import annotations

from itertools import product
from math import tau
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.analysis.turning.tours import Tour
from centrode.kinematics.change_points import BranchedPlan
from centrode.kinematics.events import EventScan
from centrode.kinematics.path import OFF_GRID
from centrode.kinematics.plan_evaluation import Branches, Event
from centrode.structure.constraints import Positions

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

    def __init__(self, tour: Tour, signed: list[int]) -> None:
        self.tour, self.signed = tour, signed
        self.signs = np.array(list(product((1.0, -1.0), repeat=len(signed)))).reshape(
            2 ** len(signed), len(signed)
        )
        first = tour.initial if tour.angular else tour.initial - tour.extent
        length = tau if tour.angular else 2.0 * tour.extent
        self.nodes = _with_own(np.asarray(first + (np.arange(NODES) + OFF_GRID) * (length / NODES)), tour)
        self.length = length
        self.closed, self.events = self._followed()
        self.limits: dict[tuple[int, int], list[float]] = {}
        for event in self.events:
            if event.kind == "limit":
                self.limits.setdefault((event.lane, self.cells(event)[0]), []).append(event.at)
        self.runs = [
            _numbered(row, cut, tour.angular) for row, cut in zip(self.closed, self._cut(), strict=True)
        ]

    def _followed(self) -> tuple[Mask, list[Event]]:
        """Where every combination closes at the nodes, and all events."""
        tour = self.tour
        lanes = len(self.signs)
        signs = {group: self.signs[:, k].copy() for k, group in enumerate(self.signed)}
        start = tour.continuation.branches
        branches = Branches(start.initial, start.forward, start.unit, lanes, signs, False, start.angles)
        continuation = BranchedPlan(
            tour.continuation.kinematics, branches, tour.continuation.start, tour.continuation.nominal
        )
        count = len(self.nodes)
        ends = [self.nodes[0] + self.length] if tour.angular else []
        at = EventScan(continuation, np.concatenate([self.nodes, ends])).run()
        closed = np.ones((lanes, count), dtype=bool)
        for x in _numbers(at):
            closed &= np.isfinite(np.broadcast_to(x, (lanes, count + len(ends)))[:, :count])
        return closed, branches.events

    def cells(self, event: Event) -> tuple[int, int]:
        """Nodes before and behind an event."""
        before = int(np.searchsorted(self.nodes, event.at, side="right")) - 1
        behind = before + 1
        if self.tour.angular:
            return before % len(self.nodes), behind % len(self.nodes)
        return max(before, 0), min(behind, len(self.nodes) - 1)

    def _cut(self) -> Mask:
        """Cells, by the node before them, that hold a limit."""
        cut = np.zeros((len(self.signs), len(self.nodes)), dtype=bool)
        for event in self.events:
            if event.kind == "limit":
                cut[event.lane, self.cells(event)[0]] = True
        return cut


def _with_own(nodes: Array, tour: Tour) -> Array:
    """The nodes, and the middle of the stretch between the limits where no node lies in it."""
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


def _numbered(closed: Mask, cut: Mask, round_: bool) -> npt.NDArray[np.intp]:
    """Number of the run of closed nodes that each node belongs to, -1 where it does not close."""
    numbers = np.full(len(closed), -1, dtype=np.intp)
    run = -1
    for k in range(len(closed)):
        if not closed[k]:
            continue
        if k == 0 or not closed[k - 1] or cut[k - 1]:
            run += 1
        numbers[k] = run
    if round_ and run > 0 and closed[0] and closed[-1] and not cut[-1]:
        numbers[numbers == run] = 0
    return numbers
