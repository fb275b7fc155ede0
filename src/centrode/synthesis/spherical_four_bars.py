"""Spherical four-bar linkages as arrays: the coupler, its point, and their exact derivatives by every dimension.

A lane of arrays is one linkage O-A-B-D on the unit sphere: fixed hinges O and D, crank OA, coupler AB and rocker DB as
arcs, and P at a longitude and latitude in the axes of the coupler, A at longitude 0 and B on the equator. Its nine
dimensions stand in the order of `SPHERE_DIMENSIONS`, where those of the plane stand. Derivatives are those of steps in
the imaginary direction, which lose no digits (J. N. Lyness, C. B. Moler, SIAM J. Numer. Anal. 4, 1967, 202-210).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from centrode.synthesis.four_bars import Array, Booleans
from centrode.synthesis.least_squares import ATTACHMENT, PHASE, VARIABLES, FitKernel, Targets

SPHERE_DIMENSIONS = (
    "O.longitude", "O.latitude", "D.longitude", "D.latitude", "OA", "AB", "DB", "P.longitude", "P.latitude",
)  # fmt: skip
O_LON, O_LAT, D_LON, D_LAT, CRANK, COUPLER, ROCKER, P_LON, P_LAT = range(9)
STEP = 1e-30
"""In the imaginary direction."""


@dataclass(frozen=True, eq=False)
class SphericalMotion:
    """Where the coupler stands at given crank angles.

    Attributes
    ----------
    crank, rocker : (lanes, n, 3) unit vectors of A and B
    radicand : (lanes, n) negative where the linkage does not close
    east, up : (lanes, n, 3) the other axes of the coupler: towards B on its equator, and its pole
    """

    crank: Any
    rocker: Any
    radicand: Any
    east: Any
    up: Any


def unit_vectors(longitude: Any, latitude: Any) -> Any:
    """(..., 3) of longitudes and latitudes [rad]."""
    return np.stack(
        [np.cos(latitude) * np.cos(longitude), np.cos(latitude) * np.sin(longitude), np.sin(latitude)],
        axis=-1,
    )


def longitudes(vectors: Array) -> tuple[Array, Array]:
    """Longitude and latitude (...) [rad] of unit vectors (..., 3)."""
    return np.arctan2(vectors[..., 1], vectors[..., 0]), np.arcsin(np.clip(vectors[..., 2], -1.0, 1.0))


def east_and_north(vectors: Array) -> tuple[Array, Array]:
    """Unit vectors (..., 3) of growing longitude and latitude."""
    longitude, latitude = longitudes(vectors)
    zero = np.zeros_like(longitude)
    east = np.stack([-np.sin(longitude), np.cos(longitude), zero], axis=-1)
    north = np.stack(
        [-np.sin(latitude) * np.cos(longitude), -np.sin(latitude) * np.sin(longitude), np.cos(latitude)],
        axis=-1,
    )
    return east, north


def _dot(first: Any, second: Any) -> Any:
    return (first * second).sum(axis=-1)


def spherical_motion(linkages: Any, crank: Any, side: Array) -> SphericalMotion:
    """The coupler at crank angles from the arc OD.

    Parameters
    ----------
    linkages : (lanes, 9) [rad]; with imaginary parts all results have them
    crank : (lanes, n) or (n,) [rad]
    side : (lanes,) +1 where B lies to the left of the arc from A to D, seen from outside
    """
    column = [linkages[:, k, None] for k in range(9)]
    fixed, other = unit_vectors(column[0], column[1]), unit_vectors(column[2], column[3])
    a, b, c = (column[k][..., None] for k in (CRANK, COUPLER, ROCKER))
    towards, across = _axes(fixed, other)
    turn = crank[..., None]
    joint = np.cos(a) * fixed + np.sin(a) * (np.cos(turn) * towards + np.sin(turn) * across)
    near = _dot(joint, other)[..., None]
    sine = 1 - near * near
    cos_b, cos_c = np.cos(b), np.cos(c)
    along = (cos_b - near * cos_c) / sine
    back = (cos_c - near * cos_b) / sine
    radicand = (1 - along * cos_b - back * cos_c) / sine
    height = np.sqrt(np.where(radicand.real > 0, radicand, 1e-300))
    end = along * joint + back * other + side[:, None, None] * height * _cross(joint, other)
    # a coupler without length has no direction: its candidates are dropped by their bounds
    sin_b = np.sin(b)
    sin_b = np.where(np.abs(sin_b) > 1e-12, sin_b, 1e-12)
    return SphericalMotion(
        joint, end, radicand[..., 0].real, (end - cos_b * joint) / sin_b, _cross(joint, end) / sin_b
    )


def coupler_points(motion: SphericalMotion, linkages: Any) -> Any:
    """P (lanes, n, 3) as unit vectors."""
    longitude, latitude = (linkages[:, k, None, None] for k in (P_LON, P_LAT))
    level = np.cos(longitude) * motion.crank + np.sin(longitude) * motion.east
    return np.cos(latitude) * level + np.sin(latitude) * motion.up


def coupler_headings(motion: SphericalMotion, linkages: Any, attachment: Any) -> Any:
    """Unit vectors (lanes, n, 3) at P: the x axis of a body, turned by attachments (lanes,) from the coupler's east."""
    longitude, latitude = (linkages[:, k, None, None] for k in (P_LON, P_LAT))
    turned = attachment[:, None, None]
    level = np.cos(longitude) * motion.crank + np.sin(longitude) * motion.east
    east = np.cos(longitude) * motion.east - np.sin(longitude) * motion.crank
    return np.cos(turned) * east + np.sin(turned) * (np.cos(latitude) * motion.up - np.sin(latitude) * level)


