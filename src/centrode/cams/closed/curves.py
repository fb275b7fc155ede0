"""Curves that join two ends of a path in value, slope and curvature: the smoothest one and what may be added to it.

The smoothest one leaves rho'' + rho, which is constant on a circle about the cam's centre and to first order on
any circle, as constant as it can: the integral of (rho''' + rho')^2 is least. By the equation of Euler and Lagrange,
D^2 (D^2 + 1)^2 rho = 0, it is a sum of 1, tau, cos tau, sin tau, tau cos tau, tau sin tau. What may be added, a
polynomial that vanishes at both ends with its derivatives, is square to it in the same integral, so that integrals add.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import factorial

import numpy as np

from centrode.algebra.jets import Jet
from centrode.cams.frames import JETS, Array

NODES = 96
"""Gauss nodes of the integral of smoothness."""


@dataclass(frozen=True)
class Ends:
    """What a return arc has to join: angles [rad] and derivatives of the radius there, from value on [m/rad^k]."""

    start: float
    stop: float
    at_start: tuple[float, ...]
    at_stop: tuple[float, ...]

    @property
    def contact(self) -> int:
        """The highest derivative that joins."""
        return len(self.at_start) - 1

    @property
    def middle(self) -> float:
        return 0.5 * (self.start + self.stop)

    @property
    def half(self) -> float:
        return 0.5 * (self.stop - self.start)


@dataclass(frozen=True)
class ReturnCurve:
    """A curve between ends: the smoothest one plus `weights` of the additions, a PolarCurve."""

    ends: Ends
    weights: tuple[float, ...] = ()

    def radius(self, phi: Array, order: int = 0) -> Array:
        """Polar radius and its derivatives by phi (order + 1, n) [m/rad^k]; NaN outside the ends."""
        given = np.asarray(phi, dtype=np.float64)
        slack = 1e-12
        inside = (given >= self.ends.start - slack) & (given <= self.ends.stop + slack)
        rows = derivatives(self.ends, given, order, len(self.weights))
        found = np.tensordot(np.array([*self.smoothest, *self.weights]), rows, axes=1)
        return np.where(inside, found, np.nan)

    @cached_property
    def smoothest(self) -> Array:
        """Weights of the functions of the smoothest curve."""
        contact = self.ends.contact
        rows = [
            derivatives(self.ends, np.array([at]), contact, 0)[:, :, 0].T
            for at in (self.ends.start, self.ends.stop)
        ]
        return np.linalg.solve(np.concatenate(rows), np.array([*self.ends.at_start, *self.ends.at_stop]))


def derivatives(ends: Ends, phi: Array, order: int, additions: int) -> Array:
    """Derivatives (function, order + 1, n) of the smoothest curve's functions and of the additions."""
    tau = Jet([phi - ends.middle, *([np.ones_like(phi)] if order else []), *([0.0 * phi] * (order - 1))])
    shares = tau * (1.0 / ends.half)
    jets = [*_kernel(tau, ends.contact), *_additions(shares, ends.contact, additions)]
    return np.array([[c * factorial(k) for k, c in enumerate(jet.coefficients)] for jet in jets])


def roughness(ends: Ends, additions: int) -> Array:
    """Integrals (additions, additions) of the products of rho^(c+1) + rho^(c-1) of the additions, c the contact."""
    roots, weights = np.polynomial.legendre.leggauss(NODES)
    contact = ends.contact
    rows = derivatives(ends, ends.middle + ends.half * roots, contact + 1, additions)[-additions:]
    values = rows[:, contact + 1] + rows[:, contact - 1]
    return np.asarray((values * (weights * ends.half)) @ values.T)


def _kernel(tau: Jet, contact: int) -> list[Jet]:
    """1, tau, ... and the sines and cosines with tau: 2 (contact + 1) functions."""
    sine, cosine = JETS.sin(tau), JETS.cos(tau)
    powers = [tau * 0.0 + 1.0]
    for _power in range(2 * contact - 3):
        powers.append(powers[-1] * tau)
    return [*powers, cosine, sine, tau * sine, tau * cosine]


def _additions(shares: Jet, contact: int, count: int) -> list[Jet]:
    """Legendre polynomials of x = tau / half times (1 - x^2)^(contact + 1)."""
    if not count:
        return []
    window = (1.0 - shares * shares) ** (contact + 1)
    legendre = [shares * 0.0 + 1.0, shares]
    for n in range(1, count):
        legendre.append((shares * legendre[n] * (2 * n + 1.0) - legendre[n - 1] * float(n)) / (n + 1.0))
    return [window * one for one in legendre[:count]]
