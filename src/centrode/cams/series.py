"""The path by the paper's power series about phi = 0, cut after a given number of terms."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from centrode.algebra.jets import Jet, square_root
from centrode.cams.asked import check_start
from centrode.cams.curvature_laws import CurvatureLaw, ExponentialCurvature, derivatives
from centrode.cams.lawful import check_span
from centrode.cams.path import inside
from centrode.cams.recursions import Series, exponential_series, system_series
from centrode.errors import InputError
from centrode.locale import _
from centrode.model.cams.parts import MOST_TERMS

Array = NDArray[np.float64]

ROUNDED = 64.0 * 2.0**-52
"""A slope of the curvature below this share of what it is computed from is zero."""
FOLLOWING = 4
"""Terms behind the last one that are kept, to tell by them what is left out."""


@dataclass(frozen=True)
class SeriesPath:
    """The polynomial eta(phi) = a_0 + ... + a_N phi^N, and the path that formula (15) makes of it.

    Made by `series_path`. NaN beyond the first break of the law, where the series is not that of the path, and
    where |eta| > 1, to which no pressure angle belongs.

    Attributes
    ----------
    sines, cosines : (N + 1), (N)
        a_n of eta = sin(gamma) and b_n of lambda = cos(gamma).
    following : (FOLLOWING)
        The next a_n, which the polynomial leaves out.
    start, stop : float [rad]
        Ends of the asked range, or the law's first breaks.
    """

    law: CurvatureLaw
    start: float
    stop: float
    sines: Array
    cosines: Array
    following: Array
    stall: float | None = None

    @property
    def terms(self) -> int:
        """N, the order of the last term."""
        return len(self.sines) - 1

    def sine(self, phi: Array, order: int = 0) -> Array:
        """The sine eta of the pressure angle and its derivatives (order + 1, n) [1/rad^k]."""
        return np.asarray([math.factorial(k) * c for k, c in enumerate(self._about(phi, order))])

    def radius(self, phi: Array, order: int = 0) -> Array:
        """Rho by formula (15), (cos(gamma) - eta') / K, and its derivatives (order + 1, n) [m/rad^k]."""
        eta = self._about(phi, order + 1)
        upright, curvature = self._upright(eta[:-1]), self._curvature(phi, order)
        slope = Jet(eta).slope()
        found = (upright - slope) / curvature
        return np.asarray([found.derivative(k) for k in range(order + 1)])

    def radius_by_slope(self, phi: Array) -> Array:
        """Rho (n) by formula (16), -(eta'' + eta) / K'; NaN where K' is zero but for its rounding and that of phi."""
        eta, places = self._about(phi, 2), inside(self, phi)
        bend, slope, second = derivatives(self.law, places, 2)
        nothing = np.abs(slope) <= ROUNDED * (np.abs(bend) + np.abs(places * second))
        return np.asarray(-(2.0 * eta[2] + eta[0]) / np.where(nothing, np.nan, slope))

    def pressure_angle(self, phi: Array) -> Array:
        """The pressure angle (n) [rad]."""
        with np.errstate(invalid="ignore"):
            return np.asarray(np.arcsin(self.sine(phi)[0]))

    def curvature(self, phi: Array, order: int = 0) -> Array:
        """K and its derivatives by phi (order + 1, n) [1/m/rad^k]."""
        return derivatives(self.law, inside(self, phi), order)

    def _upright(self, eta: list[Array]) -> Jet:
        with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
            square = 1.0 - Jet(eta) * Jet(eta)
            return Jet(square_root(square.coefficients, np.sqrt(square.value)))

    def _curvature(self, phi: Array, order: int) -> Jet:
        return Jet([c / math.factorial(k) for k, c in enumerate(self.curvature(phi, order))])

    def _about(self, phi: Array, order: int) -> list[Array]:
        """Taylor coefficients of the polynomial about places."""
        places = inside(self, phi)
        found = []
        for k in range(order + 1):
            total = np.zeros_like(places)
            for n in range(self.terms, k - 1, -1):
                total = total * places + math.comb(n, k) * self.sines[n]
            found.append(total if k <= self.terms else np.zeros_like(places))
        return found


def series_path(
    law: CurvatureLaw,
    rho0: float,
    gamma0: float = 0.0,
    start: float = 0.0,
    stop: float = math.pi / 2,
    terms: int = 20,
) -> SeriesPath:
    """The path by one power series about phi = 0.

    Parameters
    ----------
    law : CurvatureLaw
    rho0, gamma0 : float [m], [rad]
        Radius and pressure angle at phi = 0.
    start, stop : float [rad]
    terms : int
        N: the series is cut after a_N phi^N.

    Raises
    ------
    InputError
        Fewer than 2 or more than 2000 terms, or coefficients beyond what can be computed with.

    Notes
    -----
    By the recursions (24), (25), (34) of the paper for an exponential law, by those of the equations themselves for
    any other (`cams.recursions.system_series`).
    """
    check_start(rho0, gamma0, start, stop)
    check_span(law, start, stop)
    if isinstance(terms, bool) or not 2 <= terms <= MOST_TERMS:
        what = _("{terms} terms were asked for").format(terms=terms)
        raise InputError("terms", what, _("ask for 2 to {most}").format(most=MOST_TERMS))
    every, cosines = (np.asarray(c) for c in coefficients(law, rho0, gamma0, terms + FOLLOWING))
    a, b, following = every[: terms + 1], cosines[:terms], every[terms + 1 :]
    low = max([start, *(place for place in law.breaks if place < 0)])
    high = min([stop, *(place for place in law.breaks if place > 0)])
    if 0.0 in law.breaks:
        low = 0.0
    if not (np.isfinite(a).all() and np.isfinite(b).all()):
        raise InputError(
            "terms", _("the coefficients of the series leave the range of numbers"), _("ask for fewer")
        )
    return SeriesPath(law, low, high, a, b, following)


def coefficients(law: CurvatureLaw, rho0: float, gamma0: float, terms: int) -> tuple[Series, Series]:
    """The coefficients a_0 ... a_terms and b_0 ... b_(terms-1)."""
    sine, cosine = math.sin(gamma0), math.cos(gamma0)
    with np.errstate(all="ignore"):
        curvature = [float(c) for c in law.series(0.0, terms)]
        slope = cosine - rho0 * curvature[0]
        if isinstance(law, ExponentialCurvature):
            return exponential_series(sine, slope, cosine, law.k1, terms)
        _radii, sines, cosines = system_series(rho0, sine, cosine, curvature[:terms])
        return sines, cosines[:terms]
