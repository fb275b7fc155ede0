"""The equations of a group of higher class at many places, over any algebra.

What is known beside the group is given at every place; the state of a place is where the group's points and
links are. Derivatives follow from the same equations over jets, order by order, and bounds of rounding errors
over bounded numbers (Griewank and Walther, Evaluating Derivatives, 2nd ed., 2008, section 13; Higham, Accuracy
and Stability of Numerical Algorithms, 2nd ed., 2002, section 25).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Any, TypeAlias, cast

import numpy as np
import numpy.typing as npt

from centrode.geometry.in_plane import PLANE
from centrode.geometry.plane import (
    PlanePose,
    Vector,
    cross,
    dot,
    is_literal_zero,
    place,
    pose_with_point,
    rotate_vector,
    rotor_of,
    subtract,
)
from centrode.kinematics.higher_class.elimination import Follow, Pattern, pattern_of
from centrode.kinematics.higher_class.loop_closure import LoopClosure, solve_places
from centrode.kinematics.path import JETS
from centrode.kinematics.plan_evaluation import EvaluationPolicy, Kinematics
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.jets import Jet
from centrode.numerics.rounding_bounds import ROUNDED, Rounded
from centrode.structure.constraints import Constraint, Entity, PointInLink, Positions
from centrode.structure.dimensions import Dimensions
from centrode.structure.groups import Newton

# Linear equations of a group of higher class, made small: what follows from a few free coordinates is left
# out (`elimination`).

Array: TypeAlias = npt.NDArray[np.float64]
Number: TypeAlias = Any
Shift: TypeAlias = Sequence[Number]
Block: TypeAlias = tuple[tuple[Number, Number], tuple[Number, Number]]


class Linear:
    """The equations of a group made linear at k places.

    `matrix` (k, free, free) are derivatives of the equations left over by the free coordinates: turns [rad], and
    shifts in the greatest length; their lengths are in the greatest length too.
    """

    def __init__(self, group: Newton, numbers: Dimensions, at: Positions, places: int) -> None:
        self.group, self.numbers, self.places = group, numbers, places
        self.pattern = pattern_of(group)
        rows = {c: c.rows(numbers, at) for c, _row in group.equations}
        self.rows = [rows[c][row] for c, row in group.equations]
        self.number = {equation: i for i, equation in enumerate(group.equations)}
        self.tangents: dict[Entity, dict[int, Shift]] = {}
        self._inverses: dict[Entity, Block] = {}
        self._shifts: dict[Entity, Sequence[Shift]] = {}
        for follow in self.pattern.follows:
            self.tangents[follow.entity] = self._tangents(follow, at)
        self.units = [
            1.0 if group.equations[i][0].angular else 1.0 / numbers.scale for i in self.pattern.kept
        ]
        self.matrix = self._matrix()

    def _tangents(self, follow: Follow, at: Positions) -> dict[int, Shift]:
        """Derivatives of an unknown by each free coordinate on which it depends."""
        entity, by, space = follow.entity, follow.by, self.numbers.space
        if by is None:
            if entity.kind == "point":
                return {follow.first: (self.numbers.scale, 0.0), follow.first + 1: (0.0, self.numbers.scale)}
            # the link's first point may only ride on it, and be solved after the group
            place = next(iter(self.numbers.local[entity.name].values()))
            pivot = space.place(ARRAYS, at.poses[entity.name], place)
            shifts = space.shifts(ARRAYS, pivot, self.numbers.scale)
            return {follow.first + k: shift for k, shift in enumerate(shifts)}
        one, other = self._pair(by)
        if entity.kind == "link":
            pivot = at.points[by.point]
            self._shifts[entity] = space.shifts(ARRAYS, pivot, 1.0)[:2]
            # how the hinge's two rows change as the link shifts: its inverse makes the link follow its pivot
            block = [[_dot(row[entity], shift) for shift in self._shifts[entity]] for row in (one, other)]
        else:
            block = [[row[entity][0], row[entity][1]] for row in (one, other)]
        self._inverses[entity] = _inverse(block)
        source = by.bodies[0] if entity.kind == "link" else by.bodies[1]
        tangents: dict[int, Shift] = {}
        for j, shift in self.tangents.get(source, {}).items():
            tangents[j] = self._answer(entity, [_minus(_dot(row[source], shift)) for row in (one, other)])
        if entity.kind == "link":
            tangents[follow.first] = space.spin(at.poses[entity.name], at.points[by.point])
        return tangents

    def _pair(self, by: PointInLink) -> tuple[Mapping[Entity, Shift], Mapping[Entity, Shift]]:
        return self.rows[self.number[by, 0]], self.rows[self.number[by, 1]]

    def _answer(self, entity: Entity, right: Sequence[Number]) -> Shift:
        """Shift of an unknown with which the two rows of its hinge give their right sides."""
        (a, b), (c, d) = self._inverses[entity]
        pair = _dot((a, b), right), _dot((c, d), right)
        if entity.kind == "point":
            return pair
        return _combine_shifts(pair, self._shifts[entity])

    def _matrix(self) -> Array:
        free = self.pattern.free
        parts = [x for k in self.pattern.kept for row in self.rows[k].values() for x in row]
        matrix = np.zeros(
            (self.places, free, free), dtype=np.result_type(np.float64, *map(np.asarray, parts))
        )
        for i, (k, unit) in enumerate(zip(self.pattern.kept, self.units, strict=True)):
            for entity, slopes in self.rows[k].items():
                for j, shift in self.tangents.get(entity, {}).items():
                    matrix[:, i, j] += _dot(slopes, shift) * unit
        return matrix

    def reduce(self, right: Sequence[Number]) -> tuple[dict[Entity, Shift], list[Number]]:
        """Shifts of eliminated unknowns for right sides without free motion, and the right sides left over."""
        moved: dict[Entity, Shift] = {}
        for entity, by, _first in self.pattern.follows:
            if by is None:
                continue
            source = by.bodies[0] if entity.kind == "link" else by.bodies[1]
            wanted = [right[self.number[by, k]] for k in (0, 1)]
            if source in moved:
                rows = self._pair(by)
                wanted = [x - _dot(row[source], moved[source]) for x, row in zip(wanted, rows, strict=True)]
            moved[entity] = self._answer(entity, wanted)
        rest = []
        for k, unit in zip(self.pattern.kept, self.units, strict=True):
            value = right[k]
            for entity, slopes in self.rows[k].items():
                if entity in moved:
                    value = value - _dot(slopes, moved[entity])
            rest.append(value * unit)
        return moved, rest

    def whole(self, moved: Mapping[Entity, Shift], free: Sequence[Number]) -> dict[Entity, Shift]:
        """Shifts of all unknowns: those without free motion, and those by values of the free coordinates."""
        shifts: dict[Entity, Shift] = {}
        for entity, tangents in self.tangents.items():
            total = moved.get(entity, (0.0,) * entity.unknowns)
            for j, shift in tangents.items():
                total = tuple(_sum(t, _dot((x,), (free[j],))) for t, x in zip(total, shift, strict=True))
            shifts[entity] = total
        return shifts


def _sum(a: Number, b: Number) -> Number:
    return b if is_literal_zero(a) else a if is_literal_zero(b) else a + b


def _minus(a: Number) -> Number:
    return a if is_literal_zero(a) else -a


def _dot(a: Sequence[Number], b: Sequence[Number]) -> Number:
    """Scalar product; literal zeros and ones, of which rows are full, cost nothing."""
    total: Number = 0.0
    for x, y in zip(a, b, strict=True):
        if is_literal_zero(x) or is_literal_zero(y):
            continue
        total = _sum(
            total, y if type(x) is float and x == 1.0 else x if type(y) is float and y == 1.0 else x * y
        )
    return total


def _combine_shifts(factors: Sequence[Number], shifts: Sequence[Shift]) -> Shift:
    return tuple(_dot(factors, [shift[k] for shift in shifts]) for k in range(len(shifts[0])))


def _inverse(block: Sequence[Sequence[Number]]) -> Block:
    """Inverse of a matrix of two rows and columns."""
    (a, b), (c, d) = block
    over = 1.0 / (_dot((a,), (d,)) - _dot((b,), (c,)))
    return (_dot((d,), (over,)), _minus(_dot((b,), (over,)))), (
        _minus(_dot((c,), (over,))),
        _dot((a,), (over,)),
    )


Mask: TypeAlias = npt.NDArray[np.bool_]
Namespace: TypeAlias = Any


@dataclass(frozen=True)
class GroupMotion:
    """A small motion of a group: how every unknown moves, and how its free coordinates change."""

    shifts: Mapping[Entity, Shift]
    free: Sequence[Number]


@dataclass(frozen=True)
class GroupSystem:
    """The equations of a group at k places: dimensions and known positions are floats or (k,) arrays.

    A state (k, width) holds the numbers of the group's points, then those of its links' poses, then the angles of
    its links with their turns, where turns are counted.
    """

    group: Newton
    numbers: Dimensions
    known: Positions
    places: int
    closure: LoopClosure | None = None
    """The same by loops, in the plane for one mechanism."""

    def take(self, which: npt.NDArray[np.intp]) -> GroupSystem:
        """The system of equations at the places with these numbers (n,)."""

        def take(x: Number) -> Number:
            return x if np.ndim(x) == 0 else x[which]

        numbers = self.numbers if self.numbers.alone else self.numbers.map_numbers(take)
        return GroupSystem(self.group, numbers, self.known.map_numbers(take), len(which), self.closure)

    @cached_property
    def pattern(self) -> Pattern:
        """Order in which unknowns follow from free coordinates."""
        return pattern_of(self.group)

    @property
    def free(self) -> int:
        """Number of free coordinates."""
        return self.pattern.free

    @property
    def turning(self) -> int:
        """Count of the numbers of a state that are angles with their turns; they are its last ones."""
        return len(self._turns)

    @cached_property
    def _turns(self) -> dict[str, int]:
        """The free coordinate that turns a link, where turns are counted."""
        if "rolling" in self.numbers.space.lacks:
            return {}  # no turns are counted there
        return {f.entity.name: f.turn for f in self.pattern.follows if f.entity.kind == "link"}

    def at(
        self, m: Namespace, known: Positions, state: Array, motion: GroupMotion | None = None
    ) -> Positions:
        """Known positions with those of a state, moved a little, over any algebra."""
        at, space, column = known.copy(), self.numbers.space, 0
        for name in self.group.points:
            size = len(space.axes)
            place = tuple(state[:, column + k] for k in range(size))
            column += size
            at.points[name] = (
                place if motion is None else space.moved_point(m, place, motion.shifts[Entity("point", name)])
            )
        for name in self.group.links:
            parts = []
            for part in space.at_rest:
                parts.append(tuple(state[:, column + k] for k in range(len(part))))
                column += len(part)
            pose = type(space.at_rest)(*parts)
            at.poses[name] = (
                pose if motion is None else space.moved_pose(m, pose, motion.shifts[Entity("link", name)])
            )
        for k, (name, turn) in enumerate(self._turns.items()):
            angle = state[:, column + k]
            at.angles[name] = angle if motion is None else motion.free[turn] + angle
        return at

    def numbers_of(self, at: Positions) -> list[Number]:
        """The numbers of a state, over any algebra."""
        numbers = [x for name in self.group.points for x in at.points[name]]
        numbers += [x for name in self.group.links for part in at.poses[name] for x in part]
        return numbers + [at.angles[name] for name in self._turns]

    def weights(self) -> Array:
        """Weights (k, width) that make the numbers of a state comparable: lengths count in the greatest length."""
        length = 1.0 / self.numbers.scale
        weights = [length for _name in self.group.points for _axis in self.numbers.space.axes]
        rest = self.numbers.space.at_rest
        parts = [length if name == "origin" else 1.0 for name, part in rest._asdict().items() for _x in part]
        return self.stack([*weights, *parts * len(self.group.links), *[1.0] * len(self._turns)])

    def state_of(self, at: Positions) -> Array:
        """The state in which positions are: (k, width)."""
        return self.stack(self.numbers_of(at))

    def move(self, state: Array, motion: GroupMotion) -> Array:
        """A state moved a little."""
        return self.normalise(self.state_of(self.at(ARRAYS, self.known, state, motion)))

    def normalise(self, state: Array) -> Array:
        """A state whose links keep their own distances, and whose angles are those of its links."""
        at, space = self.at(ARRAYS, self.known, state), self.numbers.space
        for name in self.group.points:
            at.points[name] = space.moved_point(ARRAYS, at.points[name], (0.0, 0.0))
        for name in self.group.links:
            at.poses[name] = space.normalise(ARRAYS, at.poses[name])
        for name in self._turns:
            near = at.angles[name]
            # measured from the angle before, so that turns stay counted
            at.angles[name] = near + space.turn(
                ARRAYS, at.poses[name], space.at_rest, rotor_of(ARRAYS, near), None
            )
        return self.state_of(at)

    def residual(self, m: Namespace, at: Positions) -> list[Number]:
        """Left sides of the equations."""
        residuals: dict[Constraint, list[Number]] = {}
        values = []
        for constraint, row in self.group.equations:
            if constraint not in residuals:
                residuals[constraint] = constraint.residual(m, self.numbers, at)
            values.append(residuals[constraint][row])
        return values

    def linear(self, at: Positions) -> Linear:
        """The equations made linear at positions."""
        return Linear(self.group, self.numbers, at, self.places)

    def gap(self, state: Array) -> Array:
        """Greatest left side of the equations, in rad or in the greatest length: (k,)."""
        values = self.residual(ARRAYS, self.at(ARRAYS, self.known, state))
        units = [1.0 if c.angular else 1.0 / self.numbers.scale for c, _row in self.group.equations]
        gaps = np.abs(self.stack([x * u for x, u in zip(values, units, strict=True)]))
        return np.asarray(np.max(gaps, axis=1), dtype=np.float64)

    def stack(self, values: Sequence[Number]) -> Array:
        """Numbers as an array (k, numbers)."""
        stacked = np.empty(
            (len(values), self.places), dtype=np.result_type(np.float64, *map(np.asarray, values))
        )
        for row, value in zip(stacked, values, strict=True):
            row[:] = value
        return stacked.T

    def jets(self, known: Positions, state: Array, linear: Linear, order: int) -> GroupMotion:
        """Taylor coefficients of the motion from a converged state, by the variable of the known jets."""
        zero = np.zeros(self.places)
        shifts = {f.entity: [[zero] for _ in range(f.entity.unknowns)] for f in linear.pattern.follows}
        free = [[zero] for _ in range(self.free)]
        # the matrix is the same for every order, so it is inverted once
        inverse = solve_places(linear.matrix, np.broadcast_to(np.eye(self.free), linear.matrix.shape))
        for k in range(1, order + 1):
            motion = _as_jets(shifts, free, k)
            below = known.map_numbers(lambda x, k=k: truncate_jet(x, k))  # type: ignore[misc]
            values = self.residual(JETS, self.at(JETS, below, state, motion))
            moved, rest = linear.reduce([_minus_coefficient(x, k) for x in values])
            freely = list(times(inverse, self.stack(rest)).T)
            for entity, shift in linear.whole(moved, freely).items():
                for c, x in zip(shifts[entity], shift, strict=True):
                    c.append(x)
            for c, x in zip(free, freely, strict=True):
                c.append(x)
        return _as_jets(shifts, free, order)

    def bounds(self, known: Positions, state: Array, linear: Linear) -> GroupMotion:
        """The motion zero with the bound of the state's rounding error."""
        values = [Rounded.of(x) for x in self.residual(ROUNDED, self.at(ROUNDED, known, state))]
        zero = np.zeros(self.places)
        # a converged state leaves a residual: that is part of the error as well
        moved, rest = linear.reduce([Rounded(zero, x.bound + np.abs(x.value)) for x in values])
        inverse = solve_places(linear.matrix, np.broadcast_to(np.eye(self.free), linear.matrix.shape))
        bound = times(np.abs(inverse), self.stack([Rounded.of(x).bound for x in rest]))
        free = [Rounded(zero, column) for column in bound.T]
        shifts = {
            entity: tuple(Rounded(zero, Rounded.of(x).bound) for x in shift)
            for entity, shift in linear.whole(moved, free).items()
        }
        return GroupMotion(shifts, free)


