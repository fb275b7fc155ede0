"""Poses of a moving plane: points of it that stay on a circle, and the centres of these circles.

A pose j takes a point w of the plane from its place in the first pose to A_j w + d_j. It stays on a circle about g
through all poses where |A_j w + d_j - g|^2 is the same for all of them. Less that of the first pose this is bilinear in
w and g: |d|^2/2 + Re(conj(d) A w) - Re(conj(g) (A w + d - w)) = 0, with the first pose as the origin of both. Two poses
leave w and g with three degrees of freedom, three with two, four with one (the circle point curve and the centre point
curve, both circular cubics), five leave at most four pairs (L. Burmester, Lehrbuch der Kinematik, 1888; J. M. McCarthy,
G. S. Soh, Geometric Design of Linkages, 2nd ed., 2011, chapter 5).
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.linalg import eig

from centrode.synthesis.four_bars import Array, Complex

CURVE_PLACES = 720
FAR = 1e6
"""Times the size of the poses: a point farther away is that of a slider."""


@dataclass(frozen=True, eq=False)
class Poses:
    """Poses of a plane.

    Attributes
    ----------
    places : (n) complex, of its origin [m]
    angles : (n) [rad]
    """

    places: Complex
    angles: Array

    @property
    def turns(self) -> Complex:
        """(n - 1) unit complex numbers: by what each pose is turned from the first."""
        turns: Complex = np.exp(1j * (self.angles[1:] - self.angles[0]))
        return turns

    @property
    def shifts(self) -> Complex:
        """(n - 1) complex: where each pose takes the point that lies in the origin in the first pose."""
        shifts: Complex = self.places[1:] - self.turns * self.places[0]
        return shifts

    @property
    def size(self) -> float:
        """Greatest distance between two places, at least that of a turn."""
        return float(max(np.abs(self.places - self.places.mean()).max(), 1e-12))


@dataclass(frozen=True, eq=False)
class Dyads:
    """Links of a fixed length between a moving point and a fixed one.

    Attributes
    ----------
    moving : (n) complex, the moving points in the first pose [m]
    fixed : (n) complex, the fixed points [m]
    """

    moving: Complex
    fixed: Complex

    def take(self, which: np.ndarray[tuple[int, ...], np.dtype[np.int64]]) -> Dyads:
        """Some of them."""
        return Dyads(self.moving[which], self.fixed[which])


def closures(poses: Poses, moving: Complex, fixed: Complex) -> Array:
    """Half the change (lanes, n - 1) [m^2] of the square of each dyad's length from the first pose to the others."""
    turned = poses.turns * moving[:, None]
    first, second = poses.shifts, fixed[:, None]
    values: Array = (
        0.5 * np.abs(first) ** 2
        + (np.conj(first) * turned).real
        - (np.conj(second) * (turned + first - moving[:, None])).real
    )
    return values


def _matrices(poses: Poses) -> tuple[Array, Array, Array]:
    """M_u, M_v, M_1 (n - 1, 3) of (u M_u + v M_v + M_1) (x, y, 1) = 0 with w = u + i v and g = x + i y."""

    def rows(moving: complex) -> Array:
        image = poses.turns * moving + poses.shifts - moving
        last = 0.5 * np.abs(poses.shifts) ** 2 + (np.conj(poses.shifts) * poses.turns * moving).real
        return np.column_stack([-image.real, -image.imag, last])

    base = rows(0.0)
    return rows(1.0) - base, rows(1j) - base, base


def five_pose_dyads(poses: Poses) -> Dyads:
    """All real dyads of five poses, at most four.

    u is the eigenvalue of a pencil: the four equations times 1, v and v^2 are twelve linear ones in the twelve products
    of (x, y, 1) and (1, v, v^2, v^3). Of its finite eigenvalues two are the circular points. What is left is brought to
    rounding by Newton's method.
    """
    middle, size = complex(poses.places.mean()), poses.size
    # in an oblique frame of the size of the poses no solution lies at a special place
    oblique = np.exp(0.7j)
    scaled = Poses((poses.places - middle) / size * oblique, poses.angles)
    found = bilinear_pairs(*_matrices(scaled))
    found.sort(key=lambda pair: (pair[1].real, pair[1].imag))
    moving = np.array([w for w, _g in found], dtype=complex) / oblique * size + middle
    fixed = np.array([g for _w, g in found], dtype=complex) / oblique * size + middle
    return Dyads(moving, fixed)


