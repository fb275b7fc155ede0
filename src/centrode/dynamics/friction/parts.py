"""Friction as it stands among the reactions of a dataset."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.coordinates import place_of
from centrode.dynamics.friction.contacts import Bearing, Sliding
from centrode.dynamics.friction.losses import Powers
from centrode.dynamics.friction.rubbing import Rubbed
from centrode.dynamics.kinetostatics.stacking import column
from centrode.dynamics.states import State
from centrode.geometry.plane import turned
from centrode.model.mechanism import Mechanism

Array: TypeAlias = npt.NDArray[np.float64]


def friction_parts(rubbed: Rubbed, powers: Powers, mechanism: Mechanism) -> dict[str, Array]:
    """Variables of a dataset, samples first."""
    bearings = [k for k, contact in enumerate(rubbed.contacts) if isinstance(contact, Bearing)]
    found = {
        "friction_power": -rubbed.amounts * rubbed.slopes * powers.rate[:, None],
        "efficiency": powers.efficiency,
    }
    if bearings:
        found["friction_moment"] = rubbed.amounts[:, bearings]
    if len(bearings) < len(rubbed.contacts):
        found["friction_force"] = np.zeros((len(rubbed.amounts), len(mechanism.guides)))
        for k, guide in _guided(rubbed, mechanism):
            found["friction_force"][:, guide] = rubbed.amounts[:, k]
    return found


def _guided(rubbed: Rubbed, mechanism: Mechanism) -> list[tuple[int, int]]:
    """Contacts in guides, each with the number of its guide."""
    guides = [guide.id for guide in mechanism.guides]
    return [(k, guides.index(c.guide)) for k, c in enumerate(rubbed.contacts) if isinstance(c, Sliding)]


def with_friction(parts: dict[str, Array], rubbed: Rubbed, state: State) -> None:
    """Add friction to the force and the moment of each guide, whose lines exert it."""
    for k, which in _guided(rubbed, state.mechanism):
        guide = state.mechanism.guides[which]
        unit = turned(guide.unit, place_of(state.rotor(guide.on)))
        for axis in range(2):
            along = column(unit[axis], len(rubbed.amounts))
            parts["guide_force"][:, which, axis] += rubbed.amounts[:, k] * along
        parts["guide_moment"][:, which] += rubbed.arms[:, k]
