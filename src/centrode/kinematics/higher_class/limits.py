"""Limits of a group of higher class: places of its curve at which the path's parameter turns back."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.rounding import ROUNDED, SAFETY, Rounded
from centrode.kinematics.higher_class.bordering import bordered
from centrode.kinematics.higher_class.curves import Places, Reached, quintic, reach
from centrode.kinematics.higher_class.surroundings import Surroundings
from centrode.kinematics.higher_class.system import total

Array: TypeAlias = npt.NDArray[np.float64]
Lanes: TypeAlias = npt.NDArray[np.intp]

STEPS = 30
"""Most Newton steps along the curve to a limit, from where the polynomial between two places turns back."""
SMALL = 1e-8
"""After a step this small, in the arc between the two places, the next is below rounding."""
LONGEST = 0.1
"""Greatest such step, in the arc between the two places."""
LEAST_MARGIN = 8.0
"""Units of rounding of the parameter itself that a place may be away from a limit and still be the limit."""


@dataclass(frozen=True)
class Limits:
    """Limits reached from places, and by how much rounding may shift the parameter there."""

    reached: Reached
    margin: Array


def limits(around: Surroundings, lanes: Lanes, here: Places, there: Reached) -> Limits:
    """Limits between places and those reached beyond them."""
    whole = quintic(here, there)
    share = _first_turn(whole[:, :, -1])
    arrived = np.zeros(len(share), dtype=bool)
    for _step in range(STEPS):
        powers = share[:, None] ** np.arange(6)
        value = total(whole * powers[:, :, None])
        parameter = here.parameter + value[:, -1]
        state = around.blank(lanes).righted(value[:, :-1])
        limit = reach(around, lanes, here, here.along, parameter, state)
        with np.errstate(all="ignore"):
            change = -limit.first[:, -1] / (2.0 * limit.second[:, -1]) / there.arc
            change = np.where(np.isfinite(change), np.clip(change, -LONGEST, LONGEST), np.inf)
        if arrived.all():
            break
        share = np.where(arrived | np.isinf(change), share, share + change)
        arrived |= np.abs(change) <= SMALL
    limit.found[:] &= arrived
    return Limits(limit, _margin(around, lanes, limit.places))


def _first_turn(coefficients: Array) -> Array:
    """The first share in [0, 1] at which polynomials (k, 6) turn back."""
    found = np.full(len(coefficients), 0.5)
    for k, c in enumerate(coefficients):
        roots = np.polynomial.Polynomial(c).deriv().roots()
        real = np.sort(roots.real[np.abs(roots.imag) < 1e-6])
        inside = real[(real >= -1e-6) & (real <= 1.0 + 1e-6)]
        found[k] = inside[0] if len(inside) else 0.5
    return found


def _margin(around: Surroundings, lanes: Lanes, places: Places) -> Array:
    """By how much rounding of the equations may shift a limit along the path."""
    parameter, state = places.parameter, places.state
    system, linear, _moved, _rest, _follow, matrix = bordered(around, lanes, parameter, state, None)
    values = system.residual(ROUNDED, system.at(ROUNDED, around.bounded(parameter, lanes), state))
    zero = np.zeros(len(parameter))
    _moved, rest = linear.reduced([Rounded(zero, zero + Rounded.of(x).bound) for x in values])
    bounds = system.stacked([Rounded.of(x).bound for x in rest])
    with np.errstate(all="ignore"):
        # the combination of equations that does not feel the group's own motion there tells the parameter
        least = np.linalg.svd(np.where(np.isfinite(matrix), matrix, 0.0)[:, :, :-1])[0][:, :, -1]
        pushed = np.abs(total(least * matrix[:, :, -1]))
        shift = around.unit * total(np.abs(least) * bounds) / pushed
    spacing = LEAST_MARGIN * np.spacing(np.maximum(np.abs(parameter), 1e-3 * around.unit))
    return np.asarray(np.fmax(SAFETY * shift, spacing), dtype=np.float64)
