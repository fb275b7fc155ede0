"""Small motions about an equilibrium or a steady motion: natural frequencies, damping and shapes.

Along the free directions N a departure x = N y obeys m y'' + c y' + k y = 0 with m = N' M N and so on. Its
exponentials y = e^(s t) u are the eigenvectors of the first-order system in (y, y'). (P. C. Mueller and
W. O. Schiehlen, Linear Vibrations, 1985, chapters 4 and 5; for gyroscopic terms: L. Meirovitch, Fundamentals of
Vibrations, 2001, section 4.9.)
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

import numpy as np
import numpy.typing as npt
import scipy.linalg

from centrode.dynamics.equilibria.linear_equations import LoadedMechanism

Array: TypeAlias = npt.NDArray[np.float64]
Complex: TypeAlias = npt.NDArray[np.complex128]

ASYMPTOTIC, STABLE, NEUTRAL, UNSTABLE = "asymptotically stable", "stable", "neutral", "unstable"
STABILITIES = (ASYMPTOTIC, STABLE, NEUTRAL, UNSTABLE)
"""Departures die away; stay small; at least one neither grows nor is driven back; at least one grows."""
ROUNDING = 1e-9
"""Real parts and stiffnesses below this share of the greatest eigenvalue are rounding."""
NOTHING = 1e-13
"""Real parts below this share of the greatest eigenvalue are zero."""
WITHOUT_MASS = 1e-12
"""A direction of motion that moves less than this share of the masses moves none."""


@dataclass(frozen=True)
class SmallMotions:
    """Linear equations along the free directions, f of them, of c coordinates.

    The last `states` coordinates and directions are states of controllers: they have no mass, and damping that says how
    fast they change.

    Attributes
    ----------
    place, speeds : (c) the state that small motions depart from [rad or m], and by time [s]
    units : (c) what a change of each coordinate is compared with [1 or m]
    free : (c, f) free directions
    mass, damping, stiffness : (f, f), in kg m^2, N m s and N m for changes of one unit
    """

    place: Array
    speeds: Array
    units: Array
    free: Array
    mass: Array
    damping: Array
    stiffness: Array
    states: int = 0

    @property
    def moving(self) -> int:
        """Number of directions in which the mechanism moves."""
        return len(self.mass) - self.states

    @cached_property
    def moves_mass(self) -> bool:
        """Whether every free direction moves a mass: without that there are no frequencies."""
        if not self.moving:
            return False
        sizes = np.linalg.eigvalsh(self.mass[: self.moving, : self.moving])
        return bool(sizes[0] > WITHOUT_MASS * max(float(sizes[-1]), 1e-300))

    @cached_property
    def _spectrum(self) -> tuple[Complex, Complex]:
        """Eigenvalues s and directions u, those with an imaginary part not below zero; by frequency, then by decay."""
        matrix, count = self._first_order_matrix, self.moving
        values, vectors = np.linalg.eig(matrix)
        scale = float(np.max(np.abs(values), initial=0.0))
        # what neither damps nor grows has a real part of rounding
        values = np.where(np.abs(values.real) <= NOTHING * scale, 1j * values.imag, values)
        kept = [k for k, s in enumerate(values) if s.imag >= -1e-14 * scale]
        # of a pair whose imaginary parts are rounding both are real
        order = sorted(
            kept, key=lambda k: (round(abs(float(values[k].imag)) / max(scale, 1e-300), 12), values[k].real)
        )
        return values[order], np.concatenate([vectors[:count], vectors[2 * count :]])[:, order].T

    @property
    def _first_order_matrix(self) -> Array:
        """A of x' = A x, x being departures and their speeds along the directions, then the states of controllers."""
        count, whole = self.moving, len(self.mass)
        factor = scipy.linalg.cho_factor(self.mass[:count, :count])
        matrix = np.zeros((count + whole, count + whole))
        matrix[:count, count : 2 * count] = np.eye(count)
        moved = scipy.linalg.cho_solve(
            factor, np.hstack([self.stiffness[:count], self.damping[:count, :count]])
        )
        own = np.diag(self.damping)[count:, None]
        changed = np.hstack([self.stiffness[count:], self.damping[count:, :count]]) / own
        for rows, found in ((slice(count, 2 * count), moved), (slice(2 * count, None), changed)):
            matrix[rows, :count] = -found[:, :count]
            matrix[rows, 2 * count :] = -found[:, count:whole]
            matrix[rows, count : 2 * count] = -found[:, whole:]
        return matrix

    @property
    def eigenvalues(self) -> Complex:
        """Numbers s of all modes [1/s]; of conjugate pairs the one with the imaginary part above zero."""
        if not self.moves_mass:
            return np.zeros(0, dtype=np.complex128)
        return self._spectrum[0]

    @property
    def shapes(self) -> Complex:
        """Departures of the coordinates (modes, c) [rad or m], the greatest in its unit being 1 and real."""
        if not self.moves_mass:
            return np.zeros((0, len(self.place)), dtype=np.complex128)
        found = self._spectrum[1] @ self.free.T
        # states of controllers are not seen; a mode of these alone moves nothing
        sized = (found / self.units)[:, : len(self.place) - self.states]
        sizes = np.max(np.abs(sized), axis=1)
        still = sizes <= NOTHING * np.max(np.abs(found / self.units), axis=1)
        greatest = np.argmax(np.round(np.abs(sized) / np.where(still, 1.0, sizes)[:, None], 9), axis=1)
        scale = np.where(still, 1.0, sized[np.arange(len(sized)), greatest])
        return np.asarray(np.where(still[:, None], 0.0, found / scale[:, None]))

    @cached_property
    def undamped_frequencies(self) -> Array:
        """Angular frequencies [rad/s] without damping, increasing; NaN for a direction that is not driven back."""
        if not self.moves_mass:
            return np.zeros(0)
        count = self.moving
        squares = scipy.linalg.eigvals(self.stiffness[:count, :count], self.mass[:count, :count])
        with np.errstate(invalid="ignore"):
            found = np.where(
                np.abs(squares.imag) <= ROUNDING * np.abs(squares), np.sqrt(squares.real), np.nan
            )
        return np.sort(found)

    @cached_property
    def stability(self) -> str:
        """One of `STABILITIES`; stable where nothing can move."""
        if not self.moving:
            return STABLE
        if not self.moves_mass:
            # what moves slowly against friction of any kind goes down the stiffness
            sizes = np.linalg.eigvals(self.stiffness[: self.moving, : self.moving]).real
            rounding = ROUNDING * float(np.max(np.abs(sizes), initial=0.0))
            least = float(np.min(sizes))
            return STABLE if least > rounding else UNSTABLE if least < -rounding else NEUTRAL
        values = self.eigenvalues
        scale = float(np.max(np.abs(values), initial=0.0))
        rounding = ROUNDING * scale
        # twice zero is known to the root of rounding alone
        still = np.abs(values) <= 1e-6 * scale
        growth = float(np.max(values.real[~still], initial=-np.inf))
        if growth > rounding:
            return UNSTABLE
        if np.any(still) or not scale:
            return NEUTRAL
        return ASYMPTOTIC if growth < -rounding else STABLE


def small_motions(
    loaded: LoadedMechanism,
    places: Array,
    speeds: Array | None = None,
    numbers: dict[str, float] | None = None,
) -> tuple[SmallMotions, ...]:
    """Linear equations about n states, `places` and `speeds` (n, coordinates)."""
    found = loaded.at(places, speeds=speeds, numbers=numbers)
    free = loaded.free_directions(found.rows)
    moving = np.zeros_like(places) if speeds is None else speeds

    def reduced_matrix(matrix: Array) -> Array:
        return np.asarray(np.einsum("ncm,ncd,nde->nme", free, matrix, free))

    mass, damping, stiffness = map(reduced_matrix, (found.mass, found.damping, found.stiffness))
    mass = 0.5 * (mass + mass.transpose(0, 2, 1))
    return tuple(
        SmallMotions(
            places[k],
            moving[k],
            loaded.units,
            free[k],
            mass[k],
            damping[k],
            stiffness[k],
            len(loaded.states),
        )
        for k in range(len(places))
    )
