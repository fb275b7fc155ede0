"""Numbers over samples put together as arrays, samples first."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

Array: TypeAlias = npt.NDArray[np.float64]
Number: TypeAlias = Any


def column(value: Number, samples: int) -> Array:
    """One number over the samples (n), from arrays (1, n) or a plain number."""
    return np.array(np.broadcast_to(value, (1, samples))[0], dtype=np.float64)


def columns(values: Sequence[Number], samples: int) -> Array:
    """Numbers over the samples (n, numbers)."""
    found = np.empty((samples, len(values)))
    for k, value in enumerate(values):
        found[:, k] = column(value, samples)
    return found


def tables(values: Sequence[Sequence[Number]], width: int, samples: int) -> Array:
    """Rows of so many numbers over the samples (n, rows, width)."""
    return columns([value for row in values for value in row], samples).reshape(samples, len(values), width)
