"""The closing balance of a machine: balancing moment of its links and inertia moment of its flywheel drive it."""

from __future__ import annotations

import numpy as np
import xarray as xr

from centrode.dynamics.kinetostatics.reactions import reactions
from centrode.dynamics.steady_motion.machine import MachineResults


def closing_balance(results: MachineResults) -> xr.Dataset:
    """Reactions in the real motion at the first instant of the description, else where the drive accelerates most.

    Of that one sample `moment_of_links` + `inertia` * `drive_acceleration` is `driving_moment`, within the shares
    `driving_error` and `reaction_loss`; `driving_residual` is what is missing.

    Raises
    ------
    InputError, MotionError, NotComputedYet
        As `reactions`.
    """
    steady = results.steady
    if results.instants is not None:
        at = float(results.instants["drive_value"].values[0, 0])
    else:
        greatest = int(np.nanargmax(np.abs(steady["drive_acceleration"].values)))
        at = float(steady["drive_value"].values[greatest, 0])
    # of one motion all of it: another meaning of the mean speed has another speed here
    return reactions(results.mechanism, at=[at], motion="real", friction=False).isel(sample=0)
