"""Starting places for groups that no chain of initial angles reaches, such as a platform on three cylinders.

Their links know their angles and no place. So the first of them is tried at many places about what is known; of
what closes, the positions count that have the angles given.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import cos, radians, sin, tau
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.arrays import ARRAYS
from centrode.kinematics.higher_class.newton import newton
from centrode.kinematics.higher_class.system import System
from centrode.model.mechanism import Mechanism
from centrode.structure.constraints import Positions
from centrode.structure.dimensions import Dimensions

Array: TypeAlias = npt.NDArray[np.float64]

RINGS, SPOKES = (0.25, 0.6, 1.0), 12
"""Places are tried on rings about every known point, in the greatest length."""
POINTS = 8
"""Known points about which places are tried."""
NEAR = radians(5.0)
"""How far the angles of a position may be from those given."""
CLEARLY = 0.2
"""A position is meant if its angles are off by less than this share of what the next position's are."""
SAME = 1e-6
"""Positions closer than this, in the greatest length and in rad, are the same."""


def scattered(numbers: Dimensions, at: Positions, origin: Sequence[float]) -> Iterator[Any]:
    """Places on rings about the known points; about the origin where only guides hold the group."""
    for known in list(at.points.values())[:POINTS] or [origin]:
        for ring in RINGS:
            for k in range(SPOKES):
                reach, turn = ring * numbers.scale, tau * k / SPOKES
                yield numbers.space.moved_point(ARRAYS, known, (reach * cos(turn), reach * sin(turn)))


def closing(mechanism: Mechanism, system: System, starts: Sequence[Array], steps: int) -> list[Array]:
    """The states near the initial angles to which Newton's method leads from the starts.

    One if its angles are much nearer to those given than the angles of all others.
    """
    many = System(system.group, system.numbers, system.known, len(starts))
    with np.errstate(all="ignore"):
        found = newton(many, np.concatenate(starts), steps)
    states: list[Array] = []
    for k in np.nonzero(found.found)[0]:
        state = found.state[k : k + 1]
        if all(_apart(system, state, other) > SAME for other in states):
            states.append(state)
    near = [(_misfit(mechanism, system, state), state) for state in states]
    near = sorted((pair for pair in near if pair[0] <= NEAR), key=lambda pair: pair[0])
    if len(near) > 1 and near[0][0] < CLEARLY * near[1][0]:
        near = near[:1]
    return [state for _off, state in near]


def _apart(system: System, one: Array, other: Array) -> float:
    return float(np.max(np.abs(one - other))) / max(1.0, float(system.numbers.scale))


def _misfit(mechanism: Mechanism, system: System, state: Array) -> float:
    """Greatest difference of a link's angle from the one given [rad]."""
    at = system.at(ARRAYS, system.known, state)
    given = {link: mechanism.links[link].angle for link in system.group.links if link in at.angles}
    angles = {link: float(np.reshape(at.angles[link], -1)[0]) for link in given}
    return max(
        (abs(angles[link] - angle) for link, angle in given.items() if angle is not None),
        default=0.0,
    )
