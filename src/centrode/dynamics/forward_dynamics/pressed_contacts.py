"""Friction by coefficients of a description as contacts of a free motion, pressed by the reactions of their joints."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.forward_dynamics.contacts import (
    FREE,
    FRICTION,
    Contact,
    ContactMode,
    JointPressing,
    pressed_numbers,
)
from centrode.dynamics.forward_dynamics.equations_of_motion import EquationsOfMotion
from centrode.dynamics.forward_dynamics.initial_position import (
    equation_units,
    residuals_and_rows,
    units_of,
)
from centrode.dynamics.forward_dynamics.joint_openings import JointOpening
from centrode.dynamics.kinetostatics.friction import HingeBearing, Sliding
from centrode.dynamics.kinetostatics.friction import contacts_of as rubbing_contacts_of
from centrode.errors import InputError, NotComputedYet
from centrode.locale import _
from centrode.model.loads import BearingFriction
from centrode.model.mechanism import Mechanism
from centrode.numerics.arrays import ARRAYS
from centrode.structure.constraints import NoTurning, PointInLink, PointOnGuide

Array: TypeAlias = npt.NDArray[np.float64]

RANK = 1e-9
"""A singular value below this share of the greatest counts as none."""
DETERMINED = 1e-7
"""A reaction that a state of stress changes by less than this share of it is determined."""


def pressed_contacts_of(mechanism: Mechanism) -> tuple[Contact, ...]:
    """Contacts with friction by a coefficient, in the order of the loads.

    Raises
    ------
    InputError, NotComputedYet
        As `kinetostatics.friction.contacts_of` does; hinges of mechanisms with pairs of gears, whose teeth press
        the axes apart.
    """
    _refuse_radial_forces(mechanism)
    return tuple(
        Contact(
            FRICTION,
            rubbing.label,
            rubbing.motion,
            drift=0.0 if isinstance(rubbing, HingeBearing) else rubbing.surface_speed,
            pressing=_pressing_of_hinge(rubbing)
            if isinstance(rubbing, HingeBearing)
            else _pressing_of_guide(mechanism, rubbing),
        )
        for rubbing in rubbing_contacts_of(mechanism)
    )


def _refuse_radial_forces(mechanism: Mechanism) -> None:
    if not any(gear.pair is not None for gear in mechanism.gears):
        return
    for load in mechanism.loads:
        if isinstance(load, BearingFriction):
            what = _("radial forces of teeth press hinges, and simulations do not know them")
            repair = _("give the gear by its ratio, or the value of the friction")
            raise NotComputedYet(f"[[loads]] {load.label}", what, repair)


def _pressing_of_hinge(bearing: HingeBearing) -> JointPressing:
    joint = PointInLink(bearing.point, bearing.link)
    return JointPressing(
        (JointOpening(joint, "x"), JointOpening(joint, "y")),
        bearing.coefficient * bearing.radius,
        bearing.static * bearing.radius,
    )


def _pressing_of_guide(mechanism: Mechanism, sliding: Sliding) -> JointPressing:
    guide = mechanism.guide(sliding.guide)
    openings = [JointOpening(PointOnGuide(guide.point, guide.id, guide.on), "across")]
    if sliding.link is not None and sliding.length:
        openings.append(JointOpening(NoTurning(sliding.link, guide.id, guide.on), "turn"))
    return JointPressing(tuple(openings), sliding.coefficient, sliding.static, sliding.length, sliding.height)


def refuse_undetermined_presses(equations: EquationsOfMotion, coordinates: Array) -> None:
    """Raise InputError where friction depends on a reaction that redundant constraints leave open.

    `coordinates` (coordinates) [rad or m] are those of a position that closes.
    """
    pressed = pressed_numbers(equations.contacts)
    if not pressed or not equations.dependent:
        return
    starts = {kept.name: float(kept.driven.initial) for kept in equations.kept}
    _left, rows = residuals_and_rows(
        equations.tree, equations.numbers, equations.constraints, coordinates, starts
    )
    units = equation_units(equations.constraints, equations.numbers)
    left, sizes, _right = np.linalg.svd(rows * units_of(equations.tree, equations.numbers) / units[:, None])
    null = left[:, int(np.sum(sizes > RANK * max(sizes, default=1.0))) :] / units[:, None]
    still = [0.0] * equations.size
    terms = equations.terms(
        ARRAYS, equations.tree.values(ARRAYS, list(coordinates)), still, 0.0, _free_modes(equations)
    )
    for number in pressed:
        for opening in terms.openings[number]:
            row = np.zeros(equations.equations)
            for k, x in opening.rows.items():
                if k < len(row):
                    row[k] = float(x)
            if np.max(np.abs(row @ null), initial=0.0) > DETERMINED * np.max(np.abs(null), initial=0.0):
                label = equations.contacts[number].label
                what = _("friction at {contact} depends on a reaction that the constraints do not determine")
                repair = _("omit a redundant constraint, or the friction there")
                raise InputError(f"[[loads]] {label}", what.format(contact=label), repair)


def _free_modes(equations: EquationsOfMotion) -> Sequence[ContactMode]:
    return [FREE] * len(equations.contacts)
