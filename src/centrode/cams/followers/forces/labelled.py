"""Forces between cam and follower as a labelled result."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.cams.followers.forces import keeping
from centrode.cams.followers.forces.acting import FollowerForces, Forces, follower_forces
from centrode.cams.sampled import angles_of
from centrode.errors import Status
from centrode.kinematics.dataset import Variable, named
from centrode.model.cams.files import AnyCam, cam_text, with_follower
from centrode.model.cams.plate import PlateCam
from centrode.version import __version__

Array = npt.NDArray[np.float64]


def cam_forces(cam: AnyCam, samples: int | None = None, at: npt.ArrayLike | None = None) -> xr.Dataset:
    """Forces between a cam and its follower over a turn.

    Parameters
    ----------
    cam : PlateCam
        With `base_radius` or `[bounds]`; without `speed` the forces are those at rest.
    samples : int
        Evenly spaced over a turn, both ends included; the description's own number, else 361.
    at : (n,) angles of the cam [rad]
        Exactly these places instead.

    Returns
    -------
    Dataset
        Along `sample`, over `cam_angle`: the push along the follower's motion (`follower_push` [N], of an oscillating
        follower `follower_moment` [N m]), `contact_force` along the normal, `cam_torque`; with width and materials
        also the stress, the half width, the shear and its depth (docs: cam mechanisms). Where the contact is lost
        samples are open, where friction locks they are singular; both are NaN but for the push. Attributes hold what
        `FollowerForces` and `keeping` find over the whole turn.

    Raises
    ------
    InputError
        As `follower_cam`.
    """
    plate = with_follower(cam)
    return dataset_of_forces(plate, follower_forces(plate), angles_of(plate, samples, at))


def dataset_of_forces(cam: PlateCam, forces: FollowerForces, phi: Array) -> xr.Dataset:
    """The labelled forces at angles of the cam [rad]."""
    found = forces.at(phi)
    push = "follower_moment" if cam.swings else "follower_push"
    values = {push: found.push, "contact_force": found.normal, "cam_torque": found.torque}
    if found.strip is not None:
        values |= {
            "contact_stress": found.strip.pressure,
            "contact_shear": found.strip.shear,
            "contact_depth": found.strip.depth,
            "contact_half_width": found.strip.half_width,
        }
    data = {name: named(name, ("sample",), one) for name, one in values.items()}
    data["status"] = _status(forces, found)
    coordinates = {"cam_angle": named("cam_angle", ("sample",), phi)}
    return xr.Dataset(data, coords=coordinates, attrs=_facts(cam, forces))


def _status(forces: FollowerForces, found: Forces) -> Variable:
    lost = (found.push < 0) & (not forces.led)
    status = np.where(np.isnan(found.normal), np.int8(Status.SINGULAR), np.int8(Status.OK))
    status = np.where(lost, np.int8(Status.OPEN), status).astype(np.int8)
    dimensions, values, attributes = named("status", ("sample",), status)
    attributes["flag_values"] = np.array([s.value for s in Status], dtype=np.int8)
    attributes["flag_meanings"] = " ".join(s.name.lower() for s in Status)
    return dimensions, values, attributes


def _facts(cam: PlateCam, forces: FollowerForces) -> dict[str, Any]:
    motion, burden = forces.body.motion, forces.burden
    extremes = {
        "least_push": keeping.least_push(motion, burden, forces.speed),
        "jump_speed": keeping.jump_speed(motion, burden),
        "preload_needed": keeping.preload_needed(motion, burden, forces.speed),
        "stiffness_needed": keeping.stiffness_needed(motion, burden, forces.speed),
        "greatest_force": forces.greatest_normal,
        "greatest_torque": forces.greatest_torque,
        "least_torque": forces.least_torque,
    }
    if forces.modulus is not None and forces.width is not None:
        extremes["greatest_stress"] = forces.greatest_stress
    facts: dict[str, Any] = {"title": cam.title, "cam": cam_text(cam), "version": __version__}
    facts |= {"speed": forces.speed, "led": int(forces.led)}
    for name, one in extremes.items():
        facts |= {name: one.value, f"{name}_at": one.angle}
    if cam.bounds.stress is not None:
        facts["admissible_stress"] = cam.bounds.stress
    facts["works_difference"] = works_difference(forces)
    return facts


def works_difference(forces: FollowerForces) -> float:
    """By how much [N m] the torque of the normal force departs from that of virtual work; NaN with friction."""
    if forces.friction:
        return math.nan
    phi = np.linspace(0.0, math.tau, 361)
    found = forces.at(phi)
    apart = np.abs(found.torque - found.push * forces.body.motion.lift(phi, 1)[1])
    return float(np.nanmax(apart)) if np.isfinite(apart).any() else math.nan
