"""What the equations of kinetostatics are solved for: one unknown for each scalar constraint.

Unknowns are the multipliers of J' lambda = -Q: the force of a constraint is its multiplier times its row. A
pin has no mass, so a link of each pin, its host, bears whatever else acts on the pin: the force between pin and
host is left to the pin's own balance, and three equations a link remain. The host's own two rows are the axes
of that balance, along the sphere as in the plane.
"""

from __future__ import annotations

import functools
import operator
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import accumulate
from typing import Any, NamedTuple, Protocol, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.load_coordinates import place_of
from centrode.dynamics.state import State
from centrode.dynamics.wrenches import NOWHERE, Resultant, Vector, Wrench, couple, on_frame, on_link, on_point
from centrode.geometry import sphere as space
from centrode.geometry.plane import dot as plane_dot
from centrode.geometry.plane import subtract as plane_subtract
from centrode.geometry.sphere import (
    Attitude,
    add,
    basis,
    cross,
    dot,
    linear_combination,
    subtract,
    times,
    unit,
)
from centrode.model.mechanism import Gear, Mechanism
from centrode.numerics.arrays import ARRAYS
from centrode.structure.constraints import (
    FRAME,
    Constraint,
    DisplacementDrive,
    Entity,
    GearRatio,
    NoSlip,
    PointInLink,
    PointOnGuide,
    Positions,
    Row,
    TrackContact,
)
from centrode.structure.dimensions import Dimensions
from centrode.structure.plan import Structure
from centrode.structure.rank import in_order, match, strong_components

Unknown: TypeAlias = tuple[Constraint, int]
"""One scalar equation: a constraint and its row there."""
Mask: TypeAlias = npt.NDArray[np.bool_]
Axis: TypeAlias = tuple[str, int]
"""A point and one of its two coordinates."""


@dataclass(frozen=True)
class Scheme:
    """Unknowns and equations of one structure.

    Attributes
    ----------
    solved : as many unknowns as there are equations
    hosts : (point, axis) -> unknown that follows from the pin's balance
    loose : (point, axis) of points without a link to bear them: they keep their own equations
    repeating : unknowns of the equations that repeat others; nothing tells how great they are
    bodies : links and points without one, in the order of their equations
    """

    structure: Structure
    solved: tuple[Unknown, ...]
    hosts: Mapping[Axis, Unknown]
    loose: tuple[Axis, ...]
    repeating: tuple[Unknown, ...]
    bodies: tuple[Entity, ...]

    @classmethod
    def of(cls, structure: Structure) -> Scheme:
        """The scheme of a structure."""
        left_out = set(structure.repeating)
        kept = [
            (constraint, row)
            for constraint in structure.constraints
            for row in range(constraint.size)
            if (constraint, row) not in left_out
        ]
        points = [entity.name for entity in structure.unknowns if entity.kind == "point"]
        hosts = _hosts(points, kept)
        taken = set(hosts.values())
        loose = tuple((point, axis) for point in points for axis in range(2) if (point, axis) not in hosts)
        solved = tuple(unknown for unknown in kept if unknown not in taken)
        bodies = [Entity("link", link) for link in structure.mechanism.links]
        bodies += [Entity("point", point) for point in dict.fromkeys(point for point, _axis in loose)]
        return cls(structure, solved, hosts, loose, structure.repeating, tuple(bodies))

    @property
    def unknowns(self) -> tuple[Unknown, ...]:
        """Unknowns of the linear system, those of repeating equations behind the others."""
        return (*self.solved, *self.repeating)

    @property
    def size(self) -> int:
        """Number of equations."""
        return sum(map(_equations_of, self.bodies))

    @cached_property
    def first_rows(self) -> dict[Entity, int]:
        """Row of the first equation of a body: three of a link, two forces and a moment, two of a point."""
        counts = [0, *(_equations_of(body) for body in self.bodies)]
        return dict(zip(self.bodies, accumulate(counts), strict=False))


def _equations_of(body: Entity) -> int:
    return 3 if body.kind == "link" else 2


def _hosts(points: list[str], kept: list[Unknown]) -> dict[Axis, Unknown]:
    """The unknowns that bear each pin: both rows of the first link that has both."""
    hosts: dict[Axis, Unknown] = {}
    whole = set(kept)
    for constraint, row in kept:
        # a host bears both components of a pin, so both its rows have to be there
        if (
            isinstance(constraint, PointInLink)
            and constraint.point in points
            and (constraint, 1 - row) in whole
        ):
            hosts.setdefault((constraint.point, row), (constraint, row))
    # the first link in the order of the constraints: a host is a choice, and has to be the same every time
    return hosts


# How forces act on bodies: three equations a link and two a pin, in the plane and on the sphere.

