"""Where a step meets the end of its leg or a standstill, and when a mechanism at rest breaks loose."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.simulation.course import RATE, VALUE
from centrode.dynamics.simulation.field import Field
from centrode.numerics.search import bisect, root

State: TypeAlias = npt.NDArray[np.float64]

REST_SCANS = 2000
"""Instants at which a mechanism at rest is asked whether it breaks loose, where something depends on time."""


def loosening(field: Field, value: float, first: float, last: float) -> float | None:
    """When a mechanism at rest breaks loose between two times; evenly spaced instants tell, bisection finds it."""
    times: list[float] = np.linspace(first, last, REST_SCANS).tolist()
    for before, after in pairwise(times):
        if field.leaving(after, value) != 0.0:

            def rests(time: State) -> npt.NDArray[np.bool_]:
                return np.asarray([field.leaving(float(t), value) == 0.0 for t in time])

            return float(bisect(rests, np.array([before]), np.array([after]))[1][0])
    return None


def first_event(
    dense: Any, before: float, solver: Any, low: float, high: float, sense: float
) -> tuple[float, int, float] | None:
    """The first time in a step at which the value leaves its range or the rate (where a sense counts) its sense."""
    found: list[tuple[float, int, float]] = []
    y = solver.y
    # at an end of its range a value that does not move outwards has not left it: from rest it may stay there for long
    above = y[VALUE] > high or (y[VALUE] == high and y[RATE] > 0.0)
    below = y[VALUE] < low or (y[VALUE] == low and y[RATE] < 0.0)
    targets = [(VALUE, high)] if above else [(VALUE, low)] if below else []
    if sense and y[1] * sense <= 0.0:
        targets.append((1, 0.0))
    for component, target in targets:

        def missed(t: float, component: int = component, target: float = target) -> float:
            return float(dense(t)[component]) - target

        start = missed(before)
        if start == 0.0 or start * missed(solver.t) > 0.0:
            when = solver.t if start * missed(solver.t) > 0.0 else _behind_start(missed, before, solver.t)
        else:
            when = root(missed, before, solver.t)
        found.append((when, component, target))
    return min(found, default=None)


def _behind_start(missed: Callable[[float], float], first: float, last: float) -> float:
    """Where a function that begins at zero comes back to it; the end where it does not."""
    places = np.linspace(first, last, 65)[1:]
    values = [missed(float(x)) for x in places]
    for k in range(1, len(places)):
        if values[k - 1] * values[k] <= 0.0:
            return root(missed, places[k - 1], places[k])
    return last


def arrived(
    rates: Callable[[float, State], State], t: float, y: State, component: int, target: float
) -> tuple[float, State]:
    """From a place very near to an event to the event itself, by Taylor's polynomial."""
    slopes = rates(t, y)
    speed = float(slopes[component])
    if speed == 0.0:
        return t, y
    step = (target - float(y[component])) / speed
    moved = y + step * slopes
    if component == VALUE:
        moved[VALUE] = target
    else:
        moved[VALUE] += 0.5 * slopes[1] * step * step
        moved[1] = target
    return t + step, moved
