"""Positions as a function of several drives' values: those that bring a dragged point nearest to the cursor."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from centrode.app.documents import Document
from centrode.app.sketch import Sketch
from centrode.kinematics.path import JETS, unit_of
from centrode.kinematics.plan_evaluation import FixedSigns, layout_of
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
    """Whether drives have values of their own in a drag: several of them, or one without a law.

    Groups of higher class, and turns that gears count, follow the motion in time.
    """
    position = document.position
    if position is None:
        return False
    structure = position.structure
    follows = any(isinstance(group, Newton) for group in structure.groups) or any(
        map(bool, structure.counted)
    )
    return not follows and (len(position.mechanism.drives) > 1 or document.prepared is None)


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
    """

    values: dict[str, float]
    points: dict[str, Array]
    angles: dict[str, float]
    slopes: dict[str, Array]
    bends: dict[str, Array]

    @property
    def is_reached(self) -> bool:
        """Whether the mechanism closes."""
        return all(np.isfinite(place).all() for place in self.points.values())


def position_at(prepared: Ready, values: Mapping[str, float]) -> DrivenPosition:
    """Where everything stands at values of the drives, on the sides of the initial position."""
    kinematics, count = prepared.kinematics, len(values)
    # a lane for each pair of drives: in it both move, and one moves alone where it is paired with itself
    pairs = [(i, j) for i in range(count) for j in range(i, count)]
    moving = [[1.0 if k in pair else 0.0 for pair in pairs] for k in range(count)]
    drives = {
        name: Jet((np.full(len(pairs), value), np.array(moving[k]), np.zeros(len(pairs))))
        for k, (name, value) in enumerate(values.items())
    }
    hooks = FixedSigns(JETS, prepared.assembled.signs)
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
    angles = {}
    for link in layout.links if layout.axes == 2 else ():
        cosine, sine = (float(_lanes(x, 0, len(pairs))[0]) for x in at.poses[link][1])
        angles[link] = math.atan2(sine, cosine)
    return DrivenPosition(
        {name: float(value) for name, value in values.items()}, points, angles, slopes, bends
    )


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
        there = position_at(prepared, values)
        if there.is_reached and np.linalg.norm(there.points[point] - to) < np.linalg.norm(gap):
            here, damping = there, max(damping / 10.0, LEAST_DAMPING)
        else:
            damping *= 10.0
            if damping > GREATEST_DAMPING:
                break
    return here


def _damped_step(matrix: Array, gradient: Array, damping: float) -> Array:
    """The step to the least value of a quadratic form that is made convex."""
    values, vectors = np.linalg.eigh(matrix)
    step: Array = -vectors @ ((vectors.T @ gradient) / (np.abs(values) + damping))
    return step


def starts_of(sketch: Sketch, position: DrivenPosition) -> dict[str, float]:
    """Starts [rad or m] of the drives that put the mechanism there: their laws begin where they do now."""
    prepared = sketch.document.position
    assert prepared is not None
    before, driven = initial_values(prepared), prepared.kinematics.path.driven
    by_name = {one.drive.id: one for one in driven}
    return {name: by_name[name].start + value - before[name] for name, value in position.values.items()}
