"""The path of a roller's centre about a cam's centre: what profiles, movers and stresses are computed from.

The angle phi [rad] of the carrier is counted from the y axis towards the x axis, as the paper does:
X = rho sin(phi), Y = rho cos(phi).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from centrode.cams.curvature_laws import CurvatureLaw, derivatives
from centrode.cams.recursions import system_series
from centrode.errors import InputError
from centrode.locale import _

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
    """What follows from the state (rho, eta, cos gamma) at a place: derivatives of any order by the equations.

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
            found = system_series(*state, self.law.series(places, order - 1))[which]
        return np.asarray([math.factorial(k) * c for k, c in enumerate(found)])


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
            raise InputError("[start] gamma0", what, _("set gamma0 = 0, or leave out symmetric"))

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
        return _signed(self.half.radius(np.abs(phi), order), phi, 0)

    def sine(self, phi: Array, order: int = 0) -> Array:
        return _signed(self.half.sine(np.abs(phi), order), phi, 1)

    def pressure_angle(self, phi: Array) -> Array:
        return np.where(np.asarray(phi) < 0, -1.0, 1.0) * self.half.pressure_angle(np.abs(phi))

    def curvature(self, phi: Array, order: int = 0) -> Array:
        return _signed(self.half.curvature(np.abs(phi), order), phi, 0)


def _signed(found: Array, phi: Array, parity: int) -> Array:
    signs = (-1.0) ** (np.arange(len(found)) + parity)
    return np.where(np.asarray(phi) < 0, signs[:, None] * found, found)
