"""What a mechanism does to its frame: all of it, and the part of inertia that shakes it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.kinetostatics.finding import Found
from centrode.dynamics.kinetostatics.stacking import column, columns, tables
from centrode.dynamics.pulls import Pull, Vector, components, total

Array: TypeAlias = npt.NDArray[np.float64]


def totals_of(found: Found) -> dict[str, Array]:
    """Inertia forces of the links, forces and moments on the frame, (samples, ...)."""
    inertia, samples = found.outer.inertia, found.forces.system.shape[-1]
    origin = found.forces.system.equilibrium.origin
    shaking = [pull for one in inertia for pull in one.pulls]
    moments = [components(one.moment) for one in inertia]
    return {
        "inertia_force": tables([one.force for one in inertia], len(origin), samples),
        "inertia_moment": _moments(moments, len(origin), samples),
        **_sums("frame", found.forces.on_frame, origin, samples),
        **_sums("shaking", shaking, origin, samples),
    }


def _moments(moments: Sequence[Vector], axes: int, samples: int) -> Array:
    """Moments of links: one number each in the plane, three on the sphere."""
    found = tables(moments, axes if axes == 3 else 1, samples)
    return found if axes == 3 else found[:, :, 0]


def _sums(name: str, pulls: Sequence[Pull], origin: Vector, samples: int) -> dict[str, Array]:
    force, moment = total(pulls, origin)
    turned = columns(moment, samples) if isinstance(moment, tuple) else column(moment, samples)
    return {f"{name}_force": columns(force, samples), f"{name}_moment": turned}


def joint_moments(found: Found, forces: Array) -> Array:
    """On the sphere: moments about its centre [N m] of the forces in hinges, (samples, sides, 3)."""
    system = found.forces.system
    samples, radius = system.shape[-1], system.scheme.structure.mechanism.sphere_radius
    places = [system.at.points[side.point] for side in found.sides]
    return np.cross(radius * tables(places, 3, samples), forces)
