"""How well every constraint holds at every sample, redundant constraints and the unit length of axes included."""

from __future__ import annotations

import functools
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.arrays import ARRAYS
from centrode.errors import Status
from centrode.kinematics.evaluate import Kinematics
from centrode.kinematics.sampling import Samples, settle
from centrode.locale import _
from centrode.structure.constraints import Constraint, PointInLink, Positions

Array: TypeAlias = npt.NDArray[np.float64]
Number: TypeAlias = Any
Namespace: TypeAlias = Any


CLOSED = 1e-7
"""Greatest residual of a position: far above rounding, even next to limits and change points."""


@dataclass(frozen=True)
class UnitLength:
    """What a link's axes keep: their unit length, that is, the distances within the link."""

    link: str

    @property
    def label(self) -> str:
        """Name for messages."""
        return _("length of link {link}").format(link=self.link)


Kept: TypeAlias = Constraint | UnitLength


def residuals(kinematics: Kinematics, samples: Samples, at: Positions) -> tuple[Array, Kept]:
    """Greatest residual at each sample (lanes, n), from its positions, and the constraint that is worst of all.

    Lengths are measured in the mechanism's greatest length, angles in rad; NaN where there is no position.
    """
    worst = np.zeros(samples.status.shape)
    greatest: dict[Kept, float] = {}
    with np.errstate(all="ignore"):
        for kept, size, angular in each_residual(kinematics, ARRAYS, at):
            found = size / (1.0 if angular else kinematics.numbers.scale)
            worst = np.maximum(worst, found)
            greatest[kept] = float(np.nanmax(found, initial=0.0))
    if samples.status.any():
        worst[~np.isfinite(samples.columns[0]).all(axis=0)] = np.nan
    return worst, max(greatest, key=greatest.__getitem__)


def each_residual(kinematics: Kinematics, m: Namespace, at: Positions) -> Iterator[tuple[Kept, Number, bool]]:
    """Every constraint, drives included, with the size of its residual over any algebra, and whether it has no unit."""
    numbers, space = kinematics.numbers, kinematics.numbers.space
    for constraint in kinematics.structure.constraints:
        left = constraint.apart if isinstance(constraint, PointInLink) else constraint.residual
        size = [m.abs(r) for r in left(m, numbers, at)]
        yield constraint, functools.reduce(m.max, size), constraint.angular
    for link in kinematics.structure.mechanism.links:
        stretch = [m.abs(x) for x in space.stretch(space.attitude(at.poses[link]))]
        yield UnitLength(link), functools.reduce(m.max, stretch), True


def open_what_does_not_close(samples: Samples, residual: Array) -> None:
    """A sample at which a constraint does not hold is open: a redundant link of a batch may not fit everywhere."""
    with np.errstate(invalid="ignore"):
        broken = residual > CLOSED
    if broken.any():
        samples.status[broken] = Status.OPEN
        residual[broken] = np.nan
        settle(samples)
