"""Equations of a group bordered by the normal of a plane across its curve, and the motion of a step along it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.jets import Jet
from centrode.kinematics.higher_class.reduction import Linear, Shift
from centrode.kinematics.higher_class.surroundings import Surroundings
from centrode.kinematics.higher_class.system import Motion, System
from centrode.kinematics.paths import JETS
from centrode.structure.constraints import Entity

Array: TypeAlias = npt.NDArray[np.float64]
Lanes: TypeAlias = npt.NDArray[np.intp]
Shifts: TypeAlias = Mapping[Entity, Shift]


def bordered(
    around: Surroundings, lanes: Lanes, parameter: Array, state: Array, along: Array | None
) -> tuple[System, Linear, Shifts, Array, Shifts, Array]:
    """Equations at places: made linear, their residual, how they follow the parameter, and their matrix.

    It has a column for the parameter and, at the bottom, the normal of a plane if there is one.
    """
    known = around.known(Jet.variable(parameter, 1), lanes)
    system = around.system(known, lanes)
    linear = system.linear(system.at(JETS, system.known, state))
    values = system.residual(JETS, system.at(JETS, known, state))
    jets = [x if isinstance(x, Jet) else Jet((x, 0.0)) for x in values]
    moved, rest = linear.reduced([-x.coefficients[0] for x in jets])
    # how unknowns and right sides move with one unit of the parameter
    follow, pushed = linear.reduced([_times(x.coefficients[1], -around.unit) for x in jets])
    count, free = len(parameter), linear.pattern.free
    rows = free if along is None else free + 1
    matrix = np.empty((count, rows, free + 1))
    matrix[:, :free, :-1] = linear.matrix
    matrix[:, :free, -1] = -system.stacked(pushed)
    if along is not None:
        matrix[:, -1] = along
    return system, linear, moved, system.stacked(rest), follow, matrix


def _times(x: object, factor: float) -> object:
    return x if type(x) is float and x == 0.0 else x * factor  # type: ignore[operator]


def motion_along(linear: Linear, moved: Shifts, follow: Shifts, step: Array) -> Motion:
    """The motion of a step (k, free + 1), the parameter's part included."""
    free, ahead = list(step[:, :-1].T), step[:, -1]
    together = {
        entity: tuple(x + y * ahead for x, y in zip(shift, follow[entity], strict=True))
        for entity, shift in moved.items()
    }
    return Motion(linear.whole(together, free), free)
