"""The initial state of a free motion: a position that closes, and speeds that fit it, of least kinetic energy."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.forward_dynamics.equations_of_motion import EquationsOfMotion
from centrode.dynamics.forward_dynamics.initial_position import close_position, units_of
from centrode.dynamics.state import length_unit
from centrode.errors import InputError
from centrode.locale import _, ngettext
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.jets import Jet
from centrode.structure.constraints import constraints_of, is_drive

Array: TypeAlias = npt.NDArray[np.float64]
Number: TypeAlias = Any

RANK = 1e-9
"""A row below this share of the greatest is one of rounding."""
CONSISTENT = 1e-9
"""Speeds contradict one another beyond this share of the fastest."""
DRIVE_STEP = 0.05
"""Step [rad, or of a unit length] by which a drive is followed to another value."""


@dataclass(frozen=True)
class InitialState:
    """Joint coordinates and their speeds, closed and consistent.

    Attributes
    ----------
    coordinates : (coordinates) [rad or m]
    speeds : (coordinates) [rad/s or m/s]
    """

    coordinates: Array
    speeds: Array


def initial_state(
    equations: EquationsOfMotion, coordinates: Array, speeds: Mapping[str, Any], values: Mapping[str, float]
) -> InitialState:
    """The state at time zero: position closed, speeds consistent.

    Parameters
    ----------
    coordinates : (coordinates) of a position that closes [rad or m]
    speeds, values : as those of `FreeMotion.initial`

    Raises
    ------
    InputError
        A path names nothing, speeds contradict one another, or the position does not close.
    """
    if values:
        coordinates = _coordinates_with(equations, coordinates, values)
    return InitialState(coordinates, _consistent_speeds(equations, coordinates, speeds))


def _coordinates_with(equations: EquationsOfMotion, coordinates: Array, values: Mapping[str, float]) -> Array:
    """Coordinates of the position in which some drives have these values."""
    tree, mechanism = equations.tree, equations.tree.mechanism
    driven = {f"drives.{c.drive}": c for c in constraints_of(mechanism) if is_drive(c)}  # type: ignore[attr-defined]
    for path in values:
        if path not in driven:
            raise InputError(path, _("there is no such drive"), _("name a drive: drives.NAME"))
    starts = {path.removeprefix("drives."): float(value) for path, value in values.items()}
    # followed there in small steps, so that the branch is that of the description
    constraints = [*tree.closures, *(driven[path] for path in values)]
    here = drive_values(equations, coordinates)
    place = coordinates
    farthest = max((abs(starts[name] - here[name]) for name in starts), default=0.0)
    count = max(1, int(np.ceil(farthest / (DRIVE_STEP * float(min(1.0, equations.numbers.scale))))))
    for step in range(1, count + 1):
        part = {name: here[name] + (value - here[name]) * step / count for name, value in starts.items()}
        place = close_position(tree, equations.numbers, constraints, place, part)
    return place


def drive_values(equations: EquationsOfMotion, coordinates: Array) -> dict[str, float]:
    """Values of all drives [rad or m; on the sphere of guides rad] at joint coordinates."""
    return _of_drives(equations, InitialState(coordinates, np.zeros_like(coordinates)), 0)


def drive_speeds(equations: EquationsOfMotion, start: InitialState) -> dict[str, float]:
    """Speeds of all drives [rad/s or m/s; on the sphere of guides rad/s] in a state."""
    return _of_drives(equations, start, 1)


def _of_drives(equations: EquationsOfMotion, start: InitialState, order: int) -> dict[str, float]:
    """Derivatives by time of the values of all drives."""
    mechanism = equations.tree.mechanism
    state = equations.state(
        ARRAYS,
        equations.tree.values(ARRAYS, list(start.coordinates)),
        [Jet((x, y, 0.0)) for x, y in zip(start.coordinates, start.speeds, strict=True)],
        0.0,
    )
    unit = length_unit(mechanism)
    return {
        drive.id: float(state.drive(drive).coefficients[order]) / (1.0 if drive.kind == "angle" else unit)
        for drive in mechanism.drives
    }


def _consistent_speeds(equations: EquationsOfMotion, coordinates: Array, speeds: Mapping[str, Any]) -> Array:
    """Speeds of all coordinates (coordinates) that keep the closures and what is given."""
    tree, count = equations.tree, len(coordinates)
    values = tree.values(ARRAYS, list(coordinates))
    still = equations.terms(ARRAYS, values, [0.0] * count, 0.0)
    rows = [_dense_row(row, count) for row in still.rows]
    right = [-float(x) for x in still.speeds]
    given = {path: _numbers_of(speed) for path, speed in speeds.items()}
    mass = _mass_matrix(still.mass, count, units_of(tree, equations.numbers))
    found = np.zeros(count)
    if rows:
        found = _least_energy(mass, np.array(rows), np.array(right))
    for path, numbers in given.items():
        # one after the other, so that what contradicts those before it is named
        wanted = _speed_rows(equations, coordinates, path)
        if len(wanted) != len(numbers):
            what = ngettext("it takes {n} number", "it takes {n} numbers", len(wanted)).format(n=len(wanted))
            raise InputError(f"[simulation.speeds] {path}", what, _("give one for each axis"))
        rows += wanted
        right += numbers
        matrix, targets = np.array(rows), np.array(right)
        found = _least_energy(mass, matrix, targets)
        fastest = max(float(np.max(np.abs(found), initial=0.0)), *(abs(x) for x in right))
        gap = float(np.max(np.abs(matrix @ found - targets)))
        if gap > CONSISTENT * max(1.0, float(equations.numbers.scale)) * fastest:
            what = _("it contradicts the constraints or the speeds before it")
            raise InputError(f"[simulation.speeds] {path}", what, _("remove it, or correct it"))
    return found


def _speed_rows(equations: EquationsOfMotion, coordinates: Array, path: str) -> list[Array]:
    """Derivatives of what a path names by the coordinates, a row for each number."""
    kind, _dot, name = path.partition(".")
    mechanism = equations.tree.mechanism
    known = {
        "links": tuple(mechanism.links),
        "guides": tuple(guide.id for guide in mechanism.guides),
        "drives": tuple(drive.id for drive in mechanism.drives),
        "points": (*mechanism.moving_points, *mechanism.frame.points),
    }
    if name not in known.get(kind, ()):
        what = _("it names no link, guide, drive or point of the mechanism")
        raise InputError(
            f"[simulation.speeds] {path}",
            what,
            _("write links.NAME, guides.NAME, drives.NAME or points.NAME"),
        )
    columns = []
    found: tuple[Jet, ...]
    for k in range(len(coordinates)):
        values = equations.tree.values(ARRAYS, list(coordinates))
        jets = [Jet((x, float(i == k), 0.0)) for i, x in enumerate(coordinates)]
        state = equations.state(ARRAYS, values, jets, 0.0)
        if kind == "links":
            found = (state.angle(name),)
        elif kind == "guides":
            found = (state.slide(name),)
        elif kind == "drives":
            found = (state.drive(next(d for d in mechanism.drives if d.id == name)),)
        else:
            found = state.point(name)
        columns.append([float(jet.coefficients[1]) for jet in found])
    return list(np.array(columns).T)


def _dense_row(row: Mapping[int, Number], count: int) -> Array:
    found = np.zeros(count)
    for k, x in row.items():
        found[k] = float(x)
    return found


def _mass_matrix(mass: Mapping[tuple[int, int], Number], count: int, units: Array) -> Array:
    found = np.zeros((count, count))
    for (i, j), x in mass.items():
        found[i, j] = found[j, i] = float(x)
    # where nothing has mass the way itself is to be least
    least = 1e-6 * (float(np.max(np.diag(found) * units**2, initial=0.0)) or 1.0)
    return found + np.diag(least / units**2) * (np.diag(found) * units**2 < least)


def _least_energy(mass: Array, matrix: Array, targets: Array) -> Array:
    """The speeds of least kinetic energy that keep equations as well as can be."""
    factor = np.linalg.cholesky(mass).T
    turned = matrix @ np.linalg.inv(factor)
    sizes = np.linalg.norm(turned, axis=1)
    # a row of rounding asks for nothing
    scales = np.where(sizes > RANK * np.max(sizes, initial=0.0), sizes, np.inf)
    found = np.linalg.lstsq(turned / scales[:, None], targets / scales, rcond=RANK)[0]
    return np.asarray(np.linalg.solve(factor, found))


def _numbers_of(speed: Any) -> tuple[float, ...]:
    return tuple(float(x) for x in speed) if isinstance(speed, Sequence) else (float(speed),)
