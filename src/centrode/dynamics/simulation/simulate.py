"""The motion of a machine that is left to itself, as a labelled result."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal, TypeAlias, get_args

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.algebra.executors import ARRAYS, chosen
from centrode.dynamics.simulation.compiled import compiled
from centrode.dynamics.simulation.course import (
    Course,
)
from centrode.dynamics.simulation.fixed import even_times, fixed_steps
from centrode.dynamics.simulation.labelled import simulation_dataset
from centrode.dynamics.simulation.setting import Setting, setting_of
from centrode.dynamics.simulation.stepping import Stepper
from centrode.errors import InputError, MotionError
from centrode.kinematics.compiled.deciding import Untraceable
from centrode.kinematics.layout import layout_of
from centrode.kinematics.solve import check_size
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.model.simulations import Simulation

Array: TypeAlias = npt.NDArray[np.float64]
Tell: TypeAlias = Callable[[float], None]
Executor: TypeAlias = Literal["auto", "arrays", "machine code"]


def simulate(
    mechanism: Mechanism,
    settings: Simulation | None = None,
    *,
    at: npt.ArrayLike | None = None,
    motion: bool = False,
    executor: Executor = "auto",
    progress: Tell | None = None,
) -> xr.Dataset:
    """The motion of a mechanism with one drive under its loads and what drives it.

    Parameters
    ----------
    settings : Simulation
        In place of the description's own.
    at : (n) times [s], growing
        Exactly these instants instead of evenly spaced ones.
    motion : bool
        Also positions, velocities and accelerations of everything.
    executor : "auto", "arrays" or "machine code"
        Of the fixed-step scheme.
    progress : called with the share that is done

    Returns
    -------
    Dataset
        Value, speed and acceleration of the drive, moments, works, energies and powers over time, `occasion_...` and
        what ended it (docs: simulation). Speeds, moments and works count in the sense of the drive.

    Raises
    ------
    InputError
        No settings, several drives, nothing with mass, a start at a dead point.
    MotionError
        Nothing sets it in motion, or a formula has no value on the way.
    """
    if executor not in get_args(Executor):
        raise InputError(
            "executor",
            _("{name} is not a way to compute").format(name=f'"{executor}"'),
            _("use one of {known}").format(known=", ".join(get_args(Executor))),
        )
    setting = setting_of(mechanism, settings)
    count = setting.settings.samples if at is None else np.size(at)
    check_size(layout_of(setting.prepared.kinematics), 1, count)
    course = course_of(setting, executor, progress)
    return simulation_dataset(setting, course, _times(setting, course, at), motion=motion)


def course_of(setting: Setting, executor: Executor = "auto", progress: Tell | None = None) -> Course:
    """Integrate by the scheme that is asked for."""
    settings, until = setting.settings, setting.until
    if settings.scheme != "runge-kutta-4":
        stepper = Stepper(setting.field, until, settings.tolerance, settings.scheme == "stiff", progress)
        course = stepper.run(setting.start, setting.rate)
    else:
        course = _by_fixed_steps(setting, executor, progress)
    if course.ended == "change point" and not course.pieces:
        raise MotionError(
            "[simulation]",
            _("it starts at the change point at {value:.9g}, where its path ends").format(
                value=setting.start
            ),
            _(
                'start elsewhere, let it move away from there, or choose continuation = "smooth" in [assembly]'
            ),
        )
    if not course.last > course.first:
        raise MotionError(
            "[simulation]",
            _("nothing sets it in motion at {value:.6g}").format(value=setting.start),
            _("give it a speed, a greater driving moment, or another start"),
        )
    return course


def _by_fixed_steps(setting: Setting, executor: Executor, progress: Tell | None) -> Course:
    settings = setting.settings
    if settings.duration is None or settings.turns is not None:
        raise InputError(
            "[simulation]",
            _("a scheme of fixed steps needs a duration, and no turns"),
            _('give duration, or scheme = "adaptive"'),
        )
    field = setting.field
    if chosen(executor) != ARRAYS:
        try:
            scan = compiled(setting.rows, setting.driving, chosen(executor))
        except Untraceable as reason:
            if executor != "auto":
                raise InputError("executor", _(reason.reason), _('use executor = "auto"')) from None
        else:
            return scan.course(field, setting.start, setting.rate, settings.duration, settings.steps)
    return fixed_steps(field, setting.start, setting.rate, settings.duration, settings.steps, progress)


def _times(setting: Setting, course: Course, at: npt.ArrayLike | None) -> Array:
    """The instants of the result, no later than the end."""
    if at is not None:
        times = np.asarray(at, dtype=np.float64)
        if times.ndim != 1 or not len(times) or not np.isfinite(times).all() or (np.diff(times) <= 0.0).any():
            raise InputError("at", _("it needs growing finite times, one or more, in one dimension"))
        if times[0] < 0.0:
            raise InputError("at", _("times count from the start of the simulation, at 0 s"))
        return times[times <= course.last * (1.0 + 1e-12)].clip(max=course.last)
    settings = setting.settings
    if settings.scheme == "runge-kutta-4":
        assert settings.duration is not None
        return even_times(course, settings.duration / settings.steps, settings.samples)
    return np.linspace(course.first, course.last, settings.samples)
