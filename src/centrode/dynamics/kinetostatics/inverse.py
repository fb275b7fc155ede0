"""Matrices inverted at many positions, with what rounding makes of each."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

Array: TypeAlias = npt.NDArray[np.float64]
Mask: TypeAlias = npt.NDArray[np.bool_]
EPSILON = 2.0**-52


@dataclass(frozen=True)
class Inverse:
    """Inverted matrices (..., n, n); NaN where there is none.

    Attributes
    ----------
    condition : (...)
        Condition number in the norm of the greatest row sum; infinite where a matrix is singular, NaN where
        the matrix itself is not known.
    """

    matrix: Array
    inverse: Array
    condition: Array

    def times(self, right: Array) -> Array:
        """Solutions (n, ...) for right sides (n, ...), with one step of refinement."""
        asked = np.moveaxis(right, 0, -1)[..., None]
        with np.errstate(invalid="ignore"):
            found = self.inverse @ asked
            found = found + self.inverse @ (asked - self.matrix @ found)
        return np.moveaxis(found[..., 0], -1, 0)

    @property
    def loss(self) -> Array:
        """What share of a solution rounding can make wrong.

        Positions carry rounding multiplied by the condition number, for they are solved with the same matrix; the
        matrix moves with them, and what is solved with it once more: condition squared times the rounding of a
        sum over a row.
        """
        with np.errstate(over="ignore"):
            return np.asarray(self.condition**2 * (EPSILON * self.matrix.shape[-1]))


def inverse_of(matrix: Array) -> Inverse:
    """The inverses of matrices (..., n, n); singular ones and those with NaN are no error."""
    known = np.isfinite(matrix.sum(axis=(-1, -2)))
    safe = matrix if known.all() else np.where(known[..., None, None], matrix, np.eye(matrix.shape[-1]))
    regular = known
    try:
        inverse = np.linalg.inv(safe)
    except np.linalg.LinAlgError:
        # a pivot is exactly zero somewhere: there the sign of the determinant is zero, whatever its size
        regular = known & (np.linalg.slogdet(safe)[0] != 0.0)
        inverse = np.linalg.inv(np.where(regular[..., None, None], safe, np.eye(matrix.shape[-1])))
    condition = np.abs(safe).sum(axis=-1).max(axis=-1) * np.abs(inverse).sum(axis=-1).max(axis=-1)
    condition = np.where(regular, condition, np.where(known, np.inf, np.nan))
    if not regular.all():
        inverse = np.where(regular[..., None, None], inverse, np.nan)
    return Inverse(matrix, inverse, condition)
