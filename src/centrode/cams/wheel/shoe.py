"""The shoe of a leg: the profile that rolls on flat ground while the hub stays at its height.

The ground touches the shoe in the leg's axes as a line whose normal makes the angle phi with the leg. Its distance
from the roller's centre is p(phi) = h - H cos phi, h the height of the hub, H the polar radius of the roller's path:
the support function of the shoe. Its envelope is the paper's X_B = Y2 sin phi, Y_B = Y1 + Y2 cos phi with
Y1 = H' cot phi - H and Y2 = h - H' cos(phi)^2 / sin phi, but p has no quotient that vanishes at phi = 0.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from centrode.algebra.jets import Jet, quotient
from centrode.cams.closed.arcs import Arc
from centrode.cams.frames import JETS, Array, radius_jet
from centrode.cams.nodes import nodes_of
from centrode.cams.path import SymmetricPath
from centrode.errors import InputError, MotionError
from centrode.locale import _
from centrode.numerics.search import extremes

NEAR = 0.03
"""Within so many radians of phi = 0, H'/sin phi is the quotient of two series."""
TERMS = 14
LEVEL = 1e-12
"""Greatest pressure angle [rad] at phi = 0 that counts as zero."""


@dataclass(frozen=True)
class Shoe:
    """The shoe that belongs to a symmetric working arc and a height of the hub.

    Attributes
    ----------
    arc : Arc
        Working arc, -half to half; the shoe is as symmetric as the path over it.
    height : float [m]
        Of the hub over the ground, R0 + r + C.
    """

    arc: Arc
    height: float

    @property
    def half(self) -> float:
        """Half the working arc [rad]."""
        return self.arc.stop

    def support(self, phi: Array, order: int = 0) -> Array:
        """Distance of the ground from the roller's centre and its derivatives (order + 1, n) [m/rad^k]."""
        p = self._support(np.asarray(phi, dtype=np.float64), order)
        return np.array([c * math.factorial(k) for k, c in enumerate(p.coefficients)])

    def place(self, phi: Array) -> Array:
        """Points (X_B, Y_B) of the profile (n, 2) [m] in the leg's axes: Y along the leg from the roller's centre."""
        p, slope = self.support(phi, 1)
        sine, cosine = np.sin(phi), np.cos(phi)
        return np.stack([p * sine + slope * cosine, p * cosine - slope * sine], axis=-1)

    def polar(self, phi: Array) -> tuple[Array, Array]:
        """Angle alpha [rad] from the shoe's axis and radius [m] about the roller's centre: the paper's (9), (10)."""
        x, y = self.place(phi).T
        return np.arctan2(x, y), np.hypot(x, y)

    def bend(self, phi: Array) -> Array:
        """Radius of curvature (n) [m] of the profile: p + p''."""
        p = self.support(phi, 2)
        return np.asarray(p[0] + p[2])

    def parts(self, phi: Array) -> tuple[Array, Array]:
        """The paper's Y1 along the leg and Y2 upright (n) [m]: the contact lies at Y1 d + Y2 n.

        At phi = 0, H'/sin phi is a removable singularity: near it both are divided as series, elsewhere as numbers.
        """
        phi = np.asarray(phi, dtype=np.float64)
        radius, slope = self.arc.curve.radius(phi, 1)
        with np.errstate(divide="ignore", invalid="ignore"):
            share = slope / np.sin(phi)
        near = np.abs(phi) <= self._near
        inner = np.abs(phi[near]) if 0.0 in self.arc.breaks else phi[near]
        share[near] = np.polynomial.polynomial.polyval(inner, self._share)
        cosine = np.cos(phi)
        return share * cosine - radius, self.height - share * cosine**2

    @cached_property
    def least_bend(self) -> tuple[float, float]:
        """The least radius of curvature [m] of the profile and where [rad]."""
        found = extremes(
            self.bend,
            lambda phi: np.asarray(self.support(phi, 1)[1] + self.support(phi, 3)[3]),
            nodes_of(self.arc.edges),
        )
        return found.least, found.at_least

    def _support(self, phi: Array, order: int) -> Jet:
        angle = Jet([phi, *([np.ones_like(phi)] if order else []), *([0.0 * phi] * (order - 1))])
        lowered: Jet = radius_jet(self.arc.curve, phi, order) * JETS.cos(angle)
        return -lowered + self.height

    @cached_property
    def _share(self) -> Array:
        """Taylor coefficients of H'/sin phi about phi = 0, to the right."""
        rho = radius_jet(self.arc.curve, np.zeros(1), TERMS + 1).slope()
        sine = JETS.sin(Jet.variable(np.zeros(1), TERMS))
        found = quotient(tuple(rho.coefficients[1:]), tuple(c + np.zeros(1) for c in sine.coefficients[1:]))
        return np.array([float(c[0]) for c in found])

    @cached_property
    def _near(self) -> float:
        """How far the series is good to rounding: to no side where the law breaks at 0 without symmetry."""
        if 0.0 in self.arc.breaks and not isinstance(self.arc.curve, SymmetricPath):
            return 0.0
        last, first = abs(self._share[-1]), abs(self._share[0]) or 1.0
        reach = (np.finfo(float).eps * first / last) ** (1.0 / TERMS) if last else NEAR
        return float(min(NEAR, reach, *(abs(one) for one in self.arc.breaks if one)))


def shoe(arc: Arc, height: float) -> Shoe:
    """The shoe of a working arc.

    Parameters
    ----------
    arc : Arc
        From -half to half, less than a quarter turn to each side.
    height : float [m]
        Of the hub over the ground.

    Raises
    ------
    InputError
        gamma is not zero at phi = 0, where the contact would jump across the shoe (the paper's Y2 is infinite
        there); the arc is not as asked; the height does not exceed the path's radius.
    MotionError
        The shoe would have a cusp: the message tells the least height without one.
    """
    if abs(arc.start + arc.stop) > LEVEL or arc.stop >= math.pi / 2:
        raise InputError(
            "",
            _("a shoe belongs to equal arcs of less than 90 deg to both sides"),
            _("take three legs or more"),
        )
    radius, slope = arc.curve.radius(np.zeros(1), 1)[:, 0]
    gamma = math.atan2(slope, radius)
    if abs(gamma) > LEVEL:
        what = _("the shoe is singular: at phi = 0 its contact would jump by {jump:.6g} mm").format(
            jump=2e3 * abs(slope)
        )
        raise InputError("[start] pressure_angle", what, _("set it to 0"))
    if not height > radius:
        what = _("the hub at {height:.6g} mm lies lower than the roller's path reaches, {radius:.6g} mm")
        raise InputError(
            "[mover]", what.format(height=1e3 * height, radius=1e3 * radius), _("take a longer shoe post")
        )
    found = Shoe(arc, height)
    least, at = found.least_bend
    if least <= 0.0:
        what = _(
            "the shoe has a cusp: its radius of curvature falls to {least:.6g} mm at {at:.6g} deg"
        ).format(least=1e3 * least, at=math.degrees(at))
        more = _("make the post of the shoe longer by more than {more:.6g} mm").format(more=-1e3 * least)
        raise MotionError("[mover]", what, more)
    return found
