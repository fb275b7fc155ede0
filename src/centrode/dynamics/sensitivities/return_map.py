"""Regimes of any machine: motions that come back to themselves after a period, and whether they attract others.

The state after a period is a function of that before it, the return map; its fixed points are sought by Newton's
method with the derivatives of the variational equations. Eigenvalues of the derivative there, the multipliers, say
what is left of a departure after a period (Floquet). Where nothing else tells the period, it is one of the unknowns,
and the place at which a link passes a chosen angle is where states are compared (Poincare). (A. H. Nayfeh and
B. Balachandran, Applied Nonlinear Dynamics, 1995, chapters 3 and 7; R. Seydel, Practical Bifurcation and Stability
Analysis, 3rd ed., 2010, chapter 7.)
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.forward_dynamics.free_motion import FreeMotion
from centrode.dynamics.forward_dynamics.initial_position import residuals_and_rows, units_of
from centrode.dynamics.forward_dynamics.initial_state import InitialState
from centrode.dynamics.forward_dynamics.trajectory import Trajectory
from centrode.dynamics.sensitivities.variational_equations import ChangedMotion, VariationalEquations
from centrode.errors import MotionError
from centrode.locale import _
from centrode.model.motion_parameter import constant_speed_of
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.initial_value_problems import STEP, TIME
from centrode.numerics.python_integrations import PythonIntegration
from centrode.numerics.scans import evaluate

Array: TypeAlias = npt.NDArray[np.float64]
Complex: TypeAlias = npt.NDArray[np.complex128]

TOLERANCE = 1e-11
SETTLED = 1e-9
"""Change of the state over a period, in its units, at which it has come back."""
MOST_STEPS = 25
FARTHEST = 0.3
"""A step of Newton's method, in rad, lengths and shares of the speeds."""
INDIFFERENT = 1e-4
"""A multiplier as near to 1 says that a neighbouring motion comes back as well."""
RANK = 1e-9
MOVING = 1e-6
"""Share of the greatest speed above which something moves."""
LIKE = 0.02
"""States at two events that differ by less, in rad, lengths and shares of the fastest speed, may be of one regime."""


@dataclass(frozen=True)
class PeriodicMotion:
    """A motion that comes back to itself.

    Attributes
    ----------
    free : whose motion
    start : a state of it
    period : [s]
    turns : (coordinates) whole turns of the angles in a period
    multipliers : what is left of departures after a period, the greatest first
    maps : periods that were integrated
    given : the period is that of a drive which keeps its speed
    """

    free: FreeMotion
    start: InitialState
    period: float
    turns: Array
    multipliers: Complex
    maps: int
    given: bool

    @property
    def turning(self) -> int | None:
        """Number of the coordinate that turns most; None where none makes a whole turn."""
        number = int(np.argmax(np.abs(self.turns))) if len(self.turns) else 0
        return number if len(self.turns) and self.turns[number] else None

    @property
    def mean_speed(self) -> float:
        """Mean speed in time of what turns most [rad/s]; zero where nothing does."""
        return 0.0 if self.turning is None else float(2.0 * np.pi * self.turns[self.turning] / self.period)

    @property
    def stable(self) -> bool:
        """Whether all departures die away."""
        return bool(np.max(np.abs(self.multipliers), initial=0.0) < 1.0 - INDIFFERENT)

    @property
    def indifferent(self) -> bool:
        """Whether departures neither grow nor all die away: neighbouring motions come back as well."""
        return not self.stable and bool(np.max(np.abs(self.multipliers), initial=0.0) < 1.0 + INDIFFERENT)


