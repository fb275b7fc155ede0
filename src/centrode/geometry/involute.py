"""The involute of a circle: its polar angle as a function of the pressure angle, and back."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

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


def involutes(pressure_angles: NDArray[np.float64]) -> NDArray[np.float64]:
    """`involute` of angles (...) [rad], as accurate."""
    squares = pressure_angles * pressure_angles
    series = 1 / 3 + squares * (
        2 / 15 + squares * (17 / 315 + squares * (62 / 2835 + squares * (1382 / 155925)))
    )
    return np.where(
        np.abs(pressure_angles) < _SMALL,
        pressure_angles * squares * series,
        np.tan(pressure_angles) - pressure_angles,
    )


def pressure_angles_of(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """`pressure_angle_of` of values (...), within two units in the last place of it; NaN for negative ones."""
    known = values > 0
    sought = np.where(known, values, 1.0)
    angles = np.minimum(np.cbrt(3 * sought), np.arctan(sought + math.pi / 2))
    for _step in range(_STEPS):
        tangents = np.tan(angles)
        nearer = angles - (involutes(angles) - sought) / (tangents * tangents)
        # Newton's method doubles the digits: the step after one of 1e-9 is the last that changes anything.
        last = bool((np.abs(nearer - angles) <= 1e-9 * angles).all())
        angles = nearer
        if last:
            break
    return np.where(known, angles, np.where(values == 0, 0.0, math.nan))
