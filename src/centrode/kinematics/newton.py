"""Groups of higher class: Newton's method on the constraints of the group, all places at once.

What is known beside the group is given at every place; the state of a place is where the group's points and
links are. Derivatives follow from the same equations over jets, order by order, and bounds of rounding errors
over bounded numbers (Griewank and Walther, Evaluating Derivatives, 2nd ed., 2008, section 13; Higham, Accuracy
and Stability of Numerical Algorithms, 2nd ed., 2002, section 25).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.arrays import ARRAYS
from centrode.algebra.jets import Jet
from centrode.algebra.rounding import ROUNDED, Rounded
from centrode.geometry.plane import Pose, moved_point, moved_pose
from centrode.kinematics.paths import JETS
from centrode.structure.constraints import Constraint
from centrode.structure.dimensions import Dimensions
from centrode.structure.groups import Newton
from centrode.structure.positions import Entity, Positions

Array: TypeAlias = npt.NDArray[np.float64]
Mask: TypeAlias = npt.NDArray[np.bool_]
Number: TypeAlias = Any
Namespace: TypeAlias = Any

STEPS = 12
"""Newton steps before a place counts as not converged."""
SMALL = 1e-9
"""After a step this small (in rad, or in the greatest length) the next is below rounding: convergence is quadratic."""


@dataclass(frozen=True)
class System:
    """The equations of a group at k places: dimensions and known positions are floats or (k,) arrays.

    A state (k, width) holds the coordinates of the group's points, then origin, rotor and angle of its links;
    a step (k, size) has two coordinates a point and three a link, lengths in the greatest length.
    """

    group: Newton
    numbers: Dimensions
    known: Positions
    places: int

    @cached_property
    def first(self) -> dict[Entity, int]:
        """First coordinate of each unknown in a step."""
        entities = [Entity("point", name) for name in self.group.points]
        entities += [Entity("link", name) for name in self.group.links]
        found, total = {}, 0
        for entity in entities:
            found[entity] = total
            total += entity.unknowns
        return found

    @property
    def size(self) -> int:
        """Number of unknown coordinates, and of equations."""
        return len(self.group.equations)

    @cached_property
    def units(self) -> Array:
        """What one unit of each coordinate of a step is (k, size): the greatest length, or 1 rad."""
        units = np.ones((self.places, self.size))
        for entity, column in self.first.items():
            units[:, column : column + 2] = self._scale[:, None]
            if entity.kind == "link":
                units[:, column + 2] = 1.0
        return units

    @cached_property
    def _scale(self) -> Array:
        return np.asarray(np.broadcast_to(self.numbers.scale, (self.places,)), dtype=np.float64)

    def at(
        self, m: Namespace, known: Positions, state: Array, step: Sequence[Number] | None = None
    ) -> Positions:
        """Known positions with those of a state, moved by a step, over any algebra."""
        at = known.copied()
        by = [0.0] * self.size if step is None else [self.units[:, j] * x for j, x in enumerate(step)]
        for k, name in enumerate(self.group.points):
            place = (state[:, 2 * k], state[:, 2 * k + 1])
            at.points[name] = place if step is None else moved_point(m, place, by[2 * k : 2 * k + 2])
        for k, name in enumerate(self.group.links):
            x, y, cosine, sine, angle = state[:, self._first_link + 5 * k : self._first_link + 5 * k + 5].T
            turn = by[2 * len(self.group.points) + 3 * k :][:3]
            pose = Pose((x, y), (cosine, sine))
            at.poses[name] = pose if step is None else moved_pose(m, pose, turn)
            at.angles[name] = angle if step is None else turn[2] + angle
        return at

    @property
    def _first_link(self) -> int:
        return 2 * len(self.group.points)

    def state_of(self, at: Positions) -> Array:
        """The state in which positions are: (k, width)."""
        numbers = [x for name in self.group.points for x in at.points[name]]
        for name in self.group.links:
            pose = at.poses[name]
            numbers += [*pose.origin, *pose.rotor, at.angles[name]]
        return np.stack([np.broadcast_to(x, (self.places,)) for x in numbers], axis=-1).astype(np.float64)

    def moved(self, state: Array, step: Array) -> Array:
        """A state moved by a step, its rotors of unit length."""
        at = self.at(ARRAYS, self.known, state, list(step.T))
        moved = self.state_of(at)
        for k in range(len(self.group.links)):
            rotor = moved[:, self._first_link + 5 * k + 2 : self._first_link + 5 * k + 4]
            rotor /= np.hypot(rotor[:, 0], rotor[:, 1])[:, None]
        return moved

    def residual(self, m: Namespace, at: Positions) -> list[Number]:
        """Left sides of the equations, lengths in the greatest length."""
        found: dict[Constraint, list[Number]] = {}
        values = []
        for constraint, row in self.group.equations:
            if constraint not in found:
                found[constraint] = constraint.residual(m, self.numbers, at)
            value = found[constraint][row]
            values.append(value if constraint.angular else value * (1.0 / self._scale))
        return values

    def matrix(self, at: Positions) -> Array:
        """Derivatives of the residual by the coordinates of a step: (k, size, size)."""
        matrix = np.zeros((self.places, self.size, self.size))
        for i, (constraint, row) in enumerate(self.group.equations):
            unit = 1.0 if constraint.angular else self._scale
            for entity, values in constraint.rows(self.numbers, at)[row].items():
                column = self.first.get(entity)
                if column is not None:
                    for j, value in enumerate(values):
                        matrix[:, i, column + j] += value * self.units[:, column + j] / unit
        return matrix

    def errors(self, state: Array) -> Array:
        """Residual at a state as an array (k, size)."""
        return self._stacked(self.residual(ARRAYS, self.at(ARRAYS, self.known, state)))

    def _stacked(self, values: Sequence[Number]) -> Array:
        return np.stack(
            [np.broadcast_to(np.asarray(x, dtype=float), (self.places,)) for x in values], axis=-1
        )

    def jets(self, known: Positions, state: Array, order: int) -> list[Jet]:
        """Taylor coefficients of the step from a converged state, by the variable of the known jets."""
        inverse = inverted(self.matrix(self.at(ARRAYS, self.known, state)))
        zero = np.zeros(self.places)
        found = [[zero] for _column in range(self.size)]
        for k in range(1, order + 1):
            step = [Jet([*c, *[zero] * (order + 1 - len(c))]) for c in found]
            values = self.residual(JETS, self.at(JETS, known, state, step))
            wrong = self._stacked([x.coefficients[k] if isinstance(x, Jet) else 0.0 for x in values])
            right = times(inverse, -wrong)
            for column, c in enumerate(found):
                c.append(right[:, column])
        return [Jet(c) for c in found]

    def bounds(self, known: Positions, state: Array) -> list[Rounded]:
        """The step zero with the bound of the state's rounding error."""
        values = self.residual(ROUNDED, self.at(ROUNDED, known, state))
        bound = self._stacked([Rounded.of(x).bound + np.abs(Rounded.of(x).value) for x in values])
        inverse = np.abs(inverted(self.matrix(self.at(ARRAYS, self.known, state))))
        return [Rounded(np.zeros(self.places), column) for column in times(inverse, bound).T]