def periodic_motion(free: FreeMotion, start: InitialState, run_in: float) -> PeriodicMotion:
    """The regime that a machine runs up to from a state.

    Parameters
    ----------
    run_in : time after which its motion is nearly that of the regime [s]

    Raises
    ------
    MotionError
        Nothing turns all the way round and no drive keeps its speed, or no regime is found near the motion then.
    """
    search = _RegimeSearch(free)
    period = search.period_of_drives()
    if period is not None:
        # states are compared after whole periods, when drives are where they were
        periods = max(1, int(np.ceil(run_in / period)))
        run = free.integrate(start, periods * period, TOLERANCE, at=[periods * period])
        begin = InitialState(run.coordinates[0], run.speeds[0])
        turned = start.coordinates - begin.coordinates
        # angles begin again, as laws of drives count from theirs
        angles = search.angles
        whole = np.where(angles, 2.0 * np.pi * np.round(turned / (2.0 * np.pi)), 0.0)
        return search.solve(InitialState(begin.coordinates + whole, begin.speeds), period, None)
    instants = np.linspace(0.0, run_in, 4001)
    run = free.integrate(start, run_in, TOLERANCE, at=instants)
    if search.turns_twice(run.coordinates):
        number, begin_at, period = search.last_turn(run.time, run.coordinates)
    else:
        number, begin_at, period = search.last_recurrence(start, run)
    ahead = free.integrate(start, begin_at, TOLERANCE, at=[begin_at])
    return search.solve(InitialState(ahead.coordinates[0], ahead.speeds[0]), period, number)


