"""Poses of a body that turns about a centre: points of it that stay on a circle of the sphere, and its poles.

A pose j takes a unit vector w of the body from its place in the first pose to R_j w. It stays on a circle about the
pole g where g . (R_j - 1) w = 0 for all poses: bilinear in w and g, as in the plane, and homogeneous. Two poses leave a
pole on a great circle for any w, three one pole, four a cubic cone of w, five at most six pairs (J. M. McCarthy, G. S.
Soh, Geometric Design of Linkages, 2nd ed., 2011, chapter 9).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from centrode.synthesis.burmester import bilinear_pairs
from centrode.synthesis.four_bars import Array, Booleans
from centrode.synthesis.spherical_four_bars import east_and_north, spherical_motion, unit_vectors

GRID = 11
"""Longitudes and latitudes of moving points that are tried where two or three poses leave them free."""
ALONG = 60
OBLIQUE = np.linalg.qr(np.array([[0.9, 0.3, -0.2], [-0.1, 0.8, 0.5], [0.4, -0.3, 0.7]]))[0]
"""Axes in which no solution lies at infinity by chance."""


@dataclass(frozen=True, eq=False)
class SphericalPoses:
    """Poses of a body.

    Attributes
    ----------
    places : (n, 3) unit vectors of its origin
    headings : (n, 3) unit vectors of its x axis there
    """

    places: Array
    headings: Array

    @property
    def rotations(self) -> Array:
        """(n, 3, 3) from the first pose to each."""
        frames = np.stack([self.headings, np.cross(self.places, self.headings), self.places], axis=-1)
        turned: Array = frames @ frames[0].T
        return turned


def poses_of(rows: Array) -> SphericalPoses:
    """Poses of rows (n, 3): longitude, latitude, angle of the x axis from east to north [rad]."""
    places = unit_vectors(rows[:, 0], rows[:, 1])
    east, north = east_and_north(places)
    return SphericalPoses(places, np.cos(rows[:, 2:3]) * east + np.sin(rows[:, 2:3]) * north)


@dataclass(frozen=True, eq=False)
class SphericalDyads:
    """Arcs between a moving point, where it is in the first pose, and a pole: both (n, 3) unit vectors."""

    moving: Array
    fixed: Array


def spherical_closures(poses: SphericalPoses, dyads: SphericalDyads) -> Array:
    """Change (lanes, n - 1) of the cosine of each dyad's arc from the first pose to the others."""
    moved = np.einsum("jkl,dl->djk", poses.rotations[1:], dyads.moving) - dyads.moving[:, None]
    values: Array = (moved * dyads.fixed[:, None]).sum(axis=-1)
    return values


def spherical_dyads(poses: SphericalPoses) -> SphericalDyads:
    """All dyads of five poses, and dyads spread over what fewer poses leave free."""
    changes = poses.rotations[1:] - np.eye(3)
    if len(changes) == 4:
        turned = OBLIQUE.T @ changes @ OBLIQUE
        found = bilinear_pairs(turned[:, :, 0], turned[:, :, 1], turned[:, :, 2])
        pairs = [(OBLIQUE @ [w.real, w.imag, 1.0], OBLIQUE @ [g.real, g.imag, 1.0]) for w, g in found]
        moving = np.array([w for w, _g in pairs]).reshape(-1, 3)
        return _upright(poses, moving, np.array([g for _w, g in pairs]).reshape(-1, 3))
    if len(changes) == 3:
        return _along_the_cone(poses, changes)
    longitude = np.linspace(-np.pi, np.pi, 2 * GRID, endpoint=False)
    latitude = np.arcsin(np.linspace(-0.95, 0.95, GRID))
    moving = unit_vectors(*(x.ravel() for x in np.meshgrid(longitude, latitude, indexing="ij")))
    first = moving @ changes[0].T
    if len(changes) == 2:
        return _upright(poses, moving, np.cross(first, moving @ changes[1].T))
    moving, first = moving[::3], first[::3]
    across = np.cross(first, moving)
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    beside = np.cross(first / np.linalg.norm(first, axis=1, keepdims=True), across)
    angles = np.linspace(0.0, np.pi, 5, endpoint=False)
    fixed = np.cos(angles)[:, None, None] * across + np.sin(angles)[:, None, None] * beside
    return _upright(poses, np.tile(moving, (len(angles), 1)), fixed.reshape(-1, 3))


