"""The equations of a planar mechanism in symbols: constraints, their derivatives, Cramer's rule, normal form."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from centrode.equations.alphabet import Meaning
from centrode.equations.board import Board
from centrode.equations.draft import Condition, Draft, Unknown
from centrode.equations.expressions import expression, matrix
from centrode.equations.formulas import Formula, formula_of
from centrode.equations.given import Given, given_of
from centrode.equations.laying import laid
from centrode.equations.letters import Letter
from centrode.equations.places import Place
from centrode.equations.points import PointVelocity, shortest, velocity_of
from centrode.equations.sums import Sum
from centrode.equations.systems import LinearSystem, system_of
from centrode.errors import InputError
from centrode.kinematics.ready import Ready, ready
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.structure.assur import assur_groups

TOGETHER = 3
"""Unknowns of the largest mechanism whose groups are also solved as one system, as the textbooks do."""
DELTA = 70_000_000


@dataclass(frozen=True)
class Solution:
    """A linear system with its unknowns by Cramer's rule; None where that would not be readable.

    Attributes
    ----------
    system : matrix, right side, determinants
    letters : the unknowns
    formulas : each in terms of what stands before it
    under : the letter that stands for the determinant where this has several terms
    """

    system: LinearSystem
    formulas: tuple[Formula, ...] | None
    under: Letter | None

    @property
    def letters(self) -> tuple[Letter, ...]:
        return self.system.unknowns


@dataclass(frozen=True)
class GroupEquations:
    """A group of the plan: its unknowns, constraints, and the linear systems of its rates and accelerations.

    What is called an expression or a matrix here is SymPy's (extra `symbols`); formulas print themselves.

    Attributes
    ----------
    label : as the structural formula has it, "II(CB, BD)"
    links : links whose angles or places it gives
    unknowns : with their names and letters
    conditions : the constraints
    velocities, seconds : the systems of the rates and of the accelerations
    closed : rates in terms of time and the unknowns alone, where that stays one product
    """

    label: str
    links: tuple[str, ...]
    unknowns: tuple[Unknown, ...]
    conditions: tuple[Condition, ...]
    velocities: Solution
    seconds: Solution
    closed: tuple[Formula | None, ...]

    @property
    def symbols(self) -> tuple[str, ...]:
        """Letters of the unknowns: "phi3", "phi4"."""
        return tuple(one.letter.name for one in self.unknowns)

    @cached_property
    def constraints(self) -> Mapping[str, Any]:
        """Constraint -> left side less right side, as an expression."""
        return {one.name: expression(one.residual) for one in self.conditions}

    @cached_property
    def matrix(self) -> Any:
        """Coefficients of the rates."""
        return matrix(self.velocities.system.matrix)

    @cached_property
    def right_side(self) -> Any:
        """What stands on the right of the rates' system."""
        return matrix([[entry] for entry in self.velocities.system.right])

    @cached_property
    def acceleration_right_side(self) -> Any:
        """What stands on the right where the same matrix has the accelerations as unknowns."""
        return matrix([[entry] for entry in self.seconds.system.right])

    @property
    def determinant_formula(self) -> Formula | None:
        """Determinant in the form of the textbooks; None where it would not be readable."""
        return self.velocities.system.determinant

    @cached_property
    def determinant(self) -> Any:
        """The same as an expression."""
        return None if self.determinant_formula is None else self.determinant_formula.expression

    @cached_property
    def determinants(self) -> tuple[Any, ...] | None:
        """The determinants of Cramer's rule, one an unknown."""
        found = self.velocities.system.numerators
        return None if found is None else tuple(one.expression for one in found)

    @cached_property
    def rates(self) -> Mapping[str, Any]:
        """Rate -> expression: of time and unknowns where it is short, else of the rates of earlier groups too."""
        return {
            letter.name: formula.expression
            for letter, formula in zip(self.velocities.letters, self.normal_form or (), strict=False)
        }

    @property
    def normal_form(self) -> tuple[Formula, ...] | None:
        """Rates as formulas, the shorter way."""
        formulas = self.velocities.formulas
        if formulas is None:
            return None
        return tuple(short or long for short, long in zip(self.closed, formulas, strict=True))

    @cached_property
    def accelerations(self) -> Mapping[str, Any]:
        """Acceleration -> expression of the rates and of earlier accelerations."""
        return {
            letter.name: formula.expression
            for letter, formula in zip(self.seconds.letters, self.seconds.formulas or (), strict=False)
        }


