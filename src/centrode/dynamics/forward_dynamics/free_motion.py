"""A mechanism that is left to its loads, with any number of degrees of freedom: prepared, started and integrated."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import inf, isfinite
from typing import Any, NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt
from scipy.integrate import OdeSolution, Radau

from centrode.dynamics.forward_dynamics.change_points import Detour, HalfCircles
from centrode.dynamics.forward_dynamics.equations_of_motion import EquationsOfMotion, KeptDrive
from centrode.dynamics.forward_dynamics.free_loads import DriveEffort, free_loads_of
from centrode.dynamics.forward_dynamics.initial_position import (
    InitialPosition,
    close_position,
    equation_units,
    position_of_description,
    residuals_and_rows,
    units_of,
)
from centrode.dynamics.forward_dynamics.integration import (
    AHEAD,
    CONTROLS,
    FAR,
    GUARD,
    INDEPENDENCE,
    LIMIT,
    LOOKED,
    NEVER,
    MotionNames,
    motion_problem,
    worked_loads,
)
from centrode.dynamics.forward_dynamics.joint_state import JointState
from centrode.dynamics.forward_dynamics.model_numbers import NumbersAsVariables
from centrode.dynamics.forward_dynamics.spanning_tree import (
    JointCoordinate,
    SpanningTree,
    spanning_tree_of,
)
from centrode.dynamics.loads import MassesAndLoads
from centrode.dynamics.masses import massless_links
from centrode.dynamics.state import length_unit
from centrode.errors import InputError, NotComputedYet
from centrode.kinematics.path import DrivenBy, path_of
from centrode.laws import Law
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.executors import choose_executor
from centrode.numerics.expressions import EXPRESSIONS, variable
from centrode.numerics.initial_value_problems import HEADER, SMALLEST, STEP, TIME, InitialValueProblem
from centrode.numerics.integrators import Integrator, integrator_of
from centrode.numerics.jets import Jet, JetFunctions
from centrode.numerics.python_integrations import PythonIntegration
from centrode.numerics.scans import evaluate
from centrode.structure.constraints import (
    AngleDrive,
    DisplacementDrive,
    DistanceDrive,
    constraints_of,
    is_drive,
)

Array: TypeAlias = npt.NDArray[np.float64]
Number: TypeAlias = Any

RANK = 1e-9
"""A singular value below this share of the greatest counts as none."""
CONSISTENT = 1e-9
"""Speeds contradict one another beyond this share of the fastest."""
CONDITION = 1e-9
"""Below this share of its greatest eigenvalue the mass matrix has no inverse."""
LOOKS = (0.0, 0.13, -0.17, 0.29)
"""How far along the free directions the rank is looked for, in rad or lengths: not all can be singular."""
ROWS, MOST_ROWS = 1024, 65536
"""Steps in one call of the integrator: few at first, as room is made for all of them."""
ATTEMPTS = 200_000
MOST_STEPS = 5_000_000
WILD = 1e5
"""Displacements over the greatest length, and speeds over those at the start, grow without bound beyond this."""
STALLED = 1e-13
"""A step below this share of the time reached is none."""

STATUSES = ("ok", "crossing", "doubtful")
CROSSING, NEAR_MISS = EVENTS = ("crossing", "near miss")
DOUBTFUL = 1e-3
"""Closures that come nearer to losing rank than this, and do not, leave it doubtful how the motion goes on."""
LOST = 1e-4
"""Closures that are no more independent than this, and no smooth motion through the place where they lose rank."""
ENERGY = 1e-7
"""Energies before and behind a change point agree to this share of the kinetic energy."""
DURATION, BLOW_UP, STEP_SIZE, CHANGE_POINT, INTERRUPTED = (
    "duration",
    "blow-up",
    "step size",
    "change point",
    "interrupted",
)
ADAPTIVE, STIFF = "adaptive", "stiff"


class Event(NamedTuple):
    """What happened on the way: when [s], what, and a number that belongs to it."""

    time: float
    kind: str
    detail: float


@dataclass(frozen=True)
class InitialState:
    """Joint coordinates and their speeds, closed and consistent."""

    coordinates: Array
    speeds: Array


@dataclass(frozen=True)
class Trajectory:
    """A motion at instants; shapes by n instants, c coordinates, p points, l links, g guides, d drives.

    Attributes
    ----------
    time : (n) [s]
    coordinates, speeds, accelerations : (n, c)
    places, velocities, point_accelerations : (n, p, axes) [m], in the order of `FreeMotion.points`
    angles, angular_velocities, angular_accelerations : (n, l), with their turns; NaN where a link has none
    attitudes, spins : (n, l, 3, 3), (n, l, 3), or None in the plane
    slides, slide_speeds, slide_accelerations : (n, g)
    drives, drive_speeds, drive_accelerations : (n, d)
    kinetic_energy, potential_energy : (n) [J]
    works : label -> (n) [J], since the start
    energy_residual : (n) [J]
    multipliers : (n, equations), NaN where redundant constraints leave them open
    kept_forces : drive -> (n) [N or N m]
    position_residual, velocity_residual : (n), of the cut loops
    statuses : (n), numbers in `STATUSES`
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


