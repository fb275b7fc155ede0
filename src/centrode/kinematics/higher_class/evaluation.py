"""Groups of higher class at any places: from their tracks, with derivatives or bounds as the algebra wants."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.kinematics.higher_class.curve_continuation import CurveTracks, Foretold
from centrode.kinematics.higher_class.loop_closure import LoopClosure, solve_places
from centrode.kinematics.higher_class.newton import newton, newton_by_loops, step_at
from centrode.kinematics.higher_class.system import (
    GroupSystem,
    Linear,
    Surroundings,
    add_in_shape,
    flatten_positions,
    needed_positions,
    plain,
)
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.jets import Jet, JetFunctions
from centrode.numerics.rounding_bounds import RoundedFunctions
from centrode.structure.constraints import Positions
from centrode.structure.dimensions import Dimensions

Array: TypeAlias = npt.NDArray[np.float64]
Lanes: TypeAlias = npt.NDArray[np.intp]
Mask: TypeAlias = npt.NDArray[np.bool_]
Number: TypeAlias = Any
Namespace: TypeAlias = Any

LEAST_PART = 1.0 / 64
"""Part of the way from the description's dimensions to a batch's below which the way is given up."""
NEAR = 0.3
"""Greatest first Newton step of a part of that way, in rad or in the greatest length."""


@dataclass(frozen=True)
class ConvergedPlaces:
    """Where a group is open, where it stands at a limit, and where Newton's method did not converge."""

    opened: Mask
    limit: Mask
    lost: Mask


def close(
    around: Surroundings,
    tracks: CurveTracks,
    m: Namespace,
    at: Positions,
    parameter: Array,
    lanes: Lanes | None,
    rough: bool = False,
) -> ConvergedPlaces:
    """Add the group's points and links to positions at parameters: (n,) for all lanes, or one lane for each.

    Rough positions are those of the track, after one Newton step where derivatives are wanted as well.
    """
    shape = (tracks.lanes, parameter.shape[-1]) if lanes is None else parameter.shape
    flat = np.broadcast_to(parameter, shape).reshape(-1)
    which = np.repeat(np.arange(tracks.lanes), shape[-1]) if lanes is None else lanes
    numbers = around.kinematics.take(which).numbers
    group = around.equations
    known = flatten_positions(needed_positions(group, at), shape)
    system = GroupSystem(group, numbers, known.map_numbers(plain), len(flat))
    loops = around.loops(known)
    foretold = tracks.foretell(flat, which, None if loops is None else loops.needed)
    if loops is not None:
        return _close_by_loops(loops, system, foretold, m, known, shape, at, rough)
    start = system.normalise(foretold.state)
    with np.errstate(all="ignore"):
        if rough:
            right, state, linear = ~(foretold.beyond | foretold.limit), start, None
            # derivatives need a place where the equations hold; values on the mesh do not
            if isinstance(m, JetFunctions):
                linear = system.linear(system.at(ARRAYS, system.known, state))
                state = system.move(state, step_at(system, state, linear)[0])
        else:
            converged = newton(system, start)
            linear = system.linear(system.at(ARRAYS, system.known, converged.state))
            # the sign of the determinant tells the two assemblies apart that meet in a limit: Newton's method
            # may find the other
            right = converged.found & (np.sign(np.linalg.det(linear.matrix)) == foretold.sense)
            state = np.where(right[:, None], converged.state, np.nan)
        # at a limit the matrix is singular and nothing converges: its state is known from the track
        state[foretold.limit] = foretold.state[foretold.limit]
        add_in_shape(_lift_states(system, m, known, state, linear), group, shape, at)
    lost = ~(right | foretold.limit | foretold.beyond)
    return ConvergedPlaces(*(mask.reshape(shape) for mask in (foretold.beyond, foretold.limit, lost)))


def _close_by_loops(
    loops: LoopClosure,
    system: GroupSystem,
    foretold: Foretold,
    m: Namespace,
    known: Positions,
    shape: tuple[int, ...],
    at: Positions,
    rough: bool,
) -> ConvergedPlaces:
    """`close` by the loops of the group."""
    order = max((jet.order for jet in _jets(known)), default=0) if isinstance(m, JetFunctions) else 0
    beside = loops.known(known, system.places, order + 1)
    free, whole = loops.free_of(foretold.state)
    with np.errstate(all="ignore"):
        if rough:
            right = ~(foretold.beyond | foretold.limit)
            if isinstance(m, JetFunctions):
                left, matrix = loops.equations(loops.numbers(free, whole, beside[0]))
                free -= solve_places(matrix, left[:, :, None])[:, :, 0]
        else:
            converged = newton_by_loops(loops, beside[0], free, whole)
            numbers = loops.numbers(converged.state, whole, beside[0])
            right = converged.found & (np.sign(np.linalg.det(loops.matrix(numbers))) == foretold.sense)
            free = np.where(right[:, None], converged.state, np.nan)
        free[foretold.limit] = loops.free_of(foretold.state[foretold.limit])[0]
        numbers = loops.numbers(free, whole, beside[0])
        if isinstance(m, RoundedFunctions):
            state = loops.state(numbers)
            linear = system.linear(system.at(ARRAYS, system.known, state))
            found = system.at(m, known, state, system.bounds(known, state, linear))
        else:
            found = Positions({}, {}, {}, {})
            series = loops.series(numbers, beside, loops.matrix(numbers)) if order else numbers
            loops.positions(series, found)
        add_in_shape(found, system.group, shape, at)
    lost = ~(right | foretold.limit | foretold.beyond)
    return ConvergedPlaces(*(mask.reshape(shape) for mask in (foretold.beyond, foretold.limit, lost)))


