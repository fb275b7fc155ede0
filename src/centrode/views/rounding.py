"""What rounding leaves of zero, in numbers that are shown beside greater ones."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

Array: TypeAlias = npt.NDArray[np.float64]

ROUNDING = 1e-12
"""Share of the greatest number beside it below which a number is rounding."""


def without_rounding(values: npt.ArrayLike) -> Array:
    """Numbers (..., n) with zero in place of what is rounding beside the greatest of each n."""
    numbers = np.asarray(values, dtype=np.float64)
    size = np.max(np.abs(numbers), axis=-1, keepdims=True, initial=0.0)
    return np.where(np.abs(numbers) < ROUNDING * size, 0.0, numbers)
