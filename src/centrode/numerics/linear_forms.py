"""Sums of products, each of a factor that stands and one that moves: derivatives as a scan over samples adds them up.

A sum over samples is linear: a factor that stands while samples are passed is multiplied once, at the end. So what is
added up are the factors that move, and several derivatives have some of them in common.
"""

from __future__ import annotations

from collections.abc import Callable, Container, Mapping, Sequence
from typing import TypeAlias

from centrode.numerics.expressions import EXPRESSIONS, Node, Operand, as_node
from centrode.numerics.graphs import Graph, partial_derivatives, topological_order
from centrode.numerics.operations import CONSTANT, VARIABLE

LinearForm: TypeAlias = Mapping[Node, Operand]
"""What moves -> the factor that stands; what stands alone is a factor of `ONE`."""

m = EXPRESSIONS
ONE = as_node(1.0)


class StandingFactors:
    """Tells what stands from what moves.

    Parameters
    ----------
    moving : names of the variables that move
    """

    def __init__(self, moving: Container[str]) -> None:
        self._moving = moving
        self._moves: dict[Node, bool] = {}

    def moves(self, node: Node) -> bool:
        """Whether a node depends on a variable that moves."""
        for x in topological_order([node]) if node not in self._moves else ():
            if x not in self._moves:
                own = x.operation == VARIABLE and x.detail in self._moving
                self._moves[x] = own or any(self._moves[y] for y in x.arguments)
        return self._moves[node]

    def split(self, number: Operand) -> tuple[Node, Operand]:
        """What moves of a number, and the factor of it that stands; a sum stays as it is."""
        node = as_node(number)
        if not self.moves(node):
            return ONE, number
        if node.operation == "negate":
            what, factor = self.split(node.arguments[0])
            return what, -factor
        if node.operation == "multiply":
            (one, of_one), (other, of_other) = map(self.split, node.arguments)
            # a product that is there anyway is not made again in another order
            what = node if _is_one(of_one) and _is_one(of_other) else _product(one, other)
            return what, of_one * of_other
        return node, 1.0

    def number_of(self, form: LinearForm) -> Operand:
        """The number that a form is; factors that several have in common are multiplied once."""
        groups: dict[Node, Operand] = {}
        for what, factor in self._merged_form(form).items():
            if what is not ONE:
                key = as_node(factor)
                groups[key] = groups[key] + what if key in groups else what
        total: Operand = 0.0
        for key, together in groups.items():
            term = together if _is_one(key) else -together if _is_minus_one(key) else key * together
            total = term if _is_zero(total) else total + term
        if ONE not in form:
            return total
        return form[ONE] if _is_zero(total) else total + form[ONE]

    def with_common_factors(self, form: LinearForm) -> LinearForm:
        """The form with one number for all that has the same factor."""
        groups: dict[Node, dict[Node, Operand]] = {}
        for what, factor in form.items():
            if what is not ONE:
                groups.setdefault(as_node(factor), {})[what] = 1.0
        common: dict[Node, Operand] = {as_node(self.number_of(x)): key for key, x in groups.items()}
        return {**common, ONE: form[ONE]} if ONE in form else common

    def _merged_form(self, form: LinearForm) -> LinearForm:
        """The form without sums of what is in the form itself: of c, s and p c + q s the last needs no product."""
        merged = dict(form)
        for what, factor in form.items():
            terms = self._terms(what)
            if terms and all(x in merged and x is not what for x, _y in terms):
                del merged[what]
                _add(merged, {x: factor * y for x, y in terms})
        return merged

    def _terms(self, node: Node) -> list[tuple[Node, Operand]]:
        """A sum of two terms as what moves in each with its factor; empty of anything else."""
        if node.operation not in ("add", "subtract"):
            return []
        (one, of_one), (other, of_other) = map(self.split, node.arguments)
        return [(one, of_one), (other, of_other if node.operation == "add" else -of_other)]

    def derivatives(
        self,
        outputs: Sequence[Node],
        directions: Sequence[Mapping[Node, Operand]],
        settle: Callable[[Graph], Graph],
    ) -> list[list[LinearForm]]:
        """Derivatives of nodes along directions, a list for each direction; see `graphs.directional_derivatives`.

        `settle` gives factors as they are to be computed: what is differentiated may be written otherwise.
        """
        order = [node for node in topological_order(outputs) if node.arguments and not node.is_condition]
        factors = {
            f"{k} {i}": factor
            for k, node in enumerate(order)
            for i, factor in enumerate(partial_derivatives(node))
            if factor is not None
        }
        settled = settle(Graph.of(factors)).outputs
        changes: list[dict[Node, dict[Node, Operand]]] = [
            {x: {ONE: change} for x, change in direction.items()} for direction in directions
        ]
        for k, node in enumerate(order):
            for change in changes:
                total: dict[Node, Operand] = {}
                for i, argument in enumerate(node.arguments):
                    # a change times a plain zero is none
                    if argument in change and not _is_zero(settled.get(f"{k} {i}", 0.0)):
                        _add(total, self._times(change[argument], settled[f"{k} {i}"]))
                if total:
                    change[node] = total
        return [[change.get(x, {}) for x in outputs] for change in changes]

    def _times(self, form: LinearForm, factor: Node) -> LinearForm:
        if factor.is_condition:
            # a condition stands for 1 or 0
            return {as_node(m.where(factor, self.number_of(form), 0.0)): 1.0}
        what, standing = self.split(factor)
        if what is ONE:
            return {x: y * standing for x, y in form.items()}
        if len(form) == 1:
            ((x, y),) = form.items()
            return {_product(x, what): y * standing}
        return {_product(as_node(self.number_of(form)), what): standing}


def _add(total: dict[Node, Operand], more: LinearForm) -> None:
    for what, factor in more.items():
        if not _is_zero(factor):
            total[what] = total[what] + factor if what in total else factor


def _product(a: Node, b: Node) -> Node:
    return b if a is ONE else a if b is ONE else as_node(a * b)


def _is_number(x: Operand, number: float) -> bool:
    return x == number if isinstance(x, float) else x.operation == CONSTANT and x.detail == number


def _is_zero(x: Operand) -> bool:
    return _is_number(x, 0.0)


def _is_one(x: Operand) -> bool:
    return _is_number(x, 1.0)


def _is_minus_one(x: Operand) -> bool:
    return _is_number(x, -1.0)
