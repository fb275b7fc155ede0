"""True outlines of teeth: involute flank, the fillet that the rack leaves, undercut where it cuts into the flank."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache, partial

import numpy as np
from scipy.optimize import brentq

from centrode.gears.involutes import Array, involute_curve
from centrode.gears.pair_geometry import GearWheel, PairGeometry
from centrode.gears.racks import TransverseRack, fillet_curve
from centrode.numerics.outline_pieces import OutlinePiece

FLANK, FILLET, ARC = 25, 25, 5
"""Places of a flank, of a fillet, and of an arc of the tip or root circle: cubic curves through them with their slopes
depart by less than 1e-6 of the module."""


@dataclass(frozen=True, eq=False)
class ToothProfile:
    """The right half of a tooth whose middle lies on the y axis, from the middle of the gap to the middle of the tip.

    Attributes
    ----------
    pieces : on the layers "root", "fillet", "flank", "tip"
    flank_radius : where the involute begins [m]: above the end that the rack gives it where the wheel is undercut
    teeth : number of them
    """

    pieces: tuple[OutlinePiece, ...]
    flank_radius: float
    teeth: int


def tooth_profile(wheel: GearWheel) -> ToothProfile:
    """The profile of a wheel that is no rack.

    An external wheel has the fillet of the generating rack; if it is undercut, also the corner where that crosses the
    involute. The flank of an internal wheel goes on to its root circle, as no rack generates it. Places are on the
    curves to rounding.
    """
    teeth, base = int(wheel.teeth), wheel.base / 2
    root, tip = wheel.root / 2, wheel.tip / 2
    half = wheel.half_base_angle
    if wheel.internal:
        rolls = np.linspace(_roll(root, base), _roll(max(tip, base), base), FLANK)
        flank = OutlinePiece("flank", rolls, *involute_curve(base, rolls, half, -1))
        return ToothProfile(_with_arcs((flank,), root, tip, teeth), root, teeth)
    last, begin = wheel.pair.transverse.pressure_angle, 0.0
    if wheel.undercut:
        last, begin = _undercut_corner(wheel)
    normals = np.linspace(math.pi / 2, last, FILLET)
    fillet = OutlinePiece("fillet", normals, *fillet_curve(*_generation(wheel), normals))
    begin = begin or _roll(float(np.hypot(*fillet.places[-1])), base)
    rolls = np.linspace(begin, _roll(tip, base), FLANK)
    flank = OutlinePiece("flank", rolls, *involute_curve(base, rolls, half))
    pieces = _with_arcs((fillet, flank), root, tip, teeth)
    return ToothProfile(pieces, base * math.hypot(1.0, begin), teeth)


def true_action_ends(pair: PairGeometry) -> tuple[float, float]:
    """Where contact begins and ends as the pinion's radius of curvature [m], on the involutes that the rack leaves.

    Contact begins where the pinion's involute begins, if the other wheel's tip reaches below it, and ends where that of
    the wheel does.
    """
    begin, end = pair.action_ends
    first, second = pair.wheels
    if first.undercut:
        begin = max(begin, _flank_begin(first))
    if second.undercut:
        end = min(end, pair.line_length - _flank_begin(second))
    return max(begin, 0.0), end


def true_contact_ratio(pair: PairGeometry) -> float:
    """Contact ratio of the involutes that the rack leaves: less than that by the tips where a wheel is undercut."""
    begin, end = true_action_ends(pair)
    return (end - begin) / pair.base_pitch


def _flank_begin(wheel: GearWheel) -> float:
    """Radius of curvature [m] where the involute of an undercut wheel begins."""
    return _undercut_corner(wheel)[1] * wheel.base / 2


def _generation(wheel: GearWheel) -> tuple[TransverseRack, float, float]:
    """The rack, the pitch radius and the rack's shift [m] of a wheel."""
    return wheel.pair.transverse, wheel.pitch / 2, wheel.shift * wheel.pair.module


def _roll(radius: float, base: float) -> float:
    """tan(alpha) on a circle."""
    return math.sqrt(max((radius / base) ** 2 - 1, 0.0))


def _with_arcs(
    pieces: tuple[OutlinePiece, ...], root: float, tip: float, teeth: int
) -> tuple[OutlinePiece, ...]:
    """The pieces between the arc of the root circle from the middle of the gap, and that of the tip circle."""
    start, end = pieces[0].places[0], pieces[-1].places[-1]
    arcs = (
        ("root", root, math.pi / teeth, math.atan2(start[0], start[1])),
        ("tip", tip, math.atan2(end[0], end[1]), 0.0),
    )
    arcs_of: list[OutlinePiece] = []
    for kind, radius, first, last in arcs:
        angles = np.linspace(first, last, ARC)
        sine, cosine = radius * np.sin(angles), radius * np.cos(angles)
        places, slopes = np.stack([sine, cosine], axis=-1), np.stack([cosine, -sine], axis=-1)
        arcs_of.append(OutlinePiece(kind, angles, places, slopes))
    return (arcs_of[0], *pieces, arcs_of[1])


