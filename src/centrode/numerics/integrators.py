"""The integrators of initial value problems under one name: machine code, and Python where there is none."""

from __future__ import annotations

import functools
import importlib
from typing import Any, Protocol, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.numerics.executors import ARRAYS, choose_executor
from centrode.numerics.initial_value_problems import InitialValueProblem

Array: TypeAlias = npt.NDArray[np.float64]

HEADER = 4
"""Rows of a state before what is carried: time, size of the next step, attempts, rows that were written."""

# llvmlite is heavy and may be missing
_integrations = functools.partial(importlib.import_module, "centrode.numerics.machine_code.integrations")


class Integrator(Protocol):
    """Takes steps of a problem, lane by lane."""

    def run(self, parameters: Array, state: Array, attempts: int, rows: Array | None = None) -> Array:
        """See `machine_code.integrations.Integration.run`."""


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
        raise NotImplementedError
    made: Any = _integrations().integration_of(problem, width, hasty)
    return made  # type: ignore[no-any-return]
