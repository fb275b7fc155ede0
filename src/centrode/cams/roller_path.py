"""The path of a roller's centre about a cam's centre: what profiles, movers and stresses are computed from.

The angle phi [rad] of the carrier is counted from the y axis towards the x axis, as the paper does:
X = rho sin(phi), Y = rho cos(phi).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import factorial
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt
import xarray as xr
from numpy.typing import NDArray

from centrode.cams.curvature_laws import CurvatureLaw, derivatives
from centrode.errors import InputError
from centrode.locale import _, ngettext
from centrode.model import reading
from centrode.model.cam_files import AnyCam
from centrode.model.follower_cam import PlateCam
from centrode.model.motion_parameter import ANGLE
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.jets import Jet, JetFunctions
from centrode.numerics.search import Extremes as PathExtremes
from centrode.numerics.search import Function, extremes

# Taylor coefficients of a roller path from its differential equations, over any algebra with `+ - * /`.
#
# With eta = sin(gamma) and lambda = cos(gamma), gamma the pressure angle, the path of curvature K obeys `eta'
# = lambda - rho K`, `rho' lambda = rho eta`, `lambda lambda' = -eta eta'`. Equation numbers are those of A.
# T. Skoibeda, V. N. Zhukovets, Solution of an autonomous nonlinear differential equation of second order in
# the construction of plane curves (in Russian).

Number = Any
Series = list[Number]


def system_series(
    rho: Number, eta: Number, cosine: Number, curvature: Sequence[Number]
) -> tuple[Series, Series, Series]:
    """Coefficients of rho, eta and lambda about a place, from their values and the coefficients of K there.

    Neither K nor its slope is divided by: the zeros of K do not spoil them. One order more than K has, work of the
    order squared.
    """
    radii, sines, cosines = [rho], [eta], [cosine]
    for n in range(len(curvature)):
        bent: Number = 0
        climb: Number = 0
        for i in range(n + 1):
            bent = bent + radii[i] * curvature[n - i]
            climb = climb + radii[i] * sines[n - i]
        for i in range(1, n + 1):
            climb = climb - (n + 1 - i) * cosines[i] * radii[n + 1 - i]
        # the outer term of rho' lambda is what is solved for; the others are known
        sines.append((cosines[n] - bent) / (n + 1))
        radii.append(climb / ((n + 1) * cosine))
        cosines.append(next_cosine(sines, cosines))
    return radii, sines, cosines


def next_cosine(a: Sequence[Number], b: Sequence[Number]) -> Number:
    """b_(m+1) from a_0 ... a_(m+1) and b_0 ... b_m: formulas (24) for even m and (25) for odd m."""
    m = len(b) - 1
    total: Number = 0
    if m % 2 == 0:
        for i in range(m // 2 + 1):
            total = total - a[i] * a[m + 1 - i]
        for i in range(1, m // 2 + 1):
            total = total - b[i] * b[m + 1 - i]
        return total / b[0]
    # each product of two different coefficients stands twice in the square, hence 2 below
    for i in range((m - 1) // 2 + 1):
        total = total - a[i] * a[m + 1 - i]
    for i in range(1, (m - 1) // 2 + 1):
        total = total - b[i] * b[m + 1 - i]
    half = (m - 1) // 2 + 1
    return (2 * total - a[half] * a[half] - b[half] * b[half]) / (2 * b[0])


def exponential_series(
    a_0: Number, a_1: Number, b_0: Number, rate: Number, terms: int
) -> tuple[Series, Series]:
    """a_0 ... a_terms and b_0 ... b_(terms-1) of eta and lambda for K = k0 exp(k1 phi): (24), (25) and (34)."""
    a, b = [a_0, a_1], [b_0]
    for m in range(terms - 1):
        a.append((rate * ((m + 1) * a[m + 1] - b[m]) - a[m]) / ((m + 2) * (m + 1)))
        b.append(next_cosine(a, b))
    return a, b


def arc_series(
    phi: Number, rho: Number, eta: Number, cosine: Number, curvature: Any, order: int
) -> tuple[Series, Series, Series, Series]:
    """Coefficients of phi, rho, eta and lambda by the arc s of the path: regular where lambda is zero.

    `phi' = lambda / rho`, `rho' = eta`, `eta' = lambda w`, `lambda' = -eta w` with `w = phi' - K(phi(s))`;
    `curvature(coefficients of phi)` gives those of K, as many as it gets.
    """
    angles, radii, sines, cosines = [phi], [rho], [eta], [cosine]
    turning: Series = []
    rates: Series = []
    for n in range(order):
        # rho w = lambda by division of series: rates are phi' = lambda / rho
        rate = cosines[n]
        for i in range(n):
            rate = rate - rates[i] * radii[n - i]
        rates.append(rate / rho)
        turning.append(rates[n] - curvature(angles)[n])
        angles.append(rates[n] / (n + 1))
        radii.append(sines[n] / (n + 1))
        up: Number = 0
        down: Number = 0
        for i in range(n + 1):
            up = up + cosines[i] * turning[n - i]
            down = down - sines[i] * turning[n - i]
        sines.append(up / (n + 1))
        cosines.append(down / (n + 1))
    return angles, radii, sines, cosines


Array = NDArray[np.float64]

ROUNDING = 4 * np.finfo(np.float64).eps
"""Angles [turns of a radian] by which a place may lie beyond an end and still count as the end."""


class RollerPath(Protocol):
    """The polar radius rho(phi) of a roller's centre, with its derivatives.

    Attributes
    ----------
    law : CurvatureLaw
        Curvature [1/m] of the path.
    start, stop : float [rad]
        Where it begins and ends; `start` <= 0 <= `stop`.
    stall : float [rad] or None
        The end of the path where the follower stalls (cos gamma = 0), if it does so within the asked range.
    """

    @property
    def law(self) -> CurvatureLaw: ...
    @property
    def start(self) -> float: ...
    @property
    def stop(self) -> float: ...
    @property
    def stall(self) -> float | None: ...

    def radius(self, phi: Array, order: int = 0) -> Array:
        """The radius and its derivatives by phi (order + 1, n) [m/rad^k]; NaN outside `start` to `stop`."""

    def sine(self, phi: Array, order: int = 0) -> Array:
        """The sine eta of the pressure angle and its derivatives (order + 1, n) [1/rad^k]."""

    def pressure_angle(self, phi: Array) -> Array:
        """The pressure angle (n) [rad], tan(gamma) = rho'/rho: positive where the follower rises."""

    def curvature(self, phi: Array, order: int = 0) -> Array:
        """K and its derivatives by phi (order + 1, n) [1/m/rad^k]."""


