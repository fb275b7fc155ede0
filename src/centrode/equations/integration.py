"""Integration of equations in Cauchy form: fixed steps of the classical Runge-Kutta method, or adaptive ones.

It knows nothing of closed forms: how far the motion goes is judged by the equations alone.
"""

from __future__ import annotations

import functools
import importlib
from dataclasses import dataclass
from typing import Any, Protocol, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.errors import InputError
from centrode.locale import _
from centrode.numerics.search import bisect

Array: TypeAlias = npt.NDArray[np.float64]

# slower to import than NumPy, and needed by nothing else
_scipy = functools.partial(importlib.import_module, "scipy.integrate")

FINE = 1e-10
"""Tolerance of the adaptive method with which a fixed step is judged."""
MOST_STEPS = 20_000
"""Adaptive steps after which an integration is refused."""
FAR = 1e6
"""Change of an unknown, in its own measure, beyond which it goes to infinity: steps would become ever smaller there."""
NEAR_POLE = 1e-3
"""Part of the range within which a pole is expected from there."""
LONGEST = 1 / 24
"""Longest adaptive step as a part of the range: a determinant that is zero twice in one step would not be seen."""
NUDGE = 1e-6
"""Step of the differences that form the Jacobian of the constraints [rad, and parts of the greatest length]."""
LOST = 0.01
"""Drift, as a part of the greatest length or in radians, beyond which a state is no position of the mechanism."""


class Equations(Protocol):
    """What is integrated: equations in Cauchy form with the constraints they were derived from.

    Times are numbers or (...), states (..., unknowns): many states are computed at once.
    """

    @property
    def initial(self) -> Array:
        """The state at t = 0 [rad, and m for slides]."""
        ...

    @property
    def sizes(self) -> Array:
        """What a great change of each unknown is: 1 for an angle, the greatest length for a slide."""
        ...

    def rates(self, time: Any, state: Array) -> Array:
        """Derivatives of the state by time."""
        ...

    def constraints(self, time: Any, state: Array) -> Array:
        """Left sides less constants, lengths over the greatest length: zero on the motion."""
        ...


@dataclass(frozen=True)
class Trajectory:
    """States at the times asked for, NaN where the integration does not get.

    Attributes
    ----------
    state, rates : (n, unknowns)
    stop : float or None
        Time at which the determinant is zero: there the equations define no rates [s].
    lost : float or None
        Time of the first row that fixed steps carried away from the mechanism [s].
    steps : int
        Steps taken.
    """

    state: Array
    rates: Array
    stop: float | None
    lost: float | None
    steps: int


def fixed_steps(equations: Equations, times: Array) -> Trajectory:
    """Classical fourth-order Runge-Kutta, one step from each time to the next.

    An adaptive integration goes before it and tells where the determinant is zero; rows behind that are left out,
    and so are those after a row with another sign of the determinant or with a drift of more than `LOST`.
    """
    judge = _followed(equations, times, FINE)
    state = np.full((len(times), len(equations.initial)), np.nan)
    state[0] = equations.initial
    with np.errstate(all="ignore"):
        for row, (time, step) in enumerate(zip(times[:-1], np.diff(times), strict=True)):
            state[row + 1] = _runge_kutta(equations, float(time), float(step), state[row])
    beyond = _beyond(times, judge.stop)
    lost = _lost(equations, times, state, beyond)
    if lost is not None:
        beyond |= np.arange(len(times)) >= lost
    state[beyond] = np.nan
    when = None if lost is None else float(times[lost])
    return Trajectory(state, _rates(equations, times, state), judge.stop, when, len(times) - 1)


def adaptive_steps(equations: Equations, times: Array, tolerance: float) -> Trajectory:
    """Dormand and Prince's method of eighth order with error control; rows come from its dense output."""
    found = _followed(equations, times, tolerance)
    return Trajectory(found.state, _rates(equations, times, found.state), found.stop, None, found.steps)


def determinant(equations: Equations, time: Any, state: Array) -> Array:
    """Determinant of the Jacobian of the constraints by the unknowns (...), NaN where there are not as many of both."""
    columns = []
    for shift in NUDGE * np.diag(equations.sizes):
        ahead = np.asarray(equations.constraints(time, state + shift))
        columns.append((ahead - equations.constraints(time, state - shift)) / (2 * NUDGE))
    matrix = np.stack(columns, axis=-1)
    if matrix.shape[-1] != matrix.shape[-2]:
        return np.full(matrix.shape[:-2], np.nan)
    return np.asarray(np.linalg.det(matrix))


