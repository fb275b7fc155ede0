"""Formulas in the letters of a mechanism's equations, as leaves of texts and formulas.

A leaf holds sums of products of letters, sines and cosines as they were derived. Each renderer spells them by its own
table of operations, an `equations.spelling.FormulaSpelling`: plain text, LaTeX, typst.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    from centrode.equations.cofactors import ExpansionStep
    from centrode.equations.inverse_functions import PositionFormula
    from centrode.equations.spelling import SymbolFormula
    from centrode.equations.symbols import Letter, Sum


@dataclass(frozen=True)
class SumFormula:
    """A sum, each term a product or a fraction; of one letter that letter, of nothing zero."""

    total: Sum


@dataclass(frozen=True)
class FactoredFormula:
    """A formula in the form of textbooks, what all terms share in front.

    Attributes
    ----------
    formula : the formula
    differences_first : sines of differences stand before those of angles, as in determinants
    turned : a minus in front goes into the sine of a difference
    values : letter -> number where the formula is written with its numbers; angles in rad
    """

    formula: SymbolFormula
    differences_first: bool = False
    turned: bool = False
    values: Mapping[Letter, float] | None = None


@dataclass(frozen=True)
class InitialValue:
    """The value of a letter at time zero."""

    letter: Letter


@dataclass(frozen=True)
class TimeDerivative:
    """The derivative of a letter by time."""

    letter: Letter


@dataclass(frozen=True)
class UniformMotion:
    """What a drive at constant speed gives: a value at time zero, and the speed times t [SI]."""

    start: float
    speed: float


@dataclass(frozen=True)
class GivenNumber:
    """A number as it was given, in SI and without its unit."""

    value: float


@dataclass(frozen=True)
class AbsoluteProduct:
    """A product of powers; of letters that may be negative the size.

    Attributes
    ----------
    factors : letter, its power, and whether it may be negative
    """

    factors: tuple[tuple[Letter, int, bool], ...]


@dataclass(frozen=True)
class InverseFormula:
    """A root, an arc function, or the direction of a vector over sums of letters.

    Attributes
    ----------
    formula : the formula
    values : letter -> number where it is written with its numbers; angles in rad
    """

    formula: PositionFormula
    values: Mapping[Letter, float] | None = None


@dataclass(frozen=True)
class FunctionOfLetter:
    """A sine, cosine or tangent of a letter."""

    function: str
    letter: Letter


@dataclass(frozen=True)
class Cofactors:
    """A step of the cofactor expansion of a determinant."""

    step: ExpansionStep


SymbolicLeaf: TypeAlias = (
    SumFormula
    | FactoredFormula
    | InitialValue
    | TimeDerivative
    | UniformMotion
    | GivenNumber
    | AbsoluteProduct
    | InverseFormula
    | FunctionOfLetter
    | Cofactors
)
