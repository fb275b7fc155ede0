"""Forces between a cam and its follower over a turn, and second routes to them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.cams.followers.base_circle import has_profile
from centrode.cams.followers.closed_forms import ROUNDING, TURN, clear_lift
from centrode.cams.followers.forces import (
    Burden,
    FollowerForces,
    dataset_of_forces,
    follower_forces,
    least_push,
    meeting_of,
)
from centrode.cams.roller_path import angles_of
from centrode.model.cam_files import AnyCam, with_follower
from centrode.model.follower_cam import PlateCam

Array = npt.NDArray[np.float64]

NODES = 16
"""Of the rule of Gauss and Chebyshev, which integrates an ellipse exactly."""


@dataclass(frozen=True)
class FollowerForceResults:
    """Forces between a cam and its follower.

    Attributes
    ----------
    cam : PlateCam
    forces : FollowerForces
    dataset : the labelled forces over a turn; its attributes hold what is known of the whole turn
    """

    cam: PlateCam
    forces: FollowerForces
    dataset: xr.Dataset

    @property
    def whole_turn(self) -> dict[str, Any]:
        """Extremes, speeds and springs over the whole turn by name, each with its angle as `NAME_at`, in SI."""
        return self.dataset.attrs

    def lift_at(self, phi: float) -> tuple[float, float, float]:
        """Lift, slope and second derivative at an angle [rad], without what rounding leaves of zero."""
        rows = clear_lift(self.forces.body.motion, np.array([phi]), 2)[:, 0]
        value, slope, second = map(float, rows)
        return value, slope, second

    def levers_at(self, phi: float) -> tuple[tuple[float, float], tuple[float, float]]:
        """What forces of one along the normal and along the drag do at an angle [rad], without rounding.

        Returns their shares along the follower's motion, plain numbers or, of an oscillating follower, lengths [m];
        and their arms [m] about the cam's axis.
        """
        met = meeting_of(self.forces.body, self.forces.body.motion.lift(np.array([phi]), 2))
        x, y = met.place[0]
        size, reach = float(np.linalg.norm(met.lever)), float(np.hypot(x, y))
        (along, drag), (arm, drag_arm) = zip(
            *(
                (float(np.sum(met.lever * one)), met.sense * float(x * one[0, 1] - y * one[0, 0]))
                for one in (met.normal, met.slip)
            ),
            strict=True,
        )
        return (_clear(along, size), _clear(drag, size)), (_clear(arm, reach), _clear(drag_arm, reach))


def _clear(value: float, size: float) -> float:
    return 0.0 if abs(value) <= ROUNDING * size else float(value)


def follower_force_results(
    cam: AnyCam, samples: int | None = None, *, instants: Sequence[float] | None = None
) -> FollowerForceResults:
    """Forces between a cam and its follower over a turn.

    Parameters
    ----------
    cam : PlateCam
        With `base_radius` or `[bounds]`; without `speed` the forces are those at rest.
    samples : int
        Evenly spaced over the turn; the description's own number, else 361.
    instants : as of every topic of a cam; forces are shown where they are greatest

    Raises
    ------
    InputError, MotionError
        As `follower_cam`.
    """
    del instants
    plate = with_follower(cam)
    forces = follower_forces(plate)
    return FollowerForceResults(plate, forces, dataset_of_forces(plate, forces, angles_of(plate, samples)))


def results_of_cam_forces(cam: PlateCam, dataset: xr.Dataset) -> FollowerForceResults:
    """A dataset of `cam_forces` with the forces over the whole turn."""
    return FollowerForceResults(cam, follower_forces(cam), dataset)


def has_forces(cam: AnyCam) -> bool:
    """Whether masses, a spring or a load of a follower are given, and a size of its cam that can be made.

    Raises InputError for a profile that is undercut, as `follower_cam`.
    """
    if not isinstance(cam, PlateCam):
        return False
    follower = cam.follower
    given = follower.mass or follower.inertia or follower.load or follower.spring is not None
    return bool(given) and has_profile(cam)


# Second routes


def virtual_work_difference(forces: FollowerForces) -> tuple[float, float]:
    """The torque against what push and friction do on the follower's way and where surfaces slide.

    Returns the greatest difference [N m], and the greatest force times the greatest radius [N m].
    """
    rows, acting = forces.body.motion.lift(TURN, 2), forces.at(TURN)
    met = meeting_of(forces.body, rows)
    carried = met.sense * np.stack([-met.place[:, 1], met.place[:, 0]], axis=1)
    slid = np.sum(met.slip * (carried - met.lever * rows[1][:, None]), axis=1)
    lost = forces.friction * acting.normal * slid
    apart = np.abs(acting.torque - (acting.push * rows[1] + lost))
    known = np.isfinite(apart)
    size = float(np.max(np.abs(acting.normal[known]), initial=0.0)) * float(np.abs(met.place).max())
    return float(np.max(apart[known], initial=0.0)), size


def vanishing_push(forces: FollowerForces, burden: Burden, speed: float) -> tuple[float, float]:
    """Size of the least push over a turn, which is to be zero, and the greatest push [N, or N m].

    `speed` is that of the cam [rad/s].
    """
    motion = forces.body.motion
    least = least_push(motion, burden, speed).value
    return abs(least), float(np.abs(burden.required_effort(motion.lift(TURN, 2), speed)).max())


def strip_loads_difference(forces: FollowerForces) -> float:
    """By which share pressures of the strip, added up over its width, differ from the load; NaN if it is nowhere known.

    The stress has to be known: width and modulus of the contact are given.
    """
    acting = forces.at(TURN)
    strip, width = acting.strip, forces.width
    assert strip is not None and width is not None
    load = np.abs(acting.normal) / width
    # the pressures of a strip lie on an ellipse
    across = math.pi * np.arange(1, NODES + 1) / (NODES + 1)
    ellipse = math.pi / (NODES + 1) * float(np.sum(np.sin(across) ** 2))
    apart = np.abs(ellipse * strip.half_width * strip.pressure - load)
    known = np.isfinite(apart)
    if not known.any():
        return math.nan
    return float(np.max(apart[known] / load[known], initial=0.0, where=load[known] > 0.0))
