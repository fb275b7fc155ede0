"""The trajectory of a free motion: places, energies, works, reactions, residuals and statuses at instants."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.forward_dynamics.equations_of_motion import ContactMeasure, EquationsOfMotion
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
    count, names, tree = equations.size, MotionNames.of(equations), equations.tree
    mechanism = tree.mechanism
    q, w = list(states[names.part(names.coordinates)]), list(states[names.part(names.speeds)])
    n = len(times)
    with np.errstate(all="ignore"):
        values = tree.values(ARRAYS, q)
        fixed = dict(zip(carried, states, strict=False))
        modes = modes_of(names, fixed.__getitem__) if carried else None
        held = list(states[names.part(names.states)])
        terms = equations.terms(ARRAYS, values, w, times, modes, held)
        flags = {
            row: fixed[name] > 0.5
            for row, name in zip(equations.flagged_rows, names.flags, strict=True)
            if modes is not None
        }
        moved = equations.motion(ARRAYS, terms, equations.system(ARRAYS, terms, flags or None))
        a = [moved.accelerations.get(k, 0.0) for k in range(equations.size)]
        forces = [moved.forces.get(row, 0.0) for row in range(len(terms.rows))]
        jets = [Jet((x, y, 0.5 * z)) for x, y, z in zip(q, w, a, strict=True)]
        state = equations.state(ARRAYS, values, jets, times)
        kinetic = _row(equations.kinetic_energy(state), n)
        potential = _row(equations.potential_energy(state), n)
        works: dict[str, Array] = {}
        free = np.zeros(n)
        begun = _state_at_start(equations, names, steps)
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
        for label, work in zip(followed, states[names.part(names.works)], strict=True):
            works[label] = works.get(label, 0.0) + work
            free = free + work
        residual = kinetic + potential - free
        began = float(equations.kinetic_energy(begun)) + float(equations.potential_energy(begun))
        points = _orders([state.point(name) for name in trajectory_points(mechanism)], n)
        angles = _orders([(_angle(state, name),) for name in mechanism.links], n)[..., 0]
        slides = _orders([(state.slide(guide.id),) for guide in mechanism.guides], n)[..., 0]
        drives = _orders([(state.drive(drive),) for drive in mechanism.drives], n)[..., 0]
        attitudes, spins = _attitudes(mechanism, state, n)
        in_contacts = _contact_forces(equations, moved.measures, forces, n)
        forces = forces[: equations.equations]
        multipliers = np.array([_row(x, n) for x in forces]).reshape(len(forces), n).T
        kept = {
            kept.name: -multipliers[:, equations.equations - len(equations.kept) + k]
            for k, kept in enumerate(equations.kept)
        }
        if equations.dependent:
            multipliers[:, sorted(equations.dependent)] = np.nan
        gaps = [np.abs(_row(x, n)) for x in terms.values[: equations.equations]]
        drifts = [np.abs(_row(x, n)) for x in terms.speeds[: equations.equations]]
        outputs = np.array([_row(x, n) for x in terms.outputs]).reshape(-1, n).T
        mode_numbers = np.array([_row(one.active, n) for one in modes or ()]).reshape(-1, n).T
    return Trajectory(
        times, np.array(q).T.reshape(n, count), np.array(w).T.reshape(n, count),
        np.array([_row(x, n) for x in a]).T.reshape(n, count),
        points[0], points[1], points[2], angles[0], angles[1], angles[2], attitudes, spins,
        slides[0], slides[1], slides[2], drives[0], drives[1], drives[2],
        kinetic, potential, works, residual - began, multipliers, kept,
        np.max(gaps, axis=0, initial=0.0) if gaps else np.zeros(n),
        np.max(drifts, axis=0, initial=0.0) if drifts else np.zeros(n),
        _statuses(steps, times), steps.events, steps.ended, steps.cause, scheme, executor,
        steps.rows.shape[1] - 1, steps.attempts, in_contacts, mode_numbers,
        outputs,
    )  # fmt: skip


def _contact_forces(
    equations: EquationsOfMotion, measures: Sequence[ContactMeasure], forces: Sequence[Number], n: int
) -> Array:
    """Forces in contacts along their coordinates (n, contacts) [N or N m]."""
    rows = {number: row for row, number in equations.contact_rows}
    found = []
    for number, one in enumerate(measures):
        held = -forces[rows[number]] if number in rows else 0.0
        found.append(_row(one.strength + held, n))
    return np.array(found).reshape(-1, n).T


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
