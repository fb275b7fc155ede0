"""Signs that flip at change points, as expressions: the places of the change points are numbers of the mechanism."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.expression_functions import EXPRESSIONS
from centrode.algebra.expressions import Operand, variable
from centrode.kinematics.branches import Branches
from centrode.kinematics.compiled.variables import PARAMETER
from centrode.kinematics.ready import Ready

Array: TypeAlias = npt.NDArray[np.float64]

MOST = 16
"""Change points of a group that a sign knows at most: each costs a comparison or two at every sample."""


def signs_of(ready: Ready, crossings: Mapping[int, int]) -> dict[int, Operand]:
    """The sign of each group at a parameter, as `Branches.sign` has it, with so many change points."""
    initial = ready.kinematics.path.initial
    signs = ready.assembled.signs
    return {group: _sign(group, sign, initial, crossings.get(group, 0)) for group, sign in signs.items()}


def _sign(group: int, sign: float, initial: float, count: int) -> Operand:
    m, found = EXPRESSIONS, sign
    if not count:
        return sign
    low, high = m.min(variable(PARAMETER), initial), m.max(variable(PARAMETER), initial)
    for k in range(count):
        at = variable(crossing_of(group, k))
        # a change point that is not there is NaN, and lies nowhere between
        between = m.both(m.less(low, at), m.less(at, high))
        found = m.where(between, -found, found)  # type: ignore[assignment]
    return found


def crossing_of(group: int, k: int) -> str:
    """Name of the place of a change point of a group."""
    return f"change point {k} of {group}"


def counts_of(branches: Branches) -> dict[int, int]:
    """How many change points the signs of a batch have to know: the next power of two, so that kernels are few."""
    if not branches.smooth:
        return {}
    return {group: 1 << (table.shape[1] - 1).bit_length() for group, table in branches.crossings.items()}


def values_of(branches: Branches, counts: Mapping[int, int]) -> dict[str, Array]:
    """The places of the change points: name -> (lanes,), NaN where there is none."""
    found = {}
    for group, count in counts.items():
        table = branches.crossings[group]
        for k in range(count):
            known = table[:, k] if k < table.shape[1] else np.full(branches.lanes, np.nan)
            found[crossing_of(group, k)] = known
    return found