Number: TypeAlias = Any
MomentCentre: TypeAlias = tuple[Any, ...]
"""The place of a link's first point, on the sphere with two directions square to it."""


@dataclass(frozen=True)
class Pressing:
    """A force taken off a pin and given to what bears it: a link, or the frame by way of the centre."""

    point: str
    bearer: str
    force: Vector
    at: Vector

    @property
    def pulls(self) -> tuple[Wrench, ...]:
        """The force as wrenches on the pin and on what bears it."""
        # the frame has no equations, so any place will do; through the centre the force turns nothing
        at = NOWHERE if self.bearer == FRAME else self.at
        return on_point(self.point, tuple(-x for x in self.force), self.at), on_link(
            self.bearer, self.force, at
        )


class Equilibrium(Protocol):
    """Operations of a space that the equations of equilibrium need."""

    @property
    def origin(self) -> Vector:
        """The origin of the frame's axes, as a place."""

    def scale(self, numbers: Dimensions) -> float:
        """Greatest length of the mechanism [m], by which moments are measured."""

    def positions(self, state: State, numbers: Dimensions) -> Positions:
        """Plain positions of a state, to evaluate constraints on."""

    def by_moment(self, constraint: Constraint) -> bool:
        """Whether the multipliers of a constraint are moments; else they are forces."""

    def of_row(self, constraint: Constraint, row: Row, at: Positions, link: str | None) -> tuple[Wrench, ...]:
        """Forces and moments of a constraint's row at a multiplier of one; `link` bears what acts on its point."""

    def foot(self, first: Vector) -> MomentCentre:
        """Place and directions of the moment equations of a link whose first point has this place."""

    def on_link(self, pull: Wrench, foot: MomentCentre, scale: float) -> tuple[Number, Number, Number]:
        """Contribution of a wrench to the three equations of its link [N]."""

    def pin_axes(self, place: Vector) -> Sequence[Vector]:
        """Two directions in which a pin at a place must be in equilibrium."""

    def pressing(self, outer: Iterable[Wrench], mechanism: Mechanism, at: Positions) -> tuple[Pressing, ...]:
        """Parts of loads on moving pins that press the pin against a link, as the space does not let it yield."""

    def centre(self, pulls: Iterable[Wrench], mechanism: Mechanism) -> tuple[Wrench, ...]:
        """Wrenches of the centre of the space for each link, which bear what `pulls` leave; two a link.

        The first acts on the link, the second on the frame.
        """


class InPlane:
    """Two forces and a moment about its first point for a link; a pin is in equilibrium along x and y."""

    origin = (0.0, 0.0)

    def scale(self, numbers: Dimensions) -> float:
        return float(numbers.scale)

    def positions(self, state: State, numbers: Dimensions) -> Positions:
        mechanism, space = state.mechanism, numbers.space
        points = {name: place_of(state.point(name)) for name in mechanism.points}
        poses = {FRAME: space.at_rest}
        for link, inside in numbers.local.items():
            point, local = next(iter(inside.items()))
            poses[link] = space.pose_of(state.m.base, place_of(state.rotor(link)), local, points[point])
        return Positions(dict(points), poses, {})

    def by_moment(self, constraint: Constraint) -> bool:
        return constraint.angular

    def of_row(self, constraint: Constraint, row: Row, at: Positions, link: str | None) -> tuple[Wrench, ...]:
        wrenches = []
        for entity, values in row.items():
            if entity.kind == "link":
                x, y, moment = values
                # moments of a row are by the turn about the origin of the link's axes, so there the force
                # acts
                wrenches.append(Wrench(entity, (x, y), at.poses[entity.name].origin, moment))
                continue
            place = at.points[entity.name]
            wrenches.append(
                on_point(entity.name, values, place) if link is None else on_link(link, values, place)
            )
        return tuple(wrenches)

    def foot(self, first: Vector) -> MomentCentre:
        return (first,)

    def on_link(self, pull: Wrench, foot: MomentCentre, scale: float) -> tuple[Number, Number, Number]:
        return pull.force[0], pull.force[1], pull.moment_about(foot[0]) / scale

    def pin_axes(self, place: Vector) -> Sequence[Vector]:
        return (1.0, 0.0), (0.0, 1.0)

    def pressing(self, outer: Iterable[Wrench], mechanism: Mechanism, at: Positions) -> tuple[Pressing, ...]:
        return ()

    def centre(self, pulls: Iterable[Wrench], mechanism: Mechanism) -> tuple[Wrench, ...]:
        return ()


