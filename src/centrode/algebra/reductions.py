"""Reductions as states of a scan: what is left of all steps is one number a lane. NaN is left out.

Each gives the next values of states and what they start with, for `Scan(state=...)` and its first state.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from types import MappingProxyType
from typing import NamedTuple

from centrode.algebra.expression_functions import EXPRESSIONS
from centrode.algebra.expressions import Node, Operand, as_node, variable
from centrode.algebra.gradients import gradient
from centrode.algebra.graphs import Graph, split
from centrode.algebra.scans import Scan

m = EXPRESSIONS


class Reduction(NamedTuple):
    """States of a scan.

    Attributes
    ----------
    state : name -> its next value
    start : name -> its value before the first step
    at_end : name -> what the last states and the lane's parameters make, once a lane
    """

    state: Mapping[str, Node]
    start: Mapping[str, float]
    at_end: Mapping[str, Node] = MappingProxyType({})


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


def total_with_gradient(name: str, value: Node, by: Sequence[Node], moving: Collection[str]) -> Reduction:
    """The sum and its derivatives: `at_end` has `name` and `name by variable`.

    `moving` are the variables that differ from step to step. A sum is linear in its derivatives by the parts of the
    formula that stand meanwhile: these are what the states carry, and the chain from there to the variables `by` is
    gone through once a lane.
    """
    variables = [x for x in Graph({"": value}).variables if x not in moving]
    parts, rest = split(Graph({"": value}), variables, f"{name} part")
    own = {x: variable(x) for x in rest.variables if x in variables}
    standing = {**parts.outputs, **own}
    slopes = Graph.of(
        dict(zip(standing, gradient(rest.outputs[""], [variable(x) for x in standing]), strict=True))
    )
    carried = slopes.substituted(parts.outputs).outputs
    labels = {x: f"{name} through {x}" for x in standing}
    state = {name: _more(name, value, value)}
    state |= {labels[x]: _more(labels[x], value, carried[x]) for x in standing}
    ends: dict[str, Operand] = {name: variable(name)}
    for x in by:
        ends[f"{name} by {x.detail}"] = 0.0
    for part, node in standing.items():
        for x, factor in zip(by, gradient(node, by), strict=True):
            ends[f"{name} by {x.detail}"] = ends[f"{name} by {x.detail}"] + variable(labels[part]) * factor
    return Reduction(state, dict.fromkeys(state, 0.0), Graph.of(ends).outputs)


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
    start = {name: value for one in reductions for name, value in one.start.items()}
    return Reduction(state, start, {name: node for one in reductions for name, node in one.at_end.items()})


def end_of(reduction: Reduction, parameters: Sequence[str]) -> Scan:
    """The scan of one step that computes `at_end`: parameters and then the last states are its parameters."""
    return Scan((*parameters, *reduction.state), (), reduction.at_end)


def _more(name: str, value: Node, part: Operand) -> Node:
    so_far = variable(name)
    return m.where(m.is_number(value), so_far + part, so_far)
