"""Energies over a cycle: work of the loads and of the drive, and the speed that follows from them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias, get_args

import numpy as np

from centrode.dynamics.steady_motion.cycle import Array, Cycle, MomentShape, PanelSeries
from centrode.errors import InputError
from centrode.locale import _
from centrode.numerics.search import Extremes, extremes, root

MeanSpeed: TypeAlias = Literal["middle", "time"]
MEANS = get_args(MeanSpeed)
"""What a mean speed is: half of greatest plus least, or the mean in time (turns over time)."""

ROUNDING = 64 * float(np.finfo(np.float64).eps)


@dataclass(frozen=True)
class EnergyBalance:
    """A cycle with a drive whose work makes up for that of the loads.

    Attributes
    ----------
    cycle : Cycle
        With loads at the speeds in question.
    driving : PanelSeries [N m]
        Moment of the drive, positive where it drives.
    total : PanelSeries [N m]
        Of drive and loads; its integral over the cycle is 0.
    """

    cycle: Cycle
    driving: PanelSeries
    total: PanelSeries

    @property
    def work_of_loads(self) -> float:
        """Work [J] of all loads and weights over the cycle; negative where they resist."""
        return self.cycle.moment.total

    @property
    def driving_moment(self) -> float:
        """Mean moment [N m] of the drive."""
        return self.driving.total / self.cycle.period

    @property
    def error(self) -> float:
        """Bound [J] of the error of the works, from the series and from rounding."""
        panels = self.cycle.panels
        values = np.abs(self.cycle.moment.at(panels.nodes))
        return self.cycle.moment.error + ROUNDING * float(np.sum(panels.weights * values))

    def resultant(self, turned: Array, squares: Array | float) -> Array:
        """Moment [N m] of drive and loads less what the links' inertia takes at a square of the speed."""
        return self.total.at(turned) - 0.5 * squares * self.cycle.slope.at(turned)

    def energy_change(self, turned: Array, square: float) -> Array:
        """Work of drive and loads less the energy of the links [J] at a constant square of the speed."""
        return self.total.integral(turned) - 0.5 * square * self.cycle.inertia.at(turned)

    def energy_extremes(self, square: float) -> Extremes:
        """Extremes of `energy_change`."""
        return extremes(
            lambda turned: self.energy_change(turned, square),
            lambda turned: self.resultant(turned, square),
            self.cycle.panels.ends_and_nodes,
        )


def balance_of(cycle: Cycle, shape: MomentShape | None, speed: Array) -> EnergyBalance:
    """The drive that balances the loads of a cycle.

    Parameters
    ----------
    shape : MomentShape, optional
        How the driving moment goes; a factor makes its work that of the loads. Constant if left out.
    speed : (nodes) [rad/s]

    Raises
    ------
    InputError
        The loads drive the machine, or the shape does no work.
    """
    panels, needed = cycle.panels, -cycle.moment.total
    magnitude = float(np.sum(panels.weights * np.abs(cycle.moment.at(panels.nodes))))
    # resisting loads do negative work; what is positive beyond rounding drives
    if needed < -1e-9 * magnitude:
        raise InputError(
            "[[loads]]",
            _("over the cycle the loads do work of {work:.6g} J: they drive the machine").format(
                work=-needed
            ),
            _("reverse their signs, or add the resistance that takes up this work"),
        )
    values = np.ones(len(panels.nodes)) if shape is None else shape.at(cycle.value(panels.nodes), speed)
    given = float(np.sum(panels.weights * values))
    if not given > 1e-6 * float(np.sum(panels.weights * np.abs(values))):
        raise InputError(
            "[machine] driving",
            _("the driving moment does no work over the cycle"),
            _("give a driving moment with a positive mean"),
        )
    # the drive does the work of the loads over the cycle, so that the speed comes back
    driving = panels.series(values * (needed / given))
    total = panels.series(cycle.moment.at(panels.nodes) + driving.at(panels.nodes))
    return EnergyBalance(cycle, driving, total)


