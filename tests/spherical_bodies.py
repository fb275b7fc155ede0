"""Spherical links as clouds of mass points, and what they do by the places of their points alone."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

import centrode as ct
from growing_sphere import unit

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Cloud:
    """Mass points of a link: masses (n) [kg], places (n, 3) [m] in the link's own axes."""

    masses: Array
    places: Array

    @property
    def mass(self) -> float:
        return float(self.masses.sum())

    @property
    def centre(self) -> Array:
        return np.asarray(self.masses @ self.places / self.mass)

    @property
    def tensor(self) -> Array:
        """Of inertia about the centre of mass."""
        r = self.places - self.centre
        squares = np.einsum("n,nk,nk->", self.masses, r, r)
        return np.asarray(squares * np.eye(3) - np.einsum("n,ni,nj->ij", self.masses, r, r))

    @property
    def size(self) -> float:
        """Sum of m r^2 about the centre of the sphere."""
        return float(np.einsum("n,nk,nk->", self.masses, self.places, self.places))

    def keys(self) -> dict[str, Any]:
        """What a description says of it."""
        distance = float(np.linalg.norm(self.centre))
        return {
            "mass": self.mass,
            "centre": (self.centre / distance).tolist(),
            "centre_radius": distance,
            "inertia": self.tensor.tolist(),
        }


def drawn(random: np.random.Generator, reach: float, count: int = 5) -> Cloud:
    """A cloud about a place within a ball."""
    places = reach * (0.4 * random.normal(size=3) + 0.3 * random.normal(size=(count, 3)))
    return Cloud(random.uniform(0.2, 2.0, count), places)


def place(data: xr.Dataset, name: str, variable: str = "position") -> Array:
    """A vector of a point (n, 3) on the unit sphere."""
    return np.asarray(data[variable].sel(point=name))


def triad(first: Array, second: Array) -> Array:
    """Axes (..., 3, 3), as columns, of two places: the first, square to it towards the second, and their product."""
    towards = second - first * np.sum(first * second, axis=-1, keepdims=True)
    towards = towards / np.linalg.norm(towards, axis=-1, keepdims=True)
    return np.stack([first, towards, np.cross(first, towards)], axis=-1)


def inside(mechanism: ct.Mechanism, name: str) -> dict[str, Array]:
    """Places of a link's points in its own axes."""
    return {point: unit(list(at)) for point, at in mechanism.links[name].coordinates.items()}


def rotation(mechanism: ct.Mechanism, data: xr.Dataset, name: str) -> Array:
    """How a link stands (n, 3, 3), by the places of its first two points."""
    (first, one), (second, other) = list(inside(mechanism, name).items())[:2]
    there = triad(place(data, first), place(data, second))
    return np.asarray(there @ triad(one, other).T)


def spin(data: xr.Dataset, name: str, variable: str = "angular_velocity") -> Array:
    """Angular velocity or acceleration (n, 3); none of the frame."""
    if name == "frame":
        return np.zeros((data.sizes["sample"], 3))
    return np.asarray(data[variable].sel(link=name))


def velocities(mechanism: ct.Mechanism, data: xr.Dataset, name: str, cloud: Cloud) -> tuple[Array, Array]:
    """Velocities and accelerations of the mass points (n, points, 3)."""
    places = np.einsum("nij,pj->npi", rotation(mechanism, data, name), cloud.places)
    omega, epsilon = (spin(data, name, f"angular_{x}")[:, None, :] for x in ("velocity", "acceleration"))
    speed = np.cross(omega, places)
    return speed, np.cross(epsilon, places) + np.cross(omega, speed)


def dot(a: Array, b: Array) -> Array:
    return np.asarray(np.sum(a * b, axis=-1))
