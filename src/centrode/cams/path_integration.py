"""The path by an integrator that knows nothing of series: along the arc, where nothing is singular."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from importlib import import_module
from typing import Any

import numpy as np
from numpy.typing import NDArray

from centrode.cams.curvature_laws import CurvatureLaw, check_span, refusal, unlawful_place
from centrode.cams.roller_path import StatePath, check_start
from centrode.errors import InputError
from centrode.locale import _

Array = NDArray[np.float64]

_integrate = partial(import_module, "scipy.integrate")  # off the cold path

LEAST_TOLERANCE = 2.3e-14
"""The least relative error that may be requested of the integrator."""

LONGEST_STEP = 0.02
"""Greatest step of the integrator's variable: between the steps its polynomials are of a lower order."""

BEYOND = 12
"""Order to which the law of a leg is continued beyond its end."""

MOST_LOGARITHM = 200.0
"""Of rho over that of the leg's start, in a step that is tried and will be refused."""

MOST_NEWTON_STEPS = 30
MOST_ARC = 1000.0
"""The integrator's variable at which a leg is given up: the path circles without getting on."""


@dataclass(frozen=True)
class IntegrationLeg:
    """A stretch of the path between two breaks of the law.

    Attributes
    ----------
    low, high : float [rad]
        Its angles.
    scale : float [m]
        Rho where it begins.
    arcs, angles : (n) [1], [rad]
        The integrator's variable and phi at its steps; `angles` growing.
    solution : callable of arcs (n) -> (3, n)
        phi, ln(rho/scale), gamma.
    curvature : callable of angles (n) -> (n) [1/m]
        The leg's law, held at its ends.
    """

    low: float
    high: float
    scale: float
    arcs: Array
    angles: Array
    solution: Any
    curvature: Callable[[Array], Array]


@dataclass(frozen=True)
class IntegratedPath(StatePath):
    """A roller path by the Runge-Kutta method of Dormand and Prince of order 8 on phi, ln(rho), gamma along the arc.

    Made by `integrated_path`.
    """

    law: CurvatureLaw
    start: float
    stop: float
    legs: tuple[IntegrationLeg, ...]
    stall: float | None = None

    def state(self, phi: Array) -> tuple[Array, Array, Array]:
        """Radius [m], sin(gamma), cos(gamma) at places inside the path."""
        places = np.atleast_1d(np.asarray(phi, dtype=np.float64))
        states = np.full((3, *places.shape), np.nan)
        for leg in self.legs:
            here = (places >= leg.low) & (places <= leg.high)
            if here.any():
                _angles, growth, gamma = _solution_at(leg, places[here])
                states[:, here] = leg.scale * np.exp(growth), np.sin(gamma), np.cos(gamma)
        return tuple(states.reshape(3, *np.shape(phi)))


