"""Radial forces of the teeth of pairs of gears: they press the axes apart, and load the hinges there alone.

The radial force is F_t tan(alpha_w), whatever the sense of the tangential force F_t, so it is no linear unknown. It
acts along the line of both axes, which the carrier holds: no other reaction feels it, and it is added to solved ones.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from centrode.dynamics.kinetostatics.equations import ForceSystem
from centrode.dynamics.kinetostatics.joints import JointSide, tables
from centrode.dynamics.state import Array


def with_radial_forces(
    parts: Mapping[str, Array], forces: ForceSystem, sides: Sequence[JointSide]
) -> dict[str, Array]:
    """Reactions with the radial forces of pairs of gears; those of a mechanism without pairs as they are."""
    system = forces.system
    mechanism, axes_of = system.scheme.structure.mechanism, system.teeth.axes
    if not any(gear.pair for gear in mechanism.gears):
        return dict(parts)
    samples = system.shape[-1]
    place_of = {side: place for place, side in enumerate(sides)}
    pins = np.array(parts["joint_force"], dtype=np.float64)
    radial = np.full_like(parts["tooth_force"], np.nan)
    for number, gear in enumerate(mechanism.gears):
        if gear.pair is None or gear.id not in axes_of:
            continue
        points = axes_of[gear.id]
        first, second = (tables([system.at.points[point]], 2, samples)[:, 0] for point in points)
        across = second - first
        away = across / np.linalg.norm(across, axis=1, keepdims=True)
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
