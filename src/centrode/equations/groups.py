"""A group of the plan in symbols: its unknowns, constraints and linear systems."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from centrode.equations.draft import Condition, Unknown
from centrode.equations.expressions import expression, matrix
from centrode.equations.formulas import Formula
from centrode.equations.letters import Letter
from centrode.equations.sums import Sum
from centrode.equations.systems import LinearSystem


@dataclass(frozen=True)
class Solution:
    """A linear system with its unknowns by Cramer's rule; None where that would not be readable.

    Attributes
    ----------
    system : matrix, right side, determinants
    letters : the unknowns
    formulas : each in terms of what stands before it
    under : the letter of the determinant; it stands in the formulas where this has several terms
    """

    system: LinearSystem
    formulas: tuple[Formula, ...] | None
    under: Letter

    @property
    def letters(self) -> tuple[Letter, ...]:
        return self.system.unknowns

    @property
    def lettered(self) -> bool:
        """Whether the formulas are written with the letter of the determinant."""
        return self.system.determinant is not None and not self.system.determinant.single

    def expressions(self, formulas: Sequence[Formula] | None) -> Mapping[str, Any]:
        """Unknown -> SymPy expression, the determinant written out."""
        found = {
            letter.name: formula.expression
            for letter, formula in zip(self.letters, formulas or (), strict=False)
        }
        if not self.lettered or self.system.determinant is None:
            return found
        under = self.system.determinant.expression
        return {name: one.subs(expression(Sum.letter(self.under)), under) for name, one in found.items()}


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
        return self.velocities.expressions(self.normal_form)

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
        return self.seconds.expressions(self.seconds.formulas)