def _along_the_cone(poses: SphericalPoses, changes: Array) -> SphericalDyads:
    """Dyads of four poses: along meridians of oblique axes the determinant of three rows is a cubic."""
    moving, fixed = [], []
    turned = OBLIQUE.T @ changes @ OBLIQUE
    for u in np.tan(np.linspace(-1.5, 1.5, ALONG)):
        places = np.array([-1.0, 0.0, 1.0, 2.0])
        rows = [turned @ np.array([u, v, 1.0]) for v in places]
        cubic = np.polyfit(places, [np.linalg.det(row) for row in rows], 3)
        for root in np.roots(cubic):
            if abs(root.imag) > 1e-9 * (1 + abs(root)):
                continue
            place = np.array([u, root.real, 1.0])
            _left, _values, right = np.linalg.svd(turned @ place)
            moving.append(OBLIQUE @ place)
            fixed.append(OBLIQUE @ right[-1])
    return _upright(poses, np.array(moving).reshape(-1, 3), np.array(fixed).reshape(-1, 3))


def _upright(poses: SphericalPoses, moving: Array, fixed: Array) -> SphericalDyads:
    """Of each point and its opposite, which are hinges alike, the one near the poses; without those that vanish."""
    middle = poses.places.mean(axis=0)
    sizes = [np.linalg.norm(x, axis=1, keepdims=True) for x in (moving, fixed)]
    good = (np.concatenate(sizes, axis=1) > 1e-9).all(axis=1)
    points = []
    for vectors, size in zip((moving, fixed), sizes, strict=True):
        unit = vectors[good] / size[good]
        points.append(np.where((unit @ middle)[:, None] >= 0, unit, -unit))
    return SphericalDyads(*points)


@dataclass(frozen=True, eq=False)
class PosedLinkages:
    """Linkages of pairs of dyads with what they do in the poses.

    Attributes
    ----------
    linkages : (pairs, 9) in the order of `SPHERE_DIMENSIONS`
    crank : (pairs, poses) angles of the crank from the arc OD [rad]
    sides : (pairs, poses) of B from the arc AD
    attachment : (pairs,) of the body's x axis from the east of the coupler's axes [rad]
    """

    linkages: Array
    crank: Array
    sides: Array
    attachment: Array

    def passes(self, way: Array) -> Booleans:
        """Whether linkages close all along ways (pairs, 2) of the crank, from its first to its last angle."""
        share = np.linspace(0.0, 1.0, 91)
        angles = way[:, :1] + (way[:, 1:] - way[:, :1]) * share
        closes: Booleans = np.all(
            spherical_motion(self.linkages, angles, self.sides[:, 0]).radicand > 0, axis=1
        )
        return closes


def posed_linkages(
    poses: SphericalPoses, dyads: SphericalDyads, pairs: npt.NDArray[np.int64]
) -> PosedLinkages:
    """Linkages of pairs (pairs, 2) of dyads, of which the first is the crank."""
    w, g = (dyads.moving[pairs[:, 0]], dyads.moving[pairs[:, 1]]), (
        dyads.fixed[pairs[:, 0]], dyads.fixed[pairs[:, 1]]
    )  # fmt: skip
    joint, end = (np.einsum("jkl,pl->pjk", poses.rotations, point) for point in w)
    fixed, other = (point[:, None] for point in g)
    towards = other - (fixed * other).sum(-1, keepdims=True) * fixed
    with np.errstate(divide="ignore", invalid="ignore"):
        towards = towards / np.linalg.norm(towards, axis=-1, keepdims=True)
        across = np.cross(fixed, towards)
        crank = np.arctan2((joint * across).sum(-1), (joint * towards).sum(-1))
        sides = np.where((end * np.cross(joint, other)).sum(-1) >= 0, 1.0, -1.0)
        arcs = [_arcs(w[0], g[0]), _arcs(w[0], w[1]), _arcs(w[1], g[1])]
        first = w[0]
        up = np.cross(w[0], w[1]) / np.sin(arcs[1])[:, None]
        east = np.cross(up, first)
        place, heading = poses.places[0], poses.headings[0]
        longitude, latitude = np.arctan2(east @ place, first @ place), np.arcsin(np.clip(up @ place, -1, 1))
        eastwards = np.cos(longitude)[:, None] * east - np.sin(longitude)[:, None] * first
        upwards = np.cross(np.broadcast_to(place, eastwards.shape), eastwards)
        attachment = np.arctan2(upwards @ heading, eastwards @ heading)
    columns = []
    for point in g:
        columns += [np.arctan2(point[:, 1], point[:, 0]), np.arcsin(np.clip(point[:, 2], -1.0, 1.0))]
    return PosedLinkages(np.column_stack([*columns, *arcs, longitude, latitude]), crank, sides, attachment)


def _arcs(first: Array, second: Array) -> Array:
    arcs: Array = np.arctan2(np.linalg.norm(np.cross(first, second), axis=-1), (first * second).sum(-1))
    return arcs
