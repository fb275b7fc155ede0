"""The steady motion of a machine as a labelled result: energies, the drive's speed, real velocities of everything."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import tau
from typing import Literal, TypeAlias, get_args

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.dynamics.masses import has_masses_or_loads
from centrode.dynamics.steady_motion.balance import Mean
from centrode.dynamics.steady_motion.flywheel import Flywheel, flywheel_of
from centrode.dynamics.steady_motion.quadrature import Array
from centrode.dynamics.steady_motion.solution import Solution, solution_of
from centrode.errors import InputError
from centrode.kinematics.dataset import dataset_of, named
from centrode.kinematics.solve import DEFAULT_SAMPLES, solve
from centrode.kinematics.spans import Span
from centrode.locale import _
from centrode.model import limits
from centrode.model.mechanism import Mechanism

Method: TypeAlias = Literal["exact", "first-order"]
METHODS = get_args(Method)


def steady_motion(
    mechanism: Mechanism,
    samples: int | None = None,
    at: npt.ArrayLike | None = None,
    *,
    mean: Mean = "middle",
    method: Method = "exact",
) -> xr.Dataset:
    """A machine in steady motion: its energies over a cycle and the motion with the drive's real speed.

    Parameters
    ----------
    samples : int
        Evenly spaced over the cycle, both ends included; the description's own number, else 361.
    at : (n,) values of the drive [rad]
        Exactly these places instead; whole cycles are taken out of them.
    mean : "middle" or "time"
        What the mean speed is: half of greatest plus least, or turns over time.
    method : "exact" or "first-order"
        The speed by the energy equation, or by the coursework's first-order formula.

    Returns
    -------
    Dataset
        Everything of `motion`, with the real velocities and accelerations, and the moments, works, energies,
        speeds and accelerations of the drive (docs: flywheel). All of these count in the sense in which the drive
        turns, `turned` from the initial position.

    Raises
    ------
    InputError, MotionError
        As `flywheel`; without `fluctuation` the machine has the inertia of its shafts alone.
    """
    found = solution_of(mechanism, mean)
    return steady_dataset(found, turned_at(found, samples, at), method)


@dataclass(frozen=True)
class MachineResults:
    """A machine in steady motion.

    Attributes
    ----------
    mechanism : the machine
    flywheel : Flywheel
    steady : the labelled steady motion over a cycle
    instants : the same at the instants that were named; None without any
    """

    mechanism: Mechanism
    flywheel: Flywheel
    steady: xr.Dataset
    instants: xr.Dataset | None


def machine_results(
    mechanism: Mechanism,
    samples: int | None = None,
    mean: Mean = "middle",
    method: Method = "exact",
    *,
    instants: Sequence[float] | None = None,
) -> MachineResults:
    """Energies, flywheel and steady motion of a machine, from one solution.

    Parameters
    ----------
    samples, mean, method : as of `steady_motion`
    instants : values of the drive [rad]; those of the description if left out

    Raises
    ------
    InputError, MotionError
        As `steady_motion`.
    """
    solution = solution_of(mechanism, mean)
    if instants is None:
        # a law of time may pass a value more than once
        instants = mechanism.study.instants if solution.prepared.parameter.is_uniform else ()
    at_instants = steady_dataset(solution, turned_at(solution, at=instants), method) if instants else None
    steady = steady_dataset(solution, turned_at(solution, samples), method)
    return MachineResults(mechanism, flywheel_of(solution), steady, at_instants)


def is_machine(mechanism: Mechanism) -> bool:
    """Whether a description has a machine, and masses or loads that move it unevenly."""
    return mechanism.machine is not None and has_masses_or_loads(mechanism)


def turned_at(found: Solution, samples: int | None = None, at: npt.ArrayLike | None = None) -> Array:
    """Angles turned [rad] of evenly spaced samples, or of values of the drive."""
    cycle = found.cycle
    if at is None:
        asked = samples if samples is not None else found.prepared.mechanism.study.samples
        count = DEFAULT_SAMPLES if asked is None else asked
        if isinstance(count, bool) or not 1 <= count <= limits.SAMPLES:
            raise InputError(
                _("samples"),
                _("{samples} samples were asked for").format(samples=count),
                _("ask for 1 to {most}").format(most=limits.SAMPLES),
            )
        return np.linspace(0.0, cycle.period, count)
    values = np.asarray(at, dtype=np.float64)
    if values.ndim != 1 or not 1 <= len(values) <= limits.SAMPLES or not np.isfinite(values).all():
        raise InputError("at", _("it needs finite values of the drive, one or more, in one dimension"))
    turned = cycle.sense * (values - cycle.first)
    return np.asarray(turned - cycle.period * np.floor(turned / cycle.period))


def steady_dataset(found: Solution, turned: Array, method: Method = "exact") -> xr.Dataset:
    """The labelled steady motion at angles turned [rad] within a cycle."""
    if method not in METHODS:
        raise InputError(
            "method",
            _("{name} is not a way to compute the speed").format(name=f'"{method}"'),
            _("use one of {known}").format(known=", ".join(METHODS)),
        )
    cycle = found.cycle
    speed = found.speed if method == "exact" else found.by_source
    rate, second = cycle.sense * speed.at(turned), cycle.sense * speed.acceleration(turned)
    span = Span(speed.time(turned), cycle.value(turned), rate, second)
    data = dataset_of(solve(found.prepared, span))
    with_energies = {
        name: named(name, ("sample",), values) for name, values in _curves(found, turned).items()
    }
    return data.assign(with_energies).assign_attrs(_facts(found, method))


def _curves(found: Solution, turned: Array) -> dict[str, Array]:
    """Everything that is known of the drive over the cycle, by the names of the vocabulary."""
    balance, cycle, square = found.speed.balance, found.cycle, found.machine.mean_speed**2
    resisting, driving, total = balance.cycle.moment, balance.driving, balance.total
    return {
        "turned": turned,
        "moment_of_loads": resisting.at(turned),
        "driving_moment": driving.at(turned),
        "work_of_loads": resisting.integral(turned),
        "work_of_drive": driving.integral(turned),
        "work": total.integral(turned),
        "inertia_of_links": cycle.inertia.at(turned),
        "inertia_slope_of_links": cycle.slope.at(turned),
        "energy_of_links": 0.5 * square * cycle.inertia.at(turned),
        "energy_change": found.balance.energy_change(turned, square),
        "drive_speed": found.speed.at(turned),
        "drive_acceleration": found.speed.acceleration(turned),
        "drive_speed_first_order": found.by_source.at(turned),
        "drive_acceleration_first_order": found.by_source.acceleration(turned),
    }


def _facts(found: Solution, method: Method) -> dict[str, float | str | list[float]]:
    """Attributes of the dataset: what holds for the whole cycle, in SI."""
    lines = found.tangents
    touching: dict[str, list[float]] = (
        {}
        if lines is None
        else {
            "tangent_slopes": [lines.lower_slope, lines.upper_slope],
            "tangent_intercepts": [lines.lower_intercept, lines.upper_intercept],
            "tangents_touch_at": [lines.lower_at, lines.upper_at],
        }
    )
    return {
        "speed_by": method,
        "mean": found.kind,
        "mean_speed": found.machine.mean_speed,
        "turns_of_cycle": found.cycle.period / tau,
        "inertia": found.speed.inertia,
        "inertia_first_order": found.by_source.inertia,
        **touching,
    }
