"""The equations of a plane group of one mechanism by its loops: numbers beside a few constant matrices.

A link that hangs on something known is told by its angle; where its points are is linear in the cosines and sines
of angles, in the places of what hangs on nothing, and in what is known. So all hinges of a group are constant
matrices times these numbers, at every place and for every coefficient of a power series. Only moving guides,
cylinders, gears and drives between its links are evaluated one by one (Wampler, Solving the kinematics of planar
mechanisms, J. Mech. Des. 121, 1999, has the same form in complex numbers).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.geometry.plane import PlanePose
from centrode.kinematics.higher_class.elimination import Follow, pattern_of
from centrode.kinematics.path import JETS
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.jets import Jet
from centrode.numerics.rounding_bounds import Rounded
from centrode.structure.constraints import FRAME, Constraint, Entity, PointInLink, PointOnGuide, Positions
from centrode.structure.dimensions import Dimensions
from centrode.structure.groups import Newton

Array: TypeAlias = npt.NDArray[np.float64]
Number: TypeAlias = Any
TURN = 2.0 * np.pi
Vectors: TypeAlias = tuple[Array, Array]
"""The two coordinates of a vector, each as the factors (n,) of the numbers in which it is linear."""


@dataclass(frozen=True)
class OtherRow:
    """An equation left over that is no hinge: its constraint, the row of it, its place, and its unit."""

    constraint: Constraint
    row: int
    number: int
    unit: float


class LoopClosure:
    """The equations of a group whose dimensions are plain numbers, beside what is known of the plan before it.

    Free coordinates are angles of links [rad], and places in the greatest length. `numbers` of a place (k, n) are
    cosines and sines of the free coordinates, these themselves, and what is known; arrays of several orders have the
    coefficients of power series first, that of order zero first.
    """

    def __init__(self, group: Newton, dimensions: Dimensions, known: Positions) -> None:
        self.group, self.dimensions = group, dimensions
        self.pattern = pattern_of(group)
        self.free = self.pattern.free
        # in the order of the equations, which decides in which order sums are added up
        bodies = dict.fromkeys(body for constraint, _row in group.equations for body in constraint.bodies)
        self.points = tuple(b.name for b in bodies if b.kind == "point" and b.name not in group.points)
        self.links = tuple(b.name for b in bodies if b.kind == "link" and b.name not in group.links)
        self.drives = tuple(known.drives)
        self.angles = tuple(name for name in self.links if name in known.angles)
        self.coordinates = slice(2 * self.free, 3 * self.free)
        """Where among the numbers the free coordinates themselves stand, angles with their turns."""
        self.first_known = 3 * self.free
        counts = (2 * len(self.points), 4 * len(self.links), len(self.drives), len(self.angles))
        self.width = self.first_known + sum(counts)
        self._units = np.eye(self.width)
        self._origins: dict[str, Vectors] = {}
        self._rotors: dict[str, Vectors] = {}
        self._places: dict[str, Vectors] = {}
        self._turns: dict[str, Array] = {}
        self._known_forms()
        for follow in self.pattern.follows:
            self._follow(follow)
        self._state_forms()
        self._closing_forms()

    # the numbers in which everything is linear

    def _known_forms(self) -> None:
        column = iter(self._units[self.first_known :])
        for name in self.points:
            self._places[name] = next(column), next(column)
        for name in self.links:
            self._origins[name] = next(column), next(column)
            self._rotors[name] = next(column), next(column)
        self._driven = {name: next(column) for name in self.drives}
        for name in self.angles:
            self._turns[name] = next(column)

    def _coordinate(self, free: int) -> Array:
        """A free coordinate itself."""
        unit: Array = self._units[2 * self.free + free]
        return unit

    def _point_vectors(self, link: str, local: Any) -> Vectors:
        """From the origin of a link to its point."""
        (cosine, sine), (a, b) = self._rotors[link], local
        return a * cosine - b * sine, b * cosine + a * sine

    def _place(self, link: str, local: Any) -> Vectors:
        (x, y), (p, q) = self._origins[link], self._point_vectors(link, local)
        return x + p, y + q

    def _follow(self, follow: Follow) -> None:
        """Where an unknown is, in free coordinates and in what is known."""
        name, by, scale = follow.entity.name, follow.by, self.dimensions.scale
        local = self.dimensions.local
        if follow.entity.kind == "point":
            if by is None:
                first, second = follow.first, follow.first + 1
                self._places[name] = scale * self._coordinate(first), scale * self._coordinate(second)
            else:
                self._places[name] = self._place(by.link, local[by.link][name])
            return
        self._rotors[name] = self._units[follow.turn], self._units[self.free + follow.turn]
        self._turns[name] = self._coordinate(follow.turn)
        if by is None:
            at = scale * self._coordinate(follow.first), scale * self._coordinate(follow.first + 1)
        else:
            at = self._places[by.point]
        x, y = self._point_vectors(name, self._pivot(follow))
        self._origins[name] = at[0] - x, at[1] - y

    def _pivot(self, follow: Follow) -> Any:
        local = self.dimensions.local[follow.entity.name]
        return next(iter(local.values())) if follow.by is None else local[follow.by.point]

    def _state_forms(self) -> None:
        """The numbers of a state of the group, and the free coordinates by these."""
        group = self.group
        forms = [x for name in group.points for x in self._places[name]]
        column = {name: 2 * k for k, name in enumerate(group.points)}
        first = len(forms)
        for k, name in enumerate(group.links):
            column[name] = first + 4 * k
            forms += [*self._origins[name], *self._rotors[name]]
        turning = [f.entity.name for f in self.pattern.follows if f.entity.kind == "link"]
        angles = {name: len(forms) + k for k, name in enumerate(turning)}
        forms += [self._turns[name] for name in turning]
        self.of_state = np.ascontiguousarray(np.array(forms).T)
        back = np.zeros((len(forms), self.free))
        over = 1.0 / self.dimensions.scale
        for follow in self.pattern.follows:
            name = follow.entity.name
            if follow.entity.kind == "link":
                back[angles[name], follow.turn] = 1.0
            if follow.by is None:
                for axis in (0, 1):
                    back[column[name] + axis, follow.first + axis] = over
                if follow.entity.kind == "link":
                    a, b = self._pivot(follow)
                    cosine, sine = column[name] + 2, column[name] + 3
                    back[[cosine, sine], follow.first] = a * over, -b * over
                    back[[cosine, sine], follow.first + 1] = b * over, a * over
        self.back = back
        self.needed = np.nonzero(back.any(axis=1))[0]
        """The numbers of a state that tell its free coordinates."""
        self._turned = np.zeros(self.free)
        self._turned[[follow.turn for follow in self.pattern.follows if follow.entity.kind == "link"]] = 1.0

    def _closing_forms(self) -> None:
        """Equations left over: of hinges as constant factors, of others with the bodies of which they speak."""
        over = 1.0 / self.dimensions.scale
        self.closing = np.zeros((self.width, self.free))
        self.others: list[OtherRow] = []
        for number, k in enumerate(self.pattern.kept):
            constraint, row = self.group.equations[k]
            if isinstance(constraint, PointInLink):
                place = self._places[constraint.point]
                there = self._place(constraint.link, self.dimensions.local[constraint.link][constraint.point])
                self.closing[:, number] = (place[row] - there[row]) * over
            elif isinstance(constraint, PointOnGuide) and constraint.on == FRAME:
                # a fixed line: how far the point lies from it is linear in the point
                through, (a, b) = self.dimensions.curve(constraint.guide)
                (x, y), (p, q) = self._places[constraint.point], self._place(FRAME, through)
                self.closing[:, number] = (a * (y - q) - b * (x - p)) * over
            else:
                self.others.append(OtherRow(constraint, row, number, 1.0 if constraint.angular else over))
        bodies = dict.fromkeys(body for other in self.others for body in other.constraint.bodies)
        forms: list[Array] = [self._driven[name] for name in self.drives] if self.others else []
        self.where: dict[Entity, int] = {}
        for body in bodies:
            self.where[body] = len(forms)
            if body.kind == "point":
                forms += self._places[body.name]
            else:
                forms += [*self._origins[body.name], *self._rotors[body.name]]
                if body.name in self._turns:
                    forms.append(self._turns[body.name])
        # what bodies take stands behind the equations: one product tells both
        of_bodies = np.array(forms).T if forms else np.zeros((self.width, 0))
        self.forms = np.ascontiguousarray(np.concatenate([self.closing, of_bodies], axis=1))
        self.slopes = self._derivatives(self.forms)

    def _derivatives(self, forms: Array) -> tuple[Array, Array, Array]:
        """What forms (n, m) gain by the free coordinates (m, free): times cosine, times sine, and always."""
        free = self.free
        return forms[free : 2 * free].T.copy(), forms[:free].T.copy(), forms[2 * free : 3 * free].T.copy()

    # numbers at places

    def known(self, at: Positions, places: int, orders: int = 1, dtype: Any = np.float64) -> Array:
        """What is known of positions over any algebra, as coefficients (orders, places, known)."""
        values = [x for name in self.points for x in at.points[name]]
        values += [x for name in self.links for vector in at.poses[name] for x in vector]
        values += [at.drives[name] for name in self.drives]
        values += [at.angles[name] for name in self.angles]
        numbers = np.zeros((orders, places, len(values)), dtype=dtype)
        for column, x in enumerate(values):
            if isinstance(x, Jet):
                for order, c in enumerate(x.coefficients[:orders]):
                    numbers[order, :, column] = c
            else:
                numbers[0, :, column] = x.value if isinstance(x, Rounded) else x
        return numbers

    def free_of(self, state: Array) -> tuple[Array, Array]:
        """Free coordinates (k, free) of states (k, width), angles within half a turn, and the turns left out [rad]."""
        free = _times(state, self.back)
        # an angle of many turns has fewer digits behind the point: its rotor shall not lose them
        whole = self._turned * (TURN * np.round(free.real / TURN))
        return free - whole, whole

    def numbers(self, free: Array, whole: Array, known: Array) -> Array:
        """Numbers of places (k, n)."""
        size = self.free
        numbers = np.empty((len(free), self.width), dtype=np.result_type(free, known))
        np.cos(free, out=numbers[:, :size])
        np.sin(free, out=numbers[:, size : 2 * size])
        np.add(free, whole, out=numbers[:, self.coordinates])
        numbers[:, 3 * size :] = known
        return numbers

    def state(self, numbers: Array) -> Array:
        """States (k, width) of numbers of places, or one coefficient of theirs."""
        return _times(numbers, self.of_state)

    def positions(self, numbers: Array, at: Positions) -> None:
        """Add the group's points and links at numbers (k, n), or at series (orders, k, n), to positions."""
        if numbers.ndim == 2:
            columns: list[Number] = list(self.state(numbers).T)
        else:
            states = [self.state(coefficients).T for coefficients in numbers]
            columns = [Jet(c) for c in zip(*states, strict=True)]
        column = iter(columns)
        for name in self.group.points:
            at.points[name] = next(column), next(column)
        for name in self.group.links:
            at.poses[name] = PlanePose((next(column), next(column)), (next(column), next(column)))
        for follow in self.pattern.follows:
            if follow.entity.kind == "link":
                at.angles[follow.entity.name] = next(column)

    # equations at places

    def residual(self, numbers: Array) -> Array:
        """Left sides (k, free) of the equations left over, in rad and in the greatest length."""
        forms = _times(numbers, self.forms)
        values = forms[:, : self.free]
        if self.others:
            self._put_residuals(values, self._bodies([forms]))
        return values

    def coefficient(self, series: Array, order: int) -> Array:
        """A coefficient (k, free) of the left sides along series of numbers (orders, k, n)."""
        if not self.others:
            return _times(series[order], self.forms)
        forms = [_times(coefficients, self.forms) for coefficients in series[: order + 1]]
        values, at = forms[order][:, : self.free], self._bodies(forms)
        for other in self.others:
            left = other.constraint.residual(JETS, self.dimensions, at)[other.row]
            of_order = left.coefficients[order] if isinstance(left, Jet) else 0.0
            values[:, other.number] = of_order * other.unit
        return values

    def matrix(self, numbers: Array) -> Array:
        """Derivatives (k, free, free) of the left sides by the free coordinates."""
        return self._matrix(numbers, self._bodies([_times(numbers, self.forms)]) if self.others else None)

    def equations(self, numbers: Array) -> tuple[Array, Array]:
        """Left sides and their derivatives, as `residual` and `matrix` have them."""
        forms = _times(numbers, self.forms)
        values = forms[:, : self.free]
        if not self.others:
            return values, self._matrix(numbers, None)
        at = self._bodies([forms])
        self._put_residuals(values, at)
        return values, self._matrix(numbers, at)

    def _put_residuals(self, values: Array, at: Positions) -> None:
        """Put the left sides of the equations that are no hinges."""
        for other in self.others:
            left = other.constraint.residual(ARRAYS, self.dimensions, at)[other.row]
            values[:, other.number] = left * other.unit

    def _matrix(self, numbers: Array, at: Positions | None) -> Array:
        tangents = self._tangents(numbers)
        matrix = tangents[:, : self.free]
        if at is not None:
            shifts = tangents[:, self.free :]
            for other in self.others:
                row = other.constraint.rows(self.dimensions, at)[other.row]
                total: Number = 0.0
                for body, slopes in row.items():
                    total = total + self._turned_along(body, slopes, shifts)
                matrix[:, other.number] = total * other.unit
        return matrix

    def _turned_along(self, body: Entity, slopes: Any, shifts: Array) -> Number:
        first = self.where[body]
        total: Number = 0.0
        # of a link the third is its turn, behind its origin and its rotor; known bodies do not move
        columns = (first, first + 1) if body.kind == "point" else (first, first + 1, first + 4)
        for slope, column in zip(slopes, columns, strict=True):
            if body.kind == "link" and column == first + 4 and body.name not in self._turns:
                continue
            if not (type(slope) is float and slope == 0.0):
                total = total + np.asarray(slope)[..., None] * shifts[:, column]
        return total

    def _tangents(self, numbers: Array) -> Array:
        """Derivatives (k, m, free) of the forms by the free coordinates."""
        by_cosine, by_sine, always = self.slopes
        size = self.free
        tangents = numbers[:, None, :size] * by_cosine
        tangents -= numbers[:, None, size : 2 * size] * by_sine
        tangents += always
        return tangents

    def _bodies(self, forms: Sequence[Array]) -> Positions:
        """Positions of what the equations that are no hinges speak of: arrays, or jets for more than one order."""
        each = [of_order[:, self.free :].T for of_order in forms]
        columns = list(each[0]) if len(each) == 1 else [Jet(c) for c in zip(*each, strict=True)]
        at = Positions({}, {}, dict(zip(self.drives, columns, strict=False)))
        for body, first in self.where.items():
            if body.kind == "point":
                at.points[body.name] = tuple(columns[first : first + 2])
                continue
            x, y, cosine, sine = columns[first : first + 4]
            at.poses[body.name] = PlanePose((x, y), (cosine, sine))
            if body.name in self._turns:
                at.angles[body.name] = columns[first + 4]
        return at

    # series

    def begin(self, numbers: Array, known: Array) -> Array:
        """Series (orders, k, n) that begin with numbers, and in which only what is known moves so far."""
        series = np.zeros((len(known), *numbers.shape), dtype=numbers.dtype)
        series[0] = numbers
        series[1:, :, self.first_known :] = known[1:]
        return series

    def bend(self, series: Array, order: int) -> None:
        """Put the part of an order that the lower ones of the free coordinates give."""
        size = self.free
        for i in range(1, order):
            angle = series[i, :, self.coordinates] * (i / order)
            series[order, :, :size] -= angle * series[order - i, :, size : 2 * size]
            series[order, :, size : 2 * size] += angle * series[order - i, :, :size]

    def put(self, series: Array, order: int, free: Array) -> None:
        """Put an order of the free coordinates, which had none before."""
        size = self.free
        series[order, :, :size] -= free * series[0, :, size : 2 * size]
        series[order, :, size : 2 * size] += free * series[0, :, :size]
        series[order, :, self.coordinates] = free

    def series(self, numbers: Array, known: Array, matrix: Array) -> Array:
        """Series of converged places, all orders of what is known (orders, k, known), by the matrix there."""
        series = self.begin(numbers, known)
        # the matrix is the same for every order, so it is inverted once
        inverse = inverse_places(matrix)
        for order in range(1, len(known)):
            self.bend(series, order)
            self.put(series, order, -_each(inverse, self.coefficient(series, order)))
        return series