def _as_jets(
    shifts: Mapping[Entity, list[list[Number]]], free: list[list[Number]], order: int
) -> GroupMotion:
    def jet(c: list[Number]) -> Jet:
        return Jet([*c[: order + 1], *[0.0] * (order + 1 - len(c))])

    return GroupMotion({entity: tuple(map(jet, cs)) for entity, cs in shifts.items()}, [jet(c) for c in free])


def truncate_jet(x: Number, order: int) -> Number:
    """A jet without what is beyond an order."""
    return Jet(x.coefficients[: order + 1]) if isinstance(x, Jet) else x


def _minus_coefficient(x: Number, k: int) -> Number:
    return -x.coefficients[k] if isinstance(x, Jet) else 0.0


def total(columns: Array) -> Array:
    """Sum over the second axis, added up in one order whatever the number of places."""
    return np.asarray(np.add.reduce(np.ascontiguousarray(columns), axis=1))


def times(matrix: Array, vector: Array) -> Array:
    """Product at every place, added up in one order whatever the number of places."""
    total = np.zeros(vector.shape, dtype=np.result_type(matrix, vector))
    for j in range(vector.shape[1]):
        total += matrix[:, :, j] * vector[:, j : j + 1]
    return total


# A group of higher class by its free coordinates alone: everything else follows, link by link, from what is
# known.
#
# A link that hangs on a point that is known is given by its rotor; its points follow, and from these the links
# that hang on them. So the equations that `reduction` eliminates hold by construction, and only those left
# over are solved. In the plane.


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
class LinkChain:
    """A group with its dimensions, over any algebra; free lengths are measured in `unit` [m]."""

    group: Newton
    numbers: Dimensions
    unit: float

    @property
    def pattern(self) -> Pattern:
        """Order in which unknowns follow from free coordinates."""
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
        leaves = []
        for number, (c, row) in enumerate(self.kept):
            if row or not isinstance(c, PointInLink) or c.link not in follows or (c, 1) not in self.kept:
                # of two rows of the point both have to be left over, and the link one that follows from a
                # hinge
                continue
            # the link is spoken of by its hinge and by this constraint, and by nothing else
            if sum(body.kind == "link" and body.name == c.link for body in spoken) == 2:
                leaves.append(Leaf(c, follows[c.link].turn, (number, self.kept.index((c, 1)))))
        # by the hinge and by the point it has to reach: two constraints speak of it
        return tuple(leaves)

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
        at = known.copy()
        for follow in self.pattern.follows:
            name = follow.entity.name
            if follow.entity.kind == "link":
                turn = motion[follow.turn]
                at.poses[name] = self._pose(follow, posture, motion, at)
                at.angles[name] = posture.angles[name] + turn if _moves(turn) else posture.angles[name]
            elif follow.by is None:
                at.points[name] = self._shift_of(follow, posture, motion)
            else:
                at.points[name] = place(at.poses[follow.by.link], self.numbers.local[follow.by.link][name])
        return at

    def _pose(self, follow: Follow, posture: Posture, motion: Sequence[Number], at: Positions) -> PlanePose:
        turn, rotor = motion[follow.turn], posture.rotors[follow.entity.name]
        if _moves(turn):
            rotor = rotate_vector(rotor, _rotor_of_zero(turn))
        there = self._shift_of(follow, posture, motion) if follow.by is None else at.points[follow.by.point]
        return pose_with_point(self._pivot(follow), there, rotor)

    def _shift_of(self, follow: Follow, posture: Posture, motion: Sequence[Number]) -> Vector:
        x, y = posture.places[follow.entity.name]
        by_x, by_y = motion[follow.first : follow.first + 2]
        return (
            x + self.unit * by_x if _moves(by_x) else x,
            y + self.unit * by_y if _moves(by_y) else y,
        )

    def _pivot(self, follow: Follow) -> Vector:
        """Point about which a link turns, in its axes [m]."""
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
        arms = []
        for leaf in self.leaves:
            x, y = rotate_vector(self.arm(leaf), posture.rotors[leaf.constraint.link])
            arms.append((x * over, y * over))
        return arms

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


