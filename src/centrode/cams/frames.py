"""The frame that goes along the path of a roller's centre: place, normal, curvature, from the polar radius alone."""

from __future__ import annotations

from dataclasses import dataclass
from math import factorial
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from centrode.algebra.arrays import ARRAYS
from centrode.algebra.jet_functions import JetFunctions
from centrode.algebra.jets import Jet

Array = NDArray[np.float64]
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
        slope, value = rho.slope(), rho.lowered()
        gamma = JETS.atan2(slope, value)
        speed = JETS.sqrt(slope * slope + value * value)
        turning = -gamma.slope() + 1.0
        curvature = turning / speed.lowered()
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
