"""The bodies of a motion on the sphere: all turn about its centre, so angular velocities tell everything.

Attitudes are matrices whose columns are a body's axes in those of the frame; they follow from the places of two
of its points. The slider of a guide turns about the pole of its circle against what carries the guide, and its axes
are those of that body, turned by the displacement.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import combinations
from typing import Any

import numpy as np
import xarray as xr

from centrode.analysis.instant_centres.bodies import Array, Named, Pair, described, sliders_of
from centrode.kinematics.motion import BATCH
from centrode.model.mechanism import FRAME, Guide, Mechanism
from centrode.model.sphere import unit_vector

ORDERS = ("axes", "spin", "spin_rate", "speed")
BY_DRIVE = ("velocity_coefficient", "acceleration_coefficient")
IN_TIME = ("velocity", "acceleration")


@dataclass(frozen=True)
class TurningBodies(Named):
    """Frame, links and sliders over a motion on the sphere; a batch has its dimension in front.

    Attributes
    ----------
    axes : (..., samples, bodies, 3, 3) own axes of each body as columns; NaN of a link of one point
    spin, spin_rate : (..., samples, bodies, 3) angular velocity and acceleration [1 by unit of the drive; with
        several drives rad/s, rad/s^2]
    speed : (..., samples, bodies, 3) angular velocity [rad/s]
    points : point -> (..., samples, 3) its places
    """

    axes: Array
    spin: Array
    spin_rate: Array
    speed: Array
    points: dict[str, Array]

    @cached_property
    def rate(self) -> Array:
        """Greatest angular velocity of the motion at each sample [by unit of the drive]."""
        return np.asarray(np.max(np.linalg.norm(self.spin, axis=-1), axis=-1))

    def relative(self, pair: Pair) -> Array:
        """Angular velocity of the first body against the second (..., samples, 3)."""
        return np.asarray(self.spin[..., pair[0], :] - self.spin[..., pair[1], :])

    def two_places(self, body: int) -> tuple[Array, Array]:
        """Two places of a body that neither coincide nor lie opposite."""
        name = self.names[body]
        named = [] if name in self.sliders else list(self.mechanism.points_of(name))
        if len(named) > 1:
            first, second = _best(self.mechanism, name, named)
            return self.points[first], self.points[second]
        place = self.points[self.sliders[name].point] if name in self.sliders else self._any(named)
        least = np.argmin(np.abs(place), axis=-1)[..., None]
        across = np.cross(place, np.where(least == np.arange(3), 1.0, 0.0))
        return place, np.asarray(across / np.linalg.norm(across, axis=-1, keepdims=True))

    def _any(self, named: list[str]) -> Array:
        return self.points[named[0]] if named else np.broadcast_to([1.0, 0.0, 0.0], (*self.rate.shape, 3))

    def sample(self, number: int) -> TurningBodies:
        """One sample of a motion that is no batch."""
        points = {name: place[number] for name, place in self.points.items()}
        return replace(self, points=points, **{name: getattr(self, name)[number] for name in ORDERS})


def turning_bodies_of(motion: xr.Dataset) -> TurningBodies:
    """The bodies of a motion on the sphere."""
    if BATCH not in motion.dims:
        return _of_one(motion)
    lanes = [_of_one(motion.isel({BATCH: k})) for k in range(motion.sizes[BATCH])]
    arrays: dict[str, Any] = {name: np.stack([getattr(lane, name) for lane in lanes]) for name in ORDERS}
    points = {name: np.stack([lane.points[name] for lane in lanes]) for name in lanes[0].points}
    return replace(lanes[0], points=points, **arrays)


def _of_one(motion: xr.Dataset) -> TurningBodies:
    mechanism = described(motion)
    sliders = sliders_of(mechanism)
    names = (FRAME, *mechanism.link_names, *sliders)
    samples = motion.sizes["sample"]
    points = {str(name): motion["position"].sel(point=name).to_numpy() for name in motion["point"].values}
    axes = np.tile(np.eye(3), (samples, len(names), 1, 1))
    for number, name in enumerate(mechanism.link_names, start=1):
        axes[:, number] = _attitudes(mechanism, name, points, samples)
    orders = BY_DRIVE if "velocity_coefficient" in motion else IN_TIME
    spin, spin_rate, speed = (
        _angular(motion, f"angular_{order}", len(names)) for order in (*orders, "velocity")
    )
    for number, guide in enumerate(sliders.values(), start=len(names) - len(sliders)):
        base = names.index(guide.on)
        slides = [motion[v].sel(guide=guide.id).to_numpy() / math.sin(guide.arc) for v in _slides(orders)]
        pole = axes[:, base] @ np.array(unit_vector(pole_of(mechanism, guide)))
        axes[:, number] = _turned(pole, slides[0]) @ axes[:, base]
        spin[:, number] = spin[:, base] + slides[1][:, None] * pole
        carried = slides[2][:, None] * pole + slides[1][:, None] * np.cross(spin[:, base], pole)
        spin_rate[:, number] = spin_rate[:, base] + carried
        speed[:, number] = speed[:, base] + slides[3][:, None] * pole
    absent = ~np.isfinite(spin).all(axis=(1, 2))
    for found in (spin, spin_rate, speed):
        found[absent] = np.nan  # the frame's too, in a singular position
    return TurningBodies(mechanism, names, sliders, axes, spin, spin_rate, speed, points)


def _slides(orders: tuple[str, str]) -> tuple[str, ...]:
    return "slide", f"slide_{orders[0]}", f"slide_{orders[1]}", "slide_velocity"


def _angular(motion: xr.Dataset, variable: str, count: int) -> Array:
    """A vector of every link, with zeros for the frame and room for the sliders."""
    values = motion[variable].to_numpy()
    found = np.zeros((len(values), count, 3))
    found[:, 1 : 1 + values.shape[1]] = values
    return found


def _attitudes(mechanism: Mechanism, name: str, points: dict[str, Array], samples: int) -> Array:
    """Axes of a link over the samples, from the two of its points that tell them best."""
    own = mechanism.points_of(name)
    if len(own) < 2:
        return np.full((samples, 3, 3), np.nan)
    chosen = _best(mechanism, name, list(own))
    inside = _triad(*(np.array(unit_vector(own[point])) for point in chosen))
    return np.asarray(_triad(*(points[point] for point in chosen)) @ inside.T)


def _best(mechanism: Mechanism, name: str, named: list[str]) -> tuple[str, str]:
    """The two points of a body that lie least in line with the centre of the sphere."""
    own = {point: np.array(unit_vector(at)) for point, at in mechanism.points_of(name).items()}

    def sine(two: tuple[str, str]) -> float:
        return float(np.linalg.norm(np.cross(own[two[0]], own[two[1]])))

    return max(combinations(named, 2), key=sine)


def _triad(first: Array, second: Array) -> Array:
    """Right-handed axes as columns: a place, towards another, and square to both."""
    normal = np.cross(first, second)
    normal = normal / np.linalg.norm(normal, axis=-1, keepdims=True)
    return np.stack([first, np.cross(normal, first), normal], axis=-1)


def pole_of(mechanism: Mechanism, guide: Guide) -> tuple[float, float]:
    """Pole of a guide's circle (longitude, latitude) in the axes of what carries it."""
    pole = guide.pole
    if isinstance(pole, str):
        return mechanism.points_of(guide.on)[pole]
    assert isinstance(pole, tuple)  # a pole cannot be placed
    return pole


def _turned(axis: Array, angle: Array) -> Array:
    """Rotations about unit vectors (samples, 3) by angles (samples)."""
    x, y, z = np.moveaxis(axis, -1, 0)
    zero = np.zeros_like(x)
    around = np.stack([zero, -z, y, z, zero, -x, -y, x, zero], axis=-1).reshape(*x.shape, 3, 3)
    sine, versine = np.sin(angle)[..., None, None], (1.0 - np.cos(angle))[..., None, None]
    return np.asarray(np.eye(3) + sine * around + versine * (around @ around))
