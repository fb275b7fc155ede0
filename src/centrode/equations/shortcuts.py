"""The shortest chain to every point: the end of a rocker from its fixed hinge, not through the coupler."""

from __future__ import annotations

import heapq

from centrode.equations.board import Board
from centrode.equations.places import Place
from centrode.equations.sums import Sum

STEP = 2
"""Terms that move, which one link more adds to both coordinates together."""


def shorten(board: Board) -> None:
    """Write the place of every point that was found by the chain with the fewest terms."""
    ways = _ways(board)
    points, full = dict(board.points), dict(board.full)

    def place(name: str, known: dict[str, Place], found: dict[str, Place]) -> Place:
        if name not in found:
            step = ways[name]
            found[name] = (
                known[name]
                if step is None
                else place(step[1], known, found).plus(board.arm(step[0], step[1], name))
            )
        return found[name]

    for known in (points, full):
        found: dict[str, Place] = {}
        for name in known:
            place(name, known, found)
        (board.points if known is points else board.full).update(found)


def _ways(board: Board) -> dict[str, tuple[str, str] | None]:
    """The last link of the shortest chain to a point and where it begins; None where the chain is as it was."""
    cost = {name: _moving(board, at.x) + _moving(board, at.y) for name, at in board.points.items()}
    ways: dict[str, tuple[str, str] | None] = dict.fromkeys(cost)
    links = [(link, list(board.local(link))) for link in board.order if link in board.placed]
    waiting = [(far, name) for name, far in cost.items()]
    heapq.heapify(waiting)
    while waiting:
        far, name = heapq.heappop(waiting)
        if far > cost[name]:
            continue
        for link, points in links:
            for other in points if name in points else ():
                if other in cost and other not in board.numbers.frame and far + STEP < cost[other]:
                    cost[other], ways[other] = far + STEP, (link, name)
                    heapq.heappush(waiting, (far + STEP, other))
    return ways


def _moving(board: Board, total: Sum) -> int:
    """Number of terms that move."""
    return sum(bool(Sum({term: 1}).letters & board.alphabet.rates.keys()) for term in total.terms)
