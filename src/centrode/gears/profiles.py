"""True outlines of teeth: involute flank, the fillet that the rack leaves, undercut where it cuts into the flank."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.optimize import brentq

from centrode.gears.involutes import Array, involute, involute_curve
from centrode.gears.pair_geometry import PairGeometry
from centrode.gears.racks import TransverseRack, fillet_curve

FLANK, FILLET, ARC = 25, 25, 5
"""Places of a flank, of a fillet, and of an arc of the tip or root circle: cubic curves through them with their slopes
depart by less than 1e-6 of the module."""


@dataclass(frozen=True, eq=False)
class ProfilePiece:
    """A smooth piece of a tooth.

    Attributes
    ----------
    kind : "root", "fillet", "flank" or "tip"
    parameter : (n) growing or falling
    places, slopes : (n, 2) [m], and derivatives by the parameter
    """

    kind: Literal["root", "fillet", "flank", "tip"]
    parameter: Array
    places: Array
    slopes: Array


@dataclass(frozen=True, eq=False)
class ToothProfile:
    """The right half of a tooth whose middle lies on the y axis, from the middle of the gap to the middle of the tip.

    Attributes
    ----------
    pieces : from the root to the tip
    flank_radius : where the involute begins [m]: above the end that the rack gives it where the wheel is undercut
    teeth : number of them
    """

    pieces: tuple[ProfilePiece, ...]
    flank_radius: float
    teeth: int


def tooth_profile(pair: PairGeometry, number: int) -> ToothProfile:
    """The profile of a wheel, 0 or 1, that has a number of teeth.

    An external wheel has the fillet of the generating rack; if it is undercut, also the corner where that crosses the
    involute. The flank of an internal wheel goes on to its root circle, as no rack generates it. Places are on the
    curves to rounding.
    """
    wheel = pair.wheels[number]
    teeth, base = int(wheel.teeth), wheel.base / 2
    root, tip = wheel.root / 2, wheel.tip / 2
    half = half_base_angle(pair, number)
    if wheel.internal:
        rolls = np.linspace(_roll(root, base), _roll(max(tip, base), base), FLANK)
        flank = ProfilePiece("flank", rolls, *involute_curve(base, rolls, half, -1))
        return ToothProfile(_with_arcs((flank,), root, tip, teeth), root, teeth)
    last, begin = pair.transverse.pressure_angle, 0.0
    if wheel.undercut:
        last, begin = _undercut(pair, number, half)
    normals = np.linspace(math.pi / 2, last, FILLET)
    fillet = ProfilePiece("fillet", normals, *fillet_curve(*_generation(pair, number), normals))
    begin = begin or _roll(float(np.hypot(*fillet.places[-1])), base)
    rolls = np.linspace(begin, _roll(tip, base), FLANK)
    flank = ProfilePiece("flank", rolls, *involute_curve(base, rolls, half))
    pieces = _with_arcs((fillet, flank), root, tip, teeth)
    return ToothProfile(pieces, base * math.hypot(1.0, begin), teeth)


def true_contact_ratio(pair: PairGeometry) -> float:
    """Contact ratio of the involutes that the rack leaves: less than that by the tips where a wheel is undercut.

    Contact begins where the pinion's involute begins, if the other wheel's tip reaches below it, and ends where that of
    the wheel does.
    """
    begin, end = pair.action_ends
    begins = [
        math.sqrt(
            max(tooth_profile(pair, number).flank_radius ** 2 - (pair.wheels[number].base / 2) ** 2, 0.0)
        )
        for number in range(1 if pair.kind == "rack" else 2)
        if pair.wheels[number].undercut
    ]
    if pair.wheels[0].undercut:
        begin = max(begin, begins[0])
    if pair.wheels[1].undercut:
        end = min(end, pair.line_length - begins[-1])
    return (end - max(begin, 0.0)) / pair.base_pitch


def half_base_angle(pair: PairGeometry, number: int) -> float:
    """Half of the angle [rad] that a tooth of a wheel subtends at its base circle, outwards as far as it is there."""
    wheel = pair.wheels[number]
    side = -1 if wheel.internal else 1
    half = math.pi / 2 + side * 2 * wheel.shift * math.tan(pair.rack.pressure_angle)
    return half / wheel.teeth + side * involute(pair.transverse.pressure_angle)


def _generation(pair: PairGeometry, number: int) -> tuple[TransverseRack, float, float]:
    """The rack, the pitch radius and the rack's shift [m] of a wheel."""
    wheel = pair.wheels[number]
    return pair.transverse, wheel.pitch / 2, wheel.shift * pair.module


