"""Sums of products without squares of a cosine beside those of its sine, and without products of them that cancel.

A vector of a link that is turned by its rotor (c, s) has a length that does not depend on it: c^2 a + s^2 a is a. Jets
of positions do not know that, so it is looked for in the sums that they leave: there it makes numbers of a lane of
what would be computed in every stage.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Mapping, Sequence
from typing import TypeAlias

from centrode.numerics.expressions import Node, Operand
from centrode.numerics.graphs import rebuilt
from centrode.numerics.operations import VARIABLE

Term: TypeAlias = tuple[bool, Node]
"""A term of a sum, and whether it is taken off."""
Factors: TypeAlias = frozenset[tuple[Node, int]]

MOST_TERMS = 48
"""Longer sums stay as they are."""


def without_unit_squares(
    outputs: Mapping[str, Node], rotors: Sequence[tuple[Node, Node]], early: Collection[str]
) -> dict[str, Node]:
    """Outputs whose sums make use of c^2 + s^2 = 1.

    Parameters
    ----------
    rotors : pairs of a cosine and its sine
    early : names of variables that are multiplied first, as they stay what they are
    """
    return _Merging(rotors, early).merged_outputs(outputs)


class _Merging:
    def __init__(self, rotors: Sequence[tuple[Node, Node]], early: Collection[str]) -> None:
        self.partners = {one: other for pair in rotors for one, other in (pair, pair[::-1])}
        self.early = frozenset(early)
        self.factors: dict[Node, Factors] = {}

    def merged_outputs(self, outputs: Mapping[str, Node]) -> dict[str, Node]:
        """Outputs with all sums merged."""
        return rebuilt(outputs, self._sum)

    def _sum(self, node: Node, arguments: tuple[Node, ...]) -> Operand | None:
        if node.operation not in ("add", "subtract"):
            return None
        terms: list[Term] = []
        first, second = arguments
        if not (
            self._collect(first, False, terms) and self._collect(second, node.operation == "subtract", terms)
        ):
            return None
        shorter = self._merge(terms)
        return None if len(shorter) == len(terms) else self._total(shorter)

    def _collect(self, node: Node, off: bool, terms: list[Term]) -> bool:
        """Add the terms of a sum; False where there are too many."""
        left = [(node, off)]
        while left:
            one, sign = left.pop()
            if one.operation in ("add", "subtract"):
                a, b = one.arguments
                left += [(b, sign != (one.operation == "subtract")), (a, sign)]
            elif one.operation == "negate":
                left.append((one.arguments[0], not sign))
            else:
                terms.append((sign, one))
            if len(terms) + len(left) > MOST_TERMS:
                return False
        return True

    def _merge(self, terms: Sequence[Term]) -> list[Term]:
        """Terms of the same sum, fewer where some cancel or add up to one without a rotor."""
        left = {k: (off, self._factors(node), node) for k, (off, node) in enumerate(terms)}
        places: dict[tuple[bool, Factors], list[int]] = {}
        for k, (off, factors, _node) in left.items():
            places.setdefault((off, factors), []).append(k)
        waiting = list(left)
        while waiting:
            k = waiting.pop()
            if k not in left:
                continue
            off, factors, _node = left[k]
            if not any(one in self.partners for one, _count in factors):
                # a number that is added and taken off again may be there to round
                continue
            other = self._other(places, left, k, (not off, factors))
            if other is not None:
                del left[k], left[other]
                continue
            for one, count in factors:
                partner = self.partners.get(one)
                if partner is None or count < 2:
                    continue
                rest = Counter(dict(factors))
                rest[one] -= 2
                mate = rest.copy()
                mate[partner] += 2
                other = self._other(places, left, k, (off, _frozen(mate)))
                if other is not None:
                    del left[k], left[other]
                    found = _frozen(rest)
                    number = len(terms) + len(places) + k
                    while number in left:
                        number += 1
                    left[number] = off, found, self._product(found)
                    places.setdefault((off, found), []).append(number)
                    waiting.append(number)
                    break
        return [(off, node) for off, _factors, node in left.values()]

    @staticmethod
    def _other(
        places: Mapping[tuple[bool, Factors], list[int]],
        left: Mapping[int, tuple[bool, Factors, Node]],
        own: int,
        key: tuple[bool, Factors],
    ) -> int | None:
        return next((k for k in places.get(key, ()) if k in left and k != own), None)

    def _factors(self, node: Node) -> Factors:
        known = self.factors.get(node)
        if known is None:
            counts: Counter[Node] = Counter()
            left = [node]
            while left:
                one = left.pop()
                if one.operation == "multiply":
                    left += one.arguments
                else:
                    counts[one] += 1
            known = self.factors[node] = _frozen(counts)
        return known

    def _product(self, factors: Factors) -> Node:
        """The product of factors, those that stay what they are first."""
        ordered = sorted(
            (one for one, count in factors for _k in range(count)),
            key=lambda one: (not (one.operation == VARIABLE and one.detail in self.early), one.key),
        )
        total: Operand = 1.0
        for one in ordered:
            total = one * total
        assert isinstance(total, Node)
        return total

    @staticmethod
    def _total(terms: Sequence[Term]) -> Operand:
        ordered = sorted(terms, key=lambda term: term[0])
        if not ordered:
            return 0.0
        (off, first), *others = ordered
        total: Operand = -first if off else first
        for taken_off, node in others:
            total = total - node if taken_off else total + node
        return total


def _frozen(counts: Counter[Node]) -> Factors:
    return frozenset((one, count) for one, count in counts.items() if count)
