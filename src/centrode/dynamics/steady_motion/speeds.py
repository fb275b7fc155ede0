"""The speed of a machine over its cycle by the energy equation, without approximation.

(J_I + J_II) omega^2 / 2 = E + W, with E the energy at the beginning and W the work of drive and loads. So at a
speed omega the line with slope omega^2 / 2 through the point (J_II, W) cuts off -E + omega^2 J_I / 2: of all
lines with the slope of the greatest speed the uppermost one touches the diagram of (J_II, W) there, of those
of the least speed the lowermost one. Source: F. Wittenbauer, Graphische Dynamik, Berlin 1923; energies and
inertia of a machine as in I. I. Artobolevskii, Theory of Mechanisms and Machines.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from centrode.dynamics.steady_motion.balance import Balance, Mean
from centrode.dynamics.steady_motion.quadrature import Array
from centrode.errors import InputError
from centrode.locale import _
from centrode.numerics.search import Extremes, extremes, root


@dataclass(frozen=True)
class Speed:
    """The speed of the drive over a cycle.

    Attributes
    ----------
    balance : Balance
    inertia : float [kg m^2]
        J_I, of what turns with the drive at a constant ratio.
    energy : float [J]
        At the beginning of the cycle, all links together.
    """

    balance: Balance
    inertia: float
    energy: float

    def square(self, turned: Array) -> Array:
        """Squares of the speed [rad^2/s^2] at angles turned."""
        carried = self.inertia + self.balance.cycle.inertia.at(turned)
        return 2.0 * (self.energy + self.balance.total.integral(turned)) / carried

    def at(self, turned: Array) -> Array:
        """Speeds [rad/s] at angles turned; NaN where the energy does not last."""
        with np.errstate(invalid="ignore"):
            return np.sqrt(self.square(turned))

    def acceleration(self, turned: Array) -> Array:
        """Accelerations [rad/s^2] at angles turned."""
        carried = self.inertia + self.balance.cycle.inertia.at(turned)
        return self.balance.resultant(turned, self.square(turned)) / carried

    def extremes(self) -> Extremes:
        """Least and greatest speed."""
        return extremes(self.at, self.acceleration, self.balance.cycle.panels.ends_and_nodes)

    def time(self, turned: Array) -> Array:
        """Time [s] from the beginning of the cycle."""
        panels = self.balance.cycle.panels
        return panels.series(1.0 / self.at(panels.nodes)).integral(turned)

    def mean(self, kind: Mean) -> float:
        """Mean speed [rad/s]: half of greatest plus least ("middle"), or turns over time ("time")."""
        if kind == "middle":
            found = self.extremes()
            return 0.5 * (found.least + found.greatest)
        panels = self.balance.cycle.panels
        return self.balance.cycle.period / float(np.sum(panels.weights / self.at(panels.nodes)))


@dataclass(frozen=True)
class Tangents:
    """Two lines at the diagram of work over the links' inertia: W = `intercept` + `slope` J_II [J, rad^2/s^2].

    They touch it at `upper_at` and `lower_at` [rad turned], where the speed is greatest and least, and meet at
    J_II = -J_I.
    """

    upper_slope: float
    upper_intercept: float
    upper_at: float
    lower_slope: float
    lower_intercept: float
    lower_at: float

    @property
    def inertia(self) -> float:
        """J_I [kg m^2]; negative where the links alone keep the speed more even than asked."""
        return (self.upper_intercept - self.lower_intercept) / (self.upper_slope - self.lower_slope)

    @property
    def energy(self) -> float:
        """Energy [J] at the beginning of the cycle."""
        return self.upper_slope * self.inertia - self.upper_intercept


def tangents(balance: Balance, greatest: float, least: float) -> Tangents:
    """The tangents of the greatest and the least speed [rad/s]."""
    upper, lower = balance.energy_extremes(greatest**2), balance.energy_extremes(least**2)
    return Tangents(
        0.5 * greatest**2, upper.greatest, upper.at_greatest, 0.5 * least**2, lower.least, lower.at_least
    )


def with_fluctuation(balance: Balance, mean: float, fluctuation: float, kind: Mean) -> tuple[Speed, Tangents]:
    """The speed with a mean [rad/s] and a coefficient of fluctuation, (greatest - least) / mean.

    The inertia of the result may be negative: then none is needed.
    """
    spread = 0.5 * fluctuation * mean

    def about(middle: float) -> tuple[Speed, Tangents]:
        found = tangents(balance, middle + spread, middle - spread)
        return Speed(balance, found.inertia, found.energy), found

    found = about(mean)
    if kind == "middle" or not found[0].inertia > 0.0:
        return found

    def missed(middle: float) -> float:
        return about(middle)[0].mean("time") - mean

    # the mean in time lies between the extremes: at most half their distance from the middle
    least = max(mean - spread, spread * (1.0 + 1e-6))
    return about(root(missed, least, mean + spread))


def with_inertia(balance: Balance, mean: float, inertia: float, kind: Mean) -> Speed:
    """The speed with a mean [rad/s] and an inertia J_I [kg m^2]; raises InputError where it would not last."""
    cycle = balance.cycle
    carried = extremes(
        lambda turned: inertia + cycle.inertia.at(turned), cycle.slope.at, cycle.panels.ends_and_nodes
    )
    if not carried.least > 0.0:
        raise InputError(
            "[machine]",
            _("nothing carries the motion: the inertia is {inertia:.6g} kg m^2").format(
                inertia=carried.least
            ),
            _("give masses, [[machine.shafts]] with inertia, or fluctuation"),
        )
    swing = balance.energy_extremes(0.0)

    def missed(energy: float) -> float:
        return Speed(balance, inertia, energy).mean(kind) - mean

    least = -swing.least  # at this energy the machine stands still once a cycle
    margin = 1e-9 * (swing.range + carried.greatest * mean**2)
    if missed(least + margin) > 0.0:
        raise InputError(
            "[machine]",
            _(
                "an inertia of {inertia:.6g} kg m^2 is too little: the machine would stand still within the cycle"
            ).format(inertia=inertia),
            _("give [[machine.shafts]] with more inertia, or fluctuation to find a flywheel"),
        )
    greatest = least + margin + 2.0 * carried.greatest * mean**2 + swing.range
    return Speed(balance, inertia, root(missed, least + margin, greatest))
