"""What reactions are worth: where the equations are singular, and which reactions nothing determines."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.rounding import SAFETY
from centrode.dynamics.kinetostatics.results import reactions_of
from centrode.dynamics.kinetostatics.scheme import Unknown
from centrode.dynamics.kinetostatics.sides import Side
from centrode.dynamics.kinetostatics.solution import Forces, Kinetostatics
from centrode.errors import Status

Array: TypeAlias = npt.NDArray[np.float64]
Mask: TypeAlias = npt.NDArray[np.bool_]
Codes: TypeAlias = npt.NDArray[np.int8]
MOMENTS = ("guide_moment", "gear_moment", "balancing")
"""Reactions that may be moments: measured by the greatest length beside forces."""


def reaction_status(system: Kinetostatics, status: Codes) -> Codes:
    """The motion's statuses (n), and `singular` where rounding leaves no digit of the reactions."""
    found = status.copy()
    lost = system.inverse.useless[0]
    found[lost & ((status == Status.OK) | (status == Status.CUT_OFF))] = Status.SINGULAR
    return found


def undetermined_parts(
    system: Kinetostatics, sides: Sequence[Side], status: Codes, residual: float
) -> dict[str, Mask]:
    """Which entries of each reaction nothing determines, over all samples that are ok.

    Each equation that repeats others leaves a state of stress free: forces that balance among themselves. What any
    of them changes is not determined. `residual` is how well the equations repeat each other.
    """
    good = status == Status.OK
    found: dict[str, Mask] = {}
    if not good.any():
        return found
    condition = system.inverse.condition[0][good]
    noise = SAFETY * (system.inverse.loss[0][good] + condition * residual)
    for unknown in system.scheme.repeating:
        parts = _measured(reactions_of(_self_stress(system, unknown), sides), system.scale)
        greatest = np.max([_greatest(values[good]) for values in parts.values()], axis=0)
        for name, values in parts.items():
            bound = (noise * greatest).reshape(-1, *[1] * (values.ndim - 1))
            felt = (np.abs(values[good]) > bound).any(axis=0)
            found[name] = found.get(name, np.zeros_like(felt)) | felt
    return found


def _self_stress(system: Kinetostatics, unknown: Unknown) -> Forces:
    """All constraint forces that a unit of one repeating equation brings about."""
    multipliers = system.forces(system.pulls[unknown]).multipliers
    return Forces(system, {**multipliers, unknown: multipliers[unknown] + 1.0}, ())


def _measured(parts: Mapping[str, Array], scale: float) -> dict[str, Array]:
    return {
        name: values / scale if name in MOMENTS else np.nan_to_num(values) for name, values in parts.items()
    }


def _greatest(values: Array) -> Array:
    greatest: Array = np.abs(values).reshape(len(values), -1).max(axis=1)
    return greatest
