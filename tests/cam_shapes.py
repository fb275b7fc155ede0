"""Paths of rollers with closed forms, and the paper's, for tests of profiles and wheels."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
from numpy.typing import NDArray

import centrode as ct
from centrode.cams.curvature_laws import ExponentialCurvature
from centrode.cams.path_series import expanded_path
from centrode.cams.roller_path import SymmetricPath
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.jets import Jet, JetFunctions

Array = NDArray[np.float64]
EPS = float(np.finfo(float).eps)
JETS = JetFunctions(ARRAYS)

WHEEL = """
title = "Wheel"
kind = "cam"
display = { length = "mm", angle = "deg" }
[curvature]
law = "exponential"
k0 = "0.01 1/mm"
k1 = 0.75
symmetric = true
[start]
radius = "50 mm"
[range]
to = "90 deg"
[roller]
radius = "15 mm"
[mover]
legs = 4
post = "120 mm"
"""


class Limacon:
    """rho = a + b cos(n phi): closed, hollow where b n^2 is great."""

    def __init__(self, a: float, b: float, n: int = 1) -> None:
        self.a, self.b, self.n = a, b, n

    def radius(self, phi: Array, order: int = 0) -> Array:
        angle = Jet.variable(np.asarray(phi, dtype=float), order) * float(self.n)
        found = JETS.cos(angle) * self.b + self.a
        return np.array([c * math.factorial(k) + 0.0 * angle.value for k, c in enumerate(found.coefficients)])


@cache
def paper_path(k1: float = 0.75) -> SymmetricPath:
    """The paper's path on both sides."""
    half = expanded_path(ExponentialCurvature(10.0, k1), rho0=0.05, gamma0=0.0, start=0.0, stop=math.pi / 2)
    return SymmetricPath(half)


def exchanged(*pairs: tuple[str, str], more: str = "") -> ct.Cam:
    """The wheel with texts exchanged and tables added."""
    text = WHEEL
    for old, new in pairs:
        assert old in text, old
        text = text.replace(old, new)
    return ct.parse_cam(text + more)


def three_point_curvature(places: Array) -> Array:
    """Curvature of the circles through each three neighbouring points, positive to the right of the way."""
    a, b, c = places[:-2], places[1:-1], places[2:]
    u, v = b - a, c - b
    cross = v[:, 0] * u[:, 1] - v[:, 1] * u[:, 0]
    lengths = np.hypot(*u.T) * np.hypot(*v.T) * np.hypot(*(c - a).T)
    return np.asarray(2.0 * cross / lengths)
