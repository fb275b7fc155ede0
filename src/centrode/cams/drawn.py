"""The curvature of a curve as it is drawn: of the circles through three neighbouring places."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def drawn_curvature(phi: Array, radius: Array) -> Array:
    """Curvature (n) [1/m] of the circle through each place (phi, rho) and the two beside it; NaN at the ends.

    It knows nothing of the equations that gave rho. It differs from the curvature of the path in the order of the
    distances squared where these are equal, else in their first order; rounding is divided by the distance squared.
    """
    found = np.full(len(phi), np.nan)
    if len(phi) < 3:
        return found
    x, y = radius * np.sin(phi), radius * np.cos(phi)
    ahead, behind = (x[2:] - x[1:-1], y[2:] - y[1:-1]), (x[1:-1] - x[:-2], y[1:-1] - y[:-2])
    across = np.hypot(x[2:] - x[:-2], y[2:] - y[:-2])
    turned = behind[1] * ahead[0] - behind[0] * ahead[1]  # positive clockwise, as phi is
    with np.errstate(all="ignore"):
        found[1:-1] = 2.0 * turned / (np.hypot(*ahead) * np.hypot(*behind) * across)
    return found
