"""The equations of a mechanism in symbols: constraints, their derivatives, Cramer's rule, normal form."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from centrode.equations.chain_assembly import assemble_chains
from centrode.equations.linear import (
    Draft,
    GroupEquations,
    GroupSolution,
    LinearSystem,
    Unknown,
    UnknownPlace,
    system_of,
)
from centrode.equations.plane_positions import PlanePositions
from centrode.equations.position_functions import PositionFunctions, put_signs
from centrode.equations.spelling import SymbolFormula, formula_of
from centrode.equations.sphere_chains import SphereBoard, SpherePlace, laid_on_sphere
from centrode.equations.sphere_positions import SpherePositions
from centrode.equations.symbol_table import Lettering, SymbolTable
from centrode.equations.symbols import ZERO, Letter, Meaning, Sum
from centrode.errors import InputError
from centrode.kinematics.preparation import Ready, ready
from centrode.locale import _
from centrode.model.examples.catalogue import MechanismSource, mechanism_of
from centrode.model.mechanism import Mechanism
from centrode.structure.assur import assur_groups, roman
from centrode.structure.constraints import FRAME

# What the drives give: their letters, and where time itself can be written for one of them.


@dataclass(frozen=True)
class Drivenness:
    """A letter that a drive gives, with its derivatives.

    `law` is "t" where it is time itself, "uniform" at constant speed, else "law".
    """

    letter: Letter
    rate: Letter
    second: Letter
    drive: str
    law: str
    start: float
    speed: float


@dataclass(frozen=True)
class Given:
    """What the drives give.

    `names` has letters that are written otherwise (phi1 as t), `values` rates that are numbers (omega1 = 1).
    """

    drives: tuple[Drivenness, ...]
    names: Mapping[Letter, Letter]
    values: Mapping[Letter, Sum]

    def put(self, total: Sum) -> Sum:
        """A sum with what is given put in."""
        return total.replace_letters(self.values).rename_letters(self.names)


def given_of(board: Lettering) -> Given:
    """What the drives of a mechanism give; with one drive at 1 rad/s from 0 its angle is time."""
    found, names, values = [], {}, {}
    parameter = board.ready.parameter
    path = {one.drive.id: one for one in board.ready.kinematics.path.driven}
    for letter, drive in board.driven.items():
        rate = board.alphabet.rates[letter]
        second = board.alphabet.seconds[rate]
        coordinate, driven = parameter.drive(drive), path[drive]
        start = driven.start
        word, speed = "law", 0.0
        if driven.drive.speed is not None:
            word, speed = "uniform", driven.drive.speed
            values[second] = Sum({})
            if (start, speed, len(path)) == (0.0, 1.0, 1) and coordinate.turns:
                word = "t"
                names[letter] = Letter(letter.rank, "t")
                values[rate] = Sum.number(1)
        found.append(Drivenness(letter, rate, second, drive, word, start, speed))
    return Given(tuple(found), names, values)


# Velocities of points as formulas.


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
    place: UnknownPlace | SpherePlace
    x: SymbolFormula
    y: SymbolFormula
    z: SymbolFormula | None
    along: SymbolFormula | None
    closed_x: SymbolFormula | None
    closed_y: SymbolFormula | None
    closed_z: SymbolFormula | None
    closed_along: SymbolFormula | None

    @cached_property
    def squared_speed(self) -> SymbolFormula:
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
    place: UnknownPlace | SpherePlace,
    board: SymbolTable | SphereBoard,
    given: Given,
    closed: Mapping[Letter, Sum],
) -> PointVelocity:
    """Velocity of a point by the shortest chain to it, rates in `closed` put in where that is shorter."""
    rates = [given.put(total.rate(board.moves)) for total in place]
    x, y, *more = (formula_of(total) for total in rates)
    z = more[0] if more else None
    along = _along(point, UnknownPlace(*rates), board) if isinstance(board, SymbolTable) else None

    def short(formula: SymbolFormula | None) -> SymbolFormula | None:
        if formula is None or not formula.total.letters & closed.keys():
            return formula if formula is None or formula.single else None
        found = formula_of(formula.total.replace_letters(closed))
        return found if found.single else None

    return PointVelocity(point, place, x, y, z, along, short(x), short(y), short(z), short(along))


def _along(point: str, rates: UnknownPlace, board: SymbolTable) -> SymbolFormula | None:
    """The component along a guide of the frame in which a point runs."""
    heading = next(
        (board.heading(line) for line in board.guides if line.point == point and line.on == FRAME), None
    )
    return None if heading is None else formula_of(rates.along(heading))


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
    points : whose velocities are written out: where none are named, those on guides of the frame, and where nothing is
        unknown, all moving points
    board : letters with their ranks, places of the points
    position_functions : positions in closed form, letter by letter
    """

    mechanism: Mechanism
    legend: tuple[Meaning, ...]
    given: Given
    groups: tuple[GroupEquations, ...]
    together: GroupSolution | None
    points: tuple[str, ...]
    board: SymbolTable | SphereBoard
    position_functions: PositionFunctions

    @property
    def unknowns(self) -> tuple[Unknown, ...]:
        """Unknowns of all groups."""
        return tuple(one for group in self.groups for one in group.unknowns)

    @cached_property
    def rates(self) -> Mapping[str, Any]:
        """Cauchy normal form: rate -> expression."""
        return {name: found for group in self.groups for name, found in group.rates.items()}

    @cached_property
    def positions(self) -> Mapping[str, Any]:
        """Positions in closed form: letter -> expression of the letters before it, for the branches described."""
        signs = {one.letter: one.initial for one in self.position_functions.branches}
        lines = self.position_functions.lines
        return {line.letter.name: put_signs(line.formula, signs).expression for line in lines}

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
        used = {letter for one in sums for letter in one.letters} | self.position_functions.letters
        used |= {one.letter for one in self.given.drives}
        known = [letter for letter in used if letter in meanings]
        return [meanings[x] for x in sorted(known, key=lambda x: (not meanings[x].moves, x))]

    def velocity(self, point: str) -> PointVelocity:
        """Velocity of a point as formulas; raises InputError for a name that is no moving point."""
        _check_moving(self.board, point)
        closed = {
            letter: formula.total
            for group in self.groups
            for letter, formula in zip(group.velocities.letters, group.closed, strict=True)
            if formula is not None
        }
        return velocity_of(point, self.board.points[point], self.board, self.given, closed)


