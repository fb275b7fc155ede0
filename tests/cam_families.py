"""Designs of cams for tests of choices, and the paths that they stand for."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from centrode.cams.contact_stress import ContactMaterial, LineContact, contact_strip
from centrode.cams.curvature_laws import ExponentialCurvature
from centrode.cams.parameter_choice.problem import Family, Mesh, PathTrial
from centrode.cams.path_series import ExpandedPath, expanded_path

Array = NDArray[np.float64]

STEEL = ContactMaterial(2.06e11, 0.3)
CONTACT = LineContact(3000.0, 0.03, 0.015, STEEL, STEEL)
END = math.pi / 4


def family(end: float = END, contact: LineContact | None = CONTACT) -> Family:
    """Exponential laws from a radius of their own: k0, k1, rho0."""
    return Family(
        names=("k0", "k1", "radius"),
        low=np.array([5.0, -1.0, 0.03]),
        high=np.array([40.0, 2.0, 0.09]),
        trial=lambda p: PathTrial(lambda phi: p[0] * np.exp(p[1] * phi), float(p[2]), 0.0, 0.015),
        mesh=Mesh((0.0, end), mirrored=True),
        contact=contact,
    )


def path_of(parameters: Array, end: float = END) -> ExpandedPath:
    k0, k1, radius = (float(p) for p in parameters)
    return expanded_path(ExponentialCurvature(k0, k1), radius, 0.0, 0.0, end)


def _integral(function: Callable[[Array], Array], end: float) -> float:
    nodes, weights = np.polynomial.legendre.leggauss(40)
    return float(0.5 * end * weights @ function(0.5 * end * (nodes + 1.0)))


def measured(parameters: Array, end: float = END, angles: int = 301) -> dict[str, float]:
    """Measures of a design along the path itself; infinite where it stalls or is undercut."""
    path = path_of(parameters, end)
    if path.stop < end:
        return dict.fromkeys(("stress", "pressure_angle", "size"), math.inf) | {
            "lift": -math.inf,
            "gap": -math.inf,
            "step": -math.inf,
        }
    phi = np.linspace(0.0, end, angles)
    rho, slope = path.radius(phi, 1)
    gamma, curvature = path.pressure_angle(phi), path.curvature(phi)[0]
    stress = contact_strip(CONTACT, gamma, curvature).pressure
    return {
        "stress": float(np.max(np.where(np.isfinite(stress), stress, np.inf))),
        "pressure_angle": float(np.max(np.abs(gamma))),
        "size": float(np.max(rho)),
        "lift": float(rho[-1] - rho[0]),
        "gap": float(2 * slope[-1] * math.cos(end)),
        # 2 (rho_0 end + integral of rho' sin), by Gauss's rule
        "step": float(2 * (rho[0] * end + _integral(lambda at: path.radius(at, 1)[1] * np.sin(at), end))),
    }