class StatePath:
    """Derivatives of any order from the state (rho, eta, cos gamma) at a place, by the equations.

    So a derivative is as accurate as the state, whatever its order; towards a stall they grow without bound.
    """

    law: CurvatureLaw
    start: float
    stop: float
    stall: float | None = None

    def state(self, phi: Array) -> tuple[Array, Array, Array]:
        """Radius [m], sin(gamma), cos(gamma) at places inside the path."""
        raise NotImplementedError

    def radius(self, phi: Array, order: int = 0) -> Array:
        """The radius and its derivatives by phi (order + 1, n) [m/rad^k]; NaN outside the path."""
        return self._derivatives(phi, order, 0)

    def sine(self, phi: Array, order: int = 0) -> Array:
        """The sine eta of the pressure angle and its derivatives (order + 1, n) [1/rad^k]; NaN outside the path."""
        return self._derivatives(phi, order, 1)

    def pressure_angle(self, phi: Array) -> Array:
        """The pressure angle (n) [rad]; NaN outside the path."""
        _radius, sine, cosine = self.state(inside(self, phi))
        return np.asarray(np.arctan2(sine, cosine))

    def curvature(self, phi: Array, order: int = 0) -> Array:
        """K and its derivatives by phi (order + 1, n) [1/m/rad^k]; NaN outside the path."""
        return derivatives(self.law, inside(self, phi), order)

    def _derivatives(self, phi: Array, order: int, which: int) -> Array:
        places = inside(self, phi)
        state = self.state(places)
        if not order:
            return np.asarray(state[which])[None]
        with np.errstate(all="ignore"):
            # the recursion gives one order more than the law is given to
            series = system_series(*state, self.law.series(places, order - 1))[which]
        return np.asarray([math.factorial(k) * c for k, c in enumerate(series)])


