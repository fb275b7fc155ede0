"""SciPy's solvers on a leg: the derivatives of the states, and tolerances in the measures of the machine."""

from __future__ import annotations

from collections.abc import Callable
from math import isfinite
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import scipy.integrate

from centrode.dynamics.simulation.course import VALUE
from centrode.dynamics.simulation.field import CREEP, Field, Leg, without_value
from centrode.dynamics.simulation.rows import INERTIA
from centrode.dynamics.simulation.watching import Watch

Array: TypeAlias = npt.NDArray[np.float64]
State: TypeAlias = Array

SLOWEST = 1e-9
"""Part of a radian or a unit of length that the slowest drive of interest passes in the whole run."""


class Solvers:
    """Makes the solvers of one run; `watch` says whether they are to be stiff, `end` [s] is that of the run."""

    def __init__(self, field: Field, watch: Watch, end: float, tolerance: float) -> None:
        self.field, self.watch, self.end, self.tolerance = field, watch, end, tolerance
        # what would go no farther than this from beginning to end is rounding
        self.fastest = SLOWEST * field.tracks.unit / end if isfinite(end) else 0.0

    def rates(self, leg: Leg, begun: State) -> Callable[[float, State], State]:
        """Derivatives of the states on a leg; value and works count from its beginning."""
        field, course, first = self.field, self.watch.course, float(begun[VALUE])

        def rates(t: float, y: State) -> State:
            rate = float(y[1])
            forces = field.forces(leg, t, first + float(y[0]), rate or leg.sense * CREEP)
            course.evaluations += 1
            return np.array(
                [
                    rate,
                    forces.acceleration(rate),
                    forces.driving * rate,
                    forces.friction * rate,
                    forces.other * rate,
                ]
            )

        return rates

    def solver(
        self,
        rates: Callable[[float, State], State],
        t: float,
        y: State,
        begun: State,
        leg: Leg,
        end: float | None = None,
    ) -> Any:
        """SciPy's solver from a state on, up to a time; tolerances are in the measures of the machine."""
        forces = rates(t, y)
        if not np.isfinite(forces).all():
            raise without_value(t, float(begun[VALUE] + y[0]))
        unit = self.field.tracks.unit
        self.fastest = max(self.fastest, abs(float(y[1])), float(np.sqrt(0.02 * abs(forces[1]) * unit)))
        inertia = float(leg.rows(float(begun[VALUE] + y[0]))[INERTIA])
        energy = max(1e-300, inertia * self.fastest**2)
        scale = np.array([unit, 1e-2 * self.fastest or 1.0, energy, energy, energy])
        kind = scipy.integrate.Radau if self.watch.stiff else scipy.integrate.DOP853
        limit = self.end if end is None else end
        return kind(rates, t, y, limit, rtol=max(self.tolerance, 3e-14), atol=self.tolerance * scale)