# The speed of a machine over its cycle by the energy equation, without approximation.
#
# (J_I + J_II) omega^2 / 2 = E + W, with E the energy at the beginning and W the work of drive and loads. So
# at a speed omega the line with slope omega^2 / 2 through the point (J_II, W) cuts off -E + omega^2 J_I / 2:
# of all lines with the slope of the greatest speed the uppermost one touches the diagram of (J_II, W) there,
# of those of the least speed the lowermost one. Source: F. Wittenbauer, Graphische Dynamik, Berlin 1923;
# energies and inertia of a machine as in I. I. Artobolevskii, Theory of Mechanisms and Machines.


@dataclass(frozen=True)
class Speed:
    """The speed of the drive over a cycle.

    Attributes
    ----------
    balance : EnergyBalance
    inertia : float [kg m^2]
        J_I, of what turns with the drive at a constant ratio.
    energy : float [J]
        At the beginning of the cycle, all links together.
    """

    balance: EnergyBalance
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

    def mean(self, kind: MeanSpeed) -> float:
        """Mean speed [rad/s]: half of greatest plus least ("middle"), or turns over time ("time")."""
        if kind == "middle":
            extremes = self.extremes()
            return 0.5 * (extremes.least + extremes.greatest)
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


def tangents(balance: EnergyBalance, greatest: float, least: float) -> Tangents:
    """The tangents of the greatest and the least speed [rad/s]."""
    # W - omega^2 J / 2 is greatest, or least, where the line of that slope touches the diagram
    upper, lower = balance.energy_extremes(greatest**2), balance.energy_extremes(least**2)
    return Tangents(
        0.5 * greatest**2, upper.greatest, upper.at_greatest, 0.5 * least**2, lower.least, lower.at_least
    )


def with_fluctuation(
    balance: EnergyBalance, mean: float, fluctuation: float, kind: MeanSpeed
) -> tuple[Speed, Tangents]:
    """The speed with a mean [rad/s] and a coefficient of fluctuation, (greatest - least) / mean.

    The inertia of the result may be negative: then none is needed.
    """
    # greatest and least lie half the fluctuation either side of the middle
    spread = 0.5 * fluctuation * mean

    def about(middle: float) -> tuple[Speed, Tangents]:
        result = tangents(balance, middle + spread, middle - spread)
        return Speed(balance, result.inertia, result.energy), result

    result = about(mean)
    if kind == "middle" or not result[0].inertia > 0.0:
        return result

    def excess(middle: float) -> float:
        return about(middle)[0].mean("time") - mean

    # the mean in time lies between the extremes: at most half their distance from the middle
    least = max(mean - spread, spread * (1.0 + 1e-6))
    return about(root(excess, least, mean + spread))


def with_inertia(balance: EnergyBalance, mean: float, inertia: float, kind: MeanSpeed) -> Speed:
    """The speed with a mean [rad/s] and an inertia J_I [kg m^2]; raises InputError where it would not last."""
    cycle = balance.cycle
    carried = extremes(
        lambda turned: inertia + cycle.inertia.at(turned), cycle.slope.at, cycle.panels.ends_and_nodes
    )
    if not carried.least > 0.0:
        raise InputError(
            "[machine]",
            _("the reduced moment of inertia is {inertia:.6g} kg·m²: it must be positive").format(
                inertia=carried.least
            ),
            _("give masses, [[machine.shafts]] with inertia, or fluctuation"),
        )
    # with no speed the links take no energy: how much the work alone swings
    swing = balance.energy_extremes(0.0)

    def excess(energy: float) -> float:
        return Speed(balance, inertia, energy).mean(kind) - mean

    least = -swing.least  # at this energy the machine stands still once a cycle
    # just above standing still the mean in time is infinitely slow: the bracket begins a hair above that
    margin = 1e-9 * (swing.range + carried.greatest * mean**2)
    if excess(least + margin) > 0.0:
        raise InputError(
            "[machine]",
            _(
                "a moment of inertia of {inertia:.6g} kg·m² is too small: the machine would stop within the cycle"
            ).format(inertia=inertia),
            _("give [[machine.shafts]] with more inertia, or fluctuation to find a flywheel"),
        )
    # at this energy the slowest speed of the cycle is greater than the mean that is sought
    greatest = least + margin + 2.0 * carried.greatest * mean**2 + swing.range
    return Speed(balance, inertia, root(excess, least + margin, greatest))
