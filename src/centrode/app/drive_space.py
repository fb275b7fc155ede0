"""Positions as a function of several drives' values: those that bring a dragged point nearest to the cursor."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from centrode.app.documents import Document
from centrode.app.sketch import SketchParts
from centrode.kinematics.higher_class.evaluation import sense_of
from centrode.kinematics.higher_class.newton import newton
from centrode.kinematics.higher_class.system import (
    GroupSystem,
    add_in_shape,
    flatten_positions,
    needed_positions,
    plain,
)
from centrode.kinematics.path import JETS, unit_of
from centrode.kinematics.plan_evaluation import FixedSigns, layout_of, own_angle
from centrode.kinematics.preparation import Ready
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.jets import Jet
from centrode.structure.constraints import Positions
from centrode.structure.groups import Newton

Array = npt.NDArray[np.float64]

ITERATIONS = 24
"""Steps of Newton's method from one place of the cursor to the next."""
LONGEST = 0.3
"""Greatest step [rad, or of the greatest length]: a farther one could leap over places that are not reached."""
ENOUGH = 1e-10
"""Step [of the units] after which nothing more is gained."""
HALF = 0.5
FIRST_DAMPING, LEAST_DAMPING, GREATEST_DAMPING = 1e-3, 1e-12, 1e6


def has_free_place(document: Document) -> bool:
    """Whether drives have values of their own in a drag: several of them, or one without a law."""
    position = document.position
    return position is not None and (len(position.mechanism.drives) > 1 or document.prepared is None)


@dataclass(frozen=True)
class DrivenPosition:
    """Where everything stands at values of the drives.

    Attributes
    ----------
    values : by drive [rad or m]
    points : name -> place [m]
    angles : link -> angle [rad], of the links that have one
    slopes, bends : name -> first and second derivatives of its place by the drives, (drives, axes) and (drives, drives,
        axes)
    positions : the same with poses and counted angles, from which a position beside it goes on
    """

    values: dict[str, float]
    points: dict[str, Array]
    angles: dict[str, float]
    slopes: dict[str, Array]
    bends: dict[str, Array]
    positions: Positions

    @property
    def is_reached(self) -> bool:
        """Whether the mechanism closes."""
        return all(np.isfinite(place).all() for place in self.points.values())


def position_at(
    prepared: Ready, values: Mapping[str, float], before: Positions | None = None
) -> DrivenPosition:
    """Where everything stands at values of the drives, on the sides of the initial position.

    Groups of higher class, and turns that gears count, go on from a position `before`; without one from the initial
    position along the straight way to these values.
    """
    if before is None:
        before = _positions_on_the_way(prepared, values)
    kinematics, count = prepared.kinematics, len(values)
    # a lane for each pair of drives: in it both move, and one moves alone where it is paired with itself
    pairs = [(i, j) for i in range(count) for j in range(i, count)]
    moving = [[1.0 if k in pair else 0.0 for pair in pairs] for k in range(count)]
    drives = {
        name: Jet((np.full(len(pairs), value), np.array(moving[k]), np.zeros(len(pairs))))
        for k, (name, value) in enumerate(values.items())
    }
    hooks = _Beside(prepared, before, len(pairs))
    with np.errstate(all="ignore"):
        at = Positions.of_frame(kinematics.numbers, drives, ARRAYS)
        kinematics.advance(at, range(len(kinematics.structure.groups)), JETS, hooks)
    layout = layout_of(kinematics)
    points, slopes, bends = {}, {}, {}
    for name in (*kinematics.structure.dimensions.frame, *layout.points):
        lanes = [[_lanes(x, order, len(pairs)) for x in at.points[name]] for order in range(3)]
        place, first, second = (np.array(one).T for one in lanes)
        points[name] = place[0]
        slopes[name] = first[[pairs.index((k, k)) for k in range(count)]]
        bends[name] = _mixed_derivatives(second, pairs, count)
    here = at.map_numbers(lambda x: float(_lanes(x, 0, len(pairs))[0]))
    angles = {}
    for link in layout.links if layout.axes == 2 else ():
        cosine, sine = here.poses[link][1]
        angles[link] = math.atan2(sine, cosine)
    return DrivenPosition(
        {name: float(value) for name, value in values.items()}, points, angles, slopes, bends, here
    )


