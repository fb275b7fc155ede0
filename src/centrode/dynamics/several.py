"""Masses and loads of a mechanism with several drives: inertia matrix, Christoffel terms, generalised forces."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.dynamics.bodies import About
from centrode.dynamics.burden import Burden
from centrode.dynamics.inertia import coordinates_of as speeds_of
from centrode.dynamics.states import Moving, State
from centrode.errors import InputError
from centrode.kinematics.dataset import (
    Variable,
    attributes_of,
    coordinates_of,
    judgements_of,
    labels_of,
    named,
)
from centrode.kinematics.several_drives.partials import Partials, partials
from centrode.kinematics.solve import GREATEST_RESULT, Solved
from centrode.locale import _

Array: TypeAlias = npt.NDArray[np.float64]


def reduced_to_several(solved: Solved, burden: Burden) -> xr.Dataset:
    """Inertia matrix, Christoffel terms of the first kind and generalised forces at the samples of a motion.

    M_ij = sum m r_i . r_j + I phi_i phi_j with partial derivatives by the drives, [ij, k] = sum m r_ij . r_k + I
    phi_ij phi_k, Q_i = sum F . r_i. Raises InputError for a load whose formula names the drive's value.
    """
    refuse_drive_in_formulas(burden)
    _refuse_rings(burden)
    _check_size(solved, burden)
    found = partials(solved)
    directions = _Directions.of(found, solved)
    matrix, christoffel = _inertia(directions, burden)
    forces = _forces(directions, solved, burden)
    units = solved.ready.parameter.units
    variables = {
        "inertia_matrix": _mixed("inertia_matrix", ("drive", "drive_2"), matrix.sum(axis=1), units),
        "inertia_matrix_part": _mixed("inertia_matrix_part", ("link", "drive", "drive_2"), matrix, units),
        "christoffel": _mixed("christoffel", ("drive", "drive_2", "drive_3"), christoffel, units),
        "generalised_force": _mixed("generalised_force", ("drive",), forces.sum(axis=1), units),
        "generalised_force_part": _mixed("generalised_force_part", ("load", "drive"), forces, units),
        "status": judgements_of(found.solved, ())["status"],
    }
    known = coordinates_of(solved)
    coordinates = {name: known[name] for name in ("time", "drive_value", "drive")}
    names = labels_of(tuple(found.units))
    coordinates |= {"drive_2": names, "drive_3": names}
    coordinates |= {"link": labels_of(burden.links), "load": labels_of(burden.labels)}
    return xr.Dataset(variables, coords=coordinates, attrs=attributes_of(solved))


def refuse_drive_in_formulas(burden: Burden) -> None:
    """Raise InputError for a load whose formula names the drive's value, where there are several drives."""
    for load in burden.loads:
        if any("q" in effort.amount.uses for effort in load.efforts):
            what = _("its formula names q, and there are several drives")
            raise InputError(load.where, what, _("write it with t, x and v"))


def _refuse_rings(burden: Burden) -> None:
    for mass in burden.masses:
        if isinstance(mass.inertia, tuple) and any(isinstance(part, About) for part in mass.inertia):
            what = _("a ring and point mass belongs to mechanisms with one drive")
            raise InputError(f"[links.{mass.link}] model", what, _("give the link's tensor of inertia"))


def _check_size(solved: Solved, burden: Burden) -> None:
    drives, samples = len(solved.ready.mechanism.drives), solved.status.size
    most = GREATEST_RESULT // max(solved.layout.width * drives**2, drives**3, len(burden.loads) * drives)
    if samples > most:
        what = _("{asked} positions were asked for").format(asked=samples)
        repair = _("ask for at most {most} at once, samples times mechanisms").format(most=most)
        raise InputError(_("samples"), what, repair)


@dataclass(frozen=True)
class _Directions:
    """States differentiated along each drive and each pair of drives, and the lengths of these directions."""

    along: dict[tuple[int, int], State]
    units: tuple[float, ...]
    shape: tuple[int, ...]

    @classmethod
    def of(cls, found: Partials, solved: Solved) -> _Directions:
        """States of all directions of a motion."""
        moving = Moving(solved.span.time, solved.span.parameter, solved.span.rate)
        along = {}
        for pair, one in found.along.items():
            # directions carry derivatives of angles only, the angles themselves are those of the motion
            angles = np.concatenate([solved.angles[:1], one.angles[1:]])
            along[pair] = State.of(replace(one, angles=angles), moving)
        return cls(along, tuple(found.units.values()), solved.status.shape)


def _inertia(directions: _Directions, burden: Burden) -> tuple[Array, Array]:
    """Inertia matrix by link (n, links, i, j) and Christoffel terms (n, i, j, k)."""
    units, along = directions.units, directions.along
    size, count = len(units), directions.shape[-1]
    matrix = np.zeros((len(burden.masses), size, size, count))
    christoffel = np.zeros((size, size, size, count))
    for link, mass in enumerate(burden.masses):
        jets = {pair: speeds_of(state, mass) for pair, state in along.items()}
        for number, (factor, _one) in enumerate(jets[0, 0]):
            first = [jets[i, i][number][1].derivative(1) / units[i] for i in range(size)]
            for i, j in product(range(size), repeat=2):
                matrix[link, i, j] += np.reshape(factor * first[i] * first[j], -1)
                pair = (i, j) if i <= j else (j, i)
                second = jets[pair][number][1].derivative(2)
                if i == j:
                    second = second / units[i] ** 2
                else:
                    straight = [jets[k, k][number][1].derivative(2) for k in pair]
                    second = (second - straight[0] - straight[1]) / (2.0 * units[i] * units[j])
                for k in range(size):
                    christoffel[i, j, k] += np.reshape(factor * second * first[k], -1)
    return np.moveaxis(matrix, -1, 0), np.moveaxis(christoffel, -1, 0)


def _forces(directions: _Directions, solved: Solved, burden: Burden) -> Array:
    """Generalised forces by load (n, loads, i): how great loads are the motion says, along what the directions."""
    state = State.of(solved, Moving(solved.span.time, solved.span.parameter, solved.span.rate))
    known = state.exists
    forces = np.empty((len(burden.loads), len(directions.units), directions.shape[-1]))
    for number, load in enumerate(burden.loads):
        strengths = load.strengths(state, known)
        for i, unit in enumerate(directions.units):
            forces[number, i] = np.reshape(
                np.broadcast_to(load.along(directions.along[i, i], strengths) / unit, directions.shape), -1
            )
    absent = ~directions.along[0, 0].exists[0]
    forces[..., absent] = np.nan
    return np.moveaxis(forces, -1, 0)


def _mixed(name: str, dimensions: Sequence[str], values: Array, units: Sequence[str]) -> Variable:
    """A variable with one unit, or with one for each combination of drives in the order of the array."""
    variable = named(name, ("sample", *dimensions), values)
    drives = sum(dimension.startswith("drive") for dimension in dimensions)
    head = "N" if "force" in name else "kg"
    least = 1 if head == "N" else 2
    each = [_unit(head, least - sum(unit != "rad" for unit in of)) for of in product(units, repeat=drives)]
    variable[2]["units"] = each[0] if len(set(each)) == 1 else ", ".join(each)
    return variable


def _unit(head: str, metres: int) -> str:
    """A unit with so many metres in it: "kg m^2" with 2, "kg/m" with -1."""
    if metres == 0:
        return head
    power = "" if abs(metres) == 1 else f"^{abs(metres)}"
    return f"{head} m{power}" if metres > 0 else f"{head}/m{power}"
