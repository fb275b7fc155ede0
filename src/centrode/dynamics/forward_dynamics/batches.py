"""Many mechanisms of one structure left to themselves at once: lanes of one kernel, shared among threads."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.forward_dynamics.contacts import contacts_of
from centrode.dynamics.forward_dynamics.controllers import states_of
from centrode.dynamics.forward_dynamics.equations_of_motion import EquationsOfMotion, KeptDrive, LoadAlong
from centrode.dynamics.forward_dynamics.free_loads import dry_frictions_of, free_loads_of
from centrode.dynamics.forward_dynamics.free_motion import FreeMotion
from centrode.dynamics.forward_dynamics.initial_position import OPEN
from centrode.dynamics.forward_dynamics.initial_state import InitialState
from centrode.dynamics.forward_dynamics.model_numbers import map_equations
from centrode.dynamics.forward_dynamics.motion_problem import CONTROLS
from centrode.dynamics.forward_dynamics.motion_steps import (
    AMBIGUOUS,
    BLOW_UP,
    CHANGE_POINT,
    DURATION,
    STEP_SIZE,
)
from centrode.dynamics.forward_dynamics.pressed_contacts import pressed_contacts_of
from centrode.dynamics.kinetostatics.friction import without_friction
from centrode.dynamics.loads import loads_of
from centrode.dynamics.masses import masses_of
from centrode.kinematics.path import DrivenBy
from centrode.laws import Uniform
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.initial_value_problems import END, HEADER, STEP, TIME
from centrode.numerics.integrators import Integrator, integrator_of
from centrode.numerics.scans import evaluate
from centrode.structure.constraints import AngleDrive, DisplacementDrive, DistanceDrive, constraints_of
from centrode.structure.dimensions import dimensions_of

Array: TypeAlias = npt.NDArray[np.float64]

NEWTON_STEPS = 8
"""Steps from the described position to that of other dimensions: twice as many as ten per cent off take."""
ATTEMPTS = 10_000_000
"""Bound of what a lane may try."""
NOT_ASSEMBLED = "not assembled"
ENDS = (DURATION, CHANGE_POINT, BLOW_UP, STEP_SIZE, NOT_ASSEMBLED, AMBIGUOUS)
"""How a lane may end, by number."""


@dataclass(frozen=True)
class FreeMotions:
    """What many motions reached.

    Attributes
    ----------
    times : (instants) [s]
    coordinates, speeds : (instants, coordinates, lanes); NaN behind the end of a motion
    kinetic_energy, potential_energy : (instants, lanes) [J]
    energy_residual : (instants, lanes) [J], change of both since the start less the works
    reached : (lanes) [s], the instant up to which each motion went
    ended : (lanes), numbers in `ENDS`
    attempts : steps tried, of all lanes of the vector in which the lane is
    """

    times: Array
    coordinates: Array
    speeds: Array
    kinetic_energy: Array
    potential_energy: Array
    energy_residual: Array
    reached: Array
    ended: npt.NDArray[np.int8]
    attempts: Array


def equations_of_many(free: FreeMotion, numbers: Mapping[str, npt.ArrayLike]) -> EquationsOfMotion:
    """The equations of mechanisms whose numbers differ: path -> values (lanes), the others those of the description."""
    varied = {path: np.asarray(values, dtype=np.float64) for path, values in numbers.items()}
    mechanism, equations = free.mechanism, free.equations
    dimensions = dimensions_of(mechanism, varied, ARRAYS)
    # how wheels mesh is that of the description
    gearing = dimensions.gearing.with_phases(equations.numbers.gearing.phase)
    masses = masses_of(mechanism, varied, ARRAYS)
    given = without_friction(mechanism)
    described = loads_of(given, masses, varied)
    loads: tuple[LoadAlong, ...] = free_loads_of(given, described, ())
    contacts = contacts_of(mechanism, (*dry_frictions_of(given, described), *pressed_contacts_of(mechanism)))
    # forces of drives are no numbers of the description
    loads += equations.loads[len(loads) :]
    return replace(
        equations, numbers=replace(dimensions, gearing=gearing), masses=masses, loads=loads, contacts=contacts
    )


def start_of_many(
    free: FreeMotion, equations: EquationsOfMotion, start: InitialState
) -> tuple[InitialState, npt.NDArray[np.bool_]]:
    """Coordinates and speeds (coordinates, lanes) nearest to a state of the description, and which lanes close.

    Drives have the values and speeds that they have there; of what they leave open the change is the least.
    """
    values, speeds = free.drive_values(start.coordinates), free.drive_speeds(start)
    held = []
    for constraint in constraints_of(free.mechanism):
        if isinstance(constraint, AngleDrive | DisplacementDrive | DistanceDrive):
            drive = next(one for one in free.mechanism.drives if one.id == constraint.drive)
            held.append(KeptDrive(constraint, DrivenBy(drive, Uniform(speeds[drive.id]), values[drive.id])))
    started = replace(equations, kept=tuple(held))
    coordinates = [np.asarray(x) for x in start.coordinates]
    rest = [0.0] * len(coordinates)
    with np.errstate(all="ignore"):
        for _step in range(NEWTON_STEPS):
            terms = started.terms(ARRAYS, free.tree.values(ARRAYS, coordinates), rest, 0.0)
            shift = started.shift_to_close(terms, started.system(ARRAYS, terms))
            coordinates = [x + shift.get(k, 0.0) for k, x in enumerate(coordinates)]
        placed = free.tree.values(ARRAYS, coordinates)
        terms = started.terms(ARRAYS, placed, rest, 0.0)
        system = started.system(ARRAYS, terms)
        moving = started.consistent_speeds(ARRAYS, placed, list(start.speeds), 0.0, system)
    lanes = _lanes_of(equations, [*coordinates, *moving])
    gap = np.max([np.broadcast_to(np.abs(x), lanes) for x in terms.values], axis=0, initial=0.0)
    closes = np.broadcast_to(gap <= OPEN * max(1.0, float(np.max(equations.numbers.scale))), lanes)

    def spread(rows: Sequence[Any]) -> Array:
        return np.array([np.broadcast_to(np.asarray(x, dtype=np.float64), lanes) for x in rows])

    return InitialState(spread(coordinates), spread(moving)), closes


def _lanes_of(equations: EquationsOfMotion, numbers: Sequence[Any]) -> int:
    """Number of lanes: what varies may be a mass, which moves nothing at the start."""
    found = [np.shape(x) for x in numbers]

    def look(number: Any) -> Any:
        found.append(np.shape(number))
        return number

    map_equations(equations, look)
    return int(np.prod(np.broadcast_shapes(*found)))


def numbers_that_vary(equations: EquationsOfMotion) -> int:
    """Count of the numbers of equations that differ from lane to lane."""
    found: list[Any] = []

    def look(number: Any) -> Any:
        found.append(number)
        return number

    map_equations(equations, look)
    return sum(np.ndim(number) > 0 for number in found)


def integrate_many(
    free: FreeMotion,
    numbers: Mapping[str, npt.ArrayLike],
    start: InitialState,
    times: npt.ArrayLike,
    tolerance: float = 1e-9,
    threads: int = 1,
    executor: str = "auto",
    progress: Callable[[float], None] | None = None,
) -> FreeMotions:
    """Motions of mechanisms whose numbers differ, each from the state nearest to one of the description.

    Motions that come to a change point are integrated again one by one, so that they pass it.

    Parameters
    ----------
    numbers : path -> values (lanes), as "links.AB.length", "links.AB.mass"
    start : as `FreeMotion.initial` gives it
    times : (instants) [s] that grow; all are integrated up to the last
    tolerance : as that of `FreeMotion.integrate`
    threads : share the lanes
    progress : called with the share that is done
    """
    instants = np.atleast_1d(np.asarray(times, dtype=np.float64))
    equations = equations_of_many(free, numbers)
    begun, closes = start_of_many(free, equations, start)
    lanes = begun.coordinates.shape[1]
    integration, names = free.integration, free.integration.names
    parameters = _parameters(free, equations, begun, float(instants[-1]), tolerance, lanes)
    carried = _carried_values(free, begun, parameters, lanes)
    rate = integration.rate(start, float(instants[-1]))
    first = np.full(lanes, min(float(instants[-1]), 0.01 / rate))
    state = np.concatenate([np.zeros((1, lanes)), first[None], np.zeros((2, lanes)), carried])
    # what does not close is left where it is
    state[HEADER:, ~closes] = 0.0
    state[1, ~closes] = 0.0
    rows = np.full((len(instants), len(integration.problem.carried_names), lanes), np.nan)
    attempts = np.zeros(lanes)
    # events are found one mechanism after the other
    if not equations.has_events:
        integrator = integrator_of(integration.problem, executor, width=None)
        for number, reached in enumerate(_states_at(integrator, parameters, state, instants, threads)):
            state = reached
            attempts += state[2]
            arrived = closes & (state[0] >= instants[number])
            rows[number][:, arrived] = state[HEADER:, arrived]
            if progress is not None:
                progress((number + 1) / len(instants))
    ended = np.where(closes, ENDS.index(DURATION), ENDS.index(NOT_ASSEMBLED)).astype(np.int8)
    for lane in np.flatnonzero(closes & (state[0] < instants[-1])).tolist():
        own = free.with_numbers(map_equations(equations, partial(_of_lane, lane)))
        begun_there = InitialState(begun.coordinates[:, lane].copy(), begun.speeds[:, lane].copy())
        rows[:, :, lane], end = _rows_of_one(own, begun_there, instants, tolerance, executor)
        ended[lane] = ENDS.index(end)
    coordinates, speeds = rows[:, names.part(names.coordinates)], rows[:, names.part(names.speeds)]
    works = np.sum(rows[:, names.part(names.works)], axis=1)
    with np.errstate(all="ignore"):
        began = _energies(free, equations, begun.coordinates, begun.speeds, 0.0)
        energies = np.array(
            [
                _energies(free, equations, q, w, float(instant))
                for q, w, instant in zip(coordinates, speeds, instants, strict=True)
            ]
        )
    kinetic, potential = energies[:, 0], energies[:, 1]
    known = np.isfinite(coordinates[:, 0]) if coordinates.shape[1] else np.ones((len(instants), lanes), bool)
    arrivals = np.where(known, instants[:, None], 0.0)
    return FreeMotions(
        instants, coordinates, speeds, kinetic, potential,
        kinetic + potential - began[0] - began[1] - works, np.max(arrivals, axis=0), ended, attempts,
    )  # fmt: skip


def _states_at(
    integrator: Integrator, parameters: Array, state: Array, instants: Array, threads: int
) -> Iterator[Array]:
    """States (header + carried, lanes) of all lanes at one instant after the other, or where they stopped before it."""
    bounds = np.linspace(0, state.shape[1], threads + 1).astype(int)
    with ThreadPoolExecutor(threads) as pool:
        for instant in instants:
            parameters[CONTROLS.index(END)] = instant
            jobs = [
                pool.submit(integrator.run, parameters[:, low:high], state[:, low:high], ATTEMPTS)
                for low, high in pairwise(bounds.tolist())
            ]
            state = np.concatenate([job.result() for job in jobs], axis=1)
            yield state


def _rows_of_one(
    free: FreeMotion, start: InitialState, instants: Array, tolerance: float, executor: str
) -> tuple[Array, str]:
    """What one motion carries at instants (instants, carried), NaN behind its end, and how it ends.

    Its events and change points are looked for, which many lanes at once leave out.
    """
    integration = free.integration
    steps = integration.explicit_steps(start, float(instants[-1]), tolerance, executor)
    reached = instants[instants <= steps.rows[0, -1]]
    rows = np.full((len(instants), len(integration.problem.carried_names)), np.nan)
    rows[: len(reached)] = integration.states_at(steps, reached, executor).T
    return rows, steps.ended


def _of_lane(lane: int, number: Any) -> Any:
    """The number of one lane."""
    values = np.asarray(number) if isinstance(number, np.ndarray) else number
    return float(values[lane]) if isinstance(values, np.ndarray) and values.ndim else number


def _energies(free: FreeMotion, equations: EquationsOfMotion, q: Array, w: Array, time: float) -> Array:
    values = free.tree.values(ARRAYS, list(q))
    kinetic, potential = equations.energies(ARRAYS, values, list(w), time)
    return np.array([np.broadcast_to(kinetic, q.shape[1]), np.broadcast_to(potential, q.shape[1])])


def _parameters(
    free: FreeMotion,
    equations: EquationsOfMotion,
    start: InitialState,
    duration: float,
    tolerance: float,
    lanes: int,
) -> Array:
    """Controls and numbers (parameters, lanes); speeds are compared with the greatest of all lanes."""
    known = np.all(np.isfinite(start.speeds), axis=0)
    fastest = np.max(np.abs(start.speeds[:, known]), axis=1, initial=0.0)
    own = free.integration.parameters(
        duration,
        tolerance,
        free.integration.rate(InitialState(free.position.coordinates, fastest), duration),
        lanes,
    )
    found = free.integration.variables.values(equations)
    own[len(CONTROLS) :] = np.broadcast_to(found, (len(found), lanes))
    return own


def _carried_values(free: FreeMotion, start: InitialState, parameters: Array, lanes: int) -> Array:
    names = free.integration.names
    found: dict[str, Array] = {name: np.zeros(lanes) for name in free.integration.problem.carried_names}
    found |= dict(zip(names.coordinates, start.coordinates, strict=True))
    found |= dict(zip(names.speeds, start.speeds, strict=True))
    given = dict(zip(free.integration.problem.parameters, parameters, strict=True))
    closed = evaluate(
        free.integration.problem.of_closing, found | given | {TIME: np.zeros(1), STEP: np.ones(1)}
    )
    found |= {
        name: np.full(lanes, start)
        for name, start in zip(names.states, states_of(free.equations.controls), strict=True)
    }
    kept = (*names.coordinates, *names.speeds, *names.works, *names.states)
    rows = [found[name] if name in kept else closed[name] for name in free.integration.problem.carried_names]
    return np.array([np.broadcast_to(row, lanes) for row in rows], dtype=np.float64)