@dataclass(frozen=True)
class OnSphere:
    """Three moments about the centre of the sphere for a link; a pin is in equilibrium along the sphere.

    Links turn about the centre, so that it bears them: hinges bear what lies along the sphere, at its `radius` [m].
    Moments about the centre are taken along the direction of the link's first point, about that point, and square
    to it, where they are forces there times the radius: so small linkages keep their accuracy.
    """

    radius: float
    origin = NOWHERE

    def scale(self, numbers: Dimensions) -> float:
        return self.radius * float(numbers.scale)

    def positions(self, state: State, numbers: Dimensions) -> Positions:
        mechanism = state.mechanism
        # on the unit sphere: lengths come in with the radius where forces do
        points = {
            name: tuple(x / self.radius for x in place_of(state.point(name))) for name in mechanism.points
        }
        poses = {FRAME: numbers.space.at_rest}
        for link in mechanism.links:
            x, y, z = (place_of(axis) for axis in state.attitude(link))
            poses[link] = Attitude(x, y, z)
        return Positions(points, poses, {})

    def by_moment(self, constraint: Constraint) -> bool:
        # the value of a drive along a circle is an arc
        return constraint.angular or isinstance(constraint, DisplacementDrive)

    def of_row(self, constraint: Constraint, row: Row, at: Positions, link: str | None) -> tuple[Wrench, ...]:
        point = next((entity for entity in row if entity.kind == "point"), None)
        if point is None:
            return tuple(couple(entity.name, tuple(moment)) for entity, moment in row.items())
        place = at.points[point.name]
        # a multiplier that is a moment has its row by arcs: over the radius it is a force
        unit = 1.0 / self.radius if self.by_moment(constraint) else 1.0
        first, second = basis(ARRAYS, place)
        force = times(unit, linear_combination((row[point][0], first), (row[point][1], second)))
        there = times(self.radius, place)
        # what ties a point to a body pushes both, with opposite forces at one place
        others = [on_link(entity.name, times(-1.0, force), there) for entity in row if entity is not point]
        return on_point(point.name, force, there), *others

    def foot(self, first: Vector) -> MomentCentre:
        return first, *basis(ARRAYS, first)

    def on_link(self, pull: Wrench, foot: MomentCentre, scale: float) -> tuple[Number, Number, Number]:
        (up, one, other), force = foot, pull.force
        # moments over the radius are forces; about the link's own first point differences of places keep
        # their digits
        place = times(1.0 / self.radius, pull.at)
        turning, twist = cross(place, force), cross(subtract(place, up), force)
        if isinstance(pull.moment, tuple):
            moment = times(1.0 / self.radius, pull.moment)
            turning, twist = add(turning, moment), add(twist, moment)
        return dot(one, turning), dot(other, turning), dot(up, twist) * (self.radius / scale)

    def pin_axes(self, place: Vector) -> Sequence[Vector]:
        return basis(ARRAYS, place)

    def pressing(self, outer: Iterable[Wrench], mechanism: Mechanism, at: Positions) -> tuple[Pressing, ...]:
        """Parts of loads on moving pins that are square to the sphere.

        The only link of a pin bears it; with several links nothing tells which, so that the centre does.
        """
        pressings = []
        for pull in outer:
            name = pull.body.name
            if pull.body.kind == "point" and name in mechanism.moving_points:
                up = at.points[name]
                outwards = times(dot(pull.force, up), up)
                links = [link for link, body in mechanism.links.items() if name in body.coordinates]
                pressings.append(Pressing(name, links[0] if len(links) == 1 else FRAME, outwards, pull.at))
        return tuple(pressings)

    def centre(self, pulls: Iterable[Wrench], mechanism: Mechanism) -> tuple[Wrench, ...]:
        sums: dict[str, Vector] = dict.fromkeys(mechanism.links, NOWHERE)
        for pull in pulls:
            if pull.body.kind == "link" and pull.body.name in sums:
                sums[pull.body.name] = add(sums[pull.body.name], pull.force)
        wrenches: list[Wrench] = []
        for link, force in sums.items():
            wrenches += [on_link(link, tuple(-x for x in force), NOWHERE), on_link(FRAME, force, NOWHERE)]
        return tuple(wrenches)


def equilibrium_of(mechanism: Mechanism) -> Equilibrium:
    """That of the mechanism's space."""
    return OnSphere(mechanism.sphere_radius) if mechanism.space == "sphere" else InPlane()


# Where gears mesh: the pitch point, where it follows from the axes of both wheels.