def angle_at(prepared: Ready, position: DrivenPosition, link: str) -> float:
    """Angle [rad] of a link as its description gives it, with the turns that gears count; NaN of one that has none."""
    counted = position.positions.angles.get(link)
    if counted is not None:
        return float(counted)
    numbers = prepared.kinematics.numbers
    if "rolling" in numbers.space.lacks and numbers.reference(link) is None:
        return math.nan
    return float(own_angle(ARRAYS, numbers, position.positions, link))


class _Beside(FixedSigns):
    """Signs of the initial position; what has no sign, and turns, go on from a position beside this one."""

    def __init__(self, prepared: Ready, before: Positions, lanes: int) -> None:
        super().__init__(JETS, prepared.assembled.signs)
        self.prepared, self.before, self.lanes = prepared, before, lanes

    def continue_angle(self, group: int, key: str, angle: Any) -> Any:
        near = self.before.angles.get(key)
        return angle if near is None else angle + math.tau * np.round((near - plain(angle)) / math.tau)

    def higher(self, group: int, m: Any, at: Positions) -> None:
        equations = self.prepared.structure.groups[group]
        assert isinstance(equations, Newton)
        numbers, shape = self.prepared.kinematics.numbers, (self.lanes,)
        known = flatten_positions(needed_positions(equations, at), shape)
        system = GroupSystem(equations, numbers, known.map_numbers(plain), self.lanes)
        last = GroupSystem(equations, numbers, self.before, 1)
        state = np.repeat(last.state_of(self.before), self.lanes, axis=0)
        converged = newton(system, state)
        # behind a limit the equations have another branch, on which their determinant has the other sign
        start = self.prepared.assembled.positions
        sense = sense_of(GroupSystem(equations, numbers, start, 1), last.state_of(start))
        right = converged.found & (sense_of(system, converged.state) == sense)
        state = np.where(right[:, None], converged.state, np.nan)
        linear = system.linear(system.at(ARRAYS, system.known, state))
        found = system.at(JETS, known, state, system.jets(known, state, linear, 2))
        add_in_shape(found, equations, shape, at)


def _positions_on_the_way(prepared: Ready, values: Mapping[str, float]) -> Positions:
    """Positions beside those at values of the drives: kept ones of a drag, or by steps from the initial position."""
    start = prepared.assembled.positions
    structure = prepared.structure
    if not (
        any(isinstance(one, Newton) for one in structure.groups) or any(map(bool, structure.counted_links))
    ):
        return start
    kept = _KEPT.get(_key_of(prepared, values))
    if kept is not None and kept[0] is prepared:
        return kept[1]
    units = [unit_of(drive, prepared.kinematics.path.scale) for drive in prepared.mechanism.drives]
    begin = initial_values(prepared)
    ways = [
        abs(values[name] - begin[name]) / unit
        for name, unit in zip(begin, units, strict=True)
        if name in values
    ]
    steps = min(STEPS_OF_WAY, max(1, math.ceil(max(ways, default=0.0) / LONGEST)))
    for k in range(1, steps):
        share = {name: begin[name] + (value - begin[name]) * k / steps for name, value in values.items()}
        start = position_at(prepared, share, start).positions
    return start


_KEPT: dict[tuple[int, tuple[tuple[str, float], ...]], tuple[Ready, Positions]] = {}
"""Positions at which drags have arrived: the next step goes on from there."""
KEPT = 64
STEPS_OF_WAY = 400


def _key_of(prepared: Ready, values: Mapping[str, float]) -> tuple[int, tuple[tuple[str, float], ...]]:
    return id(prepared), tuple((name, float(value)) for name, value in values.items())


