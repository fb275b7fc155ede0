"""Many samples made one number: least, greatest, their difference, mean; samples that are not ok are left out."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.arrays import Arrays

Array: TypeAlias = npt.NDArray[np.float64]
Mask: TypeAlias = npt.NDArray[np.bool_]

REDUCTIONS = ("min", "max", "range", "mean")
FOLDS = frozenset((*REDUCTIONS, "sum"))
"""What formulas may do over samples; those of REDUCTIONS also stand alone."""


def folded(name: str, values: Array, ok: Mask) -> Array:
    """One number of the samples (axis 1) that are ok; NaN where none is.

    Parameters
    ----------
    name : one of FOLDS
    values : (lanes, n, ...)
    ok : (lanes, n)

    Notes
    -----
    Rounding of a mean stays below n eps times the mean of the absolute values. A NaN at an ok sample makes the
    whole NaN.
    """
    counted = ok.reshape(*ok.shape, *[1] * (values.ndim - 2))
    counts = counted.sum(axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        found = np.asarray(_fold(name, values, counted, counts))
    return np.where(counts > 0, found, np.nan)


def _fold(name: str, values: Array, counted: Mask, counts: Any) -> Any:
    if name in ("mean", "sum"):
        total = values.sum(axis=1, where=counted)
        return total / counts if name == "mean" else total
    least = values.min(axis=1, where=counted, initial=np.inf) if name != "max" else 0.0
    if name == "min":
        return least
    return values.max(axis=1, where=counted, initial=-np.inf) - least


class Folding(Arrays):
    """Namespace of a formula of the motion: functions on arrays (lanes, n), and folds that give (lanes, 1)."""

    def __init__(self, ok: Mask) -> None:
        self.ok = ok

    def fold(self, name: str, values: Any) -> Array:
        """One number a mechanism of what may vary from sample to sample."""
        return folded(name, np.broadcast_to(np.asarray(values, dtype=np.float64), self.ok.shape), self.ok)[
            :, None
        ]
