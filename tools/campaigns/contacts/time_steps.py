"""A second way to motions with impacts and friction that seeks no event: time steps of equal length.

Moreau's scheme of the midpoint (M. Jean, The non-smooth contact dynamics method, Computer Methods in Applied Mechanics
and Engineering 177, 1999): a half step with the old velocities, velocities behind the step from impulses that fit
Newton's restitution and Coulomb's bounds, a half step with the new ones. It is of the first order. Coordinates are
absolute, constraints and rows those of `dense_equations`; nothing is shared with the package.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from tools.campaigns.free_motions.dense_equations import RANK, TINY, DenseMechanism

Array: TypeAlias = npt.NDArray[Any]
SWEEPS = 400
"""Sweeps of Gauss and Seidel over a handful of impulses."""
SLOW = 1e-9
STILL, NEARLY_STILL = 1e-8, 2e-2
"""Speeds [rad/s] below which friction sticks, and below which a link counts as at rest: where a wall holds it too,
what is left of its speed is of the order of the step."""


@dataclass(frozen=True)
class Wall:
    """A point stays at least at a bound of its way in a direction, less what it had at the start."""

    point: str
    direction: tuple[float, float]
    most: float
    restitution: float


@dataclass(frozen=True)
class Rubbing:
    """The angle of a body against another rubs with a moment [N m], and holds a greater one."""

    body: str
    base: str
    kinetic: float
    static: float


@dataclass
class Run:
    """What time steps reached: coordinates, velocities, impacts by walls, and how long each friction rested [s]."""

    q: Array
    v: Array
    impacts: list[tuple[float, int, float]] = field(default_factory=list)
    rests: list[float] = field(default_factory=list)


def wall_gap(dense: DenseMechanism, wall: Wall, q: Array) -> Array:
    """Gap of a wall (lanes)."""
    at = dense.point(q, wall.point)
    return np.asarray(wall.most - wall.direction[0] * at[0] - wall.direction[1] * at[1])


def run_steps(
    dense: DenseMechanism, walls: Sequence[Wall], rubbing: Sequence[Rubbing], end: float, count: int
) -> Run:
    """Equal steps from rest at the start to a time [s]."""
    equations, h = dense.equations, end / count
    q, v = dense.start.copy(), np.zeros_like(dense.start)
    run = Run(q, v)
    # it begins at rest, where friction holds as much as it can
    stuck = [True] * len(rubbing)
    run.rests = [0.0] * len(rubbing)
    spins = np.array([_spin_row(dense, one) for one in rubbing]).reshape(len(rubbing), len(q))
    for step in range(count):
        middle = q + 0.5 * h * v
        lanes = middle[:, None] + 1j * TINY * np.eye(len(q))
        slopes = np.imag(equations.constraints(lanes)) / TINY
        gaps = [float(np.real(wall_gap(dense, wall, middle[:, None])[0])) for wall in walls]
        touched = [k for k, gap in enumerate(gaps) if gap <= 0.0]
        rows = [np.imag(wall_gap(dense, walls[k], lanes)) / TINY for k in touched] + list(spins)
        # what the closures leave free, in the measure of the masses
        along = slopes @ equations.root
        inverse = np.linalg.pinv(along, rcond=RANK) if len(along) else np.zeros((len(q), 0))

        def free(x: Array, along: Array = along, inverse: Array = inverse) -> Array:
            return np.asarray(x - inverse @ (along @ x))

        pushed = v + h * equations.root @ (equations.root.T @ equations.force)
        y = free(np.linalg.solve(equations.root, pushed))
        if rows:
            own = np.array(rows) @ equations.root
            own = np.array([free(row) for row in own])
            y = _with_impulses(
                run, own, y, np.linalg.solve(equations.root, v), walls, rubbing, touched, stuck, h, step
            )
        new = equations.root @ y
        q = equations.closed(middle + 0.5 * h * new)
        v = new
    run.q, run.v = q, v
    return run


def _with_impulses(
    run: Run,
    own: Array,
    y: Array,
    before: Array,
    walls: Sequence[Wall],
    rubbing: Sequence[Rubbing],
    touched: Sequence[int],
    stuck: list[bool],
    h: float,
    step: int,
) -> Array:
    matrix = own @ own.T
    old, new = own @ before, own @ y
    count = len(touched)
    low, high, aim = np.empty(len(own)), np.empty(len(own)), new.copy()
    for k, wall in enumerate(touched):
        low[k], high[k] = 0.0, np.inf
        aim[k] += walls[wall].restitution * min(old[k], 0.0)
    for k, one in enumerate(rubbing):
        most = h * (one.static if stuck[k] else one.kinetic)
        low[count + k], high[count + k] = -most, most
    impulses = np.zeros(len(own))
    for _sweep in range(SWEEPS):
        largest = 0.0
        for k in range(len(own)):
            if matrix[k, k] <= 1e-14:
                continue
            change = -(aim[k] + matrix[k] @ impulses) / matrix[k, k]
            wanted = min(max(impulses[k] + change, low[k]), high[k])
            largest = max(largest, abs(wanted - impulses[k]))
            impulses[k] = wanted
        if largest <= 1e-14 * (1.0 + np.max(np.abs(impulses))):
            break
    after = new + matrix @ impulses
    for k, wall in enumerate(touched):
        if impulses[k] > 0.0 and old[k] < -SLOW:
            run.impacts.append(((step + 1) * h, wall, float(old[k])))
    for k in range(len(rubbing)):
        place = count + k
        run.rests[k] += h if abs(after[place]) <= NEARLY_STILL else 0.0
        rests = abs(after[place]) <= STILL * (1.0 + abs(old[place]))
        stuck[k] = bool(rests and abs(impulses[place]) < high[place])
    return np.asarray(y + own.T @ impulses)


def _spin_row(dense: DenseMechanism, one: Rubbing) -> Array:
    row = np.zeros(3 * len(dense.bodies))
    row[3 * dense.bodies.index(one.body) + 2] = 1.0
    if one.base != "frame":
        row[3 * dense.bodies.index(one.base) + 2] = -1.0
    return row
