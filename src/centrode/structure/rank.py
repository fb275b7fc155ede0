"""Which constraints are independent: rank of the Jacobian, row by row.

Counting alone assigns redundancy wrongly in some couplers (a rigid braced quadrilateral has as many bars as
unknowns elsewhere), so rows are tested numerically at a random realisation of the same structure. A generic
rank in the plane is also the generic rank on the sphere (coning), so this serves both.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from math import cos, sin, tau

import numpy as np
import numpy.typing as npt

from centrode.algebra.arrays import ARRAYS
from centrode.geometry.plane import Pose, Vector, reversed_rotor, subtract, turned
from centrode.geometry.space import Row
from centrode.model.mechanism import Mechanism
from centrode.structure.constraints import Constraint
from centrode.structure.dimensions import Dimensions
from centrode.structure.generic import random_gearing
from centrode.structure.positions import FRAME, Entity, Positions

INDEPENDENT = 1e-8
"""A unit row counts as independent if this much of it is left after projection on the rows before it."""

Matrix = npt.NDArray[np.float64]


def columns_of(unknowns: Sequence[Entity]) -> tuple[dict[Entity, int], int]:
    """First column of each unknown in the Jacobian, and the number of columns."""
    first, total = {}, 0
    for entity in unknowns:
        first[entity] = total
        total += entity.unknowns
    return first, total


def jacobian(
    constraints: Iterable[Constraint], unknowns: Sequence[Entity], numbers: Dimensions, at: Positions
) -> Matrix:
    """Jacobian of the constraints at given positions (plain floats): one row an equation, in order."""
    first, total = columns_of(unknowns)
    rows = []
    for constraint in constraints:
        for entries in constraint.rows(numbers, at):
            row = np.zeros(total)
            for entity, values in entries.items():
                if entity in first:
                    row[first[entity] : first[entity] + entity.unknowns] += values
            rows.append(row)
    return np.array(rows).reshape(len(rows), total)


def independent_rows(matrix: Matrix) -> npt.NDArray[np.bool_]:
    """Mask of the rows that are independent of the rows before them (twice-repeated Gram-Schmidt)."""
    count, width = matrix.shape
    if all_independent(matrix):
        return np.ones(count, dtype=bool)
    basis = np.zeros((min(count, width), width))
    kept = np.zeros(count, dtype=bool)
    rank = 0
    for i, row in enumerate(matrix):
        norm = np.linalg.norm(row)
        if norm == 0.0 or rank == width:
            continue
        rest = row / norm
        for _ in range(2):
            rest = rest - basis[:rank].T @ (basis[:rank] @ rest)
        size = np.linalg.norm(rest)
        if size > INDEPENDENT:
            basis[rank] = rest / size
            rank += 1
            kept[i] = True
    return kept


def all_independent(matrix: Matrix) -> bool:
    """Whether all rows are independent, by one orthogonalisation: much faster than asking row by row."""
    count, width = matrix.shape
    norms = np.linalg.norm(matrix, axis=1)
    if count > width or not norms.all():
        return False
    # as long as no row is dependent, the diagonal is what Gram-Schmidt leaves of each
    diagonal = np.diagonal(np.linalg.qr((matrix / norms[:, None]).T, mode="r"))
    return bool((np.abs(diagonal) > INDEPENDENT).all())


def random_realisation(mechanism: Mechanism, numbers: Dimensions) -> tuple[Dimensions, Positions]:
    """Random positions, and the lengths that make them fit: the same structure with nothing special about it."""
    random = np.random.default_rng(1)
    points = {name: _pair(random.normal(size=2)) for name in mechanism.points}
    poses = {FRAME: Pose((0.0, 0.0), (1.0, 0.0))}
    for link in mechanism.links:
        angle = random.uniform(0.0, tau)
        poses[link] = Pose(_pair(random.normal(size=2)), (cos(angle), sin(angle)))
    at = Positions(points, poses, {drive.id: 0.0 for drive in mechanism.drives})

    def local(body: str, point: str) -> Vector:
        pose = poses[body]
        return turned(subtract(points[point], pose.origin), reversed_rotor(pose.rotor))

    direction, turn = {}, {}
    for guide in mechanism.guides:
        angle, other = random.uniform(0.0, tau, size=2)
        direction[guide.id] = (cos(angle), sin(angle))
        turn[guide.id] = (cos(other), sin(other))
    fitted = Dimensions(
        {name: points[name] for name in numbers.frame},
        {link: {point: local(link, point) for point in inside} for link, inside in numbers.local.items()},
        {guide.id: local(guide.on, guide.point) for guide in mechanism.guides},
        direction,
        turn,
        numbers.bodies,
        gearing=random_gearing(mechanism, numbers, at, direction, random),
    )
    return fitted, at


def _pair(values: Sequence[float] | Matrix) -> Vector:
    return float(values[0]), float(values[1])


def generic_jacobian(
    mechanism: Mechanism,
    constraints: Sequence[Constraint],
    unknowns: Sequence[Entity],
    numbers: Dimensions,
) -> Matrix:
    """Jacobian at the random realisation."""
    fitted, at = random_realisation(mechanism, numbers)
    return jacobian(constraints, unknowns, fitted, at)


def scaled_jacobian(
    constraints: Sequence[Constraint], unknowns: Sequence[Entity], numbers: Dimensions, at: Positions
) -> Matrix:
    """Jacobian at real positions with lengths measured in the mechanism's own scale, so that rank has a threshold.

    Links are moved by shifts of one of their points and turns about it.
    """
    scale = float(numbers.scale)
    matrix = jacobian(constraints, unknowns, numbers, at)
    for entity, column in columns_of(unknowns)[0].items():
        own = slice(column, column + entity.unknowns)
        matrix[:, own] = matrix[:, own] @ np.array(_motions(entity, numbers, at, scale)).T
    units = [1.0 if c.angular else scale for c in constraints for _row in range(c.size)]
    return np.asarray(matrix / np.array(units)[:, None])


def _motions(entity: Entity, numbers: Dimensions, at: Positions, scale: float) -> Sequence[Row]:
    """Coordinates of a body's small motions: by the scale, or 1 rad."""
    if entity.kind == "point":
        return (scale, 0.0), (0.0, scale)
    first = next(iter(numbers.local[entity.name]))
    return numbers.space.shifts(ARRAYS, at.points[first], scale)


def rank_of(matrix: Matrix) -> int:
    """Numerical rank: singular values above INDEPENDENT times the greatest."""
    if not matrix.size:
        return 0
    if all_independent(matrix):
        return int(matrix.shape[0])
    values = np.linalg.svd(matrix, compute_uv=False)
    return int(np.sum(values > INDEPENDENT * values[0]))


def residuals_at(
    constraints: Sequence[Constraint], numbers: Dimensions, at: Positions
) -> Mapping[Constraint, float]:
    """Greatest residual of each constraint at given positions [rad, or lengths in units of the greatest length]."""
    scale = float(numbers.scale)
    return {
        c: max(abs(float(r)) for r in c.residual(ARRAYS, numbers, at)) / (1.0 if c.angular else scale)
        for c in constraints
    }