# (cos, sin) of r t + b t^2 up to second order
def _rotor_of_zero(turn: Jet) -> Vector:
    """Rotor of a jet of first or second order whose value is zero."""
    rate = turn.coefficients[1]
    bend = turn.coefficients[2:]
    return Jet((1.0, 0.0, *(-0.5 * (rate * rate) for _x in bend))), Jet((0.0, rate, *bend))


# What a group of higher class is solved in: the part of the plan before it, at any parameters.

Lanes: TypeAlias = npt.NDArray[np.intp]


@dataclass(frozen=True)
class Surroundings:
    """The plan up to a group of higher class; `hooks` runs it at parameters, one lane for each."""

    kinematics: Kinematics
    group: int
    hooks: Callable[[Namespace, Array, Lanes], EvaluationPolicy]

    @property
    def unit(self) -> float:
        """Change of the parameter that counts as large."""
        return self.kinematics.path.unit

    @property
    def equations(self) -> Newton:
        """The group itself."""
        return cast(Newton, self.kinematics.structure.groups[self.group])

    def known(self, parameter: Jet, lanes: Lanes) -> Positions:
        """Positions that the group's equations need of the plan before it, at a parameter given as a jet."""
        used = self.kinematics.take(lanes)
        hooks = self.hooks(JETS, parameter.value, lanes)
        with np.errstate(all="ignore"):
            at = used.frame(JETS, parameter)
            used.advance(at, range(self.group), JETS, hooks)
        return needed_positions(self.equations, at)

    def known_at(self, parameter: Array, lanes: Lanes) -> Positions:
        """Positions that the group's equations need, at plain parameters (k,)."""
        return needed_positions(self.equations, self.before(parameter, lanes))

    def before(self, parameter: Array, lanes: Lanes) -> Positions:
        """Positions of the plan before the group, at plain parameters (k,)."""
        used = self.kinematics.take(lanes)
        with np.errstate(all="ignore"):
            at = used.frame(ARRAYS, parameter)
            used.advance(at, range(self.group), ARRAYS, self.hooks(ARRAYS, parameter, lanes))
        return at

    def with_bounds(self, parameter: Array, lanes: Lanes) -> Positions:
        """Positions that the group's equations need, with bounds of their rounding errors, at parameters (k,)."""
        used = self.kinematics.take(lanes)
        with np.errstate(all="ignore"):
            at = used.frame(ROUNDED, Rounded.of(parameter))
            used.advance(at, range(self.group), ROUNDED, self.hooks(ROUNDED, parameter, lanes))
        return needed_positions(self.equations, at)

    def blank(self, lanes: Lanes) -> GroupSystem:
        """The group's equations beside nothing: for what needs the state alone."""
        return GroupSystem(
            self.equations, self.kinematics.take(lanes).numbers, Positions({}, {}, {}, {}), len(lanes)
        )

    def normalise(self, state: Array, lanes: Lanes) -> Array:
        """States whose links keep their own distances; as they are where loops take angles and places from them."""
        return state if self._one_plane_mechanism else self.blank(lanes).normalise(state)

    def loops(self, known: Positions) -> LoopClosure | None:
        """The group's equations by loops beside what is known; None on the sphere, and for a batch."""
        if self._one_plane_mechanism and not self._loops:
            self._loops.append(LoopClosure(self.equations, self.kinematics.numbers, known))
        return self._loops[0] if self._loops else None

    def loops_at(self, parameter: Array, lanes: Lanes) -> LoopClosure | None:
        """The same beside what is known at parameters (k,)."""
        if not self._one_plane_mechanism:
            return None
        return self._loops[0] if self._loops else self.loops(self.known_at(parameter, lanes))

    @cached_property
    def _one_plane_mechanism(self) -> bool:
        numbers = self.kinematics.numbers
        return numbers.space is PLANE and numbers.alone

    @cached_property
    def _loops(self) -> list[LoopClosure]:
        return []

    def with_numbers(self, numbers: Dimensions, lanes: Lanes) -> Surroundings:
        """The plan up to the group with other dimensions of some mechanisms, numbered from 0 in this selection."""

        def hooks(m: Namespace, parameter: Array, which: Lanes) -> EvaluationPolicy:
            return self.hooks(m, parameter, lanes[which])

        return replace(self, kinematics=replace(self.kinematics, numbers=numbers), hooks=hooks)

    def system(self, known: Positions, lanes: Lanes) -> GroupSystem:
        """The group's equations beside known positions, one lane for each place."""
        known = known.map_numbers(plain)
        numbers = self.kinematics.take(lanes).numbers
        return GroupSystem(self.equations, numbers, known, len(lanes), self.loops(known))