def integrated_path(
    law: CurvatureLaw,
    rho0: float,
    gamma0: float = 0.0,
    start: float = 0.0,
    stop: float = math.pi / 2,
    tolerance: float = LEAST_TOLERANCE,
) -> IntegratedPath:
    """The path of a roller's centre by integration along its arc.

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

    Notes
    -----
    `phi' = cos(gamma), ln(rho)' = sin(gamma), gamma' = cos(gamma) - rho K` by the integral of ds/rho, all divided by
    1 + rho K: then a unit of the variable is an angle, whatever turns faster.
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
) -> tuple[list[IntegrationLeg], float | None]:
    if stop == 0.0:
        return [], None
    wrong = unlawful_place(law, stop)
    end = stop if wrong is None else wrong
    # no step goes across a break: the integrator's order holds for smooth functions only
    ends = sorted({end, *(b for b in law.breaks if 0 < sense * b < sense * end)}, key=abs)
    legs: list[IntegrationLeg] = []
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
) -> tuple[IntegrationLeg, Array, bool]:
    """Leg of an integration, the state (3,) at its end, and whether the follower stalls there."""
    onwards = _beyond(law, target, sense)

    def curvature(angles: Array) -> Array:
        inside = np.clip(angles, min(place[0], target), max(place[0], target))
        return np.asarray(law.series(inside, 0, 1)[0])

    def rates(_arc: float, y: Array) -> tuple[float, float, float]:
        # the last step goes beyond the leg's end before it is cut there
        outside = y[0] - target
        inner = sense * outside < 0
        # a step that will be cut at the end has to see a smooth law behind it
        here = float(law.series(y[0], 0, sense)[0]) if inner else polynomial(onwards, outside)
        # rho grows without bounds in a step that will be refused: the exponential must not overflow
        bend = place[1] * math.exp(min(y[1], MOST_LOGARITHM)) * here
        # a unit of the variable is about an angle, of the path or of the carrier, whichever turns faster
        pace = sense / (1.0 + bend)
        turn = math.cos(y[2])
        return pace * turn, pace * math.sin(y[2]), pace * (turn - bend)

    def arrives(_arc: float, y: Array) -> float:
        return float(y[0] - target)

    def stalls(_arc: float, y: Array) -> float:
        return math.cos(y[2])

    arrives.terminal = stalls.terminal = True  # type: ignore[attr-defined]
    first = (place[0], 0.0, place[2])
    solution = _integrate().solve_ivp(
        rates, (0.0, MOST_ARC), first, "DOP853", None, True, (arrives, stalls),
        rtol=tolerance, atol=tolerance, max_step=LONGEST_STEP,
    )  # fmt: skip
    # neither the end nor a stall was reached
    if solution.status != 1:
        what = _("the integration ends at {angle:.6g} deg").format(angle=math.degrees(solution.y[0, -1]))
        raise InputError("[curvature]", what, _("shorten the range"))
    stalled = bool(len(solution.t_events[1]))
    last = np.array(solution.y_events[1][0] if stalled else solution.y_events[0][0])
    last[1] = place[1] * math.exp(last[1])
    # exactly the end, so that the next leg begins there
    if not stalled:
        last[0] = target
    angles = np.append(solution.y[0, :-1], last[0])
    # `angles` grow, whichever way the leg was run
    order = slice(None, None, sense)
    low, high = sorted((float(place[0]), float(last[0])))
    return (
        IntegrationLeg(low, high, place[1], solution.t[order], angles[order], solution.sol, curvature),
        last,
        stalled,
    )


def _beyond(law: CurvatureLaw, target: float, sense: int) -> list[float]:
    """Taylor coefficients of the law about an end, from its near side; its value alone where there is no series."""
    coefficients = [float(c) for c in law.series(target, BEYOND, -sense)]
    return coefficients if all(math.isfinite(c) for c in coefficients) else coefficients[:1]


def polynomial(coefficients: Sequence[float], x: float) -> float:
    """The value of a polynomial."""
    total = 0.0
    for c in reversed(coefficients):
        total = total * x + c
    return total


def _solution_at(leg: IntegrationLeg, phi: Array) -> Array:
    """The solution (3, n) where the angle is phi, by Newton's method on the arc."""
    arc = np.interp(phi, leg.angles, leg.arcs)
    low, high = float(np.min(leg.arcs)), float(np.max(leg.arcs))
    sense = 1.0 if leg.arcs[-1] >= leg.arcs[0] else -1.0
    for _step in range(MOST_NEWTON_STEPS):
        angle, growth, gamma = leg.solution(arc)
        bend = leg.scale * np.exp(growth) * leg.curvature(angle)
        rate = sense * np.cos(gamma) / (1.0 + bend)
        with np.errstate(all="ignore"):
            # backwards the rate is negative: where it is not what it should be, the place stays
            step = np.where(sense * rate > 0, (angle - phi) / rate, 0.0)
        moved = np.clip(arc - step, low, high)
        if np.all(np.abs(moved - arc) <= 1e-16 * high):
            break
        arc = moved
    return np.asarray(leg.solution(arc))
