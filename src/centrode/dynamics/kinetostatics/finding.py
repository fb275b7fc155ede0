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
from centrode.errors import InputError
from centrode.kinematics.solve import Solved
from centrode.locale import _

Array: TypeAlias = npt.NDArray[np.float64]
GREATEST_MATRICES = 30_000_000
"""Numbers in all matrices of one result: with their inverses some 1 GB."""


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
    """Solve for all reactions at the samples of a motion of one mechanism.

    Raises InputError for a load without a finite amount, or more samples than memory holds.
    """
    prepared = solved.ready
    scheme, teeth = Scheme.of(prepared.structure), Teeth.of(prepared.mechanism)
    _check_size(scheme, len(pace.acceleration))
    state = State.of(solved, pace.moving)
    system = Kinetostatics.of(scheme, prepared.kinematics.numbers, state, teeth)
    outer = outer_of(state, burden, pace.acceleration, state.exists)
    forces, sides = system.forces(outer.pulls), sides_of(prepared.mechanism)
    status = reaction_status(system, solved.status[0])
    residual = float(np.nanmax(solved.residual, initial=0.0))
    undetermined = undetermined_parts(system, sides, status, residual)
    return Found(pace, outer, forces, sides, reactions_of(forces, sides), undetermined, status)


def _check_size(scheme: Scheme, samples: int) -> None:
    most = GREATEST_MATRICES // (scheme.size * len(scheme.unknowns))
    if samples > most:
        what = _("reactions at {asked} positions were asked for").format(asked=samples)
        raise InputError(_("samples"), what, _("ask for at most {most} at once").format(most=most))
