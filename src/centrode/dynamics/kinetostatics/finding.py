"""Reactions at the samples of a motion, as plain arrays with what they come from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.friction.contacts import Contact, refuse_undetermined
from centrode.dynamics.friction.following import Outcome
from centrode.dynamics.friction.losses import Powers
from centrode.dynamics.friction.parts import friction_parts, with_friction
from centrode.dynamics.friction.rubbing import Rubbed, rubbed
from centrode.dynamics.kinetostatics.acting import Outer, outer_of
from centrode.dynamics.kinetostatics.judging import Mask, reaction_status, undetermined_parts
from centrode.dynamics.kinetostatics.moving import Pace, rates_of
from centrode.dynamics.kinetostatics.results import reactions_of
from centrode.dynamics.kinetostatics.scheme import Scheme
from centrode.dynamics.kinetostatics.sides import Side, sides_of
from centrode.dynamics.kinetostatics.solution import Forces, Kinetostatics
from centrode.dynamics.kinetostatics.teeth import Teeth
from centrode.dynamics.reducer import Burden
from centrode.dynamics.states import State
from centrode.errors import InputError, Status
from centrode.kinematics.solve import Solved
from centrode.locale import _

Array: TypeAlias = npt.NDArray[np.float64]
GREATEST_MATRICES = 30_000_000
"""Numbers in all matrices of one result: with their inverses some 1 GB."""


@dataclass(frozen=True)
class WithFriction:
    """Friction with what it takes."""

    rubbed: Rubbed
    powers: Powers


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
    friction : friction by coefficients, where there is any
    """

    pace: Pace
    outer: Outer
    forces: Forces
    sides: tuple[Side, ...]
    parts: dict[str, Array]
    undetermined: dict[str, Mask]
    status: npt.NDArray[np.int8]
    friction: WithFriction | None = None


def find(solved: Solved, burden: Burden, pace: Pace, contacts: Sequence[Contact] = ()) -> Found:
    """Solve for all reactions at the samples of a motion of one mechanism.

    Raises InputError for a load without a finite amount, more samples than memory holds, or friction in a contact whose
    reaction nothing determines.
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
    found = Found(pace, outer, forces, sides, reactions_of(forces, sides), undetermined, status)
    return _with_friction(found, solved, burden, state, contacts) if contacts else found


def _with_friction(
    found: Found, solved: Solved, burden: Burden, state: State, contacts: Sequence[Contact]
) -> Found:
    """The same with friction, which is as great as the reactions that it changes make it."""
    refuse_undetermined(contacts, found.undetermined, found.sides, solved.ready.mechanism)
    useful = (found.status == Status.OK) | (found.status == Status.CUT_OFF)
    sizes = rubbed(state, found.forces, contacts, found.pace.acceleration, useful)
    without = found.outer
    outer = Outer(
        (*without.loads, *sizes.pulls), without.inertia, without.moment + sizes.moment, without.shares
    )
    forces = found.forces.system.forces(outer.pulls)
    parts = reactions_of(forces, found.sides)
    with_friction(parts, sizes, state)
    status = found.status.copy()
    status[sizes.solution.outcome == Outcome.LOCKED] = Status.SELF_LOCKING
    status[sizes.solution.outcome == Outcome.LOST] = Status.UNCONVERGED
    by_time = solved.ready.kinematics.path.by_time
    drives = parts["balancing"] * rates_of(solved, found.pace) if by_time else parts["balancing"]
    powers = Powers.of(drives, burden.loads, without.shares, without.moment, sizes, found.pace.moving.rate)
    parts |= friction_parts(sizes, powers, state.mechanism)
    return replace(
        found, outer=outer, forces=forces, parts=parts, status=status, friction=WithFriction(sizes, powers)
    )


def _check_size(scheme: Scheme, samples: int) -> None:
    most = GREATEST_MATRICES // (scheme.size * len(scheme.unknowns))
    if samples > most:
        what = _("reactions at {asked} positions were asked for").format(asked=samples)
        raise InputError(_("samples"), what, _("ask for at most {most} at once").format(most=most))