def needed_positions(group: Newton, at: Positions) -> Positions:
    """The points and links of which the equations of a group speak."""
    bodies = _bodies_of(group)
    return Positions(
        {name: place for name, place in at.points.items() if name in bodies},
        {name: pose for name, pose in at.poses.items() if name in bodies},
        at.drives,
        {name: angle for name, angle in at.angles.items() if name in bodies},
    )


@lru_cache(maxsize=256)
def _bodies_of(group: Newton) -> frozenset[str]:
    return frozenset(body.name for constraint, _row in group.equations for body in constraint.bodies)


def plain(number: Number) -> Number:
    """The value of a number of any algebra."""
    return number.value if isinstance(number, Jet | Rounded) else number


def within(function: Callable[[Number], Number]) -> Callable[[Number], Number]:
    """A function of plain numbers made one of jets and bounded numbers, part by part."""

    def apply(x: Number) -> Number:
        if isinstance(x, Jet):
            return Jet([apply(c) for c in x.coefficients])
        if isinstance(x, Rounded):
            return Rounded(apply(x.value), apply(x.bound))
        return function(x)

    return apply


def flatten_positions(at: Positions, shape: tuple[int, ...]) -> Positions:
    """Positions with every array spread over the shape and laid out in one row; floats stay."""

    def flat(x: Number) -> Number:
        return x if np.ndim(x) == 0 else np.broadcast_to(x, shape).reshape(-1)

    return at.map_numbers(within(flat))


def add_in_shape(at: Positions, names: Newton, shape: tuple[int, ...], into: Positions) -> None:
    """Add the group's points and links, laid out in one row, to positions of a shape."""

    def fold(x: Number) -> Number:
        return np.reshape(x, shape) if np.ndim(x) else x

    folded = at.map_numbers(within(fold))
    for name in names.points:
        into.points[name] = folded.points[name]
    for name in names.links:
        into.poses[name] = folded.poses[name]
        if name in folded.angles:
            into.angles[name] = folded.angles[name]