@dataclass(frozen=True)
class Equations:
    """The equations of a mechanism in symbols.

    Attributes
    ----------
    title : of the mechanism
    legend : every letter with what it stands for and its number
    given : what the drives give
    groups : in the order of the plan, those without unknowns left out
    together : all rates as one system, where they are few
    sliding : points on guides of the frame
    """

    title: str
    legend: tuple[Meaning, ...]
    given: Given
    groups: tuple[GroupEquations, ...]
    together: Solution | None
    sliding: tuple[str, ...]
    board: Board
    places: Mapping[str, Place]

    @property
    def unknowns(self) -> tuple[Unknown, ...]:
        """Unknowns of all groups."""
        return tuple(one for group in self.groups for one in group.unknowns)

    @cached_property
    def rates(self) -> Mapping[str, Any]:
        """Cauchy normal form: rate -> expression."""
        return {name: found for group in self.groups for name, found in group.rates.items()}

    @cached_property
    def accelerations(self) -> Mapping[str, Any]:
        """Acceleration -> expression."""
        return {name: found for group in self.groups for name, found in group.accelerations.items()}

    @cached_property
    def values(self) -> Mapping[str, float]:
        """Symbol -> number [m, rad]; of what moves, that in the initial position."""
        return {one.symbol: one.value for one in self.legend}

    def velocity(self, point: str) -> PointVelocity:
        """Velocity of a point as formulas; raises InputError for a name that is no moving point."""
        if point not in self.board.moving:
            known = ", ".join(self.board.moving)
            raise InputError(point, _("it is no moving point"), _("one of: {points}").format(points=known))
        closed = {
            letter: formula.total
            for group in self.groups
            for letter, formula in zip(group.velocities.letters, group.closed, strict=True)
            if formula is not None
        }
        return velocity_of(point, self.places[point], self.board, self.given, closed)


def equations(mechanism: Mechanism) -> Equations:
    """Constraint equations of a planar mechanism in symbols, differentiated and solved group by group.

    Raises
    ------
    InputError
        On the sphere; or the mechanism cannot be driven or does not assemble.
    """
    return equations_of(ready(mechanism))


def equations_of(made: Ready) -> Equations:
    """The equations of a mechanism made ready."""
    board, drafts = laid(made)
    given = given_of(board)
    places = shortest(board)
    closed: dict[Letter, Sum] = {}
    groups = tuple(_group(made, board, draft, given, closed, i) for i, draft in enumerate(drafts, 1))
    sliding = tuple(dict.fromkeys(g.point for g in made.mechanism.guides if g.on == "frame"))
    return Equations(
        made.mechanism.title,
        tuple(board.alphabet.meanings.values()),
        given,
        groups,
        _together(board, drafts, given),
        sliding,
        board,
        places,
    )


def _rates(board: Board, draft: Draft, given: Given) -> LinearSystem:
    return system_of(
        [given.put(one.residual.rate(board.moves)) for one in draft.conditions],
        [one.rate for one in draft.unknowns],
        [one.pair for one in draft.conditions],
    )


def _seconds(board: Board, draft: Draft, given: Given) -> LinearSystem:
    return system_of(
        [given.put(one.residual.rate(board.moves).rate(board.moves_twice)) for one in draft.conditions],
        [one.second for one in draft.unknowns],
        [one.pair for one in draft.conditions],
    )


def _solution(system: LinearSystem, number: int) -> Solution:
    under = system.determinant
    several = under is not None and not under.single
    letter = Letter(DELTA + number, f"Delta{number}")
    return Solution(system, system.solved(letter), letter if several else None)


def _group(
    made: Ready, board: Board, draft: Draft, given: Given, closed: dict[Letter, Sum], number: int
) -> GroupEquations:
    velocities = _solution(_rates(board, draft, given), number)
    seconds = _solution(_seconds(board, draft, given), number)
    short = _closed(velocities, closed)
    closed.update(
        (letter, one.total) for letter, one in zip(velocities.letters, short, strict=True) if one is not None
    )
    return GroupEquations(
        _label(made, draft),
        tuple(draft.links),
        tuple(draft.unknowns),
        tuple(draft.conditions),
        velocities,
        seconds,
        short,
    )


def _closed(solution: Solution, closed: Mapping[Letter, Sum]) -> tuple[Formula | None, ...]:
    """Rates with those of earlier groups put in, where one product comes out."""
    if solution.formulas is None or solution.under is not None:
        return (None,) * len(solution.letters)
    found = []
    for formula in solution.formulas:
        put_in = (
            formula_of(formula.total.replaced(closed)) if formula.total.letters & closed.keys() else formula
        )
        found.append(put_in if put_in.single else None)
    return tuple(found)


def _together(board: Board, drafts: tuple[Draft, ...], given: Given) -> Solution | None:
    count = sum(len(draft.unknowns) for draft in drafts)
    if len(drafts) < 2 or count > TOGETHER:
        return None
    draft = Draft()
    for one in drafts:
        draft.unknowns += one.unknowns
        draft.conditions += one.conditions
    return _solution(_rates(board, draft, given), 0)


def _label(made: Ready, draft: Draft) -> str:
    """The terms of the structural formula that the group is made of."""
    terms = [term.text for term in assur_groups(made.structure) if set(term.members) & set(draft.links)]
    kinds = [made.structure.groups[number].kind for number in draft.plan]
    return " + ".join(terms or [kind for kind in kinds if kind != "rigid point"])
