"""The reference rack of involute teeth, and what it leaves on a wheel: undercut, and the fillet."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from centrode.gears.involutes import Array

EDGE = 13
"""Places of the rounded edge of a rack's tooth."""


@dataclass(frozen=True)
class ReferenceRack:
    """The basic rack tooth profile in the normal section, in modules; as in GOST 13755 and ISO 53 (profile A).

    Attributes
    ----------
    pressure_angle : alpha [rad]
    addendum : h_a*
    clearance : c*
    fillet : rho_f*, radius of the rounded edge of the generating rack
    """

    pressure_angle: float = math.radians(20)
    addendum: float = 1.0
    clearance: float = 0.25
    fillet: float = 0.38

    @property
    def greatest_fillet(self) -> float:
        """The radius with which the clearance is just filled: c*/(1 - sin alpha)."""
        return self.clearance / (1 - math.sin(self.pressure_angle))

    @property
    def straight(self) -> float:
        """How deep the straight flank goes below the middle line: h_a*, more with a small fillet.

        A fillet that fills the clearance up to rounding of its printed value ends at h_a*.
        """
        rounded = self.fillet * (1 - math.sin(self.pressure_angle))
        return self.addendum + max(self.clearance - rounded, 0.0)


STANDARD_RACK = ReferenceRack()
"""That of GOST 13755 and ISO 53, profile A."""


@dataclass(frozen=True)
class TransverseRack:
    """The generating rack in the transverse section of a wheel with helix angle beta, in metres.

    Attributes
    ----------
    module : m_t [m]
    pressure_angle : alpha_t [rad]
    addendum : h_a* m_n [m]
    straight : [m], to the end of the straight flank
    dedendum : (h_a* + c*) m_n [m], to the tip line of the generating rack
    fillet : radius of the rounded edge [m] in this section
    """

    module: float
    pressure_angle: float
    addendum: float
    straight: float
    dedendum: float
    fillet: float


def transverse_rack(rack: ReferenceRack, module: float, helix_angle: float) -> TransverseRack:
    """The rack in the transverse section: m_t = m/cos(beta), tan(alpha_t) = tan(alpha)/cos(beta); heights stay."""
    cosine = math.cos(helix_angle)
    angle = math.atan(math.tan(rack.pressure_angle) / cosine)
    clearance = rack.clearance * module
    # An arc of the normal section is an ellipse in the transverse one; the circle that fills the same clearance beside
    # the inclined flank stands for it, exactly where beta is zero.
    fillet = rack.fillet * module
    if helix_angle:
        share = fillet / (rack.greatest_fillet * module) if clearance else 0.0
        fillet = share * clearance / (1 - math.sin(angle))
    return TransverseRack(
        module / cosine,
        angle,
        rack.addendum * module,
        rack.straight * module,
        (rack.addendum + rack.clearance) * module,
        fillet,
    )


def least_shift(rack: ReferenceRack, teeth: float, helix_angle: float = 0.0) -> float:
    """The shift coefficient x_min below which the rack undercuts a wheel: h_a* - z sin^2(alpha_t)/(2 cos(beta)).

    h_a* stands for the depth of the straight flank, which a fillet smaller than the clearance holds makes greater.
    """
    angle = math.atan(math.tan(rack.pressure_angle) / math.cos(helix_angle))
    return rack.straight - teeth * math.sin(angle) ** 2 / (2 * math.cos(helix_angle))


def least_teeth(rack: ReferenceRack, shift: float = 0.0, helix_angle: float = 0.0) -> float:
    """The number of teeth z_min below which the rack undercuts: 2 (h_a* - x) cos(beta)/sin^2(alpha_t)."""
    angle = math.atan(math.tan(rack.pressure_angle) / math.cos(helix_angle))
    return 2 * (rack.straight - shift) * math.cos(helix_angle) / math.sin(angle) ** 2


def rack_tooth(rack: TransverseRack, shift: float) -> Array:
    """Outline (n, 2) of a tooth of the generating rack [m] about the y axis, the wheel's pitch line at y = 0."""
    alpha, radius = rack.pressure_angle, rack.fillet
    half, slope = math.pi * rack.module / 4, math.tan(alpha)
    centre = complex(
        half - rack.dedendum * slope - radius * (1 / math.cos(alpha) - slope), shift - rack.dedendum + radius
    )
    edge = centre + radius * np.exp(1j * np.linspace(-math.pi / 2, -alpha, EDGE))
    top = complex(half + rack.addendum * slope, shift + rack.addendum)
    right = np.append(edge, top)
    outline = np.concatenate([-np.conj(right[::-1]), right])
    return np.stack([outline.real, outline.imag], axis=-1)


def rack_positions(outline: Array, pitch_radius: float, rolled: Array) -> Array:
    """Outlines (k, n, 2) of a rack in the frame of the wheel, after rolling by angles (k) [rad]."""
    places = outline[:, 0] + 1j * (pitch_radius + outline[:, 1])
    turned = (places[None, :] + pitch_radius * rolled[:, None]) * np.exp(1j * rolled)[:, None]
    return np.stack([turned.real, turned.imag], axis=-1)


def fillet_curve(
    rack: TransverseRack, pitch_radius: float, shift: float, normals: Array
) -> tuple[Array, Array]:
    """Places and slopes (n, 2) of the fillet that the rounded edge of the rack envelopes [m, m/rad].

    The tooth's middle lies on the y axis; the fillet is that on its right. By the law of gearing the normal where edge
    and wheel touch passes through the pitch point (Litvin and Fuentes 2004, section 6.2).

    Parameters
    ----------
    rack : of the transverse section
    pitch_radius : of the wheel, r = m_t z/2 [m]
    shift : of the rack's middle line from the pitch circle, x m_n [m]
    normals : (n) angles [rad] of that normal with the rack's pitch line: pi/2 at the root, the pressure angle where the
        straight flank of the rack begins; slopes are derivatives by it
    """
    alpha, radius = rack.pressure_angle, rack.fillet
    # Centre of the rounded edge: `depth` below the rack's pitch line, `across` from the middle of its tooth.
    depth = rack.dedendum - shift - radius
    half_tooth = math.pi * rack.module / 4
    across = half_tooth - rack.dedendum * math.tan(alpha) - radius * (1 / math.cos(alpha) - math.tan(alpha))
    # The rack has rolled so far when the normal at this place of its edge passes through the pitch point (0, r).
    sine, cosine = np.sin(normals), np.cos(normals)
    turned = (depth * cosine / sine - across) / pitch_radius
    turning = -depth / (sine * sine) / pitch_radius
    distance, growing = depth / sine + radius, -depth * cosine / (sine * sine)
    # Complex numbers turn by a product: the wheel has turned clockwise meanwhile, turned back this is the gap's wall on
    # the right; its mirror image is that on the left, of the gap half a pitch clockwise from the tooth.
    place = distance * cosine + 1j * (pitch_radius - distance * sine)
    slope = growing * cosine - distance * sine - 1j * (growing * sine + distance * cosine)
    back = np.exp(1j * turned)
    wall, wall_slope = place * back, (slope + 1j * turning * place) * back
    half_pitch = np.exp(-1j * math.pi * rack.module / (2 * pitch_radius))
    left, left_slope = -np.conj(wall) * half_pitch, -np.conj(wall_slope) * half_pitch
    return np.stack([left.real, left.imag], axis=-1), np.stack([left_slope.real, left_slope.imag], axis=-1)
