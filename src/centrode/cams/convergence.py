"""How far a power series reaches: its radius of convergence, from its coefficients and from the nearest singularity."""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from centrode.cams.curvature_laws import CurvatureLaw
from centrode.cams.recursions import Series, arc_series, system_series

Array = NDArray[np.float64]

TERMS = 160
"""Coefficients that the estimate is made of."""

DIRECTIONS = 9
ORDER = 24
SHARE = 0.9
"""How far towards the circle of convergence the search for singularities sets out."""

AGREEMENT = 0.5
"""By how much the logarithm of |b_n| R^n n^(3/2) may run over a quarter of the coefficients where R is the radius:
a root of cos(gamma) gives b_n such a decay. An R that is 1.5 % off runs by more."""

NEWTON = 40


@dataclass(frozen=True)
class Convergence:
    """How far the series about phi = 0 converges.

    Attributes
    ----------
    estimate : float [rad]
        Radius by the coefficients alone: the quotients of Mercer and Roberts, drawn out to endless n. Infinite
        where the coefficients vanish, NaN where they leave the range of numbers too soon. No proof: it knows no more
        than the coefficients that it is made of.
    singularity : complex [rad] or None
        The angle, mostly complex, at which cos(gamma) = 0 and whose distance fits the decay of the coefficients;
        None where none was found, as with a law that has singularities of its own.
    """

    estimate: float
    singularity: complex | None

    @property
    def radius(self) -> float:
        """The distance [rad] of the singularity, to rounding; where none was found, the estimate."""
        return self.estimate if self.singularity is None else abs(self.singularity)


def convergence(law: CurvatureLaw, rho0: float, gamma0: float = 0.0) -> Convergence:
    """The radius of convergence of the series of eta and cos(gamma) about phi = 0.

    Notes
    -----
    The quotients `(b_(n+1) b_(n-1) - b_n^2) / (b_n b_(n-2) - b_(n-1)^2)` tend to 1/R^2 for one singularity and for
    a conjugate pair (G. N. Mercer, A. J. Roberts, A centre manifold description of contaminant dispersion in
    channels with varying flow properties, 1990). The singularity is then sought by Newton's method along the arc
    of the path, where the equations are regular, from places inside the circle.
    """
    b = _cosines(law, rho0, gamma0)
    estimate = _by_coefficients(b)
    if not math.isfinite(estimate):
        return Convergence(estimate, None)
    places = [cmath.rect(SHARE * estimate, t) for t in np.linspace(0, np.pi, DIRECTIONS)]
    found = [_singularity(law, rho0, gamma0, place) for place in places]
    best = min((phi for phi in found if phi is not None and _fits(b, abs(phi))), key=abs, default=None)
    if best is None:
        return Convergence(estimate, None)
    # once more straight towards it, which is where the fewest digits are lost
    again = _singularity(law, rho0, gamma0, cmath.rect(SHARE * estimate, cmath.phase(best)))
    if again is not None and abs(again - best) < 1e-3 * abs(best):
        best = again
    return Convergence(estimate, complex(best.real, abs(best.imag)))


def _cosines(law: CurvatureLaw, rho0: float, gamma0: float) -> Array:
    """The coefficients b_n, as far as they are numbers."""
    with np.errstate(all="ignore"):
        curvature = [float(c) for c in law.series(0.0, TERMS)]
        found = np.asarray(system_series(rho0, math.sin(gamma0), math.cos(gamma0), curvature)[2])
    wrong = np.flatnonzero(~np.isfinite(found) | (np.abs(found) > 1e120))
    return found[: wrong[0]] if wrong.size else found


def _by_coefficients(b: Array) -> float:
    """The radius that the last half of the coefficients tell; of an even series those of phi squared."""
    if len(b) > 16 and not b[1::2].any():
        return math.sqrt(_by_coefficients(b[::2]))
    n = np.arange(len(b) // 2, len(b) - 1)
    if len(n) < 4:
        return math.nan
    with np.errstate(all="ignore"):
        upper = b[n + 1] * b[n - 1] - b[n] ** 2
        lower = b[n] * b[n - 2] - b[n - 1] ** 2
        inverse = np.sqrt(np.abs(upper / lower))
    known = np.isfinite(inverse) & (inverse > 0)
    if known.sum() < 4:
        return math.inf
    slope = np.polyfit(1.0 / n[known], inverse[known], 1)[0]
    middle = np.median(inverse[known] - slope / n[known])
    return float(1.0 / middle) if middle > 0 else math.inf


def _fits(b: Array, radius: float) -> bool:
    """Whether the coefficients decay as they do on a circle of convergence of this radius."""
    n = np.arange(len(b) // 2, len(b))
    with np.errstate(all="ignore"):
        sizes = np.log(np.abs(b[n])) + n * math.log(radius) + 1.5 * np.log(n)
    first, second = np.array_split(sizes, 2)
    return bool(abs(np.max(first) - np.max(second)) < AGREEMENT)


def _singularity(law: CurvatureLaw, rho0: float, gamma0: float, towards: complex) -> complex | None:
    """The angle of cos(gamma) = 0 that Newton's method finds from a complex place inside the circle."""
    phi, rho, sine, cosine = 0j, complex(rho0), complex(math.sin(gamma0)), complex(math.cos(gamma0))
    with np.errstate(all="ignore"):
        for step in range(1, 9):  # each a third of what is left to the circle
            place = (1.0 - (1.0 - SHARE) ** (step / 8)) / SHARE * towards
            series = system_series(rho, sine, cosine, law.series(phi, ORDER - 1))
            rho, sine, cosine = (_value(s, place - phi) for s in series)
            phi = place
        for _step in range(NEWTON):
            arcs = arc_series(phi, rho, sine, cosine, law.along, ORDER)
            arc = -arcs[3][0] / arcs[3][1] if arcs[3][1] else cmath.nan
            arc = arc * min(1.0, _reach(arcs) / abs(arc)) if abs(arc) > 0 else arc
            if not cmath.isfinite(arc):
                return None
            phi, rho, sine, cosine = (_value(s, arc) for s in arcs)
            if abs(arc) < 1e-15 * abs(rho):
                return phi
    return None


def _reach(series: tuple[Series, ...]) -> float:
    """An arc over which all series hold to rounding."""
    reach = math.inf
    for coefficients in series:
        scale = max(abs(coefficients[0]), abs(coefficients[1]) * abs(series[1][0]))
        for k in (ORDER - 1, ORDER):
            size = abs(coefficients[k]) / scale if scale > 0 else math.inf
            if size > 0:
                reach = min(reach, (1e-17 / size) ** (1.0 / k))
    return reach


def _value(coefficients: Series, x: complex) -> complex:
    total = 0j
    for c in reversed(coefficients):
        total = total * x + c
    return total
