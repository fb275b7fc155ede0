"""What a maker measures of a wheel: span over teeth, dimension over pins, chordal thickness of a tooth.

Formulas of GOST 16532 and GOST 19274; all lengths in metres.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from centrode.gears.pair_geometry import GearWheel
from centrode.geometry.involute import involute, pressure_angle_of

PIN = 1.7
"""Diameter of a pin in modules where none is chosen: it touches the flanks near the middle of a tooth's height."""


@dataclass(frozen=True)
class WheelMeasurements:
    """Dimensions of one wheel that can be measured [m].

    Attributes
    ----------
    span_teeth : k, number of teeth between the jaws, of an internal wheel of gaps; 0 where no number has jaws on the
        involute
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


def wheel_measurements(wheel: GearWheel, pin: float = 0.0) -> WheelMeasurements:
    """Dimensions of a wheel that can be measured; a pin of 1.7 modules where `pin` [m] is zero."""
    pin = pin or PIN * wheel.pair.module
    teeth, span = span_over_teeth(wheel)
    alpha, module = wheel.pair.rack.pressure_angle, wheel.pair.module
    thickness = math.pi / 2 * math.cos(alpha) ** 2 + wheel.outwards * wheel.shift * math.sin(2 * alpha)
    chord = thickness * module
    height = wheel.addendum - chord * math.tan(alpha) / 2
    return WheelMeasurements(teeth, span, pin, dimension_over_pins(wheel, pin), chord, height)


def base_helix_angle(wheel: GearWheel) -> float:
    """Helix angle on the base cylinder [rad]: sin(beta_b) = sin(beta) cos(alpha)."""
    return math.asin(math.sin(wheel.pair.helix_angle) * math.cos(wheel.pair.rack.pressure_angle))


def base_tangent_length(wheel: GearWheel, teeth: int) -> float:
    """W = m cos(alpha) (pi (k - 1/2) + 2 x tan(alpha) + z inv(alpha_t)) [m], whether or not jaws reach the flanks.

    Over k teeth of an external wheel, over k gaps of an internal one, whose gaps are the teeth of an external wheel of
    the same shift.
    """
    pair = wheel.pair
    alpha, angle = pair.rack.pressure_angle, pair.transverse.pressure_angle
    arcs = math.pi * (teeth - 0.5) + 2 * wheel.shift * math.tan(alpha) + wheel.teeth * involute(angle)
    return pair.module * math.cos(alpha) * arcs


def span_over_teeth(wheel: GearWheel) -> tuple[int, float]:
    """K and the base tangent length W [m] over k teeth, of an internal wheel over k gaps.

    The jaws are to touch near the middle of the flanks, on the circle of d + 2 x m; k is the nearest whole number whose
    jaws touch the involute between the fillet and the tip. (0, NaN) where there is none, and of racks and internal
    wheels with helical teeth, which cannot be measured so.
    """
    if wheel.is_rack or (wheel.internal and wheel.pair.helix_angle):
        return 0, math.nan
    middle = wheel.pitch + 2 * wheel.shift * wheel.pair.module
    if middle <= wheel.base:
        return 0, math.nan
    helix, width = base_helix_angle(wheel), wheel.pair.width
    wanted = math.sqrt(middle * middle - wheel.base * wheel.base) / 2
    least, most = _flank_lengths(wheel)

    def touching(teeth: int) -> float:
        """Radius of curvature [m] at the jaws: the span lies in the base plane, inclined by the base helix angle."""
        return base_tangent_length(wheel, teeth) * math.cos(helix) / 2

    for teeth in sorted(range(1, int(wheel.teeth)), key=lambda k: abs(touching(k) - wanted)):
        span = base_tangent_length(wheel, teeth)
        if least <= touching(teeth) <= most and (not width or span * math.sin(helix) < width):
            return teeth, span
    return 0, math.nan


def _flank_lengths(wheel: GearWheel) -> tuple[float, float]:
    """Radii of curvature of a flank [m] where it begins at the fillet, and at the tip, smaller first."""
    tip = math.sqrt(max(wheel.tip**2 - wheel.base**2, 0.0)) / 2
    if wheel.internal:
        return tip, math.sqrt(max(wheel.root**2 - wheel.base**2, 0.0)) / 2
    return max(wheel.base / 2 * math.tan(wheel.flank_pressure), 0.0), tip


def dimension_over_pins(wheel: GearWheel, pin: float) -> float:
    """M over (of an internal wheel between) two pins of a diameter [m]; NaN where they do not touch the involutes.

    inv(alpha_D) = inv(alpha_t) + D/(z m cos(alpha)) - (pi/2 - 2 x tan(alpha))/z on an external wheel. On an internal
    one the signs of D and of the half gap are the opposite; the centres of the pins lie at r_b/cos(alpha_D).
    """
    if wheel.is_rack:
        return math.nan
    pair, teeth, side = wheel.pair, wheel.teeth, wheel.outwards
    alpha, angle = pair.rack.pressure_angle, pair.transverse.pressure_angle
    gap = (math.pi / 2 - side * 2 * wheel.shift * math.tan(alpha)) / teeth
    value = involute(angle) + side * (pin / (teeth * pair.module * math.cos(alpha)) - gap)
    at = pressure_angle_of(value)
    if math.isnan(at):
        return math.nan
    diameter = wheel.base / math.cos(at)
    touching = wheel.base / 2 * math.tan(at) - side * pin / 2 * math.cos(base_helix_angle(wheel))
    least, most = _flank_lengths(wheel)
    if not least <= touching <= most:
        return math.nan
    between = diameter if teeth % 2 == 0 else diameter * math.cos(math.pi / (2 * teeth))
    return between + side * pin
