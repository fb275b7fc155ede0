"""Flanks of teeth: involutes of a circle with their slopes; the involute function and its inverse over arrays."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from centrode.geometry.involute import SMALL, STEPS

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


def involutes(pressure_angles: Array) -> Array:
    """`involute` of angles (...) [rad], as accurate."""
    squares = pressure_angles * pressure_angles
    series = 1 / 3 + squares * (
        2 / 15 + squares * (17 / 315 + squares * (62 / 2835 + squares * (1382 / 155925)))
    )
    return np.where(
        np.abs(pressure_angles) < SMALL,
        pressure_angles * squares * series,
        np.tan(pressure_angles) - pressure_angles,
    )


def pressure_angles_of(values: Array) -> Array:
    """`pressure_angle_of` of values (...), within two units in the last place of it; NaN for negative ones."""
    known = values > 0
    sought = np.where(known, values, 1.0)
    angles = np.minimum(np.cbrt(3 * sought), np.arctan(sought + math.pi / 2))
    for _step in range(STEPS):
        tangents = np.tan(angles)
        nearer = angles - (involutes(angles) - sought) / (tangents * tangents)
        # Newton's method doubles the digits: the step after one of 1e-9 is the last that changes anything.
        last = bool((np.abs(nearer - angles) <= 1e-9 * angles).all())
        angles = nearer
        if last:
            break
    return np.where(known, angles, np.where(values == 0, 0.0, math.nan))