@dataclass(frozen=True)
class Converged:
    """What Newton's method came to: states, where it converged, sizes of all steps, signs of the determinants."""

    state: Array
    found: Mask
    sizes: Array
    sense: Array


def newton(system: System, start: Array, steps: int = STEPS) -> Converged:
    """Newton's method from a state at every place; each place stops by itself, whatever its neighbours do."""
    state = start.copy()
    active = np.isfinite(start).all(axis=1)
    found = np.zeros(len(start), dtype=bool)
    sense = np.zeros(len(start))
    sizes = np.full((steps, len(start)), np.nan)
    last = np.full(len(start), np.inf)
    for k in range(steps):
        at = system.at(ARRAYS, system.known, state)
        matrix = system.matrix(at)
        step, sign = solved(matrix, -system._stacked(system.residual(ARRAYS, at)))
        size = np.max(np.abs(step), axis=1)
        sizes[k] = np.where(active, size, np.nan)
        good = active & np.isfinite(size)
        moved = system.moved(state, np.where(good[:, None], step, 0.0))
        state = np.where(good[:, None], moved, state)
        sense = np.where(good, sign, sense)
        # a step after a small one is rounding: where it is not smaller, the matrix cannot give more digits
        done = good & (last <= SMALL) & (size <= SMALL)
        found |= done
        active = good & ~done & (size < 1.0e3)
        last = size
        if not active.any():
            break
    return Converged(state, found, sizes, sense)


def solved(matrix: Array, right: Array) -> tuple[Array, Array]:
    """Solution of the equations at every place and the sign of the determinant; NaN where the matrix is singular."""
    with np.errstate(all="ignore"):
        sign, size = np.linalg.slogdet(matrix)
    regular = np.isfinite(size) & (sign != 0.0) & np.isfinite(right).all(axis=1)
    step = np.full(right.shape, np.nan)
    if regular.any():
        step[regular] = np.linalg.solve(matrix[regular], right[regular][..., None])[..., 0]
    return step, sign


def inverted(matrix: Array) -> Array:
    """Inverse at every place; NaN where the matrix is singular."""
    inverse = np.full(matrix.shape, np.nan)
    with np.errstate(all="ignore"):
        sign, size = np.linalg.slogdet(matrix)
    regular = np.isfinite(size) & (sign != 0.0)
    if regular.any():
        inverse[regular] = np.linalg.inv(matrix[regular])
    return inverse


def times(matrix: Array, vector: Array) -> Array:
    """Product at every place, added up in one order whatever the number of places."""
    total = np.zeros(vector.shape)
    for j in range(vector.shape[1]):
        total += matrix[:, :, j] * vector[:, j : j + 1]
    return total