@dataclass(frozen=True)
class Teeth:
    """Axes of gears: gear -> points about which its first and its second wheel turn in the carrier.

    A gear is in it if each wheel has exactly one point in common with the carrier, and the wheels do not turn
    alike. Its radii follow from the distance of the axes and the ratio.

    `radius` is that of the sphere [m], None in the plane.
    """

    axes: Mapping[str, tuple[str, str]]
    radius: float | None = None

    @classmethod
    def of(cls, mechanism: Mechanism) -> Teeth:
        """The gears of a mechanism whose pitch points follow."""
        teeth = {}
        for gear in mechanism.gears:
            first, second = (_common(mechanism, wheel, gear.carrier) for wheel in gear.links)
            # wheels that turn alike have no pitch point: it lies at infinity
            if len(first) == len(second) == 1 and first != second and gear.ratio != 1.0:
                teeth[gear.id] = (first[0], second[0])
        return cls(teeth, mechanism.sphere_radius if mechanism.space == "sphere" else None)

    def pulls(self, constraint: GearRatio, at: Positions, numbers: Dimensions) -> tuple[Wrench, ...]:
        """The force between the teeth, square to the line of centres, with a moment of one on the second wheel.

        Its radial part, which presses the wheels apart, is left out: nothing tells the pressure angle.
        """
        ratio = numbers.gearing.ratio[constraint.gear]
        first, second = (at.points[name] for name in self.axes[constraint.gear])
        if self.radius is not None:
            return _on_sphere(constraint, ratio, first, second, self.radius)
        # where both wheels have one velocity in the carrier: (p - a) w = (p - b) i w
        pitch = tuple((a - ratio * b) / (1.0 - ratio) for a, b in zip(first, second, strict=True))
        place = pitch[0], pitch[1]
        x, y = plane_subtract(place, second)
        # square to the line of centres, of moment 1 about the second wheel's axis
        square = plane_dot((x, y), (x, y))
        force = -y / square, x / square
        return (
            on_link(constraint.second, force, place),
            on_link(constraint.first, (-force[0], -force[1]), place),
        )

    def without(self, gears: tuple[Gear, ...]) -> tuple[str, ...]:
        """Gears whose tooth forces are not known: their moments are."""
        return tuple(gear.id for gear in gears if gear.id not in self.axes)


def _on_sphere(
    gear: GearRatio, ratio: float, first: Vector, second: Vector, radius: float
) -> tuple[Wrench, ...]:
    """Tooth force of bevel gears, whose pitch cones touch along the axis of their relative turning.

    Wheels that turn against each other mesh between their axes. Of others nothing tells on which side of the centre,
    and so which way the force points: then its moment about the centre alone is put on the wheels.
    """
    a, b = (first[0], first[1], first[2]), (second[0], second[1], second[2])
    # the axis of relative turning: w (a - i b) for angular velocities w and i w about a and b
    pitch = unit(ARRAYS, space.subtract(a, space.times(ratio, b)))
    along = space.cross(b, pitch)
    square = space.dot(along, along)
    if ratio < 0.0:
        force, place = space.times(1.0 / (radius * square), along), space.times(radius, pitch)
        return on_link(gear.second, force, place), on_link(gear.first, space.times(-1.0, force), place)
    moment = space.times(1.0 / square, space.cross(pitch, along))
    return couple(gear.second, moment), couple(gear.first, space.times(-1.0, moment))


def _common(mechanism: Mechanism, wheel: str, carrier: str) -> list[str]:
    """Points in which a wheel is hinged to its carrier."""

    def points(body: str) -> set[str]:
        return set(mechanism.frame.points if body == FRAME else mechanism.links[body].coordinates)

    return sorted(points(wheel) & points(carrier))


# What each constraint does to points and links: its row of the Jacobian as forces and moments of one unit.


def wrenches_of(
    constraint: Constraint,
    mechanism: Mechanism,
    numbers: Dimensions,
    at: Positions,
    teeth: Teeth,
    space: Equilibrium,
) -> list[tuple[Wrench, ...]]:
    """Forces and moments of each row of a constraint, at a multiplier of one.

    Rows act on points; where a guide has a slider of its own, and under a rolling wheel, the force is put on the
    slider or the wheel itself: the pin's share of it would be a mere name.
    """
    # the force between teeth is put where it acts; the row alone would be two moments
    if isinstance(constraint, GearRatio) and constraint.gear in teeth.axes:
        return [teeth.pulls(constraint, at, numbers)]
    link = _host_link(constraint, mechanism)
    return [space.of_row(constraint, row, at, link) for row in constraint.rows(numbers, at)]


def _host_link(constraint: Constraint, mechanism: Mechanism) -> str | None:
    """The link that takes what a constraint's row gives to a point; None where it is the pin itself."""
    if isinstance(constraint, (PointOnGuide, DisplacementDrive)):
        return mechanism.guide(constraint.guide).link
    return constraint.link if isinstance(constraint, (TrackContact, NoSlip)) else None


# Matrices inverted at many positions, with what rounding makes of each.

Array: TypeAlias = npt.NDArray[np.float64]
Matrix: TypeAlias = Mapping[tuple[int, int], Number]
"""(Equation, unknown) -> number at every position, of those that are not plainly zero."""
Rows: TypeAlias = Sequence[Sequence[Number]]
EPSILON = 2.0**-52


