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

from centrode.gears.involutes import Array, involute, pressure_angle_of
from centrode.gears.racks import STANDARD_RACK, ReferenceRack, TransverseRack, least_shift, transverse_rack

PairKind = Literal["external", "internal", "rack"]


@dataclass(frozen=True)
class GearWheel:
    """One wheel of a pair.

    Attributes
    ----------
    teeth : z; infinite of a rack
    shift : x
    internal : whether its teeth point inwards
    pitch, base, working_pitch, tip, root : diameters d, d_b, d_w, d_a, d_f [m]; NaN of a rack
    addendum, dedendum : heights over and below the pitch circle (of a rack: below its pitch line shifted by x) [m]
    pitch_thickness, tip_thickness : of the tooth, along the circle in the transverse section [m]
    least_shift : without undercut by the rack
    active_pressure : pressure angle alpha_p at the end of the active flank
    flank_pressure : pressure angle alpha_l where the fillet of the rack begins; NaN where no rack generates the wheel
    sliding : specific sliding at the end of the active flank, the greatest of the wheel
    """

    teeth: float
    shift: float
    internal: bool
    pitch: float
    base: float
    working_pitch: float
    tip: float
    root: float
    addendum: float
    dedendum: float
    pitch_thickness: float
    tip_thickness: float
    least_shift: float
    active_pressure: float
    flank_pressure: float
    sliding: float

    @property
    def undercut(self) -> bool:
        """Whether the rack cuts into the involute."""
        return not self.internal and math.isfinite(self.teeth) and self.shift < self.least_shift

    @property
    def interferes(self) -> bool:
        """Whether the other wheel's tip reaches below the involute into the fillet."""
        if self.internal or not math.isfinite(self.teeth):
            return False
        return not math.tan(self.active_pressure) >= math.tan(self.flank_pressure)


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
        base = self.wheel_base(0) / 2
        end = _tangent_length(self.tip_diameters[0] / 2, base)
        line = self.line_length
        if self.kind == "rack":
            # The rack's tip line, `height` inside its pitch line through the pitch point.
            height = (self.rack.addendum - self.shifts[0]) * self.module
            pitch = self.transverse.module * self.teeth[0] / 2 * math.sin(self.working_angle)
            return pitch - height / math.sin(self.working_angle), end
        other = _tangent_length(self.tip_diameters[1] / 2, self.wheel_base(1) / 2)
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
        return self.wheel_base(0) / 2 * math.tan(self.working_angle)

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

    def wheel_base(self, number: int) -> float:
        """Diameter of the base circle of a wheel [m]."""
        angle = self.transverse.pressure_angle
        return self.transverse.module * self.teeth[number] * math.cos(angle)

    def tooth_thickness(self, number: int, diameter: float) -> float:
        """Thickness of a tooth on a circle [m], along it in the transverse section; NaN inside the base circle."""
        base = self.wheel_base(number)
        if not base <= diameter:
            return math.nan
        slope, angle = (
            2 * self.shifts[number] * math.tan(self.rack.pressure_angle),
            self.transverse.pressure_angle,
        )
        sign = -1 if number == 1 and self.kind == "internal" else 1
        difference = involute(angle) - involute(math.acos(base / diameter))
        return diameter * ((math.pi / 2 + sign * slope) / self.teeth[number] + sign * difference)

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
        return self._wheel(0), self._wheel(1)

    def _wheel(self, number: int) -> GearWheel:
        teeth, shift = self.teeth[number], self.shifts[number]
        internal = number == 1 and self.kind == "internal"
        begin, end = self.action_ends
        angle = self.transverse.pressure_angle
        thickness = math.pi / 2 + (-1 if internal else 1) * 2 * shift * math.tan(self.rack.pressure_angle)
        pitch_thickness = thickness * self.transverse.module
        if not math.isfinite(teeth):
            nothing = math.nan
            height, depth = self.rack.addendum * self.module, self.transverse.dedendum
            tip_thickness = pitch_thickness - 2 * height * math.tan(angle)
            return GearWheel(
                teeth, shift, False, nothing, nothing, nothing, nothing, nothing, height, depth, pitch_thickness,
                tip_thickness, nothing, nothing, nothing, float(self.specific_sliding(end)[1]),
            )  # fmt: skip
        pitch, base = self.transverse.module * teeth, self.wheel_base(number)
        tip, root = self.tip_diameters[number], self.root_diameters[number]
        sign = -1 if internal else 1
        radius = begin if number == 0 else end
        own = radius if number == 0 else float(self.other_curvature_radius(radius))
        flank = math.nan
        if not internal:
            # Where the straight flank of the rack ends: (h_a* - x) m_n below the pitch circle (GOST 16532).
            flank = math.atan(
                math.tan(angle)
                - 4
                * (self.rack.addendum - shift)
                * self.module
                / (self.transverse.module * teeth * math.sin(2 * angle))
            )
        return GearWheel(
            teeth,
            shift,
            internal,
            pitch,
            base,
            base / math.cos(self.working_angle),
            tip,
            root,
            sign * (tip - pitch) / 2,
            sign * (pitch - root) / 2,
            pitch_thickness,
            self.tooth_thickness(number, tip),
            math.nan if internal else least_shift(self.rack, teeth, self.helix_angle),
            math.atan(2 * own / base),
            flank,
            float(self.specific_sliding(radius)[number]),
        )


def _tangent_length(radius: float, base: float) -> float:
    """Length of a tangent of the base circle to a circle; NaN where that lies inside."""
    return math.sqrt(radius * radius - base * base) if radius >= base else math.nan
