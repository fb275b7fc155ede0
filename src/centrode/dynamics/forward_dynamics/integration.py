"""The integration of a free motion: steps from a state, explicit or implicit, and what is carried between them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from importlib import import_module
from math import inf, isfinite
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.forward_dynamics.change_points import Detour, HalfCircles
from centrode.dynamics.forward_dynamics.controllers import states_of
from centrode.dynamics.forward_dynamics.equations_of_motion import EquationsOfMotion
from centrode.dynamics.forward_dynamics.event_steps import EventWatch, contact_function, row_of
from centrode.dynamics.forward_dynamics.initial_position import units_of
from centrode.dynamics.forward_dynamics.initial_state import InitialState
from centrode.dynamics.forward_dynamics.model_numbers import NumbersAsVariables
from centrode.dynamics.forward_dynamics.motion_problem import (
    AHEAD,
    CONTROLS,
    FAR,
    GUARD,
    INDEPENDENCE,
    LIMIT,
    LOOKED,
    NEVER,
    PASSED,
    MotionNames,
    motion_problem,
)
from centrode.dynamics.forward_dynamics.motion_steps import (
    BLOW_UP,
    CHANGE_POINT,
    CROSSING,
    DURATION,
    NEAR_MISS,
    STEP_SIZE,
    Event,
    MotionSteps,
)
from centrode.locale import _
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.initial_value_problems import (
    END,
    HEADER,
    SMALLEST,
    STEP,
    TIME,
    InitialValueProblem,
)
from centrode.numerics.integrators import Integrator, integrator_of
from centrode.numerics.python_functions import Function
from centrode.numerics.python_integrations import PythonIntegration
from centrode.numerics.scans import evaluate

Array: TypeAlias = npt.NDArray[np.float64]
Number: TypeAlias = Any

# explicit steps need no SciPy, which takes longer to load than most motions take
_integrate = partial(import_module, "scipy.integrate")

ROWS, MOST_ROWS = 1024, 65536
"""Steps in one call of the integrator: few at first, as room is made for all of them."""
ATTEMPTS = 200_000
"""Steps tried in one call of the integrator, so that progress is shown between calls."""
MOST_STEPS = 5_000_000
"""Steps of one motion, beyond which it ends."""
WILD = 1e5
"""Displacements over the greatest length, and speeds over those at the start, grow without bound beyond this."""
STALLED = 1e-13
"""A step below this share of the time reached is none."""
DOUBTFUL = 1e-3
"""Closures that come nearer to losing rank than this, and do not, leave it doubtful how the motion goes on."""
LOST = 1e-4
"""Closures that are no more independent than this, and no smooth motion through the place where they lose rank."""
TOO_NEAR = 0.05
"""A change point is passed from a place from which the fastest link turns by more than this up to it."""
ENERGY = 1e-7
"""Energies before and behind a change point agree to this share of the kinetic energy."""


@dataclass(frozen=True)
class MotionIntegration:
    """Equations of motion as an initial value problem whose steps can be taken.

    Their numbers are parameters of the problem, so that mechanisms of one structure share one kernel.
    """

    equations: EquationsOfMotion

    @cached_property
    def variables(self) -> NumbersAsVariables:
        """The equations with numbers as variables: one for all mechanisms of this structure."""
        return NumbersAsVariables.of(self.equations)

    @cached_property
    def names(self) -> MotionNames:
        """Names of what is carried from step to step."""
        return MotionNames.of(self.equations)

    @cached_property
    def problem(self) -> InitialValueProblem:
        """The initial value problem, its numbers being parameters."""
        return motion_problem(self.variables.equations, self.variables.parameters)

    @cached_property
    def contact_function(self) -> Function:
        """What contacts feel at one state; see `event_steps.contact_function`."""
        return contact_function(self.variables.equations, self.names, self.problem)

    @cached_property
    def closing_function(self) -> Function:
        """What a state ends with behind an event, on plain numbers."""
        return PythonIntegration(self.problem).closing

    def with_numbers(self, equations: EquationsOfMotion) -> MotionIntegration:
        """The same problem for equations of the same structure with other numbers."""
        other = MotionIntegration(equations)
        shared: tuple[str, ...] = ("variables", "names", "problem", "_half_circles")
        shared += ("contact_function", "closing_function") if self.equations.has_events else ()
        for name in shared:
            other.__dict__[name] = getattr(self, name)
        return other

    def integrator(self, executor: str = "auto") -> Integrator:
        """What takes steps of one mechanism, by an executor."""
        return integrator_of(self.problem, executor)

    def parameters(self, end: Number, tolerance: Number, rate: Number, lanes: int = 1) -> Array:
        """Values of the parameters (parameters, lanes).

        Parameters
        ----------
        end : time at which steps end [s]
        tolerance : of the error of a step
        rate : what speeds are compared with [1/s]
        """
        smallest = STALLED * np.maximum(np.asarray(end, dtype=np.float64), 1.0 / np.asarray(rate))
        smallest = np.where(np.isfinite(smallest), smallest, 0.0)
        controls = dict(
            zip(CONTROLS, (end, smallest, tolerance, rate, float(self.equations.numbers.scale)), strict=True)
        )
        rows = np.array([np.broadcast_to(controls[name], lanes) for name in CONTROLS], dtype=np.float64)
        numbers = self.variables.values(self.equations)
        return np.concatenate([rows, np.broadcast_to(numbers, (len(numbers), lanes))])

    def rate(self, start: InitialState, duration: float = inf) -> float:
        """What speeds are compared with [1/s]: those at the start, and what the accelerations make of a rest.

        In equilibrium both are rounding: then what counts is what would be seen at the end of a duration [s].
        """
        units = units_of(self.equations.tree, self.equations.numbers)
        values = self.equations.tree.values(ARRAYS, list(start.coordinates))
        with np.errstate(all="ignore"):
            terms = self.equations.terms(ARRAYS, values, list(start.speeds), 0.0)
            accelerations, _forces, _flags = self.equations.accelerations(ARRAYS, terms)
        fast = float(np.max(np.abs(start.speeds) / units, initial=0.0))
        bent = float(np.max(np.abs(np.array(accelerations, dtype=np.float64)) / units, initial=0.0))
        least = 1.0 / duration if duration > 0.0 else 0.0
        rate = max(fast, np.sqrt(bent) if isfinite(bent) else 0.0, least)
        return rate if rate > 0.0 else 1.0

    def carried_values(self, start: InitialState) -> Array:
        """What the integrator carries (carried), at a state that closes."""
        names = self.names
        found = dict.fromkeys(self.problem.carried_names, 0.0)
        found |= dict(zip(names.coordinates, start.coordinates, strict=True))
        found |= dict(zip(names.speeds, start.speeds, strict=True))
        found |= dict(zip(names.states, states_of(self.equations.controls), strict=True))
        closing = evaluate(
            self.problem.of_closing,
            found
            | {TIME: 0.0, STEP: 1.0}
            | dict(zip(self.problem.parameters, self.parameters(1.0, 1.0, 1.0)[:, 0], strict=True)),
        )
        # rotors and flags are those of the start; the start itself is closed already
        kept = (*names.coordinates, *names.speeds, *names.works, *names.states)
        return np.array(
            [found[name] if name in kept else float(closing[name]) for name in self.problem.carried_names]
        )

    def explicit_steps(
        self,
        start: InitialState,
        duration: float,
        tolerance: float,
        executor: str = "auto",
        progress: Callable[[float], None] | None = None,
    ) -> MotionSteps:
        """Steps of the explicit scheme from a state to a time; change points on the way are passed.

        Parameters
        ----------
        duration [s], tolerance : of the error of a step, relative to what moves
        progress : called with the time reached [s]
        """
        take, rate = self.integrator(executor), self.rate(start, duration)
        parameters = self.parameters(duration, tolerance, rate)
        first = min(duration, 0.01 / rate)
        state = np.concatenate([[0.0, first, 0.0, 0.0], self.carried_values(start)])[:, None]
        kept = [np.concatenate([[0.0], state[HEADER:, 0]])[None]]
        watch = EventWatch(self, take, parameters, rate) if self.equations.has_events else None
        if watch is not None:
            state = watch.begin(state)
            kept = [np.concatenate([[0.0], state[HEADER:, 0]])[None]]
        attempts, steps, room, rows = 0, 0, ROWS, np.empty((0, 0))
        ended, cause = DURATION, None
        guard = HEADER + self.problem.carried_names.index(GUARD) if self.problem.guard else None
        events: list[Event] = []
        detours: list[Detour] = []
        while float(state[0, 0]) < duration:
            if not len(rows):
                rows = np.empty((room, len(kept[0][0])))
            pause = duration if watch is None else watch.next_release(float(state[0, 0]), duration)
            parameters[CONTROLS.index(END), 0] = pause
            state = take.run(parameters, state, ATTEMPTS, rows)
            attempts += int(state[2, 0])
            written = int(state[3, 0])
            steps += written
            kept.append(rows[:written])
            rows = rows[written:]
            time, size = float(state[0, 0]), float(state[1, 0])
            if progress is not None:
                progress(time)
            if watch is not None and state[guard, 0] >= PASSED:
                # the step that went beyond the event is taken again
                kept[-1] = kept[-1][:-1]
                before = next(some[-1] for some in reversed(kept) if len(some))
                row, state, ends = watch.pass_event(before, state, max(size, 0.5 * (time - before[0])))
                kept += [row[None], row_of(state)[None]]
                if ends:
                    ended, cause = watch.ending
                    break
                continue
            if watch is not None and time >= pause and pause < duration:
                state = watch.release(state, time)
                kept.append(row_of(state)[None])
                if watch.ending[1] is not None:
                    ended, cause = watch.ending
                    break
                continue
            if time >= duration:
                break
            if guard is not None and state[guard, 0] != 0.0:
                back = self._step_back(take, parameters, state, kept, detours, rate)
                passed = self._pass_change_point(
                    parameters, state if back is None else back[0], tolerance, watch
                )
                if back is not None and not isinstance(passed, str) and passed[0] is not None:
                    state, kept = back
                elif back is not None:
                    passed = self._pass_change_point(parameters, state, tolerance, watch)
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
                ended, cause = BLOW_UP, self._wild_cause(state, away)
                break
            if not size > parameters[CONTROLS.index(SMALLEST), 0]:
                wild = not np.all(np.isfinite(state)) or away > WILD
                ended = BLOW_UP if wild else STEP_SIZE
                cause = _(
                    "at {time:.9g} s the step became as small as {step:.3g} s; {part} changes its speed fastest there"
                ).format(time=time, step=size, part=self._fastest(state))
                break
            if steps >= MOST_STEPS:
                ended, cause = STEP_SIZE, _("more than {count} steps").format(count=MOST_STEPS)
                break
            room = min(4 * room, MOST_ROWS)
        if watch is not None:
            reached = float(kept[-1][-1, 0]) if len(kept[-1]) else duration
            told = [one for one in watch.events if one.time <= reached]
            events = sorted([*events, *told], key=lambda one: one.time)
        changed = () if watch is None else tuple(watch.transitions)
        rows_of_all = np.concatenate(kept).T
        return MotionSteps(rows_of_all, ended, cause, attempts, tuple(events), tuple(detours), changed)

    def implicit_steps(
        self,
        start: InitialState,
        duration: float,
        tolerance: float,
        executor: str = "auto",
        progress: Callable[[float], None] | None = None,
    ) -> MotionSteps:
        """Steps of SciPy's Radau, for loads so stiff or so strongly damped that they hold explicit steps back.

        Its parameters are those of `explicit_steps`. (E. Hairer and G. Wanner, Solving Ordinary Differential
        Equations II, 2nd ed., 1996, section IV.8.)
        """
        followed = PythonIntegration(self.problem)
        parameters = [
            float(x) for x in self.parameters(duration, tolerance, self.rate(start, duration))[:, 0]
        ]
        carried = self.carried_values(start)
        names, count = self.names, len(self.problem.unknowns)
        angles = np.array(self.equations.tree.angles, dtype=np.intp)
        own = [
            *range(*names.part(names.coordinates).indices(count)),
            *range(*names.part(names.speeds).indices(count)),
        ]
        own += range(*names.part(names.works).indices(count))
        own += range(*names.part(names.states).indices(count))

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

        solver = _integrate().Radau(
            rates, 0.0, carried[own], duration, rtol=max(tolerance, 1e-12), atol=tolerance
        )
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
        followed_between = _integrate().OdeSolution(reached[0], pieces)

        def between(times: Array) -> Array:
            found = np.zeros((len(carried), len(times)))
            found[own] = followed_between(times)
            return found

        return MotionSteps(reached, ended, cause, len(rows) - 1, between=between)

    def states_at(self, steps: MotionSteps, times: Array, executor: str = "auto") -> Array:
        """What is carried at instants (carried, n): one step from the last one before each, as long as is needed."""
        rows, n = steps.rows, len(times)
        if steps.between is not None:
            return steps.between(times)
        begin = np.clip(np.searchsorted(rows[0], times, side="right") - 1, 0, rows.shape[1] - 1)
        lanes = rows[:, begin]
        state = np.concatenate([lanes[:1], np.full((1, n), inf), np.zeros((2, n)), lanes[1:]])
        if not n:
            return rows[1:, :0]
        guarded = [name for name in (LIMIT, GUARD) if name in self.problem.carried_names]
        for name in guarded:
            state[HEADER + self.problem.carried_names.index(name)] = NEVER if name == LIMIT else 0.0
        found = self.integrator(executor).run(self.parameters(times, inf, 1.0, n), state, 1)[HEADER:]
        count = len(self.problem.unknowns)
        for detour in steps.detours:
            inside = (times > detour.begin) & (times < detour.end)
            found[:count, inside] = detour.at(times[inside])
        return found

    @cached_property
    def _half_circles(self) -> HalfCircles:
        return HalfCircles(self.problem)

    def _step_back(
        self,
        take: Integrator,
        parameters: Array,
        state: Array,
        kept: Sequence[Array],
        detours: Sequence[Detour],
        rate: float,
    ) -> tuple[Array, list[Array]] | None:
        """The state at a good distance before a change point that a step came too near, and the rows up to there.

        Beside a change point the speeds are those of equations that have nearly lost rank, and miss by what rounding
        makes of that. None where the distance is good already.
        """
        carried, names = self.problem.carried_names, self.names
        place = HEADER + carried.index(AHEAD)
        units = units_of(self.equations.tree, self.equations.numbers)
        fast = np.abs(state[HEADER:, 0][names.part(names.speeds)]) / units
        fastest = max(rate, float(np.max(fast, initial=0.0)))
        time, ahead = float(state[0, 0]), float(state[place, 0])
        if not ahead * fastest < TOO_NEAR:
            return None
        until = max(time + ahead - 0.5 * FAR / fastest, detours[-1].end if detours else 0.0)
        rows = list(kept)
        while len(rows) > 1 and rows[-1][0, 0] > until:
            rows.pop()
        rows[-1] = rows[-1][: max(1, int(np.searchsorted(rows[-1][:, 0], until, side="right")))]
        row = rows[-1][-1]
        before = np.concatenate([[row[0], until - row[0], 0.0, 0.0], row[1:]])[:, None]
        if until > row[0]:
            before[HEADER + carried.index(GUARD)], before[HEADER + carried.index(LIMIT)] = 0.0, NEVER
            ended = parameters.copy()
            ended[CONTROLS.index(END)] = until
            between = np.empty((ROWS, len(row)))
            before = take.run(ended, before, ROWS, between)
            rows.append(between[: int(before[3, 0])])
        before[place] = time + ahead - before[0]
        return before, rows

    def _pass_change_point(
        self,
        parameters: Array,
        state: Array,
        tolerance: float,
        watch: EventWatch | None = None,
    ) -> tuple[Detour | None, Event | None] | str:
        """Pass the change point ahead, if it is one; the state is that behind it then.

        Returns the detour and the event, or why it is not passed.
        """
        carried = list(self.problem.carried_names)
        row = {name: HEADER + carried.index(name) for name in (AHEAD, LOOKED, GUARD, LIMIT, INDEPENDENCE)}
        time, ahead, near = (
            float(state[0, 0]),
            float(state[row[AHEAD], 0]),
            float(state[row[INDEPENDENCE], 0]),
        )
        units = units_of(self.equations.tree, self.equations.numbers)
        measured = [(self.names.part(kind), units) for kind in (self.names.coordinates, self.names.speeds)]
        detour = self._half_circles.around(parameters[:, 0], time, state[HEADER:, 0], ahead, measured)
        if not detour.is_analytic:
            if near < LOST:
                what = _("a change point at {time:.9g} s through which no smooth motion leads")
                return what.format(time=detour.centre)
            state[row[LOOKED], 0], state[row[GUARD], 0] = 0.5 * near, 0.0
            return None, Event(detour.centre, NEAR_MISS, near) if near < DOUBTFUL else None
        count = len(self.problem.unknowns)
        if watch is not None:
            clear = watch.clear_until(detour, state[HEADER:, 0])
            if clear is None:
                # something happens before the change point is reached: it is integrated straight up to there
                state[row[LOOKED], 0], state[row[GUARD], 0] = 0.5 * near, 0.0
                return None, None
            detour = replace(detour, short=detour.end - clear)
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
        kinetic, potential = self.equations.energies(ARRAYS, self.equations.tree.values(ARRAYS, q), w, time)
        return float(kinetic), float(potential) - float(np.sum(carried[names.part(names.works)]))

    def _wild_cause(self, state: Array, away: float) -> str:
        """What has grown without bound, and the load that gives it most power."""
        names, tree = self.names, self.equations.tree
        q, w = (list(state[HEADER:, 0][names.part(kind)]) for kind in (names.coordinates, names.speeds))
        with np.errstate(all="ignore"):
            terms = self.equations.terms(ARRAYS, tree.values(ARRAYS, q), w, float(state[0, 0]))
        sizes = np.abs(w) / units_of(tree, self.equations.numbers)
        cause = _("at {time:.9g} s {part} had moved {far:.3g} times the greatest length or as fast as that")
        part = tree.coordinates[int(np.argmax(np.nan_to_num(sizes, nan=np.inf)))].name
        cause = cause.format(time=float(state[0, 0]), part=part, far=away)
        powers = [float(power) for power in terms.powers]
        if not powers or not max(powers) > 0.0:
            return cause
        load = self.equations.loads[int(np.argmax(powers))].label
        return f"{cause}; " + _("the load that gives most power is {load}").format(load=load)

    def _fastest(self, state: Array) -> str:
        """Name of the coordinate whose speed changes most, or is the greatest."""
        names, tree = self.names, self.equations.tree
        q, w = (list(state[HEADER:, 0][names.part(kind)]) for kind in (names.coordinates, names.speeds))
        with np.errstate(all="ignore"):
            terms = self.equations.terms(ARRAYS, tree.values(ARRAYS, q), w, float(state[0, 0]))
            accelerations = np.array(self.equations.accelerations(ARRAYS, terms)[0], dtype=np.float64)
        sizes = np.abs(accelerations) / units_of(tree, self.equations.numbers)
        return tree.coordinates[int(np.argmax(np.nan_to_num(sizes, nan=np.inf)))].name

    def _farthest(self, state: Array, rate: float) -> float:
        """The greatest displacement over the greatest length, or speed over what speeds are compared with."""
        names, units = self.names, units_of(self.equations.tree, self.equations.numbers)
        values = np.abs(state[HEADER:, 0])
        slid = np.array([one.kind != "angle" for one in self.equations.tree.coordinates])
        moved = values[names.part(names.coordinates)] / units
        fast = values[names.part(names.speeds)] / units / rate
        return float(max(np.max(moved[slid], initial=0.0), 1e-3 * np.max(fast, initial=0.0)))