def _runge_kutta(equations: Equations, time: float, step: float, state: Array) -> Array:
    first = equations.rates(time, state)
    second = equations.rates(time + step / 2, state + step / 2 * first)
    third = equations.rates(time + step / 2, state + step / 2 * second)
    fourth = equations.rates(time + step, state + step * third)
    return np.asarray(state + step / 6 * (first + 2 * second + 2 * third + fourth))


@dataclass(frozen=True)
class _Followed:
    state: Array
    stop: float | None
    steps: int


def _followed(equations: Equations, times: Array, tolerance: float) -> _Followed:
    """States at the times by adaptive steps, as far as the determinant keeps its sign.

    Raises InputError where too many steps would be needed.
    """
    initial = np.asarray(equations.initial, dtype=np.float64)
    state = np.full((len(times), len(initial)), np.nan)
    first, last = float(times[0]), float(times[-1])
    state[times == first] = initial
    if first == last or not len(initial):
        return _Followed(np.broadcast_to(initial, state.shape).copy(), None, 0)
    sign = np.sign(determinant(equations, first, initial))
    with np.errstate(all="ignore"):
        if sign == 0 or not np.isfinite(equations.rates(first, initial)).all():
            return _Followed(state, first, 0)
        solver = _scipy().DOP853(
            equations.rates, first, initial, last, rtol=tolerance, atol=tolerance * equations.sizes,
            max_step=LONGEST * abs(last - first),
        )  # fmt: skip
        for steps in range(1, MOST_STEPS + 1):
            if solver.step() is not None or not np.isfinite(solver.y).all():
                return _Followed(state, float(solver.t), steps)
            if (np.abs(solver.y - initial) > FAR * equations.sizes).any():
                return _Followed(state, _pole(equations, first, initial, solver), steps)
            course = solver.dense_output()
            crosses = sign * determinant(equations, solver.t, solver.y) < 0
            stop = _crossing(equations, course) if crosses else None
            _fill(state, times, course, course.t if stop is None else stop)
            if stop is not None or solver.status == "finished":
                return _Followed(state, stop, steps)
    raise InputError(
        "",
        _("the integration needs more than {most} steps").format(most=MOST_STEPS),
        _("ask for a shorter range, or a coarser tolerance"),
    )


def _fill(state: Array, times: Array, course: Any, stop: float) -> None:
    """Rows between the last step's ends, from its polynomial."""
    forward = np.sign(course.t - course.t_old)
    inside = (forward * times > forward * course.t_old) & (forward * times <= forward * stop)
    if inside.any():
        state[inside] = course(times[inside]).T


def _pole(equations: Equations, first: float, initial: Array, solver: Any) -> float:
    """Where an unknown that is very great goes to infinity: near a simple pole y/y' is what is left."""
    moved = solver.y - initial
    most = int(np.argmax(np.abs(moved) / equations.sizes))
    left = float(moved[most] / equations.rates(solver.t, solver.y)[most])
    # where it runs away otherwise than to a pole nearby, it has run away here
    return float(solver.t) + (left if abs(left) <= NEAR_POLE * abs(solver.t_bound - first) else 0.0)


def _crossing(equations: Equations, course: Any) -> float:
    """Where the determinant changes its sign within a step, by bisection: it may be anything but smooth there."""
    low, high = np.array([course.t_old]), np.array([course.t])
    sign = np.sign(determinant(equations, float(low[0]), course(low[0])))

    def before(time: Array) -> npt.NDArray[np.bool_]:
        return np.asarray([sign * determinant(equations, float(t), course(t)) > 0 for t in time])

    return float(bisect(before, low, high)[0][0])


def _beyond(times: Array, stop: float | None) -> npt.NDArray[np.bool_]:
    if stop is None:
        return np.zeros(len(times), dtype=bool)
    return np.asarray(np.sign(times[-1] - times[0]) * (times - stop) > 0)


def _lost(equations: Equations, times: Array, state: Array, beyond: npt.NDArray[np.bool_]) -> int | None:
    """First row that is no position of the mechanism any more, or one of another assembly."""
    rows = np.flatnonzero(~beyond)
    if not rows.size or not state.shape[1]:
        return None
    with np.errstate(all="ignore"):
        drift = np.abs(equations.constraints(times[rows], state[rows])).max(axis=1)
        signs = np.sign(determinant(equations, times[rows], state[rows]))
    # a row that is no number drifts by no number
    wrong = ~(drift <= LOST) | (signs * signs[0] < 0)
    return int(rows[np.argmax(wrong)]) if wrong.any() else None


def _rates(equations: Equations, times: Array, state: Array) -> Array:
    """Rates at the rows that have a state."""
    found = np.full(state.shape, np.nan)
    rows = np.isfinite(state).all(axis=1)
    if rows.any() and state.shape[1]:
        with np.errstate(all="ignore"):
            found[rows] = equations.rates(times[rows], state[rows])
    return found
