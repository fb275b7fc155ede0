"""Partial derivatives by each drive: the motion differentiated along directions in the space of the drives.

Along a direction the jets of the closed forms give exact first and second derivatives. Mixed terms follow by
polarisation, D_ij = (D(e_i + e_j) - D(e_i) - D(e_j))/2 with D the second derivative along a direction, which is
exact up to rounding. Next to change points there are no power series: there the motion is smooth along its own path
only, while partial derivatives of the group, the second ones at least, grow without bound as towards a limit.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import frexp
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.arrays import ARRAYS
from centrode.algebra.jets import Jet
from centrode.errors import Status
from centrode.kinematics.continuation import Continuation
from centrode.kinematics.events import Scan
from centrode.kinematics.mesh import mesh_of
from centrode.kinematics.paths import JETS, unit_of
from centrode.kinematics.places import start_of
from centrode.kinematics.sampling import ORDERS, Judging, fill_columns, fill_number
from centrode.kinematics.solve import Solved, fit_for
from centrode.kinematics.spins import attitudes_of, spins_of
from centrode.structure.constraints import Positions

Array: TypeAlias = npt.NDArray[np.float64]
Mask: TypeAlias = npt.NDArray[np.bool_]


@dataclass(frozen=True)
class Partials:
    """Directional derivatives of a motion.

    Attributes
    ----------
    solved : the motion, with statuses as the partial derivatives have them
    units : drive -> length of its direction [rad or m], a power of two
    along : the motion differentiated along each pair of drives (i, j), i <= j, by direction e_i + e_j, or e_i if i = j
    """

    solved: Solved
    units: Mapping[str, float]
    along: Mapping[tuple[int, int], Solved]


def partials(solved: Solved) -> Partials:
    """Partial derivatives of a single mechanism's motion at its samples."""
    path = solved.ready.kinematics.path
    drives = [one.drive for one in path.driven]
    if not path.by_time:
        return Partials(solved, {drives[0].id: 1.0}, {(0, 0): solved})
    units = {drive.id: _power_of_two(unit_of(drive, path.scale)) for drive in drives}
    continuation = _found(solved)
    singular = np.zeros(solved.status.shape, dtype=bool)
    columns, turning = {}, {}
    for i, first in enumerate(units):
        for j, second in enumerate(list(units)[i:], start=i):
            moving = {name: units[name] for name in (first, second)}
            columns[i, j], turning[i, j], lost = _along(continuation, solved, moving)
            singular |= lost
    status = np.where(singular & (solved.status == Status.OK), Status.SINGULAR, solved.status)
    absent = singular | np.isin(status, (Status.OPEN, Status.UNCONVERGED, Status.SINGULAR))
    judged = replace(solved, status=status.astype(np.int8))
    along = {pair: _solved(judged, columns[pair], turning[pair], absent) for pair in columns}
    return Partials(judged, units, along)


def _power_of_two(unit: float) -> float:
    # so that lengths of directions are divided out without rounding
    return float(2.0 ** (frexp(unit)[1] - 1))


def _found(solved: Solved) -> Continuation:
    """The plan with everything that was found along the path."""
    ready = fit_for(solved.ready, solved.span)
    continuation = start_of(ready, ready.kinematics)
    Scan(continuation, mesh_of(ready.kinematics.path, solved.span.parameter)).run()
    return continuation


class _Straight(Judging):
    """Judges as for a motion, without power series."""

    def after(self, group: int, at: Positions) -> None:
        for total, found in zip((self.opened, self.zero), self._judged.pop(group, ()), strict=False):
            np.logical_or(total, found, out=total)


def _along(
    continuation: Continuation, solved: Solved, moving: Mapping[str, float]
) -> tuple[Array, Array, Mask]:
    """Columns and angles (3, ..., 1, n) with derivatives along a direction, and where they do not exist."""
    layout = solved.layout
    kinematics, parameter = continuation.kinematics, solved.span.parameter[None, :]
    values = kinematics.path.drive_values(ARRAYS, parameter)
    drives = {
        name: Jet((np.broadcast_to(value, parameter.shape), moving[name], 0.0)) if name in moving else value
        for name, value in values.items()
    }
    hooks = _Straight(continuation, parameter, parameter.shape)
    columns = np.empty((ORDERS, layout.width, *parameter.shape))
    angles = np.empty((ORDERS, len(layout.angles), *parameter.shape))
    with np.errstate(all="ignore"):
        at = Positions.of_frame(kinematics.numbers, drives, ARRAYS)
        kinematics.advance(at, range(len(kinematics.structure.groups)), JETS, hooks)
        fill_columns(kinematics, layout, at, columns)
        for k, link in enumerate(layout.angles):
            if layout.runs_on and link in at.angles:
                fill_number(angles[:, k], at.angles[link])
            else:
                rotor = columns[:, layout.rotor(link)]
                angles[:, k] = rotor[0, 0] * rotor[:, 1] - rotor[0, 1] * rotor[:, 0]
        whole = np.isfinite(columns.sum(axis=(0, 1)))
    return columns, angles, hooks.zero | ~whole


def _solved(solved: Solved, columns: Array, angles: Array, absent: Mask) -> Solved:
    """The motion with derivatives along a direction in the place of those along its path."""
    layout = solved.layout
    columns[1:, :, absent] = np.nan
    angles[1:, :, absent] = np.nan
    points = columns[:, : layout.first_attitude].reshape(ORDERS, -1, layout.axes, *absent.shape)
    fixed = np.zeros((ORDERS, len(solved.ready.structure.dimensions.frame), layout.axes, *absent.shape))
    fixed[..., absent] = np.nan
    return replace(
        solved,
        all_points=np.moveaxis(np.concatenate([fixed, points], axis=1), (1, 2), (3, 4)),
        points=np.moveaxis(points, (1, 2), (3, 4)),
        angles=np.moveaxis(angles, 1, 3),
        slides=np.moveaxis(columns[:, layout.first_slide : layout.first_rotor], 1, 3),
        spins=spins_of(layout, columns),
        attitudes=attitudes_of(layout, columns),
    )
