"""The path by Taylor series that are expanded anew step by step, until the follower stalls or the range ends."""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass
from numbers import Integral
from typing import NamedTuple

import numpy as np
from numpy.polynomial import polynomial
from numpy.typing import NDArray

from centrode.cams.curvature_laws import (
    ConstantCurvature,
    CurvatureLaw,
    ExponentialCurvature,
    LinearCurvature,
    SplineCurvature,
    TextCurvature,
    check_span,
    derivatives,
    lawful,
    refusal,
    unlawful_place,
)
from centrode.cams.roller_path import (
    MOST_GROWTH,
    RollerPath,
    Series,
    StatePath,
    SymmetricPath,
    arc_series,
    check_bend,
    check_start,
    exponential_series,
    inside,
    no_series,
    runs_away,
    system_series,
)
from centrode.errors import InputError
from centrode.locale import _, ngettext
from centrode.model.cam import MOST_TERMS
from centrode.model.cam_files import AnyCam, require_curvature_cam
from centrode.numerics.jets import Jet, square_root
from centrode.numerics.search import newton_roots

# The path by the paper's power series about phi = 0, cut after a given number of terms.

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
        # formula (15) needs cos(gamma), which follows from the sine by its own series
        upright, curvature = self._upright(eta[:-1]), self._curvature(phi, order)
        slope = Jet(eta).slope()
        radius = (upright - slope) / curvature
        return np.asarray([radius.derivative(k) for k in range(order + 1)])

    def radius_by_slope(self, phi: Array) -> Array:
        """Rho (n) by formula (16), -(eta'' + eta) / K'; NaN where K' is zero but for its rounding and that of phi."""
        eta, places = self._about(phi, 2), inside(self, phi)
        bend, slope, second = derivatives(self.law, places, 2)
        # next to zero K' is rounding of its own terms, and the quotient means nothing
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
        series = []
        for k in range(order + 1):
            # Horner's rule of the k-th derivative over k!, whose coefficients are binomial
            total = np.zeros_like(places)
            for n in range(self.terms, k - 1, -1):
                total = total * places + math.comb(n, k) * self.sines[n]
            series.append(total if k <= self.terms else np.zeros_like(places))
        return series


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
    any other (`cams.roller_path.system_series`).
    """
    check_start(rho0, gamma0, start, stop)
    check_span(law, start, stop)
    given: object = terms  # whoever calls without types may give anything
    if isinstance(given, bool) or not isinstance(given, Integral) or not 2 <= terms <= MOST_TERMS:
        what = ngettext("{n} term is given", "{n} terms are given", terms).format(n=terms)
        raise InputError("terms", what, _("give 2 to {most}").format(most=MOST_TERMS))
    # a few more terms than asked for: they measure what the polynomial leaves out
    every, cosines = (np.asarray(c) for c in coefficients(law, rho0, gamma0, terms + FOLLOWING))
    a, b, following = every[: terms + 1], cosines[:terms], every[terms + 1 :]
    # beyond a break the law is another function, and so is the path
    low = max([start, *(place for place in law.breaks if place < 0)])
    high = min([stop, *(place for place in law.breaks if place > 0)])
    if 0.0 in law.breaks:
        low = 0.0
    if not (np.isfinite(a).all() and np.isfinite(b).all()):
        raise InputError(
            "terms",
            _("the coefficients of the series exceed the range of floating-point numbers"),
            _("give fewer"),
        )
    return SeriesPath(law, low, high, a, b, following)


def coefficients(law: CurvatureLaw, rho0: float, gamma0: float, terms: int) -> tuple[Series, Series]:
    """The coefficients a_0 ... a_terms and b_0 ... b_(terms-1)."""
    sine, cosine = math.sin(gamma0), math.cos(gamma0)
    with np.errstate(all="ignore"):
        curvature = [float(c) for c in law.series(0.0, terms)]
        # eta' = cos(gamma) - rho K at the beginning
        slope = cosine - rho0 * curvature[0]
        if isinstance(law, ExponentialCurvature):
            return exponential_series(sine, slope, cosine, law.k1, terms)
        _radii, sines, cosines = system_series(rho0, sine, cosine, curvature[:terms])
        return sines, cosines[:terms]


# How far a power series reaches: its radius of convergence, from its coefficients and from the nearest
# singularity.

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
    """Convergence of the series about phi = 0.

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
    # in directions of the upper half plane: singularities come in conjugate pairs
    places = [cmath.rect(SHARE * estimate, t) for t in np.linspace(0, np.pi, DIRECTIONS)]
    singularities = [_singularity(law, rho0, gamma0, place) for place in places]
    best = min(
        (phi for phi in singularities if phi is not None and _fits(b, abs(phi))), key=abs, default=None
    )
    if best is None:
        return Convergence(estimate, None)
    # once more straight towards it, which is where the fewest digits are lost
    again = _singularity(law, rho0, gamma0, cmath.rect(SHARE * estimate, cmath.phase(best)))
    if again is not None and abs(again - best) < 1e-3 * abs(best):
        best = again
    # of the pair the one above the axis
    return Convergence(estimate, complex(best.real, abs(best.imag)))


