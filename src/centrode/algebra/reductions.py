"""Reductions as states of a scan: what is left of all steps is one number a lane. NaN is left out.

Each gives the next values of states and what they start with, for `Scan(state=...)` and its first state.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from centrode.algebra.expression_functions import EXPRESSIONS
from centrode.algebra.expressions import Node, Operand, as_node, variable
from centrode.algebra.gradients import gradient

m = EXPRESSIONS


class Reduction(NamedTuple):
    """States of a scan.

    Attributes
    ----------
    state : name -> its next value
    start : name -> its value before the first step
    """

    state: Mapping[str, Node]
    start: Mapping[str, float]


def greatest(name: str, value: Node) -> Reduction:
    """The greatest value of all steps; NaN if there is none."""
    return Reduction({name: as_node(m.greatest(value, variable(name)))}, {name: math.nan})


def least(name: str, value: Node) -> Reduction:
    """The least value of all steps; NaN if there is none."""
    return Reduction({name: as_node(m.least(value, variable(name)))}, {name: math.nan})


def total(name: str, value: Node) -> Reduction:
    """The sum of all values."""
    return Reduction({name: _more(name, value, value)}, {name: 0.0})


def number_of(name: str, value: Node) -> Reduction:
    """How many values there are."""
    return Reduction({name: _more(name, value, 1.0)}, {name: 0.0})


def total_with_gradient(name: str, value: Node, by: Sequence[Node]) -> Reduction:
    """The sum and its derivatives: states `name` and `name by variable`."""
    parts = {f"{name} by {x.detail}": part for x, part in zip(by, gradient(value, by), strict=True)}
    state = {label: _more(label, value, part) for label, part in {name: value, **parts}.items()}
    return Reduction(state, dict.fromkeys(state, 0.0))


def greatest_with_gradient(name: str, value: Node, by: Sequence[Node]) -> Reduction:
    """The greatest value and its derivatives there; of equals the first one counts."""
    so_far = variable(name)
    better = m.either(m.less(so_far, value), m.opposite(m.is_number(so_far)))
    state = {name: m.where(better, value, so_far)}
    for x, part in zip(by, gradient(value, by), strict=True):
        label = f"{name} by {x.detail}"
        state[label] = m.where(better, part, variable(label))
    return Reduction(state, dict.fromkeys(state, math.nan))


def together(*reductions: Reduction) -> Reduction:
    """Several reductions in one pass."""
    state = {name: node for one in reductions for name, node in one.state.items()}
    return Reduction(state, {name: value for one in reductions for name, value in one.start.items()})


def _more(name: str, value: Node, part: Operand) -> Node:
    so_far = variable(name)
    return m.where(m.is_number(value), so_far + part, so_far)
