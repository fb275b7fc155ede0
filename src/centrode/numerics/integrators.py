"""The integrators of initial value problems under one name: machine code, and Python where there is none."""

from __future__ import annotations

import functools
import importlib
from collections.abc import Callable
from typing import Any, Protocol, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.numerics.executors import ARRAYS, choose_executor
from centrode.numerics.initial_value_problems import InitialValueProblem
from centrode.numerics.python_integrations import PythonIntegration

Array: TypeAlias = npt.NDArray[np.float64]

# llvmlite is heavy and may be missing
_integrations = functools.partial(importlib.import_module, "centrode.numerics.machine_code.integrations")


class Integrator(Protocol):
    """Takes steps of a problem, lane by lane."""

    def run(self, parameters: Array, state: Array, attempts: int, rows: Array | None = None) -> Array:
        """See `machine_code.integrations.Integration.run`."""

    def attempt_of(self, parameters: Array, before: Array, after: Array) -> Callable[[], None]:
        """See `machine_code.integrations.Integration.attempt_of`."""


def integrator_of(
    problem: InitialValueProblem, executor: str = "auto", width: int | None = 1, hasty: bool = False
) -> Integrator:
    """The integrator of a problem by an executor; `width` lanes at once, as many as a register holds if None.

    Raises
    ------
    ImportError
        Machine code is requested, and llvmlite (the extra `fast`) is not installed.
    """
    if choose_executor(executor) == ARRAYS:
        return PythonIntegration(problem)
    made: Any = _integrations().integration_of(problem, width, hasty)
    return made  # type: ignore[no-any-return]
