"""Flywheel and speed as courses compute them: the links' energy at the mean speed, first order in the fluctuation.

J_I = (max dT - min dT) / (omega_m^2 delta) with dT = W - J_II omega_m^2 / 2, and omega = omega_m + (dT - (max dT +
min dT) / 2) / (omega_m J_I). Source: the coursework of the example six-bar-press (N. I. Mertsalov's method).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from centrode.dynamics.steady_motion.cycle import Array
from centrode.dynamics.steady_motion.speed import EnergyBalance
from centrode.numerics.search import Extremes, extremes


@dataclass(frozen=True)
class SpeedBySource:
    """The speed of the drive by the formulas above.

    Attributes
    ----------
    balance : EnergyBalance
    energies : Extremes [J]
        Of the change of energy of group I.
    mean : float [rad/s]
    inertia : float [kg m^2]
    """

    balance: EnergyBalance
    energies: Extremes
    mean: float
    inertia: float

    def at(self, turned: Array) -> Array:
        """Speeds [rad/s] at angles turned."""
        middle = 0.5 * (self.energies.greatest + self.energies.least)
        change = self.balance.energy_change(turned, self.mean**2)
        return self.mean + (change - middle) / (self.mean * self.inertia)

    def acceleration(self, turned: Array) -> Array:
        """Accelerations [rad/s^2]: of the energy equation at these speeds."""
        carried = self.inertia + self.balance.cycle.inertia.at(turned)
        return self.balance.resultant(turned, self.at(turned) ** 2) / carried

    def time(self, turned: Array) -> Array:
        """Time [s] from the beginning of the cycle."""
        panels = self.balance.cycle.panels
        return panels.series(1.0 / self.at(panels.nodes)).integral(turned)

    def extremes(self) -> Extremes:
        """Least and greatest speed."""
        return extremes(
            self.at,
            lambda turned: self.balance.resultant(turned, self.mean**2),
            self.balance.cycle.panels.ends_and_nodes,
        )


def needed_by_source(energies: Extremes, mean: float, fluctuation: float) -> float:
    """J_I [kg m^2] for a coefficient of fluctuation."""
    return float(energies.range / (np.square(mean) * fluctuation))