def _undercut_corner(wheel: GearWheel) -> tuple[float, float]:
    """Normal of the rack's edge, and roll of the involute, where both curves of an undercut wheel cross."""
    return _crossing_of_fillet_and_flank(*_generation(wheel), wheel.base / 2, wheel.half_base_angle)


# A search of trains meets few undercut wheels, each of them in pairs with hundreds of others.
@lru_cache(maxsize=128)
def _crossing_of_fillet_and_flank(
    rack: TransverseRack, pitch_radius: float, shift: float, base: float, half: float
) -> tuple[float, float]:
    """What `_undercut_corner` gives, by the generation, the base radius [m] and half a tooth's angle on it [rad]."""
    alpha = rack.pressure_angle
    fillet = partial(fillet_curve, rack, pitch_radius, shift)

    def beyond(normal: float) -> float:
        """By which angle the fillet lies outside the involute's flank on the same circle."""
        (x, y), *_rest = fillet(np.array([normal]))[0]
        roll = _roll(math.hypot(x, y), base)
        return math.atan2(x, y) - (half - (roll - math.atan(roll)))

    normals = np.linspace(math.pi / 2, alpha, 400)
    places = fillet(normals)[0]
    radii = np.hypot(*places.T)
    over = normals[radii >= base]
    inside = normals[(radii < base) & (normals > over[0])] if len(over) else normals[:0]
    if len(inside):  # the corner may lie close to the base circle, where the involute begins
        start = brentq(
            lambda normal: float(np.hypot(*fillet(np.array([normal]))[0][0])) - base,
            float(inside[-1]),
            float(over[0]),
            xtol=1e-15,
            rtol=8.9e-16,
        )
        over = np.concatenate([[start], over])
    values = [beyond(float(normal)) for normal in over]
    # The first crossing on the way out from the root is the corner; beyond it the fillet lies where metal is gone.
    for before, after, left, right in zip(over, over[1:], values, values[1:], strict=False):
        if (left < 0) != (right < 0):
            normal = float(brentq(beyond, float(before), float(after), xtol=1e-15, rtol=8.9e-16))
            return normal, _roll(float(np.hypot(*fillet(np.array([normal]))[0][0])), base)
    return alpha, 0.0


def whole_tooth(profile: ToothProfile) -> list[OutlinePiece]:
    """Both flanks of a tooth whose middle lies on the y axis, from the gap on its right to that on its left."""
    right = [piece.rising() for piece in profile.pieces]
    return [*right, *(piece.mirror_image() for piece in reversed(right))]


def wheel_outline(profile: ToothProfile) -> Array:
    """Places (n, 2) of the closed outline of a wheel with its first tooth on the y axis, the first place repeated."""
    tooth = np.concatenate([piece.places for piece in whole_tooth(profile)])
    outline = []
    for number in range(profile.teeth):
        angle = -2 * math.pi * number / profile.teeth
        cosine, sine = math.cos(angle), math.sin(angle)
        # From the gap on the right over the tip to the gap on the left: the next tooth is the one on the left.
        outline.append(tooth @ np.array([[cosine, -sine], [sine, cosine]]))
    return np.concatenate([*outline, outline[0][:1]])


def rack_over_pinion(pair: PairGeometry, teeth: int, along: float = 0.0) -> Array:
    """Outline (n, 2) [m] of a rack over the pinion of a pair, whose gap takes the pinion's tooth.

    Parameters
    ----------
    teeth : to either side
    along : by how much it is moved to the right [m]
    """
    module, angle = pair.transverse.module, pair.transverse.pressure_angle
    line = pair.wheels[0].pitch / 2 + pair.shifts[0] * pair.module
    tip, root = pair.rack.addendum * pair.module, pair.transverse.dedendum
    # half of a tooth at the rack's reference line, and what the flank gains towards the tip and the root
    half, slope = math.pi * module / 4, math.tan(angle)
    corners = []
    for tooth in range(-teeth, teeth):
        middle = (tooth + 0.5) * math.pi * module + along
        corners += [
            (middle - half - root * slope, line + root),
            (middle - half + tip * slope, line - tip),
            (middle + half - tip * slope, line - tip),
            (middle + half + root * slope, line + root),
        ]
    return np.array(corners)