def bilinear_pairs(by_u: Array, by_v: Array, base: Array) -> list[tuple[complex, complex]]:
    """All real (u + i v, x + i y) with (u M_u + v M_v + M_1) (x, y, 1) = 0, of four rows (4, 3) each."""
    constant, linear = np.zeros((12, 12)), np.zeros((12, 12))
    for power in range(3):
        rows = slice(4 * power, 4 * power + 4)
        constant[rows, 3 * power : 3 * power + 3] = base
        constant[rows, 3 * power + 3 : 3 * power + 6] = by_v
        linear[rows, 3 * power : 3 * power + 3] = by_u
    values, vectors = eig(constant, -linear)
    found: list[tuple[complex, complex]] = []
    for value, vector in zip(values, vectors.T, strict=True):
        if not np.isfinite(value) or abs(value) > FAR:
            continue
        parts = vector.reshape(4, 3)
        pivot = int(np.argmax(np.abs(parts[0])))
        if abs(parts[0, pivot]) < 1e-12 or abs(parts[0, 2]) < 1e-12:
            continue
        start = np.array(
            [value, parts[1, pivot] / parts[0, pivot], parts[0, 0] / parts[0, 2], parts[0, 1] / parts[0, 2]]
        )
        place = _newton(by_u, by_v, base, start)
        if place is None or np.abs(place.imag).max() > 1e-7 * (1 + np.abs(place).max()):
            continue
        real = _newton(by_u, by_v, base, place.real.astype(complex))
        if real is None or np.abs(real).max() > FAR:
            continue
        pair = (complex(real[0].real, real[1].real), complex(real[2].real, real[3].real))
        near = 1e-7 * (1 + abs(pair[0]) + abs(pair[1]))
        if not any(abs(pair[0] - w) + abs(pair[1] - g) < near for w, g in found):
            found.append(pair)
    return found


def _newton(by_u: Array, by_v: Array, base: Array, place: Complex) -> Complex | None:
    """Newton's method in complex numbers for u, v, x, y; None where it does not converge."""
    for _iteration in range(30):
        u, v, x, y = place
        matrix = u * by_u + v * by_v + base
        fixed = np.array([x, y, 1.0])
        values = matrix @ fixed
        slopes = np.column_stack([by_u @ fixed, by_v @ fixed, matrix[:, 0], matrix[:, 1]])
        try:
            step = np.linalg.solve(slopes, values)
        except np.linalg.LinAlgError:
            return None
        place = place - step
        if not np.isfinite(place).all():
            return None
        if np.abs(step).max() <= 1e-14 * (1 + np.abs(place).max()):
            return place
    return place if np.abs(step).max() < 1e-9 * (1 + np.abs(place).max()) else None


