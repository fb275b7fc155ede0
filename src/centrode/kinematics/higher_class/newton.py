"""Newton's method on the constraints of a group of higher class, at all places at once."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.kinematics.higher_class.loop_closure import LoopClosure, solve_places
from centrode.kinematics.higher_class.system import (
    GroupMotion,
    GroupSystem,
    Linear,
    Shift,
    Surroundings,
)
from centrode.kinematics.path import JETS
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.jets import Jet
from centrode.numerics.rounding_bounds import UNIT_ROUNDOFF
from centrode.structure.constraints import Entity

Array: TypeAlias = npt.NDArray[np.float64]
Lanes: TypeAlias = npt.NDArray[np.intp]
Mask: TypeAlias = npt.NDArray[np.bool_]
Number: TypeAlias = Any
Namespace: TypeAlias = Any

STEPS = 12
"""Newton steps before a place counts as not converged."""
COARSE = 1e-6
"""Greatest step of rounding alone, next to a limit."""
SMALL = 1e-9
"""After a step this small (in rad, or in the greatest length) the next is below rounding: convergence is quadratic."""


@dataclass(frozen=True)
class Converged:
    """Result of Newton's method: states (k, width), mask of the converged (k,), sizes of all steps (steps, k)."""

    state: Array
    found: Mask
    sizes: Array


Step: TypeAlias = Callable[[Lanes, Array], tuple[Array, Array]]
"""Of some of the places, from states there: the states a step on, and the sizes of the steps."""


def newton(system: GroupSystem, start: Array, steps: int = STEPS) -> Converged:
    """Newton's method from a state at every place; each place stops by itself, whatever its neighbours do."""
    closure = system.closure
    if closure is not None:
        free, whole = closure.free_of(start)
        beside = closure.known(system.known, len(start), dtype=start.dtype)[0]
        found = newton_by_loops(closure, beside, free, whole, steps)
        return replace(found, state=closure.state(closure.numbers(found.state, whole, beside)))

    def step(places: Lanes, state: Array) -> tuple[Array, Array]:
        part = system if len(places) == len(start) else system.take(places)
        motion, size = step_at(part, state)
        return part.move(state, motion), size

    return _iterate(step, start, steps)


def newton_by_loops(
    closure: LoopClosure, known: Array, start: Array, whole: Array, steps: int = STEPS
) -> Converged:
    """`newton` by the loops of a group, from free coordinates (k, free) beside what is known (k, known)."""

    def step(places: Lanes, free: Array) -> tuple[Array, Array]:
        left, matrix = closure.equations(closure.numbers(free, whole[places], known[places]))
        back = solve_places(matrix, left[:, :, None])[:, :, 0]
        return free - back, np.max(np.abs(back), axis=1)

    return _iterate(step, start, steps)


def _iterate(step: Step, start: Array, steps: int) -> Converged:
    state = start.copy()
    going = np.nonzero(np.isfinite(start).all(axis=1))[0]
    converged = np.zeros(len(start), dtype=bool)
    sizes = np.full((steps, len(start)), np.nan)
    last = np.full(len(start), np.inf)
    for k in range(steps):
        if not len(going):
            break
        moved, size = step(going, state[going])
        sizes[k, going] = size
        # a step of a thousand radians comes from a singular matrix: the place is given up
        good = np.isfinite(size) & (size < 1.0e3)
        state[going[good]] = moved[good]
        done = good & _is_last_step(last[going], size, k == steps - 1)
        last[going] = size
        converged[going[done]] = True
        going = going[good & ~done]
    return Converged(state, converged, sizes)


def _is_last_step(last: Array, size: Array, at_end: bool) -> Mask:
    """Where Newton's method has arrived with steps of these sizes."""
    done = is_rounding_step(last, size)
    # next to a limit rounding makes steps that are not small; they do not shrink any more
    return done | ((size <= COARSE) & (last <= COARSE)) if at_end else done


def step_at(system: GroupSystem, state: Array, linear: Linear | None = None) -> tuple[GroupMotion, Array]:
    """A Newton step from a state, and its size."""
    at = system.at(ARRAYS, system.known, state)
    linear = system.linear(at) if linear is None else linear
    moved, rest = linear.reduce([-x for x in system.residual(ARRAYS, at)])
    free = solve_places(linear.matrix, system.stack(rest)[:, :, None])[:, :, 0]
    return GroupMotion(linear.whole(moved, list(free.T)), list(free.T)), size_of(system, moved, free)


def size_of(system: GroupSystem, moved: Mapping[Entity, Shift], free: Array) -> Array:
    """Size of a step, in rad or in the greatest length."""
    size: Array = np.max(np.abs(free), axis=1)
    scale = 1.0 / system.numbers.scale
    for shift in moved.values():
        for x in shift:
            size = np.maximum(size, np.abs(x) * scale)
    return size


def is_rounding_step(last: Array, size: Array) -> Mask:
    """Where a step of some size after one of a last size is followed by nothing but rounding.

    Either the next step, quadratically smaller, is below it, or both are so small already that the matrix
    cannot give more digits.
    """
    with np.errstate(all="ignore"):
        # quadratic: the next step is C size^2 with C = size / last^2
        next_size = size * (size / last) ** 2
        return np.asarray((size <= SMALL) & ((last <= SMALL) | (next_size <= UNIT_ROUNDOFF)))


# Equations of a group bordered by the normal of a plane across its curve, and the motion of a step along it.

Shifts: TypeAlias = Mapping[Entity, Shift]


def bordered_equations(
    around: Surroundings, lanes: Lanes, parameter: Array, state: Array, along: Array | None
) -> tuple[GroupSystem, Linear, Shifts, Array, Shifts, Array]:
    """Equations at places: made linear, their residual, how they follow the parameter, and their matrix.

    It has a column for the parameter and, at the bottom, the normal of a plane if there is one.
    """
    known = around.known(Jet.variable(parameter, 1), lanes)
    system = around.system(known, lanes)
    linear = system.linear(system.at(JETS, system.known, state))
    values = system.residual(JETS, system.at(JETS, known, state))
    # jets of first order: values are the residual, slopes how the equations move with the parameter
    jets = [x if isinstance(x, Jet) else Jet((x, 0.0)) for x in values]
    moved, rest = linear.reduce([-x.coefficients[0] for x in jets])
    # how unknowns and right sides move with one unit of the parameter in units of the path, so that the
    # parameter's column is of the size of the others
    follow, pushed = linear.reduce([_times(x.coefficients[1], -around.unit) for x in jets])
    count, free = len(parameter), linear.pattern.free
    rows = free if along is None else free + 1
    matrix = np.empty((count, rows, free + 1))
    matrix[:, :free, :-1] = linear.matrix
    matrix[:, :free, -1] = -system.stack(pushed)
    if along is not None:
        matrix[:, -1] = along
    return system, linear, moved, system.stack(rest), follow, matrix


def _times(x: object, factor: float) -> object:
    return x if type(x) is float and x == 0.0 else x * factor  # type: ignore[operator]


def motion_along(linear: Linear, moved: Shifts, follow: Shifts, step: Array) -> GroupMotion:
    """The motion of a step (k, free + 1), the parameter's part included."""
    free, ahead = list(step[:, :-1].T), step[:, -1]
    together = {
        entity: tuple(x + y * ahead for x, y in zip(shift, follow[entity], strict=True))
        for entity, shift in moved.items()
    }
    return GroupMotion(linear.whole(together, free), free)
