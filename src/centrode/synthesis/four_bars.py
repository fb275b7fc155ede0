"""Four-bar linkages as arrays: the coupler, its point, and their exact derivatives by every dimension.

A lane of arrays is one linkage O-A-B-D in the complex plane: fixed hinges O and D, crank OA of length a, coupler AB of
length b, rocker DB of length c, and P at p from A in the axes of the coupler, whose x axis points from A to B. Its nine
dimensions stand in one row in the order of `DIMENSIONS`; the tenth variable of a fit is the phase of crank angles.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

Array: TypeAlias = npt.NDArray[np.float64]
Booleans: TypeAlias = npt.NDArray[np.bool_]
Complex: TypeAlias = npt.NDArray[np.complex128]

DIMENSIONS = ("O.x", "O.y", "D.x", "D.y", "OA", "AB", "DB", "P.x", "P.y")
OX, OY, DX, DY, CRANK, COUPLER, ROCKER, PX, PY = range(9)


@dataclass(frozen=True, eq=False)
class CouplerMotion:
    """Where the coupler stands at given crank angles.

    Attributes
    ----------
    point : (lanes, n) P [m]
    direction : (lanes, n) unit vector from A to B
    radicand : (lanes, n) negative where the linkage does not close
    sine : (lanes, n) sine of the transmission angle with its sign
    """

    point: Complex
    direction: Complex
    radicand: Array
    sine: Array


@dataclass(frozen=True, eq=False)
class CouplerSlopes:
    """Derivatives of P and of the angle of the coupler.

    Attributes
    ----------
    point : (lanes, n, 9) of P by the dimensions
    angle : (lanes, n, 9) of the coupler's angle [rad] by the dimensions
    point_by_crank : (lanes, n) of P by the crank's angle [m/rad]
    angle_by_crank : (lanes, n) of the coupler's angle by the crank's
    """

    point: Complex
    angle: Array
    point_by_crank: Complex
    angle_by_crank: Array


def coupler_motion(linkages: Array, crank: Array, side: Array) -> CouplerMotion:
    """The coupler at crank angles.

    Parameters
    ----------
    linkages : (lanes, 9) in the order of `DIMENSIONS` [m]
    crank : (lanes, n) or (n,) angles of OA from the x axis [rad]
    side : (lanes,) +1 where B lies to the left of the line from A to D, -1 to the right

    Notes
    -----
    Where a linkage does not close the coupler is put along the line AD, and its radicand is negative.
    """
    fixed, other, a, b, c, p = _parts(linkages)
    joint = fixed + a * np.exp(1j * crank)
    line = other - joint
    square = np.maximum(line.real**2 + line.imag**2, 1e-300)
    along = (square + b * b - c * c) / (2 * square)
    radicand = b * b / square - along * along
    height = np.sqrt(np.maximum(radicand, 0.0))
    direction = line * (along + 1j * side[:, None] * height)
    direction = direction / np.maximum(np.abs(direction), 1e-300)
    rocker = joint + b * direction - other
    sine = (np.conj(rocker) * 1j * direction).real / c
    return CouplerMotion(joint + direction * p, direction, radicand, sine)


def coupler_slopes(linkages: Array, crank: Array, motion: CouplerMotion) -> CouplerSlopes:
    """Derivatives at the same angles, from the closure |B - D| = c differentiated once.

    They are infinite at a toggle position, where the rocker stands along the coupler.
    """
    fixed, other, a, b, c, p = _parts(linkages)
    turned = np.broadcast_to(np.exp(1j * crank), motion.point.shape)
    direction = motion.direction
    rocker = fixed + a * turned + b * direction - other
    bar = np.conj(rocker)
    leverage = (bar * 1j * direction).real * b
    leverage = np.where(np.abs(leverage) < 1e-14, 1e-14, leverage)
    one = np.ones_like(turned)
    zero = np.zeros_like(turned)
    # How A, B without the turn of the coupler, and D move with each dimension.
    by_joint = np.stack([one, 1j * one, zero, zero, turned, zero, zero, zero, zero], axis=-1)
    pulls = np.stack([one, 1j * one, -one, -1j * one, turned, direction, zero, zero, zero], axis=-1)
    angle = -(bar[..., None] * pulls).real / leverage[..., None]
    angle[..., ROCKER] += c / leverage
    point = by_joint + (1j * direction * p)[..., None] * angle
    point[..., PX] += direction
    point[..., PY] += 1j * direction
    swing = 1j * a * turned
    angle_by_crank = -(bar * swing).real / leverage
    return CouplerSlopes(point, angle, swing + 1j * direction * p * angle_by_crank, angle_by_crank)


def _parts(linkages: Array) -> tuple[Complex, Complex, Array, Array, Array, Complex]:
    column = [linkages[:, k, None] for k in range(9)]
    return (
        column[OX] + 1j * column[OY],
        column[DX] + 1j * column[DY],
        column[CRANK],
        column[COUPLER],
        column[ROCKER],
        column[PX] + 1j * column[PY],
    )


def lengths(linkages: Array) -> Array:
    """Ground, crank, coupler and rocker (lanes, 4) [m]."""
    ground = np.hypot(linkages[:, DX] - linkages[:, OX], linkages[:, DY] - linkages[:, OY])
    ground = np.maximum(ground, 1e-12)
    return np.column_stack([ground, linkages[:, CRANK], linkages[:, COUPLER], linkages[:, ROCKER]])


def crank_margins(linkages: Array) -> Array:
    """How far a linkage is from a crank that turns fully (lanes, 2), in units of frame and crank together.

    The crank turns fully where A comes no nearer to D than |b - c| and no farther than b + c: both margins are positive
    then (Grashof's rule, without naming the shortest link).
    """
    ground, a, b, c = lengths(linkages).T
    total = ground + a
    return np.column_stack([(np.abs(ground - a) - np.abs(b - c)) / total, (b + c - ground - a) / total])


def least_transmission(linkages: Array) -> Array:
    """Least angle between coupler and rocker over a full turn of the crank (lanes,) [rad], folded to at most 90 deg.

    It lies where the crank stands along the frame (H. Alt, VDI-Z 85, 1941). NaN where the crank does not turn fully.
    """
    ground, a, b, c = lengths(linkages).T
    ends = np.column_stack([np.abs(ground - a), ground + a])
    with np.errstate(invalid="ignore", divide="ignore"):
        cosine = ((b * b + c * c)[:, None] - ends**2) / (2 * b * c)[:, None]
        greatest = np.abs(cosine).max(axis=1)
        return np.where(greatest <= 1.0, np.arccos(np.minimum(greatest, 1.0)), np.nan)


def cosines_of_transmission(linkages: Array, first: Array, last: Array) -> Array:
    """Greatest and least cosine of the angle ABD (lanes, 2) while the crank turns from one angle to another [rad].

    The crank counts from the frame OD, first <= last. Beyond one, positive or negative, the linkage is open.
    The cosine grows with that of the crank's angle, so both lie at the ends or where the crank stands along the frame.
    """
    ground, a, b, c = lengths(linkages).T
    ends = np.cos(np.column_stack([first, last]))
    # multiples of a half turn within the range: even ones along the frame, odd ones opposite
    along = np.floor(last / (2 * np.pi)) >= np.ceil(first / (2 * np.pi))
    opposite = np.floor((last - np.pi) / (2 * np.pi)) >= np.ceil((first - np.pi) / (2 * np.pi))
    greatest = np.where(along, 1.0, ends.max(axis=1))
    least = np.where(opposite, -1.0, ends.min(axis=1))
    squared = (ground**2 + a**2)[:, None] - (2 * ground * a)[:, None] * np.column_stack([greatest, least])
    cosines: Array = ((b * b + c * c)[:, None] - squared) / (2 * b * c)[:, None]
    return cosines


def transform(linkages: Array, factor: Complex, shift: Complex) -> Array:
    """Linkages turned and scaled by a complex factor (lanes,), then moved by `shift` (lanes,) [m]."""
    moved = linkages.copy()
    size = np.abs(factor)
    for x, y in ((OX, OY), (DX, DY)):
        place = factor * (linkages[:, x] + 1j * linkages[:, y]) + shift
        moved[:, x], moved[:, y] = place.real, place.imag
    for k in (CRANK, COUPLER, ROCKER, PX, PY):
        moved[:, k] = size * linkages[:, k]
    return moved


def mirror_image(linkages: Array) -> Array:
    """Mirror images in the x axis; the side of B changes with them, which the caller does."""
    image = linkages.copy()
    image[:, [OY, DY, PY]] *= -1
    return image
