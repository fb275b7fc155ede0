"""A pair of involute wheels: angles, diameters, thicknesses, contact ratio, sliding; what is wrong with it.

Everything is SI, angles in radians. Shifts are those of the normal section, x m_n from the pitch circle, positive where
a tooth grows thicker on an external wheel; on an internal one a positive shift moves the teeth outwards. Formulas are
those of GOST 16532 (external) and GOST 19274 (internal); a rack is a wheel of endless radius.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np

from centrode.gears.involutes import Array
from centrode.gears.racks import (
    STANDARD_RACK,
    ReferenceRack,
    TransverseRack,
    least_shift,
    least_teeth,
    transverse_rack,
)
from centrode.geometry.involute import involute, pressure_angle_of

UNBOUNDED = 1e9
"""Specific sliding beyond which contact lies at the base circle to rounding."""

PairKind = Literal["external", "internal", "rack"]


@dataclass(frozen=True)
class PairGeometry:
    """Geometry of two wheels in mesh, the first the pinion.

    Attributes
    ----------
    kind : "external", "internal" (the second wheel has its teeth inside) or "rack"
    module : of the normal section [m]
    teeth, shifts : of both wheels; the teeth of a rack are infinite
    helix_angle : beta
    rack : the reference rack
    width : of the rim [m]; 0 where it is not given
    """

    kind: PairKind
    module: float
    teeth: tuple[float, float]
    shifts: tuple[float, float]
    helix_angle: float = 0.0
    rack: ReferenceRack = STANDARD_RACK
    width: float = 0.0

    @cached_property
    def transverse(self) -> TransverseRack:
        """The rack in the transverse section."""
        return transverse_rack(self.rack, self.module, self.helix_angle)

    @property
    def sign(self) -> int:
        """1 of an external pair and of a rack, -1 of an internal one."""
        return -1 if self.kind == "internal" else 1

    @cached_property
    def shift_sum(self) -> float:
        """x_1 + x_2; of an internal pair x_2 - x_1."""
        return self.shifts[1] + self.sign * self.shifts[0]

    @cached_property
    def teeth_sum(self) -> float:
        """z_1 + z_2; of an internal pair z_2 - z_1."""
        return self.teeth[1] + self.sign * self.teeth[0]

    @cached_property
    def working_involute(self) -> float:
        """inv(alpha_w) = inv(alpha_t) + 2 (x_1 + x_2) tan(alpha)/(z_1 + z_2); that of a rack is inv(alpha_t)."""
        addition = 2 * self.shift_sum * math.tan(self.rack.pressure_angle) / self.teeth_sum
        return involute(self.transverse.pressure_angle) + addition

    @cached_property
    def working_angle(self) -> float:
        """The working pressure angle alpha_w; NaN where the teeth cannot mesh without play."""
        if self.kind == "rack":
            return self.transverse.pressure_angle
        return pressure_angle_of(self.working_involute)

    @cached_property
    def pitch_distance(self) -> float:
        """The centre distance a = m_t (z_2 + z_1)/2 without shift [m]; infinite of a rack."""
        return self.transverse.module * self.teeth_sum / 2

    @cached_property
    def centre_distance(self) -> float:
        """The centre distance a_w = a cos(alpha_t)/cos(alpha_w) [m]; infinite of a rack."""
        if self.kind == "rack":
            return math.inf
        return self.pitch_distance * math.cos(self.transverse.pressure_angle) / math.cos(self.working_angle)

    @cached_property
    def distance_coefficient(self) -> float:
        """Y = (a_w - a)/m; of a rack the shift of its pitch line, x_1 + x_2."""
        if self.kind == "rack":
            return self.shift_sum
        return (self.centre_distance - self.pitch_distance) / self.module

    @cached_property
    def equalising_coefficient(self) -> float:
        """Delta y = x_1 + x_2 - y: so much lower are the tips, to keep the radial clearance."""
        return self.shift_sum - self.distance_coefficient

    @cached_property
    def ratio(self) -> float:
        """U = z_2/z_1."""
        return self.teeth[1] / self.teeth[0]

    @cached_property
    def base_pitch(self) -> float:
        """p_b = pi m_t cos(alpha_t) [m]."""
        return math.pi * self.transverse.module * math.cos(self.transverse.pressure_angle)

    @cached_property
    def tip_diameters(self) -> tuple[float, float]:
        """d_a of both wheels [m]; of an internal one as GOST 19274, with k_2 = 0.25 - 0.125 x_2 below x_2 = 2."""
        (teeth, other), (shift, other_shift) = self.teeth, self.shifts
        height, lowered = self.rack.addendum, self.equalising_coefficient
        module = self.transverse.module
        if self.kind == "internal":
            first = module * teeth + 2 * (height + shift) * self.module
            relief = 0.25 - 0.125 * other_shift if other_shift < 2 else 0.0
            second = module * other - 2 * (height - other_shift + lowered - relief) * self.module
            return first, second
        first = module * teeth + 2 * (height + shift - lowered) * self.module
        if self.kind == "rack":
            return first, math.nan
        return first, module * other + 2 * (height + other_shift - lowered) * self.module

    @cached_property
    def root_diameters(self) -> tuple[float, float]:
        """d_f of both wheels [m]; that of an internal wheel keeps the clearance from the pinion's tip."""
        (teeth, other), (shift, other_shift) = self.teeth, self.shifts
        depth, module = self.rack.addendum + self.rack.clearance, self.transverse.module
        first = module * teeth - 2 * (depth - shift) * self.module
        if self.kind == "rack":
            return first, math.nan
        if self.kind == "internal":
            return first, 2 * self.centre_distance + self.tip_diameters[
                0
            ] + 2 * self.rack.clearance * self.module
        return first, module * other - 2 * (depth - other_shift) * self.module

    @cached_property
    def action_ends(self) -> tuple[float, float]:
        """Where contact begins and ends on the line of action, as the radius of curvature of the pinion's flank [m].

        The second wheel's tip gives the beginning, the pinion's own tip the end.
        """
        base = self.wheels[0].base / 2
        end = _tangent_length(self.tip_diameters[0] / 2, base)
        line = self.line_length
        if self.kind == "rack":
            # The rack's tip line, `height` inside its pitch line through the pitch point.
            height = (self.rack.addendum - self.shifts[0]) * self.module
            pitch = self.transverse.module * self.teeth[0] / 2 * math.sin(self.working_angle)
            return pitch - height / math.sin(self.working_angle), end
        other = _tangent_length(self.tip_diameters[1] / 2, self.wheels[1].base / 2)
        return (line - other, end) if self.sign > 0 else (other - line, end)

    @cached_property
    def line_length(self) -> float:
        """a_w sin(alpha_w) [m]: between the points where the line of action touches the base circles."""
        if self.kind == "rack":
            return math.inf
        return self.centre_distance * math.sin(self.working_angle)

    @cached_property
    def pitch_curvature_radius(self) -> float:
        """Radius of curvature of the pinion's flank at the pitch point [m]."""
        return self.wheels[0].base / 2 * math.tan(self.working_angle)

    @cached_property
    def action_length(self) -> float:
        """Length of the active line of action g_alpha [m]."""
        begin, end = self.action_ends
        return end - begin

    @cached_property
    def contact_ratio(self) -> float:
        """epsilon_alpha, of the transverse section: active length of the line of action over the base pitch."""
        return self.action_length / self.base_pitch

    @cached_property
    def overlap_ratio(self) -> float:
        """epsilon_beta = b sin(beta)/(pi m); zero where the width is not given."""
        return self.width * math.sin(self.helix_angle) / (math.pi * self.module)

    def other_curvature_radius(self, radius: Array | float) -> Array:
        """Radius of curvature of the second wheel's flank [m] where the pinion's has a value; infinite of a rack."""
        return np.asarray(self.line_length - self.sign * np.asarray(radius, dtype=np.float64))

    def specific_sliding(self, radius: Array | float) -> tuple[Array, Array]:
        """Specific sliding of both flanks: 1 - v_2/v_1 and 1 - v_1/v_2, with v the speed of the contact along a flank.

        Parameters
        ----------
        radius : of curvature of the pinion's flank [m]: the place of the contact on the line of action
        """
        radius = np.asarray(radius, dtype=np.float64)
        with np.errstate(divide="ignore", invalid="ignore"):
            if self.kind == "rack":
                share = self.pitch_curvature_radius / radius
            else:
                share = self.other_curvature_radius(radius) / (self.ratio * radius)
            return 1 - share, 1 - 1 / share

    def pressure_coefficient(self, radius: Array | float) -> Array:
        """M (1/rho_1 + 1/rho_2): how much the curvature of the flanks raises the contact stress (its square)."""
        radius = np.asarray(radius, dtype=np.float64)
        with np.errstate(divide="ignore"):
            return np.asarray(self.module * (1 / radius + self.sign / self.other_curvature_radius(radius)))

    @cached_property
    def wheels(self) -> tuple[GearWheel, GearWheel]:
        """Both wheels."""
        return GearWheel(self, 0), GearWheel(self, 1)

    @cached_property
    def tips_clear(self) -> float:
        """By how much the tips of an internal pair pass each other [rad]; infinite where their circles do not cross.

        Where both tip circles cross, a tooth of the pinion leaves the gap of the wheel sideways. Its tip passes that of
        the wheel's tooth where this angle of the wheel is positive; otherwise the tips run into each other.
        """
        if self.kind != "internal":
            return math.inf
        own, other, distance = self.wheels[0].tip / 2, self.wheels[1].tip / 2, self.centre_distance
        if not abs(own - distance) < other < own + distance:
            return math.inf
        # Angles from the line of centres to the place where the tip circles cross, about both axes.
        about_pinion = math.acos((other**2 - own**2 - distance**2) / (2 * own * distance))
        about_wheel = math.acos((distance**2 + other**2 - own**2) / (2 * distance * other))
        working = involute(self.working_angle)
        first = about_pinion + involute(math.acos(min(self.wheels[0].base / 2 / own, 1.0))) - working
        second = about_wheel + involute(math.acos(min(self.wheels[1].base / 2 / other, 1.0))) - working
        return first / self.ratio - second


