"""Bounds of a return arc: its size and its curvature, and by how much a curve keeps them."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from centrode.cams.closed.curves import ReturnCurve
from centrode.cams.frames import Array, Frames, frames
from centrode.cams.nodes import nodes_of
from centrode.errors import InputError
from centrode.locale import _
from centrode.numerics.search import Extremes, extremes

MOST = 16
"""Functions added to the smoothest curve."""
TOLERANCE = 1e-9
"""Share of a bound by which it counts as kept."""


@dataclass(frozen=True)
class Bounds:
    """Bounds of the roller-centre path on its return arc.

    Attributes
    ----------
    least_radius, greatest_radius : float [m]
        Of the polar radius.
    least_bend : float [m]
        Least radius of curvature where the path bends towards the cam's centre (convex); it has to exceed the
        roller's radius or the profile is undercut.
    convex : bool
        No inward bend anywhere.
    least_hollow : float [m]
        Least radius of curvature where the path bends away from the centre; of no use with `convex`.
    pressure_angle : float [rad]
        Greatest pressure angle, without sign.
    """

    least_radius: float = 0.0
    greatest_radius: float = math.inf
    least_bend: float = 0.0
    convex: bool = True
    least_hollow: float = 0.0
    pressure_angle: float = math.pi / 2

    def __post_init__(self) -> None:
        lengths = (self.least_radius, self.greatest_radius, self.least_bend, self.least_hollow)
        if any(math.isnan(one) or one < 0 for one in lengths) or math.isinf(self.least_radius):
            raise InputError("[return]", _("bounds are positive lengths"), _("correct them"))
        if not 0 < self.pressure_angle <= math.pi / 2:
            what = _("a greatest pressure angle lies between 0 and 90 deg")
            raise InputError("[return] pressure_angle", what, _("correct it"))
        if self.least_radius >= self.greatest_radius:
            what = _("the least radius is not smaller than the greatest")
            raise InputError("[return]", what, _("exchange or widen them"))

    @property
    def greatest_curvature(self) -> float:
        """Of the path [1/m]."""
        return 1.0 / self.least_bend if self.least_bend else math.inf

    @property
    def least_curvature(self) -> float:
        """Of the path [1/m]: negative where it may bend away from the centre."""
        if self.convex:
            return 0.0
        return -1.0 / self.least_hollow if self.least_hollow else -math.inf

    def margins(self, rho: Array, moving: Array, scale: float) -> tuple[Array, Array]:
        """Margins of the bounds, positive where kept, and their gradients.

        Parameters
        ----------
        rho : (3, n)
            Radius and two derivatives, over `scale`.
        moving : (weights, 3, n)
            What they change by with each weight.
        scale : float [m]

        Returns
        -------
        (m), (m, weights)
            Of the finite bounds, in units of the scale.
        """
        bend, slopes = _curvature(rho, moving)
        steep = math.tan(self.pressure_angle) if self.pressure_angle < math.pi / 2 else math.inf
        slant, slanting = rho[1] / rho[0], (moving[:, 1] - moving[:, 0] * rho[1] / rho[0]) / rho[0]
        found, gradients = [], []
        for value, gradient, low, high in (
            # a polar radius has to stay positive whatever is asked for
            (rho[0], moving[:, 0], max(self.least_radius / scale, 1e-3), self.greatest_radius / scale),
            (bend, slopes, self.least_curvature * scale, self.greatest_curvature * scale),
            (slant, slanting, -steep, steep),
        ):
            if math.isfinite(low):
                found.append(value - low)
                gradients.append(gradient.T)
            if math.isfinite(high):
                found.append(high - value)
                gradients.append(-gradient.T)
        return np.concatenate(found), np.concatenate(gradients)


@dataclass(frozen=True)
class Margins:
    """Extremes of a curve beside its bounds.

    Attributes
    ----------
    radius : (least, greatest) [m]
    curvature : (least, greatest) [1/m]
    pressure_angle : float [rad]
        The greatest, without sign.
    places : tuple of float [rad]
        Where these lie.
    """

    bounds: Bounds
    radius: tuple[float, float]
    curvature: tuple[float, float]
    pressure_angle: float
    places: tuple[float, ...]

    @staticmethod
    def along(curve: ReturnCurve, bounds: Bounds) -> Margins:
        """The extremes of a whole arc."""
        size, bend, slant = sizes(curve), bends(curve), slants(curve)
        places = tuple(at for one in (size, bend, slant) for at in (one.at_least, one.at_greatest))
        steepest = max(-slant.least, slant.greatest)
        return Margins(bounds, (size.least, size.greatest), (bend.least, bend.greatest), steepest, places)

    @staticmethod
    def at(frame: Frames, bounds: Bounds) -> Margins:
        """The values at one place."""
        size, bend = float(frame.radius[0]), float(frame.curvature[0])
        steepness = abs(float(frame.pressure_angle[0]))
        return Margins(bounds, (size, size), (bend, bend), steepness, (float(frame.phi[0]),))

    def broken(self) -> str:
        """Which bounds are broken and by how much, in words; empty if none is."""
        bounds, scale = self.bounds, self.radius[1]
        words = []
        if self.radius[0] < bounds.least_radius - TOLERANCE * scale:
            text = _("the polar radius falls to {value} mm, the bound is {bound} mm")
            words.append(text.format(value=_mm(self.radius[0]), bound=_mm(bounds.least_radius)))
        if self.radius[1] > bounds.greatest_radius + TOLERANCE * scale:
            text = _("the polar radius grows to {value} mm, the bound is {bound} mm")
            words.append(text.format(value=_mm(self.radius[1]), bound=_mm(bounds.greatest_radius)))
        if self.curvature[1] > bounds.greatest_curvature + TOLERANCE / scale:
            text = _("the radius of curvature falls to {value} mm, the bound is {bound} mm")
            words.append(text.format(value=_mm(1.0 / self.curvature[1]), bound=_mm(bounds.least_bend)))
        if self.curvature[0] < bounds.least_curvature - TOLERANCE / scale:
            value = _mm(-1.0 / self.curvature[0])
            text = _("the path is hollow with a radius of {value} mm where it has to be convex")
            if not bounds.convex:
                text = _("the radius of the hollow falls to {value} mm, the bound is {bound} mm")
            words.append(text.format(value=value, bound=_mm(bounds.least_hollow)))
        if self.pressure_angle > bounds.pressure_angle + TOLERANCE:
            text = _("the pressure angle grows to {value:.5g} deg, the bound is {bound:.5g} deg")
            steep = math.degrees(self.pressure_angle), math.degrees(bounds.pressure_angle)
            words.append(text.format(value=steep[0], bound=steep[1]))
        return "; ".join(words)


def sizes(curve: ReturnCurve) -> Extremes:
    """Extremes of the polar radius [m] over an arc."""
    nodes = nodes_of((curve.ends.start, curve.ends.stop))
    return extremes(lambda phi: curve.radius(phi)[0], lambda phi: curve.radius(phi, 1)[1], nodes)


def bends(curve: ReturnCurve) -> Extremes:
    """Extremes of the curvature [1/m] over an arc."""
    nodes = nodes_of((curve.ends.start, curve.ends.stop))
    return extremes(
        lambda phi: frames(curve, phi).curvature, lambda phi: frames(curve, phi).curvature_slope, nodes
    )


def slants(curve: ReturnCurve) -> Extremes:
    """Extremes of the pressure angle [rad] over an arc."""

    def slope(phi: Array) -> Array:
        frame = frames(curve, phi)  # gamma' = 1 - K ds/dphi
        return np.asarray(1.0 - frame.curvature * frame.speed)

    nodes = nodes_of((curve.ends.start, curve.ends.stop))
    return extremes(lambda phi: frames(curve, phi).pressure_angle, slope, nodes)


def _mm(length: float) -> str:
    return f"{1e3 * length:.6g}"


def _curvature(rho: Array, moving: Array) -> tuple[Array, Array]:
    """Curvature (n) of a polar curve and its change (weights, n) with each weight."""
    value, slope, second = rho
    square = value**2 + slope**2
    above = value**2 + 2.0 * slope**2 - value * second
    bend = above / square**1.5
    changed = (
        (2.0 * value - second) * moving[:, 0] + 4.0 * slope * moving[:, 1] - value * moving[:, 2]
    ) / square**1.5
    return bend, changed - 3.0 * bend / square * (value * moving[:, 0] + slope * moving[:, 1])