def rocker_angles_from_frame(motion: SphericalMotion, linkages: Any) -> Any:
    """Angles of DB from the arc DO (lanes, n), counter-clockwise seen from outside [rad]."""
    column = [linkages[:, k, None] for k in range(4)]
    fixed, other = unit_vectors(column[0], column[1]), unit_vectors(column[2], column[3])
    home, beside = _axes(other, fixed)
    sine, cosine = _dot(motion.rocker, beside), _dot(motion.rocker, home)
    angle = np.arctan2(sine.real, cosine.real)
    if np.iscomplexobj(sine):
        # that of a complex step: the angle of the real parts, and its slope
        square = sine.real**2 + cosine.real**2
        angle = angle + 1j * (sine.imag * cosine.real - cosine.imag * sine.real) / square
    return angle


def _cross(first: Any, second: Any) -> Any:
    x, y, z = (first[..., k] for k in range(3))
    u, v, w = (second[..., k] for k in range(3))
    return np.stack([y * w - z * v, z * u - x * w, x * v - y * u], axis=-1)


def _axes(first: Any, second: Any) -> tuple[Any, Any]:
    """Unit vectors at the first point: towards the second, and to the left of that seen from outside."""
    towards = second - _dot(first, second)[..., None] * first
    square = _dot(towards, towards)[..., None]
    towards = towards / np.sqrt(np.where(square.real > 1e-24, square, 1e-24))
    return towards, _cross(first, towards)


def _residuals(targets: Targets, variables: Array, side: Array, angles: Array) -> tuple[Array, Booleans]:
    rows, radicand = _rows(targets, variables, side, angles)
    return rows, np.all(radicand > 0, axis=1)


def _rows(targets: Targets, variables: Any, side: Array, angles: Any) -> tuple[Any, Array]:
    motion = spherical_motion(variables[:, :9], angles, side)
    rows = [coupler_points(motion, variables) - targets.points]
    if targets.directions is not None:
        heading = coupler_headings(motion, variables, variables[:, ATTACHMENT])
        rows.append(targets.arm * (heading - targets.directions))
    return np.concatenate(rows, axis=-1), motion.radicand