class EquationBlock(NamedTuple):
    """Equations that are solved together, once the unknowns before them are known.

    Attributes
    ----------
    rows, columns : the equations and their unknowns, as many
    before : of each equation the unknowns before that it speaks of
    """

    rows: tuple[int, ...]
    columns: tuple[int, ...]
    before: tuple[tuple[int, ...], ...]


# by the places alone: mechanisms of one structure have these in common
@functools.lru_cache(maxsize=64)
def blocks_of(size: int, places: frozenset[tuple[int, int]]) -> tuple[EquationBlock, ...]:
    """The least blocks of equations that matrices with numbers in these places come apart into.

    An Assur group hangs on others that it loads, and within a group most forces follow from one equation each: of a
    dyad two moments in two unknowns are left. All is one block where equations and unknowns do not match.
    """
    rows_of: dict[int, list[int]] = {column: [] for column in range(size)}
    columns_of: dict[int, list[int]] = {row: [] for row in range(size)}
    for row, column in sorted(places):
        rows_of[column].append(row)
        columns_of[row].append(column)
    owners = match(rows_of)
    if len(owners) < size:
        everything = tuple(range(size))
        return (EquationBlock(everything, everything, ((),) * size),)
    row_of = {column: row for row, column in owners.items()}
    needs = {column: columns_of[row_of[column]] for column in range(size)}
    blocks = []
    for columns in in_order(strong_components(needs), needs):
        before = [tuple(other for other in needs[column] if other not in columns) for column in columns]
        blocks.append(
            EquationBlock(tuple(row_of[column] for column in columns), tuple(columns), tuple(before))
        )
    return tuple(blocks)


@dataclass(frozen=True)
class Inverse:
    """Inverses of matrices of n equations in m unknowns, m at least n, at every position.

    Attributes
    ----------
    size, width : n and m
    of_blocks : inverse of each block of the first n unknowns
    condition : (...)
        Condition number; infinite where a matrix is singular, NaN where the matrix itself is not known.
    pseudo : positions (...) where the first unknowns do not do, and the inverses (k, m, n) of whole matrices there
    """

    matrix: Matrix
    size: int
    width: int
    blocks: tuple[EquationBlock, ...]
    of_blocks: Sequence[Rows]
    condition: Array
    pseudo: tuple[Mask, Array] | None = None

    def times(self, right: Sequence[Number]) -> Array:
        """Solutions (m, ...) for n right sides, with one step of refinement; NaN where there is none."""
        with np.errstate(invalid="ignore", over="ignore"):
            solution = self._solution(right)
            left = list(right)
            for (row, column), value in self.matrix.items():
                left[row] = left[row] - value * solution[column]
            # one step of refinement takes back what the inverse's own rounding left
            return solution + self._solution(left)

    def _solution(self, right: Sequence[Number]) -> Array:
        solution = np.zeros((self.width, *self.condition.shape))
        for block, of_block in zip(self.blocks, self.of_blocks, strict=True):
            left = []
            for row, before in zip(block.rows, block.before, strict=True):
                own = right[row]
                for column in before:
                    own = own - self.matrix[row, column] * solution[column]
                left.append(own)
            for column, factors in zip(block.columns, of_block, strict=True):
                solution[column] = _sum_of_products(factors, left)
        known = np.isfinite(self.condition)
        if not known.all():
            solution[:, ~known] = np.nan
        if self.pseudo is not None:
            lost, inverse = self.pseudo
            there = np.array([np.broadcast_to(x, lost.shape)[lost] for x in right])
            solution[:, lost] = (inverse @ there.T[..., None])[..., 0].T
        return solution

    @property
    def loss(self) -> Array:
        """Bound on the relative rounding error of a solution; from 1 on no digit is left.

        Positions are solved with the same equations, so they carry rounding multiplied by the condition number;
        the matrix moves with them, and what is solved with it is off by that, multiplied by the condition number
        once more: its square times the rounding of a sum over a row.
        """
        with np.errstate(over="ignore"):
            return np.asarray(self.condition**2 * (EPSILON * self.size))

    @property
    def useless(self) -> Mask:
        """Where rounding leaves no digit of a solution; not where nothing is known."""
        with np.errstate(invalid="ignore"):
            return np.asarray(self.loss >= 1.0)


