"""Numbers of a description moved together or one by one, for differences of whole motions beside their derivatives."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

import centrode as ct
from samples import few

STEP = 2e-5
"""Of each number, as a part of it."""
SHARES = (1.0, -0.7, 0.9, 0.6, -0.8)
"""How far the numbers move beside each other: each by about as much as the others, and no two alike."""


def directions(mechanism: ct.Mechanism, paths: Sequence[str]) -> list[NDArray[np.float64]]:
    """Steps of all numbers: all of them at once; one by one where all samples are asked for.

    The derivative along a line is the sum of the numbers' own ones, of which each counts: one motion more on either
    side tells whether one of them is wrong, where one by one takes as many as there are numbers.
    """
    steps = STEP * np.abs([float(ct.value_at(mechanism, path)) for path in paths])
    together = [steps * SHARES[: len(paths)]]
    return few(together, [*together, *np.diag(steps)])


def moved_along(mechanism: ct.Mechanism, paths: Sequence[str], by: NDArray[np.float64]) -> ct.Mechanism:
    """The mechanism with each number moved by its step."""
    for path, step in zip(paths, by, strict=True):
        mechanism = ct.with_value(mechanism, path, ct.value_at(mechanism, path) + float(step))
    return mechanism
