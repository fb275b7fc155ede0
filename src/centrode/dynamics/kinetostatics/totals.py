"""What a mechanism does to its frame: all of it, and the part of inertia that shakes it."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.kinetostatics.finding import Found
from centrode.dynamics.pulls import Pull, total

Array: TypeAlias = npt.NDArray[np.float64]
Number: TypeAlias = Any


def totals_of(found: Found) -> dict[str, Array]:
    """Inertia forces of the links, forces and moments on the frame, (samples, ...)."""
    inertia = found.outer.inertia
    shaking = [pull for one in inertia for pull in one.pulls]
    return {
        "inertia_force": _stacked(found, [list(one.force) for one in inertia], 2),
        "inertia_moment": _stacked(found, [one.moment for one in inertia]),
        **_sums(found, "frame", found.forces.on_frame),
        **_sums(found, "shaking", shaking),
    }


def _sums(found: Found, name: str, pulls: list[Pull]) -> dict[str, Array]:
    x, y, moment = total(pulls)
    return {
        f"{name}_force": _stacked(found, [x, y]),
        f"{name}_moment": _stacked(found, [moment])[:, 0],
    }


def _stacked(found: Found, values: list[Any], width: int = 0) -> Array:
    """Numbers over the samples as one array, samples first; of vectors of some width where that is given."""
    samples = found.forces.system.shape[-1]
    filled = np.zeros((samples, len(values), *((width,) if width else ())))
    for k, value in enumerate(values):
        for part, number in enumerate(value) if width else ((..., value),):
            filled[:, k, part] = np.broadcast_to(number, (1, samples))[0]
    return filled
