"""Everything that is computed of a described pair of wheels."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from centrode.errors import MotionError
from centrode.gears.blocking_contour import BlockingContour, blocking_contour
from centrode.gears.involutes import Array
from centrode.gears.measurements import WheelMeasurements, wheel_measurements
from centrode.gears.pair_faults import PairFault, pair_faults
from centrode.gears.pair_geometry import PairGeometry, PairKind
from centrode.gears.profiles import ToothProfile, tooth_profile, true_contact_ratio
from centrode.gears.racks import ReferenceRack
from centrode.gears.recommended_shifts import RecommendedRow, recommended_row
from centrode.gears.shift_choice import chosen_shifts, shift_sum_at
from centrode.geometry.involute import involute
from centrode.locale import _
from centrode.model.examples.catalogue import GearPairSource, gear_pair_of
from centrode.model.gear_pairs import RACK, STANDARD, GearPair


@dataclass(frozen=True)
class ToothForces:
    """Forces between the teeth [N] for a moment on the pinion, all of them positive.

    Attributes
    ----------
    tangential : F_t, along the working pitch circles
    radial : F_r, between the axes
    axial : F_x, along the axes; zero of spur teeth
    normal : F_n, along the normal of the flanks
    """

    tangential: float
    radial: float
    axial: float
    normal: float


@dataclass(frozen=True, eq=False)
class LineOfAction:
    """What happens along the active line of action.

    Attributes
    ----------
    places : (n) from the pitch point in the direction in which the contact moves [m]
    radii : (n, 2) radii of curvature of both flanks [m]; infinite of a rack
    sliding : (n, 2) specific sliding of both flanks
    pressure : (n) pressure coefficient m (1/rho_1 + 1/rho_2)
    speeds : (n) sliding speed of the flanks [m/s]; None where the pinion has no speed
    single : from and to [m], where one pair of teeth bears alone; None where there is no such part
    """

    places: Array
    radii: Array
    sliding: Array
    pressure: Array
    speeds: Array | None
    single: tuple[float, float] | None


@dataclass(frozen=True)
class GearPairResults:
    """A described pair with everything that is computed of it.

    Attributes
    ----------
    gear_pair : GearPair
        The description.
    geometry : PairGeometry
        With the shifts that were given or chosen.
    """

    gear_pair: GearPair
    geometry: PairGeometry

    @cached_property
    def measurements(self) -> tuple[WheelMeasurements, ...]:
        """Of the pinion, and of the wheel where it is none but a rack."""
        pin = self.gear_pair.pin or 0.0
        return tuple(wheel_measurements(wheel, pin) for wheel in self.geometry.wheels if not wheel.is_rack)

    @cached_property
    def faults(self) -> tuple[PairFault, ...]:
        """Everything that keeps the pair from working; empty where it works."""
        return tuple(pair_faults(self.geometry))

    @cached_property
    def recommendation(self) -> RecommendedRow | None:
        """The row of the recommendation that gave the shifts; None where they are given or have another purpose."""
        described, pair = self.gear_pair, self.geometry
        if described.purpose != STANDARD:
            return None
        distance = described.centre_distance
        total = None if distance is None else shift_sum_at(pair, distance)
        return recommended_row(pair.teeth, described.intended_application, total)

    @cached_property
    def line_of_action(self) -> LineOfAction:
        """Sliding and pressure along the active line of action."""
        pair = self.geometry
        begin, end = pair.action_ends
        radii = np.linspace(max(begin, 0.0), end, self.gear_pair.samples)
        first, second = pair.specific_sliding(radii)
        speeds = None
        if self.gear_pair.speed is not None:
            # The flanks move at omega_1 rho_1 and omega_2 rho_2 across the line of action.
            own = self.gear_pair.speed
            if pair.kind == "rack":
                speeds = np.abs(own * (radii - pair.pitch_curvature_radius))
            else:
                speeds = np.abs(own * radii - own / pair.ratio * pair.other_curvature_radius(radii))
        middle = pair.pitch_curvature_radius
        single = (end - pair.base_pitch - middle, begin + pair.base_pitch - middle)
        others = np.broadcast_to(pair.other_curvature_radius(radii), radii.shape)
        return LineOfAction(
            radii - middle,
            np.stack([radii, others], axis=-1),
            np.stack([first, second], axis=-1),
            pair.pressure_coefficient(radii),
            speeds,
            single if single[0] < single[1] else None,
        )

    @cached_property
    def profiles(self) -> tuple[ToothProfile, ...]:
        """True teeth of the wheels; a rack has straight ones."""
        return tuple(tooth_profile(wheel) for wheel in self.geometry.wheels if not wheel.is_rack)

    @cached_property
    def true_contact_ratio(self) -> float:
        """The contact ratio of the involutes that are there: less than by the tips where a wheel is undercut."""
        return true_contact_ratio(self.geometry)

    @cached_property
    def contour(self) -> BlockingContour | None:
        """The blocking contour about the shifts; None of a rack, whose own shift changes nothing."""
        return None if self.geometry.kind == "rack" else blocking_contour(self.geometry)

    @cached_property
    def forces(self) -> ToothForces | None:
        """Forces at the pitch point for the moment on the pinion; None where none is given."""
        moment, pair = self.gear_pair.moment, self.geometry
        if moment is None:
            return None
        tangential = 2 * moment / pair.wheels[0].working_pitch
        angle = pair.working_angle
        # Helix angle on the working pitch circle: tan(beta_w) = tan(beta) d_w/d.
        helix = math.tan(pair.helix_angle) * pair.wheels[0].working_pitch / pair.wheels[0].pitch
        axial = tangential * helix
        radial = tangential * math.tan(angle)
        return ToothForces(tangential, radial, axial, math.hypot(tangential, radial, axial))

    @property
    def output_speed(self) -> float | None:
        """Speed of the wheel [rad/s], of a rack [m/s], against the pinion where it is external."""
        speed = self.gear_pair.speed
        if speed is None:
            return None
        if self.geometry.kind == "rack":
            return speed * self.geometry.wheels[0].pitch / 2
        return -self.geometry.sign * speed / self.geometry.ratio


def gear_pair(source: GearPairSource) -> GearPairResults:
    """Geometry of a pair of gears: angles, diameters, contact ratio, sliding, measurements, true teeth.

    Parameters
    ----------
    source : GearPair, file or name of an example

    Returns
    -------
    GearPairResults
        Its `geometry` has the wheels with their diameters [m]. Profiles, blocking contour, sliding and forces are
        computed when they are first read.

    Raises
    ------
    InputError
        A description that is none; a centre distance that cannot be; a pair without recommended shifts.
    MotionError
        Wheels that cannot mesh, or no shifts that fulfil the purpose.

    Examples
    --------
    >>> import centrode as ct
    >>> pair = ct.gear_pair("shifted-gear-pair").geometry
    >>> round(pair.centre_distance * 1e3, 4), round(pair.contact_ratio, 4)
    (56.4999, 1.2021)
    """
    described = gear_pair_of(source)
    geometry = bare_geometry(described)
    if described.purpose is None:
        shifts = described.shifts
        assert isinstance(shifts, tuple)
    else:
        shifts = chosen_shifts(
            geometry, described.purpose, described.centre_distance, described.intended_application
        )
    geometry = PairGeometry(
        geometry.kind,
        geometry.module,
        geometry.teeth,
        shifts,
        geometry.helix_angle,
        geometry.rack,
        geometry.width,
    )
    if math.isnan(geometry.working_angle):
        what = _("the wheels cannot mesh: the sum of their shifts, {total:.6g}, is too small for their teeth")
        # inv(alpha_w) = 0, where the flanks touch at the base circles.
        own = involute(geometry.transverse.pressure_angle)
        from_sum = -own * geometry.teeth_sum / (2 * math.tan(geometry.rack.pressure_angle))
        raise MotionError(
            "shifts",
            what.format(total=geometry.shift_sum),
            _("it has to be greater than {least:.6g}").format(least=from_sum),
        )
    return GearPairResults(described, geometry)


def bare_geometry(described: GearPair) -> PairGeometry:
    """The described wheels without shifts."""
    first, second = described.teeth
    kind: PairKind = "internal" if described.internal else "external"
    if second == RACK:
        kind = "rack"
    rack = described.rack
    return PairGeometry(
        kind,
        described.module,
        (float(first), math.inf if second == RACK else float(second)),
        (0.0, 0.0),
        described.helix_angle,
        ReferenceRack(rack.pressure_angle, rack.addendum, rack.clearance, rack.fillet_radius),
        described.width or 0.0,
    )
