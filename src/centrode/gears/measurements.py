"""What a maker measures of a wheel: span over teeth, dimension over pins, chordal thickness of a tooth.

Formulas of GOST 16532 and GOST 19274; all lengths in metres.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from centrode.gears.involutes import involute, pressure_angle_of
from centrode.gears.pair_geometry import PairGeometry

PIN = 1.7
"""Diameter of a pin in modules where none is chosen: it touches the flanks near the middle of a tooth's height."""


@dataclass(frozen=True)
class WheelMeasurements:
    """Dimensions of one wheel that can be measured [m].

    Attributes
    ----------
    span_teeth : k, number of teeth between the jaws; 0 where no number of teeth has jaws on the involute
    span : W, over k teeth, in the normal section; NaN where there is none
    pin : D, diameter of the pin or ball
    over_pins : M, over two pins in opposite gaps (of an internal wheel between them); NaN where they do not touch
    constant_chord : s_c, chordal thickness where the straight flank of the rack touches
    constant_chord_height : h_c, its distance from the tip
    """

    span_teeth: int
    span: float
    pin: float
    over_pins: float
    constant_chord: float
    constant_chord_height: float


def measurements(pair: PairGeometry, number: int, pin: float = 0.0) -> WheelMeasurements:
    """Dimensions of a wheel, 0 or 1, that can be measured; a pin of 1.7 modules where `pin` [m] is zero."""
    pin = pin or PIN * pair.module
    internal = number == 1 and pair.kind == "internal"
    teeth, span = span_over_teeth(pair, number)
    alpha, shift = pair.rack.pressure_angle, pair.shifts[number]
    side = -1 if internal else 1
    chord = (math.pi / 2 * math.cos(alpha) ** 2 + side * shift * math.sin(2 * alpha)) * pair.module
    height = pair.wheels[number].addendum - chord * math.tan(alpha) / 2
    return WheelMeasurements(teeth, span, pin, dimension_over_pins(pair, number, pin), chord, height)


def span_over_teeth(pair: PairGeometry, number: int) -> tuple[int, float]:
    """K and the base tangent length W = m cos(alpha) (pi (k - 1/2) + 2 x tan(alpha) + z inv(alpha_t)) of a wheel.

    The jaws are to touch near the middle of the flanks, on the circle of d + 2 x m; k is the nearest whole number whose
    jaws touch the involute between the fillet and the tip. (0, NaN) where there is none, and of racks and internal
    wheels with helical teeth, which cannot be measured so.
    """
    wheel = pair.wheels[number]
    if not math.isfinite(wheel.teeth) or (wheel.internal and pair.helix_angle):
        return 0, math.nan
    alpha, angle = pair.rack.pressure_angle, pair.transverse.pressure_angle
    side = -1 if wheel.internal else 1
    # (inv(alpha_t) z + pi (k - 1/2) + 2 x tan(alpha)) r_b/z: half of W as an arc of the base circle.
    base_helix = math.asin(math.sin(pair.helix_angle) * math.cos(alpha))
    middle = wheel.pitch + 2 * shift_outwards(pair, number)
    if middle <= wheel.base:
        return 0, math.nan
    half = math.sqrt(middle * middle - wheel.base * wheel.base) / 2
    wanted = (
        half * 2 / (pair.base_pitch)
        + 0.5
        - side * (2 * wheel.shift * math.tan(alpha) + side * wheel.teeth * involute(angle)) / math.pi
    )
    least, most = _flank_lengths(pair, number)
    for teeth in sorted(range(1, max(2, int(wheel.teeth))), key=lambda k: abs(k - wanted)):
        span = (
            pair.module
            * math.cos(alpha)
            * (
                math.pi * (teeth - 0.5)
                + side * 2 * wheel.shift * math.tan(alpha)
                + wheel.teeth * involute(angle)
            )
        )
        # The line of the span lies in the base plane, inclined by the base helix angle: W cos(beta_b) in the section.
        touching = span * math.cos(base_helix) / 2
        if least <= touching <= most and (not pair.width or span * math.sin(base_helix) < pair.width):
            return teeth, span
    return 0, math.nan


def shift_outwards(pair: PairGeometry, number: int) -> float:
    """X m [m]: how far the middle of the teeth lies outside the pitch circle."""
    return pair.shifts[number] * pair.module


def _flank_lengths(pair: PairGeometry, number: int) -> tuple[float, float]:
    """Radii of curvature of a flank [m] where it begins at the fillet, and at the tip, smaller first."""
    wheel = pair.wheels[number]
    tip = math.sqrt(max(wheel.tip**2 - wheel.base**2, 0.0)) / 2
    if wheel.internal:
        return tip, math.sqrt(max(wheel.root**2 - wheel.base**2, 0.0)) / 2
    return max(wheel.base / 2 * math.tan(wheel.flank_pressure), 0.0), tip


def dimension_over_pins(pair: PairGeometry, number: int, pin: float) -> float:
    """M over (of an internal wheel between) two pins of a diameter [m]; NaN where they do not touch the involutes.

    inv(alpha_D) = inv(alpha_t) + D/(z m cos(alpha)) - (pi/2 - 2 x tan(alpha))/z on an external wheel. On an internal
    one the signs of D and of the half gap are the opposite; the centres of the pins lie at r_b/cos(alpha_D).
    """
    wheel = pair.wheels[number]
    if not math.isfinite(wheel.teeth):
        return math.nan
    alpha, angle, teeth = pair.rack.pressure_angle, pair.transverse.pressure_angle, wheel.teeth
    side = -1 if wheel.internal else 1
    gap = (math.pi / 2 - side * 2 * wheel.shift * math.tan(alpha)) / teeth
    value = involute(angle) + side * (pin / (teeth * pair.module * math.cos(alpha)) - gap)
    at = pressure_angle_of(value)
    if math.isnan(at):
        return math.nan
    diameter = wheel.base / math.cos(at)
    touching = wheel.base / 2 * math.tan(at) - side * pin / 2 * math.cos(
        math.asin(math.sin(pair.helix_angle) * math.cos(alpha))
    )
    least, most = _flank_lengths(pair, number)
    if not least <= touching <= most:
        return math.nan
    between = diameter if teeth % 2 == 0 else diameter * math.cos(math.pi / (2 * teeth))
    return between + side * pin
