"""Equations of a mechanism over several kinds of numbers, and their solutions.

The formulas take doubles, complex numbers (for derivatives by the complex step) and numbers of mpmath alike.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import mpmath
import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
COMPLEX_STEP = 1e-30
DIGITS = 50
STEP = mpmath.mpf(10) ** -12
"""Of difference quotients at `DIGITS`."""


@dataclass(frozen=True)
class Functions:
    """Functions of a kind of numbers."""

    cos: Callable[[Any], Any]
    sin: Callable[[Any], Any]
    sqrt: Callable[[Any], Any]


ARRAYS = Functions(np.cos, np.sin, np.sqrt)
EXACT = Functions(mpmath.cos, mpmath.sin, mpmath.sqrt)


class Equations(ABC):
    """Equations in as many unknowns, with the crank's angle q beside; `start` solves them at `begun`.

    `points` are named, `length` is the size of the mechanism.
    """

    points: list[str]
    start: Array
    begun: float
    length: float

    @property
    def size(self) -> int:
        """Number of unknowns."""
        return len(self.start)

    @abstractmethod
    def residual(self, x: Sequence[Any], q: Any, m: Functions) -> list[Any]:
        """What vanishes where the crank stands at q."""

    @abstractmethod
    def places(self, x: Sequence[Any], q: Any, m: Functions) -> list[Any]:
        """Coordinates of all points, one after the other."""

    def far(self, x: Array) -> float:
        """How far away the farthest point is, in some unit."""
        return float(np.max(abs(x)))

    # --- doubles

    def jacobian(self, x: Array, q: float) -> Array:
        """Derivatives of the equations by the unknowns and, in the last column, by q."""
        size = self.size
        given = x[:, None] + 1j * COMPLEX_STEP * np.eye(size, size + 1)
        driven = q + 1j * COMPLEX_STEP * np.eye(1, size + 1, size)[0]
        rows = self.residual(list(given), driven, ARRAYS)
        return np.array([np.broadcast_to(np.imag(row), size + 1) for row in rows]) / COMPLEX_STEP

    def values(self, x: Array, q: float) -> Array:
        """The equations at doubles."""
        return np.array([float(row) for row in self.residual(list(x), q, ARRAYS)])

    def closed(self, x: Array, q: float) -> Array | None:
        """The solution near a guess, by Newton's method; None where it does not converge."""
        x = x.copy()
        for _ in range(12):
            try:
                step = np.linalg.solve(self.jacobian(x, q)[:, :-1], self.values(x, q))
            except np.linalg.LinAlgError:
                return None
            x -= step
            size = float(np.max(abs(step)))
            if not size < 1.0:
                return None
            if size < 1e-13 * (1.0 + float(np.max(abs(x)))):
                return x
        return x if size < 1e-10 else None

    # --- numbers of mpmath

    def exact(self, x: Array, value: float) -> tuple[list[Any], list[Any], list[Any]]:
        """Coordinates of all points with two derivatives by q, from a solution in doubles."""
        inverse = np.linalg.inv(self.jacobian(x, value)[:, :-1])
        rows = [[mpmath.mpf(float(u)) for u in row] for row in inverse]
        with mpmath.workdps(DIGITS):
            near = [mpmath.mpf(float(u)) for u in x]
            ends = []
            for k in (-1, 0, 1):
                near = self._polished(near, mpmath.mpf(value) + k * STEP, rows)
                ends.append(self.places(near, mpmath.mpf(value) + k * STEP, EXACT))
            before, here, after = ends
            first = [(c - a) / (2 * STEP) for a, c in zip(before, after, strict=True)]
            second = [(a - 2 * b + c) / STEP**2 for a, b, c in zip(before, here, after, strict=True)]
        return here, first, second

    def _polished(self, x: list[Any], q: Any, inverse: list[list[Any]]) -> list[Any]:
        for _ in range(12):
            wrong = self.residual(x, q, EXACT)
            steps = [mpmath.fdot(row, wrong) for row in inverse]
            x = [a - b for a, b in zip(x, steps, strict=True)]
            if max(abs(step) for step in steps) < mpmath.mpf(10) ** (-DIGITS + 4):
                return x
        raise ArithmeticError("Newton's method does not converge in many digits")
