"""How well the dyads of many mechanisms close over one turn: squared sines of their transmission angles.

The squared sine is a group's radicand over its own greatest value. It falls through zero where the group begins to
be open, so it tells as well by how much a mechanism fails to turn.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import tau
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.arrays import ARRAYS
from centrode.analysis.repairing.candidates import Batch
from centrode.geometry.plane import Circle, dot, subtract
from centrode.kinematics.dyads import loci_of, solve_group
from centrode.kinematics.plan_evaluation import FixedSigns, Kinematics, SideChoices
from centrode.structure.constraints import Positions
from centrode.structure.groups import Aim, Group, Meet

Array: TypeAlias = npt.NDArray[np.float64]
Number: TypeAlias = Any

ABSENT = -1.0
"""Stands for a group where one before it is open."""


def squared_sines(batch: Batch, nodes: int) -> Array:
    """Squared sines (lanes, groups, nodes) of transmission angles over one turn; NaN behind an open group."""
    kinematics = batch.kinematics
    along = kinematics.path.initial + (np.arange(nodes) + 0.5) * (tau / nodes)
    at = kinematics.frame(ARRAYS, along[None, :])
    hooks = _Keeping(batch.signs)
    found = []
    with np.errstate(all="ignore"):
        for index, group in enumerate(kinematics.structure.groups):
            choices = SideChoices(hooks, index)
            size = _greatest(kinematics, group, at, choices)
            solve_group(group, ARRAYS, kinematics.numbers, at, choices)
            if size is not None:
                ratio = hooks.kept[index] / size
                found.append(np.broadcast_to(ratio, (batch.size, nodes)))
    if not found:
        return np.ones((batch.size, 1, nodes))
    return np.stack(found, axis=1)


class _Keeping(FixedSigns):
    """Fixed signs; radicands, and squares of divisors, are kept by their groups."""

    def __init__(self, signs: Mapping[int, Number]) -> None:
        super().__init__(ARRAYS, signs)
        self.kept: dict[int, Number] = {}

    def root(self, group: int, radicand: Number) -> Number:
        self.kept[group] = radicand
        return super().root(group, radicand)

    def divisor(self, group: int, divisor: Number) -> Number:
        self.kept[group] = divisor * divisor
        return divisor


def _greatest(kinematics: Kinematics, group: Group, at: Positions, choices: SideChoices) -> Number | None:
    """The radicand of a group at a transmission angle of 90 degrees; None for a group without one."""
    numbers = kinematics.numbers
    if isinstance(group, Aim):
        arm = subtract(at.points[group.target], at.points[group.pivot])
        return dot(arm, arm)
    if not isinstance(group, Meet):
        return None
    one, other = loci_of(group, ARRAYS, numbers, at, choices)
    if hasattr(one, "half"):
        return _sine(one) ** 2 * _sine(other) ** 2
    if not isinstance(one, Circle):
        return 1.0
    if not isinstance(other, Circle):
        return one.radius**2
    return (2.0 * one.radius * other.radius) ** 2


def _sine(circle: Any) -> Number:
    """Sine of a circle's arc on the sphere."""
    sine, cosine = circle.half
    return 2.0 * sine * cosine


def least(sines: Array) -> Array:
    """The least squared sine of every mechanism (lanes,)."""
    return np.asarray(least_by_sector(np.where(np.isnan(sines), np.inf, sines), 1).min(axis=1))


def least_by_sector(sines: Array, sectors: int) -> Array:
    """The least squared sine of every group in every sector of the turn: (lanes, groups * sectors).

    Between nodes it is that of the parabola through three of them, so that it changes smoothly with the mechanism.
    """
    lanes, groups, nodes = sines.shape
    known = np.where(np.isnan(sines), ABSENT, sines)
    width = nodes // sectors
    first = width * np.arange(sectors)
    lowest = known.reshape(lanes, groups, sectors, width).argmin(axis=3) + first
    before, here, behind = (np.take_along_axis(known, (lowest + step) % nodes, axis=2) for step in (-1, 0, 1))
    with np.errstate(all="ignore"):
        slope, bend = 0.5 * (behind - before), behind - 2.0 * here + before
        shift = np.clip(-slope / bend, -0.5, 0.5)
        below = np.where(bend > 0.0, shift * (slope + 0.5 * shift * bend), 0.0)
    smooth = np.isfinite(below) & (before != ABSENT) & (behind != ABSENT)
    return np.asarray((here + np.where(smooth, below, 0.0)).reshape(lanes, groups * sectors))