@dataclass(frozen=True)
class Course:
    """The steps of an integration: what was reached after each, the start first.

    Attributes
    ----------
    rows : (1 + carried, steps + 1), the times first
    between : times -> what is carried, of an implicit scheme; None where a step of the scheme itself tells it
    """

    rows: Array
    ended: str
    cause: str | None
    attempts: int
    events: tuple[Event, ...] = ()
    detours: tuple[Detour, ...] = ()
    between: Callable[[Array], Array] | None = None


@dataclass(frozen=True)
class FreeMotion:
    """A mechanism prepared for forward dynamics.

    Attributes
    ----------
    mechanism : the description
    equations : equations of motion with its numbers
    position : coordinates of the initial position
    mobility : degrees of freedom, kept drives taken off
    redundant : number of closure equations that others imply
    """

    mechanism: Mechanism
    equations: EquationsOfMotion
    position: InitialPosition
    mobility: int
    redundant: int

    @property
    def tree(self) -> SpanningTree:
        """Joint coordinates, and what they place."""
        return self.equations.tree

    @property
    def coordinates(self) -> tuple[JointCoordinate, ...]:
        """Joint coordinates in order."""
        return self.tree.coordinates

    @property
    def points(self) -> tuple[str, ...]:
        """Moving points, then those of the frame."""
        return (*self.mechanism.moving_points, *self.mechanism.frame.points)

    @property
    def links(self) -> tuple[str, ...]:
        """Links in description order."""
        return tuple(self.mechanism.links)

    @property
    def guides(self) -> tuple[str, ...]:
        """Guides in description order."""
        return tuple(guide.id for guide in self.mechanism.guides)

    @property
    def drives(self) -> tuple[str, ...]:
        """Drives in description order, kept and free."""
        return tuple(drive.id for drive in self.mechanism.drives)

    @property
    def closures(self) -> tuple[str, ...]:
        """Labels of the closure equations, one for each."""
        return tuple(c.label for c in self.equations.constraints for _equation in range(c.size))

    @property
    def massless(self) -> tuple[str, ...]:
        """Links without mass."""
        return massless_links(self.mechanism)

    @cached_property
    def variables(self) -> NumbersAsVariables:
        """The equations with numbers as variables: one for all mechanisms of this structure."""
        return NumbersAsVariables.of(self.equations)

    @cached_property
    def names(self) -> MotionNames:
        """Names of what is carried from step to step."""
        return MotionNames.of(self.equations)

    # the start

    def initial(
        self, speeds: Mapping[str, Any] | None = None, values: Mapping[str, float] | None = None
    ) -> InitialState:
        """The state at time zero: position closed, speeds consistent.

        Parameters
        ----------
        speeds : path -> speed
            "links.OA" [rad/s], "guides.B" [m/s], "drives.K" and "points.P" = (x, y) [m/s]; what they leave open is
            chosen by the least kinetic energy.
        values : "drives.K" -> value of a drive [rad or m] in place of that of the description

        Raises
        ------
        InputError
            A path names nothing, speeds contradict one another, or the position does not close.
        """
        coordinates = self.position.coordinates
        if values:
            coordinates = self._placed(dict(values))
        return InitialState(coordinates, self._speeds(coordinates, dict(speeds or {})))

    def _placed(self, values: dict[str, float]) -> Array:
        driven = {f"drives.{c.drive}": c for c in constraints_of(self.mechanism) if is_drive(c)}  # type: ignore[attr-defined]
        for path in values:
            if path not in driven:
                raise InputError(path, _("there is no such drive"), _("name a drive: drives.NAME"))
        starts = {path.removeprefix("drives."): float(value) for path, value in values.items()}
        # followed there in small steps, so that the branch is that of the description
        constraints = [*self.tree.closures, *(driven[path] for path in values)]
        here = self.drive_values(self.position.coordinates)
        place = self.position.coordinates
        farthest = max((abs(starts[name] - here[name]) for name in starts), default=0.0)
        count = max(1, int(np.ceil(farthest / (0.05 * float(min(1.0, self.equations.numbers.scale))))))
        for step in range(1, count + 1):
            part = {name: here[name] + (value - here[name]) * step / count for name, value in starts.items()}
            place = close_position(self.tree, self.equations.numbers, constraints, place, part)
        return place

    def drive_values(self, coordinates: Array) -> dict[str, float]:
        """Values of all drives [rad or m; on the sphere of guides rad] at joint coordinates."""
        state = self.equations.state(
            ARRAYS,
            self.tree.values(ARRAYS, list(coordinates)),
            [Jet((x, 0.0, 0.0)) for x in coordinates],
            0.0,
        )
        unit = length_unit(self.mechanism)
        return {
            drive.id: float(state.drive(drive).value) / (1.0 if drive.kind == "angle" else unit)
            for drive in self.mechanism.drives
        }

    def _speeds(self, coordinates: Array, speeds: dict[str, Any]) -> Array:
        equations, count = self.equations, len(coordinates)
        values = self.tree.values(ARRAYS, list(coordinates))
        still = equations.terms(ARRAYS, values, [0.0] * count, 0.0)
        rows = [_dense(row, count) for row in still.rows]
        right = [-float(x) for x in still.speeds]
        asked = {path: _numbers_of(speed) for path, speed in speeds.items()}
        mass = _mass_matrix(still.mass, count, units_of(self.tree, equations.numbers))
        found = np.zeros(count)
        if rows:
            found = _least_energy(mass, np.array(rows), np.array(right))
        for path, numbers in asked.items():
            # one after the other, so that what contradicts those before it is named
            wanted = self._speed_rows(coordinates, path)
            if len(wanted) != len(numbers):
                what = _("it takes {count} numbers").format(count=len(wanted))
                raise InputError(f"[simulation.speeds] {path}", what, _("give one for each axis"))
            rows += wanted
            right += numbers
            matrix, targets = np.array(rows), np.array(right)
            found = _least_energy(mass, matrix, targets)
            fastest = max(float(np.max(np.abs(found), initial=0.0)), *(abs(x) for x in right))
            gap = float(np.max(np.abs(matrix @ found - targets)))
            if gap > CONSISTENT * max(1.0, float(equations.numbers.scale)) * fastest:
                what = _("it contradicts the constraints or the speeds before it")
                raise InputError(f"[simulation.speeds] {path}", what, _("remove it, or correct it"))
        return found

    def _speed_rows(self, coordinates: Array, path: str) -> list[Array]:
        """Derivatives of what a path names by the coordinates, a row for each number."""
        kind, _dot, name = path.partition(".")
        known = {"links": self.links, "guides": self.guides, "drives": self.drives, "points": self.points}
        if name not in known.get(kind, ()):
            what = _("it names no link, guide, drive or point of the mechanism")
            raise InputError(
                f"[simulation.speeds] {path}",
                what,
                _("write links.NAME, guides.NAME, drives.NAME or points.NAME"),
            )
        columns = []
        found: tuple[Jet, ...]
        for k in range(len(coordinates)):
            values = self.tree.values(ARRAYS, list(coordinates))
            jets = [Jet((x, float(i == k), 0.0)) for i, x in enumerate(coordinates)]
            state = self.equations.state(ARRAYS, values, jets, 0.0)
            if kind == "links":
                found = (state.angle(name),)
            elif kind == "guides":
                found = (state.slide(name),)
            elif kind == "drives":
                found = (state.drive(next(d for d in self.mechanism.drives if d.id == name)),)
            else:
                found = state.point(name)
            columns.append([float(jet.coefficients[1]) for jet in found])
        return list(np.array(columns).T)

    # the motion

    def integrate(
        self,
        start: InitialState,
        duration: float,
        tolerance: float = 1e-9,
        at: npt.ArrayLike | None = None,
        samples: int = 401,
        scheme: str = ADAPTIVE,
        executor: str = "auto",
        progress: Callable[[float], None] | None = None,
    ) -> Trajectory:
        """The motion from a state.

        Parameters
        ----------
        duration [s], tolerance : of the error of a step, relative to what moves
        at : (n) [s], instants within the duration; `samples` evenly spaced ones where they are left out
        progress : called with the time reached

        Raises
        ------
        InputError
            A duration that is not positive, or instants outside.
        """
        if not (isfinite(duration) and duration > 0.0):
            raise InputError(
                "[simulation] duration", _("it has to be positive"), _("give a time, such as 10 s")
            )
        times = np.linspace(0.0, duration, samples) if at is None else np.asarray(at, dtype=np.float64)
        if np.any((times < 0.0) | (times > duration * (1.0 + 1e-12))) or np.any(np.diff(times) < 0.0):
            raise InputError("at", _("instants lie within the duration and grow"), _("correct them"))
        if scheme not in (ADAPTIVE, STIFF):
            what = _("there is no scheme {name} for all coordinates").format(name=scheme)
            raise InputError("[simulation] scheme", what, _("adaptive or stiff"))
        integrate = self.course if scheme == ADAPTIVE else self.stiff_course
        course = integrate(start, duration, tolerance, executor, progress)
        reached = float(course.rows[0, -1])
        times = times[times <= reached] if course.ended != DURATION else np.minimum(times, reached)
        states = self.states_at(course, times, executor)
        return self.trajectory(course, times, states, scheme, choose_executor(executor))

    @cached_property
    def problem(self) -> InitialValueProblem:
        """The initial value problem, its numbers being parameters."""
        return motion_problem(self.variables.equations, self.variables.parameters)

    def integrator(self, executor: str = "auto") -> Integrator:
        """What takes steps of one mechanism, by an executor."""
        return integrator_of(self.problem, executor)

    def parameters(self, end: Number, tolerance: Number, rate: Number, lanes: int = 1) -> Array:
        """Values of the parameters (parameters, lanes)."""
        smallest = STALLED * np.maximum(np.asarray(end, dtype=np.float64), 1.0 / np.asarray(rate))
        smallest = np.where(np.isfinite(smallest), smallest, 0.0)
        controls = dict(
            zip(CONTROLS, (end, smallest, tolerance, rate, float(self.equations.numbers.scale)), strict=True)
        )
        rows = np.array([np.broadcast_to(controls[name], lanes) for name in CONTROLS], dtype=np.float64)
        numbers = self.variables.values(self.equations)
        return np.concatenate([rows, np.broadcast_to(numbers, (len(numbers), lanes))])

    def rate(self, start: InitialState) -> float:
        """What speeds are compared with [1/s]: those at the start, and what the accelerations make of a rest."""
        units = units_of(self.tree, self.equations.numbers)
        values = self.tree.values(ARRAYS, list(start.coordinates))
        with np.errstate(all="ignore"):
            terms = self.equations.terms(ARRAYS, values, list(start.speeds), 0.0)
            accelerations, _forces, _flags = self.equations.accelerations(ARRAYS, terms)
        fast = float(np.max(np.abs(start.speeds) / units, initial=0.0))
        bent = float(np.max(np.abs(np.array(accelerations, dtype=np.float64)) / units, initial=0.0))
        rate = max(fast, np.sqrt(bent) if isfinite(bent) else 0.0)
        return rate if rate > 0.0 else 1.0

    def carried_at(self, start: InitialState) -> Array:
        """What the integrator carries, at a state that closes."""
        names = self.names
        found = dict.fromkeys(self.problem.carried, 0.0)
        found |= dict(zip(names.coordinates, start.coordinates, strict=True))
        found |= dict(zip(names.speeds, start.speeds, strict=True))
        closing = evaluate(
            self.problem.of_closing,
            found
            | {TIME: 0.0, STEP: 1.0}
            | dict(zip(self.problem.parameters, self.parameters(1.0, 1.0, 1.0)[:, 0], strict=True)),
        )
        # rotors and flags are those of the start; the start itself is closed already
        kept = (*names.coordinates, *names.speeds, *names.works)
        return np.array(
            [found[name] if name in kept else float(closing[name]) for name in self.problem.carried]
        )

    def course(
        self,
        start: InitialState,
        duration: float,
        tolerance: float,
        executor: str = "auto",
        progress: Callable[[float], None] | None = None,
    ) -> Course:
        """Steps from a state to a time."""
        take, rate = self.integrator(executor), self.rate(start)
        parameters = self.parameters(duration, tolerance, rate)
        first = min(duration, 0.01 / rate)
        state = np.concatenate([[0.0, first, 0.0, 0.0], self.carried_at(start)])[:, None]
        kept = [np.concatenate([[0.0], state[HEADER:, 0]])[None]]
        attempts, steps, room = 0, 0, ROWS
        ended, cause = DURATION, None
        guard = HEADER + self.problem.carried.index(GUARD) if self.problem.guard else None
        events: list[Event] = []
        detours: list[Detour] = []
        while float(state[0, 0]) < duration:
            rows = np.empty((room, len(kept[0][0])))
            state = take.run(parameters, state, ATTEMPTS, rows)
            attempts += int(state[2, 0])
            written = int(state[3, 0])
            steps += written
            kept.append(rows[:written])
            time, size = float(state[0, 0]), float(state[1, 0])
            if progress is not None:
                progress(time)
            if time >= duration:
                break
            if guard is not None and state[guard, 0] != 0.0:
                passed = self._pass(parameters, state, tolerance)
                if isinstance(passed, str):
                    ended, cause = CHANGE_POINT, passed
                    break
                detour, event = passed
                if event is not None and event.kind == NEAR_MISS:
                    # looked at again and again on the way there, it is one
                    events = [
                        one
                        for one in events
                        if one.kind != NEAR_MISS or abs(one.time - event.time) > FAR / rate
                    ]
                events += [event] if event is not None else []
                if detour is not None:
                    detours.append(detour)
                    kept.append(np.concatenate([[float(state[0, 0])], state[HEADER:, 0]])[None])
                continue
            away = self._farthest(state, rate)
            if away > WILD:
                ended = BLOW_UP
                cause = _(
                    "at {time:.9g} s something had moved {far:.3g} times the greatest length or as fast as that"
                )
                cause = cause.format(time=time, far=away)
                break
            if not size > parameters[CONTROLS.index(SMALLEST), 0]:
                wild = not np.all(np.isfinite(state)) or away > WILD
                ended = BLOW_UP if wild else STEP_SIZE
                cause = _("at {time:.9g} s the step became as small as {step:.3g} s").format(
                    time=time, step=size
                )
                break
            if steps >= MOST_STEPS:
                ended, cause = STEP_SIZE, _("more than {count} steps").format(count=MOST_STEPS)
                break
            room = min(4 * room, MOST_ROWS)
        return Course(np.concatenate(kept).T, ended, cause, attempts, tuple(events), tuple(detours))

    def stiff_course(
        self,
        start: InitialState,
        duration: float,
        tolerance: float,
        executor: str = "auto",
        progress: Callable[[float], None] | None = None,
    ) -> Course:
        """Steps of SciPy's Radau, for loads so stiff or so strongly damped that they hold explicit steps back."""
        followed = PythonIntegration(self.problem)
        parameters = [float(x) for x in self.parameters(duration, tolerance, self.rate(start))[:, 0]]
        carried = self.carried_at(start)
        names, count = self.names, len(self.problem.followed)
        angles = np.array(self.tree.angles, dtype=np.intp)
        own = [
            *range(*names.part(names.coordinates).indices(count)),
            *range(*names.part(names.speeds).indices(count)),
        ]
        own += range(*names.part(names.works).indices(count))

        def whole(y: Array) -> list[float]:
            values = carried.copy()
            values[own] = y
            turned = values[names.part(names.coordinates)][angles]
            values[names.part(names.cosines)], values[names.part(names.sines)] = (
                np.cos(turned),
                np.sin(turned),
            )
            return [float(x) for x in values]

        def rates(t: float, y: Array) -> Array:
            return np.array(followed.rates([t, *parameters, *whole(y)]))[own]

        solver = Radau(rates, 0.0, carried[own], duration, rtol=max(tolerance, 1e-12), atol=tolerance)
        rows = [np.concatenate([[0.0], carried])]
        pieces = []
        ended, cause = DURATION, None
        while solver.status == "running":
            solver.step()
            if solver.status == "failed" or not np.all(np.isfinite(solver.y)):
                ended, cause = STEP_SIZE, _("at {time:.9g} s the step became too small").format(time=solver.t)
                break
            step = solver.t - rows[-1][0]
            pieces.append(solver.dense_output())
            carried = np.array(followed.closing([solver.t, step, *parameters, *whole(solver.y)]))
            solver.y = carried[own]
            rows.append(np.concatenate([[solver.t], carried]))
            if progress is not None:
                progress(float(solver.t))
        reached = np.array(rows).T
        followed_between = OdeSolution(reached[0], pieces)

        def between(times: Array) -> Array:
            found = np.zeros((len(carried), len(times)))
            found[own] = followed_between(times)
            return found

        return Course(reached, ended, cause, len(rows) - 1, between=between)

    @cached_property
    def _half_circles(self) -> HalfCircles:
        return HalfCircles(self.problem)

    def _pass(
        self, parameters: Array, state: Array, tolerance: float
    ) -> tuple[Detour | None, Event | None] | str:
        """Pass the change point ahead, if it is one; the state is that behind it then.

        Returns the detour and the event, or why it is not passed.
        """
        carried = list(self.problem.carried)
        row = {name: HEADER + carried.index(name) for name in (AHEAD, LOOKED, GUARD, LIMIT, INDEPENDENCE)}
        time, ahead, near = (
            float(state[0, 0]),
            float(state[row[AHEAD], 0]),
            float(state[row[INDEPENDENCE], 0]),
        )
        units = units_of(self.tree, self.equations.numbers)
        measured = [(self.names.part(kind), units) for kind in (self.names.coordinates, self.names.speeds)]
        detour = self._half_circles.around(parameters[:, 0], time, state[HEADER:, 0], ahead, measured)
        if not detour.is_passed:
            if near < LOST:
                what = _("a change point at {time:.9g} s through which no smooth motion leads")
                return what.format(time=detour.centre)
            state[row[LOOKED], 0], state[row[GUARD], 0] = 0.5 * near, 0.0
            return None, Event(detour.centre, NEAR_MISS, near) if near < DOUBTFUL else None
        count = len(self.problem.followed)
        before = self._energy(state[HEADER:, 0], time)
        landed = detour.at(np.array([detour.end]))[:, 0]
        values = dict(zip(carried, state[HEADER:, 0], strict=True)) | dict(
            zip(carried[:count], landed, strict=True)
        )
        given = dict(zip(self.problem.parameters, parameters[:, 0], strict=True))
        values[INDEPENDENCE] = 0.0
        closed = evaluate(self.problem.of_closing, values | given | {TIME: detour.end, STEP: 1.0})
        state[HEADER:, 0] = [float(closed[name]) for name in carried]
        state[0, 0] = detour.end
        state[1, 0] = 0.25 * ahead
        after = self._energy(state[HEADER:, 0], detour.end)
        scale = max(abs(before[0]), abs(after[0]))
        if abs(sum(after) - sum(before)) > max(ENERGY, 100.0 * tolerance) * scale:
            what = _("a change point at {time:.9g} s behind which the energy would be another")
            return what.format(time=detour.centre)
        return detour, Event(detour.centre, CROSSING, sum(after) - sum(before))

    def _energy(self, carried: Array, time: float) -> tuple[float, float]:
        """Kinetic energy, and potential energy less the works, of what is carried."""
        names = self.names
        q, w = list(carried[names.part(names.coordinates)]), list(carried[names.part(names.speeds)])
        kinetic, potential = self.equations.energies(ARRAYS, self.tree.values(ARRAYS, q), w, time)
        return float(kinetic), float(potential) - float(np.sum(carried[names.part(names.works)]))

    def _farthest(self, state: Array, rate: float) -> float:
        """The greatest displacement over the greatest length, or speed over what speeds are compared with."""
        names, units = self.names, units_of(self.tree, self.equations.numbers)
        values = np.abs(state[HEADER:, 0])
        slid = np.array([one.kind != "angle" for one in self.coordinates])
        moved = values[names.part(names.coordinates)] / units
        fast = values[names.part(names.speeds)] / units / rate
        return float(max(np.max(moved[slid], initial=0.0), 1e-3 * np.max(fast, initial=0.0)))

    def states_at(self, course: Course, times: Array, executor: str = "auto") -> Array:
        """What is carried at instants (rows, n): one step from the last one before each, as long as is needed."""
        rows, n = course.rows, len(times)
        if course.between is not None:
            return course.between(times)
        begin = np.clip(np.searchsorted(rows[0], times, side="right") - 1, 0, rows.shape[1] - 1)
        lanes = rows[:, begin]
        state = np.concatenate([lanes[:1], np.full((1, n), inf), np.zeros((2, n)), lanes[1:]])
        if not n:
            return rows[1:, :0]
        guarded = [name for name in (LIMIT, GUARD) if name in self.problem.carried]
        for name in guarded:
            state[HEADER + self.problem.carried.index(name)] = NEVER if name == LIMIT else 0.0
        found = self.integrator(executor).run(self.parameters(times, inf, 1.0, n), state, 1)[HEADER:]
        count = len(self.problem.followed)
        for detour in course.detours:
            inside = (times > detour.begin) & (times < detour.end)
            found[:count, inside] = detour.at(times[inside])
        return found

    def trajectory(
        self, course: Course, times: Array, states: Array, scheme: str, executor: str
    ) -> Trajectory:
        """Everything that a motion shows at instants, from its states."""
        count, equations = len(self.coordinates), self.equations
        names = self.names
        q, w = list(states[names.part(names.coordinates)]), list(states[names.part(names.speeds)])
        n = len(times)
        with np.errstate(all="ignore"):
            values = self.tree.values(ARRAYS, q)
            terms = equations.terms(ARRAYS, values, w, times)
            a, forces, _flags = equations.accelerations(ARRAYS, terms)
            jets = [Jet((x, y, 0.5 * z)) for x, y, z in zip(q, w, a, strict=True)]
            state = equations.state(ARRAYS, values, jets, times)
            kinetic = _row(equations.kinetic_energy(state), n)
            potential = _row(equations.potential_energy(state), n)
            works: dict[str, Array] = {}
            free = np.zeros(n)
            begun = self._state_at_start(course)
            for load in equations.loads:
                energy = getattr(load.term.amount, "energy", None)
                if energy is not None:
                    coordinate = load.term.coordinate
                    done = _row(energy(coordinate.value(begun)) - energy(coordinate.value(state)), n)
                    works[load.label] = works.get(load.label, 0.0) + done
            followed = [equations.loads[k].label for k in worked_loads(equations)]
            followed += [f"drive {kept.name}" for kept in equations.kept]
            for label, work in zip(followed, states[names.part(names.works)], strict=True):
                works[label] = works.get(label, 0.0) + work
                free = free + work
            residual = kinetic + potential - free
            began = float(equations.kinetic_energy(begun)) + float(equations.potential_energy(begun))
            points = _orders([state.point(name) for name in self.points], n)
            angles = _orders([(self._angle(state, name),) for name in self.links], n)[..., 0]
            slides = _orders([(state.slide(name),) for name in self.guides], n)[..., 0]
            drives = _orders([(self._drive(state, name),) for name in self.drives], n)[..., 0]
            attitudes, spins = self._attitudes(state, n)
            multipliers = np.array([_row(x, n) for x in forces]).reshape(len(forces), n).T
            kept = {
                kept.name: -multipliers[:, equations.equations - len(equations.kept) + k]
                for k, kept in enumerate(equations.kept)
            }
            if equations.dependent:
                multipliers[:, sorted(equations.dependent)] = np.nan
            gaps = [np.abs(_row(x, n)) for x in terms.values]
            drifts = [np.abs(_row(x, n)) for x in terms.speeds]
        return Trajectory(
            times, np.array(q).T.reshape(n, count), np.array(w).T.reshape(n, count),
            np.array([_row(x, n) for x in a]).T.reshape(n, count),
            points[0], points[1], points[2], angles[0], angles[1], angles[2], attitudes, spins,
            slides[0], slides[1], slides[2], drives[0], drives[1], drives[2],
            kinetic, potential, works, residual - began, multipliers, kept,
            np.max(gaps, axis=0, initial=0.0) if gaps else np.zeros(n),
            np.max(drifts, axis=0, initial=0.0) if drifts else np.zeros(n),
            _statuses(course, times), course.events, course.ended, course.cause, scheme, executor,
            course.rows.shape[1] - 1, course.attempts,
        )  # fmt: skip

    def _state_at_start(self, course: Course) -> JointState:
        names, row = self.names, course.rows[1:, 0]
        q, w = list(row[names.part(names.coordinates)]), list(row[names.part(names.speeds)])
        jets = [Jet((x, y, 0.0)) for x, y in zip(q, w, strict=True)]
        return self.equations.state(ARRAYS, self.tree.values(ARRAYS, q), jets, 0.0)

    def _angle(self, state: Any, link: str) -> Jet:
        try:
            return state.angle(link)  # type: ignore[no-any-return]
        except NotComputedYet:
            return Jet((np.nan, np.nan, np.nan))

    def _drive(self, state: Any, name: str) -> Jet:
        return state.drive(next(d for d in self.mechanism.drives if d.id == name))  # type: ignore[no-any-return]

    def _attitudes(self, state: Any, n: int) -> tuple[Array | None, Array | None]:
        if self.mechanism.space != "sphere":
            return None, None
        axes = [
            [[_row(x.coefficients[0], n) for x in axis] for axis in state.attitude(name)]
            for name in self.links
        ]
        spins = [[_row(x.coefficients[0], n) for x in state.spin(name)] for name in self.links]
        return np.moveaxis(np.array(axes), -1, 0), np.moveaxis(np.array(spins), -1, 0)


