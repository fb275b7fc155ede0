"""Many mechanisms of one structure left to themselves at once: lanes of one kernel, shared among threads."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.forward_dynamics.equations_of_motion import EquationsOfMotion, KeptDrive, LoadAlong
from centrode.dynamics.forward_dynamics.free_loads import free_loads_of
from centrode.dynamics.forward_dynamics.free_motion import FreeMotion
from centrode.dynamics.forward_dynamics.initial_state import InitialState
from centrode.dynamics.forward_dynamics.motion_problem import CONTROLS, RATE
from centrode.dynamics.loads import loads_of
from centrode.dynamics.masses import masses_of
from centrode.kinematics.path import DrivenBy
from centrode.laws import Uniform
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.initial_value_problems import HEADER, STEP, TIME
from centrode.numerics.integrators import integrator_of
from centrode.numerics.scans import evaluate
from centrode.structure.constraints import AngleDrive, DisplacementDrive, DistanceDrive, constraints_of
from centrode.structure.dimensions import dimensions_of

Array: TypeAlias = npt.NDArray[np.float64]

NEWTON_STEPS = 8
"""Steps from the described position to that of other dimensions: twice as many as ten per cent off take."""
ATTEMPTS = 10_000_000
"""Bound of what a lane may try."""


@dataclass(frozen=True)
class FreeMotions:
    """What many motions reached.

    Attributes
    ----------
    time : (lanes) [s], reached; shorter than the duration where a motion stopped before a change point
    coordinates, speeds : (coordinates, lanes) at that time
    kinetic_energy, potential_energy : (lanes) [J] then
    energy_residual : (lanes) [J], change of both less the works
    attempts : steps tried, of all lanes of the vector in which the lane is
    """

    time: Array
    coordinates: Array
    speeds: Array
    kinetic_energy: Array
    potential_energy: Array
    energy_residual: Array
    attempts: Array


def equations_of_many(free: FreeMotion, numbers: Mapping[str, npt.ArrayLike]) -> EquationsOfMotion:
    """The equations of mechanisms whose numbers differ: path -> values (lanes), the others those of the description."""
    varied = {path: np.asarray(values, dtype=np.float64) for path, values in numbers.items()}
    mechanism, equations = free.mechanism, free.equations
    dimensions = dimensions_of(mechanism, varied, ARRAYS)
    # how wheels mesh is that of the description
    gearing = dimensions.gearing.with_phases(equations.numbers.gearing.phase)
    masses = masses_of(mechanism, varied, ARRAYS)
    loads: tuple[LoadAlong, ...] = free_loads_of(mechanism, loads_of(mechanism, masses, varied), ())
    # forces of drives are no numbers of the description
    loads += equations.loads[len(loads) :]
    return replace(equations, numbers=replace(dimensions, gearing=gearing), masses=masses, loads=loads)


def start_of_many(
    free: FreeMotion, equations: EquationsOfMotion, speeds: Mapping[str, float]
) -> InitialState:
    """Coordinates and speeds (coordinates, lanes): drives at their described places, with these speeds [rad/s, m/s]."""
    values = free.drive_values(free.position.coordinates)
    held = []
    for constraint in constraints_of(free.mechanism):
        if isinstance(constraint, AngleDrive | DisplacementDrive | DistanceDrive):
            drive = next(one for one in free.mechanism.drives if one.id == constraint.drive)
            law = Uniform(float(speeds.get(drive.id, 0.0)))
            held.append(KeptDrive(constraint, DrivenBy(drive, law, values[drive.id])))
    started = replace(equations, kept=tuple(held), references=(), dependent=frozenset(), weights=())
    coordinates = [np.asarray(x) for x in free.position.coordinates]
    rest = [0.0] * len(coordinates)
    for _step in range(NEWTON_STEPS):
        terms = started.terms(ARRAYS, free.tree.values(ARRAYS, coordinates), rest, 0.0)
        shift = started.shift_to_close(terms, started.system(ARRAYS, terms))
        coordinates = [x + shift.get(k, 0.0) for k, x in enumerate(coordinates)]
    placed = free.tree.values(ARRAYS, coordinates)
    system = started.system(ARRAYS, started.terms(ARRAYS, placed, rest, 0.0))
    moving = started.consistent_speeds(ARRAYS, placed, rest, 0.0, system)
    lanes = np.broadcast_shapes(*(np.shape(x) for x in (*coordinates, *moving)))

    def spread(rows: Sequence[npt.ArrayLike]) -> Array:
        return np.array([np.broadcast_to(np.asarray(x, dtype=np.float64), lanes) for x in rows])

    return InitialState(spread(coordinates), spread(moving))


def integrate_many(
    free: FreeMotion,
    numbers: Mapping[str, npt.ArrayLike],
    speeds: Mapping[str, float],
    duration: float,
    tolerance: float = 1e-9,
    threads: int = 1,
    executor: str = "auto",
) -> FreeMotions:
    """Motions of mechanisms whose numbers differ, from the drives' starts and speeds.

    Parameters
    ----------
    numbers : path -> values (lanes), as "links.AB.length", "links.AB.mass"
    speeds : drive -> speed at the start [rad/s or m/s]
    duration [s], tolerance : as those of `FreeMotion.integrate`
    threads : share the lanes
    """
    equations = equations_of_many(free, numbers)
    start = start_of_many(free, equations, speeds)
    lanes = start.coordinates.shape[1]
    parameters = _parameters(free, equations, start, duration, tolerance, lanes)
    carried = _carried_values(free, start, parameters, lanes)
    rate = parameters[CONTROLS.index(RATE)]
    first = np.minimum(duration, 0.01 / rate)
    state = np.concatenate([np.zeros((1, lanes)), first[None], np.zeros((2, lanes)), carried])
    integrator = integrator_of(free.integration.problem, executor, width=None)
    bounds = np.linspace(0, lanes, threads + 1).astype(int)
    with ThreadPoolExecutor(threads) as pool:
        parts = list(
            pool.map(
                lambda k: integrator.run(
                    parameters[:, bounds[k] : bounds[k + 1]], state[:, bounds[k] : bounds[k + 1]], ATTEMPTS
                ),
                range(threads),
            )
        )
    reached = np.concatenate(parts, axis=1)
    names = free.integration.names
    before, after = (
        [rows[names.part(part)] for part in (names.coordinates, names.speeds)]
        for rows in (carried, reached[HEADER:])
    )
    energies = [
        equations.energies(ARRAYS, free.tree.values(ARRAYS, list(q)), list(w), 0.0)
        for q, w in (before, after)
    ]
    works = np.sum(reached[HEADER:][names.part(names.works)], axis=0)
    (kinetic, potential), (own, stored) = energies
    return FreeMotions(
        reached[0], after[0], after[1], np.broadcast_to(own, lanes), np.broadcast_to(stored, lanes),
        own + stored - kinetic - potential - works, reached[2],
    )  # fmt: skip


def _parameters(
    free: FreeMotion,
    equations: EquationsOfMotion,
    start: InitialState,
    duration: float,
    tolerance: float,
    lanes: int,
) -> Array:
    """Controls and numbers (parameters, lanes); speeds are compared with the greatest of all lanes."""
    one = InitialState(start.coordinates[:, 0], np.max(np.abs(start.speeds), axis=1))
    own = free.integration.parameters(duration, tolerance, free.integration.rate(one), lanes)
    found = free.integration.variables.values(equations)
    own[len(CONTROLS) :] = np.broadcast_to(found, (len(found), lanes))
    return own


def _carried_values(free: FreeMotion, start: InitialState, parameters: Array, lanes: int) -> Array:
    names = free.integration.names
    found: dict[str, Array] = {name: np.zeros(lanes) for name in free.integration.problem.carried}
    found |= dict(zip(names.coordinates, start.coordinates, strict=True))
    found |= dict(zip(names.speeds, start.speeds, strict=True))
    given = dict(zip(free.integration.problem.parameters, parameters, strict=True))
    closed = evaluate(
        free.integration.problem.of_closing, found | given | {TIME: np.zeros(1), STEP: np.ones(1)}
    )
    kept = (*names.coordinates, *names.speeds, *names.works)
    rows = [found[name] if name in kept else closed[name] for name in free.integration.problem.carried]
    return np.array([np.broadcast_to(row, lanes) for row in rows], dtype=np.float64)
