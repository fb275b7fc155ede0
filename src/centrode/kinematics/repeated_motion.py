"""The motion of a description that is requested again and again: by machine code once that pays.

The arrays take a few milliseconds, nearly all of it calls of NumPy on short arrays; tracing and compiling the plan
takes some twenty times as long, a motion by it a quarter. Its bits are those of the arrays, but for the last of
residuals.
"""

from __future__ import annotations

import functools
import importlib
from typing import Any

from centrode.kinematics.path import SampleGrid
from centrode.kinematics.preparation import Ready
from centrode.kinematics.solve import Solved, solve
from centrode.model.kept_values import KeptValues

# what machine code needs is not loaded for one motion
_kernels = functools.partial(importlib.import_module, "centrode.kinematics.machine_code.motion_kernels")

WORTH_COMPILING = 20
"""Requests from which on a motion is compiled: until then the arrays took as long as that takes."""
MOST_SAMPLES = 10_000
"""Of more samples the numbers themselves take the arrays their time, and not the calls."""
MOST_KEPT = 16


class RepeatedMotion:
    """Motion of one description at one grid of samples, that counts how often it is requested."""

    def __init__(self) -> None:
        self._requests = 0
        self._kernels: Any = None

    @property
    def is_compiled(self) -> bool:
        """Whether machine code computes it."""
        return self._kernels is not None

    def solve(self, ready: Ready, span: SampleGrid) -> Solved:
        """The motion at the samples."""
        self._requests += 1
        if self._requests == WORTH_COMPILING:
            self._kernels = _kernels().MotionKernels.of(ready, span)
        found: Solved | None = None if self._kernels is None else self._kernels.solve()
        if found is not None:
            return found
        # a motion with events has them at every request: it stays with the arrays
        self._kernels = None
        return solve(ready, span)


_kept = KeptValues[RepeatedMotion](MOST_KEPT)


def repeated_motion(ready: Ready, span: SampleGrid) -> RepeatedMotion:
    """The motion of a description at samples, kept since it was requested first."""
    if len(span.parameter) > MOST_SAMPLES:
        return RepeatedMotion()
    grid = b"".join(x.tobytes() for x in (span.time, span.parameter, span.rate, span.second_rate))
    return _kept.get(ready.mechanism, grid, RepeatedMotion)
