"""Reduced inertia and moment of many mechanisms at once, over arrays or expressions."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.arrays import ARRAYS
from centrode.algebra.expression_functions import EXPRESSIONS
from centrode.algebra.jet_functions import JetFunctions
from centrode.dynamics.amounts import Diagram
from centrode.dynamics.burden import Burden
from centrode.dynamics.inertia import share
from centrode.dynamics.reducer import Reducer
from centrode.dynamics.states import Moving, State, getters_of
from centrode.errors import InputError
from centrode.kinematics.compiled.deciding import Untraceable
from centrode.kinematics.solve import Solved
from centrode.locale import _, mark

Array: TypeAlias = npt.NDArray[Any]
Number: TypeAlias = Any
Values: TypeAlias = Mapping[str, npt.ArrayLike]

REDUCED = ("reduced_inertia", "reduced_inertia_slope", "reduced_moment")
NODE_JETS = JetFunctions(EXPRESSIONS)


def check_reducible(solved: Solved) -> None:
    """Raise InputError for several drives, and for masses and loads that are not complete."""
    if solved.ready.kinematics.path.by_time:
        what = _("a sweep reduces masses and loads to one drive, and there are several")
        raise InputError("outputs", what, _("leave the reduced quantities out"))
    Burden.of(solved.ready.mechanism)


def reduced_number(name: str, solved: Solved, values: Values) -> Array:
    """One of REDUCED for every mechanism and sample (lanes, n); of expressions one node in a box (1, 1).

    `values` are those that vary, by their paths, one a mechanism. Raises Untraceable for what expressions cannot
    say; without a finite load there is NaN.
    """
    expressed = solved.points.dtype == object
    given = {
        path: np.asarray(x).item() if expressed else np.asarray(x)[:, None] for path, x in values.items()
    }
    burden = Burden.of(solved.ready.mechanism, given, EXPRESSIONS if expressed else ARRAYS)
    state = _state_of_nodes(solved, burden) if expressed else State.of(solved, _moving(solved, burden))
    if name == "reduced_moment":
        total: Number = 0.0
        for load in burden.loads:
            total = total + load.along(state, [effort.strength(state) for effort in load.efforts])
    else:
        which = REDUCED.index(name)
        total = sum((share(state, mass)[which] for mass in burden.masses), 0.0)
    if expressed:
        box = np.empty((1, 1), dtype=object)
        box[0, 0] = total
        return box
    known = np.where(state.exists, 0.0, np.nan)
    return np.asarray(np.broadcast_to(total, solved.status.shape) + known)


def _moving(solved: Solved, burden: Burden) -> Moving:
    """The speed that loads see, as `reduction_of` has it."""
    span, ready = solved.span, solved.ready
    if ready.mechanism.machine is None or not ready.parameter.is_uniform:
        return Moving(span.time, span.parameter, span.rate)
    speed = Reducer(ready, burden).default_rate
    assert speed is not None
    start = ready.kinematics.path.driven[0].start
    return Moving(
        ready.parameter.times(span.parameter, start, speed),
        span.parameter,
        speed * np.ones(len(span.parameter)),
    )


def _state_of_nodes(solved: Solved, burden: Burden) -> State:
    """The state at the one sample of a traced motion."""
    boxes = _moving(solved, burden)
    moving = Moving(*(np.asarray(x).ravel()[0] for x in (boxes.time, boxes.parameter, boxes.rate)))
    return state_of_nodes(solved, burden, moving)


def state_of_nodes(solved: Solved, burden: Burden, moving: Moving) -> State:
    """The same with time, parameter and rate as they are given."""
    if any(isinstance(effort.amount, Diagram) for load in burden.loads for effort in load.efforts):
        raise Untraceable(mark("indicator diagrams"))
    path, mechanism = solved.ready.kinematics.path, solved.ready.mechanism
    return State(
        mechanism,
        solved.layout,
        moving.time,
        moving.parameter,
        moving.rate,
        0,
        path.scale,
        getters_of(solved, lambda array: array[:, 0, 0]),
        m=NODE_JETS,
    )