class _RegimeSearch:
    """Newton's method on the return map of one mechanism."""

    def __init__(self, free: FreeMotion) -> None:
        self.free = free
        self.units = units_of(free.tree, free.equations.numbers)
        self.angles = np.array([one.kind == "angle" for one in free.coordinates])
        self.maps = 0

    def period_of_drives(self) -> float | None:
        """Time of a turn of the drives that keep their speeds; None without any."""
        speeds = []
        for kept in self.free.equations.kept:
            speed = constant_speed_of(kept.law)
            if speed is None or kept.driven.drive.kind != "angle":
                what = _("a regime is sought of drives that keep a constant speed")
                raise MotionError("[simulation]", what, _("let them turn at constant speeds"))
            if speed:
                speeds.append(abs(speed))
        if not speeds:
            return None
        slowest = min(speeds)
        if any(abs(one / slowest - round(one / slowest)) > 1e-12 for one in speeds):
            what = _("the speeds of the drives have no common period")
            raise MotionError("[simulation]", what, _("let them be whole multiples of the slowest"))
        return 2.0 * np.pi / slowest

    def turned_angles(self, coordinates: Array) -> Array:
        """By how much angles have turned (coordinates); zero of displacements."""
        return np.where(self.angles, np.abs(coordinates[-1] - coordinates[0]), 0.0)

    def turns_twice(self, coordinates: Array) -> bool:
        """Whether something turns all the way round twice."""
        return bool(np.max(self.turned_angles(coordinates), initial=0.0) >= 4.0 * np.pi)

    def last_recurrence(self, start: InitialState, run: Trajectory) -> tuple[int, float, float]:
        """What moves fastest in the longest stretch between two like events, an instant there, and their distance.

        Events that stops and friction make in like states tell a period where nothing turns.
        """
        events = [event for event in run.events if event.part and event.time <= run.time[-1]]
        times = np.array([event.time for event in events])
        last = (events[-1].kind, events[-1].part) if events else None
        like = [k for k, event in enumerate(events[:-1]) if (event.kind, event.part) == last]
        earlier = self._latest_alike(start, run, times, like) if like else None
        if earlier is None:
            what = _(
                "no regime is sought: nothing turns all the way round twice, no drive keeps its speed, and no event "
                "recurs"
            )
            raise MotionError("[simulation]", what, _("give a longer duration, or keep a drive"))
        return self._between_events(start, times[earlier:])

    def _latest_alike(
        self, start: InitialState, run: Trajectory, times: Array, candidates: Sequence[int]
    ) -> int | None:
        """The latest of some events whose state is nearly that of the last event."""
        states = self.free.integrate(start, float(run.time[-1]), TOLERANCE, at=times)
        fast = max(float(np.max(np.abs(run.speeds) / self.units, initial=0.0)), 1e-300)
        apart = np.max(np.abs(states.coordinates - states.coordinates[-1]) / self.units, axis=1)
        faster = np.max(np.abs(states.speeds - states.speeds[-1]) / self.units, axis=1) / fast
        alike = [k for k in candidates if times[k] < times[-1] and max(apart[k], faster[k]) < LIKE]
        return alike[-1] if alike else None

    def _between_events(self, start: InitialState, times: Array) -> tuple[int, float, float]:
        """Of the longest stretch between events in which nothing is closed or sticks, if there is one.

        Else of the longest in which something moves: what is held there is held by all motions nearby.
        """
        middles = 0.5 * (times[1:] + times[:-1])
        there = self.free.integrate(start, float(times[-1]), TOLERANCE, at=middles)
        speeds = np.max(np.abs(there.speeds) / self.units, axis=1)
        moving = np.where(speeds > MOVING * np.max(speeds, initial=0.0), np.diff(times), 0.0)
        free = np.where(np.any(there.contact_modes != 0.0, axis=1), 0.0, moving)
        lengths = free if np.any(free > 0.0) else moving
        longest = int(np.argmax(lengths))
        if not lengths[longest] > 0.0:
            what = _("no regime is sought: everything is at rest")
            raise MotionError("[simulation]", what, _("look at the events of the simulation"))
        number = int(np.argmax(np.abs(there.speeds[longest]) / self.units))
        return number, float(middles[longest]), float(times[-1] - times[0])

    def last_turn(self, times: Array, coordinates: Array) -> tuple[int, float, float]:
        """The angle that turns most, when it begins its last whole turn, and how long that takes."""
        number = int(np.argmax(self.turned_angles(coordinates)))
        course = coordinates[:, number] * np.sign(coordinates[-1, number] - coordinates[0, number])
        end = float(course[-1])
        ends = []
        for level in (end - 2.0 * np.pi, end):
            k = min(int(np.argmax(course >= level)), len(course) - 1)
            step = course[k] - course[k - 1]
            share = (level - course[k - 1]) / step if step else 0.0
            ends.append(float(times[k - 1] + share * (times[k] - times[k - 1])))
        return number, ends[0], ends[1] - ends[0]

    def free_directions(self, coordinates: Array) -> Array:
        """Columns along which the closures and the kept drives let it move, (coordinates, freedoms)."""
        equations = self.free.equations
        starts = {kept.name: float(kept.driven.initial) for kept in equations.kept}
        _left, rows = residuals_and_rows(
            equations.tree, equations.numbers, equations.constraints, coordinates, starts
        )
        if not len(rows):
            return np.diag(self.units)
        _left, sizes, right = np.linalg.svd(rows * self.units)
        rank = int(np.sum(sizes > RANK * max(float(np.max(sizes, initial=0.0)), 1e-300)))
        return np.asarray(right[rank:].T * self.units[:, None])

    def closed_state(self, state: InitialState) -> InitialState:
        """The state with positions and speeds that keep the closures."""
        integration = self.free.integration
        problem, names = integration.problem, integration.names
        parameters = dict(zip(problem.parameters, integration.parameters(1.0, 1.0, 1.0)[:, 0], strict=True))
        for _step in range(3):
            carried = dict(zip(problem.carried_names, integration.carried_values(state), strict=True))
            found = evaluate(problem.of_closing, carried | parameters | {TIME: 0.0, STEP: 1.0})
            state = InitialState(
                np.array([float(found[name]) for name in names.coordinates]),
                np.array([float(found[name]) for name in names.speeds]),
            )
        return state

    def motion_over_period(self, state: InitialState, period: float, free: Array) -> ChangedMotion:
        """The motion over a period with its derivatives by the free directions of places and of speeds."""
        none = np.zeros(len(state.coordinates))
        changes = [InitialState(column, none) for column in free.T]
        changes += [InitialState(none, column) for column in free.T]
        equations = VariationalEquations(self.free, tuple({} for _change in changes))
        self.maps += 1
        return equations.motion(state, changes, np.array([period]), TOLERANCE)

    def solve(self, state: InitialState, period: float, section: int | None) -> PeriodicMotion:
        """The regime near a state; `section` is the angle that is held where the period is sought too."""
        turns: Array | None = None
        fast = 1.0
        for _step in range(MOST_STEPS):
            state = self.closed_state(state)
            free = self.free_directions(state.coordinates)
            count = free.shape[1]
            run = self.motion_over_period(state, period, free)
            if turns is None:
                turned = (run.coordinates[0] - state.coordinates) / (2.0 * np.pi)
                turns = np.where(self.angles, np.round(turned), 0.0)
                fast = max(float(np.max(np.abs(run.speeds[0]) / self.units, initial=0.0)), 1e-9)
            # places and speeds are compared along the free directions, speeds as shares of the fastest
            inverse = np.linalg.pinv(free)
            missed = np.concatenate(
                [
                    inverse @ (run.coordinates[0] - 2.0 * np.pi * turns - state.coordinates),
                    inverse @ (run.speeds[0] - state.speeds) / fast,
                ]
            )
            derivative = np.vstack(
                [inverse @ run.coordinate_changes[0].T, inverse @ run.speed_changes[0].T / fast]
            )
            derivative[:, count:] *= fast
            matrix = derivative - np.eye(2 * count)
            flow = np.concatenate([inverse @ run.speeds[0], inverse @ self.accelerations(run) / fast])
            if section is not None:
                row = np.concatenate([free[section], np.zeros(count)])
                matrix = np.vstack([np.column_stack([matrix, flow / fast]), np.append(row, 0.0)])
                right = -np.append(missed, 0.0)
            else:
                right = -missed
            if np.max(np.abs(missed), initial=0.0) < SETTLED:
                return PeriodicMotion(
                    self.free, state, period, turns, self.multipliers(derivative, flow, free, section), self.maps,
                    section is None,
                )  # fmt: skip
            step = np.linalg.lstsq(matrix, right, rcond=1e-9)[0]
            step = step * min(1.0, FARTHEST / max(float(np.max(np.abs(step))), 1e-300))
            state = InitialState(
                state.coordinates + free @ step[:count],
                state.speeds + free @ step[count : 2 * count] * fast,
            )
            if section is not None:
                period += float(step[-1]) / fast
                if not period > 0.0:
                    break
        what = _("no motion that comes back to itself is found near the one after the run-in")
        raise MotionError("[simulation]", what, _("give a longer duration, or another speed at the start"))

    def accelerations(self, run: ChangedMotion) -> Array:
        """Accelerations at the end of a period."""
        equations = self.free.equations
        if run.steps is not None:
            # in the modes that it has there
            integration, row = self.free.integration, run.steps.rows[:, -1]
            given = [float(row[0]), *integration.parameters(1.0, 1.0, 1.0)[:, 0], *row[1:]]
            rates = np.array(PythonIntegration(integration.problem).rates(given), dtype=np.float64)
            return rates[integration.names.part(integration.names.speeds)]
        values = equations.tree.values(ARRAYS, list(run.coordinates[0]))
        terms = equations.terms(ARRAYS, values, list(run.speeds[0]), float(run.times[0]))
        return np.array(equations.accelerations(ARRAYS, terms)[0], dtype=np.float64)

    def multipliers(self, derivative: Array, flow: Array, free: Array, section: int | None) -> Complex:
        """Eigenvalues of the derivative of the return map, on the section where there is one."""
        matrix = derivative
        if section is not None:
            row = np.concatenate([free[section], np.zeros(free.shape[1])])
            _left, _sizes, right = np.linalg.svd(row[None])
            inside = right[1:].T
            # a state that is late on the section is brought there along the flow
            late = np.eye(len(flow)) - np.outer(flow, row) / float(row @ flow)
            matrix = inside.T @ late @ derivative @ inside
        found = np.linalg.eigvals(matrix)
        return np.asarray(found[np.argsort(-np.abs(found))], dtype=np.complex128)