def _cosines(law: CurvatureLaw, rho0: float, gamma0: float) -> Array:
    """The coefficients b_n, as far as they are numbers."""
    with np.errstate(all="ignore"):
        curvature = [float(c) for c in law.series(0.0, TERMS)]
        cosines = np.asarray(system_series(rho0, math.sin(gamma0), math.cos(gamma0), curvature)[2])
    # beyond 1e120 products of coefficients overflow soon
    wrong = np.flatnonzero(~np.isfinite(cosines) | (np.abs(cosines) > 1e120))
    return cosines[: wrong[0]] if wrong.size else cosines


def _by_coefficients(b: Array) -> float:
    """The radius that the last half of the coefficients tell; of an even series those of phi squared."""
    # an even function has every second coefficient zero: as a series in phi^2 its radius is the square
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
    # quotients run like 1/R + c/n: drawn out to 1/n = 0
    slope = np.polyfit(1.0 / n[known], inverse[known], 1)[0]
    # the median, as single quotients are off where coefficients nearly vanish
    middle = np.median(inverse[known] - slope / n[known])
    return float(1.0 / middle) if middle > 0 else math.inf


def _fits(b: Array, radius: float) -> bool:
    """Whether the coefficients decay as they do on a circle of convergence of this radius."""
    n = np.arange(len(b) // 2, len(b))
    with np.errstate(all="ignore"):
        # b_n R^n n^(3/2) tends to a constant for a root singularity at the distance R
        sizes = np.log(np.abs(b[n])) + n * math.log(radius) + 1.5 * np.log(n)
    first, second = np.array_split(sizes, 2)
    return bool(abs(np.max(first) - np.max(second)) < AGREEMENT)


def _singularity(law: CurvatureLaw, rho0: float, gamma0: float, towards: complex) -> complex | None:
    """The angle of cos(gamma) = 0 that Newton's method finds from a complex place inside the circle."""
    phi, rho, sine, cosine = 0j, complex(rho0), complex(math.sin(gamma0)), complex(math.cos(gamma0))
    with np.errstate(all="ignore"):
        for step in range(1, 9):  # each a third of what is left to the circle
            # so that the last step ends at the share SHARE of the whole way
            place = (1.0 - (1.0 - SHARE) ** (step / 8)) / SHARE * towards
            series = system_series(rho, sine, cosine, law.series(phi, ORDER - 1))
            rho, sine, cosine = (_value(s, place - phi) for s in series)
            phi = place
        for _step in range(NEWTON):
            arcs = arc_series(phi, rho, sine, cosine, law.along, ORDER)
            # by the arc cos(gamma) has a simple root: Newton's method on its series
            arc = -arcs[3][0] / arcs[3][1] if arcs[3][1] else cmath.nan
            # no farther than the series hold
            arc = arc * min(1.0, _arc_reach(arcs) / abs(arc)) if abs(arc) > 0 else arc
            if not cmath.isfinite(arc):
                return None
            phi, rho, sine, cosine = (_value(s, arc) for s in arcs)
            if abs(arc) < 1e-15 * abs(rho):
                return phi
    return None


def _arc_reach(series: tuple[Series, ...]) -> float:
    """An arc over which all series hold to rounding."""
    reach = math.inf
    for coefficients in series:
        # a coefficient in units of the value, or of the slope by the arc
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


# Where a follower stalls: the arc of the path, by which everything stays regular, leads there.

MOST_ARCS = 30


class StallState(NamedTuple):
    """A place of the path: angle [rad], rho [m], sin(gamma), cos(gamma)."""

    phi: float
    rho: float
    sine: float
    cosine: float


def stall_behind(law: CurvatureLaw, place: StallState, sense: int, end: float) -> StallState | None:
    """The place with cos(gamma) = 0 behind one before it, in a sense of phi, up to an end.

    Taylor series by the arc; None where the cosine grows again, or the end or a break of the law comes first: a
    stall behind a break is found from there.
    """
    here = place
    for _arc in range(MOST_ARCS):
        series = arc_series(*here, lambda angles: law.along(angles, sense), ORDER)
        arc = sense * _stall_reach(series, here.rho)
        there = _normal([_stall_value(s, arc) for s in series])
        # the cosine has passed zero: the root of its series by the arc is the stall
        if there.cosine <= 0:
            stall = _normal([_stall_value(s, _root(series[3], arc)) for s in series])
            beyond = stall._replace(sine=math.copysign(1.0, stall.sine), cosine=0.0)
            return None if sense * (beyond.phi - end) > 0 else beyond
        # behind a break the law is another function; behind a grown cosine there is no stall near
        crossed = any(sense * (here.phi - b) < 0 < sense * (there.phi - b) for b in law.breaks)
        if crossed or sense * (there.phi - end) > 0 or there.cosine > 1.5 * place.cosine:
            return None
        here = there
    return None


def _stall_reach(series: tuple[Series, ...], rho: float) -> float:
    """An arc over which the series hold to rounding."""
    reach = math.inf
    for coefficients, scale in zip(series, (1.0, rho, 1.0, 1.0), strict=True):
        for k in (ORDER - 1, ORDER):
            size = abs(coefficients[k]) / scale
            if size > 0:
                reach = min(reach, (1e-17 / size) ** (1.0 / k))
    return min(reach, rho)


def _root(coefficients: Series, arc: float) -> float:
    """The root of a series between 0, where it is positive, and `arc`, where it is not."""
    powers = np.array(coefficients)
    slopes = polynomial.polyder(powers)

    def cosine(x: Array) -> tuple[Array, Array]:
        return np.asarray(polynomial.polyval(x, powers)), np.asarray(polynomial.polyval(x, slopes))

    # backwards the arc is negative
    low, high = np.sort([[0.0], [arc]], axis=0)
    return float(newton_roots(cosine, low, high)[0])


def _stall_value(coefficients: Series, x: float) -> float:
    total = 0.0
    for c in reversed(coefficients):
        total = total * x + c
    return total


def _normal(values: list[float]) -> StallState:
    """The state with sine and cosine brought back to one."""
    phi, rho, sine, cosine = values
    # sine and cosine keep together: rounding of the steps does not add up
    unit = math.hypot(sine, cosine)
    return StallState(phi, rho, sine / unit, cosine / unit)


TOLERANCE = 1e-13
"""Share of rho and of cos(gamma) that a step may leave out."""

LEAST_TOLERANCE, GREATEST_TOLERANCE = 1e-15, 1e-3
MOST_STEPS = 5000

NEAR_STALL = 0.6
"""Cosine of the pressure angle below which a stall is looked for, each time that the steps have become half as long."""

LAST_STRETCH = 1e-11
"""Share of the angle before a stall in which nothing is expanded: cos(gamma) runs as the root of what is left."""

LEAST_STEP = 1e-15
"""Share of the angle below which a step leads nowhere."""


class SeriesStep(NamedTuple):
    """Series of rho, sin(gamma), cos(gamma) about `centre` that hold up to `end`, on either side of it."""

    centre: float
    end: float
    series: tuple[Series, Series, Series]


class Ending(NamedTuple):
    """The last stretch before a stall: the state where it begins, and the stall."""

    place: StallState
    stall: StallState


@dataclass(frozen=True)
class ExpandedPath(StatePath):
    """A roller path by series of rho, sin(gamma) and cos(gamma), each about the end of the step before it.

    Made by `expanded_path`.

    Attributes
    ----------
    law : CurvatureLaw
    start, stop : float [rad]
        Ends of the path: of the asked range, or where the follower stalls.
    edges : (steps + 1), growing [rad]
    centres : (steps) [rad]
        One of the two edges of each step.
    coefficients : (3, steps, order + 1)
        Of rho [m], sin(gamma), cos(gamma).
    endings : tuple of Ending
        Last stretches before stalls.
    """

    law: CurvatureLaw
    start: float
    stop: float
    edges: Array
    centres: Array
    coefficients: Array
    endings: tuple[Ending, ...] = ()

    @property
    def stall(self) -> float | None:  # type: ignore[override]
        """Where cos(gamma) = 0 ends the path forwards [rad]; else backwards; None where it does not."""
        ends = [ending.stall.phi for ending in self.endings]
        return float(max(ends)) if ends else None

    @property
    def order(self) -> int:
        """Degree of the series."""
        return int(self.coefficients.shape[-1]) - 1

    def state(self, phi: Array) -> tuple[Array, Array, Array]:
        """Radius [m], sin(gamma), cos(gamma) at places inside the path."""
        steps = np.clip(np.searchsorted(self.edges, phi, side="right") - 1, 0, len(self.centres) - 1)
        offset = phi - self.centres[steps]
        states = np.zeros((3, *np.shape(phi)))
        for k in range(self.order, -1, -1):
            states = states * offset + self.coefficients[:, steps, k]
        for ending in self.endings:
            _end(states, phi, ending)
        return states[0], states[1], states[2]


def _end(found: Array, phi: Array, ending: Ending) -> None:
    """Put the state of a last stretch in place."""
    place, stall = ending
    share = (stall.phi - phi) / (stall.phi - place.phi)
    here = (share >= 0) & (share < 1)
    root = np.sqrt(share[here])
    cosine = place.cosine * root
    # towards a stall the radius and the cosine run like the root of what is left of the angle
    found[0, here] = stall.rho + (place.rho - stall.rho) * root
    found[1, here] = stall.sine * np.sqrt(1.0 - cosine**2)
    found[2, here] = cosine


def expanded_path(
    law: CurvatureLaw,
    rho0: float,
    gamma0: float = 0.0,
    start: float = 0.0,
    stop: float = math.pi / 2,
    tolerance: float = TOLERANCE,
) -> ExpandedPath:
    """The path of a roller's centre from its curvature.

    Parameters
    ----------
    law : CurvatureLaw
        K(phi) [1/m], positive over the range.
    rho0, gamma0 : float [m], [rad]
        Radius and pressure angle at phi = 0.
    start, stop : float [rad]
        The range; 0 lies in it. The path ends earlier where the follower stalls.
    tolerance : float
        Share of rho and cos(gamma) that a step may leave out.

    Returns
    -------
    ExpandedPath

    Raises
    ------
    InputError
        A range without 0, a tolerance out of bounds, or a curvature that is not positive and finite.

    Notes
    -----
    The degree is `2 - ln(tolerance)/2` and the step such that the last two terms stay below the tolerance (A. Jorba,
    M. Zou, A software package for the numerical integration of ODEs by means of high-order Taylor methods, 2005).
    """
    check_start(rho0, gamma0, start, stop)
    if not LEAST_TOLERANCE <= tolerance <= GREATEST_TOLERANCE:
        what = _("the tolerance must lie between {least:g} and {most:g}, got {value:g}")
        told = what.format(least=LEAST_TOLERANCE, most=GREATEST_TOLERANCE, value=tolerance)
        raise InputError("tolerance", told)
    check_span(law, start, stop)
    if not lawful(law, 0.0):
        raise refusal(law, 0.0)
    check_bend(rho0, float(law.series(0.0, 0)[0]))
    first = StallState(0.0, rho0, math.sin(gamma0), math.cos(gamma0))
    with np.errstate(all="ignore"):
        ahead, stalled = _march(law, first, stop, 1, tolerance)
        behind, stuck = _march(law, first, start, -1, tolerance)
    steps = [*reversed(behind), *ahead]
    low, high = (behind[-1].end if behind else 0.0), (ahead[-1].end if ahead else 0.0)
    # every inner edge is the centre of a step, as steps begin where the one before ended
    edges = sorted({low, high, *(step.centre for step in steps)})
    return ExpandedPath(
        law,
        low,
        high,
        np.asarray(edges),
        np.asarray([step.centre for step in steps]),
        np.asarray([step.series for step in steps]).swapaxes(0, 1),
        tuple(ending for ending in (stalled, stuck) if ending is not None),
    )


def _march(
    law: CurvatureLaw, place: StallState, stop: float, sense: int, tolerance: float
) -> tuple[list[SeriesStep], Ending | None]:
    """Steps from a place towards `stop`, and the last stretch where the follower stalls before it."""
    if stop == place.phi:
        return [], None
    wrong = unlawful_place(law, stop)
    # a law that ceases to be lawful before the end is followed up to there, as a stall may come first
    end = stop if wrong is None else wrong
    # Jorba and Zou's degree for this tolerance
    order = math.ceil(2.0 - 0.5 * math.log(tolerance))
    steps: list[SeriesStep] = []
    stall: StallState | None = None
    looked, rho0 = math.inf, place.rho
    while len(steps) < MOST_STEPS:
        series = system_series(*place[1:], law.series(place.phi, order - 1, sense))
        reach = _reach(series, tolerance)
        if not reach > LEAST_STEP * abs(place.phi):
            raise no_series(place.phi)
        # a path that runs away to infinity takes ever greater steps, which end nowhere
        if place.rho > MOST_GROWTH * rho0:
            raise runs_away(place.phi)
        # steps shrink like the way to a singularity: each time they have halved, a stall is looked for anew
        if stall is None and place.cosine < NEAR_STALL and reach < 0.5 * looked:
            looked = reach
            stall = stall_behind(law, place, sense, end)
            end = end if stall is None else stall.phi
        to = _nearest(sense, place.phi + sense * reach, end, law.breaks, place.phi)
        # so near to the stall the root law holds to rounding
        if stall is not None and sense * (stall.phi - to) <= LAST_STRETCH * abs(stall.phi):
            steps.append(SeriesStep(place.phi, stall.phi, series))
            return steps, Ending(place, stall)
        steps.append(SeriesStep(place.phi, to, series))
        place = _move_centre(series, place.phi, to)
        if to == end:
            if wrong is not None and stall is None:
                raise refusal(law, wrong)
            return steps, None
    what = _("the path needs more than {most} steps").format(most=MOST_STEPS)
    raise InputError("[curvature]", what, _("shorten the range, or increase the tolerance"))


def _reach(series: tuple[Series, Series, Series], tolerance: float) -> float:
    """An angle over which the last two terms of each series stay below the tolerance; NaN where they are no numbers."""
    reach = math.inf
    if not all(math.isfinite(c) for coefficients in series for c in coefficients):
        return math.nan
    scales = (series[0][0], series[2][0], series[2][0])
    for coefficients, scale in zip(series, scales, strict=True):
        for k in (len(coefficients) - 2, len(coefficients) - 1):
            size = abs(coefficients[k]) / scale
            if size > 0:
                reach = min(reach, (tolerance / size) ** (1.0 / k))
    return reach


def _nearest(sense: int, reach: float, end: float, breaks: tuple[float, ...], start: float) -> float:
    """The first of what a step may reach, the end, and the next break of the law."""
    ahead = [b for b in breaks if sense * (b - start) > 0]
    return sense * min(sense * place for place in (reach, end, *ahead))


def _move_centre(series: tuple[Series, Series, Series], centre: float, to: float) -> StallState:
    offset = to - centre
    values = []
    for coefficients in series:
        total = 0.0
        for c in reversed(coefficients):
            total = total * offset + c
        values.append(float(total))
    rho, sine, cosine = values
    unit = math.hypot(sine, cosine)
    return StallState(to, rho, sine / unit, cosine / unit)


# From the description of a cam to its curvature law and the path of its roller's centre.


def law_of(cam: AnyCam) -> CurvatureLaw:
    """The curvature law K(phi) [1/m] of a cam; InputError where its numbers make none."""
    cam = require_curvature_cam(cam)
    given = cam.curvature
    try:
        if given.law == "constant":
            return ConstantCurvature(given.k0 or math.nan)
        if given.law == "exponential":
            return ExponentialCurvature(given.k0 or math.nan, given.k1 or 0.0)
        if given.law == "linear":
            return LinearCurvature(given.k0 or math.nan, given.k1 or 0.0)
        if given.law == "spline":
            angles, values = zip(*given.points or (), strict=True)
            return SplineCurvature(angles, values)
        return TextCurvature(
            given.formula or "", cam.range.start, cam.range.stop, tuple(given.constants.items())
        )
    except InputError as error:
        raise InputError(error.where or "[curvature]", error.what, error.repair) from None


def half_path(cam: AnyCam, tolerance: float = TOLERANCE) -> ExpandedPath:
    """The path that the law itself gives: of a symmetric cam the half with phi >= 0."""
    cam = require_curvature_cam(cam)
    start = cam.start
    return expanded_path(
        law_of(cam), start.radius, start.pressure_angle, cam.range.start, cam.range.stop, tolerance
    )


def path_of(cam: AnyCam, tolerance: float = TOLERANCE) -> RollerPath:
    """The path of the roller's centre, by series expanded anew step by step to a tolerance.

    Raises
    ------
    InputError
        A curvature that is not positive and finite where the path goes; the error gives its angle.
    """
    cam = require_curvature_cam(cam)
    half = half_path(cam, tolerance)
    return SymmetricPath(half) if cam.curvature.symmetric else half
