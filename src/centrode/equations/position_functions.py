"""Positions in closed form, letter by letter: what the plan solves, as one writes it by hand.

Every line gives one letter from the letters before it: coordinates of a point, the length and the angle of an auxiliary
vector, the angle of a link by the law of cosines. The sign of a branch is a letter of its own.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np

from centrode.equations.inverse_functions import CONSTANTS, AngleSum, PositionFormula, TangentOfAngle
from centrode.equations.spelling import SymbolFormula, formula_of
from centrode.equations.symbols import Letter, Sum

Formula: TypeAlias = PositionFormula | SymbolFormula


@dataclass(frozen=True)
class PositionLine:
    """One letter of a position.

    Attributes
    ----------
    letter : what is given
    formula : what gives it
    unit : "m", "rad", or "1" of places on the sphere
    other : the same written in angles and lengths alone, where that is short
    """

    letter: Letter
    formula: Formula
    unit: str
    other: Formula | None = None

    def value(self, value_of: Callable[[Letter], Any]) -> Any:
        """The number, over arrays."""
        return formula_value(self.formula, value_of)


@dataclass(frozen=True)
class Branch:
    """Which of two solutions a dyad has.

    Attributes
    ----------
    letter : its sign, 1 or -1
    measure : a sum with that sign, in letters that the motion gives; None where `places` give it
    initial : the sign in the initial position
    places : on the sphere the names of three points, whose triple product has that sign
    """

    letter: Letter
    measure: Sum | None
    initial: int
    places: tuple[str, ...] = ()


@dataclass(frozen=True)
class GroupPositions:
    """The positions of one group of the plan.

    Attributes
    ----------
    label : as the structural formula has it, "II(CB, BD)"; empty for links that are driven and points of known links
    kind : that of the plan, "RRR"
    lines : in the order in which they are computed
    names : of what describes the branch: by kind, centres and points of the dyad, letters of its auxiliary vector
    branch : of a dyad that has two solutions
    auxiliary : letters of the length of the auxiliary vector and of its angle
    unsolved : letters that have no closed form, which the motion gives
    tangents : letter -> its tangent, where that is an explicit formula
    """

    label: str
    kind: str
    lines: tuple[PositionLine, ...]
    names: tuple[str, ...] = ()
    branch: Branch | None = None
    auxiliary: tuple[Letter, ...] = ()
    unsolved: tuple[Letter, ...] = ()
    tangents: Mapping[Letter, TangentOfAngle] = field(default_factory=dict)


@dataclass(frozen=True)
class SphericalCoordinates:
    """Where a point lies on the unit sphere: its angle from the z axis and its longitude from the x axis.

    Attributes
    ----------
    point : its name
    polar, longitude : letters of both angles
    x, y, z : its coordinates
    tangent : letter of an angle that the polar one is, and the explicit formula of its tangent
    """

    point: str
    polar: Letter
    longitude: Letter
    x: Sum
    y: Sum
    z: Sum
    tangent: tuple[Letter, TangentOfAngle] | None


@dataclass(frozen=True)
class PositionFunctions:
    """The positions of a mechanism in closed form, group by group of its plan.

    Attributes
    ----------
    groups : in the order of the plan
    places : moving point -> its coordinates in letters of the lines
    spherical : of points on the sphere, where they are short
    """

    groups: tuple[GroupPositions, ...]
    places: Mapping[str, tuple[Sum, ...]]
    spherical: tuple[SphericalCoordinates, ...] = ()

    @property
    def lines(self) -> tuple[PositionLine, ...]:
        """All lines in the order in which they are computed."""
        return tuple(line for group in self.groups for line in group.lines)

    @property
    def branches(self) -> tuple[Branch, ...]:
        """The signs of all dyads."""
        return tuple(group.branch for group in self.groups if group.branch is not None)

    @property
    def unsolved_letters(self) -> tuple[Letter, ...]:
        """Letters that have no closed form."""
        return tuple(letter for group in self.groups for letter in group.unsolved)

    @cached_property
    def letters(self) -> set[Letter]:
        """All letters of the formulas."""
        found: set[Letter] = set()
        for line in self.lines:
            for formula in (line.formula, line.other):
                if formula is not None:
                    found |= letters_of(formula)
        return found

    def values(self, given: Mapping[Letter, Any]) -> dict[Letter, Any]:
        """Number of every letter from those of the constants, the drives, the signs, and what is not solved.

        Numbers may be arrays. Angles are those of the formulas, without turns; a letter that is given with its
        turns among `given` keeps them.
        """
        values = {**CONSTANTS, **given}
        for line in self.lines:
            with np.errstate(all="ignore"):
                value = line.value(values.__getitem__)
            if line.unit == "rad" and line.letter in given:
                value = value + 2 * np.pi * np.round((given[line.letter] - value) / (2 * np.pi))
            values[line.letter] = value
        return values


def formula_value(formula: Formula, value_of: Callable[[Letter], Any]) -> Any:
    """The number that a formula is, over arrays."""
    return (
        formula.total.value(np, value_of) if isinstance(formula, SymbolFormula) else formula.value(value_of)
    )


def put_signs(formula: Formula, signs: Mapping[Letter, int]) -> Formula:
    """A formula with the signs of branches in the place of their letters."""
    if isinstance(formula, (AngleSum, TangentOfAngle)):
        return formula.put(signs)
    if isinstance(formula, SymbolFormula) and formula.total.letters & signs.keys():
        return formula_of(formula.total.replace_letters({x: Sum.number(k) for x, k in signs.items()}))
    return formula


def letters_of(formula: Formula) -> set[Letter]:
    """The letters of a formula."""
    return formula.total.letters if isinstance(formula, SymbolFormula) else formula.letters