def _statuses(course: Course, times: Array) -> npt.NDArray[np.int8]:
    statuses = np.zeros(len(times), dtype=np.int8)
    for event in course.events:
        if event.kind == NEAR_MISS:
            statuses[times >= event.time] = STATUSES.index("doubtful")
    for detour in course.detours:
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


def _dense(row: Mapping[int, Number], count: int) -> Array:
    found = np.zeros(count)
    for k, x in row.items():
        found[k] = float(x)
    return found


def _mass_matrix(mass: Mapping[tuple[int, int], Number], count: int, units: Array) -> Array:
    found = np.zeros((count, count))
    for (i, j), x in mass.items():
        found[i, j] = found[j, i] = float(x)
    # where nothing has mass the way itself is to be least
    least = 1e-6 * (float(np.max(np.diag(found) * units**2, initial=0.0)) or 1.0)
    return found + np.diag(least / units**2) * (np.diag(found) * units**2 < least)


def _least_energy(mass: Array, matrix: Array, targets: Array) -> Array:
    """The speeds of least kinetic energy that keep equations as well as can be."""
    factor = np.linalg.cholesky(mass).T
    turned = matrix @ np.linalg.inv(factor)
    sizes = np.linalg.norm(turned, axis=1)
    # a row of rounding asks for nothing
    scales = np.where(sizes > RANK * np.max(sizes, initial=0.0), sizes, np.inf)
    found = np.linalg.lstsq(turned / scales[:, None], targets / scales, rcond=RANK)[0]
    return np.asarray(np.linalg.solve(factor, found))