def inverse_of(matrix: Matrix, size: int, width: int, shape: tuple[int, ...]) -> Inverse:
    """Inverses of matrices of so many equations and unknowns at positions (shape): of their first columns.

    Where these are singular the columns behind them may help: then it is the pseudo-inverse of the whole. Singular
    matrices and those with NaN are no error.
    """
    # more columns than equations: those of repeating constraints, used only where the others are singular
    square = {place: value for place, value in matrix.items() if place[1] < size}
    found = _inverse_of_square(square, size, shape)
    if width == size:
        return found
    found = replace(found, matrix=matrix, width=width)
    lost = found.useless
    if not lost.any():
        return found
    whole = np.zeros((np.count_nonzero(lost), size, width))
    for (row, column), value in matrix.items():
        whole[:, row, column] = np.broadcast_to(value, shape)[lost]
    inverse, found.condition[lost] = _pseudo(whole)
    return replace(found, pseudo=(lost, inverse))


def _inverse_of_square(matrix: Matrix, size: int, shape: tuple[int, ...]) -> Inverse:
    """Inverse of as many equations as unknowns, block by block, and its condition number."""
    blocks = blocks_of(size, frozenset(matrix))
    sizes: list[Number] = [0.0] * size
    for (row, _column), value in matrix.items():
        sizes[row] = sizes[row] + abs(value)
    norm = functools.reduce(np.maximum, sizes, np.zeros(shape))
    known = regular = np.isfinite(norm)
    # unknown -> right side -> number of the inverse that is not plainly zero
    inverse: dict[int, dict[int, Number]] = {}
    of_blocks: list[Rows] = []
    of_inverse = np.zeros(shape)
    with np.errstate(all="ignore"):
        for rows, columns, before in blocks:
            own = [[matrix.get((row, column), 0.0) for column in columns] for row in rows]
            of_block, of_full_rank = _inverse_of_block(own, known)
            of_blocks.append(of_block)
            regular = regular & of_full_rank
            # what each equation is once the unknowns before are put in: numbers that multiply the right sides
            left: list[dict[int, Number]] = []
            for row, others in zip(rows, before, strict=True):
                terms: dict[int, Number] = {row: 1.0}
                for other in others:
                    factor = matrix[row, other]
                    for side, value in inverse[other].items():
                        terms[side] = terms.get(side, 0.0) - factor * value
                left.append(terms)
            sides = list(dict.fromkeys(side for terms in left for side in terms))
            for column, factors in zip(columns, of_block, strict=True):
                inverse[column] = {
                    side: _sum_of_products(factors, [terms.get(side, 0.0) for terms in left])
                    for side in sides
                }
                of_row = functools.reduce(operator.add, map(abs, inverse[column].values()))
                of_inverse = np.maximum(of_inverse, of_row)
        # the norm of the greatest row sum: no singular values are needed for a bound
        product = norm * of_inverse
    # many nearly singular blocks one after the other: their inverses are beyond all numbers, and differ by none
    regular = regular & ~np.isnan(product)
    condition = np.where(regular, product, np.where(known, np.inf, np.nan))
    return Inverse(matrix, size, size, blocks, of_blocks, condition)


def _sum_of_products(factors: Sequence[Number], numbers: Sequence[Number]) -> Number:
    return functools.reduce(operator.add, map(operator.mul, factors, numbers))


def _inverse_of_block(matrix: Rows, known: Mask) -> tuple[Rows, Mask]:
    """Inverses of matrices that are not to be taken apart, and which of them are regular."""
    if len(matrix) == 1:
        pivot = np.asarray(matrix[0][0])
        return [[1.0 / pivot]], pivot != 0.0
    if len(matrix) == 2:
        # what dyads leave, in a tenth of the time of a general inverse
        (a, b), (c, d) = matrix
        determinant = np.asarray(a * d - b * c)
        return [[d / determinant, -b / determinant], [-c / determinant, a / determinant]], determinant != 0.0
    size = len(matrix)
    stacked = np.empty((*known.shape, size, size))
    for row, numbers in enumerate(matrix):
        for column, number in enumerate(numbers):
            stacked[..., row, column] = number
    stacked = _where(known, stacked)
    regular = known
    try:
        inverse = np.linalg.inv(stacked)
    except np.linalg.LinAlgError:
        # a pivot is exactly zero somewhere: there the determinant has no sign
        regular = known & (np.linalg.slogdet(stacked)[0] != 0.0)
        inverse = np.linalg.inv(_where(regular, stacked))
    # numbers of neighbouring positions side by side, as everywhere else
    return list(np.ascontiguousarray(np.moveaxis(inverse, (-2, -1), (0, 1)))), regular


# an identity in the place of what has no inverse keeps the rest of the stack going
def _where(regular: Mask, matrix: Array) -> Array:
    return matrix if regular.all() else np.where(regular[..., None, None], matrix, np.eye(matrix.shape[-1]))


def _pseudo(matrix: Array) -> tuple[Array, Array]:
    """Pseudo-inverses (k, m, n) and condition numbers of matrices (k, n, m) that are known."""
    left, values, right = np.linalg.svd(matrix, full_matrices=False)
    with np.errstate(divide="ignore", invalid="ignore"):
        # of singular values that are zero the quotient is infinite, and so is the condition number
        condition = values[:, 0] / values[:, -1]
        inverse = np.swapaxes(right, 1, 2) @ (np.swapaxes(left, 1, 2) / values[..., None])
    return inverse, condition


