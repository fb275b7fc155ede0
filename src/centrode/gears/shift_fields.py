"""What changes with the shifts of a pair, over arrays of shifts at once: mesh, contact ratio, tips, fillets, sliding.

The formulas are those of `PairGeometry`, which has one pair alone; a contour asks thousands of them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from centrode.gears.involutes import Array, involutes, pressure_angles_of
from centrode.gears.pair_geometry import PairGeometry
from centrode.geometry.involute import involute


@dataclass(frozen=True, eq=False)
class ShiftFields:
    """A pair over arrays of shifts; everything is NaN where the wheels cannot mesh, and of a rack where it has none.

    Attributes
    ----------
    mesh : inv(alpha_w)
    contact_ratio : epsilon_alpha
    tip_thickness : of both wheels, in modules
    above_undercut : shift of each wheel less that below which the rack undercuts; 1 where no rack generates it
    above_fillet : tangent of the pressure angle where contact ends on each wheel less that where its fillet begins
    sliding : greatest specific sliding of both wheels
    flatness : relative radius of curvature at the pitch point, in modules
    tips : by how much the tips of an internal pair pass each other [rad], at most 1; 1 of other pairs
    """

    mesh: Array
    contact_ratio: Array
    tip_thickness: tuple[Array, Array]
    above_undercut: tuple[Array, Array]
    above_fillet: tuple[Array, Array]
    sliding: tuple[Array, Array]
    flatness: Array
    tips: Array


@dataclass(frozen=True, eq=False)
class _Mesh:
    """Both wheels in mesh: lengths in modules of the normal section, over arrays of shifts."""

    angle: Array
    base: tuple[float, float]
    tip: tuple[Array, Array]
    distance: Array
    begin: Array
    end: Array
    pitch: Array
    line: Array


def shift_fields(pair: PairGeometry, first: ArrayLike, second: ArrayLike) -> ShiftFields:
    """A pair with other shifts x_1 and x_2 (...); those it has are ignored."""
    shifts = tuple(np.asarray(shift, dtype=np.float64) for shift in np.broadcast_arrays(first, second))
    with np.errstate(invalid="ignore", divide="ignore"):
        mesh = _working_involutes(pair, shifts)
        state = _mesh(pair, shifts, mesh)
        wheels = (0, 1)
        return ShiftFields(
            mesh,
            (state.end - state.begin) / _base_pitch(pair),
            tuple(_tip_thickness(pair, state, shifts, number) for number in wheels),  # type: ignore[arg-type]
            tuple(_above_undercut(pair, shifts, number) for number in wheels),  # type: ignore[arg-type]
            tuple(_above_fillet(pair, state, shifts, number) for number in wheels),  # type: ignore[arg-type]
            _sliding(pair, state),
            1 / (1 / state.pitch + pair.sign / (state.line - pair.sign * state.pitch)),
            _tips(pair, state),
        )


def _working_involutes(pair: PairGeometry, shifts: tuple[Array, ...]) -> Array:
    total = shifts[1] + pair.sign * shifts[0]
    own = involute(pair.transverse.pressure_angle)
    return np.asarray(own + 2 * total * math.tan(pair.rack.pressure_angle) / pair.teeth_sum)


def _base_pitch(pair: PairGeometry) -> float:
    return pair.base_pitch / pair.module


def _mesh(pair: PairGeometry, shifts: tuple[Array, ...], mesh: Array) -> _Mesh:
    section, height = pair.transverse, pair.rack.addendum
    module, cosine = section.module / pair.module, math.cos(section.pressure_angle)
    first, second = shifts
    base = module * pair.teeth[0] * cosine / 2, module * pair.teeth[1] * cosine / 2
    if pair.kind == "rack":
        angle = np.full(mesh.shape, section.pressure_angle)
        radius = module * pair.teeth[0] / 2
        tip = radius + height + first - 0.0 * second
        pitch = np.full(mesh.shape, radius * math.sin(section.pressure_angle))
        begin = pitch - (height - first) / math.sin(section.pressure_angle)
        far, none = np.full(mesh.shape, math.inf), np.full(mesh.shape, math.nan)
        return _Mesh(angle, base, (tip, none), far, begin, _tangent(tip, base[0]), pitch, far)
    angle = pressure_angles_of(mesh)
    plain = module * pair.teeth_sum / 2
    distance = plain * cosine / np.cos(angle)
    lowered = second + pair.sign * first - (distance - plain)
    if pair.kind == "internal":
        relief = np.where(second < 2, 0.25 - 0.125 * second, 0.0)
        own = module * pair.teeth[0] / 2 + height + first
        other = module * pair.teeth[1] / 2 - (height - second + lowered - relief)
    else:
        own = module * pair.teeth[0] / 2 + height + first - lowered
        other = module * pair.teeth[1] / 2 + height + second - lowered
    line = distance * np.sin(angle)
    begin = pair.sign * (line - _tangent(other, base[1]))
    return _Mesh(
        angle, base, (own, other), distance, begin, _tangent(own, base[0]), base[0] * np.tan(angle), line
    )


def _tangent(radius: Array, base: float) -> Array:
    """Length of a tangent of the base circle to a circle; NaN where that lies inside."""
    return np.asarray(np.sqrt(radius * radius - base * base))


def _tip_thickness(pair: PairGeometry, state: _Mesh, shifts: tuple[Array, ...], number: int) -> Array:
    section, outwards = pair.transverse, -1 if number and pair.kind == "internal" else 1
    pitch = (math.pi / 2 + outwards * 2 * shifts[number] * math.tan(pair.rack.pressure_angle)) * (
        section.module / pair.module
    )
    if math.isinf(pair.teeth[number]):
        return np.asarray(pitch - 2 * pair.rack.addendum * math.tan(section.pressure_angle))
    diameter = section.module / pair.module * pair.teeth[number]
    half = pitch / diameter + outwards * involute(section.pressure_angle)
    tip = state.tip[number]
    return np.asarray(2 * tip * (half - outwards * involutes(np.arccos(state.base[number] / tip))))


def _is_generated(pair: PairGeometry, number: int) -> bool:
    return pair.wheels[number].is_generated


def _above_undercut(pair: PairGeometry, shifts: tuple[Array, ...], number: int) -> Array:
    if not _is_generated(pair, number):
        return np.ones(shifts[number].shape)
    return np.asarray(shifts[number] - pair.wheels[number].least_shift)


def _above_fillet(pair: PairGeometry, state: _Mesh, shifts: tuple[Array, ...], number: int) -> Array:
    if not _is_generated(pair, number):
        return np.ones(shifts[number].shape)
    own = state.begin if number == 0 else state.line - pair.sign * state.end
    angle = pair.transverse.pressure_angle
    pitch = pair.transverse.module / pair.module * pair.teeth[number]
    depth = pair.rack.straight - shifts[number]
    return np.asarray(
        own / state.base[number] - (math.tan(angle) - 4 * depth / (pitch * math.sin(2 * angle)))
    )


def _sliding(pair: PairGeometry, state: _Mesh) -> tuple[Array, Array]:
    """Where each active flank ends towards the root."""

    def share(radius: Array) -> Array:
        if pair.kind == "rack":
            return np.asarray(state.pitch / radius)
        return np.asarray((state.line - pair.sign * radius) / (pair.ratio * radius))

    return 1 - share(state.begin), 1 - 1 / share(state.end)


def _tips(pair: PairGeometry, state: _Mesh) -> Array:
    if pair.kind != "internal":
        return np.ones(state.distance.shape)
    (own, other), distance = state.tip, state.distance
    crossing = (np.abs(own - distance) < other) & (other < own + distance)
    about_pinion = np.arccos((other**2 - own**2 - distance**2) / (2 * own * distance))
    about_wheel = np.arccos((distance**2 + other**2 - own**2) / (2 * distance * other))
    working = involutes(state.angle)
    first = about_pinion + involutes(np.arccos(np.minimum(state.base[0] / own, 1.0))) - working
    second = about_wheel + involutes(np.arccos(np.minimum(state.base[1] / other, 1.0))) - working
    return np.where(crossing, np.minimum(first / pair.ratio - second, 1.0), 1.0)
