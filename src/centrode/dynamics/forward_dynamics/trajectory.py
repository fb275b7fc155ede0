"""The trajectory of a free motion: places, energies, works, reactions, residuals and statuses at instants."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.forward_dynamics.contacts import ContactMode
from centrode.dynamics.forward_dynamics.equations_of_motion import ContactMeasure, EquationsOfMotion, Terms
from centrode.dynamics.forward_dynamics.joint_state import JointState
from centrode.dynamics.forward_dynamics.motion_problem import MotionNames, modes_of, worked_loads
from centrode.dynamics.forward_dynamics.motion_steps import CROSSING, NEAR_MISS, Event, MotionSteps
from centrode.errors import NotComputedYet
from centrode.model.mechanism import Mechanism
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.jets import Jet

Array: TypeAlias = npt.NDArray[np.float64]
Number: TypeAlias = Any

STATUSES = ("ok", CROSSING, "doubtful")
"""Statuses of instants by number: on a detour around a change point; behind a near miss."""


@dataclass(frozen=True)
class Trajectory:
    """A motion at instants; shapes by n instants, c coordinates, p points, l links, g guides, d drives.

    Attributes
    ----------
    time : (n) [s]
    coordinates, speeds, accelerations : (n, c) [rad or m] and their derivatives by time [s]
    places, velocities, point_accelerations : (n, p, axes) [m, m/s, m/s^2], in the order of `trajectory_points`
    angles, angular_velocities, angular_accelerations : (n, l) [rad, rad/s, rad/s^2]
        Angles with their turns; NaN where a link has none.
    attitudes, spins : (n, l, 3, 3), (n, l, 3) [rad/s], or None in the plane
    slides, slide_speeds, slide_accelerations : (n, g) [m, m/s, m/s^2]
    drives, drive_speeds, drive_accelerations : (n, d) [rad or m] and their derivatives by time [s]
    kinetic_energy, potential_energy : (n) [J]
    works : label -> (n) [J], since the start
    energy_residual : (n) [J], change of both energies less the works that are followed
    multipliers : (n, equations) [N or N m], NaN where redundant constraints leave them open
    kept_forces : drive -> (n) [N or N m]
    position_residual, velocity_residual : (n) [m or rad, m/s or rad/s], the greatest of the cut loops
    statuses : (n), numbers in `STATUSES`
    ended, cause, events, attempts : as those of `MotionSteps`
    scheme, executor : by which the steps were taken
    steps : number of steps
    contact_forces : (n, contacts) [N or N m], along the coordinates of contacts
    contact_modes : (n, contacts), -1 or 1 where a contact is closed, sticks or holds
    outputs : (n, controllers) [N or N m]
    """

    time: Array
    coordinates: Array
    speeds: Array
    accelerations: Array
    places: Array
    velocities: Array
    point_accelerations: Array
    angles: Array
    angular_velocities: Array
    angular_accelerations: Array
    attitudes: Array | None
    spins: Array | None
    slides: Array
    slide_speeds: Array
    slide_accelerations: Array
    drives: Array
    drive_speeds: Array
    drive_accelerations: Array
    kinetic_energy: Array
    potential_energy: Array
    works: Mapping[str, Array]
    energy_residual: Array
    multipliers: Array
    kept_forces: Mapping[str, Array]
    position_residual: Array
    velocity_residual: Array
    statuses: npt.NDArray[np.int8]
    events: tuple[Event, ...]
    ended: str
    cause: str | None
    scheme: str
    executor: str
    steps: int
    attempts: int
    contact_forces: Array
    contact_modes: Array
    outputs: Array


def trajectory_points(mechanism: Mechanism) -> tuple[str, ...]:
    """Points in the order of a trajectory: moving ones, then those of the frame."""
    return (*mechanism.moving_points, *mechanism.frame.points)


def trajectory_of(
    equations: EquationsOfMotion,
    steps: MotionSteps,
    times: Array,
    states: Array,
    scheme: str,
    executor: str,
    carried: Sequence[str] = (),
) -> Trajectory:
    """Everything that a motion shows at instants, from its states.

    Parameters
    ----------
    steps : of which the first is the start, from which energies and works count
    times : (n) [s]
    states : (carried, n), as `MotionIntegration.states_at` gives them
    scheme, executor : by which the steps were taken
    carried : names of what states hold, in order; what is followed alone if left out
    """
    names, mechanism = MotionNames.of(equations), equations.tree.mechanism
    n = len(times)
    with np.errstate(all="ignore"):
        solved = _solve_motion(equations, names, times, states, carried)
        state = solved.state
        energies = _energies(equations, names, steps, states, state, n)
        multipliers, kept_forces = _closure_forces(equations, solved.forces[: equations.equations], n)
        places, velocities, point_accelerations = _orders(
            [state.point(name) for name in trajectory_points(mechanism)], n
        )
        angles = _orders([(_angle(state, name),) for name in mechanism.links], n)[..., 0]
        slides = _orders([(state.slide(guide.id),) for guide in mechanism.guides], n)[..., 0]
        drives = _orders([(state.drive(drive),) for drive in mechanism.drives], n)[..., 0]
        attitudes, spins = _attitudes(mechanism, state, n)
        return Trajectory(
            time=times,
            coordinates=_columns(states[names.part(names.coordinates)], n),
            speeds=_columns(states[names.part(names.speeds)], n),
            accelerations=_columns(solved.accelerations, n),
            places=places,
            velocities=velocities,
            point_accelerations=point_accelerations,
            angles=angles[0],
            angular_velocities=angles[1],
            angular_accelerations=angles[2],
            attitudes=attitudes,
            spins=spins,
            slides=slides[0],
            slide_speeds=slides[1],
            slide_accelerations=slides[2],
            drives=drives[0],
            drive_speeds=drives[1],
            drive_accelerations=drives[2],
            kinetic_energy=energies.kinetic,
            potential_energy=energies.potential,
            works=energies.works,
            energy_residual=energies.residual,
            multipliers=multipliers,
            kept_forces=kept_forces,
            position_residual=_greatest(solved.terms.values[: equations.equations], n),
            velocity_residual=_greatest(solved.terms.speeds[: equations.equations], n),
            statuses=_statuses(steps, times),
            events=steps.events,
            ended=steps.ended,
            cause=steps.cause,
            scheme=scheme,
            executor=executor,
            steps=steps.rows.shape[1] - 1,
            attempts=steps.attempts,
            contact_forces=_contact_forces(equations, solved.measures, solved.forces, n),
            contact_modes=_columns([one.active for one in solved.modes or ()], n),
            outputs=_columns(solved.terms.outputs, n),
        )


@dataclass(frozen=True)
class _SolvedMotion:
    """The equations of motion solved at instants.

    Attributes
    ----------
    terms : of the equations, with the values and speeds of their closures
    modes : of the contacts; None where there are none
    accelerations : of the joint coordinates [rad/s^2 or m/s^2]
    forces : of every row, closures first [N or N m]
    measures : of the contacts
    state : places, velocities and accelerations of everything
    """

    terms: Terms
    modes: Sequence[ContactMode] | None
    accelerations: list[Number]
    forces: list[Number]
    measures: Sequence[ContactMeasure]
    state: JointState


def _solve_motion(
    equations: EquationsOfMotion, names: MotionNames, times: Array, states: Array, carried: Sequence[str]
) -> _SolvedMotion:
    q, w = list(states[names.part(names.coordinates)]), list(states[names.part(names.speeds)])
    values = equations.tree.values(ARRAYS, q)
    fixed = dict(zip(carried, states, strict=False))
    modes = modes_of(names, fixed.__getitem__) if carried else None
    held = list(states[names.part(names.states)])
    terms = equations.terms(ARRAYS, values, w, times, modes, held)
    # a contact's row counts at the instants at which it is closed, sticks or holds
    flags = {
        row: fixed[name] > 0.5
        for row, name in zip(equations.flagged_rows, names.flags, strict=True)
        if modes is not None
    }
    moved = equations.motion(ARRAYS, terms, equations.system(ARRAYS, terms, flags or None))
    accelerations = [moved.accelerations.get(k, 0.0) for k in range(equations.size)]
    forces = [moved.forces.get(row, 0.0) for row in range(len(terms.rows))]
    # Taylor's coefficients by time: half of the second derivative
    jets = [Jet((x, y, 0.5 * z)) for x, y, z in zip(q, w, accelerations, strict=True)]
    state = equations.state(ARRAYS, values, jets, times)
    return _SolvedMotion(terms, modes, accelerations, forces, moved.measures, state)


@dataclass(frozen=True)
class _Energies:
    """Energies (n) [J], works since the start by their label, and the energy that neither accounts for."""

    kinetic: Array
    potential: Array
    works: dict[str, Array]
    residual: Array


def _energies(
    equations: EquationsOfMotion,
    names: MotionNames,
    steps: MotionSteps,
    states: Array,
    state: JointState,
    n: int,
) -> _Energies:
    kinetic = _row(equations.kinetic_energy(state), n)
    potential = _row(equations.potential_energy(state), n)
    works: dict[str, Array] = {}
    begun = _state_at_start(equations, names, steps)
    # what a load stores follows from where it stands, so its work needs no integration
    for load in equations.loads:
        energy = getattr(load.term.amount, "energy", None)
        if energy is not None:
            coordinate = load.term.coordinate
            done = _row(energy(coordinate.value(begun)) - energy(coordinate.value(state)), n)
            works[load.label] = works.get(load.label, 0.0) + done
    followed = [equations.loads[k].label for k in worked_loads(equations)]
    followed += [f"drive {kept.name}" for kept in equations.kept]
    followed += [control.label for control in equations.controls]
    followed += [contact.label for contact in equations.contacts]
    free = np.zeros(n)
    for label, work in zip(followed, states[names.part(names.works)], strict=True):
        works[label] = works.get(label, 0.0) + work
        free = free + work
    began = float(equations.kinetic_energy(begun)) + float(equations.potential_energy(begun))
    return _Energies(kinetic, potential, works, kinetic + potential - free - began)


def _closure_forces(
    equations: EquationsOfMotion, forces: Sequence[Number], n: int
) -> tuple[Array, dict[str, Array]]:
    """Multipliers of the closures (n, equations), and the forces of the drives that keep their laws."""
    multipliers = _columns(forces, n)
    first = equations.equations - len(equations.kept)
    kept = {one.name: -multipliers[:, first + k] for k, one in enumerate(equations.kept)}
    # redundant constraints share a force in any way
    if equations.dependent:
        multipliers[:, sorted(equations.dependent)] = np.nan
    return multipliers, kept


def _columns(rows: Sequence[Number] | Array, n: int) -> Array:
    """Rows of numbers or arrays (n) as columns of one array (n, rows)."""
    return np.array([_row(row, n) for row in rows]).reshape(len(rows), n).T


def _greatest(rows: Sequence[Number], n: int) -> Array:
    """The greatest size of the rows at each of n instants; zero where there are none."""
    return np.asarray(np.max(np.abs(_columns(rows, n)), axis=1, initial=0.0))


def _contact_forces(
    equations: EquationsOfMotion, measures: Sequence[ContactMeasure], forces: Sequence[Number], n: int
) -> Array:
    """Forces in contacts along their coordinates (n, contacts) [N or N m]."""
    rows = {number: row for row, number in equations.contact_rows}
    found = []
    for number, one in enumerate(measures):
        held = -forces[rows[number]] if number in rows else 0.0
        found.append(one.strength + held)
    return _columns(found, n)


def _state_at_start(equations: EquationsOfMotion, names: MotionNames, steps: MotionSteps) -> JointState:
    row = steps.rows[1:, 0]
    q, w = list(row[names.part(names.coordinates)]), list(row[names.part(names.speeds)])
    jets = [Jet((x, y, 0.0)) for x, y in zip(q, w, strict=True)]
    return equations.state(ARRAYS, equations.tree.values(ARRAYS, q), jets, 0.0)


def _angle(state: JointState, link: str) -> Jet:
    try:
        return state.angle(link)
    except NotComputedYet:
        return Jet((np.nan, np.nan, np.nan))


def _attitudes(mechanism: Mechanism, state: JointState, n: int) -> tuple[Array | None, Array | None]:
    if mechanism.space != "sphere":
        return None, None
    axes = [
        [[_row(x.coefficients[0], n) for x in axis] for axis in state.attitude(name)]
        for name in mechanism.links
    ]
    spins = [[_row(x.coefficients[0], n) for x in state.spin(name)] for name in mechanism.links]
    return np.moveaxis(np.array(axes), -1, 0), np.moveaxis(np.array(spins), -1, 0)


def _statuses(steps: MotionSteps, times: Array) -> npt.NDArray[np.int8]:
    statuses = np.zeros(len(times), dtype=np.int8)
    for event in steps.events:
        if event.kind == NEAR_MISS:
            statuses[times >= event.time] = STATUSES.index("doubtful")
    for detour in steps.detours:
        statuses[(times > detour.begin) & (times < detour.end)] = STATUSES.index(CROSSING)
    return statuses


def _row(x: Number, n: int) -> Array:
    return np.broadcast_to(np.asarray(x, dtype=np.float64), (n,)).copy()


def _orders(numbers: Sequence[Sequence[Jet]], n: int) -> Array:
    """Values and two derivatives of jets, (3, n, numbers, components)."""
    if not numbers:
        return np.zeros((3, n, 0, 1))
    rows = [[[_row(jet.derivative(k), n) for jet in number] for number in numbers] for k in range(3)]
    return np.moveaxis(np.array(rows), -1, 1)
