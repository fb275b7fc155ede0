"""The paths of several designs at once, for a search that tries thousands of them.

With u = ln rho the equations of the path are u' = tan gamma, gamma' = 1 - exp(u) K / cos gamma. They are solved by
Picard's iteration on Chebyshev points (Clenshaw and Norton, 1963), panel by panel: every step is one small product
of matrices for all designs, and the same points serve them all, so that differences between neighbours are smooth.
The result of a search is computed once more by the path itself.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

DEGREE = 20
"""Of the polynomial in each panel."""
PANEL = 0.45
"""Greatest length of a panel [rad]."""
STEEPEST = math.radians(75)
"""Pressure angles are held below this, so that every design has a path: one that gets there is not admissible."""
MOST = 1e3
"""Greatest curvature times the radius at the start."""
ROUNDS = 60
SETTLED = 1e-14
"""Change of a round, relative, at which the iteration has settled."""


@dataclass(frozen=True)
class Trial:
    """One design to be tried.

    Attributes
    ----------
    curvature : callable
        K(phi) [1/m] of angles (n,) [rad].
    radius : float [m]
        rho at phi = 0.
    gamma : float [rad]
        Pressure angle at phi = 0.
    roller_radius : float [m]
    """

    curvature: Callable[[Array], Array]
    radius: float
    gamma: float
    roller_radius: float


@dataclass(frozen=True)
class Tried:
    """Paths of several designs at the same angles.

    Attributes
    ----------
    phi : (n,) [rad]
    rho : (n, designs) [m]
    gamma : (n, designs) [rad]
    curvature : (n, designs) [1/m]
    roller_radius : (designs,) [m]
    mirrored : bool
        The paths go on to negative angles as their own mirror image.
    """

    phi: Array
    rho: Array
    gamma: Array
    curvature: Array
    roller_radius: Array
    mirrored: bool = False


@dataclass(frozen=True)
class Mesh:
    """Angles from 0 to both ends of the range [rad], cut at the law's breaks and into panels of Chebyshev points."""

    ends: tuple[float, float]
    breaks: tuple[float, ...] = ()
    mirrored: bool = False

    @property
    def panels(self) -> list[tuple[float, float]]:
        """(from, to) of every panel, those behind 0 backwards from 0."""
        found = []
        for end in self.ends:
            inner = sorted({b for b in self.breaks if min(0, end) < b < max(0, end)}, key=abs)
            for first, last in zip([0.0, *inner], [*inner, end], strict=True):
                count = math.ceil(abs(last - first) / PANEL)
                cuts = np.linspace(first, last, count + 1).tolist()
                found += list(pairwise(cuts)) if count else []
        return found


def paths_of(trials: Sequence[Trial], mesh: Mesh, phi: Array) -> Tried:
    """Paths of all designs at the angles `phi` (n,) [rad] within the mesh.

    Errors of smooth laws stay near rounding; a law with knots needs them among the mesh's breaks.
    """
    rho, gamma = np.empty((2, len(phi), len(trials)))
    start = _starts(trials)
    states = {0.0: start}
    panels = mesh.panels
    nodes = [first + (last - first) * _unit_nodes() for first, last in panels]
    everywhere = np.concatenate([*nodes, phi])
    curvature = np.stack([_held(trial, everywhere) for trial in trials], axis=1)
    for number, (first, last) in enumerate(panels):
        bent = curvature[number * (DEGREE + 1) : (number + 1) * (DEGREE + 1)]
        u, angle = _solved(states[first], bent, last - first)
        states[last] = np.stack([u[-1], angle[-1]])
        inside = (phi >= min(first, last)) & (phi <= max(first, last))
        matrix = _between((phi[inside] - first) / (last - first))
        rho[inside], gamma[inside] = np.exp(matrix @ u), matrix @ angle
    at_zero = phi == 0
    rho[at_zero], gamma[at_zero] = np.exp(start[0]), start[1]
    rollers = np.array([trial.roller_radius for trial in trials])
    return Tried(phi, rho, gamma, curvature[len(panels) * (DEGREE + 1) :], rollers, mesh.mirrored)


def _held(trial: Trial, phi: Array) -> Array:
    """The curvature of a design: 0, which no cam has, where it is none; not beyond what any cam has."""
    with np.errstate(all="ignore"):
        found = trial.curvature(phi)
    return np.clip(np.where(np.isnan(found), 0.0, found), -MOST / trial.radius, MOST / trial.radius)


def _starts(trials: Sequence[Trial]) -> Array:
    return np.array([[math.log(one.radius) for one in trials], [one.gamma for one in trials]])


def _solved(start: Array, curvature: Array, length: float) -> tuple[Array, Array]:
    """Logarithm of rho, and gamma (nodes, designs) over a panel, from their values at its beginning."""
    matrix = length * _integration()
    u = np.broadcast_to(start[0], curvature.shape)
    gamma = np.broadcast_to(start[1], curvature.shape)
    for _round in range(ROUNDS):
        held = np.clip(gamma, -STEEPEST, STEEPEST)
        cosine = np.cos(held)
        following = start[0] + matrix @ (np.sin(held) / cosine)
        bent = np.exp(np.clip(u, start[0] - 4 * abs(length), start[0] + 4 * abs(length))) * curvature
        turned = start[1] + matrix @ (1 - bent / cosine)
        change = max(float(np.max(abs(following - u))), float(np.max(abs(turned - gamma))))
        u, gamma = following, turned
        if change < SETTLED:
            break
    return np.asarray(u), np.asarray(np.clip(gamma, -STEEPEST * 1.15, STEEPEST * 1.15))


@cache
def _unit_nodes() -> Array:
    """Chebyshev points of the second kind on [0, 1], rising."""
    nodes = np.sin(0.5 * math.pi * np.arange(DEGREE + 1) / DEGREE) ** 2
    nodes.flags.writeable = False
    return nodes


@cache
def _integration() -> Array:
    """Integrals from 0 to each node, of a polynomial given at the nodes."""
    x = 2 * _unit_nodes() - 1
    sums = np.polynomial.chebyshev.chebint(_to_coefficients(), axis=0, lbnd=-1)
    matrix = 0.5 * np.polynomial.chebyshev.chebvander(x, DEGREE + 1) @ sums
    matrix[0] = 0.0
    return np.asarray(matrix)


@cache
def _to_coefficients() -> Array:
    """Chebyshev coefficients of a polynomial given at the nodes."""
    return np.asarray(np.linalg.inv(np.polynomial.chebyshev.chebvander(2 * _unit_nodes() - 1, DEGREE)))


def _between(places: Array) -> Array:
    """Values at places (n,) on [0, 1] of the polynomial given at the nodes."""
    return np.asarray(np.polynomial.chebyshev.chebvander(2 * places - 1, DEGREE) @ _to_coefficients())
