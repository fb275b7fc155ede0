"""Matrices inverted at many positions, with what rounding makes of each."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

Array: TypeAlias = npt.NDArray[np.float64]
Mask: TypeAlias = npt.NDArray[np.bool_]
EPSILON = 2.0**-52


@dataclass(frozen=True)
class Inverse:
    """Matrices (..., n, m), m at least n, and for each some inverse (..., m, n); NaN where there is none.

    Attributes
    ----------
    condition : (...)
        Condition number; infinite where a matrix is singular, NaN where the matrix itself is not known.
    """

    matrix: Array
    inverse: Array
    condition: Array

    def times(self, right: Array) -> Array:
        """Solutions (m, ...) for right sides (n, ...), with one step of refinement."""
        asked = np.moveaxis(right, 0, -1)[..., None]
        with np.errstate(invalid="ignore"):
            found = self.inverse @ asked
            found = found + self.inverse @ (asked - self.matrix @ found)
        return np.moveaxis(found[..., 0], -1, 0)

    @property
    def loss(self) -> Array:
        """What share of a solution rounding can make wrong; from 1 on no digit is left.

        Positions are solved with the same equations, so they carry rounding multiplied by the condition number;
        the matrix moves with them, and what is solved with it is off by that, multiplied by the condition number
        once more: its square times the rounding of a sum over a row.
        """
        with np.errstate(over="ignore"):
            return np.asarray(self.condition**2 * (EPSILON * self.matrix.shape[-2]))

    @property
    def useless(self) -> Mask:
        """Where rounding leaves no digit of a solution; not where nothing is known."""
        with np.errstate(invalid="ignore"):
            return np.asarray(self.loss >= 1.0)


def inverse_of(matrix: Array) -> Inverse:
    """Inverses of matrices (..., n, m): of their first n columns, where these are regular.

    Where they are not, the columns behind them may help: then it is the pseudo-inverse of the whole. Singular
    matrices and those with NaN are no error.
    """
    size, width = matrix.shape[-2:]
    inverse, condition = _square(matrix[..., :size])
    if width == size:
        return Inverse(matrix, inverse, condition)
    wide = np.zeros((*matrix.shape[:-2], width, size))
    wide[..., :size, :] = inverse
    found = Inverse(matrix, wide, condition)
    lost = found.useless
    if lost.any():
        wide[lost], condition[lost] = _pseudo(matrix[lost])
    return found


def _square(matrix: Array) -> tuple[Array, Array]:
    """Inverses and condition numbers in the norm of the greatest row sum."""
    known = np.isfinite(matrix.sum(axis=(-1, -2)))
    regular = known
    try:
        inverse: Array = np.asarray(np.linalg.inv(_where(regular, matrix)), dtype=np.float64)
    except np.linalg.LinAlgError:
        # a pivot is exactly zero somewhere: there the determinant has no sign, whatever the size of the others
        regular = known & (np.linalg.slogdet(_where(known, matrix))[0] != 0.0)
        inverse = np.asarray(np.linalg.inv(_where(regular, matrix)), dtype=np.float64)
    if not regular.all():
        inverse = np.where(regular[..., None, None], inverse, np.nan)
    with np.errstate(invalid="ignore", over="ignore"):
        condition = _norm(matrix) * _norm(inverse)
    return inverse, np.where(regular, condition, np.where(known, np.inf, np.nan))


def _where(regular: Mask, matrix: Array) -> Array:
    return matrix if regular.all() else np.where(regular[..., None, None], matrix, np.eye(matrix.shape[-1]))


def _norm(matrix: npt.NDArray[Any]) -> Any:
    return np.abs(matrix).sum(axis=-1).max(axis=-1)


def _pseudo(matrix: Array) -> tuple[Array, Array]:
    """Pseudo-inverses (k, m, n) and condition numbers of matrices (k, n, m) that are known."""
    left, values, right = np.linalg.svd(matrix, full_matrices=False)
    with np.errstate(divide="ignore", invalid="ignore"):
        condition = values[:, 0] / values[:, -1]
        inverse = np.swapaxes(right, 1, 2) @ (np.swapaxes(left, 1, 2) / values[..., None])
    return inverse, condition
