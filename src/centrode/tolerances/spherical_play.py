"""Play in the joints of spherical linkages: holes that lie off their pins by an arc.

Virtual work as in the plane: a hole that lies off its pin by a small tangent vector d moves an output by R d, with R
the part of the joint's reaction across the pin. Directions of links are those of points a right angle from their
pivots, which no hole moves: then an angle turns with the body and not with the arc between two holes.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.geometry import sphere
from centrode.model.files import document, mechanism_from
from centrode.model.mechanism import Mechanism
from centrode.model.values import Vector
from centrode.tolerances.joint_play import JointPlay

Array: TypeAlias = npt.NDArray[np.float64]

_OF_MASS = ("mass", "centre", "inertia", "shape", "radius", "masses", "centre_radius", "model")
_OF_FORCES = ("gravity", "loads", "machine", "simulation", "tolerances", "radius")


def with_free_holes(mechanism: Mechanism, joints: Sequence[JointPlay]) -> Mechanism:
    """The same linkage without masses, in which the places of these holes are numbers of their own."""
    tables = document(mechanism)
    for key in _OF_FORCES:
        tables.pop(key, None)
    for link in tables["links"].values():
        for key in _OF_MASS:
            link.pop(key, None)
    holes = {joint.body for joint in joints}
    markers = _Markers(mechanism)
    for name in holes:
        link = tables["links"][name]
        link.pop("length", None)
        places = mechanism.links[name].coordinates
        link["points"] = {point: list(place) for point, place in places.items()}
        if len(places) > 1:
            first, second = list(places)[:2]
            # the second point says the link's direction: no hole, so that none turns it
            link["points"] = {first: list(places[first]), markers.of(name, first, second): None} | link[
                "points"
            ]
    for name, described in mechanism.links.items():
        if described.reference is not None:
            pivot, towards = described.reference
            base = next(
                (body for body in holes if {pivot, towards} <= set(mechanism.links[body].coordinates)), None
            )
            if base is not None:
                tables["links"][name]["reference"] = [pivot, markers.of(base, pivot, towards)]
    for (name, marker), place in markers.places.items():
        tables["links"][name]["points"][marker] = list(place)
    return mechanism_from(tables)


class _Markers:
    """Points of links that say directions: a right angle from a pivot on the arc to another point."""

    def __init__(self, mechanism: Mechanism) -> None:
        self.mechanism = mechanism
        self.places: dict[tuple[str, str], Vector] = {}
        self._known: dict[tuple[str, str, str], str] = {}

    def of(self, link: str, pivot: str, towards: str) -> str:
        """Name of the point of a link in the direction of one of its arcs."""
        key = link, pivot, towards
        if key not in self._known:
            number = len(self._known)
            while (name := f"direction_{number}") in self.mechanism.points:
                number += len(self.mechanism.points) + 1
            places = self.mechanism.links[link].coordinates
            along = sphere.unit(math, sphere.tangent_inside(math, places[pivot], places[towards]))
            self.places[link, name] = angles_of(np.array(along))
            self._known[key] = name
        return self._known[key]


def angles_of(vector: Array) -> Vector:
    """Longitude and latitude [rad] of a direction (3,)."""
    x, y, z = (float(one) for one in vector)
    return math.atan2(y, x), math.atan2(z, math.hypot(x, y))


def tangent_basis(place: Vector) -> Array:
    """Unit vectors (3, 3) at longitude and latitude: eastwards, northwards, outwards."""
    longitude, latitude = place
    c, s = math.cos(longitude), math.sin(longitude)
    rise, over = math.cos(latitude), math.sin(latitude)
    return np.array([[-s, c, 0.0], [-c * over, -s * over, rise], [c * rise, s * rise, over]])


def displaced_place(place: Vector, play: float, angle: float) -> tuple[Array, Array]:
    """How far longitude and latitude move where a hole lies off by an arc in a direction (0 east, pi/2 north).

    Returns both [rad] and their derivatives by the direction.
    """
    east, north, outwards = tangent_basis(place)
    c, s = math.cos(play), math.sin(play)
    x, y, z = c * outwards + s * (math.cos(angle) * east + math.sin(angle) * north)
    dx, dy, dz = s * (math.cos(angle) * north - math.sin(angle) * east)
    longitude, latitude = angles_of(np.array([x, y, z]))
    level = math.hypot(x, y)
    moved = np.array([math.remainder(longitude - place[0], math.tau), latitude - place[1]])
    return moved, np.array([(x * dy - y * dx) / level**2, dz / level])


def hole_slopes(slopes: Array, place: Vector) -> Array:
    """Derivatives (samples, 2) per arc eastwards and northwards from those by longitude and latitude."""
    return np.stack([slopes[:, 0] / math.cos(place[1]), slopes[:, 1]], axis=-1)


def sides_in_links(
    mechanism: Mechanism, joints: Sequence[JointPlay], found: xr.Dataset, motion: xr.Dataset
) -> dict[str, Array]:
    """Unit vectors (samples, 2), east and north on the link, to the side that a joint's force presses its pin to.

    `found` is what `reactions` gives of the mechanism, `motion` what `motion` does.
    """
    positions = {
        str(point): motion["position"].sel(point=point).to_numpy() for point in motion["point"].values
    }
    sides = {}
    for joint in joints:
        axes = attitudes(mechanism, joint.body, positions)
        # the pin pushes the link to where it lies in the hole
        force = found["joint_force"].sel(side=joint.name).to_numpy()
        east, north, _outwards = tangent_basis(mechanism.links[joint.body].coordinates[joint.point])
        parts = [np.einsum("si,sij,j->s", force, axes, one) for one in (east, north)]
        side = np.stack(parts, axis=-1)
        with np.errstate(invalid="ignore", divide="ignore"):
            sides[joint.name] = side / np.hypot(*side.T)[:, None]
    return sides


def attitudes(mechanism: Mechanism, body: str, positions: Mapping[str, Array]) -> Array:
    """Matrices (samples, 3, 3) from the axes of a link to those of the frame, by two of its points.

    NaN of a link with one point, whose direction no point tells.
    """
    places = mechanism.links[body].coordinates
    if len(places) < 2:
        return np.full((len(next(iter(positions.values()))), 3, 3), np.nan)
    first, second = list(places)[:2]
    inside = _triad(*(tangent_basis(places[point])[2][None] for point in (first, second)))[0]
    return np.asarray(_triad(positions[first], positions[second]) @ inside.T)


def _triad(first: Array, second: Array) -> Array:
    """Axes (samples, 3, 3) as columns: one along the first vector, one in the plane of both, one across."""
    across = np.cross(first, second)
    across = across / np.linalg.norm(across, axis=-1, keepdims=True)
    return np.stack([first, np.cross(across, first), across], axis=-1)
