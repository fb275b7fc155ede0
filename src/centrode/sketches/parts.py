"""Rigid parts of a drawn mechanism: what they join, which of them are one, which hang together with the frame."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from itertools import combinations

from centrode.errors import InputError
from centrode.locale import _
from centrode.sketches.sketch import Place, role_of

RIGHT_ANGLE = 0.02
"""Cosine up to which corners of a rectangle are right, sine up to which lines are parallel."""
FRAME = 0
"""Number of the frame among the bodies."""


@dataclass
class Body:
    """A rigid part: the nodes that it joins in the order in which they are drawn, its sides, name and layer."""

    nodes: list[int]
    sides: list[tuple[int, int]]
    name: str = ""
    layer: str = ""


@dataclass(frozen=True)
class Guided:
    """A node on a line: its direction, and the body that carries the line."""

    node: int
    direction: Place
    carrier: int


@dataclass
class DrawingParts:
    """Nodes, bodies (the frame first) and guides of a drawing.

    Attributes
    ----------
    places : of nodes, in the drawing's units
    names : of nodes
    driven : bodies that turn about a fixed hinge, with their speeds as texts, empty where the drawing names none
    cylinders : pairs of nodes whose distance is driven, with their speeds
    """

    places: list[Place] = field(default_factory=list)
    bodies: list[Body] = field(default_factory=lambda: [Body([], [])])
    guided: list[Guided] = field(default_factory=list)
    names: list[str] = field(default_factory=list)
    driven: list[tuple[int, str]] = field(default_factory=list)
    cylinders: list[tuple[int, int, str]] = field(default_factory=list)

    def unite(self, kept: Body, other: Body) -> None:
        """Make one body of two."""
        into, gone = self._number(kept), self._number(other)
        kept.nodes += [k for k in other.nodes if k not in kept.nodes]
        kept.sides += other.sides
        kept.name = kept.name or other.name
        kept.layer = kept.layer if role_of(kept.layer) == "drive" else other.layer
        del self.bodies[gone]
        numbers = {
            k: (into if k == gone else k) - ((into if k == gone else k) > gone)
            for k in range(len(self.bodies) + 1)
        }
        self._renumber(numbers)

    def remove(self, body: Body) -> None:
        """Remove a body, and what it carries."""
        gone = self._number(body)
        del self.bodies[gone]
        self._renumber({k: k - (k > gone) for k in range(len(self.bodies) + 1) if k != gone})

    def _number(self, body: Body) -> int:
        return next(k for k, one in enumerate(self.bodies) if one is body)

    def _renumber(self, numbers: dict[int, int]) -> None:
        self.guided = [
            Guided(one.node, one.direction, numbers[one.carrier])
            for one in self.guided
            if one.carrier in numbers
        ]
        self.driven = [(numbers[body], speed) for body, speed in self.driven if body in numbers]

    def unite_rigid(self, where: str) -> int:
        """Make one of bodies that share two nodes, and of three that form a triangle; how many were given up.

        Raises InputError where links hold each other to the frame: that is no mechanism, or it was misread.
        """
        before = len(self.bodies)
        while group := self._rigid_group():
            first, *others = group
            if len(group) > 2 and first is self.bodies[FRAME]:
                names = ", ".join(
                    "-".join(self.names[k] for k in one.nodes) if self.names else "?" for one in others
                )
                what = _("links are held rigidly by the frame: {names}").format(names=names)
                raise InputError(where, what, _("put what is fixed on a layer named ground"))
            for other in others:
                self.unite(first, other)
        return before - len(self.bodies)

    def _rigid_group(self) -> list[Body]:
        """Bodies that hold each other, the frame first where it is among them."""
        shared: dict[tuple[int, int], set[int]] = {}
        sets = [set(body.nodes) for body in self.bodies]
        for one, other in combinations(range(len(sets)), 2):
            common = sets[one] & sets[other]
            if len(common) > 1:
                return [self.bodies[one], self.bodies[other]]
            if common:
                shared[one, other] = common
        neighbours: dict[int, set[int]] = {}
        for one, other in shared:
            neighbours.setdefault(one, set()).add(other)
            neighbours.setdefault(other, set()).add(one)
        for one, other in shared:
            for third in neighbours[one] & neighbours[other]:
                numbers = sorted((one, other, third))
                nodes = {next(iter(shared[pair])) for pair in combinations(numbers, 2)}
                if len(nodes) == 3:
                    return [self.bodies[k] for k in numbers]
        return []

    def leave_out_loose(self) -> int:
        """Remove bodies that do not hang together with the frame; how many they were."""
        held = {FRAME}
        joined = [set(body.nodes) for body in self.bodies]
        for one in self.guided:
            joined[one.carrier].add(one.node)
        for first, second, _speed in self.cylinders:
            both = [k for k, nodes in enumerate(joined) if nodes & {first, second}]
            for k in both:
                joined[k] |= {first, second}
        while more := {
            k for k in range(len(joined)) if k not in held and any(joined[k] & joined[m] for m in held)
        }:
            held |= more
        loose = len(self.bodies) - len(held)
        if loose:
            self.bodies = [self.bodies[k] for k in sorted(held)]
            self._renumber({old: new for new, old in enumerate(sorted(held))})
            kept = {k for body in self.bodies for k in body.nodes}
            self.guided = [one for one in self.guided if one.node in kept]
        return loose

    def check(self, where: str) -> None:
        """Raise InputError where nothing can move."""
        if len(self.bodies) < 2:
            what = _("the drawing has no moving link")
            raise InputError(
                where, what, _("put what is fixed on a layer named ground, links on one named links")
            )


# Lines of the plane.


def less(place: Place, origin: Place) -> Place:
    """A place as seen from an origin."""
    return place[0] - origin[0], place[1] - origin[1]


def unit(vector: Place) -> Place:
    """A vector of length 1 in the same direction; that of the x axis for a vector without length."""
    length = math.hypot(*vector)
    return (vector[0] / length, vector[1] / length) if length else (1.0, 0.0)


def parallel(one: Place, other: Place) -> bool:
    """Whether two vectors have the same direction, or opposite ones."""
    across = abs(one[0] * other[1] - one[1] * other[0])
    return across <= RIGHT_ANGLE * math.hypot(*one) * math.hypot(*other)


def along(place: Place, start: Place, end: Place) -> float:
    """Where the foot of a place on a segment stands: 0 at its start, 1 at its end."""
    way, off = less(end, start), less(place, start)
    square = way[0] ** 2 + way[1] ** 2
    return (way[0] * off[0] + way[1] * off[1]) / square if square else 0.0


def distance_to_segment(place: Place, start: Place, end: Place) -> float:
    """Distance of a place from the nearest point of a segment."""
    share = min(1.0, max(0.0, along(place, start, end)))
    foot = start[0] + share * (end[0] - start[0]), start[1] + share * (end[1] - start[1])
    return math.dist(place, foot)


def signed_distance(place: Place, start: Place, end: Place) -> float:
    """Distance of a place from the line through two, positive to its left."""
    way, off = less(end, start), less(place, start)
    length = math.hypot(*way)
    return (way[0] * off[1] - way[1] * off[0]) / length if length else math.hypot(*off)


def distance_to_line(place: Place, start: Place, end: Place) -> float:
    """Distance from a segment, or from its line where the foot is on it nearly."""
    share = along(place, start, end)
    return abs(signed_distance(place, start, end)) if -0.05 <= share <= 1.05 else math.inf
