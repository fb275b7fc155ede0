"""Where two curves of a group of higher class meet: a change point, told from a near miss.

At a change point the equations are dependent, parameter included. Seen along the two directions in which they
tell least, the worst equation has a saddle there; its value at the saddle is to a group of higher class what the
radicand is to a dyad: zero within its rounding error at a change point, anything else a near miss (Golubitsky
and Schaeffer, Singularities and Groups in Bifurcation Theory I, 1985, chapter 1).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.jets import Jet
from centrode.algebra.rounding import ROUNDED, SAFETY, Rounded
from centrode.kinematics.higher_class.bordering import bordered, motion_along
from centrode.kinematics.higher_class.curves import Places, Reached, quintic
from centrode.kinematics.higher_class.surroundings import Surroundings
from centrode.kinematics.higher_class.system import Motion, total
from centrode.kinematics.paths import JETS

Array: TypeAlias = npt.NDArray[np.float64]
Lanes: TypeAlias = npt.NDArray[np.intp]

STEPS = 20
GREATEST = 0.05
"""Greatest step towards a saddle, in rad or in the greatest length."""
SMALL = 1e-11
"""A saddle is flat: its value is exact to the square of this."""
NEAR = 3.0
"""How many arcs away from its beginning a crossing may lie to belong to it."""


@dataclass
class _Saddle:
    """A place on its way to the saddle: one lane."""

    around: Surroundings
    lane: Lanes
    parameter: Array
    state: Array

    def approach(self) -> tuple[float, bool]:
        """Step towards the saddle; returns the size of the step and whether it is one."""
        system, linear, moved, rest, follow, matrix = bordered(
            self.around, self.lane, self.parameter, self.state, None
        )
        left, values, right = np.linalg.svd(matrix[0])
        least, plane = left[:, -1], right[-2:]
        bends = [self._bend(least, d) for d in (plane[0], plane[1], plane[0] + plane[1])]
        mixed = 0.5 * (bends[2] - bends[0] - bends[1])
        hessian = np.array([[bends[0], mixed], [mixed, bends[1]]])
        inside = -np.linalg.solve(hessian, plane @ matrix[0].T @ least)
        back = right[: len(values) - 1].T @ ((left[:, :-1].T @ rest[0]) / values[:-1])
        step = plane.T @ inside + back
        size = float(np.max(np.abs(step)))
        step *= min(1.0, GREATEST / size)
        self.state = system.moved(self.state, motion_along(linear, moved, follow, step[None, :]))
        self.parameter = self.parameter + self.around.unit * step[-1]
        return size, bool(np.linalg.det(hessian) < 0.0)

    def _bend(self, least: Array, direction: Array) -> float:
        """Second derivative of the worst equation in a direction of the curve's coordinates."""
        system, linear, _moved, _rest, follow, _matrix = bordered(
            self.around, self.lane, self.parameter, self.state, None
        )
        zero = np.zeros(1)
        still = {entity: (0.0,) * entity.unknowns for entity in follow}
        one = motion_along(linear, still, follow, direction[None, :])
        shifts = {e: tuple(Jet((zero, x, zero)) for x in shift) for e, shift in one.shifts.items()}
        straight = Motion(shifts, [Jet((zero, x, zero)) for x in one.free])
        ahead = Jet((self.parameter, zero + self.around.unit * direction[-1], zero))
        known = self.around.known(ahead, self.lane)
        values = system.residual(JETS, system.at(JETS, known, self.state, straight))
        _moved, rest = linear.reduced([x.coefficients[2] if isinstance(x, Jet) else 0.0 for x in values])
        return 2.0 * float(least @ system.stacked(rest)[0])

    def value(self) -> tuple[float, float]:
        """The worst equation's value with the bound of its rounding error."""
        system, linear, _moved, rest, _follow, matrix = bordered(
            self.around, self.lane, self.parameter, self.state, None
        )
        least = np.linalg.svd(matrix[0])[0][:, -1]
        known = self.around.bounded(self.parameter, self.lane)
        values = system.residual(ROUNDED, system.at(ROUNDED, known, self.state))
        _moved, bounds = linear.reduced([Rounded(np.zeros(1), Rounded.of(x).bound) for x in values])
        bound = float(np.abs(least) @ np.array([float(np.max(Rounded.of(x).bound)) for x in bounds]))
        return float(least @ rest[0]), bound


def crossing(around: Surroundings, lane: Lanes, base: Places, there: Reached) -> float | None:
    """The parameter at which curves cross between two places; None if they do not."""
    share = float(np.clip(base.size[0] / (base.size[0] - there.places.size[0]), 0.0, 1.0))
    middle = total(quintic(base, there) * share ** np.arange(6)[:, None])
    system = around.blank(lane)
    state = system.righted(middle[:, :-1])
    saddle = _Saddle(around, lane, base.parameter + middle[:, -1], state)
    try:
        with np.errstate(all="ignore"):
            for _step in range(STEPS):
                size, crosses = saddle.approach()
                if not size > SMALL:
                    break
            value, bound = saddle.value()
    except np.linalg.LinAlgError:
        return None
    parameter = float(saddle.parameter[0])
    away = abs(parameter - float(base.parameter[0])) / around.unit
    met = crosses and size <= 1e-7 and away <= NEAR * float(there.arc[0]) and abs(value) <= SAFETY * bound
    return parameter if met else None
