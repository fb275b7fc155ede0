"""Identities of rigid bodies that a motion was not computed from: rotation about another point, arcs that stay."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.errors import Status
from centrode.model.mechanism import Mechanism

Array: TypeAlias = npt.NDArray[np.float64]
EPS = float(np.finfo(float).eps)
INTERPOLATED = {"velocity": 1e-10, "acceleration": 1e-8}
"""Errors of rates about change points, where motions are interpolated (docs: conventions)."""
ROUNDED = 1 << 20
"""Rounding of a rate is multiplied by this at a transmission angle of 0.06 deg: one over the square of its sine."""


@dataclass(frozen=True)
class RigidBodyCheck:
    """How far a motion is from an identity of rigid bodies, over all samples that are reached.

    Attributes
    ----------
    identity : "velocity" and "acceleration" by the rotation about another point of the link; on the sphere "arcs", the
        chords of links, and "rotation", the velocity as the vector product of rotation and place
    difference, size : the greatest difference, and the greatest quantity [SI]
    bound : the share of the size that rounding allows
    """

    identity: Literal["velocity", "acceleration", "arcs", "rotation"]
    difference: float
    size: float
    bound: float


def rigid_body_checks(mechanism: Mechanism, motion: xr.Dataset) -> tuple[RigidBodyCheck, ...]:
    """Identities on the velocities and accelerations of a motion; none where no sample is reached."""
    reached = motion["status"].values == Status.OK
    if not reached.any():
        return ()
    data = motion.isel(sample=np.flatnonzero(reached))
    if mechanism.space == "sphere":
        return _on_sphere(mechanism, data)
    interpolated = bool(motion["event_kind"].values.any())
    return tuple(_in_plane(mechanism, data, interpolated))


def _in_plane(mechanism: Mechanism, data: xr.Dataset, interpolated: bool) -> Iterator[RigidBodyCheck]:
    rates: tuple[Literal["velocity", "acceleration"], ...] = ("velocity", "acceleration")
    for rate in rates:
        apart = rotation_error(mechanism, data, rate)
        if apart is not None:
            bound = ROUNDED * EPS + (INTERPOLATED[rate] if interpolated else 0.0)
            yield RigidBodyCheck(rate, *apart, bound)


def rotation_error(
    mechanism: Mechanism, data: xr.Dataset, rate: Literal["velocity", "acceleration"]
) -> tuple[float, float] | None:
    """Greatest difference of a rate from the rotation about another point of the link, and the greatest rate [SI].

    None where no link has two points, or nothing moves.
    """
    worst, size = 0.0, 0.0
    for link, described in mechanism.links.items():
        points = list(described.coordinates)
        turn, second = (
            data[f"angular_{word}"].sel(link=link).values[:, None] for word in ("velocity", "acceleration")
        )
        for point in points[1:]:
            arm = _of(data, "position", point) - _of(data, "position", points[0])
            apart = _of(data, rate, point) - _of(data, rate, points[0])
            square = np.stack([-arm[:, 1], arm[:, 0]], axis=1)
            rotation = turn * square if rate == "velocity" else second * square - turn**2 * arm
            worst = max(worst, float(np.nanmax(np.abs(apart - rotation))))
            size = max(
                size, float(np.nanmax(np.abs(_of(data, rate, point)))), float(np.nanmax(np.abs(rotation)))
            )
    return (worst, size) if size else None


def _of(data: xr.Dataset, name: str, point: str) -> Array:
    return np.asarray(data[name].sel(point=point).values, dtype=np.float64)


def _on_sphere(mechanism: Mechanism, data: xr.Dataset) -> tuple[RigidBodyCheck, ...]:
    """Arcs that stay what they are, and v = omega x r."""
    place, rate, turning = (data[name].values for name in ("position", "velocity", "angular_velocity"))
    names, links = data["point"].values.tolist(), data["link"].values.tolist()
    stretch, slip = 0.0, 0.0
    for number, (link, body) in enumerate(mechanism.links.items()):
        points = [names.index(name) for name in body.coordinates]
        if body.length is not None and len(points) == 2:
            chord = np.linalg.norm(place[:, points[0]] - place[:, points[1]], axis=1)
            stretch = max(stretch, float(np.abs(chord - 2.0 * np.sin(body.length / 2.0)).max()))
        if link == links[number] and len(points) > 1:
            for point in points:
                apart = rate[:, point] - np.cross(turning[:, number], place[:, point])
                slip = max(slip, float(np.abs(apart).max()))
    return (
        RigidBodyCheck("arcs", stretch, 1.0, 64.0 * EPS * len(links)),
        RigidBodyCheck("rotation", slip, float(np.abs(rate).max()), ROUNDED * EPS),
    )
