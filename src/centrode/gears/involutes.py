"""Flanks of teeth: involutes of a circle with their slopes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def involute_curve(
    base_radius: float, rolls: Array, half_angle: float, sense: int = 1
) -> tuple[Array, Array]:
    """Places and slopes (n, 2) of the right flank of a tooth whose middle lies on the y axis [m, m/rad].

    Parameters
    ----------
    base_radius : of the base circle [m]
    rolls : (n) tan(alpha) at the places, at least zero: by so much the generating line has rolled [rad]; slopes are
        derivatives by it
    half_angle : half of the angle [rad] that the tooth subtends at the base circle
    sense : 1 where it grows thinner outwards, by inv(alpha); -1 of a tooth that points inwards
    """
    squares = 1 + rolls * rolls
    radii = base_radius * np.sqrt(squares)
    angles = half_angle - sense * (rolls - np.arctan(rolls))
    grows, turns = base_radius * rolls / np.sqrt(squares), -sense * rolls * rolls / squares
    sine, cosine = np.sin(angles), np.cos(angles)
    places = np.stack([radii * sine, radii * cosine], axis=-1)
    slopes = np.stack([grows * sine + radii * turns * cosine, grows * cosine - radii * turns * sine], axis=-1)
    return places, slopes
