"""How far a limit of the drive moves by the dimensions, from the list of constraints alone.

At a limit the Jacobian of the constraints F(x, q, p) = 0 by all coordinates x is singular: a vector w has w F_x = 0. So
w (F_q dq + F_p dp) = 0 whatever the coordinates do, and dq/dp = -(w F_p) / (w F_q). This holds for groups of any class,
in the plane and on the sphere.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.geometry.space import Pose
from centrode.kinematics.machine_code.frame_plan import FreeMechanism
from centrode.kinematics.path import grid_at
from centrode.kinematics.preparation import Ready
from centrode.kinematics.solve import solve
from centrode.model.files import value_at
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.expressions import EXPRESSIONS, as_node, variable
from centrode.numerics.graphs import Graph, gradient
from centrode.numerics.scans import evaluate
from centrode.structure.constraints import Positions
from centrode.structure.rank import jacobian
from centrode.sweeps.folds import through_of

Array: TypeAlias = npt.NDArray[np.float64]

DRIVE = "value of the drive"
SINGULAR = 1e-4
"""Singular values below this part of the greatest are zero: places at a limit are good to the root of rounding."""


def gradient_at_limit(prepared: Ready, paths: Sequence[str], limit: float) -> Array:
    """Derivatives of a limit of the one drive [rad or m] by the numbers of paths.

    NaN where no limit is met there, and where several groups lock at once: then either may stop the drive.
    Raises Untraceable for paths that move more than dimensions.
    """
    at = _positions(prepared, limit)
    if at is None:
        return np.full(len(paths), np.nan)
    kept = prepared.structure.constraints
    left_out = set(prepared.structure.repeating)
    rows = [
        number
        for number, equation in enumerate(
            (constraint, row) for constraint in kept for row in range(constraint.size)
        )
        if equation not in left_out
    ]
    matrix = jacobian(kept, prepared.structure.unknowns, prepared.kinematics.numbers, at)[rows]
    vectors, sizes, _right = np.linalg.svd(matrix)
    singular = sizes < SINGULAR * sizes[0]
    if matrix.shape[0] != matrix.shape[1] or np.count_nonzero(singular) != 1:
        return np.full(len(paths), np.nan)
    free = FreeMechanism(prepared, grid_at(prepared.kinematics.path, np.array([limit])), tuple(paths))
    own = [value_at(prepared.mechanism, path) for path in paths]
    varied = free.varied_numbers(own)
    drives = prepared.kinematics.path.drive_values(EXPRESSIONS, variable(DRIVE))
    fixed = Positions.of_frame(varied.numbers, drives, EXPRESSIONS)
    driven = Positions({**at.points, **fixed.points}, at.poses, drives, at.angles)
    residuals = [x for one in kept for x in one.residual(EXPRESSIONS, varied.numbers, driven)]
    # what stands still in the sum needs no derivative
    balance: Any = 0.0
    for weight, row in zip(vectors[:, -1].tolist(), rows, strict=True):
        balance = balance + weight * residuals[row]
    through = through_of(paths, varied)
    moved = list(dict.fromkeys(x for parts in through.values() for x, _factor in parts))
    slopes = dict(
        zip([variable(DRIVE), *moved], gradient(as_node(balance), [variable(DRIVE), *moved]), strict=True)
    )
    nodes = {"": slopes[variable(DRIVE)]}
    for path, parts in through.items():
        nodes[path] = sum((slopes[x] * factor for x, factor in parts), start=0.0)
    values: dict[str, Any] = dict(varied.values(free.dimensions(own)))
    values |= {path: np.array([x]) for path, x in zip(paths, own, strict=True)}
    values[DRIVE] = np.array([limit])
    found = evaluate(Graph({name: as_node(x) for name, x in nodes.items()}), values)
    numbers = {name: float(np.ravel(x)[0]) for name, x in found.items()}
    return np.array([-numbers[path] / numbers[""] for path in paths])


def _positions(prepared: Ready, limit: float) -> Positions | None:
    """Where everything stands at a limit; None where the motion does not come there."""
    solved = solve(prepared, grid_at(prepared.kinematics.path, np.array([limit])))
    places = solved.points[0, 0, 0]
    if not np.isfinite(places).all():
        return None
    mechanism, numbers = prepared.mechanism, prepared.kinematics.numbers
    drives = prepared.kinematics.path.drive_values(ARRAYS, limit)
    at = Positions.of_frame(numbers, drives, ARRAYS)
    at.points |= {
        name: tuple(map(float, place)) for name, place in zip(mechanism.moving_points, places, strict=True)
    }
    for number, name in enumerate(mechanism.links):
        point, local = next(iter(mechanism.links[name].coordinates.items()))
        angle = float(solved.angles[0, 0, 0, number])
        if solved.attitudes is None:
            attitude = np.array([np.cos(angle), np.sin(angle)])
        else:
            attitude = solved.attitudes[0, 0, 0, number].T.ravel()
        pose: Pose = numbers.space.pose_of(ARRAYS, attitude.tolist(), local, at.points[point])
        at.poses[name] = pose
        at.angles[name] = angle
    return at
