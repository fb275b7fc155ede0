"""A path of constant curvature in closed form, which tests of cams compare with."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from centrode.cams.curvature_laws import ConstantCurvature, CurvatureLaw
from centrode.cams.roller_path import Array, StatePath


@dataclass(frozen=True)
class CirclePath(StatePath):
    """The path of constant curvature in closed form: a circle of radius 1/k0 whose centre lies off the cam's.

    Parameters
    ----------
    rho0 : float [m]
        Radius at phi = 0.
    gamma0 : float [rad]
        Pressure angle there.
    k0 : float [1/m]
    """

    rho0: float
    gamma0: float
    k0: float
    start: float = -math.pi
    stop: float = math.pi
    stall: float | None = None
    law: CurvatureLaw = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "law", ConstantCurvature(self.k0))

    @property
    def centre(self) -> tuple[float, float]:
        """Centre of the circle (x, y) [m]."""
        return math.sin(self.gamma0) / self.k0, self.rho0 - math.cos(self.gamma0) / self.k0

    def state(self, phi: Array) -> tuple[Array, Array, Array]:
        x, y = self.centre
        along = x * np.sin(phi) + y * np.cos(phi)
        across = x * np.cos(phi) - y * np.sin(phi)
        with np.errstate(invalid="ignore"):
            root = np.sqrt(1.0 / self.k0**2 - across**2)
        return along + root, self.k0 * across, self.k0 * root
