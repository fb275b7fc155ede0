"""The involute of a circle: its polar angle as a function of the pressure angle, and back."""

from __future__ import annotations

import math

SMALL = 0.05
"""Pressure angle [rad] below which tan(a) - a is summed as a series: the difference would lose digits."""
STEPS = 60


def involute(pressure_angle: float) -> float:
    """The involute function inv(alpha) = tan(alpha) - alpha [rad].

    Accurate to some units in the last place for every angle: below 0.05 rad by its series, as the difference of two
    nearly equal numbers loses digits there.
    """
    if abs(pressure_angle) < SMALL:
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
    for _step in range(STEPS):
        tangent = math.tan(angle)
        nearer = angle - (involute(angle) - value) / (tangent * tangent)
        if nearer == angle or abs(nearer - angle) <= 2e-16 * angle:
            break
        angle = nearer
    return angle
