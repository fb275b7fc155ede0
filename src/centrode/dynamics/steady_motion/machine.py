"""A machine in steady motion as one result: its energies, its flywheel, its real motion over a cycle and instants."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import xarray as xr

from centrode.dynamics.kinetostatics.reactions import reactions
from centrode.dynamics.masses import has_masses_or_loads
from centrode.dynamics.steady_motion.flywheel import Flywheel, flywheel_of
from centrode.dynamics.steady_motion.speed import MeanSpeed
from centrode.dynamics.steady_motion.steady import Method, solution_of, steady_dataset, turned_at
from centrode.model.mechanism import Mechanism


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
    mean: MeanSpeed = "middle",
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


def results_of_steady_motion(mechanism: Mechanism, steady: xr.Dataset) -> MachineResults:
    """A dataset of `steady_motion` with the energies and the flywheel of the machine."""
    solution = solution_of(mechanism, steady.attrs["mean"])
    return MachineResults(mechanism, flywheel_of(solution), steady, None)


def results_of_flywheel(mechanism: Mechanism, flywheel: Flywheel) -> MachineResults:
    """A flywheel with the steady motion of its machine."""
    return replace(machine_results(mechanism, mean=flywheel.mean), flywheel=flywheel)


def is_machine(mechanism: Mechanism) -> bool:
    """Whether a description has a machine with a mean speed, and masses or loads that move it unevenly."""
    return mechanism.runs_at_mean_speed and has_masses_or_loads(mechanism)


def closing_balance(results: MachineResults) -> xr.Dataset:
    """Reactions in the real motion at the first instant of the description, else where the drive accelerates most.

    They close the balance of a machine, which the balancing moment of its links and the inertia moment of its flywheel
    drive: of that one sample `moment_of_links` + `inertia` * `drive_acceleration` is `driving_moment`, within the
    shares `driving_error` and `reaction_loss`; `driving_residual` is what is missing.

    Raises
    ------
    InputError, MotionError, NotComputedYet
        As `reactions`.
    """
    steady = results.steady
    if results.instants is not None:
        at = float(results.instants["drive_value"].values[0, 0])
    else:
        greatest = int(np.nanargmax(np.abs(steady["drive_acceleration"].values)))
        at = float(steady["drive_value"].values[greatest, 0])
    # of one motion all of it: another meaning of the mean speed has another speed here
    return reactions(results.mechanism, at=[at], motion="real", friction=False).isel(sample=0)