def _each(matrix: Array, vector: Array) -> Array:
    """Product of a matrix and a vector at every place."""
    return np.asarray(np.matmul(matrix, vector[:, :, None])[:, :, 0])


def _times(numbers: Array, factors: Array) -> Array:
    """Products (k, n) (n, m), place by place: the bits of one do not depend on how many there are."""
    return np.asarray(np.matmul(numbers[:, None, :], factors)[:, 0])


def inverse_places(matrix: Array) -> Array:
    """Inverse (k, n, n) of the matrix at every place; NaN where it is singular."""
    try:
        return np.asarray(np.linalg.inv(matrix))
    except np.linalg.LinAlgError:
        return solve_places(matrix, np.broadcast_to(np.eye(matrix.shape[-1]), matrix.shape))


def solve_places(matrix: Array, right: Array) -> Array:
    """Solution (k, n, m) of the equations at every place; NaN where the matrix is singular."""
    try:
        # NumPy refuses all places where one is singular: the others are solved without it
        return np.asarray(np.linalg.solve(matrix, right))
    except np.linalg.LinAlgError:
        sign, _size = np.linalg.slogdet(matrix)
        solution = np.full(right.shape, np.nan, dtype=np.result_type(matrix, right))
        solution[sign != 0.0] = np.linalg.solve(matrix[sign != 0.0], right[sign != 0.0])
        return solution