def inside(path: RollerPath | StatePath, phi: Array) -> Array:
    """The places, those beyond an end by rounding moved to it, others outside NaN."""
    places = np.asarray(phi, dtype=np.float64)
    slack = ROUNDING * max(1.0, abs(path.start), abs(path.stop))
    known = (places >= path.start - slack) & (places <= path.stop + slack)
    return np.where(known, np.clip(places, path.start, path.stop), np.nan)


def stalls_of(path: RollerPath) -> tuple[float, ...]:
    """The ends of a path [rad], growing, at which the follower stalls: there gamma is a right angle exactly."""
    if path.stall is None:
        return ()
    ends = np.array([path.start, path.stop])
    return tuple(ends[np.abs(path.pressure_angle(ends)) == math.pi / 2].tolist())


@dataclass(frozen=True)
class SymmetricPath:
    """A path for phi >= 0 and its mirror image in the y axis: rho(-phi) = rho(phi).

    Value, slope and curvature join at phi = 0, where the pressure angle has to be zero; higher derivatives of
    odd order jump there, that of the right-hand side is given.
    """

    half: RollerPath

    def __post_init__(self) -> None:
        kink = float(self.half.pressure_angle(np.zeros(1))[0])
        if abs(kink) > ROUNDING:
            what = _("a symmetric path has a kink of {angle:.4g} deg at phi = 0").format(
                angle=math.degrees(2 * kink)
            )
            raise InputError("[start] gamma0", what, _("set gamma0 = 0, or omit symmetric"))

    @property
    def law(self) -> CurvatureLaw:
        return self.half.law

    @property
    def start(self) -> float:
        return -self.half.stop

    @property
    def stop(self) -> float:
        return self.half.stop

    @property
    def stall(self) -> float | None:
        return self.half.stall

    def radius(self, phi: Array, order: int = 0) -> Array:
        return _apply_signs(self.half.radius(np.abs(phi), order), phi, 0)

    def sine(self, phi: Array, order: int = 0) -> Array:
        return _apply_signs(self.half.sine(np.abs(phi), order), phi, 1)

    def pressure_angle(self, phi: Array) -> Array:
        return np.where(np.asarray(phi) < 0, -1.0, 1.0) * self.half.pressure_angle(np.abs(phi))

    def curvature(self, phi: Array, order: int = 0) -> Array:
        return _apply_signs(self.half.curvature(np.abs(phi), order), phi, 0)


def _apply_signs(found: Array, phi: Array, parity: int) -> Array:
    # each derivative of an even function is odd, and the other way round
    signs = (-1.0) ** (np.arange(len(found)) + parity)
    return np.where(np.asarray(phi) < 0, signs[:, None] * found, found)


# The frame that goes along the path of a roller's centre: place, normal, curvature, from the polar radius
# alone.

JETS = JetFunctions(ARRAYS)


class PolarCurve(Protocol):
    """A curve about the cam's centre, given by its polar radius: a RollerPath is one, and so is a closed path."""

    def radius(self, phi: Array, order: int = 0) -> Array:
        """Polar radius and its derivatives by phi (order + 1, n) [m/rad^k]."""


