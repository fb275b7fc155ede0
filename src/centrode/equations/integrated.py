"""The motion of a mechanism by integration of its differential equations, beside the motion in closed form."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.equations.cauchy import CauchyForm, form_of
from centrode.equations.courses import course_of
from centrode.equations.derivation import equations
from centrode.equations.integration import FINE, Trajectory, adaptive_steps, fixed_steps
from centrode.errors import InputError, Status
from centrode.kinematics.dataset import (
    attributes_of,
    coordinates_of,
    dataset_of,
    judgements_of,
    labels_of,
    named,
)
from centrode.kinematics.motion import motion
from centrode.kinematics.ready import Ready, ready
from centrode.kinematics.solve import Solved, asked_span, solve
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.model.problems import nearest, shown

Array: TypeAlias = npt.NDArray[np.float64]

METHODS = ("rk4", "adaptive")
MOST_STEPS = 100_000
TOLERANCES = (1e-13, 1e-2)
"""Finest and coarsest tolerance of the adaptive method: below the first it would be rounding that is controlled."""


def integrate(
    mechanism: Mechanism,
    method: str = "rk4",
    steps: int = 100,
    tolerance: float = FINE,
    stop: float | None = None,
) -> xr.Dataset:
    """The motion from t = 0 by integration of the equations in Cauchy form, with its difference from the closed forms.

    Parameters
    ----------
    method : "rk4" or "adaptive"
        Fixed steps of the classical Runge-Kutta method, or Dormand and Prince's of eighth order with error control.
    steps : int
        Number of fixed steps; of either method the result has steps + 1 rows, evenly spaced in time.
    tolerance : float
        Of the adaptive method, relative and absolute, for each step: rad, and parts of the greatest length.
    stop : float [rad or m, or s]
        Last value of the drive, a time where the drive is a law or there are several; one turn if left out.

    Returns
    -------
    Dataset
        Variables as `motion` names them, `drift` of the constraints, `angle_difference` and `position_difference`
        from the closed forms (docs: integration). Rows that the integration does not reach are NaN with the status
        `open`; those that fixed steps carry away from the mechanism, `unconverged`.

    Raises
    ------
    InputError
        As `motion` and `equations` do, or method, steps or tolerance do not exist.
    """
    _check(method, steps, tolerance)
    prepared = ready(mechanism)
    form = form_of(prepared)
    start = prepared.kinematics.path.initial if prepared.parameter.is_uniform else 0.0
    solved = solve(prepared, asked_span(prepared, steps + 1, start, stop))
    scaled = Scaled(form, float(prepared.kinematics.numbers.scale))
    times = solved.span.time
    if method == "rk4":
        found = fixed_steps(scaled, times)
    else:
        found = adaptive_steps(scaled, times, tolerance)
    told = {"method": method, "steps": steps, "steps_taken": found.steps}
    if method == "adaptive":
        told["tolerance"] = tolerance
    return _dataset(prepared, solved, form, scaled, found, told)


@dataclass(frozen=True)
class IntegrationResults:
    """An integrated motion beside the one in closed form.

    Attributes
    ----------
    mechanism : Mechanism
    integration : the dataset of `integrate`
    closed : the motion in closed form over the same range, whose curves stand under the integrated ones
    """

    mechanism: Mechanism
    integration: xr.Dataset
    closed: xr.Dataset


def integration_results(
    mechanism: Mechanism,
    method: str = "rk4",
    steps: int = 100,
    tolerance: float | None = None,
    stop: float | None = None,
) -> IntegrationResults:
    """The motion by integration, with the mechanism and the motion in closed form.

    Arguments and failures are those of `integrate`; InputError also for a tolerance of fixed steps.
    """
    if tolerance is not None and method == "rk4":
        what = _("fixed steps have no tolerance")
        raise InputError("--tolerance", what, _("add --method adaptive, or ask for more --steps"))
    integration = integrate(mechanism, method, steps, FINE if tolerance is None else tolerance, stop)
    return IntegrationResults(mechanism, integration, closed_motion(mechanism, integration))


def closed_motion(mechanism: Mechanism, integration: xr.Dataset, samples: int = 361) -> xr.Dataset:
    """The motion in closed form over the range of an integrated one, for curves to be compared with."""
    instants = mechanism.motion_parameter.instants(integration)
    first, last = (float(instants[end]) for end in (0, -1))
    return motion(mechanism, samples, start=first, stop=last)


def is_integrated(mechanism: Mechanism) -> bool:
    """Whether a mechanism moves in the plane and has unknowns that its equations give."""
    return mechanism.space == "plane" and bool(equations(mechanism).unknowns)


def _check(method: object, steps: object, tolerance: object) -> None:
    if method not in METHODS:
        what = _("there is no method {name}").format(name=shown(method))
        raise InputError("method", what, nearest(str(method), METHODS))
    if isinstance(steps, bool) or not isinstance(steps, int) or not 1 <= steps <= MOST_STEPS:
        what = _("{steps} steps were asked for").format(steps=shown(steps))
        raise InputError("steps", what, _("ask for 1 to {most}").format(most=MOST_STEPS))
    low, high = TOLERANCES
    if isinstance(tolerance, bool) or not isinstance(tolerance, int | float) or not low <= tolerance <= high:
        what = _("{value} is no tolerance").format(value=shown(tolerance))
        raise InputError("tolerance", what, _("ask for {low:g} to {high:g}").format(low=low, high=high))


@dataclass(frozen=True)
class Scaled:
    """Equations whose constraints are compared with the greatest length."""

    form: CauchyForm
    scale: float

    @property
    def initial(self) -> Array:
        return self.form.initial

    @property
    def sizes(self) -> Array:
        return np.array([self.scale if name.startswith("slide.") else 1.0 for name in self.form.names])

    def rates(self, time: Any, state: Array) -> Array:
        return np.asarray(self.form.rates(time, state), dtype=np.float64)

    def constraints(self, time: Any, state: Array) -> Array:
        return np.asarray(self.form.constraints(time, state), dtype=np.float64) / self._units

    @cached_property
    def _units(self) -> Array:
        """What each constraint is compared with: those of wheels are angles."""
        angular = ("gear ", "rolling ")
        return np.array(
            [1.0 if name.startswith(angular) else self.scale for name in self.form.constraint_names]
        )


def _dataset(
    prepared: Ready,
    solved: Solved,
    form: CauchyForm,
    scaled: Scaled,
    found: Trajectory,
    told: Mapping[str, Any],
) -> xr.Dataset:
    closed = dataset_of(solved)
    times = solved.span.time
    status = _status(found, times)
    course = course_of(prepared, closed, form, found)
    drift = np.full((len(status), len(form.constraint_names)), np.nan)
    rows = status == Status.OK
    drift[rows] = scaled.constraints(times[rows], found.state[rows])
    off = course.angles - closed["angle"].to_numpy()
    apart = np.linalg.norm(course.points - closed["position"].to_numpy(), axis=-1)
    judged = judgements_of(solved, ())["status"]
    variables = {
        "angle": named("angle", ("sample", "link"), course.angles),
        "angular_velocity": named("angular_velocity", ("sample", "link"), course.spins),
        "position": named("position", ("sample", "point", "axis"), course.points),
        "velocity": named("velocity", ("sample", "point", "axis"), course.velocities),
        "slide": named("slide", ("sample", "guide"), course.slides),
        "slide_velocity": named("slide_velocity", ("sample", "guide"), course.slips),
        "drift": named("drift", ("sample", "constraint"), drift),
        "angle_difference": named("angle_difference", ("sample", "link"), off),
        "position_difference": named("position_difference", ("sample", "point"), apart),
        "status": (judged[0], status, judged[2]),
        **{name: closed[name] for name in ("event_value", "event_kind", "event_group")},
    }
    coordinates = {**coordinates_of(solved), "constraint": labels_of(form.constraint_names)}
    attributes = {name: told for name, told in attributes_of(solved).items() if "residual" not in name}
    attributes |= {
        **told,
        "stop_time": _or_nan(found.stop),
        "lost_time": _or_nan(found.lost),
        "return_difference": _apart(course.angles, course.points, scaled.scale),
        "closed_return_difference": _apart(
            closed["angle"].to_numpy(), closed["position"].to_numpy(), scaled.scale
        ),
    }
    return xr.Dataset(variables, coords=coordinates, attrs=attributes)


def _or_nan(time: float | None) -> float:
    return float("nan") if time is None else time


def _status(found: Trajectory, times: Array) -> npt.NDArray[np.int8]:
    """Ok where there is a state; behind a stop open, from a row that is lost on unconverged."""
    status = np.where(np.isfinite(found.state).all(axis=1), Status.OK, Status.OPEN).astype(np.int8)
    forward = np.sign(times[-1] - times[0])
    if found.lost is not None:
        end = times[-1] if found.stop is None else found.stop
        status[(forward * times >= forward * found.lost) & (forward * times <= forward * end)] = (
            Status.UNCONVERGED
        )
    return status


def _apart(angles: Array, points: Array, scale: float) -> float:
    """How far the last row is from the first: angles modulo turns [rad], places over the greatest length.

    NaN where one of them does not exist.
    """
    turned = np.abs(np.remainder(angles[-1] - angles[0] + np.pi, 2 * np.pi) - np.pi)
    moved = np.abs(points[-1] - points[0]) / scale
    return float(np.max(np.concatenate([turned.ravel(), moved.ravel()]), initial=0.0))
