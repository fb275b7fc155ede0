"""Velocities of points as formulas."""

from __future__ import annotations

import heapq
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from centrode.equations.board import Board
from centrode.equations.formulas import Formula, formula_of
from centrode.equations.given import Given
from centrode.equations.letters import Letter
from centrode.equations.places import Place
from centrode.equations.sums import Sum
from centrode.structure.positions import FRAME


@dataclass(frozen=True)
class PointVelocity:
    """Velocity of a point.

    Attributes
    ----------
    point : str
    place : its coordinates in symbols
    x, y : components along the frame's axes, in the rates
    along : for a point on a guide of the frame, the component in the guide's direction
    squared : square of the speed
    closed_x, closed_y, closed_along : the same in time and unknowns alone, where one product comes out
    """

    point: str
    place: Place
    x: Formula
    y: Formula
    along: Formula | None
    squared: Formula
    closed_x: Formula | None
    closed_y: Formula | None
    closed_along: Formula | None

    @cached_property
    def expressions(self) -> tuple[Any, Any]:
        """Both components as SymPy expressions."""
        return (self.closed_x or self.x).expression, (self.closed_y or self.y).expression


def velocity_of(
    point: str, place: Place, board: Board, given: Given, closed: Mapping[Letter, Sum]
) -> PointVelocity:
    """Velocity of a point by the shortest chain to it, rates in `closed` put in where that is shorter."""
    rates = Place(*(given.put(total.rate(board.moves)) for total in place))
    x, y = (formula_of(total) for total in rates)
    heading = next(
        (board.heading(line) for line in board.guides if line.point == point and line.on == FRAME), None
    )
    along = None if heading is None else formula_of(rates.along(heading))

    def short(formula: Formula | None) -> Formula | None:
        if formula is None or not formula.total.letters & closed.keys():
            return formula if formula is None or formula.single else None
        found = formula_of(formula.total.replaced(closed))
        return found if found.single else None

    squared = formula_of(rates.x * rates.x + rates.y * rates.y)
    return PointVelocity(point, place, x, y, along, squared, short(x), short(y), short(along))


def shortest(board: Board) -> dict[str, Place]:
    """Coordinates of every point by the chain with the fewest links: B of a rocker DB from D, not through the coupler."""
    cost = {name: len(at.x.terms) + len(at.y.terms) for name, at in board.points.items()}
    way: dict[str, tuple[str, str] | None] = dict.fromkeys(cost)
    waiting = [(far, name) for name, far in cost.items()]
    heapq.heapify(waiting)
    while waiting:
        far, name = heapq.heappop(waiting)
        if far > cost[name]:
            continue
        for link in board.order:
            if name not in board.local(link):
                continue
            for other in board.local(link):
                if other not in board.numbers.frame and far + 2 < cost[other]:
                    cost[other], way[other] = far + 2, (link, name)
                    heapq.heappush(waiting, (far + 2, other))
    found: dict[str, Place] = {}

    def place(name: str) -> Place:
        if name not in found:
            step = way[name]
            found[name] = (
                board.points[name] if step is None else place(step[1]).plus(board.arm(step[0], step[1], name))
            )
        return found[name]

    return {name: place(name) for name in board.points}
