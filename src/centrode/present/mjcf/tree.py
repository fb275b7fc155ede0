"""A planar linkage as a tree of bodies, and what is left over: pins and prismatic pairs that close its loops.

All bodies stand as they do initially and their axes are those of the world, so every coordinate of a joint counts
from the initial position. A guide without a link of its own gets a slider, a cylinder a barrel and a rod, a loop of
prismatic pairs a carriage.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import TypeAlias

from centrode.model.mechanism import FRAME, Mechanism

Place: TypeAlias = tuple[float, float]


@dataclass(frozen=True)
class Pair:
    """Two bodies that turn about a point, or slide along a direction.

    Attributes
    ----------
    name : of the joint in the model
    place : where the point is initially [m]
    direction : along which the second slides on the first; None for a hinge
    point : the hinge's name; None for a pair that slides
    """

    name: str
    first: str
    second: str
    place: Place
    direction: Place | None = None
    point: str | None = None


@dataclass
class Tree:
    """Bodies below each other, as they are reached from the frame.

    Attributes
    ----------
    joints : body -> the pair by which it hangs, and the body it hangs on
    closures : pairs that the tree leaves open
    """

    joints: dict[str, tuple[Pair, str]] = field(default_factory=dict)
    closures: list[Pair] = field(default_factory=list)

    def children(self, body: str) -> list[str]:
        """Bodies that hang on a body, in the order in which they were reached."""
        return [name for name, (_pair, parent) in self.joints.items() if parent == body]

    def turn(self, body: str) -> dict[str, float]:
        """The angle turned by a body since the beginning, as joints and their factors."""
        found: dict[str, float] = {}
        while body in self.joints:
            pair, parent = self.joints[body]
            if pair.direction is None:
                found[pair.name] = 1.0
            body = parent
        return found


def tree_of(mechanism: Mechanism, places: Mapping[str, Place], directions: Mapping[str, Place]) -> Tree:
    """The tree; `places` of the points and `directions` of the guides are those of the initial position [m].

    What slides on a body is reached from it at once: loops then close in hinges. A loop of prismatic pairs alone closes
    in a carriage: a body that slides like the last of them, and is pinned where that one is, as none of them turns
    against another.
    """
    pairs = _pairs(mechanism, places, directions)
    tree, waiting, known = Tree(), deque([FRAME]), {FRAME}
    used: list[Pair] = []

    def reach(body: str, choice: list[Pair]) -> None:
        for pair in choice:
            other = {pair.first: pair.second, pair.second: pair.first}.get(body)
            if other is not None and other not in known:
                tree.joints[other] = pair, body
                used.append(pair)
                known.add(other)
                waiting.append(other)
                reach(other, sliding)

    sliding = [pair for pair in pairs if pair.direction is not None]
    reach(FRAME, sliding)
    while waiting:
        reach(waiting.popleft(), pairs)
    for pair in _left_over(pairs, used):
        if pair.direction is None:
            tree.closures.append(pair)
            continue
        carriage = carriage_name(pair.name)
        slid = replace(pair, second=carriage)
        tree.joints[carriage] = slid, pair.first
        tree.closures.append(Pair(f"{pair.name} closes", carriage, pair.second, pair.place))
    return tree


def _left_over(pairs: list[Pair], used: list[Pair]) -> list[Pair]:
    """Pairs that the tree does not keep by itself: of the hinges at one point, as many as join what is still apart."""
    left = [pair for pair in pairs if pair.point is None and pair not in used]
    for point in dict.fromkeys(pair.point for pair in pairs if pair.point is not None):
        joined: dict[str, str] = {}

        def root(body: str, joined: dict[str, str] = joined) -> str:
            while body in joined:
                body = joined[body]
            return body

        here = [pair for pair in pairs if pair.point == point]
        for pair in sorted(here, key=lambda pair: pair not in used):
            first, second = root(pair.first), root(pair.second)
            if first != second:
                joined[first] = second
                if pair not in used:
                    left.append(pair)
    return left


def _pairs(mechanism: Mechanism, places: Mapping[str, Place], directions: Mapping[str, Place]) -> list[Pair]:
    """All pairs; those of driven links with the bodies that they are driven against come first."""
    members = _members(mechanism)
    found = [
        Pair(f"{first} {second} {point}", first, second, places[point], point=point)
        for point, bodies in members.items()
        for i, first in enumerate(bodies)
        for second in bodies[i + 1 :]
    ]
    for guide in mechanism.guides:
        second = guide.link or slider_name(guide.id)
        found.append(Pair(f"guide {guide.id}", guide.on, second, places[guide.point], directions[guide.id]))
    for drive in mechanism.drives:
        if drive.distance is not None:
            start, end = (places[point] for point in drive.distance)
            way = (end[0] - start[0], end[1] - start[1])
            length = (way[0] ** 2 + way[1] ** 2) ** 0.5
            barrel, rod = cylinder_names(drive.id)
            found.append(Pair(f"drive {drive.id}", barrel, rod, end, (way[0] / length, way[1] / length)))
    driven = {frozenset((drive.link, drive.relative_to)) for drive in mechanism.drives if drive.link}
    return sorted(found, key=lambda pair: frozenset((pair.first, pair.second)) not in driven)


def _members(mechanism: Mechanism) -> dict[str, list[str]]:
    """Point -> the bodies that are hinged there; a link that a guide holds needs no other slider."""
    found: dict[str, list[str]] = {}
    for point in mechanism.frame.points:
        found.setdefault(point, []).append(FRAME)
    for name, link in mechanism.links.items():
        for point in link.coordinates:
            found.setdefault(point, []).append(name)
    for guide in mechanism.guides:
        if guide.link is None:
            found.setdefault(guide.point, []).append(slider_name(guide.id))
    for drive in mechanism.drives:
        for point, body in zip(drive.distance or (), cylinder_names(drive.id), strict=False):
            found.setdefault(point, []).append(body)
    return {point: bodies for point, bodies in found.items() if len(bodies) > 1}


def slider_name(guide: str) -> str:
    """The body that slides along a guide without a link of its own."""
    return f"slider {guide}"


def carriage_name(pair: str) -> str:
    """The body that slides where a loop closes in a prismatic pair."""
    return f"carriage {pair}"


def cylinder_names(drive: str) -> tuple[str, str]:
    """Barrel and rod of a cylinder."""
    return f"barrel {drive}", f"rod {drive}"


def outline(places: list[Place]) -> list[tuple[Place, Place]]:
    """Lines between the points of a body, in their order and closed where there are more than two."""
    closed = [*places, places[0]] if len(places) > 2 else places
    return list(pairwise(closed))
