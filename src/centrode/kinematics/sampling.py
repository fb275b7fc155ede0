"""Values and derivatives at samples of the path, with a status for each.

Arrays are ordered (derivative, column, lane, sample): columns are the coordinates of moving points, the
rotors of links and the displacements of guides; lanes are the mechanisms of a batch.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.jets import Jet
from centrode.algebra.rounding import SAFETY
from centrode.errors import Status
from centrode.geometry.plane import Pose, dot, subtract, turned
from centrode.kinematics.branches import Branches
from centrode.kinematics.evaluate import Kinematics
from centrode.kinematics.events import guard_with_bound
from centrode.kinematics.paths import JETS
from centrode.structure.constraints import Positions, line_of

Array: TypeAlias = npt.NDArray[np.float64]
Lanes: TypeAlias = npt.NDArray[np.intp]
Number: TypeAlias = Any

ORDERS = 3
"""Value, first and second derivative."""
SUSPECT = 1e-8
"""Radicands below this fraction of their greatest value are compared with their rounding error."""


@dataclass(frozen=True)
class Layout:
    """Which column of the arrays holds what."""

    points: tuple[str, ...]
    links: tuple[str, ...]
    guides: tuple[str, ...]

    @property
    def width(self) -> int:
        """Number of columns."""
        return 2 * len(self.points) + 2 * len(self.links) + len(self.guides)

    @property
    def first_rotor(self) -> int:
        """Column of the first link's rotor."""
        return 2 * len(self.points)

    @property
    def first_slide(self) -> int:
        """Column of the first guide's displacement."""
        return self.first_rotor + 2 * len(self.links)


@dataclass
class Samples:
    """Columns with their derivatives by the path's parameter, and a status for each sample."""

    layout: Layout
    columns: Array
    status: npt.NDArray[np.int8]


def layout_of(kinematics: Kinematics) -> Layout:
    """Columns for a mechanism: moving points, links and guides in description order."""
    mechanism = kinematics.structure.mechanism
    return Layout(
        tuple(mechanism.moving_points),
        tuple(mechanism.links),
        tuple(guide.id for guide in mechanism.guides),
    )


def evaluate_columns(
    kinematics: Kinematics, layout: Layout, branches: Branches, parameter: Array, lanes: Lanes | None
) -> tuple[Array, npt.NDArray[np.bool_], npt.NDArray[np.bool_]]:
    """Columns at parameters by the closed forms alone, and where a group is open or at zero of its radicand.

    With `lanes` None the result has shape (3, columns, lanes, n) for n parameters; otherwise the parameters
    have shape (k,), each with its own lane, and the result (3, columns, k).
    """
    shape = (branches.lanes, len(parameter)) if lanes is None else parameter.shape
    along = parameter[None, :] if lanes is None else parameter
    opened, zero = np.zeros(shape, dtype=bool), np.zeros(shape, dtype=bool)

    def branch(group: int, radicand: Number) -> Number:
        sign = branches.sign(group, along, lanes)
        if not isinstance(radicand, Jet):
            radicand = Jet((radicand, *[0.0] * (ORDERS - 1)))
        value = np.broadcast_to(radicand.value, shape)
        below = _at_zero(kinematics, branches, group, value, parameter, lanes)
        zero[below] = True
        opened[(value < 0.0) & ~below] = True
        cleared = np.where(below, 0.0, value) if below.any() else radicand.value
        return JETS.sqrt(Jet((cleared, *radicand.coefficients[1:]))) * sign

    used = kinematics if lanes is None else kinematics.taken(lanes)
    with np.errstate(all="ignore"):
        at = used.positions(JETS, Jet.variable(along, ORDERS - 1), branch)
        return _columns(used, layout, at, shape), opened, zero


def _at_zero(
    kinematics: Kinematics,
    branches: Branches,
    group: int,
    value: Array,
    parameter: Array,
    lanes: Lanes | None,
) -> npt.NDArray[np.bool_]:
    """Where a radicand is zero within its rounding error."""
    zero = np.zeros(value.shape, dtype=bool)
    suspects = np.nonzero(np.abs(value) <= SUSPECT * branches.greatest(group, lanes))
    if len(suspects[0]):
        own = suspects[0] if lanes is None else lanes[suspects[0]]
        _value, bound = guard_with_bound(kinematics, branches, group, own, parameter[suspects[-1]])
        zero[suspects] = np.abs(value[suspects]) <= SAFETY * bound
    return zero


def _columns(kinematics: Kinematics, layout: Layout, at: Positions, shape: tuple[int, ...]) -> Array:
    numbers: list[Number] = [x for point in layout.points for x in at.points[point]]
    numbers += [x for link in layout.links for x in at.poses[link].rotor]
    numbers += [_slide(kinematics, at, guide) for guide in layout.guides]
    columns = np.empty((ORDERS, layout.width, *shape))
    for k, number in enumerate(numbers):
        if isinstance(number, Jet):
            for order in range(ORDERS):
                columns[order, k] = number.derivative(order)
        else:
            columns[0, k] = number
            columns[1:, k] = 0.0
    return columns


def _slide(kinematics: Kinematics, at: Positions, guide_id: str) -> Number:
    """Displacement of a guide's point along its line, from the point the line goes through."""
    guide = kinematics.structure.mechanism.guide(guide_id)
    through, direction = line_of(kinematics.numbers, at, guide_id, guide.on)
    return dot(direction, subtract(at.points[guide.point], through))


def sample(kinematics: Kinematics, layout: Layout, branches: Branches, parameter: Array) -> Samples:
    """Columns and statuses at the parameters of a path (before the neighbourhood of change points is mended)."""
    columns, opened, zero = evaluate_columns(kinematics, layout, branches, parameter, None)
    status = np.zeros(opened.shape, dtype=np.int8)
    reach = np.array([branches.reach(lane) for lane in range(branches.lanes)])
    margin = 4.0 * np.spacing(np.abs(parameter))
    beyond = (parameter < reach[:, :1] - margin) | (parameter > reach[:, 1:] + margin)
    status[zero | ~np.isfinite(columns).all(axis=(0, 1))] = Status.SINGULAR
    status[beyond] = Status.CUT_OFF
    status[opened] = Status.OPEN
    return Samples(layout, columns, status)


def settle(samples: Samples) -> None:
    """Absence is NaN: nothing stands in open samples, and no derivatives in singular ones."""
    opened = samples.status == Status.OPEN
    samples.columns[:, :, opened] = np.nan
    samples.columns[1:, :, samples.status == Status.SINGULAR] = np.nan
    samples.columns[~np.isfinite(samples.columns)] = np.nan


def positions_from(kinematics: Kinematics, layout: Layout, values: Array) -> Positions:
    """Positions as plain arrays from the values of the columns (columns first), to evaluate constraints on."""
    numbers = kinematics.numbers
    at = Positions.of_frame(numbers, {})
    for k, point in enumerate(layout.points):
        at.points[point] = (values[2 * k], values[2 * k + 1])
    for k, link in enumerate(layout.links):
        column = layout.first_rotor + 2 * k
        rotor = (values[column], values[column + 1])
        point, local = next(iter(numbers.local[link].items()))
        at.poses[link] = Pose(subtract(at.points[point], turned(local, rotor)), rotor)
    return at