@dataclass(frozen=True)
class Frames:
    """Frames of a polar curve at angles `phi` (n) [rad], counted from the y axis towards the x axis.

    Attributes
    ----------
    radius : (n) [m]
    pressure_angle : (n) [rad]
        gamma, tan(gamma) = rho'/rho.
    normal_angle : (n) [rad]
        psi = phi - gamma, of the outward normal, counted as phi is: the paper's (7).
    place, normal, tangent : (n, 2) [m], unit vectors
        The tangent points to where phi grows.
    speed : (n) [m/rad]
        ds/dphi.
    curvature, curvature_slope : (n) [1/m], [1/m/rad]
        Positive where the curve bends towards the cam's centre; derivative by phi.
    """

    phi: Array
    radius: Array
    pressure_angle: Array
    normal_angle: Array
    place: Array
    normal: Array
    tangent: Array
    speed: Array
    curvature: Array
    curvature_slope: Array


def radius_jet(curve: PolarCurve, phi: Array, order: int) -> Jet:
    """The polar radius as a jet along phi."""
    return Jet([row / factorial(k) for k, row in enumerate(curve.radius(phi, order))])


def frames(curve: PolarCurve, phi: Array) -> Frames:
    """Frames of a curve at angles (n) [rad]; exact to the rounding of the radius's three derivatives."""
    phi = np.asarray(phi, dtype=np.float64)
    with np.errstate(invalid="ignore", divide="ignore"):
        rho = radius_jet(curve, phi, 3)
        slope, value = rho.slope(), rho.lower_order()
        gamma = JETS.atan2(slope, value)
        speed = JETS.sqrt(slope * slope + value * value)
        # the outward normal turns by psi' = 1 - gamma' while the place goes ds/dphi: the curvature is their quotient
        turning = -gamma.slope() + 1.0
        curvature = turning / speed.lower_order()
    psi = phi - gamma.value
    sine, cosine = np.sin(psi), np.cos(psi)
    return Frames(
        phi,
        rho.value,
        gamma.value,
        psi,
        rho.value[:, None] * np.stack([np.sin(phi), np.cos(phi)], axis=-1),
        np.stack([sine, cosine], axis=-1),
        np.stack([cosine, -sine], axis=-1),
        speed.value,
        curvature.value,
        curvature.derivative(1),
    )


# Conditions on a path: its start, its range, that it stays near and smooth.

GREATEST_RANGE = 20 * math.pi
"""Ten turns either way."""

STEEPEST = math.radians(89.0)


MOST_BEND = 1e4
"""Radius at the start over the radius of curvature there."""


MOST_GROWTH = 1e6
"""Rho over rho0 from which on a path is taken to run away."""


def check_bend(rho0: float, curvature: float) -> None:
    """Raise InputError for a path that bends into next to a point at its start."""
    if rho0 * curvature > MOST_BEND:
        what = _("at the start the radius of curvature is more than {times:g} times smaller than the radius")
        raise InputError("[curvature]", what.format(times=MOST_BEND), _("check the units of the curvature"))


def check_start(rho0: float, gamma0: float, start: float, stop: float) -> None:
    """Raise InputError for a start that no path has: radius, pressure angle and range."""
    if not all(math.isfinite(number) for number in (rho0, gamma0, start, stop)):
        raise InputError("[start]", _("finite numbers are needed"), _("correct them"))
    if rho0 <= 0:
        what = _("the radius at the start has to be positive, got {value:g} m").format(value=rho0)
        raise InputError("[start] radius", what)
    if abs(gamma0) > STEEPEST:
        what = _("the pressure angle at the start must lie within 89 deg, got {angle:.6g} deg")
        told = what.format(angle=math.degrees(gamma0))
        raise InputError("[start] pressure_angle", told, _("at 90 deg the follower stalls"))
    if not start <= 0.0 <= stop or start == stop:
        what = _("the range must contain the start phi = 0, got {start:.6g} to {stop:.6g} deg")
        told = what.format(start=math.degrees(start), stop=math.degrees(stop))
        raise InputError("[range]", told, _('write [range] with "from" not above 0 and "to" not below'))
    if stop - start > GREATEST_RANGE:
        what = _("the range is longer than {turns:g} turns").format(turns=GREATEST_RANGE / math.tau)
        raise InputError("[range]", what, _("shorten it"))


