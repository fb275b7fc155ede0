"""A graph in stages, each of which gets a loop over the lanes of its own.

An arc tangent is a long chain of operations. Beside all others it takes registers and hides how little the
numbers of two vectors have to wait for each other; in a loop of its own the processor has several under way.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from centrode.algebra.expressions import Node

LONG = frozenset({"atan2"})
MOST_LEFT = 32
"""Numbers that stages may leave for later ones; more, and waiting for memory costs what the loops gain."""


@dataclass(frozen=True)
class Stage:
    """What one loop computes.

    Attributes
    ----------
    nodes : in order, variables included
    left : of these, what later stages take
    """

    nodes: tuple[Node, ...]
    left: tuple[Node, ...]


def stages_of(order: Sequence[Node]) -> list[Stage]:
    """Nodes in stages: each arc tangent, and what hangs on it, behind all that hangs on none."""
    numbers = _numbers(order)
    count = max(numbers.values(), default=0) + 1
    last_use = {x: numbers[node] for node in sorted(order, key=numbers.__getitem__) for x in node.arguments}
    waiting = [x for x in order if x.arguments and last_use.get(x, 0) > numbers[x]]
    if count == 1 or len(waiting) > MOST_LEFT or any(x.is_condition for x in waiting):
        return [Stage(tuple(order), ())]
    found = []
    for number in range(count):
        nodes = tuple(node for node in order if numbers[node] == number)
        found.append(Stage(nodes, tuple(x for x in waiting if numbers[x] == number)))
    return found


def _numbers(order: Sequence[Node]) -> dict[Node, int]:
    """Which stage a node belongs to."""
    numbers: dict[Node, int] = {}
    longs = 0
    for node in order:
        number = max((numbers[x] for x in node.arguments if x in numbers), default=0)
        if node.operation in LONG:
            longs += 1
            number = longs
        numbers[node] = number
    return numbers