# The equations of kinetostatics at many positions: built once, solved for any forces that act.


@dataclass(frozen=True)
class ForceSystem:
    """Solution of the equations for some outer forces.

    Attributes
    ----------
    multipliers : unknown -> its value at every position [N or N m]
    outer : the forces that acted
    """

    system: Kinetostatics
    multipliers: Mapping[Unknown, Number]
    outer: tuple[Wrench, ...]

    def pulls(self, unknown: Unknown) -> list[Wrench]:
        """Forces and moments of one scalar constraint on all it ties together."""
        return self._wrenches_by_unknown[unknown]

    @cached_property
    def _wrenches_by_unknown(self) -> dict[Unknown, list[Wrench]]:
        pulls = self.system.pulls
        return {
            unknown: [pull.times(value) for pull in pulls[unknown]]
            for unknown, value in self.multipliers.items()
        }

    @cached_property
    def pressing(self) -> tuple[Pressing, ...]:
        """Parts of loads on pins that are square to a sphere."""
        mechanism = self.system.scheme.structure.mechanism
        return self.system.equilibrium.pressing(self.outer, mechanism, self.system.at)

    @cached_property
    def acting(self) -> tuple[Wrench, ...]:
        """Wrenches on all bodies but those of the centre of a sphere."""
        tied = [pull for pulls in self._wrenches_by_unknown.values() for pull in pulls]
        return (*tied, *self.outer, *(pull for joint in self.pressing for pull in joint.pulls))

    @cached_property
    def centre(self) -> tuple[Wrench, ...]:
        """Wrenches of the centre of a sphere on each link, and the opposite ones on the frame."""
        return self.system.equilibrium.centre(self.acting, self.system.scheme.structure.mechanism)

    @cached_property
    def all_wrenches(self) -> tuple[Wrench, ...]:
        """Wrenches on all bodies."""
        return (*self.acting, *self.centre)

    @cached_property
    def on_frame(self) -> list[Wrench]:
        """Wrenches on the frame and its points."""
        fixed = self.system.scheme.structure.mechanism.frame.points
        return [pull for pull in self.all_wrenches if on_frame(pull.body, fixed)]

    @cached_property
    def frame_resultant(self) -> Resultant:
        """What acts on the frame, about the origin."""
        return Resultant.of(self.on_frame, self.system.equilibrium.origin)