def equations(mechanism: MechanismSource, points: Sequence[str] | None = None) -> Equations:
    """Constraint equations of a mechanism in symbols, differentiated and solved group by group.

    Parameters
    ----------
    points : names of points, optional
        Whose velocities are written out; those on guides of the frame by default.

    Raises
    ------
    InputError
        The mechanism cannot be driven or does not assemble; a point does not move; or on the sphere other groups than
        dyads of arcs and circles have to be solved.

    Examples
    --------
    >>> import centrode as ct
    >>> print(ct.summary(ct.equations(ct.example("crank-rocker"))).splitlines()[2])
      φ₂(0) = 0.94797 rad   angle of link AB
    """
    mechanism = mechanism_of(mechanism)
    made = ready(mechanism)
    board, drafts = assemble_chains(made) if made.mechanism.space == "plane" else laid_on_sphere(made)
    given = given_of(board)
    closed: dict[Letter, Sum] = {}
    deltas = [
        Letter(DELTA + i, f"Delta_{roman(i)}" if len(drafts) > 1 else "Delta")
        for i in range(1, len(drafts) + 1)
    ]
    groups = tuple(
        _group(made, board, draft, given, closed, delta) for draft, delta in zip(drafts, deltas, strict=True)
    )
    positions = _positions(made, board, drafts)
    if points is None:
        sliding = dict.fromkeys(guide.point for guide in mechanism.guides if guide.on == FRAME)
        points = list(sliding) if groups else board.moving
    for point in points:
        _check_moving(board, point)
    return Equations(
        made.mechanism,
        tuple(board.alphabet.meanings.values()),
        given,
        groups,
        _together(board, drafts, given),
        tuple(points),
        board,
        positions,
    )


def _check_moving(board: Lettering, point: str) -> None:
    if point not in board.moving:
        known = ", ".join(board.moving)
        raise InputError(point, _("this is not a moving point"), _("one of: {points}").format(points=known))


def _rates(board: Lettering, draft: Draft, given: Given) -> LinearSystem:
    return system_of(
        [given.put(one.rate(board.moves)) for one in draft.conditions],
        [one.rate for one in draft.unknowns],
        [one.pair for one in draft.conditions],
    )


def _seconds(board: Lettering, draft: Draft, given: Given, closed: Mapping[Letter, Sum]) -> LinearSystem:
    zeros = {letter: total for letter, total in closed.items() if not total}
    return system_of(
        [given.put(one.rate(board.moves_twice, 2)).replace_letters(zeros) for one in draft.conditions],
        [one.second for one in draft.unknowns],
        [one.pair for one in draft.conditions],
    )


def _solution(system: LinearSystem, letter: Letter) -> GroupSolution:
    return GroupSolution(system, system.solved_unknowns(letter), letter)


def _group(
    made: Ready, board: Lettering, draft: Draft, given: Given, closed: dict[Letter, Sum], delta: Letter
) -> GroupEquations:
    velocities = _solution(_rates(board, draft, given), delta)
    seconds = _solution(_seconds(board, draft, given, closed), delta)
    short = _substitute_rates(velocities, closed)
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


def _substitute_rates(
    solution: GroupSolution, closed: Mapping[Letter, Sum]
) -> tuple[SymbolFormula | None, ...]:
    """Rates with those of earlier groups put in, where one product comes out."""
    if solution.formulas is None or solution.has_letter:
        return (None,) * len(solution.letters)
    found = []
    for formula in solution.formulas:
        put_in = (
            formula_of(formula.total.replace_letters(closed))
            if formula.total.letters & closed.keys()
            else formula
        )
        found.append(put_in if put_in.single else None)
    return tuple(found)


def _positions(made: Ready, board: SymbolTable | SphereBoard, drafts: Sequence[Draft]) -> PositionFunctions:
    """Positions in closed form, the groups by their names in the structural formula."""
    labels = {number: _label(made, draft) for draft in drafts for number in draft.plan}
    if isinstance(board, SymbolTable):
        conditions = [one for draft in drafts for one in draft.conditions]
        return PlanePositions(board, conditions).written(labels)
    return SpherePositions(board).written(labels)


def _together(board: Lettering, drafts: tuple[Draft, ...], given: Given) -> GroupSolution | None:
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