def _numbers_of(speed: Any) -> tuple[float, ...]:
    return tuple(float(x) for x in speed) if isinstance(speed, Sequence) else (float(speed),)


# Preparation: kept drives, redundant closures, masses that do not do.


def free_motion_of(
    mechanism: Mechanism, keeps: Sequence[str] = (), efforts: Sequence[DriveEffort] = ()
) -> FreeMotion:
    """A mechanism prepared to be left to its loads.

    Parameters
    ----------
    keeps : drives that keep their laws; all others are free
    efforts : forces of drives besides the loads

    Raises
    ------
    InputError
        It does not close, nothing has a mass, or a motion is possible that moves none.
    NotComputedYet
        Dry friction and whatever jumps with the sense of a motion; kept drives whose law is a table.
    """
    tree = spanning_tree_of(mechanism)
    position = position_of_description(mechanism, tree)
    burden = MassesAndLoads.of(mechanism)
    loads = free_loads_of(mechanism, burden.loads, efforts)
    kept = _kept_drives(mechanism, float(position.numbers.scale), keeps)
    equations = EquationsOfMotion(tree, position.numbers, burden.masses, loads, kept)
    looked = [place for place in _places_near(equations, position.coordinates)]
    ranks = [_closure_rank(equations, place) for place in looked]
    rank = max(ranks)
    mobility = equations.size - rank
    count = equations.equations
    if rank < count:
        generic = looked[ranks.index(rank)]
        equations = replace(equations, dependent=_dependent_equations(equations, generic, rank))
    equations = _with_weights(equations, looked)
    equations = replace(equations, references=_references(equations, looked))
    return FreeMotion(mechanism, equations, position, mobility, count - rank)