@dataclass(frozen=True)
class Kinetostatics:
    """J' lambda = -Q at the positions of a state (one mechanism): any Q, without building J again.

    Attributes
    ----------
    scheme : what is solved for
    numbers : the mechanism's dimensions
    teeth : where gears mesh
    equilibrium : what the space makes of forces
    scale : the mechanism's greatest length [m], by which moments are measured
    at : plain positions
    pulls : unknown -> forces and moments of its row, at a multiplier of one
    shape : of every array, (1, n)
    """

    scheme: Scheme
    numbers: Dimensions
    teeth: Teeth
    equilibrium: Equilibrium
    scale: float
    at: Positions
    pulls: Mapping[Unknown, tuple[Wrench, ...]]
    shape: tuple[int, ...]

    @classmethod
    def of(cls, scheme: Scheme, numbers: Dimensions, state: State, teeth: Teeth) -> Kinetostatics:
        """The equations at the positions of a state."""
        space = equilibrium_of(state.mechanism)
        at = space.positions(state, numbers)
        pulls: dict[Unknown, tuple[Wrench, ...]] = {}
        with np.errstate(all="ignore"):
            for constraint in scheme.structure.constraints:
                wrenches = wrenches_of(constraint, state.mechanism, numbers, at, teeth, space)
                pulls |= {(constraint, row): each for row, each in enumerate(wrenches)}
        shape = (1, len(state.parameter))
        return cls(scheme, numbers, teeth, space, space.scale(numbers), at, pulls, shape)

    @cached_property
    def inverse(self) -> Inverse:
        """The matrix of the equations, inverted at every position."""
        return inverse_of(self.matrix(), self.scheme.size, len(self.scheme.unknowns), self.shape)

    def matrix(self) -> Matrix:
        """The matrix of the equations."""
        matrix: dict[tuple[int, int], Number] = {}
        for column, unknown in enumerate(self.scheme.unknowns):
            # forces and moments over the greatest length are of one size, so that the condition number means
            # something
            scale = self.scale if self.equilibrium.by_moment(unknown[0]) else None
            for row, value in self._sums(self.pulls[unknown]).items():
                matrix[row, column] = value if scale is None else value * scale
        return matrix

    def right_side(self, outer: Iterable[Wrench]) -> list[Number]:
        """Forces and moments [N] on the links, for each equation."""
        sums = self._sums(outer)
        return [sums.get(row, 0.0) for row in range(self.scheme.size)]

    def forces(self, outer: Sequence[Wrench]) -> ForceSystem:
        """Constraint forces that balance what acts on points and links.

        Equations that repeat others bear nothing, except where the others alone are singular: there all together bear
        the least. What nothing determines is one of the many forces that are possible.
        """
        solved = self.inverse.times([-x for x in self.right_side(outer)])
        multipliers: dict[Unknown, Number] = {}
        for row, unknown in enumerate(self.scheme.unknowns):
            turns = self.equilibrium.by_moment(unknown[0])
            multipliers[unknown] = solved[row] * self.scale if turns else solved[row]
        multipliers |= self.at_hosts(multipliers, outer, np.zeros(self.shape))
        return ForceSystem(self, multipliers, tuple(outer))

    def at_hosts(
        self, multipliers: Mapping[Unknown, Number], outer: Sequence[Wrench], nothing: Number
    ) -> dict[Unknown, Number]:
        """Force of each pin on its host: the rest of what acts on the pin, sums beginning with `nothing`."""
        sums: dict[Axis, Number] = dict.fromkeys(self.scheme.hosts, nothing)
        acting = [(pull, value) for unknown, value in multipliers.items() for pull in self.pulls[unknown]]
        # only pins are summed: what acts on links is in their own equations
        for pull, value in [*acting, *((pull, 1.0) for pull in outer)]:
            if pull.body.kind == "point":
                for axis in range(2):
                    place = pull.body.name, axis
                    along = _along(pull.force, self._host_axis(place)) if place in sums else 0.0
                    if not _is_zero(along):
                        sums[place] = sums[place] + along * value
        # what is missing to the pin's equilibrium is what its host bears
        return {unknown: -sums[place] for place, unknown in self.scheme.hosts.items()}

    def _host_axis(self, place: Axis) -> Vector:
        """Direction in which a pin's host bears it: that of its row, a unit vector square to that of its other row."""
        pulls = self.pulls[self.scheme.hosts[place]]
        return next(pull.force for pull in pulls if pull.body.kind == "point")

    def _sums(self, pulls: Iterable[Wrench]) -> dict[int, Number]:
        """What pulls do to each equation that they are in; the frame has none."""
        sums: dict[int, Number] = {}
        for pull in pulls:
            for row, value in self.entries(pull):
                if not _is_zero(value):
                    sums[row] = sums[row] + value if row in sums else value
        return sums

    def entries(self, pull: Wrench) -> list[tuple[int, Number]]:
        """Equations that a wrench is in, each with what it adds there."""
        name, scheme = pull.body.name, self.scheme
        if pull.body.kind == "link":
            return self._on_link(name, pull) if pull.body in scheme.first_rows else []
        # what acts on a pin with a host is put on the host's equations, at the pin's place
        if (name, 0) in scheme.hosts:
            return self._on_link(scheme.hosts[name, 0][0].link, pull)  # type: ignore[attr-defined]
        row = scheme.first_rows.get(pull.body)
        if row is None:
            # pins of the frame have no equations
            return []
        return [(row + k, _along(pull.force, axis)) for k, axis in enumerate(self._pin_axes(name))]

    def _pin_axes(self, point: str) -> Sequence[Vector]:
        return self.equilibrium.pin_axes(self.at.points[point])

    def _on_link(self, link: str, pull: Wrench) -> list[tuple[int, Number]]:
        row = self.scheme.first_rows[Entity("link", link)]
        return [(row + k, value) for k, value in enumerate(self.on_link(link, pull))]

    def on_link(self, link: str, pull: Wrench) -> tuple[Number, Number, Number]:
        """Contribution of a wrench to the three equations of its link [N], moments over the greatest length."""
        return self.equilibrium.on_link(pull, self._moment_centres[link], self.scale)

    @cached_property
    def _moment_centres(self) -> dict[str, MomentCentre]:
        links = self.scheme.structure.mechanism.links
        firsts = {name: next(iter(link.coordinates)) for name, link in links.items()}
        return {name: self.equilibrium.foot(self.at.points[first]) for name, first in firsts.items()}


def _along(force: Vector, axis: Vector) -> Number:
    """Component of a force; a component that is plainly zero costs nothing."""
    summed: Number = 0.0
    for x, u in zip(force, axis, strict=True):
        if not _is_zero(x) and not _is_zero(u):
            summed = summed + (x if isinstance(u, float) and u == 1.0 else x * u)
    return summed


def _is_zero(value: Number) -> bool:
    return isinstance(value, float) and value == 0.0