def _slopes(targets: Targets, variables: Array, side: Array, angles: Array) -> tuple[Array, Array]:
    lanes, n = angles.shape
    rows = 6 if targets.directions is not None else 3
    by = np.zeros((lanes, n, rows, VARIABLES))
    for k in (*range(9), ATTACHMENT):
        moved = variables.astype(np.complex128)
        moved[:, k] += 1j * STEP
        by[..., k] = _rows(targets, moved, side, angles)[0].imag / STEP
    turn = _rows(targets, variables.astype(np.complex128), side, angles + 1j * STEP)[0].imag / STEP
    by[..., PHASE] = turn
    return by, turn


SPHERE = FitKernel(_residuals, _slopes)


def hinges_within(
    linkages: Array, longitude: tuple[float, float] | None, latitude: tuple[float, float] | None
) -> Booleans:
    """Which linkages (lanes, 9) have O and D within least and greatest longitudes and latitudes [rad]."""
    inside: Booleans = np.full(len(linkages), True)
    for lon, lat in ((O_LON, O_LAT), (D_LON, D_LAT)):
        east, north = longitudes(unit_vectors(linkages[:, lon], linkages[:, lat]))
        if longitude is not None:
            # counted on from the least one, a turn of which is the same meridian
            inside &= np.mod(east - longitude[0], 2 * np.pi) <= longitude[1] - longitude[0]
        if latitude is not None:
            inside &= (north >= latitude[0]) & (north <= latitude[1])
    return inside


def in_range(linkage: Array, attachment: float) -> tuple[Array, float]:
    """The same linkage (9,) with latitudes up to a right angle, and its attachment.

    Beyond the pole of the coupler's axes east is the opposite direction.
    """
    row = linkage.copy()
    for lon, lat in ((O_LON, O_LAT), (D_LON, D_LAT), (P_LON, P_LAT)):
        vector = unit_vectors(linkage[lon], linkage[lat])
        row[lon], row[lat] = (float(x) for x in longitudes(vector))
    beyond = np.cos(linkage[P_LAT]) < 0
    return row, attachment + np.pi if beyond else attachment


def frame_arcs(linkages: Array) -> Array:
    """Arcs OD (lanes,) [rad]."""
    fixed = unit_vectors(linkages[:, O_LON], linkages[:, O_LAT])
    other = unit_vectors(linkages[:, D_LON], linkages[:, D_LAT])
    sine: Array = np.linalg.norm(np.cross(fixed, other), axis=-1)
    arcs: Array = np.arctan2(sine, _dot(fixed, other))
    return arcs


def _reaches(linkages: Array) -> tuple[Array, Array, Array]:
    """Least and greatest arc AD over a turn (lanes, 2), and coupler and rocker (lanes,)."""
    frame, crank = frame_arcs(linkages), linkages[:, CRANK]
    far = frame + crank
    ends = np.column_stack([np.abs(frame - crank), np.minimum(far, 2 * np.pi - far)])
    return ends, linkages[:, COUPLER], linkages[:, ROCKER]


def spherical_crank_margins(linkages: Array) -> Array:
    """How far a linkage is from a crank that turns fully (lanes, 6) [rad]: all are positive then.

    The spherical triangle ABD closes where each side is smaller than the sum of the others, and all are smaller than a
    great circle (C. H. Chiang, Kinematics of Spherical Mechanisms, 1988).
    """
    ends, b, c = _reaches(linkages)
    return np.concatenate(
        [ends - np.abs(b - c)[:, None], (b + c)[:, None] - ends, 2 * np.pi - (b + c)[:, None] - ends], axis=1
    )


def transmission_cosines(linkages: Array) -> Array:
    """Cosines (lanes, 2) of the angle between coupler and rocker where the crank lies along the frame."""
    ends, b, c = _reaches(linkages)
    with np.errstate(divide="ignore", invalid="ignore"):
        cosines: Array = (np.cos(ends) - (np.cos(b) * np.cos(c))[:, None]) / (np.sin(b) * np.sin(c))[:, None]
    return cosines