def follow(
    around: Surroundings, tracks: CurveTracks, at: Positions, parameter: Array, lanes: Lanes, steps: int
) -> None:
    """Add the group's points and links along ways of complex parameters, NaN from where Newton's method fails.

    The ways stand one after the other, of so many steps each, and begin with a real parameter.
    """
    group = around.equations
    known = flatten_positions(needed_positions(group, at), parameter.shape)
    first = np.arange(0, len(parameter), steps)
    # a way begins with a real parameter, where the track knows the state; from there it goes through complex
    # ones
    state: Any = tracks.foretell(parameter[first].real, lanes[first]).state + 0j
    loops = around.loops(known)
    if loops is not None:
        found = Positions({}, {}, {}, {})
        loops.positions(_follow_by_loops(loops, known, state, first, len(parameter)), found)
    else:
        system = GroupSystem(group, around.kinematics.take(lanes).numbers, known, len(parameter))
        state = system.take(first).normalise(state)
        states: Any = np.empty((len(parameter), state.shape[1]), dtype=complex)
        for k in range(steps):
            converged = newton(system.take(first + k), state)
            # each place starts from the one before: along a way there is no track to start from
            state = np.where(converged.found[:, None], converged.state, np.nan)
            states[first + k] = state
        found = system.at(ARRAYS, known, states)
    add_in_shape(found, group, parameter.shape, at)


def _follow_by_loops(loops: LoopClosure, known: Positions, state: Array, first: Lanes, places: int) -> Array:
    """Numbers of a group along ways that begin at places with states."""
    beside = loops.known(known, places, dtype=complex)[0]
    free, whole = loops.free_of(state)
    numbers = np.empty((places, loops.width), dtype=complex)
    before = free
    for k in range(places // len(first)):
        # each place starts from the two before: along a way there is no track to start from
        start = 2.0 * free - before if k > 1 else free
        converged = newton_by_loops(loops, beside[first + k], start, whole)
        before, free = free, np.where(converged.found[:, None], converged.state, np.nan)
        numbers[first + k] = loops.numbers(free, whole, beside[first + k])
    return numbers


def _lift_states(
    system: GroupSystem, m: Namespace, known: Positions, state: Array, linear: Linear | None
) -> Positions:
    """Converged states over the algebra of the known positions."""
    if linear is None:
        return system.at(m, known, state)
    if isinstance(m, JetFunctions):
        order = max((jet.order for jet in _jets(known)), default=0)
        motion = system.jets(known, state, linear, order) if order else None
        return system.at(m, known, state, motion)
    if isinstance(m, RoundedFunctions):
        return system.at(m, known, state, system.bounds(known, state, linear))
    return system.at(m, known, state)


def _jets(known: Positions) -> Iterator[Jet]:
    yield from (x for x in known.drives.values() if isinstance(x, Jet))
    yield from (x for v in known.points.values() for x in v if isinstance(x, Jet))
    yield from (x for pose in known.poses.values() for v in pose for x in v if isinstance(x, Jet))


def starts(around: Surroundings, nominal: Dimensions, start: Positions, initial: float, lanes: int) -> Array:
    """States (lanes, width) in the initial position; those of a batch by way of the description's own dimensions.

    NaN where the way fails, or crosses a position in which the group is singular.
    """
    group = around.equations
    own = GroupSystem(group, nominal, start, 1)
    state = np.repeat(own.state_of(start), lanes, axis=0)
    if all(isinstance(x, float) for x in numbers_of(around.kinematics.numbers)):
        return state
    # a change of this sign on the way means a singular position was crossed, and another assembly may have
    # been reached
    sense = sense_of(own, state[:1])
    done, part = np.zeros(lanes), np.ones(lanes)
    while (going := np.nonzero((done < 1.0) & (part >= LEAST_PART))[0]).size:
        aim = np.minimum(done[going] + part[going], 1.0)
        numbers = around.kinematics.take(going).numbers
        between = around.with_numbers(blend_dimensions(nominal, numbers, aim), going)
        everyone = np.arange(len(going))
        known = between.known_at(np.full(len(going), initial), everyone)
        system = between.system(known, everyone)
        with np.errstate(all="ignore"):
            converged = newton(system, state[going])
            good = (
                converged.found & (sense_of(system, converged.state) == sense) & (converged.sizes[0] < NEAR)
            )
        state[going[good]] = converged.state[good]
        done[going[good]] = aim[good]
        # as a step size: doubled after success, halved after failure
        part[going] *= np.where(good, 2.0, 0.5)
    state[done < 1.0] = np.nan
    return state


def sense_of(system: GroupSystem, state: Array) -> Array:
    """Sign of the determinant of the equations at states."""
    matrix = system.linear(system.at(ARRAYS, system.known, state)).matrix
    return np.asarray(np.sign(np.linalg.det(matrix)), dtype=np.float64)


def numbers_of(numbers: Dimensions) -> list[Number]:
    """Every number of the dimensions, in one order."""
    used: list[Number] = []

    def note(x: Number) -> Number:
        used.append(x)
        return x

    numbers.map_numbers(note)
    return used


def blend_dimensions(first: Dimensions, second: Dimensions, part: Array) -> Dimensions:
    """Dimensions (lanes,) part of the way from the first to the second, exactly these at the end."""
    from_first = iter(numbers_of(first))

    def between(x: Number) -> Number:
        y = next(from_first)
        # at the end the batch's own bits: y + 1 (x - y) need not round to x
        return x if isinstance(x, float) else np.where(part == 1.0, x, y + part * (x - y))

    return second.map_numbers(between)
