"""The integration of a free motion: steps from a state, explicit or implicit, and states between them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial
from importlib import import_module
from math import inf
from typing import Self, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.forward_dynamics.change_points import HalfCircles
from centrode.dynamics.forward_dynamics.equations_of_motion import EquationsOfMotion
from centrode.dynamics.forward_dynamics.explicit_steps import ExplicitSteps
from centrode.dynamics.forward_dynamics.initial_state import InitialState
from centrode.dynamics.forward_dynamics.motion_functions import MotionFunctions
from centrode.dynamics.forward_dynamics.motion_problem import (
    GUARD,
    LIMIT,
    NEVER,
)
from centrode.dynamics.forward_dynamics.motion_steps import (
    DURATION,
    STEP_SIZE,
    MotionSteps,
)
from centrode.locale import _
from centrode.numerics.initial_value_problems import HEADER
from centrode.numerics.python_integrations import PythonIntegration

Array: TypeAlias = npt.NDArray[np.float64]

# explicit steps need no SciPy, which takes longer to load than most motions take
_integrate = partial(import_module, "scipy.integrate")


@dataclass(frozen=True)
class MotionIntegration(MotionFunctions):
    """Equations of motion whose steps are taken."""

    def with_numbers(self, equations: EquationsOfMotion) -> Self:
        """The same problem for equations of the same structure with other numbers."""
        other = super().with_numbers(equations)
        other.__dict__["_half_circles"] = self._half_circles
        return other

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
        steps = ExplicitSteps(
            self, self._half_circles, self.integrator(executor), duration, tolerance, progress
        )
        return steps.run(start)

    @cached_property
    def _half_circles(self) -> HalfCircles:
        return HalfCircles(self.problem)

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
