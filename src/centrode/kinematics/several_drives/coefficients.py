"""Kinematic coefficients by each drive, as a labelled result."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product
from typing import TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.errors import InputError
from centrode.kinematics.dataset import (
    Variable,
    attributes_of,
    coordinates_of,
    judgements_of,
    kinds_of,
    labels_of,
    named,
)
from centrode.kinematics.ready import ready
from centrode.kinematics.several_drives.partials import Partials, partials
from centrode.kinematics.solve import GREATEST_RESULT, Solved, asked_span, solve
from centrode.kinematics.spans import span_at
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.quantities import QUANTITIES

Array: TypeAlias = npt.NDArray[np.float64]


def kinematic_coefficients(
    mechanism: Mechanism,
    samples: int | None = None,
    start: float | None = None,
    stop: float | None = None,
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
    """
    prepared = ready(mechanism)
    if at is None:
        span = asked_span(prepared, samples, start, stop)
    else:
        span = span_at(prepared.kinematics.path, np.asarray(at, dtype=np.float64))
    return coefficients_of(solve(prepared, span))


def coefficients_of(solved: Solved) -> xr.Dataset:
    """The same for a motion solved before."""
    if solved.status.size > most_samples(solved):
        raise InputError(
            _("samples"),
            _("{asked} positions were asked for").format(asked=solved.status.size),
            _("ask for at most {most} at once, samples times mechanisms").format(most=most_samples(solved)),
        )
    found = partials(solved)
    variables = {"status": judgements_of(found.solved, ())["status"]}
    units, length = solved.ready.parameter.units, solved.layout.space.unit
    for number, kind in enumerate(kinds_of(solved)):
        first, second = _tensors(found, number)
        for word, values, drives in (("velocity", first, 1), ("acceleration", second, 2)):
            name = f"{kind.prefix}{word}_coefficient"
            dimensions = ("sample", *("drive", "drive_2")[:drives], *kind.dimensions)
            variables[name] = _with_units(named(name, dimensions, values, length_unit=length), name, units)
    coordinates = coordinates_of(solved)
    coordinates["drive_2"] = labels_of(tuple(found.units))
    return xr.Dataset(variables, coords=coordinates, attrs=attributes_of(solved))


def most_samples(solved: Solved) -> int:
    """How many samples' coefficients fit into the memory of an ordinary machine."""
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
