"""Reactions at the samples of a motion, as plain arrays with what they come from."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.kinetostatics.acting import Outer, outer_of
from centrode.dynamics.kinetostatics.judging import Mask, reaction_status, undetermined_parts
from centrode.dynamics.kinetostatics.moving import Pace
from centrode.dynamics.kinetostatics.results import reactions_of
from centrode.dynamics.kinetostatics.scheme import Scheme
from centrode.dynamics.kinetostatics.sides import Side, sides_of
from centrode.dynamics.kinetostatics.solution import Forces, Kinetostatics
from centrode.dynamics.kinetostatics.teeth import Teeth
from centrode.dynamics.reducer import Burden
from centrode.dynamics.states import State
from centrode.kinematics.solve import Solved

Array: TypeAlias = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Found:
    """Reactions of a motion.

    Attributes
    ----------
    pace : how the drive moved
    outer : loads and inertia
    forces : the solved equations
    parts : name -> reactions (samples, ...); of an undetermined one, one of the many that are possible
    undetermined : name -> mask (...) of reactions that nothing determines
    status : (samples)
    """

    pace: Pace
    outer: Outer
    forces: Forces
    sides: tuple[Side, ...]
    parts: dict[str, Array]
    undetermined: dict[str, Mask]
    status: npt.NDArray[np.int8]


def find(solved: Solved, burden: Burden, pace: Pace) -> Found:
    """Solve for all reactions at the samples of a motion of one planar mechanism."""
    prepared = solved.ready
    state = State.of(solved, pace.moving)
    scheme, teeth = Scheme.of(prepared.structure), Teeth.of(prepared.mechanism)
    system = Kinetostatics.of(scheme, prepared.kinematics.numbers, state, teeth)
    outer = outer_of(state, burden, pace.acceleration, np.isfinite(state.columns["angle"](0)[1]))
    forces, sides = system.forces(outer.pulls), sides_of(prepared.mechanism)
    status = reaction_status(system, solved.status[0])
    residual = float(np.nanmax(solved.residual, initial=0.0))
    undetermined = undetermined_parts(system, sides, status, residual)
    return Found(pace, outer, forces, sides, reactions_of(forces, sides), undetermined, status)