def _roll(radius: float, base: float) -> float:
    """tan(alpha) on a circle."""
    return math.sqrt(max((radius / base) ** 2 - 1, 0.0))


def _with_arcs(
    pieces: tuple[ProfilePiece, ...], root: float, tip: float, teeth: int
) -> tuple[ProfilePiece, ...]:
    """The pieces between the arc of the root circle from the middle of the gap, and that of the tip circle."""
    start, end = pieces[0].places[0], pieces[-1].places[-1]
    arcs = (
        ("root", root, math.pi / teeth, math.atan2(start[0], start[1])),
        ("tip", tip, math.atan2(end[0], end[1]), 0.0),
    )
    made: list[ProfilePiece] = []
    for kind, radius, first, last in arcs:
        angles = np.linspace(first, last, ARC)
        sine, cosine = radius * np.sin(angles), radius * np.cos(angles)
        places, slopes = np.stack([sine, cosine], axis=-1), np.stack([cosine, -sine], axis=-1)
        made.append(ProfilePiece(kind, angles, places, slopes))  # type: ignore[arg-type]
    return (made[0], *pieces, made[1])


def _undercut(pair: PairGeometry, number: int, half: float) -> tuple[float, float]:
    """Normal of the rack's edge, and roll of the involute, where both curves of an undercut wheel cross."""
    generation, base = _generation(pair, number), pair.wheels[number].base / 2

    def beyond(normal: float) -> float:
        """By which angle the fillet lies outside the involute's flank on the same circle."""
        (x, y), *_rest = fillet_curve(*generation, np.array([normal]))[0]
        roll = _roll(math.hypot(x, y), base)
        return math.atan2(x, y) - (half - (roll - math.atan(roll)))

    normals = np.linspace(math.pi / 2, pair.transverse.pressure_angle, 400)
    places = fillet_curve(*generation, normals)[0]
    radii = np.hypot(*places.T)
    over = normals[radii >= base]
    inside = normals[(radii < base) & (normals > over[0])] if len(over) else normals[:0]
    if len(inside):  # the corner may lie close to the base circle, where the involute begins
        start = brentq(
            lambda normal: float(np.hypot(*fillet_curve(*generation, np.array([normal]))[0][0])) - base,
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
            return normal, _roll(float(np.hypot(*fillet_curve(*generation, np.array([normal]))[0][0])), base)
    return pair.transverse.pressure_angle, 0.0


def turned_pieces(
    profile: ToothProfile, angle: float, centre: tuple[float, float] = (0.0, 0.0)
) -> list[ProfilePiece]:
    """The whole tooth, both flanks, with its middle turned counter-clockwise by an angle [rad] about a centre [m]."""
    mirror = np.array([-1.0, 1.0])
    left = [
        ProfilePiece(
            piece.kind, -piece.parameter[::-1], piece.places[::-1] * mirror, -piece.slopes[::-1] * mirror
        )
        for piece in reversed(profile.pieces)
    ]
    cosine, sine = math.cos(angle), math.sin(angle)
    turning = np.array([[cosine, sine], [-sine, cosine]])
    return [
        ProfilePiece(piece.kind, piece.parameter, piece.places @ turning + centre, piece.slopes @ turning)
        for piece in (*profile.pieces, *left)
    ]


def wheel_outline(profile: ToothProfile) -> Array:
    """Places (n, 2) of the closed outline of a wheel with its first tooth on the y axis, the first place repeated."""
    tooth = np.concatenate([piece.places for piece in turned_pieces(profile, 0.0)])
    outline = []
    for number in range(profile.teeth):
        angle = -2 * math.pi * number / profile.teeth
        cosine, sine = math.cos(angle), math.sin(angle)
        # From the gap on the right over the tip to the gap on the left: the next tooth is the one on the left.
        outline.append(tooth @ np.array([[cosine, -sine], [sine, cosine]]))
    return np.concatenate([*outline, outline[0][:1]])
