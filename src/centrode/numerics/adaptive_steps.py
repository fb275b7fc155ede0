"""Adaptive steps of DOP853 on NumPy, one solution at a time, with a polynomial over each: no SciPy is loaded for them.

Steps are chosen as in E. Hairer, S. P. Norsett and G. Wanner, Solving Ordinary Differential Equations I, 2nd ed., 1993,
sections II.4 and II.10; the operations are those of SciPy's solver of this name, so that its numbers come out.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.numerics.dormand_prince import DENSE, FIFTH, MORE_A, MORE_C, STAGES, THIRD, A, B, C

Array: TypeAlias = npt.NDArray[np.float64]
Rates: TypeAlias = Callable[[float, Array], Array]

SAFETY, LEAST_FACTOR, GREATEST_FACTOR = 0.9, 0.2, 10.0
"""Part of the foretold step that is taken; least and greatest quotient of a step and the one before."""
ERROR_ORDER = 7
ROWS = STAGES + 1 + len(MORE_A)


def _rows_of(rows: Sequence[Sequence[float]]) -> list[Array]:
    return [np.array(row) for row in rows]


_A, _MORE_A = _rows_of(A), _rows_of(MORE_A)
_B, _FIFTH, _THIRD, _DENSE = np.array(B), np.array((*FIFTH, 0.0)), np.array((*THIRD, 0.0)), np.array(DENSE)


@dataclass(frozen=True)
class StepPolynomial:
    """The solution over one step, from `t_old` to `t`, as a polynomial of degree seven: terms (7, unknowns)."""

    t_old: float
    t: float
    before: Array
    terms: Array

    def __call__(self, time: npt.ArrayLike) -> Array:
        """The unknowns (unknowns, ...) at a time or at several (...)."""
        share = (np.asarray(time) - self.t_old) / (self.t - self.t_old)
        share = share[..., None] if share.ndim else share
        value = np.zeros((*np.shape(time), len(self.before)))
        for k, term in enumerate(self.terms[::-1]):
            value += term
            value *= share if k % 2 == 0 else 1.0 - share
        value += self.before
        return value.T


class AdaptiveSteps:
    """A solution that is taken from step to step.

    Attributes
    ----------
    t, y : where it has come to
    t_bound : where it ends
    """

    def __init__(
        self,
        rates: Rates,
        start: float,
        initial: Array,
        end: float,
        relative: float,
        absolute: Array,
        longest: float,
    ) -> None:
        self.rates, self.t, self.y, self.t_bound = rates, start, initial, end
        self.relative, self.absolute, self.longest = relative, absolute, longest
        self.direction = float(np.sign(end - start))
        self._rate = np.asarray(rates(start, initial))
        self._stages = np.empty((ROWS, len(initial)))
        self._length = self._first_length()
        self._before = start, initial, 0.0

    @property
    def is_finished(self) -> bool:
        """Whether the end is reached."""
        return self.direction * (self.t - self.t_bound) >= 0.0

    def step(self) -> bool:
        """Take a step; whether there is one that is longer than rounding."""
        shortest = 10.0 * abs(np.nextafter(self.t, self.direction * np.inf) - self.t)
        length, refused = min(max(self._length, shortest), self.longest), False
        while length >= shortest:
            there = self.t + length * self.direction
            if self.direction * (there - self.t_bound) > 0.0:
                there = self.t_bound
            step = there - self.t
            length = abs(step)
            value, rate = self._attempt(step)
            scale = self.absolute + np.maximum(np.abs(self.y), np.abs(value)) * self.relative
            error = self._error(step, scale)
            if error < 1.0:
                factor = GREATEST_FACTOR if error == 0.0 else SAFETY * error ** (-1.0 / (ERROR_ORDER + 1))
                factor = min(GREATEST_FACTOR, factor)
                # after a refusal no step grows at once
                self._length = length * (min(1.0, factor) if refused else factor)
                self._before = self.t, self.y, step
                self.t, self.y, self._rate = there, value, rate
                return True
            length *= max(LEAST_FACTOR, SAFETY * error ** (-1.0 / (ERROR_ORDER + 1)))
            refused = True
        return False

    def dense_output(self) -> StepPolynomial:
        """The polynomial over the last step."""
        start, before, step = self._before
        stages = self._stages
        for k, (weights, share) in enumerate(zip(_MORE_A, MORE_C, strict=True), start=STAGES + 1):
            stages[k] = self.rates(start + share * step, before + np.dot(stages[:k].T, weights) * step)
        moved, first = self.y - before, stages[0]
        terms = [moved, step * first - moved, 2.0 * moved - step * (self._rate + first)]
        return StepPolynomial(start, self.t, before, np.stack([*terms, *(step * np.dot(_DENSE, stages))]))

    def _attempt(self, step: float) -> tuple[Array, Array]:
        """The solution a step ahead, and its rate there."""
        stages = self._stages
        stages[0] = self._rate
        for k in range(1, STAGES):
            ahead = np.dot(stages[:k].T, _A[k]) * step
            stages[k] = self.rates(self.t + C[k] * step, self.y + ahead)
        value = self.y + step * np.dot(stages[:STAGES].T, _B)
        rate = stages[STAGES] = self.rates(self.t + step, value)
        return value, np.asarray(rate)

    def _error(self, step: float, scale: Array) -> float:
        """Estimate of the error over what is tolerated, from the embedded formulas of both orders."""
        stages = self._stages[: STAGES + 1].T
        fifth = float(np.linalg.norm(np.dot(stages, _FIFTH) / scale)) ** 2
        third = float(np.linalg.norm(np.dot(stages, _THIRD) / scale)) ** 2
        if fifth == third == 0.0:
            return 0.0
        return float(abs(step) * fifth / np.sqrt((fifth + 0.01 * third) * len(scale)))

    def _first_length(self) -> float:
        """Length of the first step: such that one of Euler's method, and one of order eight, changes little."""
        whole = abs(self.t_bound - self.t)
        scale = self.absolute + np.abs(self.y) * self.relative

        def size(vector: Array) -> float:
            return float(np.linalg.norm(vector / scale) / len(scale) ** 0.5)

        value, rate = size(self.y), size(self._rate)
        trial = 1e-6 if value < 1e-5 or rate < 1e-5 else 0.01 * value / rate
        trial = min(trial, whole)
        ahead = self.rates(self.t + trial * self.direction, self.y + trial * self.direction * self._rate)
        bend = size(np.asarray(ahead) - self._rate) / trial
        least = max(rate, bend)
        second = (
            max(1e-6, trial * 1e-3) if least <= 1e-15 else float((0.01 / least) ** (1.0 / (ERROR_ORDER + 1)))
        )
        return min(100.0 * trial, second, whole, self.longest)
