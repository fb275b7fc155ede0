"""Forces on the frames of an animation: of the pins on the links, and of the loads, with the places where they act."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.dynamics.kinetostatics.applied_forces import input_motion_of
from centrode.dynamics.kinetostatics.reactions import reactions
from centrode.dynamics.loads import MassesAndLoads
from centrode.dynamics.state import State, length_unit
from centrode.dynamics.wrenches import Wrench
from centrode.kinematics.path import grid_at
from centrode.kinematics.preparation import ready
from centrode.kinematics.solve import solve
from centrode.model.mechanism import FRAME, Mechanism

Array: TypeAlias = npt.NDArray[np.float64]


@dataclass(frozen=True)
class LoadForce:
    """One force of a load.

    Attributes
    ----------
    load : str
        What results call the load.
    force : (sample, axis) [N]
    place : (sample, axis)
        Where it acts [m]; on the sphere as a unit vector.
    """

    load: str
    force: Array
    place: Array


def joint_forces(mechanism: Mechanism, places: Array) -> xr.Dataset:
    """`reactions` at given places, without those on the frame: each link with the forces of its own pins."""
    found = reactions(mechanism, at=places)
    return found.isel(side=np.flatnonzero(found["side_link"].values != FRAME))


def load_forces(mechanism: Mechanism, places: Array) -> list[LoadForce]:
    """Forces of all loads and weights at given places, as `reactions` takes them; moments are not among them."""
    prepared = ready(mechanism)
    solved = solve(prepared, grid_at(prepared.kinematics.path, places))
    burden = MassesAndLoads.for_reactions(mechanism)
    state = State.of(solved, input_motion_of(solved, burden).moving)
    found = []
    for load in burden.loads:
        with np.errstate(all="ignore"):
            strengths = load.strengths(state, state.exists)
            pulls = [
                pull.times(strength)
                for effort, strength in zip(load.efforts, strengths, strict=True)
                for pull in effort.pulls(state)
            ]
        found += _join_pulls(load.label, pulls, len(places), length_unit(mechanism))
    return found


def _join_pulls(label: str, pulls: Sequence[Wrench], samples: int, unit: float) -> list[LoadForce]:
    """Pulls of a load as forces; components on one body are one force."""
    bodies = dict.fromkeys(pull.body for pull in pulls)
    found = []
    for body in bodies:
        own = [pull for pull in pulls if pull.body == body]
        force = np.asarray(sum(_rows(pull.force, samples) for pull in own))
        if np.nan_to_num(force).any():
            found.append(LoadForce(label, force, _rows(own[0].at, samples) / unit))
    return found


def _rows(vector: Sequence[npt.ArrayLike], samples: int) -> Array:
    """A vector of numbers or of arrays (1, sample) as (sample, axis)."""
    return np.stack([np.broadcast_to(np.asarray(x, dtype=float), (1, samples))[0] for x in vector], axis=-1)
