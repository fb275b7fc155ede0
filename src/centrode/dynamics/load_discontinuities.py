"""Where loads jump or have a kink: places at which a coordinate turns or passes a row of a diagram, to rounding."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterator, Sequence
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.load_coordinates import Coordinate
from centrode.dynamics.loads import REST, AppliedLoad, LoadTable, LoadTerm
from centrode.dynamics.state import State
from centrode.numerics.search import foretold_brackets, newton_roots

Array: TypeAlias = npt.NDArray[np.float64]
StateAt: TypeAlias = Callable[[Array], State]
WithSlope: TypeAlias = Callable[[State], tuple[Array, Array]]

TOGETHER = 64.0 * 2.0**-52
"""Places nearer than this share of the parameter (of 1 where that is less) are one."""


def jumps_of(loads: Sequence[AppliedLoad], at: StateAt, nodes: Array) -> Array:
    """Values of the parameter, sorted, between the first and the last of the nodes.

    They are found where they belong to a change of sign between two nodes, or to two changes that the tangents at
    the nodes foretell.
    """
    turning = list(dict.fromkeys(c for effort in _load_terms(loads) for c in effort.switches))
    kinked: dict[Coordinate, set[float]] = {}
    for effort in _load_terms(loads):
        if effort.amount.levels:
            kinked.setdefault(effort.coordinate, set()).update(effort.amount.levels)
    tables = [effort.amount for effort in _load_terms(loads) if isinstance(effort.amount, LoadTable)]
    if not (turning or kinked or tables) or len(nodes) < 2:
        return np.empty(0)
    state = at(nodes)
    places = [np.array([x for table in tables for x in table.kinks(float(nodes[0]), float(nodes[-1]))])]
    for coordinate in turning:
        places += _turning_points(coordinate, at, nodes, state)
    for coordinate, levels in kinked.items():
        places.append(_passings(coordinate, np.array(sorted(levels)), at, nodes, state))
    return _distinct(np.sort(np.concatenate(places)))


def _load_terms(loads: Sequence[AppliedLoad]) -> Iterator[LoadTerm]:
    return (effort for load in loads for effort in load.efforts)


def _turning_points(coordinate: Coordinate, at: StateAt, nodes: Array, state: State) -> Iterator[Array]:
    """Places at which a coordinate turns round."""
    function = _slope_with_derivative(coordinate)
    value, slope = (np.broadcast_to(x, (1, len(nodes)))[0] for x in function(state))
    if _stands_still(value, state.scale):
        # the sign of a slope that is rounding alone changes everywhere
        return
    there = functools.partial(_at_values, function, at)
    yield newton_roots(there, *foretold_brackets(there, nodes, value, slope))
    # a node at which the slope is zero lies inside no change of sign
    yield nodes[value == 0.0]


def _stands_still(value: Array, scale: float) -> bool:
    """Whether a coordinate never moves, but for rounding: then it does not turn round either."""
    return bool(np.nanmax(np.abs(value), initial=0.0) <= REST * max(1.0, scale))


def _passings(coordinate: Coordinate, levels: Array, at: StateAt, nodes: Array, state: State) -> Array:
    """Places at which a coordinate passes one of several levels, all found together."""
    value = np.broadcast_to(coordinate.value(state), (1, len(nodes)))[0]
    low, high = np.minimum(value[:-1], value[1:]), np.maximum(value[:-1], value[1:])
    # levels strictly between the values at both nodes; one at a node is found as that node
    first, last = np.searchsorted(levels, low, "right"), np.searchsorted(levels, high, "left")
    counts = np.where(np.isfinite(low + high), np.maximum(last - first, 0), 0)
    cells = np.repeat(np.arange(len(counts)), counts)
    if not len(cells):
        return nodes[np.isin(value, levels)]
    # each cell once for every level passed in it: one array of roots
    passed = levels[np.concatenate([np.arange(i, i + n) for i, n in zip(first, counts, strict=True)])]

    def function(x: Array) -> tuple[Array, Array]:
        there = at(x)
        distances = np.broadcast_to(coordinate.value(there), (1, len(x)))[0] - passed
        return distances, np.broadcast_to(coordinate.slope(there).value, (1, len(x)))[0]

    return np.append(newton_roots(function, nodes[cells], nodes[cells + 1]), nodes[np.isin(value, levels)])


def _slope_with_derivative(coordinate: Coordinate) -> WithSlope:
    def function(state: State) -> tuple[Array, Array]:
        slope = coordinate.slope(state)
        return slope.value, slope.derivative(1)

    return function


def _at_values(function: WithSlope, at: StateAt, x: Array) -> tuple[Array, Array]:
    value, slope = (np.broadcast_to(part, (1, len(x)))[0] for part in function(at(x)))
    return value, slope


def _distinct(places: Array) -> Array:
    # the same turning may be met by several loads, and a level at a node from both sides
    if not len(places):
        return places
    apart = np.diff(places) > TOGETHER * np.maximum(1.0, np.abs(places[1:]))
    kept: Array = places[np.concatenate([[True], apart])]
    return kept
