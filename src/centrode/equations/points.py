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
from centrode.equations.sphere_board import SphereBoard
from centrode.equations.sums import ZERO, Sum
from centrode.equations.turned import SpherePlace
from centrode.structure.constraints import FRAME


@dataclass(frozen=True)
class PointVelocity:
    """Velocity of a point.

    Attributes
    ----------
    point : str
    place : its coordinates in symbols
    x, y, z : components along the frame's axes, in the rates; z on the sphere alone
    along : for a point on a guide of the frame, the component in the guide's direction
    closed_x, closed_y, closed_z, closed_along : the same in time and unknowns alone, where one product comes out
    """

    point: str
    place: Place | SpherePlace
    x: Formula
    y: Formula
    z: Formula | None
    along: Formula | None
    closed_x: Formula | None
    closed_y: Formula | None
    closed_z: Formula | None
    closed_along: Formula | None

    @cached_property
    def squared(self) -> Formula:
        """Square of the speed."""
        components = [one.total for one in (self.x, self.y, self.z) if one is not None]
        return formula_of(sum((one * one for one in components), ZERO))

    @cached_property
    def expressions(self) -> tuple[Any, ...]:
        """All components as SymPy expressions."""
        both = [(self.closed_x or self.x).expression, (self.closed_y or self.y).expression]
        return (*both, (self.closed_z or self.z).expression) if self.z is not None else tuple(both)


def velocity_of(
    point: str,
    place: Place | SpherePlace,
    board: Board | SphereBoard,
    given: Given,
    closed: Mapping[Letter, Sum],
) -> PointVelocity:
    """Velocity of a point by the shortest chain to it, rates in `closed` put in where that is shorter."""
    rates = [given.put(total.rate(board.moves)) for total in place]
    x, y, *more = (formula_of(total) for total in rates)
    z = more[0] if more else None
    along = _along(point, Place(*rates), board) if isinstance(board, Board) else None

    def short(formula: Formula | None) -> Formula | None:
        if formula is None or not formula.total.letters & closed.keys():
            return formula if formula is None or formula.single else None
        found = formula_of(formula.total.replaced(closed))
        return found if found.single else None

    return PointVelocity(point, place, x, y, z, along, short(x), short(y), short(z), short(along))


def _along(point: str, rates: Place, board: Board) -> Formula | None:
    """The component along a guide of the frame in which a point runs."""
    heading = next(
        (board.heading(line) for line in board.guides if line.point == point and line.on == FRAME), None
    )
    return None if heading is None else formula_of(rates.along(heading))
