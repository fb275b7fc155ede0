"""A mechanism made ready to move: structure, path, assembled initial position, mobility at real positions."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any, TypeAlias

import numpy as np

from centrode.errors import InputError
from centrode.kinematics.assembly import Assembled, assemble
from centrode.kinematics.assembly_mode import RESIDUAL_TOLERANCE, length_misfits, refuse_surplus_drives
from centrode.kinematics.change_points import BranchedPlan
from centrode.kinematics.events import EventScan
from centrode.kinematics.mesh import mesh_of
from centrode.kinematics.path import path_of
from centrode.kinematics.plan_evaluation import Kinematics, branches_at_start
from centrode.locale import _
from centrode.model.mechanism import Mechanism, kept_by_mechanism
from centrode.model.motion_parameter import MotionParameter
from centrode.numerics.arrays import ARRAYS
from centrode.structure.constraints import Positions, is_drive
from centrode.structure.groups import Newton
from centrode.structure.plan import Structure, drives_against_mobility, structure_of
from centrode.structure.rank import rank_of, residuals_at, scaled_jacobian

Number: TypeAlias = Any

LOOKS = (0.11, -0.13, 0.37)
"""Places near the initial position, in the path's units, where the rank is taken: not all can be dead points."""


@dataclass(frozen=True)
class Ready:
    """A mechanism with its plan and its assembled initial position.

    Attributes
    ----------
    mobility : int
        Unknowns less the greatest rank (drives left out) found at real positions.
    """

    kinematics: Kinematics
    assembled: Assembled
    mobility: int

    @property
    def structure(self) -> Structure:
        return self.kinematics.structure

    @property
    def parameter(self) -> MotionParameter:
        """Parameter of the motion: time [s], or the value of the one drive [rad or m]."""
        return self.kinematics.path.parameter

    @property
    def mechanism(self) -> Mechanism:
        return self.kinematics.structure.mechanism


# a page or an analysis needs the motion, the reactions and the limits of one mechanism: it is made ready once
@kept_by_mechanism(32)
def ready(mechanism: Mechanism) -> Ready:
    """Make a mechanism ready to move.

    Raises
    ------
    InputError
        Drives and mobility differ, or the initial position does not assemble.
    NotComputedYet
        The description names what this version does not compute.
    """
    structure = structure_of(mechanism)
    path = path_of(mechanism, float(structure.dimensions.scale))
    kinematics = Kinematics(structure, structure.dimensions, path)
    if any(isinstance(group, Newton) for group in structure.groups):
        # before assembling, as groups of higher class would fail first and be reported instead
        refuse_surplus_drives(structure)
    assembled = assemble(kinematics)
    kinematics = replace(kinematics, numbers=assembled.numbers)
    mobility = _mobility(kinematics, assembled)
    return Ready(kinematics, assembled, mobility)


def _mobility(kinematics: Kinematics, assembled: Assembled) -> int:
    """Mobility by rank at real positions; refuse drives that differ from it."""
    structure = kinematics.structure
    # drives left out: mobility is that of the mechanism, and drives are compared with it
    free = [c for c in structure.constraints if not is_drive(c)]
    width = sum(entity.unknowns for entity in structure.unknowns)
    rank = 0
    looked: list[Positions] = []
    for at in _places(kinematics, assembled):
        looked.append(at)
        matrix = scaled_jacobian(free, structure.unknowns, kinematics.numbers, at)
        rank = max(rank, rank_of(matrix))
        # full rank with nothing redundant cannot grow, so the search of other positions is spared
        if rank == matrix.shape[0] and not structure.redundant:
            break  # it cannot be greater anywhere
    mobility = width - rank
    # the greatest rank counts: dead points and change points have less
    if mobility != structure.drives:
        raise InputError(
            "[[drives]]",
            drives_against_mobility(structure.drives, mobility),
            _("give as many drives as the mobility"),
        )
    for at in looked:
        _check_redundant(kinematics, at)
    return mobility


def _places(kinematics: Kinematics, assembled: Assembled) -> Iterator[Positions]:
    """The initial position, then some next to it that close, past change points on the branch that goes on."""
    yield assembled.positions
    path = kinematics.path
    looks = path.initial + path.unit * np.array(LOOKS)
    mesh = mesh_of(path, looks)
    branches = branches_at_start(path, assembled.signs, assembled.angles, smooth=True)
    continuation = BranchedPlan(kinematics, branches, assembled.positions, kinematics.numbers)
    # signs and change points have to be known to go on past them
    EventScan(continuation, mesh).run()
    # nodes of the mesh next to the places wanted: there everything has been looked at
    nodes = mesh[np.argmin(np.abs(mesh[:, None] - looks), axis=0)]
    with np.errstate(all="ignore"):
        there = kinematics.positions(ARRAYS, nodes[None, :], continuation.hooks(ARRAYS, nodes[None, :], None))
    for k in range(len(nodes)):
        at = there.map_numbers(lambda x, k=k: float(np.broadcast_to(x, (1, len(nodes)))[0, k]))  # type: ignore[misc]
        vectors = [*at.points.values(), *(vector for pose in at.poses.values() for vector in pose)]
        if all(np.isfinite(x) for vector in vectors for x in vector):
            yield at


def _check_redundant(kinematics: Kinematics, at: Positions) -> None:
    """A redundant constraint must also hold elsewhere, or the mechanism does not move at all."""
    redundant = kinematics.structure.redundant
    residuals = {c.label: value for c, value in residuals_at(redundant, kinematics.numbers, at).items()}
    for label, value in (residuals | length_misfits(kinematics, at)).items():
        if value > RESIDUAL_TOLERANCE:
            raise InputError(
                label,
                _("it holds in the initial position only, so the mechanism cannot move"),
                _("correct the dimensions, or remove the constraint"),
            )
