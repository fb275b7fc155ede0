"""The involute of a circle: its polar angle as a function of the pressure angle, and back."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_SMALL = 0.05
"""Pressure angle [rad] below which tan(a) - a is summed as a series: the difference would lose digits."""
_STEPS = 60


def involute(pressure_angle: float) -> float:
    """The involute function inv(alpha) = tan(alpha) - alpha [rad].

    Accurate to some units in the last place for every angle: below 0.05 rad by its series, as the difference of two
    nearly equal numbers loses digits there.
    """
    if abs(pressure_angle) < _SMALL:
        square = pressure_angle * pressure_angle
        series = 1 / 3 + square * (
            2 / 15 + square * (17 / 315 + square * (62 / 2835 + square * (1382 / 155925)))
        )
        return float(pressure_angle * square * series)
    tangent: float = math.tan(pressure_angle)
    return tangent - pressure_angle


def pressure_angle_of(value: float) -> float:
    """The pressure angle [rad], 0 to pi/2, whose involute function has a value; NaN for a negative one.

    Newton's method from above: the function is convex there, so that no step goes beyond the root.
    """
    if not value >= 0:
        return math.nan
    if value == 0:
        return 0.0
    # inv(a) >= a^3/3 gives an upper end for small values; tan(a) <= value + pi/2 one for great values.
    angle: float = min((3 * value) ** (1 / 3), math.atan(value + math.pi / 2))
    for _step in range(_STEPS):
        tangent = math.tan(angle)
        nearer = angle - (involute(angle) - value) / (tangent * tangent)
        if nearer == angle or abs(nearer - angle) <= 2e-16 * angle:
            break
        angle = nearer
    return angle


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