def _is_formula(law: Law) -> bool:
    """Whether a law can be traced: a table chooses its row by the value of the time."""
    try:
        law.jet(JetFunctions(EXPRESSIONS), Jet((variable(TIME), 1.0, 0.0)))
    except TypeError:
        return False
    return True


def _kept_drives(mechanism: Mechanism, scale: float, keeps: Sequence[str]) -> tuple[KeptDrive, ...]:
    if not keeps:
        return ()
    driven: dict[str, DrivenBy] = {one.drive.id: one for one in path_of(mechanism, scale).driven}
    found = []
    for constraint in constraints_of(mechanism):
        if (
            isinstance(constraint, AngleDrive | DisplacementDrive | DistanceDrive)
            and constraint.drive in keeps
        ):
            law = driven[constraint.drive].law
            if not _is_formula(law):
                what = _("a drive that keeps a law by a table is not computed here")
                raise NotComputedYet(f"[[drives]] {constraint.drive}", what, _("give a speed or a formula"))
            found.append(KeptDrive(constraint, driven[constraint.drive]))
    return tuple(found)


def _places_near(equations: EquationsOfMotion, coordinates: Array) -> list[Array]:
    """The position itself and some that close near it, along the free directions."""
    units = units_of(equations.tree, equations.numbers)
    places = [coordinates]
    generator = np.random.default_rng(2)
    for far in LOOKS[1:]:
        _left, rows = residuals_and_rows(
            equations.tree, equations.numbers, equations.tree.closures, coordinates, {}
        )
        if len(rows):
            scaled = rows * units / equation_units(equations.tree.closures, equations.numbers)[:, None]
            _u, sizes, turned = np.linalg.svd(scaled)
            free = turned[int(np.sum(sizes > RANK * max(sizes, default=1.0))) :]
        else:
            free = np.eye(len(coordinates))
        if not len(free):
            continue
        way = generator.uniform(0.5, 1.0, len(free)) @ free
        guess = coordinates + far * units * way / max(float(np.max(np.abs(way))), 1e-12)
        try:
            places.append(
                close_position(equations.tree, equations.numbers, equations.tree.closures, guess, {})
            )
        except InputError:
            continue
    return places


