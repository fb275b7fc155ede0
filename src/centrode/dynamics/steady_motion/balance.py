"""Energies over a cycle: work of the loads and of the drive, and the speed that follows from them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias, get_args

import numpy as np

from centrode.dynamics.steady_motion.cycle import Cycle
from centrode.dynamics.steady_motion.driving import Shape
from centrode.dynamics.steady_motion.quadrature import Array, Series
from centrode.errors import InputError
from centrode.locale import _
from centrode.numerics.search import Extremes, extremes

Mean: TypeAlias = Literal["middle", "time"]
MEANS = get_args(Mean)
"""What a mean speed is: half of greatest plus least, or the mean in time (turns over time)."""

ROUNDING = 64 * float(np.finfo(np.float64).eps)


@dataclass(frozen=True)
class Balance:
    """A cycle with a drive whose work makes up for that of the loads.

    Attributes
    ----------
    cycle : Cycle
        With loads at the speeds in question.
    driving : Series [N m]
        Moment of the drive, positive where it drives.
    total : Series [N m]
        Of drive and loads; its integral over the cycle is 0.
    """

    cycle: Cycle
    driving: Series
    total: Series

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


def balance_of(cycle: Cycle, shape: Shape | None, speed: Array) -> Balance:
    """The drive that balances the loads of a cycle.

    Parameters
    ----------
    shape : Shape, optional
        How the driving moment goes; a factor makes its work that of the loads. Constant if left out.
    speed : (nodes) [rad/s]

    Raises
    ------
    InputError
        The loads drive the machine, or the shape does no work.
    """
    panels, needed = cycle.panels, -cycle.moment.total
    magnitude = float(np.sum(panels.weights * np.abs(cycle.moment.at(panels.nodes))))
    if needed < -1e-9 * magnitude:
        raise InputError(
            "[[loads]]",
            _("over the cycle the loads do work of {work:.6g} J: they drive the machine").format(
                work=-needed
            ),
            _("turn their signs round, or add the resistance that takes this work up"),
        )
    values = np.ones(len(panels.nodes)) if shape is None else shape.at(cycle.value(panels.nodes), speed)
    given = float(np.sum(panels.weights * values))
    if not given > 1e-6 * float(np.sum(panels.weights * np.abs(values))):
        raise InputError(
            "[machine] driving",
            _("the driving moment does no work over the cycle"),
            _("give one that drives: its mean has to be positive"),
        )
    driving = panels.series(values * (needed / given))
    total = panels.series(cycle.moment.at(panels.nodes) + driving.at(panels.nodes))
    return Balance(cycle, driving, total)