@dataclass(frozen=True)
class GearWheel:
    """One wheel of a pair; lengths of a rack that a circle would have are NaN.

    Attributes
    ----------
    pair : PairGeometry
    number : 0 of the pinion, 1 of the other one
    """

    pair: PairGeometry
    number: int

    @property
    def teeth(self) -> float:
        """Z; infinite of a rack."""
        return self.pair.teeth[self.number]

    @property
    def shift(self) -> float:
        """X, of the normal section."""
        return self.pair.shifts[self.number]

    @property
    def internal(self) -> bool:
        """Whether its teeth point inwards."""
        return self.number == 1 and self.pair.kind == "internal"

    @property
    def is_rack(self) -> bool:
        """Whether it is a rack."""
        return not math.isfinite(self.teeth)

    @property
    def is_generated(self) -> bool:
        """Whether the reference rack generates it: an external wheel."""
        return not self.internal and not self.is_rack

    @property
    def outwards(self) -> int:
        """1 where the teeth grow thinner outwards; -1 of an internal wheel."""
        return -1 if self.internal else 1

    @cached_property
    def pitch(self) -> float:
        """Diameter d = m_t z [m]."""
        return math.nan if self.is_rack else self.pair.transverse.module * self.teeth

    @cached_property
    def base(self) -> float:
        """Diameter d_b = d cos(alpha_t) [m]."""
        return self.pitch * math.cos(self.pair.transverse.pressure_angle)

    @cached_property
    def working_pitch(self) -> float:
        """Diameter d_w [m]."""
        return self.base / math.cos(self.pair.working_angle)

    @cached_property
    def tip(self) -> float:
        """Diameter d_a [m]."""
        return self.pair.tip_diameters[self.number]

    @cached_property
    def root(self) -> float:
        """Diameter d_f [m]."""
        return self.pair.root_diameters[self.number]

    @cached_property
    def addendum(self) -> float:
        """Height of a tooth over the pitch circle [m]."""
        if self.is_rack:
            return self.pair.rack.addendum * self.pair.module
        return self.outwards * (self.tip - self.pitch) / 2

    @cached_property
    def dedendum(self) -> float:
        """Depth of a gap below the pitch circle [m]; of a rack below its pitch line shifted by x."""
        if self.is_rack:
            return self.pair.transverse.dedendum
        return self.outwards * (self.pitch - self.root) / 2

    @cached_property
    def radial_clearance(self) -> float:
        """Between its tip and the root of the other wheel [m]."""
        other = self.pair.wheels[1 - self.number]
        if self.pair.kind == "internal":
            inner, outer = (self.tip, other.root) if self.number == 0 else (other.root, self.tip)
            return (outer - inner) / 2 - self.pair.centre_distance
        if self.pair.kind == "external":
            return self.pair.centre_distance - (self.tip + other.root) / 2
        # The pitch line of the rack lies x m outside the pinion's pitch circle.
        line = self.pair.wheels[0].pitch / 2 + self.pair.shifts[0] * self.pair.module
        if self.number == 0:
            return line + self.pair.transverse.dedendum - self.tip / 2
        return line - self.addendum - other.root / 2

    @cached_property
    def pitch_thickness(self) -> float:
        """Thickness of a tooth on the pitch circle [m], along it in the transverse section."""
        slope = 2 * self.shift * math.tan(self.pair.rack.pressure_angle)
        return (math.pi / 2 + self.outwards * slope) * self.pair.transverse.module

    @cached_property
    def tip_thickness(self) -> float:
        """Thickness of a tooth on the tip circle [m]."""
        if self.is_rack:
            return self.pitch_thickness - 2 * self.addendum * math.tan(self.pair.transverse.pressure_angle)
        return self.thickness(self.tip)

    @cached_property
    def half_base_angle(self) -> float:
        """Half of the angle [rad] that a tooth subtends at the base circle, involutes prolonged to it."""
        return self.pitch_thickness / self.pitch + self.outwards * involute(
            self.pair.transverse.pressure_angle
        )

    def thickness(self, diameter: float) -> float:
        """Thickness of a tooth on a circle [m], along it in the transverse section; NaN inside the base circle."""
        if not self.base <= diameter:
            return math.nan
        angle = involute(math.acos(self.base / diameter))
        return diameter * (self.half_base_angle - self.outwards * angle)

    def chordal_thickness(self, diameter: float) -> tuple[float, float]:
        """Chord of a tooth on a circle, and its distance from the tip [m]; NaN inside the base circle."""
        half = self.thickness(diameter) / diameter
        height = self.outwards * (self.tip / 2 - diameter / 2 * math.cos(half))
        return diameter * math.sin(half), height

    @cached_property
    def least_shift(self) -> float:
        """X_min, below which the rack undercuts; NaN where no rack generates the wheel."""
        if not self.is_generated:
            return math.nan
        return least_shift(self.pair.rack, self.teeth, self.pair.helix_angle)

    @cached_property
    def least_teeth(self) -> float:
        """Z_min, below which the rack undercuts a wheel of this shift; NaN where no rack generates the wheel."""
        if not self.is_generated:
            return math.nan
        return least_teeth(self.pair.rack, self.shift, self.pair.helix_angle)

    @property
    def undercut(self) -> bool:
        """Whether the rack cuts into the involute."""
        return self.is_generated and self.shift < self.least_shift

    @cached_property
    def active_end(self) -> float:
        """Where its active flank ends towards the root, as the radius of curvature of the pinion's flank [m]."""
        return self.pair.action_ends[self.number]

    @cached_property
    def active_pressure(self) -> float:
        """Pressure angle alpha_p at that end; NaN of a rack."""
        if self.is_rack:
            return math.nan
        own = self.active_end
        if self.number == 1:
            own = float(self.pair.other_curvature_radius(own))
        return math.atan(2 * own / self.base)

    @cached_property
    def flank_pressure(self) -> float:
        """Pressure angle alpha_l where the fillet of the rack begins; NaN where no rack generates the wheel.

        The straight flank of a usual rack ends (h_a* - x) m_n below the pitch circle (GOST 16532).
        """
        if not self.is_generated:
            return math.nan
        angle = self.pair.transverse.pressure_angle
        depth = (self.pair.rack.straight - self.shift) * self.pair.module
        return math.atan(math.tan(angle) - 4 * depth / (self.pitch * math.sin(2 * angle)))

    @property
    def interferes(self) -> bool:
        """Whether the other wheel's tip reaches below the involute into the fillet."""
        return self.is_generated and not math.tan(self.active_pressure) >= math.tan(self.flank_pressure)

    @property
    def tip_inside_base(self) -> bool:
        """Whether its tips end inside the base circle, where there is no involute."""
        return not self.is_rack and self.tip < self.base

    @cached_property
    def sliding(self) -> float:
        """Specific sliding at the end of the active flank, the greatest of the wheel; infinite at the base circle."""
        return float(self.pair.specific_sliding(self.active_end)[self.number])

    @property
    def sliding_is_unbounded(self) -> bool:
        """Whether contact reaches the base circle, where specific sliding is infinite, or goes beyond."""
        # Beyond the base circle it returns from infinity with the other sign.
        return abs(self.sliding) > UNBOUNDED or self.sliding > 1e-12


def _tangent_length(radius: float, base: float) -> float:
    """Length of a tangent of the base circle to a circle; NaN where that lies inside."""
    return math.sqrt(radius * radius - base * base) if radius >= base else math.nan