def _scaled_rows(equations: EquationsOfMotion, coordinates: Array) -> Array:
    starts = {kept.name: float(kept.driven.initial) for kept in equations.kept}
    _left, rows = residuals_and_rows(
        equations.tree, equations.numbers, equations.constraints, coordinates, starts
    )
    units = units_of(equations.tree, equations.numbers)
    return np.asarray(rows * units / equation_units(equations.constraints, equations.numbers)[:, None])


def _closure_rank(equations: EquationsOfMotion, coordinates: Array) -> int:
    rows = _scaled_rows(equations, coordinates)
    sizes = np.linalg.svd(rows, compute_uv=False) if len(rows) else np.zeros(0)
    return int(np.sum(sizes > RANK * max(sizes, default=1.0)))


def _dependent_equations(equations: EquationsOfMotion, coordinates: Array, rank: int) -> frozenset[int]:
    """Equations that take part in what others imply: where the left null space of their rows is not zero."""
    rows = _scaled_rows(equations, coordinates)
    left, _sizes, _right = np.linalg.svd(rows)
    null = left[:, rank:]
    return frozenset(int(k) for k in np.nonzero(np.max(np.abs(null), axis=1) > 1e-7)[0])


def _with_weights(equations: EquationsOfMotion, places: Sequence[Array]) -> EquationsOfMotion:
    """Weights of the closures where links are without mass; InputError where a motion moves no mass."""
    units, count = units_of(equations.tree, equations.numbers), equations.size
    weak = False
    carried = 0.0
    for place in places:
        values = equations.tree.values(ARRAYS, list(place))
        terms = equations.terms(ARRAYS, values, [0.0] * count, 0.0)
        mass = np.zeros((count, count))
        for (i, j), x in terms.mass.items():
            mass[i, j] = mass[j, i] = float(x) * units[i] * units[j]
        sizes = np.linalg.eigvalsh(mass) if count else np.ones(1)
        weak = weak or sizes[0] <= CONDITION * max(float(sizes[-1]), 1e-300)
        rows = _scaled_rows(equations, place)
        free = _null_space(rows, count)
        of_free = np.linalg.eigvalsh(free.T @ mass @ free) if free.shape[1] else np.ones(1)
        carried = max(carried, float(of_free[0]) / max(float(sizes[-1]), 1e-300))
    if carried <= 1e-14:
        what = _("a motion is possible that moves no mass")
        raise InputError("[links]", what, _("give the links that move alone a mass"))
    if not weak:
        return equations
    return replace(equations, weights=_weights(equations, places[-1], units))