def no_series(phi: float) -> InputError:
    """Error for a path that cannot be expanded at an angle [rad]."""
    what = _("the path has no Taylor series at {angle:.6g} deg").format(angle=math.degrees(phi))
    repair = _(
        "a root of a term that vanishes there is not smooth, and a term that changes too fast exceeds the range "
        "of floating-point numbers"
    )
    return InputError("[curvature]", what, repair)


def runs_away(phi: float) -> InputError:
    """Error for a path that leaves the cam at an angle [rad]."""
    what = _(
        "the path diverges from the cam's centre: at {angle:.6g} deg ρ is {growth:g} times its initial value"
    )
    told = what.format(angle=math.degrees(phi), growth=MOST_GROWTH)
    return InputError("[curvature]", told, _("increase the curvature, or shorten the range"))


# Angles of the carrier at which a cam is looked at.

DEFAULT_SAMPLES = 361
FEWEST = 2
"""Samples of what is computed for its extremes alone."""


def ends_of(cam: AnyCam) -> tuple[float, float]:
    """First and last angle [rad] that a cam asks for: of a symmetric one on both sides, of a follower's a turn."""
    if isinstance(cam, PlateCam):
        return 0.0, math.tau
    low, high = cam.range.start, cam.range.stop
    return (-high, high) if cam.curvature.symmetric else (low, high)


def angles_of(cam: AnyCam, samples: int | None = None, at: npt.ArrayLike | None = None) -> Array:
    """Angles [rad]: those given, else evenly spaced ones, both ends included.

    Raises
    ------
    InputError
        A number of samples out of bounds, or angles that are not finite numbers in one dimension.
    """
    if at is None:
        asked = samples if samples is not None else cam.study.samples
        count = DEFAULT_SAMPLES if asked is None else asked
        if isinstance(count, bool) or not 2 <= count <= reading.SAMPLES:
            what = ngettext("{n} sample is given", "{n} samples are given", count).format(n=count)
            raise InputError(_("samples"), what, _("give 2 to {most}").format(most=reading.SAMPLES))
        return np.linspace(*ends_of(cam), count)
    angle = replace(ANGLE, refuses_bare=cam.display.refuses_bare_angles)
    try:
        places = np.asarray(angle.read_all(at, "at"), dtype=np.float64)
    except (TypeError, ValueError):
        places = np.array(math.nan)
    if places.ndim != 1 or not 1 <= len(places) <= reading.SAMPLES or not np.isfinite(places).all():
        raise InputError("at", _("a one-dimensional array of finite angles of the carrier is required"))
    return places


def in_order_of(dataset: xr.Dataset, pattern: xr.Dataset) -> xr.Dataset:
    """A dataset with the variables of another, in their order; a netCDF file does not keep it.

    Raises KeyError where one is absent.
    """
    return dataset[list(pattern.data_vars)]


# Least and greatest values of a path: of its radius, its pressure angle, its curvature.

NODES = 1441


def radius_extremes(path: RollerPath) -> PathExtremes:
    """Of rho [m]."""
    return _extremes(path, lambda phi: path.radius(phi)[0], lambda phi: path.sine(phi)[0])


def pressure_extremes(path: RollerPath) -> PathExtremes:
    """Of the pressure angle [rad]."""
    return _extremes(path, path.pressure_angle, lambda phi: path.sine(phi, 1)[1])


def curvature_extremes(path: RollerPath) -> PathExtremes:
    """Of the curvature [1/m]."""
    return _extremes(path, lambda phi: path.curvature(phi)[0], lambda phi: path.curvature(phi, 1)[1])


def _extremes(path: RollerPath, value: Function, slope: Function) -> PathExtremes:
    """From nodes, the places between them where the sign of the slope changes, and the ends."""
    nodes = np.unique(np.concatenate([np.linspace(path.start, path.stop, NODES), _breaks(path)]))
    with np.errstate(all="ignore"):
        return extremes(value, slope, nodes)


def _breaks(path: RollerPath) -> list[float]:
    return [place for place in path.law.breaks if path.start < place < path.stop]
