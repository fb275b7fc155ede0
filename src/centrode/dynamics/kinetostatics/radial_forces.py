"""Radial forces of the teeth of pairs of gears: they press the axes apart, and load the hinges there alone.

The radial force is F_t tan(alpha_w), whatever the sense of the tangential force F_t, so it is no linear unknown. It
acts along the line of both axes, which the carrier holds: no other reaction feels it, and it is added to solved ones.
Friction in a hinge does feel it; there the sense of F_t is that without friction.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from centrode.dynamics.kinetostatics.applied_forces import Outer
from centrode.dynamics.kinetostatics.equations import ForceSystem, Kinetostatics, Scheme, Teeth
from centrode.dynamics.kinetostatics.joints import JointSide, column, tables
from centrode.dynamics.state import Array, State
from centrode.kinematics.preparation import Ready
from centrode.model.gears import Gear
from centrode.structure.constraints import GearRatio


def tooth_senses(forces: ForceSystem) -> dict[str, Array]:
    """Sense (n) of the tangential force between the teeth of each pair, by the gear's id."""
    return {gear.id: np.sign(_tangential(forces, tie, sizes)) for gear, tie, sizes, _points in _pairs(forces)}


def tangential_forces_at(prepared: Ready, state: State, outer: Outer) -> dict[str, Array]:
    """Tangential forces (n, 2) on the second wheels of pairs [N], by the gear's id."""
    scheme, teeth = Scheme.of(prepared.structure), Teeth.of(prepared.mechanism)
    forces = Kinetostatics.of(scheme, prepared.kinematics.numbers, state, teeth).forces(outer.pulls)
    samples = forces.system.shape[-1]
    found = {}
    for gear, tie, _sizes, _points in _pairs(forces):
        unit = tables([forces.system.pulls[tie, 0][0].force], 2, samples)[:, 0]
        found[gear.id] = column(forces.multipliers.get((tie, 0), 0.0), samples)[:, None] * unit
    return found


def radial_force_on(forces: ForceSystem, side: JointSide, senses: Mapping[str, Array]) -> Array:
    """Radial forces (n, 2) of pairs that press a pin on a body [N], linear in the forces for given senses.

    Parameters
    ----------
    senses : of the tangential forces, those of `tooth_senses` where friction changes none of them
    """
    samples = forces.system.shape[-1]
    force = np.zeros((samples, 2))
    for gear, tie, sizes, points in _pairs(forces):
        assert gear.pair is not None
        size = senses[gear.id] * _tangential(forces, tie, sizes) * math.tan(gear.pair.working_mesh()[0])
        on_second = gear.pair.turns * size[:, None] * _away(forces, points)
        for wheel, point, own in zip(gear.links, points, (-on_second, on_second), strict=True):
            for body, sense in ((wheel, -1.0), (gear.carrier, 1.0)):
                if side == JointSide(point, body):
                    force += sense * own
    return force


def _pairs(forces: ForceSystem) -> Iterator[tuple[Gear, GearRatio, Array, tuple[str, ...]]]:
    """Gears with a pair whose axes are known: constraint, force of a unit multiplier (n), points of both axes."""
    structure, axes_of = forces.system.scheme.structure, forces.system.teeth.axes
    ties = {tie.gear: tie for tie in structure.constraints if isinstance(tie, GearRatio)}
    samples = forces.system.shape[-1]
    for gear in structure.mechanism.gears:
        if gear.pair is not None and gear.id in axes_of and gear.id in ties:
            unit = tables([forces.system.pulls[ties[gear.id], 0][0].force], 2, samples)[:, 0]
            yield gear, ties[gear.id], np.linalg.norm(unit, axis=1), tuple(axes_of[gear.id])


def _tangential(forces: ForceSystem, tie: GearRatio, sizes: Array) -> Array:
    return column(forces.multipliers.get((tie, 0), 0.0), len(sizes)) * sizes


def _away(forces: ForceSystem, points: Sequence[str]) -> Array:
    """Unit vector (n, 2) from the axis of the first wheel to that of the second."""
    samples = forces.system.shape[-1]
    first, second = (tables([forces.system.at.points[point]], 2, samples)[:, 0] for point in points)
    across = second - first
    return np.asarray(across / np.linalg.norm(across, axis=1, keepdims=True))


def with_radial_forces(
    parts: Mapping[str, Array], forces: ForceSystem, sides: Sequence[JointSide]
) -> dict[str, Array]:
    """Reactions with the radial forces of pairs of gears; those of a mechanism without pairs as they are."""
    system = forces.system
    mechanism, axes_of = system.scheme.structure.mechanism, system.teeth.axes
    if not any(gear.pair for gear in mechanism.gears):
        return dict(parts)
    place_of = {side: place for place, side in enumerate(sides)}
    pins = np.array(parts["joint_force"], dtype=np.float64)
    radial = np.full_like(parts["tooth_force"], np.nan)
    for number, gear in enumerate(mechanism.gears):
        if gear.pair is None or gear.id not in axes_of:
            continue
        points = axes_of[gear.id]
        away = _away(forces, points)
        size = np.linalg.norm(parts["tooth_force"][:, number], axis=1) * math.tan(gear.pair.working_mesh()[0])
        # Of an external pair the second wheel is pressed away from the first; a ring presses its pinion inwards.
        on_second = gear.pair.turns * size[:, None] * away
        radial[:, number] = on_second
        for wheel, point, force in zip(gear.links, points, (-on_second, on_second), strict=True):
            for body, sense in ((wheel, -1.0), (gear.carrier, 1.0)):
                place = place_of.get(JointSide(point, body))
                if place is not None:
                    pins[:, place] += sense * force
    return {**parts, "joint_force": pins, "tooth_radial_force": radial}
