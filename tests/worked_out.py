"""Formulas of a mechanism worked out as numbers, one after the other, as one does by hand."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

import centrode as ct
from centrode.equations.derivation import Equations
from centrode.equations.linear import GroupSolution
from centrode.equations.spelling import SymbolFormula
from centrode.equations.symbols import Letter
from centrode.kinematics.path import JETS
from centrode.numerics.jets import Jet
from samples import examples_at_hand

Values = dict[Letter, Any]


def value_of(formula: SymbolFormula, values: Values) -> float:
    return float(formula.total.value(math, values.__getitem__))


def initial_values(found: Equations) -> Values:
    """Every letter's number in the initial position: drives by their laws, rates and accelerations by the formulas."""
    values: Values = dict(found.board.alphabet.values)
    path = {one.drive.id: one for one in found.board.ready.kinematics.path.driven}
    for one in found.given.drives:
        jet = path[one.drive].value(JETS, Jet.variable(np.float64(0.0), 2))
        derivatives = [float(jet.derivative(k)) if isinstance(jet, Jet) else 0.0 for k in range(3)]
        for letter, value in zip((one.letter, one.rate, one.second), derivatives, strict=True):
            values[letter] = value
    for letter, name in found.given.names.items():
        values[name] = values[letter]
    for group in found.groups:
        work_out(group.velocities, group.normal_form, values)
    for group in found.groups:
        work_out(group.seconds, group.seconds.formulas, values)
    return values


def work_out(solution: GroupSolution, formulas: tuple[SymbolFormula, ...] | None, values: Values) -> None:
    """Add the unknowns of a system: by the formulas, or where these are too long by the system itself."""
    system = solution.system

    def number(total: Any) -> float:
        return float(total.value(math, values.__getitem__))

    if formulas is None:
        matrix = [[number(entry) for entry in row] for row in system.matrix]
        solved = np.linalg.solve(matrix, [number(entry) for entry in system.right])
    else:
        if system.determinant is not None:
            values[solution.under] = value_of(system.determinant, values)
        solved = np.array([value_of(formula, values) for formula in formulas])
    values.update(zip(system.unknowns, solved, strict=True))


def condition(found: Equations, values: Values) -> float:
    """The worst condition number of the groups' systems, columns and rows of one size."""
    worst = 1.0
    for group in found.groups:
        matrix = np.array(
            [
                [float(x.value(math, values.__getitem__)) for x in row]
                for row in group.velocities.system.matrix
            ]
        )
        matrix = matrix / np.linalg.norm(matrix, axis=1, keepdims=True)
        matrix = matrix / np.linalg.norm(matrix, axis=0)
        worst = max(worst, float(np.linalg.cond(matrix)))
    return worst


def planar_examples() -> list[str]:
    return [name for name in examples_at_hand(ct.example_names()) if ct.example(name).space == "plane"]
