"""A group of higher class by its free coordinates alone: everything else follows, link by link, from what is known.

A link that hangs on a point that is known is told by its rotor; its points follow, and from these the links that
hang on them. So the equations that `reduction` eliminates hold by construction, and only those left over are
solved. In the plane.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeAlias

from centrode.algebra.jets import Jet
from centrode.geometry.plane import Pose, Vector, cross, dot, place, pose_with_point, subtract, turned
from centrode.kinematics.higher_class.reduction import Follow, Pattern, pattern_of
from centrode.structure.constraints import Constraint, PointInLink, Positions
from centrode.structure.dimensions import Dimensions
from centrode.structure.groups import Newton

Number: TypeAlias = Any
Namespace: TypeAlias = Any


@dataclass(frozen=True)
class Posture:
    """Where the free coordinates of a group stand.

    Attributes
    ----------
    rotors, angles : of its links; an angle has its turns
    places : of its points, and of the first points of its links, that hang on nothing
    """

    rotors: Mapping[str, Vector]
    angles: Mapping[str, Number]
    places: Mapping[str, Vector]


@dataclass(frozen=True)
class Leaf:
    """A link that hangs on a point and has to reach one other: its turn stands in the two equations of that alone.

    Seen along the arm between both, one equation does not speak of the turn; seen across, the other tells it.
    """

    constraint: PointInLink
    column: int
    rows: tuple[int, int]


@dataclass(frozen=True)
class Chain:
    """A group with its dimensions, over any algebra; free lengths are measured in `unit` [m]."""

    group: Newton
    numbers: Dimensions
    unit: float

    @property
    def pattern(self) -> Pattern:
        """What follows from what."""
        return pattern_of(self.group)

    @cached_property
    def kept(self) -> tuple[tuple[Constraint, int], ...]:
        """The equations left over, each a constraint and a row of it."""
        return tuple(self.group.equations[k] for k in self.pattern.kept)

    @cached_property
    def leaves(self) -> tuple[Leaf, ...]:
        """The links whose turns are found last."""
        follows = {f.entity.name: f for f in self.pattern.follows if f.entity.kind == "link" and f.by}
        spoken = [body for c, row in self.group.equations if row == 0 for body in c.bodies]
        found = []
        for number, (c, row) in enumerate(self.kept):
            if row or not isinstance(c, PointInLink) or c.link not in follows or (c, 1) not in self.kept:
                continue
            # the link is spoken of by its hinge and by this constraint, and by nothing else
            if sum(body.kind == "link" and body.name == c.link for body in spoken) == 2:
                found.append(Leaf(c, follows[c.link].turn, (number, self.kept.index((c, 1)))))
        return tuple(found)

    def posture(self, at: Positions) -> Posture:
        """The free coordinates of positions."""
        places = {}
        for follow in self.pattern.follows:
            name = follow.entity.name
            if follow.by is None:
                link = follow.entity.kind == "link"
                places[name] = place(at.poses[name], self._pivot(follow)) if link else at.points[name]
        links = self.group.links
        rotors = {name: at.poses[name].rotor for name in links}
        return Posture(rotors, {name: at.angles[name] for name in links}, places)

    def positions(self, known: Positions, posture: Posture, motion: Sequence[Number]) -> Positions:
        """Known positions with those of the group: in a posture, moved by jets that are zero there, or by 0.0."""
        at = known.copied()
        for follow in self.pattern.follows:
            name = follow.entity.name
            if follow.entity.kind == "link":
                turn = motion[follow.turn]
                at.poses[name] = self._pose(follow, posture, motion, at)
                at.angles[name] = posture.angles[name] + turn if _moves(turn) else posture.angles[name]
            elif follow.by is None:
                at.points[name] = self._shifted(follow, posture, motion)
            else:
                at.points[name] = place(at.poses[follow.by.link], self.numbers.local[follow.by.link][name])
        return at

    def _pose(self, follow: Follow, posture: Posture, motion: Sequence[Number], at: Positions) -> Pose:
        turn, rotor = motion[follow.turn], posture.rotors[follow.entity.name]
        if _moves(turn):
            rotor = turned(rotor, _rotor_of_zero(turn))
        there = self._shifted(follow, posture, motion) if follow.by is None else at.points[follow.by.point]
        return pose_with_point(self._pivot(follow), there, rotor)

    def _shifted(self, follow: Follow, posture: Posture, motion: Sequence[Number]) -> Vector:
        x, y = posture.places[follow.entity.name]
        by_x, by_y = motion[follow.first : follow.first + 2]
        return (
            x + self.unit * by_x if _moves(by_x) else x,
            y + self.unit * by_y if _moves(by_y) else y,
        )

    def _pivot(self, follow: Follow) -> Vector:
        """What a link turns about, in its axes."""
        local = self.numbers.local[follow.entity.name]
        pivot: Vector = next(iter(local.values())) if follow.by is None else local[follow.by.point]
        return pivot

    def arm(self, leaf: Leaf) -> Vector:
        """From the hinge of a leaf to the point that it has to reach, in its axes."""
        link = leaf.constraint.link
        follow = next(f for f in self.pattern.follows if f.entity.name == link and f.entity.kind == "link")
        return subtract(self.numbers.local[link][leaf.constraint.point], self._pivot(follow))

    def arms(self, posture: Posture) -> list[Vector]:
        """The arms of all leaves as they lie, in `unit`."""
        over = 1.0 / self.unit
        found = []
        for leaf in self.leaves:
            x, y = turned(self.arm(leaf), posture.rotors[leaf.constraint.link])
            found.append((x * over, y * over))
        return found

    def equations(self, m: Namespace, at: Positions, arms: Sequence[Vector]) -> list[Number]:
        """Left sides of the equations left over, those of leaves along and across given arms, in rad and `unit`."""
        over = 1.0 / self.unit
        sides: dict[Constraint, list[Number]] = {}
        values = []
        for c, row in self.kept:
            if c not in sides:
                sides[c] = c.residual(m, self.numbers, at)
            values.append(sides[c][row] if c.angular else sides[c][row] * over)
        for leaf, arm in zip(self.leaves, arms, strict=True):
            first, second = leaf.rows
            gap = values[first], values[second]
            values[first], values[second] = dot(gap, arm), cross(arm, gap)
        return values


def _moves(x: Number) -> bool:
    return isinstance(x, Jet)


def _rotor_of_zero(turn: Jet) -> Vector:
    """Rotor of a jet of first or second order whose value is zero."""
    rate = turn.coefficients[1]
    bend = turn.coefficients[2:]
    return Jet((1.0, 0.0, *(-0.5 * (rate * rate) for _x in bend))), Jet((0.0, rate, *bend))