def _keep(prepared: Ready, position: DrivenPosition) -> None:
    _KEPT[_key_of(prepared, position.values)] = prepared, position.positions
    while len(_KEPT) > KEPT:
        del _KEPT[next(iter(_KEPT))]


def _lanes(number: Any, order: int, count: int) -> Array:
    """A derivative in every lane."""
    value = number.derivative(order) if isinstance(number, Jet) else (number if order == 0 else 0.0)
    return np.broadcast_to(np.asarray(value, dtype=float), (count,))


def _mixed_derivatives(along: Array, pairs: Sequence[tuple[int, int]], count: int) -> Array:
    """Second derivatives by two drives, from those along sums of directions: by polarisation."""
    bends = np.empty((count, count, along.shape[1]))
    own = [along[pairs.index((k, k))] for k in range(count)]
    for lane, (i, j) in enumerate(pairs):
        bends[i, j] = bends[j, i] = own[i] if i == j else (along[lane] - own[i] - own[j]) / 2.0
    return bends


def initial_values(prepared: Ready) -> dict[str, float]:
    """Values of the drives in the initial position [rad or m]."""
    return {name: float(value) for name, value in prepared.assembled.positions.drives.items()}


def place_in_drive_space(
    prepared: Ready, point: str, to: Array, present: Mapping[str, float]
) -> DrivenPosition:
    """The position in which a point is nearest to a place: least squares of the distance, from present values.

    The method of Levenberg and Marquardt, whose damping gives the least change of the drives where more of them move
    the point than it has coordinates; out of reach Newton's method, which converges there too. A step to values at
    which the mechanism does not close is shortened, so the branch is kept.
    """
    scale = prepared.kinematics.path.scale
    units = np.array([unit_of(drive, scale) for drive in prepared.mechanism.drives])
    names = [drive.id for drive in prepared.mechanism.drives]
    here = position_at(prepared, {name: present[name] for name in names})
    damping = FIRST_DAMPING
    for _iteration in range(ITERATIONS):
        gap = here.points[point] - to
        rows = here.slopes[point] * units[:, None]  # by each drive in its own unit
        step = _damped_step(rows @ rows.T, rows @ gap, damping * scale**2)
        if np.linalg.norm(gap + rows.T @ step) > HALF * np.linalg.norm(gap):
            # the gap stays, so its bends count: the place is out of reach, or nearly
            bent = (here.bends[point] @ gap) * np.outer(units, units)
            step = _damped_step(rows @ rows.T + bent, rows @ gap, damping * scale**2)
        size = float(np.max(np.abs(step)))
        if not math.isfinite(size) or size < ENOUGH:
            break
        step *= min(1.0, LONGEST / size)
        values = {name: here.values[name] + float(x) for name, x in zip(names, step * units, strict=True)}
        there = position_at(prepared, values, here.positions)
        if there.is_reached and np.linalg.norm(there.points[point] - to) < np.linalg.norm(gap):
            here, damping = there, max(damping / 10.0, LEAST_DAMPING)
        else:
            damping *= 10.0
            if damping > GREATEST_DAMPING:
                break
    _keep(prepared, here)
    return here


def _damped_step(matrix: Array, gradient: Array, damping: float) -> Array:
    """The step to the least value of a quadratic form that is made convex."""
    values, vectors = np.linalg.eigh(matrix)
    step: Array = -vectors @ ((vectors.T @ gradient) / (np.abs(values) + damping))
    return step


def starts_of(sketch: SketchParts, position: DrivenPosition) -> dict[str, float]:
    """Starts [rad or m] of the drives that put the mechanism there: their laws begin where they do now."""
    prepared = sketch.document.position
    assert prepared is not None
    before, driven = initial_values(prepared), prepared.kinematics.path.driven
    by_name = {one.drive.id: one for one in driven}
    return {name: by_name[name].start + value - before[name] for name, value in position.values.items()}
