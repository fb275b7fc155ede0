"""Kinematic coefficients by each drive, as a labelled result."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from math import frexp
from typing import TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.errors import InputError, Status
from centrode.kinematics.angular_velocity import attitudes_of, spins_of
from centrode.kinematics.change_points import BranchedPlan
from centrode.kinematics.events import EventScan
from centrode.kinematics.mesh import mesh_of
from centrode.kinematics.motion import (
    Variable,
    attributes_of,
    coordinates_of,
    judgements_of,
    kinds_of,
    labels_of,
    vocabulary_variable,
)
from centrode.kinematics.path import JETS, unit_of
from centrode.kinematics.preparation import ready
from centrode.kinematics.sample_index import selectable
from centrode.kinematics.samples import ORDERS, SampleJudging, fill_columns, fill_number, start_of
from centrode.kinematics.solve import GREATEST_RESULT, Solved, fit_for, grid_of, solve
from centrode.locale import _
from centrode.model.examples.catalogue import MechanismSource, mechanism_of
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.jets import Jet
from centrode.quantities import QUANTITIES
from centrode.structure.constraints import Positions

# Partial derivatives by each drive: the motion differentiated along directions in the space of the drives.
#
# Along a direction the jets of the closed forms give exact first and second derivatives. Mixed terms follow
# by polarisation, D_ij = (D(e_i + e_j) - D(e_i) - D(e_j))/2 with D the second derivative along a direction,
# which is exact up to rounding. Next to change points there are no power series: there the motion is smooth
# along its own path only, while partial derivatives of the group, the second ones at least, grow without
# bound as towards a limit.

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
    drives = [driven.drive for driven in path.driven]
    if not path.by_time:
        return Partials(solved, {drives[0].id: 1.0}, {(0, 0): solved})
    # the direction's length is the size of the drive's own unit, so that derivatives of all drives are alike
    # in size
    units = {drive.id: _power_of_two(unit_of(drive, path.scale)) for drive in drives}
    continuation = _branched_plan(solved)
    singular = np.zeros(solved.status.shape, dtype=bool)
    columns, turning = {}, {}
    for i, first in enumerate(units):
        for j, second in enumerate(list(units)[i:], start=i):
            # along e_i + e_j, or along e_i where i = j: polarisation needs no others
            moving = {name: units[name] for name in (first, second)}
            columns[i, j], turning[i, j], lost = _along(continuation, solved, moving)
            singular |= lost
    status = np.where(singular & (solved.status == Status.OK), Status.SINGULAR, solved.status)
    absent = singular | np.isin(status, (Status.OPEN, Status.UNCONVERGED, Status.SINGULAR))
    judged = replace(solved, status=status.astype(np.int8))
    along = {pair: _solve_direction(judged, columns[pair], turning[pair], absent) for pair in columns}
    return Partials(judged, units, along)


def _power_of_two(unit: float) -> float:
    # so that lengths of directions are divided out without rounding
    # the power of two below the unit
    return float(2.0 ** (frexp(unit)[1] - 1))


def _branched_plan(solved: Solved) -> BranchedPlan:
    """The plan with everything that was found along the path."""
    ready = fit_for(solved.ready, solved.span)
    continuation = start_of(ready, ready.kinematics)
    EventScan(continuation, mesh_of(ready.kinematics.path, solved.span.parameter)).run()
    return continuation


class _Straight(SampleJudging):
    """Judges as for a motion, without power series."""

    # a series runs along the motion's own path, and says nothing of other directions
    def after(self, group: int, at: Positions) -> None:
        for total, mask in zip((self.opened, self.zero), self._judged.pop(group, ()), strict=False):
            np.logical_or(total, mask, out=total)


def _along(
    continuation: BranchedPlan, solved: Solved, moving: Mapping[str, float]
) -> tuple[Array, Array, Mask]:
    """Columns and angles (3, ..., 1, n) with derivatives along a direction, and where they do not exist."""
    layout = solved.layout
    kinematics, parameter = continuation.kinematics, solved.span.parameter[None, :]
    values = kinematics.path.drive_values(ARRAYS, parameter)
    drives = {
        # the drives that move have the direction's length as slope and no bend; others are numbers
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
                # c s' - s c' for both orders, and 0 for the value, which is not used
                angles[:, k] = rotor[0, 0] * rotor[:, 1] - rotor[0, 1] * rotor[:, 0]
        whole = np.isfinite(columns.sum(axis=(0, 1)))
    return columns, angles, hooks.zero | ~whole


def _solve_direction(solved: Solved, columns: Array, angles: Array, absent: Mask) -> Solved:
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


def kinematic_coefficients(
    mechanism: MechanismSource,
    samples: int | None = None,
    start: float | str | None = None,
    stop: float | str | None = None,
    at: npt.ArrayLike | None = None,
) -> xr.Dataset:
    """Partial derivatives of positions, angles and displacements by the value of each drive, first and second.

    Parameters
    ----------
    samples, start, stop, at
        As for `motion`: the coefficients belong to the samples of the motion, on its branch.

    Returns
    -------
    Dataset
        `velocity_coefficient` (sample, drive, point, axis), `acceleration_coefficient` (sample, drive, drive_2,
        point, axis), symmetric in the drives, and the same of links and guides (docs: results). With one drive
        they are those of the motion. Where the motion passes a change point, the coefficients of its group do not
        exist: NaN, status singular; near it they lose digits as they do towards a limit.

    Raises
    ------
    InputError, NotComputedYet
        As `motion` does.

    Examples
    --------
    >>> import centrode as ct
    >>> arm = ct.example("five-bar-two-drives")
    >>> ct.kinematic_coefficients(arm, 9).velocity_coefficient.dims
    ('sample', 'drive', 'point', 'axis')
    """
    mechanism = mechanism_of(mechanism)
    prepared = ready(mechanism)
    span = grid_of(prepared, samples, start, stop, at)
    return coefficients_of(solve(prepared, span))


def coefficients_of(solved: Solved) -> xr.Dataset:
    """Partial derivatives by each drive at the samples of a solved motion; see `kinematic_coefficients`."""
    if solved.status.size > most_samples(solved):
        raise InputError(
            _("samples"),
            _("{asked} positions are given").format(asked=solved.status.size),
            _("give at most {most} at once, samples times mechanisms").format(most=most_samples(solved)),
        )
    coefficients = partials(solved)
    variables = {"status": judgements_of(coefficients.solved, ())["status"]}
    units, length = solved.ready.parameter.units, solved.layout.space.unit
    for number, kind in enumerate(kinds_of(solved)):
        first, second = _tensors(coefficients, number)
        for word, values, drives in (("velocity", first, 1), ("acceleration", second, 2)):
            name = f"{kind.prefix}{word}_coefficient"
            dimensions = ("sample", *("drive", "drive_2")[:drives], *kind.dimensions)
            variables[name] = _with_units(
                vocabulary_variable(name, dimensions, values, length_unit=length), name, units
            )
    coordinates = coordinates_of(solved)
    coordinates["drive_2"] = labels_of(tuple(coefficients.units))
    return selectable(xr.Dataset(variables, coords=coordinates, attrs=attributes_of(solved, "run")))


def most_samples(solved: Solved) -> int:
    """Most samples whose coefficients fit into the memory of an ordinary machine."""
    drives = len(solved.ready.mechanism.drives)
    return GREATEST_RESULT // (max(solved.layout.width, 1) * drives * drives)


def _tensors(found: Partials, number: int) -> tuple[Array, Array]:
    """First (n, drives, ...) and second (n, drives, drives, ...) derivatives of one kind of value."""
    units = list(found.units.values())
    orders = {pair: kinds_of(along)[number].orders for pair, along in found.along.items()}
    shape = orders[0, 0][1].shape[1:]
    first = np.empty((len(units), *shape))
    second = np.empty((len(units), len(units), *shape))
    for i, unit in enumerate(units):
        first[i] = orders[i, i][1][0] / unit
        second[i, i] = orders[i, i][2][0] / (unit * unit)
    for i, j in product(range(len(units)), repeat=2):
        if i < j:
            # D(e_i + e_j) = D_ii + 2 D_ij + D_jj
            mixed = orders[i, j][2][0] - orders[i, i][2][0] - orders[j, j][2][0]
            second[i, j] = second[j, i] = mixed / (2.0 * units[i] * units[j])
    return np.moveaxis(first, 0, 1), np.moveaxis(second, (0, 1), (1, 2))


def _with_units(variable: Variable, name: str, units: Sequence[str]) -> Variable:
    """With drives of several kinds: one unit for each drive, or pair of drives, in the order of the array."""
    quantity = QUANTITIES[name]
    base = variable[2]["units"]
    each = [quantity.by_drives(pair).unit for pair in product(units, repeat=quantity.by_drive)]
    if len(set(each)) > 1:
        variable[2]["units"] = ", ".join(each)
    elif units[0] != "rad":
        variable[2]["units"] = each[0]
    else:
        variable[2]["units"] = base
    return variable
