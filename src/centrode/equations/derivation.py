"""The equations of a mechanism in symbols: constraints, their derivatives, Cramer's rule, normal form."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from centrode.equations.alphabet import Meaning
from centrode.equations.board import Board
from centrode.equations.draft import Draft, Unknown
from centrode.equations.formulas import Formula, formula_of
from centrode.equations.given import Given, given_of
from centrode.equations.groups import GroupEquations, Solution
from centrode.equations.laying import laid
from centrode.equations.lettering import Lettering
from centrode.equations.letters import Letter
from centrode.equations.points import PointVelocity, velocity_of
from centrode.equations.sphere_board import SphereBoard
from centrode.equations.sphere_laying import laid_on_sphere
from centrode.equations.sums import Sum
from centrode.equations.systems import LinearSystem, system_of
from centrode.errors import InputError
from centrode.kinematics.prepared import Ready, ready
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.structure.assur import assur_groups, roman

TOGETHER = 3
"""Unknowns of the largest mechanism whose groups are also solved as one system, as the textbooks do."""
DELTA = 70_000_000


@dataclass(frozen=True)
class Equations:
    """The equations of a mechanism in symbols.

    Attributes
    ----------
    mechanism : as it was given
    legend : every letter with what it stands for and its number
    given : what the drives give
    groups : in the order of the plan, those without unknowns left out
    together : all rates as one system, where they are few
    sliding : points on guides of the frame; where nothing is unknown, all moving points
    """

    mechanism: Mechanism
    legend: tuple[Meaning, ...]
    given: Given
    groups: tuple[GroupEquations, ...]
    together: Solution | None
    sliding: tuple[str, ...]
    board: Board | SphereBoard

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

    def legend_of(self, points: Sequence[str]) -> list[Meaning]:
        """Meanings of the letters in the constraints and in the velocities of some points: what moves first."""
        moves, meanings = self.board.moves, self.board.alphabet.meanings
        conditions = [one for group in self.groups for one in group.conditions]
        sums = [side for one in conditions for side in (one.full, one.left, one.right, one.rate(moves))]
        sums += [side for point in points for side in self.velocity(point).place]
        used = {letter for one in sums for letter in one.letters} | {one.letter for one in self.given.drives}
        known = [letter for letter in used if letter in meanings]
        return [meanings[x] for x in sorted(known, key=lambda x: (not meanings[x].moves, x))]

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
        return velocity_of(point, self.board.points[point], self.board, self.given, closed)


def equations(mechanism: Mechanism) -> Equations:
    """Constraint equations of a mechanism in symbols, differentiated and solved group by group.

    Raises
    ------
    InputError
        The mechanism cannot be driven or does not assemble; or on the sphere other groups than dyads of arcs and
        circles have to be solved.
    """
    return equations_of(ready(mechanism))


def equations_of(made: Ready) -> Equations:
    """The equations of a mechanism made ready."""
    board, drafts = laid(made) if made.mechanism.space == "plane" else laid_on_sphere(made)
    given = given_of(board)
    closed: dict[Letter, Sum] = {}
    deltas = [
        Letter(DELTA + i, f"Delta_{roman(i)}" if len(drafts) > 1 else "Delta")
        for i in range(1, len(drafts) + 1)
    ]
    groups = tuple(
        _group(made, board, draft, given, closed, delta) for draft, delta in zip(drafts, deltas, strict=True)
    )
    sliding = tuple(dict.fromkeys(g.point for g in made.mechanism.guides if g.on == "frame"))
    if not groups:
        sliding = tuple(board.moving)
    return Equations(
        made.mechanism,
        tuple(board.alphabet.meanings.values()),
        given,
        groups,
        _together(board, drafts, given),
        sliding,
        board,
    )


def _rates(board: Lettering, draft: Draft, given: Given) -> LinearSystem:
    return system_of(
        [given.put(one.rate(board.moves)) for one in draft.conditions],
        [one.rate for one in draft.unknowns],
        [one.pair for one in draft.conditions],
    )


def _seconds(board: Lettering, draft: Draft, given: Given, closed: Mapping[Letter, Sum]) -> LinearSystem:
    zeros = {letter: total for letter, total in closed.items() if not total}
    return system_of(
        [given.put(one.rate(board.moves_twice, 2)).replaced(zeros) for one in draft.conditions],
        [one.second for one in draft.unknowns],
        [one.pair for one in draft.conditions],
    )


def _solution(system: LinearSystem, letter: Letter) -> Solution:
    return Solution(system, system.solved(letter), letter)


def _group(
    made: Ready, board: Lettering, draft: Draft, given: Given, closed: dict[Letter, Sum], delta: Letter
) -> GroupEquations:
    velocities = _solution(_rates(board, draft, given), delta)
    seconds = _solution(_seconds(board, draft, given, closed), delta)
    short = _closed(velocities, closed)
    closed.update(
        (letter, one.total) for letter, one in zip(velocities.letters, short, strict=True) if one is not None
    )
    closed.update(
        (letter, one.total)
        for letter, one in zip(seconds.letters, seconds.formulas or (), strict=False)
        if not one.number
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
    if solution.formulas is None or solution.lettered:
        return (None,) * len(solution.letters)
    found = []
    for formula in solution.formulas:
        put_in = (
            formula_of(formula.total.replaced(closed)) if formula.total.letters & closed.keys() else formula
        )
        found.append(put_in if put_in.single else None)
    return tuple(found)


def _together(board: Lettering, drafts: tuple[Draft, ...], given: Given) -> Solution | None:
    count = sum(len(draft.unknowns) for draft in drafts)
    if len(drafts) < 2 or count > TOGETHER:
        return None
    draft = Draft()
    for one in drafts:
        draft.unknowns += one.unknowns
        draft.conditions += one.conditions
    return _solution(_rates(board, draft, given), Letter(DELTA, "Delta"))


def _label(made: Ready, draft: Draft) -> str:
    """The terms of the structural formula that the group is made of."""
    if draft.label:
        return draft.label
    terms = [term.text for term in assur_groups(made.structure) if set(term.members) & set(draft.links)]
    kinds = [made.structure.groups[number].kind for number in draft.plan]
    return " + ".join(terms or [kind for kind in kinds if kind != "rigid point"])
