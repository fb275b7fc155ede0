"""Initial value problems on plain Python numbers, real or complex: without machine code, and off the real axis."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.numerics.dormand_prince import FIFTH, THIRD, A, B, C
from centrode.numerics.initial_value_problems import (
    BEFORE,
    END,
    HEADER,
    OF_FIFTH,
    OF_THIRD,
    SIZE,
    SMALLEST,
    STEP,
    TIME,
    InitialValueProblem,
)
from centrode.numerics.python_functions import Function, python_function

Array: TypeAlias = npt.NDArray[np.float64]
Number: TypeAlias = Any


@dataclass(frozen=True)
class PythonIntegration:
    """A problem as functions of Python; see `machine_code.integrations.Integration`."""

    problem: InitialValueProblem
    is_complex: bool = False

    @cached_property
    def rates(self) -> Function:
        """(time, parameters, carried) -> derivatives of what is followed."""
        return python_function(self.problem.of_rates, self._arguments(TIME), self.is_complex)

    @cached_property
    def closing(self) -> Function:
        """(time, step, parameters, carried) -> what is carried behind a step."""
        return python_function(self.problem.of_closing, self._arguments(TIME, STEP), self.is_complex)

    @cached_property
    def _control(self) -> Function:
        followed = self.problem.unknowns
        marked = [prefix + name for prefix in (OF_FIFTH, OF_THIRD, BEFORE) for name in followed]
        names = [STEP, SIZE, *self.problem.parameters, *self.problem.carried_names, *marked]
        return python_function(self.problem.of_control, names, self.is_complex)

    def _arguments(self, *first: str) -> list[str]:
        return [*first, *self.problem.parameters, *self.problem.carried_names]

    def stages(
        self,
        parameters: Sequence[float],
        carried: Sequence[Number],
        times: Sequence[Number],
        step: Number,
        slope: Any,
    ) -> tuple[list[Number], list[list[Number]]]:
        """What is followed behind a step, and the rates of all stages.

        `times` are those of the stages; rates are multiplied by `slope(stage)`, the derivative of time by what steps
        are taken in.
        """
        count = len(self.problem.unknowns)
        start, fixed = list(carried[:count]), list(carried[count:])
        stages: list[list[Number]] = []
        for number, (row, time) in enumerate(zip(A, times, strict=True)):
            here = _advanced_values(start, step, row, stages)
            factor = slope(number)
            stages.append([x * factor for x in self.rates([time, *parameters, *here, *fixed])])
        return _advanced_values(start, step, B, stages), stages

    def run(self, parameters: Array, state: Array, attempts: int, rows: Array | None = None) -> Array:
        """Attempts from a state, as `Integration.run` takes them."""
        after = np.array(state, dtype=np.float64)
        for lane in range(after.shape[1]):
            given = [float(x) for x in (parameters[:, lane] if parameters.shape[1] > 1 else parameters[:, 0])]
            self._run_lane(given, after[:, lane], attempts, rows)
        return after

    def attempt_of(self, parameters: Array, before: Array, after: Array) -> Callable[[], None]:
        """A function that takes one attempt, as that of `Integration.attempt_of`."""

        def attempt() -> None:
            after[:] = self.run(parameters, before, 1)

        return attempt

    def _run_lane(self, parameters: list[float], state: Array, attempts: int, rows: Array | None) -> None:
        problem = self.problem
        named = dict(zip(problem.parameters, parameters, strict=True))
        count = len(problem.unknowns)
        carried = [float(x) for x in state[HEADER:]]
        time, size = float(state[0]), float(state[1])
        limit = problem.carried_names.index(problem.limit) if problem.limit else None
        guard = problem.carried_names.index(problem.guard) if problem.guard else None
        tried = written = 0
        while tried < attempts and (rows is None or written < len(rows)):
            left = named[END] - time
            if limit is not None:
                size = min(size, carried[limit])
            if not (left > 0.0 and size > named[SMALLEST]) or (guard is not None and carried[guard] != 0.0):
                break
            step = min(left, size)
            values, stages = self.stages(
                parameters, carried, [time + c * step for c in C], step, lambda _stage: 1.0
            )
            errors = [_advanced_values([0.0] * count, 1.0, weights, stages) for weights in (FIFTH, THIRD)]
            told = [
                step,
                size,
                *parameters,
                *values,
                *carried[count:],
                *errors[0],
                *errors[1],
                *carried[:count],
            ]
            taken, further = self._control(told)
            tried += 1
            if taken > 0.5:
                time = named[END] if left <= size else time + step
                carried = list(self.closing([time, step, *parameters, *values, *carried[count:]]))
                if rows is not None:
                    rows[written] = [time, *carried]
                written += 1
            size = further
        state[0], state[1], state[2], state[3] = time, size, tried, written
        state[HEADER:] = carried


def _advanced_values(
    start: Sequence[Number], step: Number, weights: Sequence[float], stages: Sequence[Sequence[Number]]
) -> list[Number]:
    used = [(weight, stage) for weight, stage in zip(weights, stages, strict=False) if weight]
    return [x + step * sum(weight * stage[k] for weight, stage in used) for k, x in enumerate(start)]
