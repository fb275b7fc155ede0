"""Formulas in letters as strings: one walk over their leaves, a table of operations for each medium."""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING, assert_never

import lazy_loader

from centrode.sheets.symbolic import (
    AbsoluteProduct,
    Cofactors,
    FactoredFormula,
    FunctionOfLetter,
    GivenNumber,
    InitialValue,
    InverseFormula,
    SumFormula,
    SymbolicLeaf,
    TimeDerivative,
    UniformMotion,
)

if TYPE_CHECKING:
    from centrode.equations.spelling import FormulaSpelling

_spelling = functools.partial(lazy_loader.load, "centrode.equations.spelling", suppress_warning=True)
"""Loaded at the first formula: most commands print none."""


def plain_symbolic(leaf: SymbolicLeaf) -> str:
    """A leaf as one line of text."""
    return spell_symbolic(leaf, _spelling().FormulaSpelling())


def spell_symbolic(leaf: SymbolicLeaf, spelling: FormulaSpelling) -> str:
    """A leaf by the operations of a medium; letters stand where the medium puts in no numbers."""
    match leaf:
        case SumFormula(total):
            return str(_spelling().spelled_sum(total, spelling))
        case FactoredFormula(formula, differences_first, turned):
            return str(_spelling().spell_formula(formula, spelling, differences_first, turned))
        case InitialValue(letter):
            return spelling.initial(spelling.letter(letter))
        case TimeDerivative(letter):
            return spelling.derivative(letter)
        case UniformMotion():
            return _uniform_motion(leaf, spelling)
        case GivenNumber(value):
            return spelling.decimal(value)
        case AbsoluteProduct():
            return _absolute_product(leaf, spelling)
        case InverseFormula(formula):
            return formula.text(spelling)
        case FunctionOfLetter(function, letter):
            return spelling.function_of(function, letter)
        case Cofactors(step):
            return step.text(spelling)
        case _:
            assert_never(leaf)


def _uniform_motion(leaf: UniformMotion, spelling: FormulaSpelling) -> str:
    size = [spelling.decimal(abs(leaf.speed))] if abs(leaf.speed) != 1.0 else []
    way, minus = spelling.join([*size, "t"]), leaf.speed < 0
    if leaf.start:
        return f"{spelling.decimal(leaf.start)} {'-' if minus else '+'} {way}"
    return f"-{way}" if minus else way


def _absolute_product(leaf: AbsoluteProduct, spelling: FormulaSpelling) -> str:
    """Lengths first, then rates, which may be negative, between bars."""
    texts = []
    for letter, power, signed in sorted(leaf.factors, key=lambda factor: factor[2]):
        factor = spelling.power(spelling.letter(letter), power)
        texts.append(spelling.bars(factor) if signed else factor)
    return spelling.join(texts) or spelling.number(1)
