"""Order from dependence: matching of equations to unknowns, and the groups that must be solved together.

Dulmage-Mendelsohn decomposition of a square structurally regular system: a perfect matching, then the
strongly connected components of "depends on", dependencies first. Any perfect matching gives the same
components.
"""

from __future__ import annotations

import heapq
from collections import deque
from collections.abc import Hashable, Mapping, Sequence
from typing import TypeVar

Left = TypeVar("Left", bound=Hashable)
Right = TypeVar("Right", bound=Hashable)
Node = TypeVar("Node", bound=Hashable)


def match(neighbours: Mapping[Left, Sequence[Right]]) -> dict[Right, Left]:
    """Matching of greatest size, right -> left, by augmenting paths (breadth first, no recursion)."""
    owner: dict[Right, Left] = {}
    mate: dict[Left, Right] = {}
    for start in neighbours:
        came_from, free = _augmenting_path(start, neighbours, owner)
        while free is not None:
            left = came_from[free]
            owner[free], mate[left], free = left, free, mate.get(left)
    return owner


def _augmenting_path(
    start: Left, neighbours: Mapping[Left, Sequence[Right]], owner: Mapping[Right, Left]
) -> tuple[dict[Right, Left], Right | None]:
    """Where each right node was reached from, and a free one at the end of a path, if there is one."""
    came_from: dict[Right, Left] = {}
    queue = deque([start])
    while queue:
        left = queue.popleft()
        for right in neighbours[left]:
            if right in came_from:
                continue
            came_from[right] = left
            if right not in owner:
                return came_from, right
            queue.append(owner[right])
    return came_from, None


def strong_components(depends: Mapping[Node, Sequence[Node]]) -> list[list[Node]]:
    """Strongly connected components (Tarjan, iterative), each in the order of `depends`."""
    index: dict[Node, int] = {}
    low: dict[Node, int] = {}
    on_stack: set[Node] = set()
    stack: list[Node] = []
    found: list[list[Node]] = []
    rank = {node: k for k, node in enumerate(depends)}

    for root in depends:
        if root in index:
            continue
        work = [(root, iter(depends[root]))]
        index[root] = low[root] = len(index)
        stack.append(root)
        on_stack.add(root)
        while work:
            node, rest = work[-1]
            for other in rest:
                if other not in index:
                    index[other] = low[other] = len(index)
                    stack.append(other)
                    on_stack.add(other)
                    work.append((other, iter(depends[other])))
                    break
                if other in on_stack:
                    low[node] = min(low[node], index[other])
            else:
                work.pop()
                if work:
                    low[work[-1][0]] = min(low[work[-1][0]], low[node])
                if low[node] == index[node]:
                    component: list[Node] = []
                    while not component or component[-1] != node:
                        component.append(stack.pop())
                        on_stack.discard(component[-1])
                    found.append(sorted(component, key=rank.__getitem__))
    return found


def in_order(
    components: Sequence[Sequence[Node]], depends: Mapping[Node, Sequence[Node]]
) -> list[list[Node]]:
    """Components with dependencies first; of those that are ready, the first in the order of `depends`."""
    rank = {node: k for k, node in enumerate(depends)}
    home = {node: k for k, component in enumerate(components) for node in component}
    waits = {
        k: {home[other] for node in component for other in depends[node]} - {k}
        for k, component in enumerate(components)
    }
    followers: dict[int, list[int]] = {k: [] for k in waits}
    for k, before in waits.items():
        for other in before:
            followers[other].append(k)
    first = {k: min(rank[node] for node in component) for k, component in enumerate(components)}
    ready = [(first[k], k) for k, before in waits.items() if not before]
    heapq.heapify(ready)
    ordered = []
    while ready:
        _rank, k = heapq.heappop(ready)
        ordered.append(list(components[k]))
        for follower in followers[k]:
            waits[follower].discard(k)
            if not waits[follower]:
                heapq.heappush(ready, (first[follower], follower))
    return ordered
