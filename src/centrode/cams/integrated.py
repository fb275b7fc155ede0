"""The path by an integrator that knows nothing of series: along the arc, where nothing is singular."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from importlib import import_module
from typing import Any

import numpy as np
from numpy.typing import NDArray

from centrode.cams.asked import check_start
from centrode.cams.curvature_laws import CurvatureLaw
from centrode.cams.lawful import check_span, refusal, unlawful_place
from centrode.cams.path import StatePath
from centrode.errors import InputError
from centrode.locale import _

Array = NDArray[np.float64]

_integrate = partial(import_module, "scipy.integrate")  # off the cold path

TOLERANCE = 2.3e-14
"""The least relative error that the integrator can be asked for."""

LONGEST_STEP = 0.02
"""Over rho and over the radius of curvature: the polynomials between the steps are of a lower order than these."""

NEWTON = 30
MOST_TURNINGS = 100.0
"""Length of the path over rho0 times the range, beyond which it is given up."""


@dataclass(frozen=True)
class Leg:
    """A stretch of the path between two breaks of the law.

    Attributes
    ----------
    low, high : float [rad]
        Its angles.
    arcs, angles : (n) [m], [rad]
        Arcs of the integrator's steps and the angles there, growing.
    solution : callable of arcs (n) -> (3, n)
        phi, rho, gamma.
    """

    low: float
    high: float
    arcs: Array
    angles: Array
    solution: Any


@dataclass(frozen=True)
class IntegratedPath(StatePath):
    """A roller path by the Runge-Kutta method of Dormand and Prince of order 8 on phi, rho and gamma by the arc.

    Made by `integrated_path`.
    """

    law: CurvatureLaw
    start: float
    stop: float
    legs: tuple[Leg, ...]
    stall: float | None = None

    def state(self, phi: Array) -> tuple[Array, Array, Array]:
        """Radius [m], sin(gamma), cos(gamma) at places inside the path."""
        places = np.atleast_1d(np.asarray(phi, dtype=np.float64))
        found = np.full((3, *places.shape), np.nan)
        for leg in self.legs:
            here = (places >= leg.low) & (places <= leg.high)
            if here.any():
                _angles, radius, gamma = _at(leg, places[here])
                found[:, here] = radius, np.sin(gamma), np.cos(gamma)
        return tuple(found.reshape(3, *np.shape(phi)))


def integrated_path(
    law: CurvatureLaw,
    rho0: float,
    gamma0: float = 0.0,
    start: float = 0.0,
    stop: float = math.pi / 2,
    tolerance: float = TOLERANCE,
) -> IntegratedPath:
    """The path of a roller's centre by integration of `phi' = cos(gamma)/rho, rho' = sin(gamma), gamma' = phi' - K`.

    Parameters
    ----------
    law, rho0, gamma0, start, stop
        As `expanded_path`.
    tolerance : float
        Relative error a step may make.

    Raises
    ------
    InputError
        As `expanded_path`.
    """
    check_start(rho0, gamma0, start, stop)
    check_span(law, start, stop)
    first = np.array([0.0, rho0, gamma0])
    ahead, stalled = _march(law, first, stop, 1, tolerance)
    behind, stuck = _march(law, first, start, -1, tolerance)
    legs = (*reversed(behind), *ahead)
    stall = stalled if stalled is not None else stuck
    return IntegratedPath(law, legs[0].low, legs[-1].high, legs, stall)


def _march(
    law: CurvatureLaw, first: Array, stop: float, sense: int, tolerance: float
) -> tuple[list[Leg], float | None]:
    if stop == 0.0:
        return [], None
    wrong = unlawful_place(law, stop)
    end = stop if wrong is None else wrong
    ends = sorted({end, *(b for b in law.breaks if 0 < sense * b < sense * end)}, key=abs)
    legs: list[Leg] = []
    place = first
    for target in ends:
        leg, place, stalled = _leg(law, place, target, sense, tolerance)
        legs.append(leg)
        if stalled:
            return legs, float(place[0])
    if wrong is not None:
        raise refusal(law, wrong)
    return legs, None


def _leg(
    law: CurvatureLaw, place: Array, target: float, sense: int, tolerance: float
) -> tuple[Leg, Array, bool]:
    """One leg, the state at its end, and whether the follower stalls there."""

    def rates(_arc: float, y: Array) -> tuple[float, float, float]:
        # beyond its end the leg's law stays what it is there: only the last step, which is cut, gets to see it
        phi = min(y[0], target) if sense > 0 else max(y[0], target)
        curvature = float(law.series(phi, 0, sense if phi != target else -sense)[0])
        turn = math.cos(y[2]) / y[1]
        return sense * turn, sense * math.sin(y[2]), sense * (turn - curvature)

    def arrives(_arc: float, y: Array) -> float:
        return float(y[0] - target)

    def stalls(_arc: float, y: Array) -> float:
        return math.cos(y[2])

    arrives.terminal = stalls.terminal = True  # type: ignore[attr-defined]
    scales = [1.0, place[1], 1.0]
    longest = LONGEST_STEP * min(place[1], 1.0 / float(law.series(place[0], 0, sense)[0]))
    # cos(gamma) is the rate of phi: a path of this length has turned by the whole range long ago, or stalled
    most = MOST_TURNINGS * place[1] * max(1.0, abs(target - place[0]))
    found = _integrate().solve_ivp(
        rates, (0.0, most), place, "DOP853", None, True, (arrives, stalls),
        rtol=tolerance, atol=[tolerance * scale for scale in scales], max_step=longest,
    )  # fmt: skip
    if found.status != 1:
        what = _("the integration ends at {angle:.6g} deg").format(angle=math.degrees(found.y[0, -1]))
        raise InputError("[curvature]", what, _("shorten the range"))
    stalled = bool(len(found.t_events[1]))
    last = np.array(found.y_events[1][0] if stalled else found.y_events[0][0])
    if not stalled:
        last[0] = target
    angles = np.append(found.y[0, :-1], last[0])
    order = slice(None, None, sense)
    low, high = sorted((float(place[0]), float(last[0])))
    return Leg(low, high, found.t[order], angles[order], found.sol), last, stalled


def _at(leg: Leg, phi: Array) -> Array:
    """phi, rho, gamma (3, n) where the angle is phi, by Newton's method on the arc."""
    arc = np.interp(phi, leg.angles, leg.arcs)
    low, high = float(np.min(leg.arcs)), float(np.max(leg.arcs))
    ascending = leg.arcs[-1] >= leg.arcs[0]
    for _step in range(NEWTON):
        angle, radius, gamma = leg.solution(arc)
        rate = np.cos(gamma) / radius * (1.0 if ascending else -1.0)
        with np.errstate(all="ignore"):
            step = np.where(rate > 0 if ascending else rate < 0, (angle - phi) / rate, 0.0)
        moved = np.clip(arc - step, low, high)
        if np.all(np.abs(moved - arc) <= 1e-16 * high):
            break
        arc = moved
    return np.asarray(leg.solution(arc))