def four_pose_dyads(poses: Poses, places: int = CURVE_PLACES) -> Dyads:
    """Dyads along the curves of four poses, two for each angle by which the link turns from the first to the second.

    With the turns beta of the link about g the closures are D2 e^(i b2) + D3 e^(i b3) + D4 e^(i b4) = D1, which is a
    four-bar linkage whose crank angle is b2 (G. N. Sandor, A. G. Erdman, Advanced Mechanism Design 2, 1984, 3.8). Where
    it is open there is no dyad, and both points are NaN. The dyads of one branch follow each other.
    """
    turns, shifts = poses.turns, poses.shifts
    determinants = [
        turns_minor(turns, shifts, 1, 2),
        -turns_minor(turns, shifts, 0, 2),
        turns_minor(turns, shifts, 0, 1),
    ]
    first = -sum(determinants)
    angle = _angles_of_curve(first, determinants, places)
    swung = np.exp(1j * angle)
    side = -first - determinants[0] * swung
    second, third = abs(determinants[1]), abs(determinants[2])
    reach = np.abs(side)
    with np.errstate(invalid="ignore", divide="ignore"):
        cosine = (reach**2 + second**2 - third**2) / (2 * reach * second)
        corner = np.where(np.abs(cosine) <= 1, np.arccos(np.clip(cosine, -1, 1)), np.nan)
    moving, fixed = [], []
    for sign in (1.0, -1.0):
        arm = second * np.exp(1j * (np.angle(side) + sign * corner))
        beta = arm / determinants[1]
        # (e^(i b) - 1) l + (e^(i a) - 1) z = d, with z from the moving point to the plane's origin and l the link
        rows = np.stack(
            [
                np.stack([swung - 1, np.full_like(swung, turns[0] - 1)], axis=-1),
                np.stack([beta - 1, np.full_like(swung, turns[1] - 1)], axis=-1),
            ],
            axis=-2,
        )
        determinant = rows[:, 0, 0] * rows[:, 1, 1] - rows[:, 0, 1] * rows[:, 1, 0]
        with np.errstate(invalid="ignore", divide="ignore"):
            link = (shifts[0] * rows[:, 1, 1] - rows[:, 0, 1] * shifts[1]) / determinant
            origin = (rows[:, 0, 0] * shifts[1] - rows[:, 1, 0] * shifts[0]) / determinant
        # the plane's origin lies at 0 in the first pose: w + z = 0
        # the second branch is run through backwards: both meet where the four-bar linkage of the turns stands stretched
        run = slice(None, None, 1 if sign > 0 else -1)
        moving.append((-origin)[run])
        fixed.append((-origin - link)[run])
    joined = Dyads(np.concatenate(moving), np.concatenate(fixed))
    far = FAR * poses.size
    wild = ~(np.abs(joined.moving) + np.abs(joined.fixed) < far)
    joined.moving[wild] = complex(np.nan, np.nan)
    joined.fixed[wild] = complex(np.nan, np.nan)
    return joined


def _angles_of_curve(first: complex, determinants: list[complex], places: int) -> Array:
    """Crank angles of the linkage of the turns, dense towards the ends of the intervals in which it closes."""
    least = abs(abs(determinants[1]) - abs(determinants[2]))
    most = abs(determinants[1]) + abs(determinants[2])
    # |first + D2 e^(i b)| passes the least and the greatest reach at these angles
    ends = []
    size, mean = 2 * abs(first) * abs(determinants[0]), abs(first) ** 2 + abs(determinants[0]) ** 2
    middle = float(np.angle(first / determinants[0]))
    for reach in (least, most):
        cosine = (reach**2 - mean) / size
        if abs(cosine) < 1:
            ends += [middle - np.arccos(cosine), middle + np.arccos(cosine)]
    if not ends:
        return np.linspace(0.0, 2 * np.pi, places)
    bounds = np.sort(np.mod(ends, 2 * np.pi))
    bounds = np.append(bounds, bounds[0] + 2 * np.pi)
    share = 0.5 - 0.5 * np.cos(np.linspace(1e-4, np.pi - 1e-4, max(places // len(ends), 8)))
    return np.concatenate([low + (high - low) * share for low, high in pairwise(bounds)])


def turns_minor(turns: Complex, shifts: Complex, j: int, k: int) -> complex:
    """(e^(i a_j) - 1) d_k - (e^(i a_k) - 1) d_j."""
    return complex((turns[j] - 1) * shifts[k] - (turns[k] - 1) * shifts[j])


def three_pose_moving_points(poses: Poses, fixed: Complex) -> Complex:
    """Moving points (n) in the first pose whose circles through three poses have given centres (n)."""
    by_u, by_v, base = _matrices(poses)
    at = np.stack([fixed.real, fixed.imag, np.ones(len(fixed))], axis=-1)
    system = np.stack([at @ by_u.T, at @ by_v.T], axis=-1)
    return _solve_pairs(system, -(at @ base.T))


def three_pose_centres(poses: Poses, moving: Complex) -> Complex:
    """Centres (n) of the circles through three places of moving points (n), which are given in the first pose."""
    by_u, by_v, base = _matrices(poses)
    matrix = moving.real[:, None, None] * by_u + moving.imag[:, None, None] * by_v + base
    return _solve_pairs(matrix[:, :, :2], -matrix[:, :, 2])


def _solve_pairs(system: Array, right: Array) -> Complex:
    determinant = np.linalg.det(system)
    regular = np.abs(determinant) > 1e-12
    system = np.where(regular[:, None, None], system, np.eye(2))
    found = np.linalg.solve(system, right[..., None])[..., 0]
    found[~regular] = np.nan
    solved: Complex = found[:, 0] + 1j * found[:, 1]
    return solved