def _references(equations: EquationsOfMotion, places: Sequence[Array]) -> tuple[float, ...]:
    """The greatest diagonal of S at some places, the same for all equations of a constraint."""
    greatest = np.zeros(equations.equations)
    for place in places:
        values = equations.tree.values(ARRAYS, list(place))
        system = equations.system(ARRAYS, equations.terms(ARRAYS, values, [0.0] * equations.size, 0.0))
        greatest = np.maximum(greatest, np.array(system.diagonal, dtype=np.float64))
    first = 0
    for constraint in equations.constraints:
        own = slice(first, first + constraint.size)
        greatest[own] = np.sum(greatest[own])
        first += constraint.size
    return tuple(float(x) if x > 0.0 else 1.0 for x in greatest)


def _null_space(rows: Array, count: int) -> Array:
    if not len(rows):
        return np.eye(count)
    _left, sizes, right = np.linalg.svd(rows)
    rank = int(np.sum(sizes > RANK * max(sizes, default=1.0)))
    return np.asarray(right[rank:].T)


def _weights(equations: EquationsOfMotion, place: Array, units: Array) -> tuple[float, ...]:
    """A mass for each closure equation: that of the links over the square of its row."""
    values = equations.tree.values(ARRAYS, list(place))
    terms = equations.terms(ARRAYS, values, [0.0] * equations.size, 0.0)
    heaviest = max((float(x) * units[i] ** 2 for (i, j), x in terms.mass.items() if i == j), default=1.0)
    sizes = [sum((float(x) * units[k]) ** 2 for k, x in row.items()) for row in terms.rows]
    return tuple(heaviest / size if size > 0.0 else heaviest for size in sizes)
