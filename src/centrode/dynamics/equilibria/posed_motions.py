"""Positions one behind the other as a motion that pictures, animations and pages show: modes, and equilibria."""

from __future__ import annotations

from dataclasses import replace
from typing import TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.dynamics.equilibria.linear_equations import LoadedMechanism
from centrode.dynamics.forward_dynamics.free_motion import FreeMotion
from centrode.dynamics.forward_dynamics.motion_problem import MotionNames
from centrode.dynamics.forward_dynamics.motion_steps import DURATION, MotionSteps
from centrode.dynamics.forward_dynamics.trajectory import trajectory_of
from centrode.dynamics.simulation.multibody_motion import MultibodySetting, multibody_dataset
from centrode.dynamics.state import Centre, Mass, Radial, Spread
from centrode.model.mechanism import Mechanism
from centrode.model.simulation import Simulation
from centrode.numerics.arrays import ARRAYS

Array: TypeAlias = npt.NDArray[np.float64]
Complex: TypeAlias = npt.NDArray[np.complex128]

AMPLITUDE = 0.25
"""Greatest departure of a mode that is drawn [rad, or of the greatest length]."""
FRAMES = 72
"""Positions in a period."""
SHOWN = (
    "position", "angle", "joint_angle", "polar_angle", "azimuth", "slide", "status", "potential_energy",
    "generalised_coordinate",
)  # fmt: skip
AXES = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


def posed_motion(loaded: LoadedMechanism, times: Array, places: Array) -> xr.Dataset:
    """Positions (n, coordinates) at times (n) [s] with the names of a simulation; nothing moves in them."""
    if not len(places):
        # of no position there are names all the same
        return posed_motion(loaded, np.zeros(1), loaded.start[None]).isel(sample=slice(0))
    # accelerations are of no account, and without masses there would be none
    masses = _unit_masses(loaded.mechanism, loaded)
    equations = replace(loaded.equations, masses=masses, shafts=(), loads=(), controls=(), contacts=())
    free = FreeMotion(loaded.mechanism, equations, loaded.position, loaded.mobility, 0)
    setting = MultibodySetting(loaded.mechanism, Simulation(duration=1.0))
    setting.__dict__["free"] = free
    names = MotionNames.of(equations)
    rows = np.zeros((1 + len(names.unknowns), len(times)))
    rows[0] = times
    rows[1:][names.part(names.coordinates)] = places[:, : loaded.joints].T
    steps = MotionSteps(rows[:, :1], DURATION, None, 0)
    course = trajectory_of(equations, steps, times, rows[1:], "adaptive", "arrays")
    found = multibody_dataset(setting, course)
    kept = found[[name for name in SHOWN if name in found]]
    return kept.assign(potential_energy=kept["potential_energy"].copy(data=potential_energy(loaded, places)))


def potential_energy(loaded: LoadedMechanism, places: Array) -> Array:
    """Potential energy of weights and springs (n) [J]."""
    equations, still = loaded.equations, [np.zeros(len(places))] * loaded.joints
    values = equations.tree.values(ARRAYS, list(places[:, : loaded.joints].T))
    return np.broadcast_to(equations.energies(ARRAYS, values, still, 0.0)[1], len(places)).astype(np.float64)


def _unit_masses(mechanism: Mechanism, loaded: LoadedMechanism) -> tuple[Mass, ...]:
    pivots = loaded.equations.tree.pivots
    if mechanism.space == "sphere":
        parts = tuple(Spread(1.0, axis) for axis in AXES)
        return tuple(Mass(link, 0.0, Radial(link, AXES[0], 1.0), parts) for link in mechanism.links)
    return tuple(
        Mass(link, 1.0, Centre(link, pivots[link], 0.0, 0.0), 1.0)
        for link in mechanism.links
        if link in pivots
    )


def mode_motion(loaded: LoadedMechanism, place: Array, shape: Complex, frequency: float) -> xr.Dataset:
    """A period of a mode about a position (coordinates), from there and back to it.

    Parameters
    ----------
    shape : (coordinates) [rad or m], the greatest being 1 in its unit
    frequency : [rad/s]; of a mode that does not oscillate a period takes a second
    """
    phases = np.linspace(0.0, 2.0 * np.pi, FRAMES + 1)
    size = AMPLITUDE
    for _halving in range(12):
        # by the sine of the phase: the motion begins and ends in the position itself where all move together
        moved = size * np.imag(shape[None, :] * np.exp(1j * phases)[:, None])
        places = loaded.closed_coordinates(place + moved)
        strayed = np.max(np.abs((places - place - moved) / loaded.units))
        if np.isfinite(strayed) and strayed < 0.5 * size:
            break
        size *= 0.5
    period = 2.0 * np.pi / frequency if frequency else 1.0
    return posed_motion(loaded, phases / (2.0 * np.pi) * period, places)
