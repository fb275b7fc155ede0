"""The closing balance of a machine: balancing moment of its links and inertia moment of its flywheel drive it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from centrode.dynamics.kinetostatics.reactions import reactions
from centrode.dynamics.steady_motion.machine import MachineResults


@dataclass(frozen=True)
class ClosingBalance:
    """links + inertia * acceleration = driving, at one place of the cycle; moments in the sense of the drive.

    Attributes
    ----------
    at : value of the drive [rad]
    links : balancing moment of the links, by the equilibrium of each of them at the real speed [N m]
    inertia : of what turns with the drive, the flywheel among it [kg m^2]
    acceleration : of the drive [rad/s^2]
    driving : moment of the motor, by the work over the cycle [N m]
    """

    at: float
    links: float
    inertia: float
    acceleration: float
    driving: float

    @property
    def difference(self) -> float:
        """Left side less right side [N m]."""
        return self.links + self.inertia * self.acceleration - self.driving


def closing_balance(results: MachineResults) -> ClosingBalance:
    """The balance at the first instant of the description, else where the drive accelerates most.

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
    # of one motion all four: another meaning of the mean speed has another speed here
    here = reactions(results.mechanism, at=[at], motion="real", friction=False)
    return ClosingBalance(
        at,
        float(here["moment_of_links"].values[0]),
        float(here.attrs["inertia"]),
        float(here["drive_acceleration"].values[0]),
        float(here["driving_moment"].values[0]),
    )
