"""Change points of a free motion, passed on a half circle of complex time.

In a change point the closures lose rank: two motions cross there, and the equations of motion become 0/0. The motion that
goes on smoothly is an analytic function of time, so it is followed around the place, at a distance at which nothing is
lost: from the time before, along a half circle above the real axis, to as long behind. The same numbers give Taylor's
coefficients of everything on the disc (Cauchy's integral), from which instants near the change point are taken. A
singularity inside the circle, as where the closures only come near to losing rank, gives coefficients of negative powers:
then there is nothing to pass, and the motion is integrated straight on.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.numerics.initial_value_problems import C
from centrode.numerics.python_integrations import PythonIntegration

Array: TypeAlias = npt.NDArray[np.float64]
Complex: TypeAlias = npt.NDArray[np.complex128]

POINTS = 48
"""Steps along the half circle: an arc of 0.07 rad each, which the scheme follows to rounding."""
SINGULAR = 1e-8
"""Coefficients of negative powers above this share of what changes tell of a singularity inside the circle."""
UNRESOLVED = 1e-9
"""The last coefficients of positive powers below this share are small enough for the whole disc."""


@dataclass(frozen=True)
class Detour:
    """A piece of motion around a change point.

    Attributes
    ----------
    centre, radius : of the circle in complex time [s]
    coefficients : (followed, powers) of ((t - centre) / radius)
    singular : size of the coefficients of negative powers, over that of what changes
    unresolved : size of the last coefficients, in the same measure
    """

    centre: float
    radius: float
    coefficients: Array
    singular: float
    unresolved: float

    @property
    def begin(self) -> float:
        """Time before."""
        return self.centre - self.radius

    @property
    def end(self) -> float:
        """Time behind."""
        return self.centre + self.radius

    @property
    def is_passed(self) -> bool:
        """Whether everything is analytic on the disc."""
        return self.singular < SINGULAR and self.unresolved < UNRESOLVED

    def at(self, times: Array) -> Array:
        """What is followed at times within (followed, n)."""
        share = (np.asarray(times) - self.centre) / self.radius
        return np.asarray(np.polynomial.polynomial.polyval(share, self.coefficients.T))


def around(
    integration: PythonIntegration,
    parameters: Array,
    time: float,
    carried: Array,
    ahead: float,
    measured: Sequence[tuple[slice, Array]],
) -> Detour:
    """The motion from a time along a half circle to twice `ahead` later, as a detour.

    `integration` is complex; `measured` are parts of what is followed, one kind each, with what they are compared with.
    """
    centre, radius = time + ahead, ahead
    count = len(integration.problem.followed)
    given = [float(x) for x in parameters]
    here: list[Any] = [complex(x) for x in carried]
    fixed = here[count:]
    values = np.empty((POINTS + 1, count), dtype=np.complex128)
    values[0] = here[:count]
    step = np.pi / POINTS
    for k in range(POINTS):
        turned = [np.exp(-1j * (k + c) * step) for c in C]
        times = [complex(centre - radius * x) for x in turned]
        slopes = [complex(1j * radius * x) for x in turned]
        found, _stages = integration.stages(given, here, times, step, _entry(slopes))
        here = [*found, *fixed]
        values[k + 1] = found
        if not np.all(np.isfinite(values[k + 1])):
            return Detour(centre, radius, np.zeros((count, 1)), np.inf, np.inf)
    return _detour(centre, radius, values, measured)


def _entry(slopes: list[complex]) -> Callable[[int], complex]:
    return lambda stage: slopes[stage]


def _detour(centre: float, radius: float, values: Complex, measured: Sequence[tuple[slice, Array]]) -> Detour:
    """Taylor's coefficients from values on the half circle, which begins on the left."""
    upper = values[::-1]  # from the right, over the top, to the left
    lower = np.conj(upper[1:-1])[::-1]
    circle = np.concatenate([upper, lower])
    coefficients = np.fft.fft(circle, axis=0).T / len(circle)
    half = len(circle) // 2
    singular = unresolved = 0.0
    for part, units in measured:
        sizes = np.abs(coefficients[part]) / units[:, None]
        if not len(sizes):
            continue
        # what stands is compared with what moves
        moved = float(np.max(sizes[:, 1:half])) or 1.0
        imaginary = np.abs(coefficients[part, :half].imag) / units[:, None]
        singular = max(singular, float(np.max(sizes[:, half + 1 :])) / moved, float(np.max(imaginary)) / moved)
        unresolved = max(unresolved, float(np.max(sizes[:, half - 6 : half])) / moved)
    return Detour(centre, radius, coefficients[:, :half].real.copy(), singular, unresolved)
