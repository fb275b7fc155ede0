"""What a mechanism does to its frame: all of it, and the part of inertia that shakes it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.kinetostatics.finding import Found
from centrode.dynamics.kinetostatics.stacking import column, columns, tables
from centrode.dynamics.pulls import Pull, total

Array: TypeAlias = npt.NDArray[np.float64]


def totals_of(found: Found) -> dict[str, Array]:
    """Inertia forces of the links, forces and moments on the frame, (samples, ...)."""
    inertia, samples = found.outer.inertia, found.forces.system.shape[-1]
    shaking = [pull for one in inertia for pull in one.pulls]
    return {
        "inertia_force": tables([one.force for one in inertia], 2, samples),
        "inertia_moment": columns([one.moment for one in inertia], samples),
        **_sums("frame", found.forces.on_frame, samples),
        **_sums("shaking", shaking, samples),
    }


def _sums(name: str, pulls: Sequence[Pull], samples: int) -> dict[str, Array]:
    x, y, moment = total(pulls)
    return {f"{name}_force": columns([x, y], samples), f"{name}_moment": column(moment, samples)}
