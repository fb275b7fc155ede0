"""Velocities of points as formulas."""

from __future__ import annotations

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
